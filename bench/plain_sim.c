#include "plain_sim.h"

#include <tgmath.h>

#include "physics/contact.h"

#ifndef REAL
#define REAL	       double
#define PLAIN_RUN      plain_run
#define PLAIN_BRACKETS 0
#endif

struct state {
	REAL x[2], v[2], w[3];
	enum ball_phase phase;
};

struct plain {
	const struct table *table;
	const struct model *model;
	const struct plain_solver *solver;
	struct state ball[BALL_MAX];
	int count;
};

/* ---- roots
 * --------------------------------------------------------------------------------------------------------------- */

#if PLAIN_BRACKETS
static REAL value(const REAL c[5], int degree, REAL t)
{
	REAL sum = 0;
	for (int k = degree; k >= 0; k--)
		sum = sum * t + c[k];
	return sum;
}

static REAL bisect(const REAL c[5], int degree, REAL low, REAL high)
{
	bool rises = value(c, degree, low) < 0;
	for (int i = 0; i < 200; i++) {
		REAL middle = (low + high) / 2;
		if (middle <= low || middle >= high)
			break;
		if ((value(c, degree, middle) < 0) == rises)
			low = middle;
		else
			high = middle;
	}
	return (low + high) / 2;
}

/* Sign changes of the polynomial within (0, horizon), in order: between neighbouring ones of its derivative it is
 * monotone. */
static int sign_changes(const REAL c[5], int degree, REAL horizon, REAL root[4])
{
	if (degree < 1)
		return 0;
	REAL slope[5] = {0}, turn[6], end = 0;
	for (int k = 1; k <= degree; k++)
		slope[k - 1] = (REAL)k * c[k];
	int turns = sign_changes(slope, degree - 1, horizon, turn), count = 0;
	turn[turns++] = horizon;
	for (int i = 0; i < turns; i++) {
		if ((value(c, degree, end) < 0) != (value(c, degree, turn[i]) < 0))
			root[count++] = bisect(c, degree, end, turn[i]);
		end = turn[i];
	}
	return count;
}

static REAL entry(const struct plain *plain, const REAL c[5], REAL horizon)
{
	(void)plain;
	REAL root[4], slope[5] = {c[1], 2 * c[2], 3 * c[3], 4 * c[4], 0};
	int count = sign_changes(c, 4, horizon, root);
	for (int i = 0; i < count; i++)
		if (value(slope, 3, root[i]) < 0)
			return root[i];
	return INFINITY;
}
#else
static REAL entry(const struct plain *plain, const REAL c[5], REAL horizon)
{
	return plain->solver->entry(c, horizon, plain->solver->tolerance);
}
#endif

/* ---- motion
 * -------------------------------------------------------------------------------------------------------------- */

static void acceleration(const struct plain *plain, const struct state *b, REAL a[2])
{
	const struct material *m = &plain->table->material;
	REAL r = plain->table->ball_radius;
	REAL u[2] = {b->v[0], b->v[1]}, mu = m->mu_roll;
	a[0] = a[1] = 0;
	if (b->phase == BALL_SLIDING) {
		u[0] -= r * b->w[1];
		u[1] += r * b->w[0];
		mu = m->mu_slide;
	} else if (b->phase != BALL_ROLLING) {
		return;
	}
	REAL size = sqrt(u[0] * u[0] + u[1] * u[1]);
	if (size > 0)
		for (int i = 0; i < 2; i++)
			a[i] = -mu * m->gravity * u[i] / size;
}

static REAL phase_end(const struct plain *plain, const struct state *b, enum event_kind *kind)
{
	const struct material *m = &plain->table->material;
	REAL r = plain->table->ball_radius, g = m->gravity;
	if (b->phase == BALL_SLIDING) {
		REAL u[2] = {b->v[0] - r * b->w[1], b->v[1] + r * b->w[0]};
		*kind = EVENT_SLIDING_ROLLING;
		return 2 * sqrt(u[0] * u[0] + u[1] * u[1]) / (7 * m->mu_slide * g);
	}
	REAL spin = fabs(b->w[2]) * 2 * r * r / (5 * m->mu_spin * g);
	if (b->phase == BALL_ROLLING) {
		REAL roll = sqrt(b->v[0] * b->v[0] + b->v[1] * b->v[1]) / (m->mu_roll * g);
		*kind = spin > roll ? EVENT_ROLLING_SPINNING : EVENT_ROLLING_REST;
		return roll;
	}
	*kind = EVENT_SPINNING_REST;
	return b->phase == BALL_SPINNING ? spin : INFINITY;
}

