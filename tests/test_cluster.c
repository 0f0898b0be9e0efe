/* Contacts that overlap in time, against an integration of their own: GSL's rk8pd with tight tolerances, Hertz's force
 * from Young's modulus and Poisson's ratio, another law of damping (Kuwabara and Kono 1987), all balls against
 * all, friction smoothed over 1 cm/s of slip. */
#include "harness.h"
#include "scenes.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "physics/sim.h"

static const double YOUNG = 5.8e9, POISSON = 0.3; /* phenolic resin */

static struct table table_with_time(void)
{
	struct table t = scene_box_table(3.5, 1.7);
	t.material.hertz_modulus = YOUNG / (1 - POISSON * POISSON);
	return t;
}

/* ---- the judge ---- */

struct hertz {
	int count;
	double radius, mass, stiffness, loss; /* m, kg, N / m^1.5, s */
	const struct material *rub;	      /* friction; NULL: none */
};

/* x, y, vx, vy, spin about z times the radius. */
enum { X, Y, VX, VY, RIM, NUMBERS };

static double friction(const struct material *m, double slip)
{
	return m ? (m->mu_ball_a + m->mu_ball_b * exp(-m->mu_ball_c * fabs(slip))) * tanh(slip / 0.01) : 0;
}

/* What the contact of two balls, a and b, adds to their rates. */
static void contact(const struct hertz *h, const double *a, const double *b, double *da, double *db)
{
	double dx = b[X] - a[X], dy = b[Y] - a[Y], d = hypot(dx, dy), depth = 2 * h->radius - d;
	if (depth <= 0)
		return;
	double nx = dx / d, ny = dy / d;
	double rate = (b[VX] - a[VX]) * nx + (b[VY] - a[VY]) * ny;
	double slip = (a[VY] - b[VY]) * nx - (a[VX] - b[VX]) * ny + a[RIM] + b[RIM];
	double f = h->stiffness * (pow(depth, 1.5) - 1.5 * h->loss * sqrt(depth) * rate) / h->mass;
	double t = -f * friction(h->rub, slip);
	da[VX] -= f * nx + t * ny;
	da[VY] -= f * ny - t * nx;
	db[VX] += f * nx + t * ny;
	db[VY] += f * ny - t * nx;
	da[RIM] += 2.5 * t;
	db[RIM] += 2.5 * t;
}

static int forces(double t, const double y[], double dydt[], void *params)
{
	const struct hertz *h = params;
	(void)t;
	memset(dydt, 0, sizeof *dydt * (size_t)(NUMBERS * h->count));
	for (int i = 0; i < h->count; i++) {
		dydt[NUMBERS * i + X] = y[NUMBERS * i + VX];
		dydt[NUMBERS * i + Y] = y[NUMBERS * i + VY];
		for (int k = 0; k < i; k++)
			contact(h, y + NUMBERS * i, y + NUMBERS * k, dydt + NUMBERS * i, dydt + NUMBERS * k);
	}
	return GSL_SUCCESS;
}

static bool any_touch(const struct hertz *h, const double *y)
{
	for (int i = 0; i < h->count; i++)
		for (int k = 0; k < i; k++)
			if (hypot(y[NUMBERS * i] - y[NUMBERS * k], y[NUMBERS * i + Y] - y[NUMBERS * k + Y]) <
			    2 * h->radius)
				return true;
	return false;
}

/* From a first contact for the window (s), then until no balls touch; returns how long that takes, s. */
static double integrate(struct hertz *h, double *y, double window)
{
	gsl_odeiv2_system system = {forces, NULL, (size_t)(NUMBERS * h->count), h};
	gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-7, 1e-9, 1e-9);
	gsl_odeiv2_driver_set_hmax(driver, 1e-5);
	double t = 0;
	for (int n = 1; n < 4000; n++) {
		ck_assert_int_eq(gsl_odeiv2_driver_apply(driver, &t, n * 5e-6, y), GSL_SUCCESS);
		if (t >= window && !any_touch(h, y))
			break;
	}
	gsl_odeiv2_driver_free(driver);
	return t;
}

/* Two balls at this speed: restitution and the contact's time. */
static double pair_restitution(struct hertz h, double speed, double *lasts)
{
	double y[2 * NUMBERS] = {0, 0, speed, 0, 0, 2 * h.radius};
	h.count = 2;
	h.rub = NULL;
	*lasts = integrate(&h, y, 0);
	return (y[NUMBERS + VX] - y[VX]) / speed;
}

