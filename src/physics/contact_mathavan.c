#include <assert.h>

#include "physics/contact_real.h"

/* Frame of the paper: x along the cushion, y into it, z up. The ball touches the nose at I, radius (0, c, s) from its
 * centre, and the cloth at C, radius (0, 0, -1). The normal impulse P at I is the variable of integration; all impulses
 * are per unit mass (m/s). Friction at I acts along e1 = x and e2 = (0, -s, c). */

enum { F1, F2, G1, G2, WORK, DIM };	/* friction impulses at I and C, work of the normal impulse at I per mass */
enum place { NOSE, CLOTH };

struct impact {
	double s, c;			/* sine and cosine of the nose's angle above the centre */
	double mu_nose, mu_cloth;
	double slip0[2][2], vy0;	/* before: slip at I (e1, e2) and C (x, y), velocity into the cushion */
	bool stick[2];
	vec2 onset[2];			/* direction in which slip begins after sticking, while too small to have one; else 0 */
	double rest_slip;		/* m/s: smaller slip counts as none */
	double p, y[DIM];
};

struct rates {
	vec2 nose, cloth;	/* friction at I and C per unit normal impulse at I */
};

static vec2 impact_slip(const struct impact *im, enum place place, double p, const double y[DIM])
{
	double s = im->s, c = im->c;
	const double *s0 = im->slip0[place];
	if (place == NOSE)
		return (vec2){s0[0] + 3.5 * y[F1] + (1 - 2.5 * s) * y[G1],
			      s0[1] + s * c * p + (2.5 + s * s) * y[F2] + (2.5 - s) * y[G2]};
	return (vec2){s0[0] + (1 - 2.5 * s) * y[F1] + 3.5 * y[G1], s0[1] - c * p + (2.5 - s) * y[F2] + 3.5 * y[G2]};
}

static double impact_vy(const struct impact *im, double p, const double y[DIM])
{
	return im->vy0 - im->c * p - im->s * y[F2] + y[G2];
}

/* Load on the cloth per unit normal impulse at I: the nose presses the ball down, the cloth bears it. */
static double cloth_load(const struct impact *im, vec2 nose)
{
	return fmax(im->s - im->c * nose.y, 0);
}

static vec2 clamp_length(vec2 a, double most)
{
	double n = vec2_norm(a);
	return n > most ? vec2_scale(a, most / n) : a;
}

/* Friction that keeps the slip at one place as it is, given the friction at the other. */
static vec2 holding_nose(const struct impact *im, vec2 cloth)
{
	double s = im->s;
	return (vec2){-(1 - 2.5 * s) * cloth.x / 3.5, -(s * im->c + (2.5 - s) * cloth.y) / (2.5 + s * s)};
}

static vec2 holding_cloth(const struct impact *im, vec2 nose)
{
	double s = im->s;
	return (vec2){-(1 - 2.5 * s) * nose.x / 3.5, (im->c - (2.5 - s) * nose.y) / 3.5};
}

static vec2 slip_direction(const struct impact *im, enum place place, vec2 slip)
{
	double n = vec2_norm(slip);
	bool begins = n <= im->rest_slip && vec2_norm2(im->onset[place]) > 0;
	return begins || n == 0 ? im->onset[place] : vec2_scale(slip, 1 / n);
}

/* Friction at both places. Where one sticks it depends on the other's and, through the load, the other on it: a contraction
 * (factor well below one half), repeated to rounding. */
static struct rates friction_rates(const struct impact *im, vec2 slip_nose, vec2 slip_cloth)
{
	struct rates r = {{0, 0}, {0, 0}};
	vec2 d = slip_direction(im, NOSE, slip_nose), q = slip_direction(im, CLOTH, slip_cloth);
	int rounds = im->stick[NOSE] ? 40 : 1;
	if (!im->stick[NOSE])
		r.nose = vec2_scale(d, -im->mu_nose);
	for (int i = 0; i < rounds; i++) {
		vec2 before = r.nose;
		double most = im->mu_cloth * cloth_load(im, r.nose);
		r.cloth = im->stick[CLOTH] ? clamp_length(holding_cloth(im, r.nose), most) : vec2_scale(q, -most);
		if (im->stick[NOSE])
			r.nose = clamp_length(holding_nose(im, r.cloth), im->mu_nose);
		if (vec2_dist(before, r.nose) <= 1e-15)
			break;
	}
	return r;
}