static void advance(const struct plain *plain, struct state *b, REAL dt)
{
	const struct material *m = &plain->table->material;
	REAL r = plain->table->ball_radius, a[2];
	acceleration(plain, b, a);
	for (int i = 0; i < 2; i++) {
		b->x[i] += dt * (b->v[i] + dt * a[i] / 2);
		b->v[i] += dt * a[i];
	}
	if (b->phase == BALL_SLIDING) {
		b->w[0] += 5 / (2 * r) * a[1] * dt;
		b->w[1] -= 5 / (2 * r) * a[0] * dt;
	} else if (b->phase == BALL_ROLLING) {
		b->w[0] = -b->v[1] / r;
		b->w[1] = b->v[0] / r;
	}
	REAL lost = 5 * m->mu_spin * m->gravity / (2 * r * r) * dt;
	if (b->phase != BALL_POTTED)
		b->w[2] = b->w[2] > 0 ? fmax(b->w[2] - lost, 0) : fmin(b->w[2] + lost, 0);
}

static void end_phase(const struct plain *plain, struct state *b, enum event_kind kind)
{
	REAL r = plain->table->ball_radius;
	b->phase = kind == EVENT_SLIDING_ROLLING    ? BALL_ROLLING
		   : kind == EVENT_ROLLING_SPINNING ? BALL_SPINNING
						    : BALL_REST;
	if (b->phase != BALL_ROLLING)
		b->v[0] = b->v[1] = 0;
	b->w[0] = -b->v[1] / r;
	b->w[1] = b->v[0] / r;
	if (b->phase == BALL_REST)
		b->w[2] = 0;
}

/* ---- contacts
 * ------------------------------------------------------------------------------------------------------------ */

/* Both balls' relative path against a distance; b NULL: a fixed point with a zero velocity. */
static REAL meet(const struct plain *plain, const struct state *a, const struct state *b, const REAL point[2],
		 REAL distance, REAL horizon)
{
	REAL aa[2], ab[2] = {0, 0}, p[2], v[2], q[2];
	acceleration(plain, a, aa);
	if (b)
		acceleration(plain, b, ab);
	for (int i = 0; i < 2; i++) {
		p[i] = (b ? b->x[i] : point[i]) - a->x[i];
		v[i] = (b ? b->v[i] : 0) - a->v[i];
		q[i] = ab[i] - aa[i];
	}
	const REAL c[5] = {p[0] * p[0] + p[1] * p[1] - distance * distance, 2 * (p[0] * v[0] + p[1] * v[1]),
			   v[0] * v[0] + v[1] * v[1] + p[0] * q[0] + p[1] * q[1], v[0] * q[0] + v[1] * q[1],
			   (q[0] * q[0] + q[1] * q[1]) / 4};
	return entry(plain, c, horizon);
}

/* Signed side of the ball's centre, and its distance from the nose line less one radius, as a polynomial of time. */
static REAL meet_cushion(const struct plain *plain, const struct state *b, const struct cushion *cushion, REAL horizon)
{
	REAL a[2], n[2] = {-(REAL)cushion->b.y + cushion->a.y, (REAL)cushion->b.x - cushion->a.x};
	REAL span = sqrt(n[0] * n[0] + n[1] * n[1]), d[2] = {b->x[0] - cushion->a.x, b->x[1] - cushion->a.y};
	acceleration(plain, b, a);
	REAL side = (n[0] * d[0] + n[1] * d[1]) / span < 0 ? -1 : 1;
	REAL c[5] = {0};
	for (int i = 0; i < 2; i++) {
		n[i] *= side / span;
		c[0] += n[i] * d[i];
		c[1] += n[i] * b->v[i];
		c[2] += n[i] * a[i] / 2;
	}
	c[0] -= plain->table->ball_radius;
	REAL t = entry(plain, c, horizon);
	if (!(t < INFINITY))
		return INFINITY;
	REAL along = 0;
	for (int i = 0; i < 2; i++)
		along += (i ? -n[0] : n[1]) * (d[i] + t * (b->v[i] + t * a[i] / 2));
	along *= side;
	return along >= 0 && along <= span ? t : INFINITY;
}

struct next {
	REAL time;
	enum event_kind kind;
	int ball, other;
};

static void consider(struct next *best, REAL time, enum event_kind kind, int ball, int other)
{
	if (time < best->time)
		*best = (struct next){time, kind, ball, other};
}

static void look_at_ball(const struct plain *plain, int i, struct next *best)
{
	const struct table *t = plain->table;
	const struct state *b = &plain->ball[i];
	enum event_kind kind;
	REAL end = phase_end(plain, b, &kind);
	consider(best, end, kind, i, -1);
	if (b->phase != BALL_SLIDING && b->phase != BALL_ROLLING)
		return;
	for (int k = 0; k < t->cushion_count; k++)
		if (plain->model->pocket != POCKET_MODEL_NONE || t->cushion[k].main_rail)
			consider(best, meet_cushion(plain, b, &t->cushion[k], end), EVENT_CUSHION, i, k);
	for (int k = 0; k < t->jaw_count && plain->model->pocket != POCKET_MODEL_NONE; k++) {
		if (t->jaw[k].radius == 0 && plain->model->pocket != POCKET_MODEL_JAWS)
			continue;
		const REAL at[2] = {t->jaw[k].centre.x, t->jaw[k].centre.y};
		REAL distance = (REAL)t->jaw[k].radius + t->ball_radius;
		consider(best, meet(plain, b, NULL, at, distance, end), EVENT_JAW, i, k);
	}
	for (int k = 0; k < t->pocket_count && plain->model->pocket != POCKET_MODEL_NONE; k++) {
		const REAL at[2] = {t->pocket[k].centre.x, t->pocket[k].centre.y};
		consider(best, meet(plain, b, NULL, at, t->pocket[k].radius, end), EVENT_POCKET, i, k);
	}
}

