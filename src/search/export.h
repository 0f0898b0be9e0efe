/* From what the search has found to what the caller gets. */
#ifndef BILLIARD_SEARCH_EXPORT_H
#define BILLIARD_SEARCH_EXPORT_H

#include "search/planner.h"

/* The plan_shot of a record played from ball. */
void shot_export(const struct record *record, const struct ball *ball, int count, struct plan_shot *out);

/* The best so far, with at most limit plans filled in; 0: all. */
void planner_export(struct planner *planner, int limit, struct plan_result *result);

#endif