static void derivative(const struct impact *im, double p, const double y[DIM], double out[DIM])
{
	struct rates r = friction_rates(im, impact_slip(im, NOSE, p, y), impact_slip(im, CLOTH, p, y));
	out[F1] = r.nose.x;
	out[F2] = r.nose.y;
	out[G1] = r.cloth.x;
	out[G2] = r.cloth.y;
	out[WORK] = im->c * impact_vy(im, p, y);
}

/* Dormand and Prince 5(4). */
static const double STAGE[6][6] = {
	{1.0 / 5},
	{3.0 / 40, 9.0 / 40},
	{44.0 / 45, -56.0 / 15, 32.0 / 9},
	{19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
	{9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
	{35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
};
static const double NODE[6] = {1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
static const double ERROR[7] = {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

/* One step of h from im, whose derivative is k0. Fills y and returns the estimated error in m/s. */
static double step(const struct impact *im, double h, const double k0[DIM], double y[DIM])
{
	double k[7][DIM];
	for (int i = 0; i < DIM; i++)
		k[0][i] = k0[i];
	for (int stage = 0; stage < 6; stage++) {
		for (int i = 0; i < DIM; i++) {
			double sum = 0;
			for (int j = 0; j <= stage; j++)
				sum += STAGE[stage][j] * k[j][i];
			y[i] = im->y[i] + h * sum;
		}
		derivative(im, im->p + h * NODE[stage], y, k[stage + 1]);
	}
	double error = 0;
	for (int i = 0; i < WORK; i++) {
		double sum = 0;
		for (int j = 0; j < 7; j++)
			sum += ERROR[j] * k[j][i];
		error = fmax(error, fabs(h * sum));
	}
	return error;
}

/* Rate of change of the slip at one place per unit normal impulse. */
static vec2 slip_rate(const struct impact *im, enum place place, const struct rates *r)
{
	struct impact zero = {.s = im->s, .c = im->c};
	double y[DIM] = {r->nose.x, r->nose.y, r->cloth.x, r->cloth.y, 0};
	return impact_slip(&zero, place, 1, y);
}

/* Slip begins in the direction in which friction against it leaves it growing. */
static vec2 onset_direction(const struct impact *im, enum place place, struct rates r, vec2 holding, double most)
{
	vec2 direction = vec2_unit(vec2_scale(holding, -1));
	for (int i = 0; i < 40; i++) {
		if (place == NOSE)
			r.nose = vec2_scale(direction, -most);
		else
			r.cloth = vec2_scale(direction, -most);
		direction = vec2_unit(slip_rate(im, place, &r));
	}
	return direction;
}

/* Decides for each place whether it sticks: slip has ended, and friction can hold it. */
static void choose_modes(struct impact *im)
{
	for (int place = NOSE; place <= CLOTH; place++) {
		im->onset[place] = (vec2){0, 0};
		if (vec2_norm(impact_slip(im, (enum place)place, im->p, im->y)) <= im->rest_slip)
			im->stick[place] = true;
	}
	for (int place = NOSE; place <= CLOTH; place++) {
		if (!im->stick[place])
			continue;
		struct rates r = friction_rates(im, impact_slip(im, NOSE, im->p, im->y), impact_slip(im, CLOTH, im->p, im->y));
		vec2 holding = place == NOSE ? holding_nose(im, r.cloth) : holding_cloth(im, r.nose);
		double most = place == NOSE ? im->mu_nose : im->mu_cloth * cloth_load(im, r.nose);
		if (vec2_norm(holding) > most * (1 + 1e-12)) {
			im->stick[place] = false;
			im->onset[place] = onset_direction(im, (enum place)place, r, holding, most);
		}
	}
}

/* A step must not carry a slip through zero, where friction turns round: nine tenths of the way at most. */
static double slip_limit(const struct impact *im, const double k0[DIM])
{
	struct rates r = {{k0[F1], k0[F2]}, {k0[G1], k0[G2]}};
	double limit = INFINITY;
	for (int place = NOSE; place <= CLOTH; place++) {
		vec2 slip = impact_slip(im, (enum place)place, im->p, im->y);
		double size = vec2_norm(slip);
		if (im->stick[place] || size <= im->rest_slip)
			continue;
		double rate = vec2_dot(slip, slip_rate(im, (enum place)place, &r)) / size;
		if (rate < 0)
			limit = fmin(limit, 0.9 * size / -rate);
	}
	return limit;
}

/* Normal impulse until the work reaches target if vy went on changing as it does now; INFINITY if it never does. The work
 * falls during restitution (vy < 0). */
static double restitution_left(const struct impact *im, double target, const double k0[DIM])
{
	double vy = impact_vy(im, im->p, im->y), rate = -im->c - im->s * k0[F2] + k0[G2];
	double left = (im->y[WORK] - target) / im->c;
	double root = vy * vy - 2 * rate * left;
	if (left <= 0 || root <= 0)
		return left <= 0 ? 0 : INFINITY;
	double speed = fmax(-vy, 0) + sqrt(root);
	return speed > 0 ? 2 * left / speed : INFINITY;
}

static double compression_left(const struct impact *im, const double k0[DIM])
{
	double vy = impact_vy(im, im->p, im->y), rate = -im->c - im->s * k0[F2] + k0[G2];
	if (vy <= 0)
		return 0;
	return rate < 0 ? vy / -rate : INFINITY;
}

enum { STEPS_MAX = 2000 };

/* Integrates until the compression ends (target NAN) or the work has fallen to target. tolerance: m/s a step, and what
 * is left of the phase when it counts as over. STEPS_MAX is reached only where friction wedges the ball in for good. */
static void integrate(struct impact *im, double target, double tolerance)
{
	double h = INFINITY;
	for (int n = 0; n < STEPS_MAX; n++) {
		choose_modes(im);
		double k0[DIM], y[DIM];
		derivative(im, im->p, im->y, k0);
		double left = isnan(target) ? compression_left(im, k0) : restitution_left(im, target, k0);
		if (left <= tolerance)
			return;
		h = fmin(fmin(h, slip_limit(im, k0)), fmin(left, 0.25 * im->vy0));
		double error = step(im, h, k0, y);
		if (error <= tolerance) {
			im->p += h;
			for (int i = 0; i < DIM; i++)
				im->y[i] = y[i];
		}
		h *= fmin(4, fmax(0.2, 0.8 * pow(tolerance / fmax(error, 1e-300), 0.2)));
	}
}

void contact_cushion_mathavan(const struct table *table, vec2 normal, double nose_height, struct ball *ball)
{
	const struct material *m = &table->material;
	double r = table->ball_radius;
	assert(nose_height > 0 && nose_height < 2 * r);
	vec2 into = vec2_scale(normal, -1), along = {into.y, -into.x};
	double vx = vec2_dot(along, ball->vel), vy = vec2_dot(into, ball->vel);
	double wx = r * (along.x * ball->spin[0] + along.y * ball->spin[1]);
	double wy = r * (into.x * ball->spin[0] + into.y * ball->spin[1]), wz = r * ball->spin[2];
	assert(vy >= 0);
	if (vy == 0)
		return;

	double s = nose_height / r - 1, c = sqrt(1 - s * s);
	double scale = fabs(vx) + vy + fabs(wx) + fabs(wy) + fabs(wz);
	struct impact im = {
		.s = s, .c = c, .mu_nose = m->mu_cushion, .mu_cloth = m->mu_slide, .vy0 = vy, .rest_slip = 1e-10 * scale,
		.slip0 = {{vx + wy * s - wz * c, wx - vy * s}, {vx - wy, vy + wx}},
	};
	double tolerance = 1e-10 * scale;
	integrate(&im, NAN, tolerance);
	integrate(&im, (1 - m->e_cushion * m->e_cushion) * im.y[WORK], tolerance);

	const double *y = im.y;
	ball->vel = vec2_madd(ball->vel, y[F1] + y[G1], along);
	ball->vel = vec2_madd(ball->vel, -c * im.p - s * y[F2] + y[G2], into);
	vec2 turn = vec2_madd(vec2_scale(along, y[F2] + y[G2]), s * y[F1] - y[G1], into);
	ball->spin[0] += 2.5 / r * turn.x;
	ball->spin[1] += 2.5 / r * turn.y;
	ball->spin[2] -= 2.5 / r * c * y[F1];
}
