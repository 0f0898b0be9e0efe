/* A bed that is not level against GSL's integration of the equations of motion, and what must follow from them. */
#include "harness.h"
#include "scenes.h"

#include <errno.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "physics/bed.h"
#include "physics/motion.h"
#include "physics/sim.h"

static struct table sloping(double slope_x, double slope_y, double xx, double xy, double yy)
{
	struct table t = scene_snooker_table();
	char err[200];
	t.bed = (struct bed){.slope = {slope_x, slope_y}, .bowl = {xx, xy, yy}};
	ck_assert_msg(table_finish(&t, err, sizeof err) == 0, "%s", err);
	return t;
}

static struct table random_bed(struct random *r)
{
	double bend = random_u64(r) & 1 ? 2e-3 : 0;
	return sloping(random_in(r, -2e-3, 2e-3), random_in(r, -2e-3, 2e-3), random_in(r, -bend, bend),
		       random_in(r, -bend, bend), random_in(r, -bend, bend));
}

/* ---- the judge: x, y, vx, vy, wx, wy from forces and torques; the height by differences ---- */

static double height(const struct table *t, double x, double y)
{
	const struct bed *b = &t->bed;
	return b->slope.x * x + b->slope.y * y + 0.5 * b->bowl[0] * x * x + b->bowl[1] * x * y +
	       0.5 * b->bowl[2] * y * y;
}

static void pull(const struct table *t, double x, double y, double out[2])
{
	double d = 0.5; /* exact for a quadratic */
	out[0] = -t->material.gravity * (height(t, x + d, y) - height(t, x - d, y)) / (2 * d);
	out[1] = -t->material.gravity * (height(t, x, y + d) - height(t, x, y - d)) / (2 * d);
}

static int sliding(double time, const double y[], double dydt[], void *params)
{
	const struct table *t = params;
	double r = t->ball_radius, ux = y[2] - r * y[5], uy = y[3] + r * y[4], u = hypot(ux, uy), p[2];
	double fx = -t->material.mu_slide * t->material.gravity * ux / u,
	       fy = -t->material.mu_slide * t->material.gravity * uy / u;
	(void)time;
	pull(t, y[0], y[1], p);
	const double out[6] = {y[2], y[3], fx + p[0], fy + p[1], 2.5 / r * fy, -2.5 / r * fx};
	memcpy(dydt, out, sizeof out);
	return GSL_SUCCESS;
}

/* The force f at the contact turns as it pushes: f = -2/7 of the pull; the resistance is per mass on the centre. */
static int rolling(double time, const double y[], double dydt[], void *params)
{
	const struct table *t = params;
	double v = hypot(y[2], y[3]), p[2], f = t->material.mu_roll * t->material.gravity;
	(void)time;
	pull(t, y[0], y[1], p);
	const double out[4] = {y[2], y[3], p[0] - 2 * p[0] / 7 - f * y[2] / v, p[1] - 2 * p[1] / 7 - f * y[3] / v};
	memcpy(dydt, out, sizeof out);
	return GSL_SUCCESS;
}

/* The judge's state at `end` from a ball. */
static void judge(const struct table *table, const struct ball *b, double end, double y[6])
{
	bool slides = b->phase == BALL_SLIDING;
	const double start[6] = {b->pos.x, b->pos.y, b->vel.x, b->vel.y, b->spin[0], b->spin[1]};
	memcpy(y, start, sizeof start);
	double t = 0;
	gsl_odeiv2_system system = {slides ? sliding : rolling, NULL, slides ? 6 : 4, (void *)table};
	gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-4, 1e-13, 1e-13);
	gsl_odeiv2_driver_set_nmax(driver, 100000);
	ck_assert_int_eq(gsl_odeiv2_driver_apply(driver, &t, end, y), GSL_SUCCESS);
	gsl_odeiv2_driver_free(driver);
}

static struct ball random_mover(struct random *r, const struct table *t)
{
	struct ball b = ball_at(COLOUR_WHITE, (vec2){random_in(r, -1.5, 1.5), random_in(r, -0.7, 0.7)});
	b.vel = vec2_scale(vec2_from_angle(random_in(r, -M_PI, M_PI)), pow(10, random_in(r, -2, 0.7)));
	if (random_u64(r) & 1) {
		motion_roll(&b, t);
		return b;
	}
	for (int i = 0; i < 2; i++)
		b.spin[i] = random_in(r, -2, 2) * vec2_norm(b.vel) / t->ball_radius;
	motion_classify(&b, t);
	return b;
}

