#include "search/crew.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "search/export.h"

static_assert(BATCH - PLAN_WORKERS_MAX + 0 >= 0, "every worker has a slot of its own");
static_assert(FOUND_MAX - SPEEDS_MAX + 0 >= 0, "the results of one node fit");

/* ---- life -----------------------------------------------------------------------------------------------------------
 */

static const struct share *share_of(enum plan_scheme scheme)
{
	switch (scheme) {
	case SCHEME_WINDOWS:
		return &share_windows;
	case SCHEME_STEAL:
		return &share_steal;
	default:
		return &share_queue;
	}
}

int crew_create(struct crew **out, struct planner *planner, size_t bytes)
{
	*out = NULL;
	struct crew *crew = calloc(1, sizeof *crew);
	if (!crew)
		return -ENOMEM;
	crew->planner = planner;
	crew->share = share_of(planner->def.scheme);
	crew->worker_count = planner->def.workers;
	pthread_mutex_init(&crew->lock, NULL);
	pthread_cond_init(&crew->work, NULL);
	pthread_cond_init(&crew->news, NULL);
	atomic_init(&crew->over, true);
	crew->worker = calloc((size_t)crew->worker_count, sizeof *crew->worker);
	int rc = crew->worker ? 0 : -ENOMEM;
	for (int i = 0; i < crew->worker_count && crew->worker; i++) {
		pthread_mutex_init(&crew->worker[i].queue_lock, NULL);
		if (crew->share != &share_queue && rc == 0)
			rc = frontier_init(&crew->worker[i].open, bytes / (size_t)crew->worker_count);
	}
	if (rc != 0) {
		crew_destroy(crew);
		return rc;
	}
	*out = crew;
	return 0;
}

void crew_destroy(struct crew *crew)
{
	if (!crew)
		return;
	for (int i = 0; i < crew->worker_count && crew->worker; i++) {
		frontier_finish(&crew->worker[i].open);
		pthread_mutex_destroy(&crew->worker[i].queue_lock);
	}
	pthread_cond_destroy(&crew->news);
	pthread_cond_destroy(&crew->work);
	pthread_mutex_destroy(&crew->lock);
	free(crew->worker);
	free(crew);
}

/* ---- for the schemes ------------------------------------------------------------------------------------------------
 */

void crew_end(struct crew *crew)
{
	atomic_store(&crew->over, true);
	pthread_cond_broadcast(&crew->work);
}

bool crew_is_over(struct crew *crew)
{
	if (atomic_load_explicit(&crew->over, memory_order_relaxed))
		return true;
	if (!budget_is_over(&crew->planner->budget))
		return false;
	pthread_mutex_lock(&crew->lock);
	crew->cut = true;
	crew_end(crew);
	pthread_mutex_unlock(&crew->lock);
	return true;
}

bool crew_wait(struct crew *crew, struct worker *worker, bool (*any)(const struct crew *crew))
{
	if (atomic_load(&crew->over))
		return false;
	int dry = atomic_fetch_add(&crew->dry, 1) + 1;
	if (!any || !any(crew)) {
		if (dry == crew->worker_count) {
			crew_end(crew);
		} else {
			double since = budget_now(&crew->planner->budget);
			pthread_cond_wait(&crew->work, &crew->lock);
			atomic_store(&worker->waited,
				     atomic_load(&worker->waited) + budget_now(&crew->planner->budget) - since);
		}
	}
	atomic_fetch_sub(&crew->dry, 1);
	return !atomic_load(&crew->over);
}

bool crew_pop(struct crew *crew, struct frontier *open, struct node *out)
{
	if (open->count == 0)
		return false;
	if (frontier_best(open) > atomic_load_explicit(&crew->limit, memory_order_relaxed)) {
		if (open->overflow)
			atomic_store_explicit(&crew->overflow, true, memory_order_relaxed);
		frontier_clear(open);
		return false;
	}
	*out = frontier_pop(open);
	return true;
}

/* ---- results --------------------------------------------------------------------------------------------------------
 */

