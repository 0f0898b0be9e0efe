/* Backward functions of the search (thesis 4.6.2): the speed before a leg or a contact from the speed wanted after it.
 * All speeds m/s >= 0, lengths m >= 0. */
#ifndef BILLIARD_PHYSICS_INVERSE_H
#define BILLIARD_PHYSICS_INVERSE_H

#include "physics/table.h"

/* A ball struck or hit without spin: slides, then rolls. The start speed that leaves v_end after a way; both branches of
 * errata 4.33 (rolling and still sliding arrival). */
double leg_backward(const struct table *table, double v_end, double way);

/* The same for a ball that already rolls at the start. */
double leg_rolling_backward(const struct table *table, double v_end, double way);

/* Ball on resting ball, thesis model (8.113): speed of the hitting ball that gives the struck one u at a cut angle with
 * cosine cos_cut in (0, 1]. What rounding makes more than 1 counts as 1; at a cosine of 0 nothing is handed on, and no
 * speed is enough (INFINITY). */
double hit_backward(const struct table *table, double u, double cos_cut);

/* Cushion, thesis model (4.63 with the errata). */
double cushion_backward(const struct table *table, double u);

#endif
