/* When the next contact comes. Pure functions of balls in closed-form motion. */
#ifndef BILLIARD_PHYSICS_PREDICT_H
#define BILLIARD_PHYSICS_PREDICT_H

#include "physics/event.h"
#include "physics/model.h"
#include "physics/table.h"

/* What the search for contacts cost: equations solved, and cases settled without one. */
struct solve_count {
	uint64_t quartic;   /* both balls or a curved path */
	uint64_t quadratic; /* straight paths, equal accelerations, cushions */
	uint64_t linear;    /* cushions, no acceleration across them */
	uint64_t culled;    /* out of reach, moving apart, at rest */
};

/* A ball's motion in its present phase, from the time `begin`. */
struct motion {
	vec2 acceleration; /* m/s^2 */
	double begin, end; /* s; end INFINITY at rest */
	double reach;	   /* m; no point of the path is farther from the start */
	double speed;	   /* m/s at begin */
	enum event_kind end_kind;
	bool straight; /* the path is a straight line */
};

/* A ball, given at motion->begin, and how it goes on from there. */
struct mover {
	const struct ball *ball;
	const struct motion *motion;
};

/* What every prediction is made with. */
struct predictor {
	const struct table *table;
	const struct model *model;
	struct solve_count *count; /* counted on */
};

/* Motion of a ball from now on. */
struct motion predict_motion(const struct table *table, const struct ball *ball, double now);

/* Contact time of two balls at or after now (>= both begins), INFINITY if none within their phases. On a contact grid
 * (model->contact_grid) a contact comes early, never late. */
double predict_pair(const struct predictor *by, const struct mover *a, const struct mover *b, double now);

/* The first thing that happens to ball number index by itself: end of its phase, cushion, jaw or pocket. Time INFINITY
 * and EVENT_NONE for a ball at rest. */
struct event predict_own(const struct predictor *by, const struct mover *mover, int index);

/* Unit normal of a cushion on the ball's side. */
vec2 predict_cushion_normal(const struct cushion *cushion, vec2 pos);

#endif
