#include "search/pool.h"

#include <assert.h>
#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "search/plan.h"

struct pool_thread {
	struct pool *pool;
	pthread_t thread;
	int worker;
};

/* A round is one pool_for(). Threads sleep between rounds; items are claimed by an atomic counter. */
struct pool {
	pthread_mutex_t lock;
	pthread_cond_t begin, end;
	uint64_t round; /* under lock, as are running and stop */
	int running;	/* threads still in this round */
	bool stop;
	atomic_int next; /* item to claim */
	int count;	 /* of this round; written under lock before it begins */
	pool_fn *fn;
	void *context;
	int thread_count; /* without the caller */
	struct pool_thread thread[PLAN_WORKERS_MAX];
};

static void work(struct pool *pool, int worker)
{
	int item;
	while ((item = atomic_fetch_add_explicit(&pool->next, 1, memory_order_relaxed)) < pool->count)
		pool->fn(pool->context, item, worker);
}

static void *thread_main(void *arg)
{
	struct pool_thread *self = arg;
	struct pool *pool = self->pool;
	uint64_t done = 0;
	pthread_mutex_lock(&pool->lock);
	for (;;) {
		while (!pool->stop && pool->round == done)
			pthread_cond_wait(&pool->begin, &pool->lock);
		if (pool->stop)
			break;
		done = pool->round;
		pthread_mutex_unlock(&pool->lock);
		work(pool, self->worker);
		pthread_mutex_lock(&pool->lock);
		if (--pool->running == 0)
			pthread_cond_signal(&pool->end);
	}
	pthread_mutex_unlock(&pool->lock);
	return NULL;
}

int pool_create(struct pool **out, int workers)
{
	*out = NULL;
	if (workers < 1 || workers > PLAN_WORKERS_MAX + 1)
		return -EINVAL;
	struct pool *pool = calloc(1, sizeof *pool);
	if (!pool)
		return -ENOMEM;
	pthread_mutex_init(&pool->lock, NULL);
	pthread_cond_init(&pool->begin, NULL);
	pthread_cond_init(&pool->end, NULL);
	for (int i = 0; i < workers - 1; i++) {
		struct pool_thread *t = &pool->thread[i];
		t->pool = pool;
		t->worker = i + 1;
		if (pthread_create(&t->thread, NULL, thread_main, t) != 0) {
			pool_destroy(pool);
			return -EAGAIN;
		}
		pool->thread_count++;
	}
	*out = pool;
	return 0;
}

void pool_destroy(struct pool *pool)
{
	if (!pool)
		return;
	pthread_mutex_lock(&pool->lock);
	pool->stop = true;
	pthread_cond_broadcast(&pool->begin);
	pthread_mutex_unlock(&pool->lock);
	for (int i = 0; i < pool->thread_count; i++)
		pthread_join(pool->thread[i].thread, NULL);
	pthread_cond_destroy(&pool->begin);
	pthread_cond_destroy(&pool->end);
	pthread_mutex_destroy(&pool->lock);
	free(pool);
}

void pool_begin(struct pool *pool, int count, pool_fn *fn, void *context)
{
	assert(pool->thread_count > 0);
	pthread_mutex_lock(&pool->lock);
	pool->fn = fn;
	pool->context = context;
	pool->count = count;
	atomic_store_explicit(&pool->next, 0, memory_order_relaxed);
	pool->running = pool->thread_count;
	pool->round++;
	pthread_cond_broadcast(&pool->begin);
	pthread_mutex_unlock(&pool->lock);
}

void pool_end(struct pool *pool)
{
	pthread_mutex_lock(&pool->lock);
	while (pool->running > 0)
		pthread_cond_wait(&pool->end, &pool->lock);
	pthread_mutex_unlock(&pool->lock);
}

void pool_for(struct pool *pool, int count, pool_fn *fn, void *context)
{
	assert(count >= 0);
	if (pool->thread_count == 0 || count <= 1) {
		for (int i = 0; i < count; i++)
			fn(context, i, 0);
		return;
	}
	pool_begin(pool, count, fn, context);
	work(pool, 0);
	pool_end(pool);
}
