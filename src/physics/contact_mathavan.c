#include <assert.h>

#include "physics/contact_real.h"
#include "physics/tolerances.h"

/* Frame of the paper: x along the cushion, y into it, z up. The ball touches the nose at I, radius (0, c, s) from its
 * centre, and the cloth at C, radius (0, 0, -1). The normal impulse P at I, per unit mass (m/s), is the variable of
 * integration. Friction at I acts along e1 = x and e2 = (0, -s, c).
 *
 * The slip of the ball's surface at I (e1, e2) and C (x, y) is all that the friction depends on, and the velocity into
 * the cushion follows from it: vy = (C2 - I2) / (1 + s). So the state is these four and the work done by the normal
 * impulse. While a slip is small its direction obeys a stiff equation: hence an L-stable method. */

enum { I1, I2, C1, C2, WORK, DIM, SLIPS = WORK };
enum impact_place { NOSE, CLOTH };

struct impact {
	double s, c; /* sine and cosine of the nose's angle above the centre */
	double mu[2];
	bool stick[2];
	vec2 onset[2];	  /* where slip begins after sticking and has no direction yet, the one it takes; else 0 */
	double rest_slip; /* m/s: smaller slip counts as none */
	double z[DIM];
};

struct friction {
	vec2 nose, cloth; /* per unit normal impulse at I */
};

static vec2 slip_of(const double z[DIM], enum impact_place place)
{
	return place == NOSE ? (vec2){z[I1], z[I2]} : (vec2){z[C1], z[C2]};
}

static double velocity_into(const struct impact *im, const double z[DIM])
{
	return (z[C2] - z[I2]) / (1 + im->s);
}

/* Load on the cloth: the nose presses the ball down, the cloth bears it. */
static double cloth_load(const struct impact *im, vec2 nose)
{
	return fmax(im->s - im->c * nose.y, 0);
}

static double most_friction(const struct impact *im, enum impact_place place, const struct friction *f)
{
	return place == NOSE ? im->mu[NOSE] : im->mu[CLOTH] * cloth_load(im, f->nose);
}

static vec2 clamp_length(vec2 a, double most)
{
	double n = vec2_norm(a);
	return n > most ? vec2_scale(a, most / n) : a;
}

/* Friction that keeps the slip at one place as it is, given the friction at the other. */
static vec2 holding_friction(const struct impact *im, enum impact_place place, const struct friction *f)
{
	double s = im->s, c = im->c, coupling = -(1 - 2.5 * s) / 3.5;
	if (place == NOSE)
		return (vec2){coupling * f->cloth.x, -(s * c + (2.5 - s) * f->cloth.y) / (2.5 + s * s)};
	return (vec2){coupling * f->nose.x, (c - (2.5 - s) * f->nose.y) / 3.5};
}

static vec2 slip_direction(const struct impact *im, const double z[DIM], enum impact_place place)
{
	vec2 slip = slip_of(z, place);
	double n = vec2_norm(slip);
	bool begins = n <= im->rest_slip && vec2_norm2(im->onset[place]) > 0;
	return begins || n == 0 ? im->onset[place] : vec2_scale(slip, 1 / n);
}

/* Nose friction that holds the slip there while the cloth slips in direction q: the cloth's friction depends on the
 * load and so on the nose's, two linear equations. */
static vec2 holding_over_slip(const struct impact *im, vec2 q)
{
	double s = im->s, c = im->c, give = (2.5 - s) / (2.5 + s * s), mu = im->mu[CLOTH];
	double up = (give * mu * s * q.y - s * c / (2.5 + s * s)) / (1 + give * mu * c * q.y);
	struct friction f = {{0, up}, {0, 0}};
	f.cloth = vec2_scale(q, -most_friction(im, CLOTH, &f));
	return holding_friction(im, NOSE, &f);
}

/* The same while the cloth sticks too. */
static vec2 holding_both(const struct impact *im)
{
	double s = im->s, c = im->c;
	return (vec2){0, -(3.5 * s * c + (2.5 - s) * c) / (3.5 * (2.5 + s * s) - (2.5 - s) * (2.5 - s))};
}

/* Friction at both places. */
static struct friction friction_at(const struct impact *im, const double z[DIM])
{
	struct friction f = {{0, 0}, {0, 0}};
	vec2 q = slip_direction(im, z, CLOTH);
	if (!im->stick[NOSE])
		f.nose = vec2_scale(slip_direction(im, z, NOSE), -im->mu[NOSE]);
	else
		f.nose = clamp_length(im->stick[CLOTH] ? holding_both(im) : holding_over_slip(im, q), im->mu[NOSE]);
	double most = most_friction(im, CLOTH, &f);
	f.cloth = im->stick[CLOTH] ? clamp_length(holding_friction(im, CLOTH, &f), most) : vec2_scale(q, -most);
	return f;
}

