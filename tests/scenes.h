/* Tables and positions that tests and benches share. */
#ifndef BILLIARD_TESTS_SCENES_H
#define BILLIARD_TESTS_SCENES_H

#include "physics/table.h"

/* The thesis' table: 1881 x 943 mm, six pockets, 18 cushion segments, its constants. Finished. */
struct table scene_thesis_table(void);
/* A 12-ft snooker table, 3569 x 1778 mm, with rounded jaws. Finished. */
struct table scene_snooker_table(void);
/* Four main rails around a bed of that size, no pockets. Finished. */
struct table scene_box_table(double length, double width);

enum { SCENE_RACK_COUNT = 22 };
/* All 22 balls as at the start of a frame (reds touching), the cue ball first, in the D. */
void scene_rack(const struct table *table, struct ball ball[SCENE_RACK_COUNT]);

#endif
