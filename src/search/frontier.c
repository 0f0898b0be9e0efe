#include "search/frontier.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>

int frontier_init(struct frontier *frontier, size_t bytes)
{
	size_t each = sizeof(struct node) + sizeof(struct frontier_entry) + sizeof(uint32_t);
	size_t capacity = bytes / each;
	*frontier = (struct frontier){.capacity = capacity > 1u << 24 ? 1u << 24 : (uint32_t)capacity};
	if (capacity == 0)
		return -EINVAL;
	frontier->node = calloc(frontier->capacity, sizeof *frontier->node);
	frontier->heap = calloc(frontier->capacity, sizeof *frontier->heap);
	frontier->free_slot = calloc(frontier->capacity, sizeof *frontier->free_slot);
	if (!frontier->node || !frontier->heap || !frontier->free_slot) {
		frontier_finish(frontier);
		return -ENOMEM;
	}
	for (uint32_t i = 0; i < frontier->capacity; i++)
		frontier->free_slot[i] = i;
	return 0;
}

void frontier_finish(struct frontier *frontier)
{
	free(frontier->node);
	free(frontier->heap);
	free(frontier->free_slot);
	*frontier = (struct frontier){.capacity = 0};
}

/* Slots are handed out from the free list: free_slot[count..] are free. */
void frontier_clear(struct frontier *frontier)
{
	for (uint32_t i = 0; i < frontier->count; i++)
		frontier->free_slot[i] = frontier->heap[i].slot;
	frontier->count = 0;
	frontier->order = 0;
	frontier->overflow = false;
}

static bool before(const struct frontier_entry *a, const struct frontier_entry *b)
{
	return a->cost != b->cost ? a->cost < b->cost : a->order < b->order;
}

static void sift_up(struct frontier *frontier, uint32_t at, struct frontier_entry entry)
{
	while (at > 0) {
		uint32_t parent = (at - 1) / 2;
		if (!before(&entry, &frontier->heap[parent]))
			break;
		frontier->heap[at] = frontier->heap[parent];
		at = parent;
	}
	frontier->heap[at] = entry;
}

static void sift_down(struct frontier *frontier, struct frontier_entry entry)
{
	uint32_t at = 0;
	for (;;) {
		uint32_t child = 2 * at + 1;
		if (child >= frontier->count)
			break;
		if (child + 1 < frontier->count && before(&frontier->heap[child + 1], &frontier->heap[child]))
			child++;
		if (!before(&frontier->heap[child], &entry))
			break;
		frontier->heap[at] = frontier->heap[child];
		at = child;
	}
	frontier->heap[at] = entry;
}

void frontier_push(struct frontier *frontier, const struct node *node)
{
	struct frontier_entry entry = {node->cost, frontier->order++, 0};
	if (frontier->count == frontier->capacity) {
		frontier->overflow = true;
		const struct frontier_entry *last = &frontier->heap[frontier->count - 1];
		if (!before(&entry, last))
			return;
		entry.slot = last->slot;
		frontier->count--;
	} else {
		entry.slot = frontier->free_slot[frontier->count];
	}
	frontier->node[entry.slot] = *node;
	sift_up(frontier, frontier->count++, entry);
}

struct node frontier_pop(struct frontier *frontier)
{
	assert(frontier->count > 0);
	struct frontier_entry best = frontier->heap[0];
	struct frontier_entry last = frontier->heap[--frontier->count];
	frontier->free_slot[frontier->count] = best.slot;
	if (frontier->count > 0)
		sift_down(frontier, last);
	return frontier->node[best.slot];
}

double frontier_best(const struct frontier *frontier)
{
	return frontier->count > 0 ? frontier->heap[0].cost : INFINITY;
}
