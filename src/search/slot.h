/* Work on one node: it is expanded, or, when complete, played at its start speeds. */
#ifndef BILLIARD_SEARCH_SLOT_H
#define BILLIARD_SEARCH_SLOT_H

#include "search/state.h"

enum {
	SPEEDS_MAX = 32,    /* start speeds of one chain */
	CHILDREN_MAX = 2048 /* of one expansion */
};

/* What a search counts. */
enum { COUNT_NODES, COUNT_SIMS, COUNT_TRIED, COUNT_LANDED, COUNT_REFINED, COUNT_KINDS };

/* What the simulation made of a complete node at one start speed. */
struct played {
	struct record record;
	struct rules_outcome outcome;
};

/* A node and what came out of it; written by one worker. */
struct slot {
	struct node node;
	struct node child[CHILDREN_MAX];
	int child_count;
	struct played played[SPEEDS_MAX];
	int played_count;
	uint64_t count[COUNT_KINDS];
	bool overflow;
};

/* Works on slot->node; does nothing when the search is over. */
void slot_work(const struct task *task, struct slot *slot, struct workspace *work);

#endif
