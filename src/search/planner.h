/* A planner's memory: what it is made of, and what belongs to the running search. */
#ifndef BILLIARD_SEARCH_PLANNER_H
#define BILLIARD_SEARCH_PLANNER_H

#include "search/frontier.h"
#include "search/pool.h"
#include "search/solutions.h"
#include "search/value.h"

enum { BATCH = 32 /* nodes worked on at a time: never depends on the number of workers, so that results do not */ };

/* What planner_figures() shows of batches. Written by the thread that runs the search. */
struct shown {
	_Atomic uint64_t nodes, sims;
	_Atomic uint32_t open;
	atomic_int busy, depth;
	uint64_t nodes_before, sims_before;
};

struct crew;

struct planner {
	struct planner_def def;
	struct mirrors mirrors;
	struct budget budget;
	struct pool *pool;
	struct workspace *work;	 /* one a worker */
	struct slot *slot;	 /* BATCH */
	uint8_t claim[BATCH];	 /* slots in the order in which workers take them */
	struct results *results; /* one */
	struct plan *plan;	 /* PLAN_MAX, what results point to */
	struct frontier frontier;
	struct crew *crew;	    /* NULL for SCHEME_BATCH */
	struct value_search *value; /* NULL unless the profile ranks by value */
	struct shown shown;

	/* of the running search */
	struct plan_request request; /* what the search for chains is asked for */
	uint64_t nodes_wanted;	     /* the whole budget: chains may take a share of it */
	struct task task;
	int state_count, batch_count;
	uint64_t count[COUNT_KINDS];
	bool overflow, cut; /* something was dropped; ended before its time */
};

#endif
