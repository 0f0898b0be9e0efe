#include "search/solutions.h"

#include <string.h>

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

struct solution solution_make(const struct task *task, int32_t state, const struct record *record)
{
	const struct state *from = &task->state[state];
	uint64_t key = mix(mix(mix(from->key, record->hash), bits(record->shot.angle)), bits(record->shot.speed));
	key = mix(mix(key, (uint64_t)(record->target + 1)), (uint64_t)(record->pocket + 1));
	for (int i = 0; i < record->chain_count; i++)
		key = mix(key, (uint64_t)(record->chain[i] + 1));
	return (struct solution){from->cost + record->cost, key, state, *record};
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

void solution_open(const struct solution *solution, const struct task *task, int index,
		   const struct rules_outcome *outcome)
{
	struct state *state = &task->state[index];
	*state = (struct state){
		.rules = outcome->next,
		.record = solution->last,
		.parent = solution->state,
		.shots = task->state[solution->state].shots + 1,
		.cost = solution->cost,
		.key = solution->key,
	};
	for (int i = 0; i < task->ball_count; i++)
		state->ball[i] = outcome->ball[i];
}

struct finding finding_make(const struct task *task, int32_t state, const struct played *played)
{
	struct state *from = &task->state[state];
	atomic_fetch_or_explicit(&from->landed[played->record.target], (uint8_t)(1u << played->record.pocket),
				 memory_order_relaxed);
	int depth = task->request->depth, shots = from->shots + 1;
	bool last = shots == depth || state_is_cleared(&played->outcome, task->ball_count);
	return (struct finding){
		.solution = solution_make(task, state, &played->record),
		.shots = last ? depth : shots,
		.leads_on = !last,
	};
}

void results_clear(struct results *results, int depth, int limit)
{
	results->depth = depth;
	for (int i = 0; i <= SAFETY_LIST; i++) {
		results->list[i].count = 0;
		results->list[i].limit = i == SAFETY_LIST ? 1 : limit;
	}
}

bool results_add(struct results *results, const struct solution *solution, int shots)
{
	struct solutions *list = &results->list[shots - 1];
	return solutions_add(list, solution) && list == results_best(results) &&
	       solutions_at(list, 0)->key == solution->key;
}

struct solutions *results_best(struct results *results)
{
	for (int shots = results->depth; shots >= 1; shots--)
		if (results->list[shots - 1].count > 0)
			return &results->list[shots - 1];
	return results->list[SAFETY_LIST].count > 0 ? &results->list[SAFETY_LIST] : NULL;
}

bool results_have_pot(struct results *results)
{
	struct solutions *best = results_best(results);
	return best && best != &results->list[SAFETY_LIST];
}

double results_limit(struct results *results)
{
	struct solutions *full = &results->list[results->depth - 1];
	return full->count == full->limit ? solutions_at(full, full->count - 1)->cost : INFINITY;
}
