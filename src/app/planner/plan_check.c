#include "app/planner/plan_check.h"

#include <math.h>

#include "app/planner/plan_message.h"

/* What no table exceeds: m, m/s or m/s^2, s. Drawing then needs no care for overflow. */
static const double PLACE_MAX = 100, SPEED_MAX = 1000, TIME_MAX = 3600;

static bool in(long value, long low, long high)
{
	return value >= low && value <= high;
}

static bool within(double value, double limit)
{
	return fabs(value) <= limit; /* false for NaN */
}

static bool shot_ok(const billiard_plan_t *plan, const billiard_plan_shot_t *shot, const struct table *table)
{
	bool ok = in(shot->target, -1, plan->ball_count - 1) && in(shot->pocket, -1, table->pocket_count - 1) &&
		  in(shot->chain_count, 0, 4) && in(shot->potted_count, 0, 8) && within(shot->angle, 100) &&
		  within(shot->speed, 100) && within(shot->side, 1) && within(shot->follow, 1) &&
		  within(shot->elevation, 2) && isfinite(shot->cost) && isfinite(shot->tolerance_angle) &&
		  isfinite(shot->tolerance_speed) && within(shot->success, 1) &&
		  in(shot->keyframe_first, 0, plan->keyframe_count) &&
		  in(shot->keyframe_count, 0, plan->keyframe_count - shot->keyframe_first);
	for (int i = 0; ok && i < shot->chain_count; i++)
		ok = in(shot->chain[i], 0, plan->ball_count - 1);
	for (int i = 0; ok && i < shot->potted_count; i++)
		ok = in(shot->potted_ball[i], 0, plan->ball_count - 1) &&
		     in(shot->potted_pocket[i], 0, table->pocket_count - 1);
	for (int i = 0; ok && i < plan->ball_count; i++)
		ok = within(shot->start_x[i], PLACE_MAX) && within(shot->start_y[i], PLACE_MAX);
	return ok;
}

static bool keyframe_ok(const billiard_keyframe_t *k, int ball_count)
{
	return in(k->ball, 0, ball_count - 1) && in(k->phase, 0, BALL_POTTED) &&
	       in(k->event, 0, EVENT_KIND_COUNT - 1) && k->begin >= 0 && k->begin <= k->end && k->end <= TIME_MAX &&
	       within(k->x, PLACE_MAX) && within(k->y, PLACE_MAX) && within(k->vx, SPEED_MAX) &&
	       within(k->vy, SPEED_MAX) && within(k->ax, SPEED_MAX) && within(k->ay, SPEED_MAX);
}

bool plan_check(const billiard_plan_t *plan, const struct table *table)
{
	bool ok = plan->request_id > 0 && in(plan->status, PLAN_MESSAGE_OK, PLAN_MESSAGE_REFUSED) &&
		  in(plan->ball_count, 0, BALL_MAX) && in(plan->entry_count, 0, PLAN_MESSAGE_ENTRIES) &&
		  in(plan->keyframe_count, 0, PLAN_MESSAGE_KEYFRAMES) &&
		  (plan->status != PLAN_MESSAGE_OK || plan->entry_count > 0);
	for (int i = 0; ok && i < plan->ball_count; i++)
		ok = in(plan->colours[i], 0, COLOUR_COUNT - 1);
	for (int i = 0; ok && i < plan->keyframe_count; i++)
		ok = keyframe_ok(&plan->keyframes[i], plan->ball_count);
	for (int i = 0; ok && i < plan->entry_count; i++) {
		const billiard_plan_entry_t *entry = &plan->entries[i];
		ok = in(entry->shot_count, 1, PLAN_MESSAGE_SHOTS) && isfinite(entry->cost);
		for (int k = 0; ok && k < entry->shot_count; k++)
			ok = shot_ok(plan, &entry->shots[k], table);
	}
	return ok;
}
