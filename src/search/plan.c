/* Life of a planner and the course of one search. */
#include "search/plan.h"

#include <assert.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "search/crew.h"
#include "search/export.h"
#include "search/figures.h"
#include "search/rank.h"
#include "search/safety.h"
#include "search/start.h"
#include "search/step.h"
#include "search/worth.h"

/* Of a live budget, for those who rank by success, and for those who only want to know the tolerance of a few plans. */
static const double RANKING_SHARE = 0.2, TOLERANCE_SHARE = 0.05;
/* The same for chains over balls and cushions, where shots are ranked by value. */
static const double CHAIN_SHARE = 0.2;

static const char *const ranking_names[] = {
	[RANK_THESIS] = "thesis", [RANK_SUCCESS] = "success", [RANK_VALUE] = "value"};

bool plan_ranking_from_name(const char *name, enum plan_ranking *ranking)
{
	for (size_t i = 0; i < sizeof ranking_names / sizeof *ranking_names; i++)
		if (strcmp(name, ranking_names[i]) == 0) {
			*ranking = (enum plan_ranking)i;
			return true;
		}
	return false;
}

struct planner_def planner_def_default(void)
{
	struct planner_def def = {
		.profile = cost_profile_thesis(),
		.workers = 1,
		.sync_period = 0.1,
		.sync_window = 0.004,
		.memory = 32u << 20,
	};
	bool known = model_from_name("thesis", &def.model);
	assert(known);
	(void)known;
	return def;
}

/* Bytes that are not for open nodes; the same for any number of workers, so that the room for nodes is. */
static size_t fixed_memory(void)
{
	return sizeof(struct planner) + (PLAN_WORKERS_MAX + 1) * sizeof(struct workspace) +
	       BATCH * sizeof(struct slot) + STATES_MAX * sizeof(struct state) + sizeof(struct results) +
	       PLAN_MAX * sizeof(struct plan);
}

static int take_memory(struct planner *planner)
{
	bool batches = planner->def.scheme == SCHEME_BATCH;
	int workers = planner->def.workers + !batches; /* the manager works along where a search needs batches */
	size_t bytes = planner->def.memory - fixed_memory();
	planner->work = calloc((size_t)workers, sizeof *planner->work);
	planner->slot = calloc(BATCH, sizeof *planner->slot);
	planner->task.state = calloc(STATES_MAX, sizeof *planner->task.state);
	planner->results = calloc(1, sizeof *planner->results);
	planner->plan = calloc(PLAN_MAX, sizeof *planner->plan);
	if (!planner->work || !planner->slot || !planner->task.state || !planner->results || !planner->plan)
		return -ENOMEM;
	int rc = frontier_init(&planner->frontier, bytes);
	if (rc == 0)
		rc = pool_create(&planner->pool, workers);
	if (rc == 0 && !batches)
		rc = crew_create(&planner->crew, planner, bytes);
	if (rc == 0 && planner->def.profile.ranking == RANK_VALUE)
		rc = value_create(&planner->value, planner->def.table, &planner->def.model, planner->pool, workers);
	return rc;
}

/* What the search takes for granted of a profile; false for NaN, too. */
static bool profile_is_valid(const struct cost_profile *p)
{
	const double not_negative[] = {p->w_distance,	p->w_angle,	p->w_balls,	  p->w_rails,
				       p->ball_cost,	p->rail_cost,	p->w_points,	  p->w_speed,
				       p->w_simulation, p->clearance,	p->cue_clearance, p->cue_room,
				       p->error.angle,	p->error.speed, p->error.tip,	  p->error.elevation};
	bool valid = p->max_cut > 0 && p->max_cut <= M_PI / 2 && p->max_speed > 0 && p->max_speed <= SHOT_SPEED_MAX &&
		     p->pocket_speed > 0 && isfinite(p->pocket_speed) && p->speed_step > 0 && p->aims >= 1 &&
		     p->aims <= AIMS_MAX - 1;
	for (size_t i = 0; i < sizeof not_negative / sizeof not_negative[0]; i++)
		valid &= not_negative[i] >= 0 && isfinite(not_negative[i]);
	return valid;
}

