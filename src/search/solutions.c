/* The best sequences found so far. */
#include <string.h>

#include "search/planner.h"

struct solution *solutions_at(struct solutions *solutions, int rank)
{
	return &solutions->item[solutions->order[rank]];
}

/* splitmix64's finish. */
static uint64_t mix(uint64_t key, uint64_t value)
{
	uint64_t z = (key ^ value) + 0x9e3779b97f4a7c15u;
	z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
	z = (z ^ z >> 27) * 0x94d049bb133111ebu;
	return z ^ z >> 31;
}

static uint64_t bits(double value)
{
	uint64_t out;
	memcpy(&out, &value, sizeof out);
	return out;
}

struct solution solution_make(const struct planner *planner, uint32_t state, const struct record *record)
{
	const struct state *from = &planner->state[state];
	uint64_t key = mix(mix(mix(from->key, record->hash), bits(record->shot.angle)), bits(record->shot.speed));
	key = mix(mix(key, (uint64_t)(record->target + 1)), (uint64_t)(record->pocket + 1));
	for (int i = 0; i < record->chain_count; i++)
		key = mix(key, (uint64_t)(record->chain[i] + 1));
	return (struct solution){from->cost + record->cost, key, (int32_t)state, *record};
}

static bool before(const struct solution *a, const struct solution *b)
{
	return a->cost != b->cost ? a->cost < b->cost : a->key < b->key;
}

bool solutions_add(struct solutions *solutions, const struct solution *solution)
{
	int at = solutions->count;
	while (at > 0 && before(solution, solutions_at(solutions, at - 1)))
		at--;
	if (at == solutions->limit)
		return false;
	int slot = solutions->count;
	if (solutions->count < solutions->limit)
		solutions->count++;
	else
		slot = solutions->order[solutions->count - 1]; /* the worst one goes */
	memmove(&solutions->order[at + 1], &solutions->order[at],
		(size_t)(solutions->count - 1 - at) * sizeof solutions->order[0]);
	solutions->order[at] = (uint16_t)slot;
	solutions->item[slot] = *solution;
	return true;
}
