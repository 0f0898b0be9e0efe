/* The other way round: play every direction forward and see what falls. An independent judge of what the search finds.
 */
#ifndef BILLIARD_TESTS_BRUTE_FORCE_H
#define BILLIARD_TESTS_BRUTE_FORCE_H

#include "search/plan.h"

struct brute_fan {
	int angles;	 /* round the clock */
	double speed[8]; /* m/s */
	int speed_count;
};

struct brute_result {
	uint8_t pots[BALL_MAX]; /* bit per pocket: the ball falls there, struck by the cue ball or by one ball between,
				   no cushion met, cue ball left */
	double angle[BALL_MAX][POCKET_MAX]; /* rad, one shot that does it */
	double speed[BALL_MAX][POCKET_MAX]; /* m/s */
	long sims;
};

/* Only pockets count to which the ball's straight way is free by clearance (m). */
void brute_force(const struct table *table, const struct model *model, const struct ball *ball, int count,
		 const struct brute_fan *fan, double clearance, struct brute_result *result);

/* The thesis' cost without what keeps it from finding all: every cut, no clearance, no cue, points across pockets. */
struct cost_profile brute_profile(void);

#endif
