/* Between the bus messages of planning and the search's own structures. Pure. */
#ifndef BILLIARD_APP_PLAN_MESSAGE_H
#define BILLIARD_APP_PLAN_MESSAGE_H

#include "app/control/stability.h"
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

/* Ball of a message; its numbers are not checked. */
void ball_to_message(billiard_ball_t *out, const struct ball *ball, const char *name, int track);
/* False when a number is not finite or out of range. */
bool ball_from_message(struct ball *out, const billiard_ball_t *ball);

/* A request as it came from the wire, checked against the table. 0, or -EINVAL with the reason. */
int plan_request_from_message(struct plan_request *out, const billiard_plan_request_t *message,
			      const struct table *table, char *err, size_t err_size);

/* Names, colours and id of the request; no entries. */
void plan_message_begin(billiard_plan_t *out, const billiard_plan_request_t *request);
/* Fills the entries, best first, with the keyframes of their shots as long as there is room. scratch: PLAN_TRACE_MAX entries. */
void plan_message_fill(billiard_plan_t *out, const struct plan_result *result, const struct table *table,
		       const struct model *model, struct trace_entry *scratch);
/* True when counts and indices are in range and all numbers finite: to be called on every plan from the wire. */
bool plan_message_check(const billiard_plan_t *plan, const struct table *table);

/* Animation of one shot of one entry, which must have passed plan_message_check(). */
void plan_message_animation(billiard_animation_t *out, const billiard_plan_t *plan, int entry, int shot);
/* True when both move the same balls in the same way. */
bool plan_message_same_motion(const billiard_animation_t *a, const billiard_animation_t *b);
/* s from the strike until all balls rest. */
double plan_message_animation_length(const billiard_animation_t *animation);
/* s since the strike at which the animation stands, elapsed s after it was at its position: it runs to the end, pauses, begins again. */
double plan_message_animation_time(const billiard_animation_t *animation, double elapsed);
/* True when counts and indices are in range and all numbers finite: to be called on every animation from the wire. */
bool plan_message_animation_check(const billiard_animation_t *animation);

#endif
