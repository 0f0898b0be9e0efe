/* What may be taken of a plan from the wire. Pure. */
#ifndef BILLIARD_APP_PLAN_CHECK_H
#define BILLIARD_APP_PLAN_CHECK_H

#include <stdbool.h>

#include "lcmtypes/billiard_plan_t.h"
#include "physics/table.h"

/* True when counts and indices are in range and all numbers finite: to be called on every plan from the wire. */
bool plan_check(const billiard_plan_t *plan, const struct table *table);

#endif
