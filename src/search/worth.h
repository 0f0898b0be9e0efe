/* A planner whose profile ranks by value: what the search for chains has found and all direct pots, valued. */
#ifndef BILLIARD_SEARCH_WORTH_H
#define BILLIARD_SEARCH_WORTH_H

#include "search/planner.h"

/* Values shots from the roots of the search within what is left of the budget. */
void worth_run(struct planner *planner, plan_progress_fn *progress, void *context, struct plan_result *result);

/* The plans in order of their value, at most limit filled in; 0: all. */
void worth_export(struct planner *planner, int limit, struct plan_result *result);

/* There is one. */
bool worth_has_results(const struct planner *planner);

#endif
