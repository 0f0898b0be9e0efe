/* Cost terms against their definitions. */
#include "harness.h"
#include "scenes.h"

#include "search/cost.h"

/* 4.22 to 4.29 as they stand: the y of a cubic Bezier curve with P0..P3, by de Casteljau. */
static double bezier_y(double t)
{
	double p[4] = {0, 0, 1, 1};
	for (int n = 3; n > 0; n--)
		for (int i = 0; i < n; i++)
			p[i] = (1 - t) * p[i] + t * p[i + 1];
	return p[0];
}

START_TEST(angle_is_the_bezier_curve)
{
	double last = -1;
	for (int i = 0; i <= 1000; i++) {
		double x = i / 1000.0;
		ck_assert_double_eq_tol(cost_angle(1 - x), bezier_y(x), 1e-14);
		ck_assert(cost_angle(1 - x) > last);
		last = cost_angle(1 - x);
	}
	ck_assert_double_eq(cost_angle(1), 0);
	ck_assert_double_eq(cost_angle(0), 1);
}
END_TEST

START_TEST(distance_is_a_share_of_the_diagonal)
{
	struct table table = scene_thesis_table();
	double diagonal2 = table.length * table.length + table.width * table.width;
	ck_assert_double_eq(cost_distance(&table, diagonal2), 1);
	ck_assert_double_eq(cost_distance(&table, 0), 0);
	ck_assert_double_eq_tol(cost_distance(&table, diagonal2 / 4), 0.25, 1e-15);
}
END_TEST

/* Each weight switches its own term and no other. */
START_TEST(terms_have_their_weights)
{
	struct table table = scene_thesis_table();
	struct cost_profile profile = cost_profile_thesis();
	struct cost_way way = {.way2 = 0.3, .carry = 0.5, .angles = 0.2, .rails = 2, .strikes = true};
	double distance = cost_distance(&table, way.way2) * way.carry;
	ck_assert_double_eq_tol(cost_search(&table, &profile, &way), distance + 0.2 + 0.5 + 4.0 / 3, 1e-14);
	profile.w_distance = 0;
	ck_assert_double_eq_tol(cost_search(&table, &profile, &way), 0.2 + 0.5 + 4.0 / 3, 1e-14);
	profile.w_angle = 0;
	ck_assert_double_eq_tol(cost_search(&table, &profile, &way), 0.5 + 4.0 / 3, 1e-14);
	profile.w_rails = 0;
	ck_assert_double_eq_tol(cost_search(&table, &profile, &way), 0.5, 1e-14);
	way.strikes = false;
	ck_assert_double_eq(cost_search(&table, &profile, &way), 0);
}
END_TEST

START_TEST(result_cost)
{
	struct cost_profile profile = cost_profile_thesis();
	/* 4.100 to 4.104 by hand: one point of seven, 1 m/s of 5 */
	ck_assert_double_eq_tol(cost_result(&profile, 1, 1, 0.8), 0.8 * (0.5 * 6 / 7 + 0.5 / 25), 1e-15);
	ck_assert_double_eq(cost_result(&profile, 7, 0, 0.8), 0);
	ck_assert_double_eq(cost_result(&profile, 20, 0, 0.8), 0);
	ck_assert(cost_result(&profile, 0, 2, 1) > cost_result(&profile, 0, 1, 1));
	profile.w_simulation = 0;
	ck_assert_double_eq(cost_result(&profile, 1, 1, 0.8), 0);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("cost");
	TCase *tc = tcase_create("cost");
	tcase_add_test(tc, angle_is_the_bezier_curve);
	tcase_add_test(tc, distance_is_a_share_of_the_diagonal);
	tcase_add_test(tc, terms_have_their_weights);
	tcase_add_test(tc, result_cost);
	suite_add_tcase(suite, tc);
	return suite;
}
