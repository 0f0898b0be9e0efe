/* Which shot is drawn on the table, as somebody sees it who knows the plans. Pure. */
#ifndef BILLIARD_APP_DRAWN_SHOT_H
#define BILLIARD_APP_DRAWN_SHOT_H

#include "lcmtypes/billiard_animation_t.h"
#include "lcmtypes/billiard_plan_t.h"
#include "physics/sim.h"

enum { DRAWN_PLANS = 6 };

/* About 1 MB. Begins as {0}. */
struct drawn_shot {
	billiard_plan_t plan[DRAWN_PLANS]; /* a ring */
	int64_t count;
};

/* Remembers a checked plan that holds a shot. */
void drawn_shot_plan(struct drawn_shot *drawn, const billiard_plan_t *plan);
/* The shot of the proposal with that id: the one whose cue ball the animation moves, of all entries of all answers to it; without an
 * animation of that id the best of the newest answer. False when no answer to it is known. */
bool drawn_shot_find(const struct drawn_shot *drawn, int64_t id, const billiard_animation_t *animation,
		     struct shot *out);

#endif
