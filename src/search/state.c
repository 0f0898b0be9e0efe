#include "search/state.h"

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

static void set_scene(const struct task *task, struct state *state)
{
	const struct plan_request *request = task->request;
	struct scene *scene = &state->scene;
	*scene = (struct scene){
		.table = task->def->table,
		.mirrors = task->mirrors,
		.profile = &task->def->profile,
		.ball = state->ball,
		.count = task->ball_count,
		.cue = task->cue,
		.named = (state->rules.on == ON_COLOUR || state->rules.free_ball) && !state->rules.any_first,
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

int state_roots(const struct task *task, int index, struct node root[ROOTS_MAX])
{
	struct state *state = &task->state[index];
	set_scene(task, state);
	int outermost = (task->def->profile.aims - 1) / 2, count = 0;
	for (int p = 0; p < task->def->table->pocket_count && state->scene.wanted; p++) {
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

bool state_is_spare(const struct task *task, const struct node *node)
{
	return node->aim != 0 && node->chain_count > 0 &&
	       (task->state[node->state].landed[node->chain[0]] >> node->pocket & 1);
}

bool state_play(const struct task *task, const struct state *state, struct workspace *work, struct record *record,
		struct rules_outcome *outcome)
{
	const struct setting setting = {task->def->table, &task->def->model, state->ball, task->ball_count,
					&state->rules};
	return shot_play(work, &setting, record, outcome);
}

bool state_is_cleared(const struct rules_outcome *outcome, int count)
{
	for (int i = 0; i < count; i++)
		if (rules_ball_on(&outcome->next, outcome->ball, count, i))
			return false;
	return true;
}
