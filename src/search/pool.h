/* A pool of worker threads for independent items. One worker means no thread at all. */
#ifndef BILLIARD_SEARCH_POOL_H
#define BILLIARD_SEARCH_POOL_H

/* Called once per item; worker is 0..workers - 1, never the same for two calls at a time. */
typedef void pool_fn(void *context, int item, int worker);

struct pool;
/* workers, the caller among them: 1..PLAN_WORKERS_MAX + 1. 0, -EINVAL, -ENOMEM or -EAGAIN (no thread to be had); *out
 * is NULL on failure. Caller destroys. */
int pool_create(struct pool **out, int workers);
void pool_destroy(struct pool *pool); /* NULL is fine */

/* Calls fn for items 0..count - 1, each once, in any order and on any worker; the caller is worker 0 and returns when
 * all are done. What the items wrote is visible to the caller then. From one thread at a time. */
void pool_for(struct pool *pool, int count, pool_fn *fn, void *context);

/* The same in two halves, for a caller that has other things to do in between: items are worked on by the pool's own
 * threads alone, on any of them: a fast one may take two. */
void pool_begin(struct pool *pool, int count, pool_fn *fn, void *context);
void pool_end(struct pool *pool);

#endif
