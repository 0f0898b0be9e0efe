/* The ranked lists of the thesis' own program, compared with ours. */
#ifndef BILLIARD_TESTS_THESIS_LISTS_H
#define BILLIARD_TESTS_THESIS_LISTS_H

#include <jansson.h>

#include "app/config/position.h"
#include "search/plan.h"

/* Place (from 0) of one entry of such a list ("shots" with angle, speed, potted balls) in ours: angles within 0.2
 * degrees, speeds within 2 %, the same balls potted. -1 when it is not there. */
int thesis_rank(const struct position *position, const struct plan_result *result, json_t *want);

#endif