/* The loss is tuned for the restitution at this speed. */
static struct hertz hertz_of(const struct table *t, int count, double speed)
{
	double star = YOUNG / (2 * (1 - POISSON * POISSON)), low = 0, high = 1e-4, lasts;
	struct hertz h = {.count = count,
			  .radius = t->ball_radius,
			  .mass = t->ball_mass,
			  .stiffness = 4.0 / 3 * star * sqrt(t->ball_radius / 2),
			  .rub = &t->material};
	for (int i = 0; i < 25; i++) {
		h.loss = 0.5 * (low + high);
		*(pair_restitution(h, speed, &lasts) > t->material.e_ball ? &low : &high) = h.loss;
	}
	return h;
}

static void judge(struct hertz h, const struct ball *ball, double window, vec2 *vel)
{
	double y[NUMBERS * BALL_MAX];
	for (int i = 0; i < h.count; i++) {
		const double start[NUMBERS] = {ball[i].pos.x, ball[i].pos.y, ball[i].vel.x, ball[i].vel.y,
					       h.radius * ball[i].spin[2]};
		memcpy(y + NUMBERS * i, start, sizeof start);
	}
	integrate(&h, y, window);
	for (int i = 0; i < h.count; i++)
		vel[i] = (vec2){y[NUMBERS * i + VX], y[NUMBERS * i + VY]};
}

/* ---- the product ---- */

static struct model real_model(void)
{
	struct model model;
	ck_assert(model_from_name("real", &model));
	model.pocket = POCKET_MODEL_NONE;
	return model;
}

/* A case: balls of which the first moves and touches, or nearly, the second. */
struct scene {
	struct table table;
	struct ball ball[BALL_MAX];
	int count;
	double speed, window; /* m/s, s */
};

/* Velocities at the end of the window. */
static void simulate(const struct scene *s, const struct model *model, vec2 *vel)
{
	static struct sim sim;
	sim_init(&sim, &s->table, model, s->ball, s->count);
	sim_run(&sim, &(struct sim_limits){s->window, 2000}, NULL);
	for (int i = 0; i < s->count; i++)
		vel[i] = sim_ball(&sim, i).vel;
}

/* ---- racks ---- */

enum { RACK = 16, SHOTS = 5 };

/* Cue ball touching the first red of a triangle with gaps, moving along x at an offset across. */
static void rack(struct scene *s, double gap, double across)
{
	double d = 2 * s->table.ball_radius, step = d + gap;
	s->count = 1;
	s->ball[0] = ball_at(COLOUR_WHITE, (vec2){-sqrt(d * d - across * across), across});
	s->ball[0].vel = (vec2){s->speed, 0};
	for (int row = 0; row < 5; row++)
		for (int k = 0; k <= row; k++)
			s->ball[s->count++] =
				ball_at(COLOUR_RED, (vec2){row * step * sqrt(0.75), (k - 0.5 * row) * step});
}

static double movers(const vec2 *vel, double speed)
{
	int count = 0;
	for (int i = 1; i < RACK; i++)
		count += vec2_norm(vel[i]) > 0.1 * speed;
	return count;
}

struct tally {
	double want, got, before; /* reds that move, mean over the shots; before: contacts take no time */
	double square, square_before;
	double fastest, fastest_want;
};

static void tally(struct tally *sum, const struct scene *s, const struct hertz *h)
{
	struct model model = real_model(), at_once = model;
	at_once.lasting_contacts = false;
	vec2 want[RACK], got[RACK], before[RACK];
	judge(*h, s->ball, s->window, want);
	simulate(s, &model, got);
	simulate(s, &at_once, before);
	sum->want += movers(want, s->speed) / SHOTS;
	sum->got += movers(got, s->speed) / SHOTS;
	sum->before += movers(before, s->speed) / SHOTS;
	for (int i = 0; i < RACK; i++) {
		double unit = 1 / (s->speed * s->speed * SHOTS * RACK);
		sum->square += unit * vec2_norm2(vec2_sub(got[i], want[i]));
		sum->square_before += unit * vec2_norm2(vec2_sub(before[i], want[i]));
		sum->fastest = fmax(sum->fastest, i > 0 ? vec2_norm(got[i]) / s->speed : 0);
		sum->fastest_want = fmax(sum->fastest_want, i > 0 ? vec2_norm(want[i]) / s->speed : 0);
	}
}

