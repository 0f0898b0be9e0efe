/* One queue for all, under the lock. */
#include "search/crew.h"

static void begin(struct crew *crew)
{
	(void)crew; /* the first nodes are where they belong */
}

static bool take(struct crew *crew, struct worker *worker, struct node *out)
{
	if (crew_is_over(crew))
		return false;
	struct planner *planner = crew->planner;
	bool taken = false;
	pthread_mutex_lock(&crew->lock);
	while (!(taken = crew_pop(crew, &planner->frontier, out)))
		if (!crew_wait(crew, worker, NULL))
			break;
	atomic_store_explicit(&worker->open_count, planner->frontier.count / (uint32_t)crew->worker_count,
			      memory_order_relaxed);
	pthread_mutex_unlock(&crew->lock);
	return taken;
}

static void give(struct crew *crew, struct worker *worker, const struct node *node, int count)
{
	(void)worker;
	pthread_mutex_lock(&crew->lock);
	for (int i = 0; i < count; i++)
		frontier_push(&crew->planner->frontier, &node[i]);
	if (atomic_load(&crew->dry) > 0)
		pthread_cond_broadcast(&crew->work);
	pthread_mutex_unlock(&crew->lock);
}

const struct share share_queue = {.begin = begin, .take = take, .give = give};
