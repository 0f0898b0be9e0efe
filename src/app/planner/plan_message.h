/* What the search found as the bus message of a plan. Pure. */
#ifndef BILLIARD_APP_PLAN_MESSAGE_H
#define BILLIARD_APP_PLAN_MESSAGE_H

#include "lcmtypes/billiard_animation_t.h"
#include "lcmtypes/billiard_plan_request_t.h"
#include "lcmtypes/billiard_plan_t.h"
#include "search/plan.h"

enum {
	PLAN_MESSAGE_ENTRIES = 5,
	PLAN_MESSAGE_SHOTS = 3,
	PLAN_MESSAGE_KEYFRAMES = 768,
	PLAN_TRACE_MAX = 2048 /* events of one shot that are looked at */
};

enum plan_message_status { PLAN_MESSAGE_OK, PLAN_MESSAGE_NONE, PLAN_MESSAGE_CANCELLED, PLAN_MESSAGE_REFUSED };

/* Names, colours and id of the request; no entries. */
void plan_message_begin(billiard_plan_t *out, const billiard_plan_request_t *request);
/* Fills the entries, best first, with the keyframes of their shots as long as there is room. scratch: PLAN_TRACE_MAX entries. */
void plan_message_fill(billiard_plan_t *out, const struct plan_result *result, const struct table *table,
		       const struct model *model, struct trace_entry *scratch);
/* Animation of one shot of one entry, which must have passed plan_check(). It runs at its real speed. */
void plan_message_animation(billiard_animation_t *out, const billiard_plan_t *plan, int entry, int shot);

#endif
