/* Closed-form motion against GSL's integration of the equations of motion, and against itself. */
#include "harness.h"
#include "scenes.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <string.h>

#include "physics/motion.h"

static struct ball random_sliding(struct random *r, const struct table *table)
{
	struct ball b = ball_at(COLOUR_WHITE, (vec2){random_in(r, -0.5, 0.5), random_in(r, -0.3, 0.3)});
	b.vel = (vec2){random_in(r, -4, 4), random_in(r, -4, 4)};
	for (int i = 0; i < 3; i++)
		b.spin[i] = random_in(r, -4, 4) / table->ball_radius;
	motion_classify(&b, table);
	return b;
}

/* y = x, y, vx, vy, wx, wy: friction at the contact point and its torque about the centre. */
static int equations(double t, const double y[], double dydt[], void *params)
{
	const struct table *table = params;
	const struct material *m = &table->material;
	double r = table->ball_radius, ux = y[2] - r * y[5], uy = y[3] + r * y[4], u = hypot(ux, uy);
	double fx = -m->mu_slide * m->gravity * ux / u, fy = -m->mu_slide * m->gravity * uy / u; /* per mass */
	(void)t;
	dydt[0] = y[2];
	dydt[1] = y[3];
	dydt[2] = fx;
	dydt[3] = fy;
	/* (0, 0, -r) x f / (2/5 r^2) */
	dydt[4] = 2.5 / r * fy;
	dydt[5] = -2.5 / r * fx;
	return GSL_SUCCESS;
}

START_TEST(sliding_agrees_with_integration)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("sliding_agrees_with_integration");
	gsl_odeiv2_system system = {equations, NULL, 6, &table};
	for (int i = 0; i < 200; i++) {
		struct ball b = random_sliding(&r, &table);
		enum event_kind kind;
		double end = 0.99 * motion_phase_end(&b, &table, &kind), t = 0;
		double y[6] = {b.pos.x, b.pos.y, b.vel.x, b.vel.y, b.spin[0], b.spin[1]};
		gsl_odeiv2_driver *driver =
			gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-4, 1e-12, 1e-12);
		ck_assert_int_eq(gsl_odeiv2_driver_apply(driver, &t, end, y), GSL_SUCCESS);
		gsl_odeiv2_driver_free(driver);
		struct ball after = motion_advance(&b, &table, end);
		ck_assert_double_le(hypot(after.pos.x - y[0], after.pos.y - y[1]), 1e-9);
		ck_assert_double_le(hypot(after.vel.x - y[2], after.vel.y - y[3]), 1e-8);
		ck_assert_double_le(hypot(after.spin[0] - y[4], after.spin[1] - y[5]), 1e-6);
	}
}
END_TEST

/* Drilling friction of constant size, in every phase, until the spin is gone. */
START_TEST(vertical_spin_decays)
{
	struct table table = scene_thesis_table();
	double rate = 2.5 * table.material.mu_spin * table.material.gravity / (table.ball_radius * table.ball_radius);
	for (int rolls = 0; rolls < 2; rolls++) {
		struct ball b = ball_at(COLOUR_WHITE, (vec2){0, 0});
		b.vel = (vec2){1, 0};
		if (rolls)
			motion_roll(&b, &table);
		b.spin[2] = -20;
		motion_classify(&b, &table);
		ck_assert_double_eq_tol(motion_advance(&b, &table, 0.02).spin[2], -20 + 0.02 * rate, 1e-12);
		ck_assert_double_eq(motion_advance(&b, &table, 20 / rate + 1e-9).spin[2], 0);
	}
}
END_TEST

START_TEST(slip_ends_when_it_is_said_to)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("slip_ends_when_it_is_said_to");
	for (int i = 0; i < 2000; i++) {
		struct ball b = random_sliding(&r, &table);
		enum event_kind kind;
		double end = motion_phase_end(&b, &table, &kind);
		vec2 before = motion_slip(&b, table.ball_radius);
		struct ball half = motion_advance(&b, &table, 0.5 * end), after = motion_advance(&b, &table, end);
		vec2 slip = motion_slip(&half, table.ball_radius);
		ck_assert_int_eq(kind, EVENT_SLIDING_ROLLING);
		/* keeps its direction, loses its size evenly */
		ck_assert_double_le(vec2_dist(slip, vec2_scale(before, 0.5)), 1e-13);
		ck_assert_double_le(vec2_norm(motion_slip(&after, table.ball_radius)), 1e-13);
		motion_transition(&after, &table, kind);
		ck_assert_int_eq(after.phase, BALL_ROLLING);
		ck_assert_double_le(vec2_norm(motion_slip(&after, table.ball_radius)), 1e-15);
	}
}
END_TEST