/* Runs one phase piece by piece; at each joint and at moments between, place and velocity are the judge's. */
START_TEST(a_phase_is_the_judge_s)
{
	struct random r = random_begin("a_phase_is_the_judge_s");
	double worst_between = 0, worst_joint = 0, worst_speed = 0, worst_spin = 0;
	int pieces = 0, phases = 300;
	for (int n = 0; n < phases; n++) {
		struct table t = random_bed(&r);
		struct ball start = random_mover(&r, &t), b = start;
		double time = 0;
		enum event_kind kind;
		do {
			double end = motion_phase_end(&b, &t, &kind);
			for (int k = 1; k <= 3; k++) {
				double y[6], dt = end * k / 3 * (k == 3 && kind != EVENT_PIECE ? 0.999 : 1);
				struct ball at = motion_advance(&b, &t, dt);
				judge(&t, &start, time + dt, y);
				double off = hypot(at.pos.x - y[0], at.pos.y - y[1]);
				worst_between = fmax(worst_between, off);
				ck_assert_double_le(off, t.bed.path_error + 5e-6);
				worst_joint = fmax(worst_joint, k == 3 && kind == EVENT_PIECE ? off : 0);
				worst_speed = fmax(worst_speed, hypot(at.vel.x - y[2], at.vel.y - y[3]));
				if (start.phase == BALL_SLIDING)
					worst_spin = fmax(worst_spin, hypot(at.spin[0] - y[4], at.spin[1] - y[5]));
			}
			b = motion_advance(&b, &t, end);
			motion_transition(&b, &t, kind);
			time += end;
			ck_assert_int_lt(++pieces, 200 * phases);
		} while (kind == EVENT_PIECE && fabs(b.pos.x) < t.length / 2 && fabs(b.pos.y) < t.width / 2);
	}
	printf("%d phases, %.1f pieces each: off by %.2g m between, %.2g m at joints, %.2g m/s, %.2g rad/s\n", phases,
	       (double)pieces / phases, worst_between, worst_joint, worst_speed, worst_spin);
	fflush(stdout);
	ck_assert_double_le(worst_joint, 5e-6);
	ck_assert_double_le(worst_speed, 1e-4);
	ck_assert_double_le(worst_spin, 1e-2);
}
END_TEST

/* Straight up and straight down a plane the way has a closed form: v^2 / 2 over friction plus or less 5/7 of the pull. One
 * piece, exact. */
START_TEST(straight_up_and_down)
{
	for (int k = 0; k < 4; k++) {
		double slope = k & 1 ? 2e-3 : -2e-3;
		struct table t = k & 2 ? sloping(slope, 0, 0, 0, 0) : sloping(0, slope, 0, 0, 0);
		struct ball b = ball_at(COLOUR_WHITE, (vec2){0, 0});
		double v = 0.3, g = t.material.gravity, a = t.material.mu_roll * g + 5.0 / 7 * slope * g;
		b.vel = k & 2 ? (vec2){v, 0} : (vec2){0, v};
		motion_roll(&b, &t);
		enum event_kind kind;
		double end = motion_phase_end(&b, &t, &kind);
		ck_assert_int_eq(kind, EVENT_ROLLING_REST);
		ck_assert_double_eq_tol(end, v / a, 1e-13);
		struct ball after = motion_advance(&b, &t, end);
		ck_assert_double_eq_tol(vec2_norm(after.pos), 0.5 * v * v / a, 1e-13);
		ck_assert_double_le(vec2_norm(after.vel), 1e-15);
	}
}
END_TEST

/* A ball rests where rolling friction holds it, and a bed where it would not is refused: 5/7 of the slope against mu_roll,
 * at the bed's steepest corner. */
