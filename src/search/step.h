/* One step of the joint tree. */
#ifndef BILLIARD_SEARCH_STEP_H
#define BILLIARD_SEARCH_STEP_H

#include "search/planner.h"

enum { FIRST_SLICE = 8 /* batches that the caller works on alone, without waking anybody */ };

/* Works on the best open nodes once. False when there is nothing left to do. *improved: a better best plan. */
bool search_step(struct planner *planner, bool *improved);

#endif
