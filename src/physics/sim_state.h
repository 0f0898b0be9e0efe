/* The inside of struct sim: public only so that callers can hold one. Use the functions of sim.h. */
#ifndef BILLIARD_PHYSICS_SIM_STATE_H
#define BILLIARD_PHYSICS_SIM_STATE_H

#include <stdint.h>

#include "physics/event.h"
#include "physics/model.h"
#include "physics/table.h"

struct sim {
	const struct table *table;	/* borrowed */
	struct model model;
	double time;			/* s */
	int ball_count;
	int event_count;
	struct ball ball[BALL_MAX];	/* at its own last event */
	double ball_time[BALL_MAX];	/* s, when that was */
};

#endif