void crew_report(struct crew *crew, struct worker *worker)
{
	struct planner *planner = crew->planner;
	for (int i = 0; i < worker->found_count; i++) {
		const struct solution *solution = &worker->found[i];
		if (!results_add(planner->results, solution, worker->found_shots[i]))
			continue;
		crew->improved = true;
		atomic_store_explicit(&crew->best, solution->cost, memory_order_relaxed);
		atomic_store_explicit(&planner->shown.depth, worker->found_shots[i], memory_order_relaxed);
	}
	worker->found_count = 0;
	atomic_store_explicit(&crew->limit, results_limit(planner->results), memory_order_relaxed);
	if (crew->improved)
		pthread_cond_signal(&crew->news);
}

static void report_now(struct crew *crew, struct worker *worker)
{
	pthread_mutex_lock(&crew->lock);
	crew_report(crew, worker);
	pthread_mutex_unlock(&crew->lock);
}

/* An answer that is there never waits for a window. */
static bool must_report(const struct crew *crew, const struct worker *worker)
{
	if (worker->found_count == 0)
		return false;
	if (!crew->share->keeps_results || worker->found_count + SPEEDS_MAX > FOUND_MAX)
		return true;
	double best = atomic_load_explicit(&crew->best, memory_order_relaxed);
	for (int i = 0; i < worker->found_count; i++)
		if (worker->found[i].cost <= best || worker->found_shots[i] == crew->planner->results->depth)
			return true;
	return false;
}

/* ---- one node -------------------------------------------------------------------------------------------------------
 */

/* The position that a shot leads to becomes part of the tree. */
static void open_state(struct crew *crew, struct worker *worker, const struct solution *shot,
		       const struct rules_outcome *outcome)
{
	struct planner *planner = crew->planner;
	int index = atomic_fetch_add_explicit(&crew->state_count, 1, memory_order_relaxed);
	if (index >= STATES_MAX) {
		atomic_store_explicit(&crew->state_count, STATES_MAX, memory_order_relaxed);
		atomic_store_explicit(&crew->overflow, true, memory_order_relaxed);
		return;
	}
	struct node root[ROOTS_MAX];
	solution_open(shot, &planner->task, index, outcome);
	int count = state_roots(&planner->task, index, root);
	crew->share->give(crew, worker, root, count);
}

static void take_in(struct crew *crew, struct worker *worker, const struct slot *slot, const struct played *played)
{
	struct finding finding = finding_make(&crew->planner->task, (int32_t)slot->node.state, played);
	worker->found_shots[worker->found_count] = (uint8_t)finding.shots;
	worker->found[worker->found_count++] = finding.solution;
	if (finding.leads_on && finding.solution.cost <= atomic_load_explicit(&crew->limit, memory_order_relaxed))
		open_state(crew, worker, &finding.solution, &played->outcome);
}

static void take_in_all(struct crew *crew, struct worker *worker, struct slot *slot)
{
	for (int i = 0; i < COUNT_KINDS; i++)
		count_up(&worker->count[i], slot->count[i]);
	if (slot->overflow)
		atomic_store_explicit(&crew->overflow, true, memory_order_relaxed);
	for (int i = 0; i < slot->played_count; i++)
		take_in(crew, worker, slot, &slot->played[i]);
	double limit = atomic_load_explicit(&crew->limit, memory_order_relaxed);
	int wanted = 0;
	for (int i = 0; i < slot->child_count; i++)
		if (slot->child[i].cost <= limit)
			slot->child[wanted++] = slot->child[i];
	if (wanted > 0)
		crew->share->give(crew, worker, slot->child, wanted);
	if (must_report(crew, worker))
		report_now(crew, worker);
}

static void work(void *context, int item, int thread)
{
	(void)thread;
	struct crew *crew = context;
	struct planner *planner = crew->planner;
	struct worker *worker = &crew->worker[item];
	struct slot *slot = &planner->slot[item];
	struct workspace *workspace = &planner->work[item + 1]; /* the first is the manager's */
	while (crew->share->take(crew, worker, &slot->node)) {
		if (state_is_spare(&planner->task, &slot->node))
			continue;
		slot_work(&planner->task, slot, workspace);
		take_in_all(crew, worker, slot);
	}
	pthread_mutex_lock(&crew->lock);
	crew_report(crew, worker);
	crew->finished++;
	pthread_cond_signal(&crew->news);
	pthread_mutex_unlock(&crew->lock);
}

