/* The inside of struct sim: public only so that callers can hold one. Use the functions of sim.h. */
#ifndef BILLIARD_PHYSICS_SIM_STATE_H
#define BILLIARD_PHYSICS_SIM_STATE_H

#include <stdint.h>

#include "physics/predict.h"
#include "physics/event.h"
#include "physics/model.h"
#include "physics/queue.h"
#include "physics/table.h"

/* Contacts of one instant that are solved together. */
enum { GROUP_MAX = 64 }; /* 22 equal discs have at most 49 contacts */

struct sim {
	const struct table *table; /* borrowed */
	struct model model;
	double time; /* s */
	int ball_count;
	int event_count;
	struct ball ball[BALL_MAX];	/* at its own last event */
	double ball_time[BALL_MAX];	/* s, when that was */
	struct motion motion[BALL_MAX]; /* of the phase that began then */
	struct queue queue;
	struct event pending[GROUP_MAX]; /* already resolved, still to be reported */
	int pending_count, pending_next;
	double instant;		   /* s, of the last contact that advanced time */
	int instant_contacts;	   /* contacts since then */
	struct solve_count solved; /* since sim_init() */
};

#endif
