#include "search/stroke.h"

enum { STEPS = 6, EVENTS = 12 };
static const double GOOD = 2e-4;     /* m beside the goal that is good enough */
static const double PROBE = 1e-4;    /* rad, first step of the secant when the slope is unknown */
static const double ARRIVAL = 0.12;  /* m/s, least speed at the pocket */
static const double TURN_MAX = 0.12; /* rad, further than that from geometry it is another shot */

/* The object ball's velocity just after the cue ball has met it. False when it is not met first. */
static bool object_velocity(const struct estimator *e, const struct model *model, const struct ball pair[2],
			    const struct shot *shot, vec2 *out)
{
	struct sim sim;
	struct event event;
	sim_init(&sim, e->table, model, pair, 2);
	sim_strike(&sim, 0, shot);
	for (int i = 0; i < EVENTS && sim_step(&sim, &event); i++) {
		if (event.kind == EVENT_BALL_BALL) {
			*out = sim.ball[1].vel;
			return true;
		}
		if (event.kind == EVENT_CUSHION || event.kind == EVENT_JAW || event.kind == EVENT_POCKET)
			return false;
	}
	return false;
}

/* Speed of a ball that slides off and then rolls far, at the end of its way; 0 when it stops before. */
static double arrival(const struct estimator *e, double speed, double far)
{
	const struct material *m = &e->table->material;
	double rolling = 5.0 / 7 * speed;
	double left = rolling * rolling - 2 * m->mu_roll * m->gravity * far;
	return left > 0 ? sqrt(left) : 0;
}

/* Where the pocket wants the ball that comes with this velocity. */
static bool find_goal(const struct estimator *e, const struct ball *object, const struct pot *pot, double speed,
		      vec2 *goal, double *half)
{
	vec2 centre = e->table->pocket[pot->pocket].centre;
	double far = vec2_dist(object->pos, pot->goal), end = arrival(e, speed, far);
	if (end < ARRIVAL)
		return false;
	struct acceptance_window w = acceptance_at(&e->acceptance, e->table, pot->pocket, pot->way, end);
	if (w.high <= w.low)
		return false;
	*goal = vec2_madd(centre, (w.low + w.high) / 2, vec2_perp(pot->way));
	*half = atan2((w.high - w.low) / 2, vec2_dist(object->pos, *goal));
	return true;
}

bool stroke_aim(const struct estimator *e, const struct model *model, const struct ball *cue, const struct ball *object,
		const struct pot *pot, struct aimed *aimed)
{
	const struct ball pair[2] = {*cue, *object};
	double slope = -pot->gain, last_miss = 0, last_angle = 0, half = 0;
	aimed->shot.angle = pot->angle + shot_squirt(e->table, aimed->shot.side);
	for (int i = 0; i < STEPS; i++) {
		vec2 vel, goal;
		if (!object_velocity(e, model, pair, &aimed->shot, &vel) ||
		    !find_goal(e, object, pot, vec2_norm(vel), &goal, &half))
			return false;
		vec2 want = vec2_sub(goal, object->pos);
		double miss = atan2(vec2_cross(want, vel), vec2_dot(want, vel));
		if (i > 0 && fabs(aimed->shot.angle - last_angle) > 1e-9)
			slope = (miss - last_miss) / (aimed->shot.angle - last_angle);
		if (fabs(miss) * vec2_norm(want) < GOOD && i > 0) {
			aimed->gain = fabs(slope);
			double sigma = aimed->gain * aim_sigma(&e->error);
			aimed->chance = within_chance(half, aimed->gain * e->error.angle_bias, sigma);
			return true;
		}
		last_miss = miss;
		last_angle = aimed->shot.angle;
		double step = slope != 0 ? -miss / slope : PROBE;
		if (i == 0 && fabs(step) < PROBE)
			step = copysign(PROBE, step);
		aimed->shot.angle += fmax(-0.03, fmin(0.03, step));
		if (fabs(aimed->shot.angle - pot->angle) > TURN_MAX)
			return false;
	}
	return false;
}
