/* The one border of a plan behind the bus. Pure. */
#ifndef BILLIARD_APP_PLAN_CHECK_H
#define BILLIARD_APP_PLAN_CHECK_H

#include <stdbool.h>

#include "lcmtypes/billiard_plan_t.h"
#include "physics/table.h"

/* True when a plan whose numbers the bus let through (message_check()) agrees with itself and the table: indices name balls, pockets and
 * keyframes that are there. To be called once on every plan from the wire; what comes after takes checked plans. */
bool plan_check(const billiard_plan_t *plan, const struct table *table);

#endif
