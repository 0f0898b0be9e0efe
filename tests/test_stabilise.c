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

/* However long a ball has rested: what a slow drift of the camera moves it by is taken over within seconds. */
START_TEST(test_long_rest_does_not_stiffen)
{
	struct stabiliser s = stabilise_begin((vec2){0, 0}, 0);
	int i = 1;
	for (; i < 5000; i++)
		stabilise_add(&s, (vec2){0, 0}, i * dt, noise);
	for (; i < 5300; i++)
		stabilise_add(&s, (vec2){2 * noise, 0}, i * dt, noise);
	ck_assert(!s.moving);
	ck_assert_double_gt(s.pos.x, 0.9 * 2 * noise);
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

/* Off by more than three times the noise, twice in a row, or by more than eight once: it moves. */
START_TEST(test_when_rest_ends)
{
	struct stabiliser s = stabilise_begin((vec2){0, 0}, 0), far;
	for (int i = 1; i < 10; i++)
		stabilise_add(&s, (vec2){0, 0}, i * dt, noise);
	far = s;
	stabilise_add(&far, (vec2){8.5 * noise, 0}, 10 * dt, noise);
	ck_assert(far.moving && far.pos.x == 8.5 * noise);
	ck_assert_double_gt(far.vel.x, 0);
	stabilise_add(&s, (vec2){4 * noise, 0}, 10 * dt, noise);
	ck_assert(!s.moving && s.pos.x == 0 && s.vel.x == 0);
	stabilise_add(&s, (vec2){4 * noise, 0}, 11 * dt, noise);
	ck_assert(s.moving && s.pos.x == 4 * noise);
	/* Three in one place and it rests again, there. */
	stabilise_add(&s, (vec2){4 * noise, 0}, 12 * dt, noise);
	ck_assert(!s.moving && s.vel.x == 0);
	ck_assert_double_eq_tol(s.pos.x, 4 * noise, 1e-15);
}
END_TEST

/* Frames may come at one time or unevenly: velocity stays finite and right. */
START_TEST(test_uneven_times)
{
	struct random r = random_begin("stabilise_uneven");
	vec2 v = {0.8, -0.3};
	struct stabiliser s = stabilise_begin((vec2){0, 0}, 0);
	double time = 0;
	for (int i = 1; i < 60; i++) {
		time += random_in(&r, 0.005, 0.2);
		stabilise_add(&s, vec2_scale(v, time), time, noise);
		if (i > 1)
			ck_assert_double_lt(vec2_dist(s.vel, v), 1e-9);
	}
	for (int i = 0; i < 6; i++) {
		stabilise_add(&s, (vec2){i * 0.1, 0}, time, noise);
		ck_assert(isfinite(s.vel.x) && isfinite(s.vel.y));
	}
}
END_TEST

/* Slower than what rest tolerates: the mean follows, and lags by no more than that. */
START_TEST(test_creeping_ball_is_followed)
{
	struct stabiliser s = stabilise_begin((vec2){0, 0}, 0);
	for (int i = 1; i < 3000; i++) {
		double x = i * dt * 0.5 * mm;
		stabilise_add(&s, (vec2){x, 0}, i * dt, noise);
		ck_assert_double_lt(fabs(s.pos.x - x), 4 * noise);
	}
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

/* The history holds THESIS_HISTORY frames: what is older has no say. */
START_TEST(test_thesis_history_ends)
{
	struct thesis_stabiliser s = {0};
	vec2 p = {0, 0};
	for (int i = 0; i < THESIS_HISTORY; i++)
		p = thesis_stabilise(&s, (vec2){5 * mm, 0}, 20 * mm, 5);
	for (int i = 0; i < THESIS_HISTORY; i++)
		p = thesis_stabilise(&s, (vec2){0, 0}, 20 * mm, 5);
	ck_assert_double_eq_tol(p.x, 0, 1e-15);
	ck_assert_int_eq(s.count, THESIS_HISTORY);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("stabilise");
	TCase *tc = tcase_create("stabilise");
	tcase_add_test(tc, test_resting_ball_settles);
	tcase_add_test(tc, test_long_rest_does_not_stiffen);
	tcase_add_test(tc, test_rolling_ball_does_not_lag);
	tcase_add_test(tc, test_ball_comes_to_rest_where_it_is);
	tcase_add_test(tc, test_one_outlier_moves_nothing);
	tcase_add_test(tc, test_when_rest_ends);
	tcase_add_test(tc, test_uneven_times);
	tcase_add_test(tc, test_creeping_ball_is_followed);
	tcase_add_test(tc, test_thesis_blending);
	tcase_add_test(tc, test_thesis_history_ends);
	suite_add_tcase(suite, tc);
	return suite;
}
