/* Tolerance and success of the best plans, and the order by success. */
#ifndef BILLIARD_SEARCH_RANK_H
#define BILLIARD_SEARCH_RANK_H

#include "search/planner.h"

enum { RANKED_MAX = 64 /* plans whose success is found when a profile ranks by it */ };

/* Finds tolerance and success of as many of the best plans as the request or the profile asks for, and ranks by success
 * if the profile does. */
void rank_solutions(struct planner *planner);

#endif
