/* Life of a planner and the course of one search. */
#include "search/plan.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#include "search/planner.h"

struct planner_def planner_def_default(void)
{
	struct planner_def def = {.profile = cost_profile_thesis(), .workers = 1, .memory = 32u << 20};
	bool known = model_from_name("thesis", &def.model);
	assert(known);
	(void)known;
	return def;
}

/* Bytes that are not for open nodes. */
static size_t fixed_memory(int workers)
{
	return sizeof(struct planner) + (size_t)workers * sizeof(struct workspace) + BATCH * sizeof(struct slot) +
	       STATES_MAX * sizeof(struct state) + PLAN_SHOTS_MAX * sizeof(struct solutions) + PLAN_MAX * sizeof(struct plan);
}

static int take_memory(struct planner *planner)
{
	int workers = planner->def.workers;
	planner->work = calloc((size_t)workers, sizeof *planner->work);
	planner->slot = calloc(BATCH, sizeof *planner->slot);
	planner->state = calloc(STATES_MAX, sizeof *planner->state);
	planner->solutions = calloc(PLAN_SHOTS_MAX, sizeof *planner->solutions);
	planner->plan = calloc(PLAN_MAX, sizeof *planner->plan);
	if (!planner->work || !planner->slot || !planner->state || !planner->solutions || !planner->plan)
		return -ENOMEM;
	int rc = frontier_init(&planner->frontier, planner->def.memory - fixed_memory(workers));
	return rc ? rc : pool_create(&planner->pool, workers);
}

int planner_create(struct planner **out, const struct planner_def *def)
{
	*out = NULL;
	if (!def->table || def->workers < 1 || def->workers > PLAN_WORKERS_MAX || def->memory <= fixed_memory(def->workers))
		return -EINVAL;
	struct planner *planner = calloc(1, sizeof *planner);
	if (!planner)
		return -ENOMEM;
	planner->def = *def;
	mirrors_init(&planner->mirrors, def->table);
	int rc = take_memory(planner);
	if (rc != 0) {
		planner_destroy(planner);
		return rc;
	}
	*out = planner;
	return 0;
}

void planner_destroy(struct planner *planner)
{
	if (!planner)
		return;
	pool_destroy(planner->pool);
	frontier_finish(&planner->frontier);
	free(planner->work);
	free(planner->slot);
	free(planner->state);
	free(planner->solutions);
	free(planner->plan);
	free(planner);
}

void planner_cancel(struct planner *planner)
{
	atomic_store_explicit(&planner->cancel, true, memory_order_relaxed);
}

static void export_plan(const struct planner *planner, const struct solution *solution, struct plan *plan)
{
	const struct state *from = &planner->state[solution->state];
	int shots = from->shots + 1;
	plan->shot_count = shots;
	plan->cost = solution->cost;
	shot_export(&solution->last, from->ball, planner->ball_count, &plan->shot[shots - 1]);
	for (int i = shots - 2; i >= 0; i--) {
		const struct state *before = &planner->state[from->parent];
		shot_export(&from->record, before->ball, planner->ball_count, &plan->shot[i]);
		from = before;
	}
}

static void export_result(struct planner *planner, struct plan_result *result)
{
	struct solutions *list = best_solutions(planner);
	*result = (struct plan_result){
		.plan = planner->plan,
		.plan_count = list ? list->count : 0,
		.nodes = planner->nodes,
		.sims = planner->sims,
		.tried = planner->tried,
		.landed = planner->landed,
		.refined = planner->refined,
		.exhausted = !planner->cut && !planner->overflow,
	};
	for (int i = 0; i < result->plan_count; i++)
		export_plan(planner, solutions_at(list, i), &planner->plan[i]);
	result->status = result->plan_count > 0 ? PLAN_OK : PLAN_NONE;
}

/* Tolerances of the last shots and, once a position each, of those that led there. */
static void find_tolerances(struct planner *planner)
{
	struct solutions *list = best_solutions(planner);
	for (int i = 0; list && i < list->count && i < planner->request->tolerances; i++) {
		struct solution *s = solutions_at(list, i);
		tolerance_find(planner, &planner->state[s->state], &s->last, planner->work);
		for (int32_t at = s->state; planner->state[at].parent != NO_STATE; at = planner->state[at].parent) {
			struct state *state = &planner->state[at];
			if (isnan(state->record.success))
				tolerance_find(planner, &planner->state[state->parent], &state->record, planner->work);
		}
	}
}

int planner_run(struct planner *planner, const struct plan_request *request, plan_progress_fn *progress, void *context,
		struct plan_result *result, char *err, size_t err_size)
{
	int rc = plan_request_check(planner->def.table, request, err, err_size);
	if (rc == 0 && request->budget.seconds > 0 && !planner->def.now) {
		snprintf(err, err_size, "a budget in seconds needs a clock");
		rc = -EINVAL;
	}
	if (rc != 0)
		return rc;
	atomic_store_explicit(&planner->cancel, false, memory_order_relaxed);
	planner->request = request;
	planner->deadline = request->budget.seconds > 0 ? planner->def.now(planner->def.now_context) + request->budget.seconds : INFINITY;
	search_begin(planner);
	bool improved;
	while (search_step(planner, &improved))
		if (improved && progress) {
			export_result(planner, result);
			progress(context, result);
		}
	if (!best_solutions(planner))
		safety_find(planner);
	find_tolerances(planner);
	export_result(planner, result);
	planner->request = NULL;
	if (!atomic_load_explicit(&planner->cancel, memory_order_relaxed))
		return 0;
	result->status = PLAN_CANCELLED;
	return -ECANCELED;
}
