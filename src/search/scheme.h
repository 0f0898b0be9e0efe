/* Ways in which the workers of a planner share the open nodes of a search. */
#ifndef BILLIARD_SEARCH_SCHEME_H
#define BILLIARD_SEARCH_SCHEME_H

#include <stdbool.h>
#include <stdint.h>

/* An exhaustive search gives the same result in every scheme; one that is cut short by the clock gives what was found
 * by then. A search with a node budget is always worked on in batches: only these are the same at any number of workers
 * and any timing. */
enum plan_scheme {
	SCHEME_BATCH,	/* the best nodes in batches of fixed size, merged in order by the caller, who is worker 0 */
	SCHEME_WINDOWS, /* thesis 4.7: queues of their own, a manager, synchronisation windows */
	SCHEME_QUEUE,	/* one queue under a lock */
	SCHEME_STEAL,	/* queues of their own; who runs dry takes half of another's best */
	SCHEME_COUNT
};

/* "batch", "windows", "queue", "steal". */
const char *scheme_name(enum plan_scheme scheme);
/* False, *out untouched, for any other name. */
bool scheme_from_name(const char *name, enum plan_scheme *out);

/* How the work goes on. Counts are sums since the planner was made. */
struct plan_figures {
	uint64_t nodes, sims;
	uint64_t windows_held;	  /* hand-overs that began in their own window */
	uint64_t windows_missed;  /* windows that went by while their worker was busy with one node */
	uint64_t windows_late;	  /* hand-overs that began in time and ended after their window */
	uint64_t windows_blocked; /* windows in which another's late hand-over still went on: none begins then, so that
				     none overlap */
	uint64_t on_demand; /* nodes given away outside of windows because another worker had none: hand-overs or thefts
			     */
	double waited;	    /* s that workers had nothing to do during searches; 0 without a clock */
	uint32_t open;	    /* nodes now; a snapshot */
	int busy;	    /* workers now */
	int depth;	    /* shots of the longest sequence found by the running or last search */
};

#endif