START_TEST(rest_or_refused)
{
	struct table t = scene_snooker_table();
	double limit = 1.4 * t.material.mu_roll * 0.9;
	for (int k = 0; k < 2; k++) {
		double f = k ? 1.001 : 0.999;
		t.bed = (struct bed){.slope = {0.6 * f * limit, 0.8 * f * limit}};
		char err[200] = "";
		ck_assert_int_eq(table_finish(&t, err, sizeof err), k ? -EINVAL : 0);
		ck_assert(!k || strstr(err, "steep"));
		t.bed = (struct bed){.bowl = {f * limit / (0.55 * t.length), 0, 0}};
		ck_assert_int_eq(table_finish(&t, err, sizeof err), k ? -EINVAL : 0);
		t.bed = (struct bed){.bowl = {0, 0, -f * limit / (0.55 * t.width)}};
		ck_assert_int_eq(table_finish(&t, err, sizeof err), k ? -EINVAL : 0);
	}
	t.bed = (struct bed){.slope = {NAN, 0}};
	ck_assert_int_eq(table_finish(&t, NULL, 0), -EINVAL);
	t.bed = (struct bed){.bowl = {0, INFINITY, 0}};
	ck_assert_int_eq(table_finish(&t, NULL, 0), -EINVAL);
	t.bed = (struct bed){.path_error = -1};
	ck_assert_int_eq(table_finish(&t, NULL, 0), -EINVAL);

	t = sloping(3e-3, -2e-3, 1e-3, 1e-3, -1e-3);
	struct model model;
	model_from_name("real", &model);
	struct ball rack[SCENE_RACK_COUNT];
	scene_rack(&t, rack);
	static struct sim sim;
	sim_init(&sim, &t, &model, rack, SCENE_RACK_COUNT);
	struct event event;
	ck_assert(!sim_step(&sim, &event));
}
END_TEST

/* The finer, the nearer, and a level bed has no pieces. */
START_TEST(error_is_what_is_asked_for)
{
	double error[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
	int before = 0;
	for (int n = 0; n < 5; n++) {
		struct table t = scene_snooker_table();
		t.bed = (struct bed){.slope = {1e-3, 2e-3}, .bowl = {1e-3, 0, -1e-3}, .path_error = error[n]};
		ck_assert_int_eq(table_finish(&t, NULL, 0), 0);
		struct ball start = ball_at(COLOUR_WHITE, (vec2){-1.5, -0.5}), b;
		start.vel = (vec2){0.5, 0.1};
		motion_roll(&start, &t);
		b = start;
		double time = 0, worst = 0;
		enum event_kind kind;
		int pieces = 0;
		do {
			double y[6], end = motion_phase_end(&b, &t, &kind);
			for (int k = 1; k < 4; k++) {
				judge(&t, &start, time + end * k / 4, y);
				struct ball at = motion_advance(&b, &t, end * k / 4);
				worst = fmax(worst, hypot(at.pos.x - y[0], at.pos.y - y[1]));
			}
			b = motion_advance(&b, &t, end);
			time += end;
			pieces++;
		} while (kind == EVENT_PIECE);
		printf("path error %g m: %d pieces, off by %.2g m\n", error[n], pieces, worst);
		fflush(stdout);
		ck_assert_double_le(worst, error[n] + 3e-6);
		ck_assert_int_gt(pieces, before);
		before = pieces;
	}
	struct table level = scene_snooker_table();
	ck_assert(!level.bed.uneven);
	struct ball b = ball_at(COLOUR_WHITE, (vec2){0, 0});
	b.vel = (vec2){0.5, 0.1};
	motion_classify(&b, &level);
	enum event_kind kind;
	motion_phase_end(&b, &level, &kind);
	ck_assert_int_eq(kind, EVENT_SLIDING_ROLLING);
}
END_TEST

/* A slow ball that rolls along a cushion onto which the slope draws it, and the same with a ball to push: ends, stays
 * before the nose, and not by thousands of events. */
START_TEST(drawn_to_a_cushion)
{
	struct table t = sloping(0, -4e-3, 0, 0, 0); /* down to the left, +y */
	int most = 0;
	static const char *const name[] = {"simple-elastic", "simple", "thesis", "real", "real-mathavan"};
	for (int k = 0; k < 5; k++) {
		struct model model;
		model_from_name(name[k], &model);
		double edge = 0.889 - t.ball_radius;
		for (int n = 0; n < 20; n++) {
			struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){0.3, edge - (n & 1 ? 0 : 1e-3 * n)}),
					       ball_at(COLOUR_RED, (vec2){0.3 + 2 * t.ball_radius + (n & 2 ? 0 : 0.1),
									  edge - 1e-3 * (n % 3)})};
			ball[0].vel = (vec2){0.05 + 0.02 * n, n & 1 ? 0 : -1e-3 * n};
			motion_roll(&ball[0], &t);
			static struct sim sim;
			sim_init(&sim, &t, &model, ball, 2);
			struct event event;
			while (sim_step(&sim, &event)) {
				for (int i = 0; i < 2; i++)
					ck_assert(sim_ball(&sim, i).phase == BALL_POTTED ||
						  sim_ball(&sim, i).pos.x > 1.6 ||
						  sim_ball(&sim, i).pos.y <= edge + 1e-9);
				ck_assert_int_lt(sim.event_count, 2000);
			}
			most = sim.event_count > most ? sim.event_count : most;
		}
	}
	printf("drawn to a cushion: at most %d events\n", most);
	fflush(stdout);
}
END_TEST

