/* A plain event simulation to measure others by: every step looks at every pair, no queue, no culling. Compiled twice
 * from one source: in double with a polynomial solver of the caller's choice, and in long double with roots bracketed
 * by the roots of the derivatives, which is the reference. */
#ifndef BILLIARD_BENCH_PLAIN_SIM_H
#define BILLIARD_BENCH_PLAIN_SIM_H

#include "physics/event.h"
#include "physics/model.h"
#include "physics/table.h"

/* Earliest time in (0, horizon] at which c[0] + c[1] t + ... falls through zero, INFINITY if there is none. */
struct plain_solver {
	double (*entry)(const double c[5], double horizon, double tolerance);
	double tolerance;
};

struct plain_event {
	struct event event;
	vec2 pos[2]; /* of the ball and, for BALL_BALL, of the other; m */
};

/* Fills log with at most capacity events of balls in motion, until all rest; returns how many. No thesis motion. */
int plain_run(const struct table *table, const struct model *model, const struct ball *ball, int count,
	      const struct plain_solver *solver, struct plain_event *log, int capacity);

/* The reference; solver is not used. Contacts are resolved in double, in coordinates of the contact. */
int plain_run_long(const struct table *table, const struct model *model, const struct ball *ball, int count,
		   const struct plain_solver *solver, struct plain_event *log, int capacity);

#endif
