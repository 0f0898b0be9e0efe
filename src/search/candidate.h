/* The candidate search: chains of balls, built backwards from a pocket (thesis 4.6.1). Pure functions on caller's
 * memory. */
#ifndef BILLIARD_SEARCH_CANDIDATE_H
#define BILLIARD_SEARCH_CANDIDATE_H

#include "search/cost.h"
#include "search/geometry.h"

/* An aim for balls that lie on a cushion: along it. */
enum { AIM_ALONG = 100 };

/* A chain of balls that is open at its near end: chain[0] is to fall, chain[chain_count - 1] must get to know who
 * strikes it. Complete when that is the cue ball: then angle and start_speed hold. */
struct node {
	double cost;	    /* of the shots before and of the search so far: the order of the search */
	double search_cost; /* of this shot so far, K of 4.32 summed */
	double carry;	    /* distance cost of the first leg of the near ball */
	double speed;	    /* m/s, start speed that the near ball needs; at a root the speed wanted at the pocket */
	vec2 to;	    /* where the centre of the next ball must go: pocket or place of contact */
	vec2 after;	    /* unit: way of the struck ball; at a root out through the pocket */
	double angle;	    /* rad, of the complete chain */
	uint32_t state;	    /* index of the position it belongs to */
	int16_t pocket;
	int8_t aim; /* 0 the middle of the pocket, +-1, ... points to either side, or AIM_ALONG */
	uint16_t sequence[PLAN_CHAIN_MAX]; /* of each ball's way */
	int8_t chain[PLAN_CHAIN_MAX];
	uint8_t chain_count, rails;
	bool complete;
};

/* What all expansions of one position share. All borrowed. */
struct scene {
	const struct table *table;
	const struct mirrors *mirrors;
	const struct cost_profile *profile;
	const struct ball *ball;
	int count, cue;
	uint32_t on;	  /* bit per ball: may be struck first */
	uint32_t wanted;  /* bit per ball: may be the one to fall */
	bool named;	  /* the ball that is to fall must be struck first: a colour after a red */
	int rails, balls; /* limits as in the request */
};

enum { EXPAND_MAX = BALL_MAX * SEQUENCE_MAX };

/* The root of one pocket, aimed at a point of it: 0 its middle, up to +-(profile.aims - 1) / 2, or AIM_ALONG. */
struct node candidate_root(const struct scene *scene, int pocket, int aim);

/* All chains that are one ball longer, best effort in no order; at most capacity. Returns how many; *overflow is set
 * when more were there. */
int candidate_expand(const struct scene *scene, const struct node *node, struct node *child, int capacity,
		     bool *overflow);

/* Where each ball of a chain must go (place of contact, for chain[0] the pocket), and over how many cushions. False when
 * a way at the very end of a nose is, by rounding, none any more. */
struct goal {
	vec2 point;
	int rails;
};
bool candidate_goals(const struct scene *scene, const struct node *node, struct goal goal[PLAN_CHAIN_MAX]);

/* Start speed for an end speed after a leg (4.33), in the form that the profile asks for. rolling: it comes off a
 * cushion. */
double candidate_leg_backward(const struct scene *scene, double v_end, double way, bool rolling);

#endif
