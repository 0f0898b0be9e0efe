/* The first positions of a search. */
#ifndef BILLIARD_SEARCH_START_H
#define BILLIARD_SEARCH_START_H

#include "search/planner.h"

/* Empties what the last search has left and sets up the first positions and their roots. */
void search_begin(struct planner *planner);

#endif