/* What friction adds to the four slips per unit normal impulse. */
static void spread(const struct impact *im, const struct friction *f, double out[SLIPS])
{
	double s = im->s, coupling = 1 - 2.5 * s;
	out[I1] = 3.5 * f->nose.x + coupling * f->cloth.x;
	out[I2] = (2.5 + s * s) * f->nose.y + (2.5 - s) * f->cloth.y;
	out[C1] = coupling * f->nose.x + 3.5 * f->cloth.x;
	out[C2] = (2.5 - s) * f->nose.y + 3.5 * f->cloth.y;
}

static void slip_rates(const struct impact *im, const struct friction *f, double out[SLIPS])
{
	spread(im, f, out);
	out[I2] += im->s * im->c;
	out[C2] -= im->c;
}

static void derivative(const struct impact *im, const double z[DIM], double out[DIM])
{
	struct friction f = friction_at(im, z);
	slip_rates(im, &f, out);
	out[WORK] = im->c * velocity_into(im, z);
}

/* Change of a slip's direction with a change of the slip. */
static vec2 direction_change(const struct impact *im, enum impact_place place, vec2 change)
{
	vec2 slip = slip_of(im->z, place);
	double n = vec2_norm(slip);
	if (im->stick[place] || n <= im->rest_slip)
		return (vec2){0, 0};
	return vec2_scale(vec2_perp(slip), vec2_cross(slip, change) / (n * n * n));
}

/* Change of friction_at() with a change of the slips; f is the friction itself. */
static struct friction friction_change(const struct impact *im, const struct friction *f, const double change[DIM])
{
	double s = im->s, coupling = -(1 - 2.5 * s) / 3.5, load = cloth_load(im, f->nose), mu = im->mu[CLOTH];
	vec2 q = slip_direction(im, im->z, CLOTH), dq = direction_change(im, CLOTH, slip_of(change, CLOTH));
	struct friction d = {vec2_scale(direction_change(im, NOSE, slip_of(change, NOSE)), -im->mu[NOSE]), {0, 0}};
	if (im->stick[CLOTH]) {
		d.cloth = (vec2){coupling * d.nose.x, -(2.5 - s) / 3.5 * d.nose.y};
	} else if (im->stick[NOSE]) {
		double give = (2.5 - s) / (2.5 + s * s);
		d.cloth.y = -mu * load * dq.y / (1 + mu * im->c * give * q.y);
		d.nose.y = -give * d.cloth.y;
		d.cloth.x = -mu * load * dq.x + mu * im->c * q.x * d.nose.y;
		d.nose.x = coupling * d.cloth.x;
	} else {
		d.cloth = vec2_scale(dq, -mu * load);
		if (load > 0)
			d.cloth = vec2_madd(d.cloth, mu * im->c * d.nose.y, q);
	}
	return d;
}

static void jacobian(const struct impact *im, double j[SLIPS][SLIPS])
{
	struct friction f = friction_at(im, im->z);
	for (int column = 0; column < SLIPS; column++) {
		double change[DIM] = {0}, out[SLIPS];
		change[column] = 1;
		struct friction d = friction_change(im, &f, change);
		spread(im, &d, out);
		for (int row = 0; row < SLIPS; row++)
			j[row][column] = out[row];
	}
}

/* Inverse by Gauss and Jordan with row exchange; the matrix 1/(h gamma) - J has no small pivots left then. */
static void invert(double a[SLIPS][SLIPS], double out[SLIPS][SLIPS])
{
	for (int i = 0; i < SLIPS; i++)
		for (int k = 0; k < SLIPS; k++)
			out[i][k] = i == k;
	for (int i = 0; i < SLIPS; i++) {
		int pivot = i;
		for (int k = i + 1; k < SLIPS; k++)
			if (fabs(a[k][i]) > fabs(a[pivot][i]))
				pivot = k;
		double scale = 1 / a[pivot][i];
		for (int k = 0; k < SLIPS; k++) {
			double x = a[pivot][k], y = out[pivot][k];
			a[pivot][k] = a[i][k];
			out[pivot][k] = out[i][k];
			a[i][k] = x * scale;
			out[i][k] = y * scale;
		}
		for (int k = 0; k < SLIPS; k++) {
			double factor = a[k][i];
			for (int l = 0; k != i && l < SLIPS; l++) {
				a[k][l] -= factor * a[i][l];
				out[k][l] -= factor * out[i][l];
			}
		}
	}
}

