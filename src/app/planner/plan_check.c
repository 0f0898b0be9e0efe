#include "app/planner/plan_check.h"

#include "app/light/keyframe.h"
#include "app/planner/plan_message.h"

/* Indices name what is there; -1 where none is meant. */
static bool shot_check(const billiard_plan_t *plan, const billiard_plan_shot_t *shot, const struct table *table)
{
	bool ok = shot->target < plan->ball_count && shot->pocket < table->pocket_count &&
		  shot->keyframe_first <= plan->keyframe_count &&
		  shot->keyframe_count <= plan->keyframe_count - shot->keyframe_first;
	for (int i = 0; ok && i < shot->chain_count; i++)
		ok = shot->chain[i] < plan->ball_count;
	for (int i = 0; ok && i < shot->potted_count; i++)
		ok = shot->potted_ball[i] < plan->ball_count && shot->potted_pocket[i] < table->pocket_count;
	return ok;
}

bool plan_check(const billiard_plan_t *plan, const struct table *table)
{
	bool ok = plan->request_id > 0 && (plan->status != PLAN_MESSAGE_OK || plan->entry_count > 0);
	for (int i = 0; ok && i < plan->keyframe_count; i++)
		ok = keyframe_check(&plan->keyframes[i], plan->ball_count);
	for (int i = 0; ok && i < plan->entry_count; i++)
		for (int k = 0; ok && k < plan->entries[i].shot_count; k++)
			ok = shot_check(plan, &plan->entries[i].shots[k], table);
	return ok;
}
