/* How a player errs: what he does is what he means plus a normal deviate of each quantity. */
#ifndef BILLIARD_SEARCH_PLAYER_ERROR_H
#define BILLIARD_SEARCH_PLAYER_ERROR_H

#include "physics/sim.h"

/* 1 sigma and mean (bias) of each. Computer-pool tournaments play with 0.125 degrees, 0.075 m/s, 0.5 mm of the tip and
 * 0.1 degrees of elevation (Archibald, Altman, Shoham 2009). */
struct player_error {
	double angle, angle_bias;	    /* rad, of the direction; bias counter-clockwise */
	double speed, speed_bias;	    /* share of the speed */
	double tip, side_bias, follow_bias; /* share of the radius; one sigma for both ways of the tip */
	double elevation, elevation_bias;   /* rad */
};

enum { ERROR_DIMENSIONS = 5 };

/* Standard normal deviates of one stroke: direction, speed, side, follow, elevation. */
struct deviate {
	double z[ERROR_DIMENSIONS];
};

/* The first count points of Sobol's sequence (1967; directions of Joe and Kuo 2008) in Gray code order, with a random
 * digital shift, as normal deviates. The same points for every shot: common random numbers. Any 2^k points from the first
 * on lie one in each 2^k-th of every dimension: a few do for means what many random ones would. */
void player_error_points(struct deviate *point, int count, uint64_t seed);

/* The stroke that comes of a meant shot. Kept within what a strike can be: speed in (0, SHOT_SPEED_MAX], tip within
 * 0.9 of the radius, elevation in [0, 80 degrees]. */
struct shot player_error_apply(const struct player_error *error, const struct shot *shot, const struct deviate *d);

/* Inverse of the standard normal distribution for 0 < p < 1; |relative error| < 1.2e-9 (Acklam 2003). */
double normal_quantile(double p);

#endif
