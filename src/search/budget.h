/* Who may stop a search, and when. */
#ifndef BILLIARD_SEARCH_BUDGET_H
#define BILLIARD_SEARCH_BUDGET_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

struct budget {
	double (*now)(void *context); /* s, monotonic; NULL: no clock, no deadline */
	void *now_context;
	_Atomic uint64_t cancelled; /* runs up to this number are */
	uint64_t run;		    /* number of the running search; 0: it cannot be cancelled */
	double deadline;	    /* s on that clock */
};

/* s; 0 without a clock. */
double budget_now(const struct budget *budget);

/* From any thread: runs 1 to run are cancelled. */
void budget_cancel(struct budget *budget, uint64_t run);
bool budget_is_cancelled(const struct budget *budget);

/* True when cancelled or out of time. */
bool budget_is_over(const struct budget *budget);

#endif
