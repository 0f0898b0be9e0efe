/* A queue for each worker; who has nothing takes every second one of another's best. */
#include "search/crew.h"

enum { STEAL_MAX = 32 };

/* Round-robin, the best first, as algorithm 5 of the thesis does. */
static void begin(struct crew *crew)
{
	struct frontier *all = &crew->planner->frontier;
	for (int at = 0; all->count > 0; at = (at + 1) % crew->worker_count) {
		struct worker *worker = &crew->worker[at];
		struct node node = frontier_pop(all);
		frontier_push(&worker->open, &node);
		atomic_store(&worker->open_count, worker->open.count);
	}
}

static bool pop(struct crew *crew, struct worker *from, struct node *out)
{
	pthread_mutex_lock(&from->queue_lock);
	bool taken = crew_pop(crew, &from->open, out);
	atomic_store(&from->open_count, from->open.count);
	pthread_mutex_unlock(&from->queue_lock);
	return taken;
}

/* Every second one of the victim's best, half of them at most: both go on with good ones. */
static int rob(struct crew *crew, struct worker *victim, struct node loot[STEAL_MAX])
{
	struct node kept[STEAL_MAX];
	int taken = 0, kept_count = 0;
	pthread_mutex_lock(&victim->queue_lock);
	int want = (int)(victim->open.count + 1) / 2;
	while (taken < want && taken < STEAL_MAX && crew_pop(crew, &victim->open, &loot[taken])) {
		taken++;
		if (taken < want && taken < STEAL_MAX && crew_pop(crew, &victim->open, &kept[kept_count]))
			kept_count++;
	}
	for (int i = 0; i < kept_count; i++)
		frontier_push(&victim->open, &kept[i]);
	atomic_store(&victim->open_count, victim->open.count);
	pthread_mutex_unlock(&victim->queue_lock);
	return taken;
}

/* The first is for the thief at once: it cannot be stolen back. */
static bool steal(struct crew *crew, struct worker *thief, struct node *out)
{
	int self = (int)(thief - crew->worker);
	struct node loot[STEAL_MAX];
	int count = 0;
	for (int i = 1; i < crew->worker_count && count == 0; i++) {
		struct worker *victim = &crew->worker[(self + i) % crew->worker_count];
		if (atomic_load(&victim->open_count) > 0)
			count = rob(crew, victim, loot);
	}
	if (count == 0)
		return false;
	count_up(&thief->on_demand, 1);
	*out = loot[0];
	if (count > 1)
		share_steal.give(crew, thief, loot + 1, count - 1);
	return true;
}

static bool any(const struct crew *crew)
{
	for (int i = 0; i < crew->worker_count; i++)
		if (atomic_load(&crew->worker[i].open_count) > 0)
			return true;
	return false;
}

static bool take(struct crew *crew, struct worker *worker, struct node *out)
{
	while (!crew_is_over(crew)) {
		if (pop(crew, worker, out) || steal(crew, worker, out))
			return true;
		pthread_mutex_lock(&crew->lock);
		bool goes_on = crew_wait(crew, worker, any);
		pthread_mutex_unlock(&crew->lock);
		if (!goes_on)
			return false;
	}
	return false;
}

/* A worker that goes to sleep counts itself as dry before it looks at the queues; so either it sees these nodes or is
 * seen here. */
static void give(struct crew *crew, struct worker *worker, const struct node *node, int count)
{
	pthread_mutex_lock(&worker->queue_lock);
	for (int i = 0; i < count; i++)
		frontier_push(&worker->open, &node[i]);
	atomic_store(&worker->open_count, worker->open.count);
	pthread_mutex_unlock(&worker->queue_lock);
	if (atomic_load(&crew->dry) == 0)
		return;
	pthread_mutex_lock(&crew->lock);
	pthread_cond_broadcast(&crew->work);
	pthread_mutex_unlock(&crew->lock);
}

const struct share share_steal = {.begin = begin, .take = take, .give = give};
