/* The open nodes of the search, best first, in fixed memory. */
#ifndef BILLIARD_SEARCH_FRONTIER_H
#define BILLIARD_SEARCH_FRONTIER_H

#include <stddef.h>

#include "search/candidate.h"

/* Equal costs leave in the order in which they came: the order is total. */
struct frontier_entry {
	double cost;
	uint32_t order, slot;
};

struct frontier {
	struct node *node;	     /* owned, capacity */
	struct frontier_entry *heap; /* owned, capacity */
	uint32_t *free_slot;	     /* owned, capacity */
	uint32_t capacity, count, order;
	bool overflow; /* a node had to be dropped */
};

/* Takes at most that many bytes. 0, -EINVAL (no room for a single node) or -ENOMEM. */
int frontier_init(struct frontier *frontier, size_t bytes);
void frontier_finish(struct frontier *frontier);
void frontier_clear(struct frontier *frontier);
/* When full, the new node takes the place of a worse one among the last or is dropped; overflow is set either way. */
void frontier_push(struct frontier *frontier, const struct node *node);
/* Takes the best out. Precondition (asserted): count > 0. */
struct node frontier_pop(struct frontier *frontier);
/* Cost of the best, INFINITY when empty. */
double frontier_best(const struct frontier *frontier);

#endif
