#include "search/worth.h"

#include "search/export.h"
#include "search/why.h"

/* Simulations that an idle core of a cloud machine makes in a second: what a time budget is planned with. What comes late
 * is cut off by the clock. */
static const double SIMS_PER_SECOND = 170e3;
static const uint64_t SIMS_DEFAULT = 30000; /* without any budget */

struct worth {
	struct planner *planner;
	plan_progress_fn *progress;
	void *context;
	struct plan_result *result;
};

static bool is_over(void *context)
{
	const struct worth *worth = context;
	return budget_is_over(&worth->planner->budget);
}

static void improved(void *context)
{
	struct worth *worth = context;
	if (!worth->progress || !worth_has_results(worth->planner))
		return;
	worth_export(worth->planner, worth->planner->def.progress_plans, worth->result);
	worth->progress(worth->context, worth->result);
}

static uint64_t sims_left(const struct planner *planner)
{
	const struct plan_budget *budget = &planner->request.budget;
	uint64_t used = planner->count[COUNT_NODES] + planner->count[COUNT_SIMS];
	uint64_t sims = SIMS_DEFAULT;
	if (planner->nodes_wanted > 0)
		sims = planner->nodes_wanted > used ? planner->nodes_wanted - used : 1;
	if (budget->seconds > 0) {
		double left = planner->budget.deadline - budget_now(&planner->budget);
		double most = fmax(1, left * SIMS_PER_SECOND * planner->def.workers);
		if (planner->nodes_wanted == 0 || most < (double)sims)
			sims = (uint64_t)most;
	}
	return sims;
}

static void set_roots(const struct planner *planner, struct value_request *request)
{
	for (int i = 0; i < planner->state_count && request->root_count < VALUE_ROOTS_MAX; i++) {
		const struct state *state = &planner->task.state[i];
		if (state->parent != NO_STATE)
			continue;
		request->root[request->root_count++] =
			(struct value_root){state->ball, state->rules, state->scene.wanted, i};
	}
}

static int root_of(const struct value_request *request, int32_t state)
{
	for (int i = 0; i < request->root_count; i++)
		if (request->root[i].index == state)
			return i;
	return -1;
}

/* Direct pots are opened by the value search itself; chains over balls and cushions are what it is given. */
static void add_chains(struct planner *planner, const struct value_request *request)
{
	struct solutions *list = &planner->results->list[0];
	for (int i = 0; i < list->count; i++) {
		const struct solution *solution = solutions_at(list, i);
		int root = root_of(request, solution->state);
		if (root >= 0 && (solution->last.rails > 0 || solution->last.chain_count > 2))
			value_add(planner->value, root, &solution->last);
	}
}

void worth_run(struct planner *planner, plan_progress_fn *progress, void *context, struct plan_result *result)
{
	struct worth worth = {planner, progress, context, result};
	const struct value_hooks hooks = {is_over, improved, &worth};
	const struct cost_profile *profile = &planner->def.profile;
	struct value_request request = {
		.ball_count = planner->task.ball_count,
		.cue = planner->task.cue,
		.max_speed = profile->max_speed,
		.sims = sims_left(planner),
	};
	set_roots(planner, &request);
	value_set_error(planner->value, planner->request.has_error ? &planner->request.error : &profile->error);
	value_begin(planner->value, &request);
	add_chains(planner, &request);
	value_run(planner->value, &hooks);
	planner->count[COUNT_SIMS] += value_sims(planner->value);
}

bool worth_has_results(const struct planner *planner)
{
	return value_result(planner->value, 0) != NULL;
}

static void export_stroke(const struct planner *planner, const struct stroke *stroke, struct plan *plan)
{
	struct plan_shot *shot = &plan->shot[0];
	const struct state *from = &planner->task.state[value_root_index(planner->value, stroke->root)];
	shot_export(&stroke->record, from->ball, planner->task.ball_count, shot);
	shot->success = stroke->chance;
	shot->value = stroke->value;
	if (stroke->good > 0) {
		shot->leave = stroke->leave;
		shot->leave_radius = stroke->leave_radius;
	}
	const struct setting setting = {planner->def.table, &planner->def.model, from->ball, planner->task.ball_count,
					&from->rules};
	why_find(shot, &stroke->record, &setting, value_estimator(planner->value), &planner->work[0]);
	plan->shot_count = 1;
	plan->cost = shot->cost;
}

void worth_export(struct planner *planner, int limit, struct plan_result *result)
{
	int found = 0;
	while (found < planner->request.plans && value_result(planner->value, found))
		found++;
	planner_export(planner, 1, result);
	result->found = found;
	result->plan_count = limit > 0 && limit < found ? limit : found;
	result->status = found > 0 ? PLAN_OK : PLAN_NONE;
	for (int i = 0; i < result->plan_count; i++)
		export_stroke(planner, value_result(planner->value, i), &planner->plan[i]);
}