/* Rosenbrock method RODAS of order 4 with an embedded one of order 3 (Hairer and Wanner, Solving ODEs II, IV.7). */
static const double GAMMA = 0.25;
static const double STAGE[5][5] = {
	{0},
	{1.544},
	{0.9466785280815826, 0.2557011698983284},
	{3.314825187068521, 2.896124015972201, 0.9986419139977817},
	{1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
};
static const double COUPLE[6][5] = {
	{0},
	{-5.6688},
	{-2.430093356833875, -0.2063599157091915},
	{-0.1073529058151375, -9.594562251023355, -20.47028614809616},
	{7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
	{8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054},
};

/* Stage equation: slips by the inverted matrix, then the work, which depends on the slips only. */
static void solve_stage(const struct impact *im, double h, double inverse[SLIPS][SLIPS], const double right[DIM],
			double k[DIM])
{
	for (int i = 0; i < SLIPS; i++) {
		k[i] = 0;
		for (int l = 0; l < SLIPS; l++)
			k[i] += inverse[i][l] * right[l];
	}
	k[WORK] = GAMMA * h * (right[WORK] + im->c * velocity_into(im, k));
}

/* One step of h from im, where the derivative is rates and its Jacobian j; fills z and returns the estimated error in
 * m/s. */
static double step(const struct impact *im, double h, const double rates[DIM], double j[SLIPS][SLIPS], double z[DIM])
{
	double matrix[SLIPS][SLIPS], inverse[SLIPS][SLIPS], k[6][DIM], per_h = 1 / h;
	for (int i = 0; i < SLIPS; i++)
		for (int l = 0; l < SLIPS; l++)
			matrix[i][l] = (i == l ? per_h / GAMMA : 0) - j[i][l];
	invert(matrix, inverse);
	for (int i = 0; i < DIM; i++)
		z[i] = im->z[i];
	for (int stage = 0; stage < 6; stage++) {
		double right[DIM];
		for (int i = 0; i < DIM && stage > 0; i++) {
			z[i] = stage == 5 ? z[i] + k[4][i] : im->z[i];
			for (int l = 0; l < stage && stage < 5; l++)
				z[i] += STAGE[stage][l] * k[l][i];
		}
		if (stage > 0)
			derivative(im, z, right);
		for (int i = 0; i < DIM && stage == 0; i++)
			right[i] = rates[i];
		for (int l = 0; l < stage; l++) {
			double couple = COUPLE[stage][l] * per_h;
			for (int i = 0; i < DIM; i++)
				right[i] += couple * k[l][i];
		}
		solve_stage(im, h, inverse, right, k[stage]);
	}
	double error = 0;
	for (int i = 0; i < DIM; i++) {
		z[i] += k[5][i];
		if (i < SLIPS)
			error = fmax(error, fabs(k[5][i]));
	}
	return error;
}

/* Slip begins in the direction in which friction against it leaves it growing. */
static vec2 onset_direction(const struct impact *im, enum impact_place place, struct friction f, vec2 holding,
			    double most)
{
	vec2 direction = vec2_unit(vec2_scale(holding, -1)), before = {0, 0};
	for (int i = 0; i < 40 && vec2_dist(direction, before) > 1e-9; i++) {
		double rates[DIM];
		before = direction;
		*(place == NOSE ? &f.nose : &f.cloth) = vec2_scale(direction, -most);
		slip_rates(im, &f, rates);
		direction = vec2_unit(slip_of(rates, place));
	}
	return direction;
}

/* Decides for each place whether it sticks: slip has ended, and friction can hold it. */
static void choose_modes(struct impact *im)
{
	for (int place = NOSE; place <= CLOTH; place++) {
		im->onset[place] = (vec2){0, 0};
		if (vec2_norm(slip_of(im->z, (enum impact_place)place)) <= im->rest_slip)
			im->stick[place] = true;
	}
	for (int place = NOSE; place <= CLOTH; place++) {
		if (!im->stick[place])
			continue;
		struct friction f = friction_at(im, im->z);
		vec2 holding = holding_friction(im, (enum impact_place)place, &f);
		double most = most_friction(im, (enum impact_place)place, &f);
		if (vec2_norm(holding) > most * (1 + 1e-12)) {
			im->stick[place] = false;
			im->onset[place] = onset_direction(im, (enum impact_place)place, f, holding, most);
		}
	}
}

/* A step must not carry a slip through zero, where friction turns round: nine tenths of the way at most. */
static double slip_limit(const struct impact *im, const double rates[DIM])
{
	double limit = INFINITY;
	for (int place = NOSE; place <= CLOTH; place++) {
		vec2 slip = slip_of(im->z, (enum impact_place)place);
		double size = vec2_norm(slip);
		if (im->stick[place] || size <= im->rest_slip)
			continue;
		double rate = vec2_dot(slip, slip_of(rates, (enum impact_place)place)) / size;
		if (rate < 0)
			limit = fmin(limit, 0.9 * size / -rate);
	}
	return limit;
}

/* Normal impulse until the compression ends (target NAN) or the work has fallen to target, if vy went on changing as it
 * does now; INFINITY if it never would. */
static double impulse_left(const struct impact *im, double target, const double rates[DIM])
{
	double vy = velocity_into(im, im->z), rate = velocity_into(im, rates);
	if (isnan(target))
		return vy <= 0 ? 0 : rate < 0 ? vy / -rate : INFINITY;
	double left = (im->z[WORK] - target) / im->c, root = vy * vy - 2 * rate * left;
	if (left <= 0)
		return 0;
	double speed = fmax(-vy, 0) + sqrt(fmax(root, 0));
	return speed > 0 ? 2 * left / speed : INFINITY;
}

/* Integrates to the end of a phase; scale: speed before, m/s. False: friction wedges the ball in, the phase has no end.
 */
static bool integrate(struct impact *im, double target, double scale)
{
	double h = scale, spent = 0;
	for (int n = 0; n < IMPACT_STEPS_MAX && spent <= IMPULSE_MAX * scale; n++) {
		choose_modes(im);
		double rates[DIM], z[DIM], j[SLIPS][SLIPS];
		derivative(im, im->z, rates);
		double left = impulse_left(im, target, rates);
		if (left <= IMPULSE_END * scale)
			return true;
		jacobian(im, j);
		h = fmin(fmin(h, slip_limit(im, rates)), left);
		double error = step(im, h, rates, j, z);
		bool good = error <= IMPACT_ERROR * scale;
		spent += good ? h : 0;
		for (int i = 0; i < DIM && good; i++)
			im->z[i] = z[i];
		h *= fmin(5, fmax(0.2, 0.85 * sqrt(sqrt(IMPACT_ERROR * scale / fmax(error, 1e-300)))));
	}
	return false;
}

void contact_cushion_mathavan(const struct table *table, const struct nose *nose, struct ball *ball)
{
	double r = table->ball_radius;
	vec2 into = vec2_scale(nose->normal, -1), along = {into.y, -into.x};
	double vx = vec2_dot(along, ball->vel), vy = vec2_dot(into, ball->vel);
	double wx = r * (along.x * ball->spin[0] + along.y * ball->spin[1]);
	double wy = r * (into.x * ball->spin[0] + into.y * ball->spin[1]), wz = r * ball->spin[2];
	assert(vy >= 0);
	if (vy == 0)
		return;

	/* Beyond these heights the ball would pass under or over the nose. */
	double s = fmin(fmax(nose->height / r - 1, -0.9), 0.9), c = sqrt(1 - s * s);
	double scale = fabs(vx) + vy + fabs(wx) + fabs(wy) + fabs(wz);
	struct impact im = {.s = s,
			    .c = c,
			    .mu = {nose->mu, table->material.mu_slide},
			    .rest_slip = IMPACT_REST_SLIP * scale,
			    .z = {vx + wy * s - wz * c, wx - vy * s, vx - wy, vy + wx, 0}};
	double first[2] = {im.z[I1], im.z[C1]};
	bool ends = integrate(&im, NAN, scale);
	double e = nose_restitution(table, nose, vy);
	ends = ends && integrate(&im, (1 - e * e) * im.z[WORK], scale);
	if (!ends) {
		ball->vel = vec2_madd(ball->vel, -vy, into);
		return;
	}

	/* Impulses along x from the changes of the slips along x. */
	double coupling = 1 - 2.5 * s, det = 3.5 * 3.5 - coupling * coupling;
	double d1 = im.z[I1] - first[0], d2 = im.z[C1] - first[1];
	double push = (3.5 * d1 - coupling * d2) / det, cloth = (3.5 * d2 - coupling * d1) / det;
	double after = velocity_into(&im, im.z), spin = im.z[C2] - after;
	ball->vel = vec2_madd(vec2_madd(ball->vel, push + cloth, along), fmin(after, 0) - vy, into);
	vec2 turn = vec2_madd(vec2_scale(along, spin - wx), 2.5 * (s * push - cloth), into);
	ball->spin[0] += turn.x / r;
	ball->spin[1] += turn.y / r;
	ball->spin[2] -= 2.5 / r * c * push;
}
