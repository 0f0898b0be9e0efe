/* One step of the joint tree: a batch of the best open nodes is worked on, then what came out is merged in order. */
#include <assert.h>

#include "search/planner.h"
#include "search/respot.h"

bool search_is_cancelled(const struct planner *planner)
{
	uint64_t run = planner->request->run;
	return run > 0 && run <= atomic_load_explicit(&planner->cancelled, memory_order_relaxed);
}

bool search_is_over(const struct planner *planner)
{
	if (search_is_cancelled(planner))
		return true;
	return planner->def.now && planner->def.now(planner->def.now_context) >= planner->deadline;
}

/* Under which rules the first shot is judged. A named colour is played as after a red, or in its turn when no red is
 * left. */
static struct rules_state first_rules(const struct planner *planner)
{
	const struct plan_request *request = planner->request;
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

static bool is_wanted(const struct plan_request *request, const struct state *state, int ball)
{
	if (state->shots > 0)
		return true;
	if (request->target == TARGET_BALL)
		return ball == request->target_ball;
	if (request->target == TARGET_COLOUR)
		return state->ball[ball].colour == request->target_colour;
	return true;
}

static void set_scene(const struct planner *planner, struct state *state)
{
	const struct plan_request *request = planner->request;
	struct scene *scene = &state->scene;
	*scene = (struct scene){
		.table = planner->def.table,
		.mirrors = &planner->mirrors,
		.profile = &planner->def.profile,
		.ball = state->ball,
		.count = planner->ball_count,
		.cue = planner->cue,
		.named = state->rules.on == ON_COLOUR && !state->rules.any_first,
		.rails = request->rails,
		.balls = request->balls,
	};
	for (int i = 0; i < scene->count; i++) {
		if (state->rules.any_first && i != scene->cue)
			scene->on |= 1u << i;
		if (!rules_ball_on(&state->rules, state->ball, scene->count, i))
			continue;
		scene->on |= 1u << i;
		if (is_wanted(request, state, i))
			scene->wanted |= 1u << i;
	}
}

int state_roots(const struct planner *planner, int index, struct node root[ROOTS_MAX])
{
	struct state *state = &planner->state[index];
	set_scene(planner, state);
	int outermost = (planner->def.profile.aims - 1) / 2, count = 0;
	assert(2 * outermost + 2 <= AIMS_MAX);
	for (int p = 0; p < planner->def.table->pocket_count && state->scene.wanted; p++) {
		for (int aim = -outermost; aim <= outermost; aim++)
			root[count++] = candidate_root(&state->scene, p, aim);
		if (outermost > 0)
			root[count++] = candidate_root(&state->scene, p, AIM_ALONG);
	}
	for (int i = 0; i < count; i++) {
		root[i].state = (uint32_t)index;
		root[i].cost += state->cost;
	}
	return count;
}

static void push_roots(struct planner *planner, int index)
{
	struct node root[ROOTS_MAX];
	int count = state_roots(planner, index, root);
	for (int i = 0; i < count; i++)
		frontier_push(&planner->frontier, &root[i]);
}

static void add_root_state(struct planner *planner, vec2 cue)
{
	struct state *state = &planner->state[planner->state_count];
	const struct plan_request *request = planner->request;
	*state = (struct state){.rules = first_rules(planner), .parent = NO_STATE};
	state->rules.in_hand = false;
	state->rules.any_first = planner->def.profile.any_first;
	for (int i = 0; i < request->ball_count; i++)
		state->ball[i] = request->ball[i];
	state->ball[planner->cue] = ball_at(COLOUR_WHITE, cue);
	push_roots(planner, planner->state_count++);
}

/* Places in the D: its middle, half way out and on its line; what is free of them. */
static void add_places_in_hand(struct planner *planner)
{
	enum { RINGS = 2, RAYS = 7 };
	const struct table *table = planner->def.table;
	struct ball others[BALL_MAX];
	for (int i = 0; i < planner->ball_count; i++)
		others[i] = planner->request->ball[i];
	others[planner->cue].phase = BALL_POTTED;
	if (respot_is_free(table, others, planner->ball_count, table->baulk_d_centre))
		add_root_state(planner, table->baulk_d_centre);
	for (int ring = 1; ring <= RINGS; ring++)
		for (int ray = 0; ray < RAYS; ray++) {
			vec2 out = vec2_from_angle(M_PI / 2 + M_PI * ray / (RAYS - 1));
			vec2 place = vec2_madd(table->baulk_d_centre, table->baulk_d_radius * ring / RINGS, out);
			if (respot_is_free(table, others, planner->ball_count, place))
				add_root_state(planner, place);
		}
}

void search_begin(struct planner *planner)
{
	const struct plan_request *request = planner->request;
	frontier_clear(&planner->frontier);
	planner->ball_count = request->ball_count;
	planner->state_count = 0;
	planner->nodes = planner->sims = planner->tried = planner->landed = planner->refined = 0;
	planner->overflow = planner->cut = false;
	planner->batch_count = 0;
	/* who ranks by success must look at more than the cheapest few */
	int kept = request->plans;
	if (planner->def.profile.rank_by_success && kept < RANKED_MAX)
		kept = RANKED_MAX;
	for (int i = 0; i <= SAFETY_LIST; i++) {
		planner->solutions[i].count = 0;
		planner->solutions[i].limit = i == SAFETY_LIST ? 1 : kept;
	}
	for (int i = 0; i < request->ball_count; i++)
		if (request->ball[i].colour == COLOUR_WHITE)
			planner->cue = i;
	if (request->state.in_hand)
		add_places_in_hand(planner);
	if (planner->state_count == 0)
		add_root_state(planner, request->ball[planner->cue].pos);
}

struct solutions *best_solutions(struct planner *planner)
{
	for (int shots = planner->request->depth; shots >= 1; shots--)
		if (planner->solutions[shots - 1].count > 0)
			return &planner->solutions[shots - 1];
	return planner->solutions[SAFETY_LIST].count > 0 ? &planner->solutions[SAFETY_LIST] : NULL;
}

void slot_work(const struct planner *planner, struct slot *slot, struct workspace *work)
{
	slot->child_count = slot->played_count = 0;
	slot->expansions = slot->sims = slot->tried = slot->landed = slot->refined = 0;
	slot->overflow = false;
	if (search_is_over(planner))
		return;
	if (slot->node.complete) {
		slot_play(planner, slot, work);
		return;
	}
	const struct state *state = &planner->state[slot->node.state];
	slot->child_count = candidate_expand(&state->scene, &slot->node, slot->child, CHILDREN_MAX, &slot->overflow);
	slot->expansions = 1;
}

static void work_on(void *context, int item, int worker)
{
	struct planner *planner = context;
	slot_work(planner, &planner->slot[planner->claim[item]], &planner->work[worker]);
}

/* Cost that a sequence must stay below to be among the wanted ones. */
static double cost_limit(const struct planner *planner)
{
	struct solutions *full = &planner->solutions[planner->request->depth - 1];
	return full->count == full->limit ? solutions_at(full, full->count - 1)->cost : INFINITY;
}

bool outcome_is_cleared(const struct rules_outcome *outcome, int count)
{
	for (int i = 0; i < count; i++)
		if (rules_ball_on(&outcome->next, outcome->ball, count, i))
			return false;
	return true;
}

void state_set(struct state *state, const struct planner *planner, const struct solution *shot,
	       const struct rules_outcome *outcome)
{
	*state = (struct state){
		.rules = outcome->next,
		.record = shot->last,
		.parent = shot->state,
		.shots = planner->state[shot->state].shots + 1,
		.cost = shot->cost,
		.key = shot->key,
	};
	for (int i = 0; i < planner->ball_count; i++)
		state->ball[i] = outcome->ball[i];
}

static void merge_played(struct planner *planner, const struct slot *slot, const struct played *played, bool *improved)
{
	struct state *from = &planner->state[slot->node.state];
	from->landed[played->record.target] |= (uint8_t)(1u << played->record.pocket);
	int depth = planner->request->depth, shots = from->shots + 1;
	bool last = shots == depth || outcome_is_cleared(&played->outcome, planner->ball_count);
	struct solution solution = solution_make(planner, slot->node.state, &played->record);
	struct solutions *list = &planner->solutions[last ? depth - 1 : shots - 1];
	if (solutions_add(list, &solution) && list == best_solutions(planner) &&
	    solutions_at(list, 0)->cost == solution.cost)
		*improved = true;
	if (last || solution.cost > cost_limit(planner))
		return;
	if (planner->state_count == STATES_MAX) {
		planner->overflow = true;
		return;
	}
	state_set(&planner->state[planner->state_count], planner, &solution, &played->outcome);
	push_roots(planner, planner->state_count++);
}

static void merge(struct planner *planner, const struct slot *slot, bool *improved)
{
	planner->nodes += slot->expansions;
	planner->sims += slot->sims;
	planner->tried += slot->tried;
	planner->landed += slot->landed;
	planner->refined += slot->refined;
	planner->overflow |= slot->overflow;
	for (int i = 0; i < slot->played_count; i++)
		merge_played(planner, slot, &slot->played[i], improved);
	double limit = cost_limit(planner);
	for (int i = 0; i < slot->child_count; i++)
		if (slot->child[i].cost <= limit)
			frontier_push(&planner->frontier, &slot->child[i]);
}

/* How many nodes this batch may take: all that is left of a node budget at most. */
static int batch_size(struct planner *planner)
{
	uint64_t budget = planner->request->budget.nodes, used = planner->nodes + planner->sims;
	int size = planner->batch_count < FIRST_SLICE ? FIRST_BATCH : BATCH;
	return budget == 0 || budget - used >= (uint64_t)size ? size : (int)(budget - used);
}

bool node_is_spare(const struct planner *planner, const struct node *node)
{
	return node->aim != 0 && node->chain_count > 0 &&
	       (planner->state[node->state].landed[node->chain[0]] >> node->pocket & 1);
}

/* What is simulated takes longest: workers claim it first, so that they are done at about the same time. */
static void order_claims(struct planner *planner, int count)
{
	int at = 0;
	for (int complete = 1; complete >= 0; complete--)
		for (int i = 0; i < count; i++)
			if (planner->slot[i].node.complete == complete)
				planner->claim[at++] = (uint8_t)i;
}

bool search_step(struct planner *planner, bool *improved)
{
	uint64_t budget = planner->request->budget.nodes;
	*improved = false;
	if (planner->frontier.count == 0 || frontier_best(&planner->frontier) > cost_limit(planner))
		return false;
	if (search_is_over(planner) || (budget > 0 && planner->nodes + planner->sims >= budget)) {
		planner->cut = true;
		return false;
	}
	int size = batch_size(planner), count = 0;
	while (count < size && planner->frontier.count > 0) {
		planner->slot[count].node = frontier_pop(&planner->frontier);
		count += !node_is_spare(planner, &planner->slot[count].node);
	}
	order_claims(planner, count);
	if (planner->batch_count < FIRST_SLICE)
		for (int i = 0; i < count; i++)
			work_on(planner, i, 0);
	else
		pool_for(planner->pool, count, work_on, planner);
	for (int i = 0; i < count; i++)
		merge(planner, &planner->slot[i], improved);
	if (++planner->batch_count == SAFETY_STEP && !best_solutions(planner))
		*improved = safety_find(planner, false);
	return true;
}
