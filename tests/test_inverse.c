/* Each backward function undoes the forward one of its name, and the forward ones agree with the motion itself. */
#include "harness.h"
#include "inverse_forward.h"
#include "scenes.h"

#include <math.h>

#include "physics/inverse.h"
#include "physics/motion.h"

START_TEST(backward_undoes_forward)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("backward_undoes_forward");
	int sliding = 0, rolling = 0;
	for (int i = 0; i < 100000; i++) {
		double v = random_in(&r, 0.01, 10), way = pow(10, random_in(&r, -3, 1)), cut = random_in(&r, 0.05, 1);
		double start = leg_backward(&table, v, way);
		ck_assert_double_eq_tol(leg_forward(&table, start, way), v, 1e-11 * start);
		double slide = 12.0 / 49 * start * start / (table.material.mu_slide * table.material.gravity);
		sliding += way < slide;
		rolling += way > slide;
		start = leg_rolling_backward(&table, v, way);
		ck_assert_double_eq_tol(leg_rolling_forward(&table, start, way), v, 1e-11 * start);
		ck_assert_double_eq_tol(hit_forward(&table, hit_backward(&table, v, cut), cut), v, 1e-14 * v);
		ck_assert_double_eq_tol(cushion_forward(&table, cushion_backward(&table, v)), v, 1e-14 * v);
	}
	ck_assert_int_gt(sliding, 5000);
	ck_assert_int_gt(rolling, 5000);
}
END_TEST

START_TEST(branches_meet)
{
	struct table table = scene_thesis_table();
	const struct material *m = &table.material;
	for (double v = 0.1; v < 8; v += 0.1) {
		double slide = 12.0 / 49 * v * v / (m->mu_slide * m->gravity);
		double before = leg_forward(&table, v, slide * (1 - 1e-12)),
		       after = leg_forward(&table, v, slide * (1 + 1e-12));
		ck_assert_double_eq_tol(before, 5.0 / 7 * v, 1e-10);
		ck_assert_double_eq_tol(after, 5.0 / 7 * v, 1e-10);
		ck_assert_double_eq_tol(leg_backward(&table, 5.0 / 7 * v, slide * (1 - 1e-12)), v, 1e-10);
		ck_assert_double_eq_tol(leg_backward(&table, 5.0 / 7 * v, slide * (1 + 1e-12)), v, 1e-10);
	}
}
END_TEST

/* The way and speed of the closed-form motion at random times. */
START_TEST(forward_is_the_motion)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("forward_is_the_motion");
	for (int i = 0; i < 10000; i++) {
		struct ball b = ball_at(COLOUR_WHITE, (vec2){0, 0});
		double v = random_in(&r, 0.01, 10);
		b.vel = (vec2){v, 0};
		motion_classify(&b, &table);
		enum event_kind kind;
		double end = motion_phase_end(&b, &table, &kind);
		struct ball at = motion_advance(&b, &table, random_in(&r, 0, 1) * end);
		ck_assert_double_eq_tol(leg_forward(&table, v, at.pos.x), at.vel.x, 1e-12 * v);
		at = motion_advance(&b, &table, end);
		motion_transition(&at, &table, kind);
		double from = at.pos.x, speed = at.vel.x;
		at = motion_advance(&at, &table, random_in(&r, 0, 0.99) * motion_phase_end(&at, &table, &kind));
		ck_assert_double_eq_tol(leg_forward(&table, v, at.pos.x), at.vel.x, 1e-11 * v);
		ck_assert_double_eq_tol(leg_rolling_forward(&table, speed, at.pos.x - from), at.vel.x, 1e-11 * v);
	}
}
END_TEST

START_TEST(a_way_too_long_leaves_nothing)
{
	struct table table = scene_thesis_table();
	ck_assert_double_eq(leg_forward(&table, 0.5, 10), 0);
	ck_assert_double_eq(leg_rolling_forward(&table, 0.5, 10), 0);
	ck_assert_double_eq(leg_forward(&table, 0, 0), 0);
	ck_assert_double_eq(leg_backward(&table, 0, 0), 0);
}
END_TEST

/* The cosine of two equal directions is often 1 + 2^-52: a straight hit, not a fault. */
START_TEST(straight_on_is_the_border)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("straight_on_is_the_border");
	int beyond = 0;
	for (int i = 0; i < 1000; i++) {
		vec2 d = {random_in(&r, -1, 1), random_in(&r, -1, 1)};
		double cosine = vec2_dot(vec2_unit(d), d) / sqrt(vec2_norm2(d));
		beyond += cosine > 1;
		if (cosine >= 1) {
			ck_assert(hit_backward(&table, 2, cosine) == hit_backward(&table, 2, 1));
			ck_assert(hit_forward(&table, 2, cosine) == hit_forward(&table, 2, 1));
		}
	}
	ck_assert_int_gt(beyond, 10);
	ck_assert(isinf(hit_backward(&table, 2, 0)));
	ck_assert_double_eq(hit_forward(&table, 2, 0), 0);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("inverse");
	TCase *tcase = tcase_create("inverse");
	tcase_add_test(tcase, backward_undoes_forward);
	tcase_add_test(tcase, branches_meet);
	tcase_add_test(tcase, forward_is_the_motion);
	tcase_add_test(tcase, a_way_too_long_leaves_nothing);
	tcase_add_test(tcase, straight_on_is_the_border);
	suite_add_tcase(suite, tcase);
	return suite;
}
