/* The question the player asks: what should I play, so that I score most, given how I play? Shots are opened into
 * speeds and tip places, aimed against the simulation, and valued by the expected points of the visit, less what the
 * opponent may expect, over samples of the player's error. Common random numbers; sequential halving shares the samples
 * out (Karnin, Koren, Somekh 2013): few for the many, many for the few. */
#ifndef BILLIARD_SEARCH_VALUE_H
#define BILLIARD_SEARCH_VALUE_H

#include "search/estimate.h"
#include "search/pool.h"
#include "search/shot.h"

enum { VALUE_ROOTS_MAX = 16, VALUE_RESULTS = 64 };

/* A position to play from: the one on the table, or one of several with the cue ball placed in the D. */
struct value_root {
	const struct ball *ball; /* borrowed */
	struct rules_state rules;
	uint32_t wanted; /* bit per ball: may be the one meant to fall */
	int index;	 /* the caller's name of it */
};

struct value_request {
	struct value_root root[VALUE_ROOTS_MAX];
	int root_count, ball_count, cue;
	double max_speed; /* m/s */
	uint64_t sims;	  /* how many simulations the whole may take: what is done is shared out by it */
};

/* A stroke and what is known of it. */
struct stroke {
	struct record record; /* shot, target (-1: a contact only), pocket, chain */
	int root;	      /* index into the request's roots */
	int opening;	      /* which direct pot it is aimed at; -1: none, it was found otherwise */
	double value;	      /* points */
	double chance;	      /* of the pot; of a legal contact when there is no target */
	double sum;	      /* of the samples' values */
	int samples, good;    /* taken; of them legal and as meant */
	int left;	      /* place at which it left the race for samples; 0: it has not */
	int plies;	      /* 0: the end is estimated; 1: the next shot is searched */
	vec2 leave;	      /* m, mean place of the cue ball at the end of good samples */
	double leave_radius;  /* m, of the circle around leave that holds half of them */
	uint32_t key;	      /* order among equals: the same at any number of workers */
};

struct value_search;

/* All memory is taken here. workers: of the pool. 0, -ENOMEM; *out is NULL on failure. The table is borrowed. */
int value_create(struct value_search **out, const struct table *table, const struct model *model, struct pool *pool,
		 int workers);
void value_destroy(struct value_search *value); /* NULL is fine */

/* Another player. Cheap when the error is the same as before. */
void value_set_error(struct value_search *value, const struct player_error *error);

/* What the search asks while it runs. Both may be NULL. */
struct value_hooks {
	bool (*is_over)(void *context);	 /* true: end soon with what there is; from any worker */
	void (*improved)(void *context); /* another stroke leads; from the caller's thread */
	void *context;
};

/* Adds a shot that another search has found (over cushions, over balls): valued with the rest. Between value_begin and
 * value_run. */
void value_begin(struct value_search *value, const struct value_request *request);
void value_add(struct value_search *value, int root, const struct record *record);

/* Values shots; the results are ready in order afterwards, and also inside hooks->improved. */
void value_run(struct value_search *value, const struct value_hooks *hooks);

/* The rank-th best stroke; NULL beyond the last. Its record carries the exact outcome (potted, points, foul, hash). */
const struct stroke *value_result(const struct value_search *value, int rank);
/* The caller's name of a root. */
int value_root_index(const struct value_search *value, int root);
/* What the search believes of table, model and player. */
const struct estimator *value_estimator(const struct value_search *value);
/* Simulations made since value_begin. */
uint64_t value_sims(const struct value_search *value);

#endif
