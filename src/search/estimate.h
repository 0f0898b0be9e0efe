/* What a position is worth to the player whose turn it is, without a simulation: the chance of each pot by geometry,
 * and what may follow it. Unit: points, his minus the opponent's. Pure functions; allocate nothing. */
#ifndef BILLIARD_SEARCH_ESTIMATE_H
#define BILLIARD_SEARCH_ESTIMATE_H

#include "search/acceptance.h"
#include "search/player_error.h"
#include "search/shot.h"

enum { POTS_MAX = 64 };

/* What all estimates of one table, model and player share. Read-only after estimator_init(). */
struct estimator {
	const struct table *table; /* borrowed */
	struct player_error error;
	struct acceptance acceptance;
	double flow;		/* chance that a shot of a visit under way succeeds, 0..1 */
	double going_on[4][16]; /* expected points of a visit under way, by enum rules_on and reds on the table */
};

/* Measures the acceptance of the pockets and, on random positions with a fixed seed, how often this player finds a good
 * pot (flow). Some 10 ms. */
void estimator_init(struct estimator *estimator, const struct table *table, const struct model *model,
		    const struct player_error *error);

/* The same table and model, another player. */
void estimator_set_error(struct estimator *estimator, const struct player_error *error);

/* A direct pot. */
struct pot {
	int16_t ball, pocket;
	vec2 way;      /* unit, of the object ball into the pocket */
	vec2 goal;     /* m, the point of the pocket that it is sent to: the middle of what falls */
	double angle;  /* rad, of the cue ball */
	double gain;   /* how many times an error of the aim is larger as an error of the object ball's direction */
	double half;   /* rad, half width of the object ball's directions that fall */
	double chance; /* 0..1 */
	double brings; /* points, its own and what may follow */
	double costs;  /* points, of a miss */
	double value;  /* points: chance * brings - (1 - chance) * costs */
};

/* The chance that a normal error of sigma, off by bias, stays within +-half. */
double within_chance(double half, double bias, double sigma);

/* rad, 1 sigma of the cue ball's direction with what an error of the tip adds. */
double aim_sigma(const struct player_error *error);

/* The pots there are with a chance of at least least, best value first; at most POTS_MAX. */
int estimate_pots(const struct estimator *estimator, const struct setting *from, double least,
		  struct pot pot[POTS_MAX]);

/* Value of the position to the player at the table. In hand: the best of some places in the D. */
double estimate_value(const struct estimator *estimator, const struct setting *from);

#endif
