#include "search/start.h"

#include <string.h>

#include "search/rank.h"
#include "search/respot.h"

/* Under which rules the first shot is judged. A named colour is played as after a red, or in its turn when no red is
 * left. */
static struct rules_state first_rules(const struct plan_request *request)
{
	struct rules_state rules = request->state;
	enum ball_colour colour = request->target_colour;
	switch (request->target) {
	case TARGET_RULES:
		return rules;
	case TARGET_ANY:
		rules.on = ON_ANY;
		return rules;
	case TARGET_BALL:
		colour = request->ball[request->target_ball].colour;
		break;
	case TARGET_COLOUR:
		break;
	}
	struct rules_state position = rules_state_from_position(request->ball, request->ball_count);
	if (colour == COLOUR_UNKNOWN)
		rules.on = ON_ANY;
	else if (colour == COLOUR_RED)
		rules.on = ON_RED;
	else
		rules.on = ON_COLOUR;
	for (int i = 0; i < request->ball_count && position.on == ON_CLEARANCE; i++)
		if (request->ball[i].colour == colour &&
		    rules_ball_on(&position, request->ball, request->ball_count, i))
			rules.on = ON_CLEARANCE;
	return rules;
}

static void push_roots(struct planner *planner, int index)
{
	struct node root[ROOTS_MAX];
	int count = state_roots(&planner->task, index, root);
	for (int i = 0; i < count; i++)
		frontier_push(&planner->frontier, &root[i]);
}

static void add_root_state(struct planner *planner, vec2 cue)
{
	struct state *state = &planner->task.state[planner->state_count];
	const struct plan_request *request = planner->task.request;
	*state = (struct state){.rules = first_rules(request), .parent = NO_STATE};
	state->rules.in_hand = false;
	/* a profile does not bend the law: who asks for the rules and means the thesis' says so in the request */
	state->rules.any_first =
		request->target == TARGET_RULES ? request->state.any_first : planner->def.profile.any_first;
	for (int i = 0; i < request->ball_count; i++)
		state->ball[i] = request->ball[i];
	state->ball[planner->task.cue] = ball_at(COLOUR_WHITE, cue);
	push_roots(planner, planner->state_count++);
}

/* Places in the D: its middle, half way out and on its line; what is free of them. */
static void add_places_in_hand(struct planner *planner)
{
	enum { RINGS = 2, RAYS = 7 };
	const struct table *table = planner->def.table;
	struct ball others[BALL_MAX];
	for (int i = 0; i < planner->task.ball_count; i++)
		others[i] = planner->task.request->ball[i];
	others[planner->task.cue].phase = BALL_POTTED;
	if (respot_is_free(table, others, planner->task.ball_count, table->baulk_d_centre))
		add_root_state(planner, table->baulk_d_centre);
	for (int ring = 1; ring <= RINGS; ring++)
		for (int ray = 0; ray < RAYS; ray++) {
			vec2 out = vec2_from_angle(M_PI / 2 + M_PI * ray / (RAYS - 1));
			vec2 place = vec2_madd(table->baulk_d_centre, table->baulk_d_radius * ring / RINGS, out);
			if (respot_is_free(table, others, planner->task.ball_count, place))
				add_root_state(planner, place);
		}
}

static int cue_ball(const struct plan_request *request)
{
	int cue = 0;
	while (request->ball[cue].colour != COLOUR_WHITE)
		cue++;
	return cue;
}

void search_begin(struct planner *planner)
{
	const struct plan_request *request = planner->task.request;
	frontier_clear(&planner->frontier);
	planner->task.ball_count = request->ball_count;
	planner->task.cue = cue_ball(request);
	planner->state_count = planner->batch_count = 0;
	memset(planner->count, 0, sizeof planner->count);
	planner->overflow = planner->cut = false;
	/* who ranks by success must look at more than the cheapest few */
	bool ranks = planner->def.profile.ranking != RANK_THESIS && request->plans < RANKED_MAX;
	results_clear(planner->results, request->depth, ranks ? RANKED_MAX : request->plans);
	if (request->state.in_hand)
		add_places_in_hand(planner);
	if (planner->state_count == 0)
		add_root_state(planner, request->ball[planner->task.cue].pos);
}
