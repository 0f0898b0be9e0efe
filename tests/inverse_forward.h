/* What the backward functions of physics/inverse.h undo: the speed after a leg or a contact from the speed before it. All
 * speeds m/s >= 0, lengths m >= 0. */
#ifndef BILLIARD_TESTS_INVERSE_FORWARD_H
#define BILLIARD_TESTS_INVERSE_FORWARD_H

#include "physics/table.h"

/* Speed left after a way, 0 if it stops before: of a ball struck or hit without spin, and of one that rolls. */
double leg_forward(const struct table *table, double v_start, double way);
double leg_rolling_forward(const struct table *table, double v_start, double way);
/* Of the struck ball, cosine of the cut angle within 0..1 but for rounding. */
double hit_forward(const struct table *table, double v, double cos_cut);
/* Off a cushion. */
double cushion_forward(const struct table *table, double v);

#endif