START_TEST(a_ball_without_spin_keeps_five_sevenths)
{
	struct table table = scene_thesis_table();
	const struct material *m = &table.material;
	struct ball b = ball_at(COLOUR_WHITE, (vec2){0, 0});
	b.vel = (vec2){2, 0};
	motion_classify(&b, &table);
	enum event_kind kind;
	double end = motion_phase_end(&b, &table, &kind);
	ck_assert_double_eq_tol(end, 2 / (3.5 * m->gravity * m->mu_slide), 1e-15); /* 4.99 */
	struct ball after = motion_advance(&b, &table, end);
	ck_assert_double_eq_tol(after.vel.x, 10.0 / 7, 1e-14);
	ck_assert_double_eq_tol(after.pos.x, 12.0 / 49 * 4 / (m->gravity * m->mu_slide), 1e-14); /* 8.12 */
}
END_TEST

START_TEST(parts_add_up)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("parts_add_up");
	for (int i = 0; i < 2000; i++) {
		struct ball b = random_sliding(&r, &table);
		if (i & 1)
			motion_roll(&b, &table);
		enum event_kind kind;
		double end = motion_phase_end(&b, &table, &kind), part = random_in(&r, 0, 1) * end;
		struct ball whole = motion_advance(&b, &table, 0.9 * end);
		struct ball first = motion_advance(&b, &table, 0.9 * part),
			    sum = motion_advance(&first, &table, 0.9 * (end - part));
		ck_assert_double_le(vec2_dist(whole.pos, sum.pos), 1e-12);
		ck_assert_double_le(vec2_dist(whole.vel, sum.vel), 1e-12);
		ck_assert_double_le(fabs(whole.spin[2] - sum.spin[2]), 1e-9);
	}
}
END_TEST

START_TEST(rolling_and_spinning_end)
{
	struct table table = scene_thesis_table();
	struct ball b = ball_at(COLOUR_RED, (vec2){0, 0});
	b.vel = (vec2){0.3, 0.4};
	motion_roll(&b, &table);
	enum event_kind kind;
	double end = motion_phase_end(&b, &table, &kind);
	ck_assert_double_eq_tol(end, 0.5 / (table.material.mu_roll * table.material.gravity), 1e-14);
	ck_assert_int_eq(kind, EVENT_ROLLING_REST);
	struct ball after = motion_advance(&b, &table, end);
	ck_assert_double_le(vec2_norm(after.vel), 1e-15);
	b.spin[2] = 1e4;
	motion_phase_end(&b, &table, &kind);
	ck_assert_int_eq(kind, EVENT_ROLLING_SPINNING);
	after = motion_advance(&b, &table, end);
	motion_transition(&after, &table, kind);
	ck_assert_int_eq(after.phase, BALL_SPINNING);
	end = motion_phase_end(&after, &table, &kind);
	ck_assert_int_eq(kind, EVENT_SPINNING_REST);
	after = motion_advance(&after, &table, end);
	motion_transition(&after, &table, kind);
	ck_assert_int_eq(after.phase, BALL_REST);
	ck_assert(isinf(motion_phase_end(&after, &table, &kind)));
	ck_assert_int_eq(kind, EVENT_NONE);
}
END_TEST

START_TEST(phases_from_velocity_and_spin)
{
	struct table table = scene_thesis_table();
	struct ball b = ball_at(COLOUR_RED, (vec2){0, 0});
	motion_classify(&b, &table);
	ck_assert_int_eq(b.phase, BALL_REST);
	b.spin[2] = 3;
	motion_classify(&b, &table);
	ck_assert_int_eq(b.phase, BALL_SPINNING);
	b.vel = (vec2){1e-6, 0};
	motion_classify(&b, &table);
	ck_assert_int_eq(b.phase, BALL_SLIDING);
	motion_roll(&b, &table);
	motion_classify(&b, &table);
	ck_assert_int_eq(b.phase, BALL_ROLLING);
	b.vel = (vec2){0, 0};
	motion_classify(&b, &table);
	ck_assert_int_eq(b.phase, BALL_SLIDING); /* draws on the spot */
}
END_TEST

/* A phase is not run backwards, and what rests or has fallen stays. */
START_TEST(time_only_goes_on)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("time_only_goes_on");
	for (int i = 0; i < 1000; i++) {
		struct ball b = random_sliding(&r, &table), after = motion_advance(&b, &table, -1e-3);
		ck_assert(memcmp(&b, &after, sizeof b) == 0);
		b.phase = i & 1 ? BALL_REST : BALL_POTTED;
		after = motion_advance(&b, &table, 1);
		ck_assert(memcmp(&b, &after, sizeof b) == 0);
	}
}
END_TEST