/* Turning table, slope and shot by half a turn turns the result; mirroring mirrors it. */
START_TEST(symmetries)
{
	struct model model;
	model_from_name("real", &model);
	struct table t[3] = {sloping(1e-3, 2e-3, 5e-4, 2e-4, 1e-3), sloping(-1e-3, -2e-3, 5e-4, 2e-4, 1e-3),
			     sloping(1e-3, -2e-3, 5e-4, -2e-4, 1e-3)};
	struct ball end[3][2];
	for (int k = 0; k < 3; k++) {
		double sx = k == 1 ? -1 : 1, sy = k == 0 ? 1 : -1;
		struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){sx * -1, sy * 0.2}),
				       ball_at(COLOUR_RED, (vec2){0, sy * 0.21})};
		struct sim sim;
		sim_init(&sim, &t[k], &model, ball, 2);
		struct shot shot = {.angle = atan2(sy * 0.01, sx), .speed = 1.2, .side = k == 2 ? -0.2 : 0.2};
		sim_strike(&sim, 0, &shot);
		sim_run(&sim, &(struct sim_limits){INFINITY, 1000}, NULL);
		for (int i = 0; i < 2; i++) {
			end[k][i] = sim_ball(&sim, i);
			end[k][i].pos.x *= sx;
			end[k][i].pos.y *= sy;
			ck_assert_double_le(vec2_dist(end[k][i].pos, end[0][i].pos), 1e-9);
			ck_assert_int_eq(end[k][i].phase, BALL_REST);
		}
	}
}
END_TEST

/* 2 mm per metre across: a ball that rolls for 3 m is drawn aside by centimetres, as a judge of the rolling says. */
START_TEST(a_slope_is_felt)
{
	struct table t = sloping(0, 2e-3, 0, 0, 0);
	struct ball b = ball_at(COLOUR_WHITE, (vec2){-1.5, 0});
	b.vel = (vec2){0.75, 0};
	motion_roll(&b, &t);
	struct model model;
	model_from_name("real", &model);
	static struct sim sim;
	static struct trace_entry entry[100];
	struct trace trace;
	trace_init(&trace, entry, 100);
	sim_init(&sim, &t, &model, &b, 1);
	ck_assert_int_eq(sim_run(&sim, &(struct sim_limits){INFINITY, 100}, &trace), SIM_AT_REST);
	double y[6];
	judge(&t, &b, 0.9999 * sim.time, y);
	printf("rolled %.3f m, aside %.1f mm, %d events\n", sim.ball[0].pos.x + 1.5, 1e3 * sim.ball[0].pos.y,
	       sim.event_count);
	ck_assert_double_lt(sim.ball[0].pos.y, -0.1);
	ck_assert_double_eq_tol(sim.ball[0].pos.y, y[1], 1e-5);
	for (int k = 0; k < 100; k++) {
		struct ball at = trace_at(&trace, 0, 0.01 * k * sim.time);
		judge(&t, &b, 0.01 * k * sim.time + 1e-12, y);
		ck_assert_double_le(hypot(at.pos.x - y[0], at.pos.y - y[1]), 1.5e-5);
		ck_assert_double_le(hypot(at.vel.x - y[2], at.vel.y - y[3]), 1e-4);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("bed");
	TCase *tcase = tcase_create("bed");
	tcase_set_timeout(tcase, 120);
	tcase_add_test(tcase, a_phase_is_the_judge_s);
	tcase_add_test(tcase, straight_up_and_down);
	tcase_add_test(tcase, rest_or_refused);
	tcase_add_test(tcase, error_is_what_is_asked_for);
	tcase_add_test(tcase, drawn_to_a_cushion);
	tcase_add_test(tcase, symmetries);
	tcase_add_test(tcase, a_slope_is_felt);
	suite_add_tcase(suite, tcase);
	return suite;
}