/* ---- the manager ----------------------------------------------------------------------------------------------------
 */

/* Goes on from where the first slice has come. */
static void begin(struct crew *crew)
{
	struct planner *planner = crew->planner;
	bool any = results_have_pot(planner->results);
	atomic_store(&crew->best, any ? solutions_at(results_best(planner->results), 0)->cost : INFINITY);
	atomic_store(&crew->limit, results_limit(planner->results));
	memcpy(crew->slice, planner->count, sizeof crew->slice);
	atomic_store(&crew->state_count, planner->state_count);
	atomic_store(&crew->dry, 0);
	atomic_store(&crew->over, false);
	atomic_store(&crew->overflow, false);
	crew->improved = crew->serve_due = crew->cut = false;
	crew->finished = 0;
	crew->start = budget_now(&planner->budget);
	for (int i = 0; i < crew->worker_count; i++) {
		struct worker *worker = &crew->worker[i];
		frontier_clear(&worker->open);
		atomic_store(&worker->open_count, 0);
		worker->found_count = 0;
		worker->asks = false;
		atomic_store(&worker->inbox_count, 0);
		for (int k = 0; k < COUNT_KINDS; k++)
			worker->before[k] = atomic_load(&worker->count[k]);
	}
	crew->share->begin(crew);
}

static uint64_t sum(const struct crew *crew, int kind)
{
	uint64_t total = 0;
	for (int i = 0; i < crew->worker_count; i++)
		total += atomic_load(&crew->worker[i].count[kind]) - crew->worker[i].before[kind];
	return total;
}

/* What the running search has done so far. */
static void sum_up(struct crew *crew)
{
	struct planner *planner = crew->planner;
	planner->cut = crew->cut;
	for (int i = 0; i < COUNT_KINDS; i++)
		planner->count[i] = crew->slice[i] + sum(crew, i);
}

void crew_run(struct crew *crew, plan_progress_fn *progress, void *context, struct plan_result *result)
{
	struct planner *planner = crew->planner;
	begin(crew);
	pool_begin(planner->pool, crew->worker_count, work, crew);
	pthread_mutex_lock(&crew->lock);
	/* The last improvement is told, too: it may come with the end. */
	while (crew->finished < crew->worker_count || (crew->improved && progress)) {
		if (crew->improved && progress) {
			crew->improved = false;
			sum_up(crew);
			planner_export(planner, planner->def.progress_plans, result);
			result->exhausted = false;
			pthread_mutex_unlock(&crew->lock);
			progress(context, result);
			pthread_mutex_lock(&crew->lock);
		} else if (crew->serve_due) {
			crew->serve_due = false;
			crew->share->serve(crew);
		} else {
			pthread_cond_wait(&crew->news, &crew->lock);
		}
	}
	pthread_mutex_unlock(&crew->lock);
	pool_end(planner->pool);
	sum_up(crew);
	int states = atomic_load(&crew->state_count);
	planner->state_count = states < STATES_MAX ? states : STATES_MAX;
	planner->overflow |= planner->frontier.overflow || atomic_load(&crew->overflow);
	for (int i = 0; i < crew->worker_count; i++)
		planner->overflow |= crew->worker[i].open.overflow;
}

void crew_figures(const struct crew *crew, struct plan_figures *out)
{
	int dry = atomic_load(&crew->dry);
	bool over = atomic_load(&crew->over);
	out->busy += over ? 0 : crew->worker_count - dry;
	for (int i = 0; i < crew->worker_count; i++) {
		const struct worker *worker = &crew->worker[i];
		out->nodes += atomic_load(&worker->count[COUNT_NODES]);
		out->sims += atomic_load(&worker->count[COUNT_SIMS]);
		out->windows_held += atomic_load(&worker->held);
		out->windows_missed += atomic_load(&worker->missed);
		out->windows_late += atomic_load(&worker->late);
		out->windows_blocked += atomic_load(&worker->blocked);
		out->on_demand += atomic_load(&worker->on_demand);
		out->waited += atomic_load(&worker->waited);
		out->open += over ? 0 : atomic_load(&worker->open_count);
	}
}
