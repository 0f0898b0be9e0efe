/* The best sequences found so far. */
#include <string.h>

#include "search/planner.h"

struct solution *solutions_at(struct solutions *solutions, int rank)
{
	return &solutions->item[solutions->order[rank]];
}

bool solutions_add(struct solutions *solutions, const struct solution *solution)
{
	int at = solutions->count;
	while (at > 0 && solution->cost < solutions_at(solutions, at - 1)->cost)
		at--;
	if (at == solutions->limit)
		return false;
	int slot = solutions->count;
	if (solutions->count < solutions->limit)
		solutions->count++;
	else
		slot = solutions->order[solutions->count - 1];	/* the worst one goes */
	memmove(&solutions->order[at + 1], &solutions->order[at], (size_t)(solutions->count - 1 - at) * sizeof solutions->order[0]);
	solutions->order[at] = (uint16_t)slot;
	solutions->item[slot] = *solution;
	return true;
}
