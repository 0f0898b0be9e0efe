/* A complete chain, played at its start speeds. */
#include <string.h>

#include "search/planner.h"

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
static bool try_shot(const struct planner *planner, struct slot *slot, struct workspace *work, struct record *record,
		     struct rules_outcome *outcome)
{
	const struct state *state = &planner->state[slot->node.state];
	slot->sims++;
	slot->tried++;
	bool played = shot_play(work, planner->def.table, &planner->def.model, state->ball, planner->ball_count,
				&state->rules, record, outcome);
	bool landed = played && record->foul == 0 && shot_is_as_meant(record);
	slot->landed += landed;
	if (!planner->def.model.thesis_motion && played) {
		bool refined = shot_refine(planner, slot, work, record, outcome);
		slot->refined += refined;
		return refined;
	}
	return landed || (played && record->foul == 0 && rename_fluke(&planner->def.profile, &state->scene, record));
}

void slot_play(const struct planner *planner, struct slot *slot, struct workspace *work)
{
	const struct cost_profile *profile = &planner->def.profile;
	int speeds = planner->request->speeds < SPEEDS_MAX ? planner->request->speeds : SPEEDS_MAX;
	for (int i = 0; i < speeds && !search_is_over(planner); i++) {
		struct played *played = &slot->played[slot->played_count];
		struct record *record = &played->record;
		begin_record(&slot->node, record);
		record->shot.speed = slot->node.speed + i * profile->speed_step;
		if (record->shot.speed > profile->max_speed)
			break;
		if (!try_shot(planner, slot, work, record, &played->outcome))
			continue;
		record->cost = record->search_cost +
			       cost_result(profile, record->points, record->shot.speed, record->search_cost);
		slot->played_count++;
	}
}