static bool moves(const struct state *b)
{
	return b->phase == BALL_SLIDING || b->phase == BALL_ROLLING;
}

static struct next find_next(const struct plain *plain)
{
	struct next best = {INFINITY, EVENT_NONE, -1, -1};
	for (int i = 0; i < plain->count; i++) {
		if (plain->ball[i].phase == BALL_POTTED)
			continue;
		look_at_ball(plain, i, &best);
		for (int k = i + 1; k < plain->count; k++) {
			const struct state *a = &plain->ball[i], *b = &plain->ball[k];
			enum event_kind kind;
			if (b->phase == BALL_POTTED || (!moves(a) && !moves(b)))
				continue;
			REAL end_a = phase_end(plain, a, &kind), end_b = phase_end(plain, b, &kind);
			REAL end = !moves(a) ? end_b : !moves(b) ? end_a : fmin(end_a, end_b);
			consider(&best, meet(plain, a, b, NULL, 2 * (REAL)plain->table->ball_radius, end),
				 EVENT_BALL_BALL, i, k);
		}
	}
	return best;
}

static struct ball to_ball(const struct state *s, const REAL origin[2])
{
	return (struct ball){.pos = {(double)(s->x[0] - origin[0]), (double)(s->x[1] - origin[1])},
			     .vel = {(double)s->v[0], (double)s->v[1]},
			     .spin = {(double)s->w[0], (double)s->w[1], (double)s->w[2]},
			     .phase = s->phase};
}

static void from_ball(const struct ball *b, struct state *s)
{
	s->v[0] = b->vel.x;
	s->v[1] = b->vel.y;
	for (int i = 0; i < 3; i++)
		s->w[i] = b->spin[i];
	s->phase = b->phase;
}

static vec2 contact_normal(const struct table *t, const struct next *next, const struct state *s)
{
	if (next->kind == EVENT_JAW) {
		vec2 centre = t->jaw[next->other].centre;
		return vec2_unit((vec2){(double)(s->x[0] - centre.x), (double)(s->x[1] - centre.y)});
	}
	const struct cushion *c = &t->cushion[next->other];
	double side = (double)((s->x[0] - c->a.x) * c->normal.x + (s->x[1] - c->a.y) * c->normal.y);
	return vec2_scale(c->normal, side < 0 ? -1 : 1);
}

static void resolve(struct plain *plain, const struct next *next)
{
	const struct table *t = plain->table;
	struct state *s = &plain->ball[next->ball];
	struct ball a = to_ball(s, s->x), b;
	struct nose nose;
	switch (next->kind) {
	case EVENT_BALL_BALL:
		b = to_ball(&plain->ball[next->other], s->x);
		contact_balls(t, plain->model, &a, &b);
		from_ball(&a, s);
		from_ball(&b, &plain->ball[next->other]);
		break;
	case EVENT_CUSHION:
	case EVENT_JAW:
		nose = table_nose(t, contact_normal(t, next, s),
				  next->kind == EVENT_JAW ? t->jaw[next->other].nose_height
							  : t->cushion[next->other].nose_height);
		contact_cushion(t, plain->model, &nose, &a);
		from_ball(&a, s);
		break;
	case EVENT_POCKET:
		s->phase = BALL_POTTED;
		break;
	default:
		end_phase(plain, s, next->kind);
	}
}

int PLAIN_RUN(const struct table *table, const struct model *model, const struct ball *ball, int count,
	      const struct plain_solver *solver, struct plain_event *log, int capacity)
{
	struct plain plain = {.table = table, .model = model, .solver = solver, .count = count};
	REAL time = 0;
	for (int i = 0; i < count; i++) {
		plain.ball[i].x[0] = ball[i].pos.x;
		plain.ball[i].x[1] = ball[i].pos.y;
		from_ball(&ball[i], &plain.ball[i]);
	}
	for (int n = 0; n < capacity; n++) {
		struct next next = find_next(&plain);
		if (next.kind == EVENT_NONE)
			return n;
		time += next.time;
		for (int i = 0; i < count; i++)
			advance(&plain, &plain.ball[i], next.time);
		const struct state *a = &plain.ball[next.ball];
		log[n].event = (struct event){(double)time, next.kind, (int16_t)next.ball, (int16_t)next.other};
		log[n].pos[0] = log[n].pos[1] = (vec2){(double)a->x[0], (double)a->x[1]};
		if (next.kind == EVENT_BALL_BALL)
			log[n].pos[1] =
				(vec2){(double)plain.ball[next.other].x[0], (double)plain.ball[next.other].x[1]};
		resolve(&plain, &next);
	}
	return capacity;
}
