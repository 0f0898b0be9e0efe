#include <assert.h>

#include "physics/contact_real.h"

/* Time runs in units of the inverse normal frequency: compression lasts pi/2, restitution e times as long. Slip is
 * counted along its first direction, everything is divided by the approach speed, so that the incoming ball has normal
 * velocity -1 and slip x > 0. */

/* Inverse tangential mass of a solid sphere: 1 + 5/2. */
static const double BETA = 3.5;

struct compliance {
	double e;     /* restitution */
	double mu;    /* friction */
	double omega; /* tangential over normal frequency */
	double eta2;  /* normal over tangential stiffness */
};

/* The tangential spring's stretch and rate where the contact point begins to stick. */
struct stick {
	double time, stretch, rate;
};

static double restitution_phase(const struct compliance *c, double time)
{
	return time / c->e + M_PI_2 * (1 - 1 / c->e);
}

static struct stick stick_begin(const struct compliance *c, double x)
{
	if (x < c->mu * c->eta2)
		return (struct stick){0, 0, x};
	double slope = x / c->mu - BETA;
	if (slope <= 0) {
		double cosine = slope / (c->eta2 - BETA);
		double time = acos(fmin(cosine, 1));
		return (struct stick){time, c->mu * c->eta2 * sin(time), x - c->mu * BETA * (1 - cos(time))};
	}
	double cosine = slope / (c->eta2 / c->e - c->e * BETA);
	double phase = acos(fmax(cosine, -1));
	return (struct stick){c->e * (phase - M_PI_2 * (1 - 1 / c->e)), c->mu * c->eta2 * sin(phase),
			      x - c->mu * BETA * (1 - c->e * cos(phase))};
}

static double stick_stretch(const struct compliance *c, const struct stick *s, double time)
{
	double angle = c->omega * (time - s->time);
	return s->stretch * cos(angle) + s->rate / c->omega * sin(angle);
}

static double stick_rate(const struct compliance *c, const struct stick *s, double time)
{
	double angle = c->omega * (time - s->time);
	return s->rate * cos(angle) - c->omega * s->stretch * sin(angle);
}

/* What friction can still hold, less what the spring pulls: sticking ends where it falls below zero. */
static double stick_reserve(const struct compliance *c, const struct stick *s, double time)
{
	return c->mu * c->eta2 * sin(restitution_phase(c, time)) - fabs(stick_stretch(c, s, time));
}

/* Bisection to the last bit: the reserve has a kink where the spring changes side, which spoils faster methods. */
static double stick_end(const struct compliance *c, const struct stick *s)
{
	double low = fmax(M_PI_2, s->time), high = M_PI_2 * (1 + c->e);
	for (int i = 0; i < 60; i++) {
		double middle = 0.5 * (low + high);
		if (middle <= low || middle >= high)
			break;
		if (stick_reserve(c, s, middle) > 0)
			low = middle;
		else
			high = middle;
	}
	return 0.5 * (low + high);
}

/* Slip after the impact for slip x before it, both per approach speed. Where the spring could not recoil in the time
 * that the impact lasts, the limit of a stiff one: Coulomb friction until the slip ends. */
static double slip_after(const struct compliance *c, double x)
{
	if (!(c->omega > 1 && c->omega < 2 && c->e * c->omega > 1))
		return fmax(x - c->mu * BETA * (1 + c->e), 0);
	if (x > c->mu * ((1 + c->e) * BETA - c->eta2 / c->e))
		return x - c->mu * BETA * (1 + c->e);
	struct stick s = stick_begin(c, x);
	double time = stick_end(c, &s);
	double last = c->mu * BETA * c->e * (1 + cos(restitution_phase(c, time)));
	return stick_rate(c, &s, time) - copysign(last, stick_stretch(c, &s, time));
}

void contact_cushion_stronge(const struct table *table, const struct nose *nose, struct ball *ball)
{
	vec2 normal = nose->normal;
	double r = table->ball_radius;
	assert(nose->height >= 0 && nose->height <= 2 * r);
	double slope = nose->height / r - 1, cosine = 1 / sqrt(1 + slope * slope), sine = slope * cosine;
	vec2 t = vec2_perp(normal);
	/* Components along normal (n), across it (t) and up (z); the contact point is -r (cosine n - sine z) from the
	 * centre. The contact's own frame: its normal cosine n - sine z, its tangents t and sine n + cosine z. */
	double vn = vec2_dot(normal, ball->vel), vt = vec2_dot(t, ball->vel);
	double wn = normal.x * ball->spin[0] + normal.y * ball->spin[1];
	double wt = t.x * ball->spin[0] + t.y * ball->spin[1];
	double approach = -cosine * vn;
	assert(approach >= 0);
	if (approach == 0)
		return;
	double slip_t = vt - r * (cosine * ball->spin[2] + sine * wn), slip_u = sine * vn + r * wt;
	double slip = hypot(slip_t, slip_u);
	double e = nose_restitution(table, nose, approach), normal_impulse = (1 + e) * approach, along = 0, up = 0;
	if (slip > 0) {
		double omega = table->material.stronge_omega;
		struct compliance c = {e, nose->mu, omega, BETA / (omega * omega)};
		double impulse = (slip_after(&c, slip / approach) * approach - slip) / BETA;
		along = impulse * slip_t / slip;
		up = impulse * slip_u / slip;
	}
	/* A steep nose may leave some of the approach: the rail takes that. */
	ball->vel = vec2_madd(ball->vel, fmax(cosine * normal_impulse + sine * up, -vn), normal);
	ball->vel = vec2_madd(ball->vel, along, t);
	double turn = 2.5 / r;
	vec2 spin = vec2_madd(vec2_scale(t, turn * up), -turn * sine * along, normal);
	ball->spin[0] += spin.x;
	ball->spin[1] += spin.y;
	ball->spin[2] -= turn * cosine * along;
}
