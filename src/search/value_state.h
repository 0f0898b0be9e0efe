/* The inside of a value search: what its files share. */
#ifndef BILLIARD_SEARCH_VALUE_STATE_H
#define BILLIARD_SEARCH_VALUE_STATE_H

#include <stdatomic.h>

#include "search/stroke.h"
#include "search/value.h"

enum {
	VALUE_POTS = 32,     /* pots that are opened into strokes */
	VALUE_PER_POT = 10,  /* strokes kept of each */
	VALUE_ADDED = 64,    /* shots that the caller has found */
	VALUE_SAFETIES = 48, /* contact shots kept */
	VALUE_REFINED = 48,  /* neighbours of the leaders */
	VALUE_STROKES = VALUE_POTS * VALUE_PER_POT + VALUE_ADDED + VALUE_SAFETIES + VALUE_REFINED,
	VALUE_SAMPLES = 512, /* points of the player's error */
	FAN = 1440,	     /* directions that are looked into */
	FAN_DIRECTIONS = 480 /* and of these played */
};

/* A pot of one of the roots, to be opened. */
struct opening {
	struct pot pot;
	int root;
};

struct value_worker {
	struct workspace work;
	uint64_t sims;
};

/* Contact shots in many directions: the two best of each. */
struct fan {
	struct value_search *value;
	double angle[FAN];
	int count;
	struct stroke best[FAN_DIRECTIONS][2];
};

struct value_search {
	const struct table *table;
	struct model model;
	struct pool *pool;
	int workers;
	struct value_worker *worker;
	struct estimator estimator;
	struct deviate point[VALUE_SAMPLES];

	/* of the running search */
	struct value_request request;
	const struct value_hooks *hooks;
	struct opening opening[VALUE_POTS];
	int opening_count;
	int grid; /* how finely pots are opened, an index into the grids */
	struct stroke stroke[VALUE_STROKES];
	int stroke_count;
	uint16_t order[VALUE_STROKES]; /* indices of strokes, best first */
	struct fan fan;
	int to_sample; /* of the running round: samples that each stroke shall have */
	bool deep;     /* of the running round: next shots are searched */
	int first;     /* of the running round: index of the first stroke of a range, -1: by order */
};

bool value_is_over(const struct value_search *value);

/* Plays a stroke as meant from its root: fills the record's outcome. False when the simulation finds no end. */
bool value_play(struct value_search *value, struct value_worker *worker, int root, struct record *record,
		struct rules_outcome *outcome);

/* Points of a played stroke and of what follows, to the striker. deep: the next shot is searched, not estimated. */
double value_of_outcome(struct value_search *value, struct value_worker *worker, const struct record *record,
			const struct rules_outcome *outcome, bool deep);

/* Finds the pots of all roots and opens them into strokes. */
void value_open(struct value_search *value);
/* One stroke of that speed and tip at a pot: aimed, played as meant, its end estimated. False when it is none. opening is
 * one of value->opening. */
bool value_try(struct value_search *value, struct value_worker *worker, const struct opening *opening,
	       const struct shot *shot, struct stroke *out);
/* Finds contact shots whose leave costs the opponent most. */
void value_find_safeties(struct value_search *value);
/* Sequential halving over the strokes that there are, then the second ply for those that lead. */
void value_race(struct value_search *value);

/* Orders strokes: best value first, then by key. */
void value_sort(struct value_search *value);

/* The best value that a stroke at one of the best pots promises: the second ply. */
double value_next_shot(struct value_search *value, struct value_worker *worker, const struct setting *from);

#endif
