/* Sequences of shots that were found: the best of one kind, and all kinds together. */
#ifndef BILLIARD_SEARCH_SOLUTIONS_H
#define BILLIARD_SEARCH_SOLUTIONS_H

#include "search/slot.h"

enum { SAFETY_LIST = PLAN_SHOTS_MAX /* place of the contact shot among the lists */ };

/* A sequence of shots: all but the last are found by going up from state. */
struct solution {
	double cost;
	uint64_t key; /* decides among equal costs: the same whatever was found first */
	int32_t state;
	struct record last;
};

struct solutions {
	struct solution item[PLAN_MAX];
	uint16_t order[PLAN_MAX]; /* indices of items, best first */
	int count, limit;
};

/* The sequence that ends with record, played from a state. */
struct solution solution_make(const struct task *task, int32_t state, const struct record *record);
/* Makes the position after it state index of the tree. */
void solution_open(const struct solution *solution, const struct task *task, int index,
		   const struct rules_outcome *outcome);
/* Sorted insertion; false when it is not among the limit best. */
bool solutions_add(struct solutions *solutions, const struct solution *solution);
/* The rank-th best. */
struct solution *solutions_at(struct solutions *solutions, int rank);

/* By number of shots, and at SAFETY_LIST the contact shot. */
struct results {
	struct solutions list[PLAN_SHOTS_MAX + 1];
	int depth; /* shots wanted */
};

/* Empties all lists; limit is how many sequences each may hold. */
void results_clear(struct results *results, int depth, int limit);

/* One played shot as a sequence: the one rule by which batches and crews take in what a worker has found. */
struct finding {
	struct solution solution;
	int shots;     /* the list it belongs to; the request's depth also when nothing is left to play for */
	bool leads_on; /* a next shot may follow */
};
/* Also notes that the ball falls there. From any worker. */
struct finding finding_make(const struct task *task, int32_t state, const struct played *played);
/* True when it is the best of all now. */
bool results_add(struct results *results, const struct solution *solution, int shots);
/* The list of the longest sequences that there are, else the contact shot; NULL when there is neither. */
struct solutions *results_best(struct results *results);
/* A pot was found. */
bool results_have_pot(struct results *results);
/* Cost up to which a sequence is wanted. */
double results_limit(struct results *results);

#endif
