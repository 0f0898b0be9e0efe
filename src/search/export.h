/* From what the search has found to what the caller gets. */
#ifndef BILLIARD_SEARCH_EXPORT_H
#define BILLIARD_SEARCH_EXPORT_H

#include "search/planner.h"

/* The best so far, with at most limit plans filled in; 0: all. */
void planner_export(struct planner *planner, int limit, struct plan_result *result);

#endif