static bool def_is_valid(const struct planner_def *def)
{
	bool windows = def->sync_window > 0 && (def->workers + 1) * def->sync_window <= def->sync_period;
	return def->table && profile_is_valid(&def->profile) && def->workers >= 1 && def->workers <= PLAN_WORKERS_MAX &&
	       def->memory > fixed_memory() && def->scheme >= SCHEME_BATCH && def->scheme < SCHEME_COUNT &&
	       (def->scheme != SCHEME_WINDOWS || (windows && def->now));
}

int planner_create(struct planner **out, const struct planner_def *def)
{
	*out = NULL;
	if (!def_is_valid(def))
		return -EINVAL;
	struct planner *planner = calloc(1, sizeof *planner);
	if (!planner)
		return -ENOMEM;
	planner->def = *def;
	planner->budget = (struct budget){.now = def->now, .now_context = def->now_context};
	mirrors_init(&planner->mirrors, def->table);
	planner->task = (struct task){.def = &planner->def, .mirrors = &planner->mirrors, .budget = &planner->budget};
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
	value_destroy(planner->value);
	pool_destroy(planner->pool);
	crew_destroy(planner->crew);
	frontier_finish(&planner->frontier);
	free(planner->work);
	free(planner->slot);
	free(planner->task.state);
	free(planner->results);
	free(planner->plan);
	free(planner);
}

void planner_cancel(struct planner *planner, uint64_t run)
{
	budget_cancel(&planner->budget, run);
}

/* At most limit of them. True when more are to be worked on. */
static bool run_batches(struct planner *planner, int limit, plan_progress_fn *progress, void *context,
			struct plan_result *result)
{
	bool improved, more = true;
	show_begin(planner);
	for (int i = 0; i < limit && (more = search_step(planner, &improved)); i++) {
		show_step(planner);
		if (improved && progress) {
			planner_export(planner, planner->def.progress_plans, result);
			progress(context, result);
		}
	}
	planner->overflow |= planner->frontier.overflow;
	show_end(planner);
	return more;
}

static void search(struct planner *planner, plan_progress_fn *progress, void *context, struct plan_result *result)
{
	double budget = planner->task.request->budget.seconds, begin = budget > 0 ? budget_now(&planner->budget) : 0;
	double share = 1;
	if (planner->value)
		share = CHAIN_SHARE;
	else if (planner->def.profile.ranking == RANK_SUCCESS)
		share -= RANKING_SHARE;
	else if (planner->task.request->tolerances > 0)
		share -= TOLERANCE_SHARE;
	planner->budget.deadline = budget > 0 ? begin + share * budget : INFINITY;
	search_begin(planner);
	/* An easy question is answered before any worker is woken. */
	bool crewed = planner->crew && planner->task.request->budget.nodes == 0;
	if (run_batches(planner, crewed ? FIRST_SLICE : INT_MAX, progress, context, result) && crewed)
		crew_run(planner->crew, progress, context, result);
	if (!results_have_pot(planner->results))
		safety_find(planner, true);
	planner->budget.deadline = budget > 0 ? begin + budget : INFINITY;
	if (planner->value)
		worth_run(planner, progress, context, result);
	else
		rank_solutions(planner);
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
	planner->request = *request;
	if (planner->value) { /* a visit is a plan of one shot: what follows is in its value */
		planner->request.depth = 1;
		planner->request.budget.nodes = (uint64_t)ceil(CHAIN_SHARE * (double)request->budget.nodes);
	}
	planner->nodes_wanted = request->budget.nodes;
	planner->task.request = &planner->request;
	planner->budget.run = request->run;
	search(planner, progress, context, result);
	bool cancelled = budget_is_cancelled(&planner->budget);
	int plans = cancelled ? planner->def.progress_plans : planner->def.result_plans;
	if (planner->value && worth_has_results(planner))
		worth_export(planner, plans, result);
	else
		planner_export(planner, plans, result);
	planner->task.request = NULL;
	if (!cancelled)
		return 0;
	result->status = PLAN_CANCELLED;
	return -ECANCELED;
}
