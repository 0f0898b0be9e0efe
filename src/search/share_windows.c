/* The thesis' scheme (4.7): each worker goes on with nodes of its own; once in a period k, in its own window of length
 * n, it hands its results and the best of its open nodes to the manager, who deals all that it has out again (algorithm
 * 5). Worker i's window begins at k + i n. The manager's follows the last worker's (in figure 4.47 it comes first: then
 * what was handed over would lie idle for a whole period).
 *
 * Windows are for sharing the work of long searches. Who has nothing asks at once, and when the manager has nothing
 * either, whoever has some gives at once: counted apart, as on demand. */
#include <math.h>

#include "search/crew.h"

enum { HAND_OVER_MAX = 128 };
static const double HAND_OVER_SHARE = 0.6; /* of the open nodes, as the thesis' program */

static void begin(struct crew *crew)
{
	const struct planner_def *def = &crew->planner->def;
	struct frontier *all = &crew->planner->frontier;
	double k = def->now ? def->sync_period : INFINITY, n = def->sync_window;
	for (int at = 0; all->count > 0; at = (at + 1) % crew->worker_count) {
		struct node node = frontier_pop(all);
		frontier_push(&crew->worker[at].open, &node);
	}
	for (int i = 0; i < crew->worker_count; i++)
		crew->worker[i].window = crew->start + k + i * n;
	atomic_store(&crew->next_serve, crew->start + k + crew->worker_count * n);
	crew->serve_all = false;
	atomic_store(&crew->relief, false);
	atomic_store(&crew->handing_over, false);
}

static void wake_manager(struct crew *crew)
{
	crew->serve_due = true;
	pthread_cond_signal(&crew->news);
}

/* Gives want of the best nodes; with alternate every second one, so that good ones stay too. Locked by the caller. */
static void hand_over(struct crew *crew, struct worker *worker, int want, bool alternate)
{
	struct frontier *all = &crew->planner->frontier;
	struct node node, kept[HAND_OVER_MAX];
	int kept_count = 0;
	crew_report(crew, worker);
	for (int i = 0; i < want && crew_pop(crew, &worker->open, &node); i++) {
		frontier_push(all, &node);
		if (alternate && crew_pop(crew, &worker->open, &kept[kept_count]))
			kept_count++;
	}
	for (int i = 0; i < kept_count; i++)
		frontier_push(&worker->open, &kept[i]);
}

static int at_most(double count)
{
	return count < HAND_OVER_MAX ? (int)count : HAND_OVER_MAX;
}

static void hold_window(struct crew *crew, struct worker *worker)
{
	if (atomic_exchange(&crew->handing_over, true)) {
		count_up(&worker->blocked, 1);
		return;
	}
	pthread_mutex_lock(&crew->lock);
	hand_over(crew, worker, at_most(HAND_OVER_SHARE * worker->open.count), false);
	pthread_mutex_unlock(&crew->lock);
	atomic_store(&crew->handing_over, false);
	count_up(&worker->held, 1);
}

/* Hands over when the worker's window is open. A window that went by while a node was worked on is missed: the next one
 * counts. */
static void look_at_clock(struct crew *crew, struct worker *worker)
{
	const struct planner_def *def = &crew->planner->def;
	double k = def->sync_period, n = def->sync_window, t = budget_now(&crew->planner->budget);
	if (t >= worker->window) {
		double periods = floor((t - worker->window) / k);
		count_up(&worker->missed, (uint64_t)periods);
		worker->window += periods * k;
		if (t < worker->window + n) {
			hold_window(crew, worker);
			if (budget_now(&crew->planner->budget) > worker->window + n)
				count_up(&worker->late, 1);
		} else {
			count_up(&worker->missed, 1);
		}
		worker->window += k;
	}
	if (t < atomic_load_explicit(&crew->next_serve, memory_order_relaxed))
		return;
	pthread_mutex_lock(&crew->lock);
	double next = atomic_load(&crew->next_serve);
	if (t >= next) {
		atomic_store(&crew->next_serve, next + (floor((t - next) / k) + 1) * k);
		crew->serve_all = true;
		wake_manager(crew);
	}
	pthread_mutex_unlock(&crew->lock);
}