/* What a break's first milliseconds do to a rack with gaps of camera errors' size. */
START_TEST(racks_with_gaps)
{
	static const double gap[] = {0, 1e-5, 1e-4, 2e-4, 5e-4, 1e-3}, speeds[] = {3, 5, 8};
	struct scene s = {.table = table_with_time(), .speed = speeds[_i], .window = 0.02 / speeds[_i]};
	struct hertz h = hertz_of(&s.table, RACK, s.speed);
	double lasts;
	pair_restitution(h, s.speed, &lasts);
	printf("%g m/s: a contact lasts %.0f us\n", s.speed, 1e6 * lasts);
	ck_assert(lasts > 240e-6 && lasts < 370e-6);
	for (int g = 0; g < 6; g++) {
		struct tally sum = {0};
		for (int k = 0; k < SHOTS; k++) {
			rack(&s, gap[g], (k - 2) * 0.35 * s.table.ball_radius + 1e-4);
			tally(&sum, &s, &h);
		}
		printf("gap %4.2f mm: %.1f reds move, judge %.1f (without time %.1f); rms %.3f (%.3f) of the cue "
		       "ball's speed; "
		       "fastest %.2f, judge %.2f\n",
		       1e3 * gap[g], sum.got, sum.want, sum.before, sqrt(sum.square), sqrt(sum.square_before),
		       sum.fastest, sum.fastest_want);
		fflush(stdout);
		ck_assert_double_le(fabs(sum.got - sum.want), 1);
		ck_assert_double_le(sqrt(sum.square), 0.05);
	}
}
END_TEST

/* ---- one ball into two ---- */

/* A ball between two, off their middle by so much: from a hit of both at once the way goes without a jump to one after
 * the other. */
START_TEST(one_into_two_off_centre)
{
	struct model model = real_model();
	static const double gaps[] = {0, 1e-4, 3e-3};
	struct scene s = {.table = table_with_time(), .count = 3, .speed = 3, .window = 3e-3};
	struct hertz h = hertz_of(&s.table, 3, s.speed);
	double d = 2 * s.table.ball_radius, half = 0.5 * (d + gaps[_i]), worst = 0, jump = 0;
	vec2 last[3] = {{0, 0}};
	for (int k = -5; k <= 50; k++) {
		double across = k > 0 ? 1e-5 * k : k > -5 ? pow(10, k - 5) : 0; /* 0, then 1 nm to 0.5 mm */
		double reach = half - across;
		s.ball[0] = ball_at(COLOUR_WHITE, (vec2){-sqrt(d * d - reach * reach) - 1e-7, across});
		s.ball[0].vel = (vec2){s.speed, 0};
		s.ball[1] = ball_at(COLOUR_RED, (vec2){0, half});
		s.ball[2] = ball_at(COLOUR_RED, (vec2){0, -half});
		vec2 want[3], got[3];
		judge(h, s.ball, s.window, want);
		simulate(&s, &model, got);
		for (int i = 0; i < 3; i++) {
			worst = fmax(worst, vec2_dist(want[i], got[i]) / s.speed);
			if (k > -5)
				jump = fmax(jump, vec2_dist(got[i], last[i]) / s.speed);
			last[i] = got[i];
		}
	}
	printf("gap %g mm: off the judge by at most %.3f of the speed, from step to step %.4f\n", 1e3 * gaps[_i], worst,
	       jump);
	fflush(stdout);
	ck_assert_double_le(worst, 0.05);
	ck_assert_double_le(jump, 0.02);
}
END_TEST

/* ---- properties ---- */

/* Momentum stays, energy never grows, and two balls alone meet by the law of a single contact, to the last bit. */
START_TEST(clusters_keep_momentum)
{
	struct table t = table_with_time();
	struct model model = real_model(), at_once = model;
	at_once.lasting_contacts = false;
	struct random r = random_begin("clusters_keep_momentum");
	int clusters = 0;
	for (int n = 0; n < 2000; n++) {
		struct ball ball[7];
		int count = 2 + n % 6;
		double d = 2 * t.ball_radius + random_in(&r, 0, 3e-4);
		/* no loss at all, of a third: the steps in time must not give what nothing takes */
		t.material.e_ball = n % 3 ? random_in(&r, 0.3, 1) : 1;
		t.material.mu_ball_a = n % 3 ? 0.009951 : 0;
		t.material.mu_ball_b = n % 3 ? 0.108 : 0;
		for (int i = 0; i < count; i++) {
			vec2 at = i == 0 ? (vec2){0, 0} : vec2_scale(vec2_from_angle((i - 1) * M_PI / 3), d);
			ball[i] = ball_at(COLOUR_RED, at);
		}
		double angle = random_in(&r, -M_PI, M_PI);
		ball[0].vel = vec2_scale(vec2_from_angle(angle), pow(10, random_in(&r, -4, 1)));
		for (int k = 0; k < 3; k++)
			ball[0].spin[k] = random_in(&r, -1, 1) * vec2_norm(ball[0].vel) / t.ball_radius;
		static struct sim sim, other, before;
		sim_init(&sim, &t, &model, ball, count);
		sim_init(&other, &t, &at_once, ball, count);
		struct event event;
		do
			before = sim;
		while (sim_step(&sim, &event) && event.kind != EVENT_BALL_BALL && sim.time < 1e-3);
		if (event.kind != EVENT_BALL_BALL)
			continue;
		clusters += sim.pending_count > 0;
		vec2 sum[2] = {{0, 0}, {0, 0}};
		before.time = sim.time;
		for (int i = 0; i < count; i++) {
			sum[0] = vec2_add(sum[0], sim_ball(&before, i).vel);
			sum[1] = vec2_add(sum[1], sim_ball(&sim, i).vel);
		}
		ck_assert_double_le(vec2_dist(sum[0], sum[1]), 2e-3 * vec2_norm(sum[0]));
		ck_assert_double_le(sim_energy(&sim), sim_energy(&before) * (1 + 1e-12));
		if (count > 2)
			continue;
		while (sim_step(&other, &event) && event.kind != EVENT_BALL_BALL)
			;
		ck_assert(sim_hash(&sim, 0) == sim_hash(&other, 0));
	}
	ck_assert_int_gt(clusters, 300);
}
END_TEST

