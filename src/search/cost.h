/* The terms of the search cost (thesis 4.20 to 4.32) and of the result (4.100 to 4.104), by name, in the form of the
 * thesis' program where that differs from the text. All are >= 0. */
#ifndef BILLIARD_SEARCH_COST_H
#define BILLIARD_SEARCH_COST_H

#include "search/plan.h"

/* Share of the table's diagonal, squared: way2 is the sum of the squared legs (m^2). */
double cost_distance(const struct table *table, double way2);

/* x = 1 - cos, weighted by the Bezier curve 3 x^2 - 2 x^3 (4.29). 0 straight on, 1 at a right angle. */
double cost_angle(double cos_angle);

/* One way of a ball to its target: legs, cushions, angles on arrival. */
struct cost_way {
	double way2;   /* m^2, sum of the squared legs */
	double carry;  /* distance cost of the first leg of the ball struck by the cue ball; 1 for an object ball's way
			*/
	double angles; /* sum of cost_angle() over target and cushions */
	int rails;
	bool strikes; /* an object ball's way: one more ball is struck */
};
/* 4.32 for one way. */
double cost_search(const struct table *table, const struct cost_profile *profile, const struct cost_way *way);

/* 4.100 to 4.104: result cost for points, start speed (m/s) and search cost; the shot's cost is search_cost plus this.
 */
double cost_result(const struct cost_profile *profile, int points, double speed, double search_cost);

#endif
