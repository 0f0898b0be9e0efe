/* What a pocket takes: measured once per table and model with the simulator, and kept. */
#ifndef BILLIARD_SEARCH_ACCEPTANCE_H
#define BILLIARD_SEARCH_ACCEPTANCE_H

#include "physics/sim.h"

enum { ACCEPT_ANGLES = 33, ACCEPT_SPEEDS = 3 };

/* Ways that fall: straight lines past the pocket's centre, at a distance of low to high to the left of it (m, seen along
 * the way). Empty when high <= low. */
struct acceptance_window {
	double low, high;
};

struct acceptance {
	struct acceptance_window window[POCKET_MAX][ACCEPT_SPEEDS][ACCEPT_ANGLES];
};

/* Rolls balls at every pocket; some 20 000 simulations of one ball. */
void acceptance_measure(struct acceptance *acceptance, const struct table *table, const struct model *model);

/* The window for a ball that comes in direction way (unit) at about speed m/s. */
struct acceptance_window acceptance_at(const struct acceptance *acceptance, const struct table *table, int pocket,
				       vec2 way, double speed);

#endif
