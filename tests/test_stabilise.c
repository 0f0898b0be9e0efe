#include "vision/stabilise.h"

#include <math.h>

#include "vision_scene.h"

static const double mm = 1e-3, noise = 0.2e-3, dt = 1 / 30.0;

static vec2 jitter(struct random *r, vec2 p)
{
	return (vec2){p.x + 0.7 * noise * scene_gauss(r), p.y + 0.7 * noise * scene_gauss(r)};
}

START_TEST(test_resting_ball_settles)
{
	struct random r = random_begin("stabilise_rest");
	vec2 truth = {0.3, -0.2}, last;
	struct stabiliser s = stabilise_begin(jitter(&r, truth), 0);
	double worst = 0, sum = 0;
	for (int i = 1; i < 400; i++) {
		last = s.pos;
		stabilise_add(&s, jitter(&r, truth), i * dt, noise);
		if (i > 60) {
			worst = fmax(worst, vec2_dist(s.pos, truth));
			sum += vec2_dist(s.pos, last);
			ck_assert(!s.moving);
			ck_assert(s.vel.x == 0 && s.vel.y == 0);
		}
	}
	ck_assert_double_lt(worst, 0.1 * mm);
	ck_assert_double_lt(sum / 340, 0.01 * mm);
}
END_TEST

START_TEST(test_rolling_ball_does_not_lag)
{
	struct random r = random_begin("stabilise_roll");
	vec2 v = {1.2, 0.5}, from = {-0.5, 0};
	struct stabiliser s = stabilise_begin(from, 0);
	for (int i = 1; i < 10; i++)
		stabilise_add(&s, jitter(&r, from), i * dt, noise);
	for (int i = 0; i < 20; i++) {
		vec2 truth = vec2_madd(from, i * dt, v);
		stabilise_add(&s, jitter(&r, truth), (10 + i) * dt, noise);
		if (i > 1)
			ck_assert_double_lt(vec2_dist(s.pos, truth), 4 * noise);
		if (i > 3)
			ck_assert_double_lt(vec2_dist(s.vel, v), 0.05);
	}
}
END_TEST

START_TEST(test_ball_comes_to_rest_where_it_is)
{
	struct random r = random_begin("stabilise_stop");
	struct stabiliser s = stabilise_begin((vec2){0, 0}, 0);
	vec2 truth = {0, 0};
	for (int i = 1; i < 40; i++) {
		truth.x += fmax(0, 0.6 - 0.03 * i) * dt;
		stabilise_add(&s, jitter(&r, truth), i * dt, noise);
	}
	for (int i = 40; i < 80; i++)
		stabilise_add(&s, jitter(&r, truth), i * dt, noise);
	ck_assert(!s.moving);
	ck_assert_double_lt(vec2_dist(s.pos, truth), 0.15 * mm);
}
END_TEST

START_TEST(test_one_outlier_moves_nothing)
{
	struct stabiliser s = stabilise_begin((vec2){0, 0}, 0);
	for (int i = 1; i < 30; i++)
		stabilise_add(&s, (vec2){0, 0}, i * dt, noise);
	stabilise_add(&s, (vec2){5 * noise, 0}, 30 * dt, noise);
	ck_assert(s.pos.x == 0);
	stabilise_add(&s, (vec2){0, 0}, 31 * dt, noise);
	ck_assert(!s.moving && s.pos.x == 0);
}
END_TEST

/* Equations 4.1 and 4.2 by hand. */
START_TEST(test_thesis_blending)
{
	struct thesis_stabiliser s = {0};
	double D = 20 * mm;
	for (int i = 0; i < 9; i++)
		ck_assert(thesis_stabilise(&s, (vec2){0, 0}, D, 5).x == 0);
	/* Tenth: the mean of ten is 1 mm, d = 9 mm, f = 0.45, P = 0.45 * 10 + 0.55 * 1. */
	vec2 p = thesis_stabilise(&s, (vec2){10 * mm, 0}, D, 5);
	ck_assert_double_eq_tol(p.x, (0.45 * 10 + 0.55 * 1) * mm, 1e-12);
	/* Further than D: the history begins anew and the position is taken as it is. */
	p = thesis_stabilise(&s, (vec2){100 * mm, 0}, D, 5);
	ck_assert_double_eq_tol(p.x, 100 * mm, 1e-12);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("stabilise");
	TCase *tc = tcase_create("stabilise");
	tcase_add_test(tc, test_resting_ball_settles);
	tcase_add_test(tc, test_rolling_ball_does_not_lag);
	tcase_add_test(tc, test_ball_comes_to_rest_where_it_is);
	tcase_add_test(tc, test_one_outlier_moves_nothing);
	tcase_add_test(tc, test_thesis_blending);
	suite_add_tcase(suite, tc);
	return suite;
}