/* A rack hit in its middle: what the one half does, the other does mirrored. */
START_TEST(a_rack_stays_mirrored)
{
	struct model model = real_model();
	for (int k = 0; k < 3; k++) {
		struct scene s = {.table = table_with_time(), .speed = 6, .window = 1e-9};
		vec2 vel[RACK];
		rack(&s, k * 1e-4, 0);
		s.ball[0].spin[1] = 0.3 * s.speed / s.table.ball_radius;
		simulate(&s, &model, vel);
		ck_assert_double_le(fabs(vel[0].y), 1e-9);
		for (int i = 1; i < RACK; i++) {
			for (int m = 1; m < RACK; m++) {
				vec2 mirrored = {s.ball[m].pos.x, -s.ball[m].pos.y};
				if (vec2_dist(mirrored, s.ball[i].pos) < 1e-9)
					ck_assert_double_le(vec2_dist(vel[i], (vec2){vel[m].x, -vel[m].y}), 1e-9);
			}
		}
	}
}
END_TEST

/* Balls that a camera saw overlap by a tenth of a millimetre are not under load: a slow hit across their line leaves the
 * second where it is, but for friction. */
START_TEST(overlaps_are_not_under_load)
{
	struct model model = real_model();
	struct scene s = {.table = table_with_time(), .count = 3, .speed = 0.02, .window = 1e-9};
	double d = 2 * s.table.ball_radius;
	vec2 vel[3];
	s.ball[0] = ball_at(COLOUR_WHITE, (vec2){-d, 0});
	s.ball[0].vel.x = s.speed;
	s.ball[1] = ball_at(COLOUR_RED, (vec2){0, 0});
	s.ball[2] = ball_at(COLOUR_RED, (vec2){-1e-6, d - 9e-5});
	simulate(&s, &model, vel);
	ck_assert_double_gt(vel[1].x, 0.9 * s.speed);
	ck_assert_double_lt(fabs(vel[1].y), 0.2 * s.speed);
	ck_assert_double_lt(vec2_norm(vel[2]), 0.2 * s.speed);
}
END_TEST

/* Of contacts that belong together the first is reported first, whatever the balls' numbers: who was hit first decides a
 * foul. */
START_TEST(the_first_hit_is_reported_first)
{
	struct table t = table_with_time();
	struct model model = real_model();
	double d = 2 * t.ball_radius, half = 0.6 * d;
	for (int first = 1; first <= 2; first++) {
		/* the cue ball's way is nearer to the one by 0.1 mm */
		double across = first == 1 ? 1e-4 : -1e-4;
		struct ball ball[4] = {ball_at(COLOUR_WHITE, (vec2){-0.1, across}),
				       ball_at(COLOUR_RED, (vec2){0, half}), ball_at(COLOUR_BLACK, (vec2){0, -half}),
				       ball_at(COLOUR_RED, (vec2){d, half + 1e-5})};
		ball[0].vel = (vec2){3, 0};
		static struct sim sim;
		struct event event;
		sim_init(&sim, &t, &model, ball, 4);
		do
			ck_assert(sim_step(&sim, &event));
		while (event.kind != EVENT_BALL_BALL);
		ck_assert(event.ball == 0 && event.other == first);
		bool both = false;
		double time = event.time;
		while (sim_step(&sim, &event) && event.time == time)
			both = both || (event.ball == 0 && event.other == 3 - first);
		ck_assert(both);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("cluster");
	TCase *tcase = tcase_create("cluster");
	tcase_set_timeout(tcase, 300);
	tcase_add_loop_test(tcase, racks_with_gaps, 0, 3);
	tcase_add_loop_test(tcase, one_into_two_off_centre, 0, 3);
	tcase_add_test(tcase, clusters_keep_momentum);
	tcase_add_test(tcase, a_rack_stays_mirrored);
	tcase_add_test(tcase, overlaps_are_not_under_load);
	tcase_add_test(tcase, the_first_hit_is_reported_first);
	suite_add_tcase(suite, tcase);
	return suite;
}
