#include "search/slot.h"

#include <string.h>

#include "search/refine.h"

static void begin_record(const struct node *node, struct record *record)
{
	memset(record, 0, sizeof *record);
	record->shot.angle = node->angle;
	record->target = node->chain[0];
	record->pocket = node->pocket;
	record->search_cost = node->search_cost;
	record->rails = node->rails;
	record->chain_count = node->chain_count;
	for (int i = 0; i < PLAN_CHAIN_MAX; i++)
		record->chain[i] = i < node->chain_count ? node->chain[node->chain_count - 1 - i] : -1;
	record->success = NAN;
}

/* A legal pot of something else than meant becomes a proposal that says so. */
static bool rename_fluke(const struct cost_profile *profile, const struct scene *scene, struct record *record)
{
	if (!profile->keep_flukes || record->potted_count == 0)
		return false;
	for (int i = 0; i < record->potted_count; i++)
		if (scene->wanted >> record->potted[i].ball & 1) {
			record->target = record->potted[i].ball;
			record->pocket = record->potted[i].pocket;
			return true;
		}
	return false;
}

/* Plays record->shot; where mirroring is not how balls come off cushions and throw is felt, the aim is refined. True
 * for a proposal. */
static bool try_shot(const struct task *task, struct slot *slot, struct workspace *work, struct record *record,
		     struct rules_outcome *outcome)
{
	const struct state *state = &task->state[slot->node.state];
	slot->count[COUNT_SIMS]++;
	slot->count[COUNT_TRIED]++;
	bool played = state_play(task, state, work, record, outcome);
	bool landed = played && record->foul == 0 && shot_is_as_meant(record);
	slot->count[COUNT_LANDED] += landed;
	if (!task->def->model.thesis_motion && played) {
		bool refined = shot_refine(task, slot, work, record, outcome);
		slot->count[COUNT_REFINED] += refined;
		return refined;
	}
	return landed || (played && record->foul == 0 && rename_fluke(&task->def->profile, &state->scene, record));
}

static void play(const struct task *task, struct slot *slot, struct workspace *work)
{
	const struct cost_profile *profile = &task->def->profile;
	int speeds = task->request->speeds < SPEEDS_MAX ? task->request->speeds : SPEEDS_MAX;
	/* who ranks by value opens direct pots into strokes by himself: one is enough for a first answer */
	if (profile->ranking == RANK_VALUE && slot->node.chain_count == 2 && slot->node.rails == 0)
		speeds = 1;
	for (int i = 0; i < speeds && !budget_is_over(task->budget); i++) {
		struct played *played = &slot->played[slot->played_count];
		struct record *record = &played->record;
		begin_record(&slot->node, record);
		record->shot.speed = slot->node.speed + i * profile->speed_step;
		if (record->shot.speed > profile->max_speed)
			break;
		if (!try_shot(task, slot, work, record, &played->outcome))
			continue;
		record->cost = record->search_cost +
			       cost_result(profile, record->points, record->shot.speed, record->search_cost);
		slot->played_count++;
	}
}

void slot_work(const struct task *task, struct slot *slot, struct workspace *work)
{
	slot->child_count = slot->played_count = 0;
	memset(slot->count, 0, sizeof slot->count);
	slot->overflow = false;
	if (budget_is_over(task->budget))
		return;
	if (slot->node.complete) {
		play(task, slot, work);
		return;
	}
	const struct state *state = &task->state[slot->node.state];
	slot->child_count = candidate_expand(&state->scene, &slot->node, slot->child, CHILDREN_MAX, &slot->overflow);
	slot->count[COUNT_NODES] = 1;
}