static void relieve(struct crew *crew, struct worker *worker)
{
	if (worker->open.count < 2 || !atomic_exchange(&crew->relief, false))
		return;
	pthread_mutex_lock(&crew->lock);
	hand_over(crew, worker, at_most(worker->open.count / 2), true);
	wake_manager(crew);
	pthread_mutex_unlock(&crew->lock);
	count_up(&worker->on_demand, 1);
}

static void empty_inbox(struct worker *worker)
{
	int count = atomic_load(&worker->inbox_count);
	for (int i = 0; i < count; i++)
		frontier_push(&worker->open, &worker->inbox[i]);
	atomic_store(&worker->inbox_count, 0);
}

static bool nobody_has_any(const struct crew *crew)
{
	bool none = crew->planner->frontier.count == 0 && atomic_load(&crew->dry) == crew->worker_count;
	for (int i = 0; i < crew->worker_count && none; i++)
		none = atomic_load(&crew->worker[i].inbox_count) == 0;
	return none;
}

/* Asks the manager for nodes and waits for them. False: the search is over. */
static bool ask(struct crew *crew, struct worker *worker)
{
	double since = budget_now(&crew->planner->budget);
	pthread_mutex_lock(&crew->lock);
	crew_report(crew, worker);
	worker->asks = true;
	atomic_fetch_add(&crew->dry, 1);
	while (!atomic_load(&crew->over) && atomic_load(&worker->inbox_count) == 0) {
		if (crew->planner->frontier.count > 0) {
			wake_manager(crew);
		} else if (nobody_has_any(crew)) {
			crew_end(crew);
			break;
		} else {
			atomic_store(&crew->relief, true);
		}
		pthread_cond_wait(&crew->work, &crew->lock);
	}
	atomic_fetch_sub(&crew->dry, 1);
	worker->asks = false;
	empty_inbox(worker);
	pthread_mutex_unlock(&crew->lock);
	atomic_store(&worker->waited, atomic_load(&worker->waited) + budget_now(&crew->planner->budget) - since);
	return !atomic_load(&crew->over);
}

static bool take(struct crew *crew, struct worker *worker, struct node *out)
{
	while (!crew_is_over(crew)) {
		look_at_clock(crew, worker);
		if (atomic_load_explicit(&crew->relief, memory_order_relaxed))
			relieve(crew, worker);
		if (atomic_load_explicit(&worker->inbox_count, memory_order_relaxed) > 0) {
			pthread_mutex_lock(&crew->lock);
			empty_inbox(worker);
			pthread_mutex_unlock(&crew->lock);
		}
		atomic_store_explicit(&worker->open_count, worker->open.count, memory_order_relaxed);
		if (crew_pop(crew, &worker->open, out))
			return true;
		if (!ask(crew, worker))
			return false;
	}
	return false;
}

static void give(struct crew *crew, struct worker *worker, const struct node *node, int count)
{
	(void)crew;
	for (int i = 0; i < count; i++)
		frontier_push(&worker->open, &node[i]);
}

/* Algorithm 5: the best node to the first request, the second best to the second, and so on round-robin. */
static void serve(struct crew *crew)
{
	struct frontier *all = &crew->planner->frontier;
	struct worker *request[PLAN_WORKERS_MAX];
	int count = 0, at = 0;
	struct node node;
	for (int i = 0; i < crew->worker_count; i++) {
		struct worker *worker = &crew->worker[i];
		if ((crew->serve_all || worker->asks) && atomic_load(&worker->inbox_count) < INBOX_MAX)
			request[count++] = worker;
	}
	crew->serve_all = false;
	while (count > 0 && crew_pop(crew, all, &node)) {
		struct worker *worker = request[at];
		int place = atomic_load(&worker->inbox_count);
		worker->inbox[place] = node;
		atomic_store(&worker->inbox_count, place + 1);
		if (place + 1 == INBOX_MAX)
			request[at] = request[--count];
		else
			at++;
		at = at >= count ? 0 : at;
	}
	if (atomic_load(&crew->dry) > 0)
		pthread_cond_broadcast(&crew->work);
}

const struct share share_windows = {.begin = begin, .take = take, .give = give, .serve = serve, .keeps_results = true};
