/* There is always an answer: the simplest legal contact with a ball on. */
#ifndef BILLIARD_SEARCH_SAFETY_H
#define BILLIARD_SEARCH_SAFETY_H

#include "search/planner.h"

/* With nothing to pot (yet): the simplest legal contact becomes the one solution. thorough: beside the middle of balls,
 * over cushions, at last a fan of directions and the cheapest foul. False when there is none. */
bool safety_find(struct planner *planner, bool thorough);

#endif
