#include "physics/motion.h"

#include <assert.h>

#include "physics/bed.h"
#include "physics/tolerances.h"

vec2 motion_slip(const struct ball *ball, double radius)
{
	return (vec2){ball->vel.x - radius * ball->spin[1], ball->vel.y + radius * ball->spin[0]};
}

static bool on_pieces(const struct ball *ball, const struct table *table)
{
	return table->bed.uneven && (ball->phase == BALL_SLIDING || ball->phase == BALL_ROLLING);
}

vec2 motion_acceleration(const struct ball *ball, const struct table *table)
{
	const struct material *m = &table->material;
	if (on_pieces(ball, table))
		return bed_piece(ball, table).acceleration;
	if (ball->phase == BALL_SLIDING)
		return vec2_scale(vec2_unit(motion_slip(ball, table->ball_radius)), -m->mu_slide * m->gravity);
	if (ball->phase == BALL_ROLLING)
		return vec2_scale(vec2_unit(ball->vel), -m->mu_roll * m->gravity);
	return (vec2){0, 0};
}

/* |dw_z/dt|, in every phase: 5 mu_sp g / (2 r^2). */
static double spin_decay(const struct table *table)
{
	const struct material *m = &table->material;
	return 2.5 * m->mu_spin * m->gravity / (table->ball_radius * table->ball_radius);
}

static double piece_end(const struct ball *ball, const struct table *table, enum event_kind *kind)
{
	struct bed_piece piece = bed_piece(ball, table);
	bool spins = fabs(ball->spin[2]) > spin_decay(table) * piece.duration;
	if (!piece.last)
		*kind = EVENT_PIECE;
	else if (ball->phase == BALL_SLIDING)
		*kind = EVENT_SLIDING_ROLLING;
	else
		*kind = spins ? EVENT_ROLLING_SPINNING : EVENT_ROLLING_REST;
	return piece.duration;
}

double motion_phase_end(const struct ball *ball, const struct table *table, enum event_kind *kind)
{
	const struct material *m = &table->material;
	double t;
	if (on_pieces(ball, table))
		return piece_end(ball, table, kind);
	switch (ball->phase) {
	case BALL_SLIDING:
		/* du/dt = -7/2 mu_s g: translation and rotation both act against the slip (8.8) */
		*kind = EVENT_SLIDING_ROLLING;
		return 2 * vec2_norm(motion_slip(ball, table->ball_radius)) / (7 * m->mu_slide * m->gravity);
	case BALL_ROLLING:
		t = vec2_norm(ball->vel) / (m->mu_roll * m->gravity);
		*kind = fabs(ball->spin[2]) > spin_decay(table) * t ? EVENT_ROLLING_SPINNING : EVENT_ROLLING_REST;
		return t;
	case BALL_SPINNING:
		*kind = EVENT_SPINNING_REST;
		return fabs(ball->spin[2]) / spin_decay(table);
	default:
		*kind = EVENT_NONE;
		return INFINITY;
	}
}

static void roll(struct ball *ball, double radius)
{
	ball->spin[0] = -ball->vel.y / radius;
	ball->spin[1] = ball->vel.x / radius;
}

struct ball motion_advance_by(const struct ball *ball, const struct table *table, vec2 acceleration, double dt)
{
	struct ball b = *ball;
	if (b.phase == BALL_REST || b.phase == BALL_POTTED || dt <= 0)
		return b;
	b.pos = vec2_madd(vec2_madd(b.pos, dt, b.vel), 0.5 * dt * dt, acceleration);
	b.vel = vec2_madd(b.vel, dt, acceleration);
	double rest = fabs(b.spin[2]) - spin_decay(table) * dt;
	b.spin[2] = rest > 0 ? copysign(rest, b.spin[2]) : 0;
	if (on_pieces(ball, table)) {
		bed_turn(ball, table, dt, &b);
	} else if (b.phase == BALL_SLIDING) {
		/* the friction that slows the ball by a turns it by 5/(2 r) a */
		double k = 2.5 / table->ball_radius * dt;
		b.spin[0] += k * acceleration.y;
		b.spin[1] -= k * acceleration.x;
	} else if (b.phase == BALL_ROLLING) {
		roll(&b, table->ball_radius);
	}
	return b;
}

struct ball motion_advance(const struct ball *ball, const struct table *table, double dt)
{
	return motion_advance_by(ball, table, motion_acceleration(ball, table), dt);
}

void motion_transition(struct ball *ball, const struct table *table, enum event_kind kind)
{
	switch (kind) {
	case EVENT_PIECE:
		return;
	case EVENT_SLIDING_ROLLING:
		/* what is left of the slip at the end of a last piece goes as the rest went: 2/7 of it off the velocity */
		if (table->bed.uneven)
			ball->vel = vec2_madd(ball->vel, -2.0 / 7, motion_slip(ball, table->ball_radius));
		roll(ball, table->ball_radius);
		ball->phase = BALL_ROLLING;
		if (vec2_norm(ball->vel) >= REST_SPEED)
			return;
		break; /* rolled out to nothing: rests or spins at once */
	case EVENT_ROLLING_SPINNING:
	case EVENT_ROLLING_REST:
	case EVENT_SPINNING_REST:
		break;
	default:
		assert(kind == EVENT_SPINNING_REST);
	}
	ball->vel = (vec2){0, 0};
	ball->spin[0] = ball->spin[1] = 0;
	if (kind == EVENT_ROLLING_REST || kind == EVENT_SPINNING_REST)
		ball->spin[2] = 0;
	ball->phase = ball->spin[2] != 0 ? BALL_SPINNING : BALL_REST;
}

void motion_roll(struct ball *ball, const struct table *table)
{
	roll(ball, table->ball_radius);
	ball->spin[2] = 0;
	ball->phase = vec2_norm(ball->vel) < REST_SPEED ? BALL_REST : BALL_ROLLING;
}

void motion_classify(struct ball *ball, const struct table *table)
{
	double r = table->ball_radius;
	double speed = fabs(ball->vel.x) + fabs(ball->vel.y);
	double slip = vec2_norm(motion_slip(ball, r));
	double rim = r * (fabs(ball->spin[0]) + fabs(ball->spin[1]));
	if (speed < REST_SPEED && rim < REST_SPEED) {
		ball->vel = (vec2){0, 0};
		ball->spin[0] = ball->spin[1] = 0;
		ball->phase = fabs(ball->spin[2]) * r < REST_SPEED ? BALL_REST : BALL_SPINNING;
		if (ball->phase == BALL_REST)
			ball->spin[2] = 0;
	} else {
		ball->phase = slip <= SLIP_ROUNDING * (speed + rim) ? BALL_ROLLING : BALL_SLIDING;
	}
}