/* Which of roll and vertical spin ends first decides what comes: a step to each side of the tie. */
START_TEST(roll_or_spin_ends_first)
{
	struct table table = scene_thesis_table();
	const struct material *m = &table.material;
	double r = table.ball_radius, rate = 2.5 * m->mu_spin * m->gravity / (r * r);
	for (int sign = -1; sign <= 1; sign += 2) {
		struct ball b = ball_at(COLOUR_RED, (vec2){0, 0});
		b.vel = (vec2){0.7, -0.2};
		motion_roll(&b, &table);
		enum event_kind kind;
		double spin = rate * motion_phase_end(&b, &table, &kind);
		b.spin[2] = sign * spin * (1 + 1e-9);
		motion_phase_end(&b, &table, &kind);
		ck_assert_int_eq(kind, EVENT_ROLLING_SPINNING);
		b.spin[2] = sign * spin * (1 - 1e-9);
		motion_phase_end(&b, &table, &kind);
		ck_assert_int_eq(kind, EVENT_ROLLING_REST);
	}
}
END_TEST

/* What an end of a phase demands holds exactly: no speed, no spin that rounding has left. */
START_TEST(ends_are_exact)
{
	struct table table = scene_thesis_table();
	struct ball b = ball_at(COLOUR_RED, (vec2){0, 0});
	b.phase = BALL_ROLLING;
	b.vel = (vec2){1e-17, -1e-18};
	b.spin[2] = 1e-16;
	motion_transition(&b, &table, EVENT_ROLLING_REST);
	ck_assert(b.phase == BALL_REST && b.spin[2] == 0 && b.vel.x == 0 && b.spin[0] == 0 && b.spin[1] == 0);
	for (int k = 0; k < 3; k++) {
		b = ball_at(COLOUR_RED, (vec2){0, 0});
		b.phase = BALL_SLIDING;
		b.vel.x = k == 2 ? 1.01e-8 : 0.99e-8;
		b.spin[2] = k == 1 ? 3 : 0;
		motion_transition(&b, &table, EVENT_SLIDING_ROLLING);
		ck_assert_int_eq(b.phase, k == 0 ? BALL_REST : k == 1 ? BALL_SPINNING : BALL_ROLLING);
		ck_assert(k == 2 ? b.vel.x > 0 : b.vel.x == 0);
	}
}
END_TEST

/* The borders of rest and of rolling, a step inside and a step outside. */
START_TEST(rest_and_roll_have_a_border)
{
	struct table table = scene_thesis_table();
	double r = table.ball_radius;
	for (int k = 0; k < 2; k++) {
		double f = k ? 1.01 : 0.99;
		struct ball b = ball_at(COLOUR_RED, (vec2){0, 0});
		b.vel = (vec2){0, f * 1e-8};
		motion_classify(&b, &table);
		ck_assert_int_eq(b.phase, k ? BALL_SLIDING : BALL_REST);
		b.vel = (vec2){0, 0};
		b.spin[0] = f * 1e-8 / r;
		motion_classify(&b, &table);
		ck_assert_int_eq(b.phase, k ? BALL_SLIDING : BALL_REST);
		b.spin[0] = 0;
		b.spin[2] = f * 1e-8 / r;
		motion_classify(&b, &table);
		ck_assert_int_eq(b.phase, k ? BALL_SPINNING : BALL_REST);
		ck_assert(k || b.spin[2] == 0);
		b.spin[2] = 5;
		b.vel = (vec2){1, 0};
		motion_roll(&b, &table);
		ck_assert(b.spin[2] == 0 && b.phase == BALL_ROLLING);
		b.spin[1] += f * 2e-13 / r;
		motion_classify(&b, &table);
		ck_assert_int_eq(b.phase, k ? BALL_SLIDING : BALL_ROLLING);
		b.vel = (vec2){f * 1e-8, 0};
		motion_roll(&b, &table);
		ck_assert_int_eq(b.phase, k ? BALL_ROLLING : BALL_REST);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("motion");
	TCase *tcase = tcase_create("motion");
	tcase_set_timeout(tcase, 60);
	tcase_add_test(tcase, sliding_agrees_with_integration);
	tcase_add_test(tcase, vertical_spin_decays);
	tcase_add_test(tcase, slip_ends_when_it_is_said_to);
	tcase_add_test(tcase, a_ball_without_spin_keeps_five_sevenths);
	tcase_add_test(tcase, parts_add_up);
	tcase_add_test(tcase, rolling_and_spinning_end);
	tcase_add_test(tcase, phases_from_velocity_and_spin);
	tcase_add_test(tcase, time_only_goes_on);
	tcase_add_test(tcase, roll_or_spin_ends_first);
	tcase_add_test(tcase, ends_are_exact);
	tcase_add_test(tcase, rest_and_roll_have_a_border);
	suite_add_tcase(suite, tcase);
	return suite;
}
