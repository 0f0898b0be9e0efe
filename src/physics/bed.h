/* A bed that is not level: its height, and how balls move on it. Pure functions.
 * Gravity pulls the centre of a ball with -g grad h along the bed (slopes are small: first order in them). Sliding, it
 * acts on the centre alone; rolling, 2/7 of it goes into the turning (a solid sphere), so 5/7 are felt. The pull bends a
 * path that would be straight or a parabola, and there is no closed form. A phase is therefore cut into pieces: in each
 * the path is a parabola from the true place at its begin to the true place at its end, nowhere farther than
 * bed.path_error from the true path between; velocity and spin are the true ones at every time. "True" is a Runge-Kutta
 * step of order 4 over the piece, whose own error is far smaller. */
#ifndef BILLIARD_PHYSICS_BED_H
#define BILLIARD_PHYSICS_BED_H

#include "physics/table.h"

/* One piece of a sliding or rolling ball's path, from the ball's present state on. */
struct bed_piece {
	vec2 acceleration; /* m/s^2, of the parabola */
	double duration;   /* s */
	bool last;	   /* its end is the phase's */
};

/* m, height of the bed at a place over that at its middle. */
double bed_height(const struct bed *bed, vec2 pos);

/* The present piece of a ball that slides or rolls on an uneven bed. */
struct bed_piece bed_piece(const struct ball *ball, const struct table *table);

/* Gives *to the velocity and the spin about x and y that *from has dt >= 0 later, within its piece. The place is the
 * parabola's. */
void bed_turn(const struct ball *from, const struct table *table, double dt, struct ball *to);

/* Range check of table_finish(): a ball must come to rest wherever it lies. */
bool bed_holds(const struct table *table);

#endif
