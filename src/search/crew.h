/* Workers that go their own way until the search ends, unlike batches: what the schemes of sharing have in common. */
#ifndef BILLIARD_SEARCH_CREW_H
#define BILLIARD_SEARCH_CREW_H

#include <pthread.h>

#include "search/planner.h"

enum {
	FOUND_MAX = 64, /* results a worker keeps before it must hand them over */
	INBOX_MAX = 512 /* nodes of one answer to a worker */
};

struct crew;

/* One worker. Written by itself alone but for what stands under crew->lock. */
struct worker {
	struct frontier open; /* its own nodes: windows; under queue_lock: stealing */
	pthread_mutex_t queue_lock;
	_Atomic uint32_t open_count;
	struct solution found[FOUND_MAX];
	uint8_t found_shots[FOUND_MAX]; /* which list it belongs to */
	int found_count;
	double window;			     /* s, when its next one begins */
	_Atomic uint64_t count[COUNT_KINDS]; /* since the beginning, as are those below */
	uint64_t before[COUNT_KINDS];	     /* this search */
	_Atomic uint64_t held, missed, late, blocked, on_demand;
	_Atomic double waited;

	struct node inbox[INBOX_MAX]; /* under crew->lock */
	atomic_int inbox_count;	      /* written under it */
	bool asks;		      /* under crew->lock: it has nothing to do */
};

/* A scheme: how open nodes get to workers. */
struct share {
	/* Deals out the first nodes, which are in planner->frontier. */
	void (*begin)(struct crew *crew);
	/* The worker's next node. Sleeps while others may still find some. False: the search is over. */
	bool (*take)(struct crew *crew, struct worker *worker, struct node *out);
	/* Takes in what a worker has found. */
	void (*give)(struct crew *crew, struct worker *worker, const struct node *node, int count);
	/* The manager's part, called under the lock when serve_due is set. NULL: none. */
	void (*serve)(struct crew *crew);
	bool keeps_results; /* until it hands over; but for a new best one */
};
extern const struct share share_windows, share_queue, share_steal;

struct crew {
	struct planner *planner;
	const struct share *share;
	int worker_count;
	struct worker *worker; /* owned */
	_Atomic double limit;  /* cost up to which a sequence is wanted */
	_Atomic double best;   /* cost of the best one */
	atomic_int state_count;
	atomic_int dry; /* workers that have nothing to do; written under lock */
	atomic_bool over, overflow;

	pthread_mutex_t lock; /* of all below, of the results in planner and, but for stealing, of planner->frontier */
	pthread_cond_t work, news; /* for workers; for the manager */
	bool improved, serve_due, cut;
	uint64_t slice[COUNT_KINDS]; /* done before the crew began */
	int finished;		     /* workers that are done */

	/* windows */
	double start;		   /* s, when this search began */
	_Atomic double next_serve; /* s, when the manager's next window begins */
	bool serve_all;		   /* under lock: serve every worker, not only those that have nothing */
	atomic_bool relief;	   /* a worker has nothing and neither has the manager: who has some gives at once */
	atomic_bool handing_over;  /* one has its window */
};

/* 0, -ENOMEM; *out is NULL on failure. planner is borrowed and must have its pool with a thread for each worker. */
int crew_create(struct crew **out, struct planner *planner, size_t bytes);
void crew_destroy(struct crew *crew); /* NULL is fine */

/* Searches from what search_begin() has set up until nothing is left or it is cut short. The caller is the manager. */
void crew_run(struct crew *crew, plan_progress_fn *progress, void *context, struct plan_result *result);

void crew_figures(const struct crew *crew, struct plan_figures *out);

/* For the schemes. The first three under the lock. */
void crew_report(struct crew *crew, struct worker *worker); /* hands its results over */
void crew_end(struct crew *crew);
/* Sleeps until the others have found something. any (may be NULL) says whether they have. False: the search is over, or
 * just ended because nobody has anything. */
bool crew_wait(struct crew *crew, struct worker *worker, bool (*any)(const struct crew *crew));
/* True, and everybody knows, when the search is over. */
bool crew_is_over(struct crew *crew);
/* Takes the best out of a queue; false when it is empty or holds only what is not wanted any more (which is dropped).
 */
bool crew_pop(struct crew *crew, struct frontier *open, struct node *out);

static inline void count_up(_Atomic uint64_t *counter, uint64_t by)
{
	atomic_store_explicit(counter, atomic_load_explicit(counter, memory_order_relaxed) + by, memory_order_relaxed);
}

#endif
