/* Roots against a judge of another method and precision, and against GSL. */
#include "harness.h"
#include "poly_judge.h"

#include <gsl/gsl_poly.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "physics/roots.h"

static int polys_wanted(void)
{
	const char *text = getenv("BILLIARD_TEST_POLYS");
	return text ? atoi(text) : 1000000;
}

static double sign_of(struct random *r)
{
	return random_u64(r) & 1 ? 1 : -1;
}

static double decades(struct random *r, double low, double high)
{
	return sign_of(r) * pow(10, random_in(r, low, high));
}

/* ---- families ---- */

static void multiply(double c[5], int *degree, double root)
{
	for (int i = ++*degree; i >= 0; i--)
		c[i] = (i > 0 ? c[i - 1] : 0) - root * (i < *degree ? c[i] : 0);
}

static void from_roots(double c[5], const double *root, int n, double lead)
{
	int degree = 0;
	for (int i = 0; i < 5; i++)
		c[i] = 0;
	c[0] = lead;
	for (int i = 0; i < n; i++)
		multiply(c, &degree, root[i]);
}

static void plain(struct random *r, double c[5])
{
	for (int i = 0; i < 5; i++)
		c[i] = random_in(r, -1, 1);
}

static void all_real(struct random *r, double c[5])
{
	double root[4];
	for (int i = 0; i < 4; i++)
		root[i] = random_in(r, -1, 2);
	from_roots(c, root, 4, sign_of(r));
}

static void double_root(struct random *r, double c[5])
{
	double a = random_in(r, 0, 1), root[4] = {a, a, random_in(r, -1, 2), random_in(r, -1, 2)};
	from_roots(c, root, 2 + (int)(random_u64(r) % 3), sign_of(r));
}

static void near_double_root(struct random *r, double c[5])
{
	double_root(r, c);
	c[0] += decades(r, -18, -4);
}

static void multiple_root(struct random *r, double c[5])
{
	double a = random_in(r, 0, 1), root[4] = {a, a, a, random_u64(r) & 1 ? a : random_in(r, -1, 2)};
	from_roots(c, root, 4, sign_of(r));
}

static void vanishing_lead(struct random *r, double c[5])
{
	plain(r, c);
	c[4] *= random_u64(r) & 1 ? 0 : decades(r, -30, -5);
	if (random_u64(r) & 1)
		c[3] *= random_u64(r) & 1 ? 0 : decades(r, -30, -5);
}

static void many_orders(struct random *r, double c[5])
{
	for (int i = 0; i < 5; i++)
		c[i] = decades(r, -10, 10);
}

static void root_at_start(struct random *r, double c[5])
{
	plain(r, c);
	c[0] = random_u64(r) & 1 ? 0 : decades(r, -20, -12);
	if (random_u64(r) % 4 == 0)
		c[1] = random_u64(r) & 1 ? 0 : decades(r, -20, -12);
}

/* |p + v t + a t^2 / 2|^2 - D^2 of two balls on a table. */
static void two_balls(struct random *r, double c[5])
{
	double px = random_in(r, -1, 1), py = random_in(r, -0.5, 0.5), vx = random_in(r, -5, 5),
	       vy = random_in(r, -5, 5);
	double ax = random_in(r, -4, 4), ay = random_in(r, -4, 4);
	c[0] = px * px + py * py - 0.0523 * 0.0523;
	c[1] = 2 * (px * vx + py * vy);
	c[2] = vx * vx + vy * vy + px * ax + py * ay;
	c[3] = vx * ax + vy * ay;
	c[4] = 0.25 * (ax * ax + ay * ay);
}

static const struct {
	const char *name;
	void (*make)(struct random *r, double c[5]);
} families[] = {
	{"plain", plain},
	{"all real", all_real},
	{"double root", double_root},
	{"near-double root", near_double_root},
	{"multiple root", multiple_root},
	{"vanishing leading coefficients", vanishing_lead},
	{"20 orders of magnitude", many_orders},
	{"root at the start", root_at_start},
	{"two balls", two_balls},
};
enum { FAMILIES = sizeof families / sizeof *families };

/* ---- quartic ---- */

struct tally {
	int entries, missed, invented;
	double worst; /* largest relative error of a well-conditioned root */
};

static bool falls_at_start(const double c[5])
{
	for (int i = 1; i < 5; i++) {
		if (c[i] != 0)
			return c[i] < 0;
	}
	return false;
}

static void judge(struct tally *tally, const double c[5], double horizon, double t)
{
	long double x[5];
	for (int i = 0; i < 5; i++)
		x[i] = c[i];
	if (c[0] <= 0) {
		if (falls_at_start(c)) {
			tally->missed += t != 0;
			tally->entries++;
			return;
		}
		x[0] = 0;
	}
	struct judge_entry entry = judge_first_entry(x, horizon);
	tally->entries += entry.certain;
	if (entry.certain && !(t <= entry.below))
		tally->missed++;
	if (t == INFINITY)
		return;
	long double slope_noise = 64 * judge_noise(x, t) / (t > 0 ? t : 1);
	if (fabsl(judge_value(x, t)) > judge_noise(x, t) || judge_slope(x, t) > slope_noise || t < 0 || t > horizon)
		tally->invented++;
	long double slope = fabsl(judge_slope(x, t));
	if (slope * horizon > 1e9L * judge_noise(x, horizon))
		tally->worst = fmax(tally->worst, (double)(fabsl(judge_value(x, t)) / slope / horizon));
}

START_TEST(quartic_finds_the_first_entry)
{
	struct random r = random_begin(families[_i].name);
	struct tally tally = {0};
	int count = polys_wanted() / FAMILIES;
	for (int i = 0; i < count; i++) {
		double c[5], horizon = random_u64(&r) & 1 ? 1 : pow(10, random_in(&r, -3, 2));
		families[_i].make(&r, c);
		int before = tally.missed + tally.invented;
		double t = roots_quartic_entry(c, horizon);
		judge(&tally, c, horizon, t);
		if (tally.missed + tally.invented > before && before < 5)
			printf("%s: %a %a %a %a %a on [0, %a] gave %.17g\n", families[_i].name, c[0], c[1], c[2], c[3],
			       c[4], horizon, t);
		fflush(stdout);
	}
	printf("%s: %d quartics, %d entries, %d missed, %d invented, error of clear roots %.2g of the horizon\n",
	       families[_i].name, count, tally.entries, tally.missed, tally.invented, tally.worst);
	ck_assert_int_eq(tally.missed, 0);
	ck_assert_int_eq(tally.invented, 0);
	ck_assert_double_le(tally.worst, 1e-9);
}
END_TEST

/* GSL's companion matrix as the second judge, where the roots are far enough apart for it to tell them. */
START_TEST(quartic_agrees_with_gsl)
{
	struct random r = random_begin("quartic_agrees_with_gsl");
	gsl_poly_complex_workspace *work = gsl_poly_complex_workspace_alloc(5);
	int compared = 0;
	for (int i = 0; i < 20000; i++) {
		double c[5], z[8], first = INFINITY;
		all_real(&r, c);
		if (c[0] <= 0)
			continue;
		ck_assert_int_eq(gsl_poly_complex_solve(c, 5, work, z), 0);
		bool clear = true;
		for (int k = 0; k < 4; k++) {
			for (int m = 0; m < k; m++)
				clear = clear && hypot(z[2 * k] - z[2 * m], z[2 * k + 1] - z[2 * m + 1]) > 1e-2;
			clear = clear && fabs(z[2 * k]) > 1e-6 && fabs(z[2 * k] - 1) > 1e-6;
			double x = z[2 * k];
			double slope = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * 4 * c[4]));
			if (fabs(z[2 * k + 1]) < 1e-9 && x > 0 && x <= 1 && slope < 0 && x < first)
				first = x;
		}
		if (!clear)
			continue;
		compared++;
		double t = roots_quartic_entry(c, 1);
		ck_assert((t == INFINITY) == (first == INFINITY));
		if (t < INFINITY)
			ck_assert_double_eq_tol(t, first, 1e-9);
	}
	gsl_poly_complex_workspace_free(work);
	printf("quartic_agrees_with_gsl: %d compared\n", compared);
	ck_assert_int_gt(compared, 5000);
}
END_TEST

/* ---- named cases ---- */

START_TEST(start_on_the_root_counts_by_approach)
{
	ck_assert_double_eq(roots_quartic_entry((double[]){0, -1, 1, 0, 0}, 2), 0);
	ck_assert_double_eq(roots_quartic_entry((double[]){-1e-18, -1, 1, 0, 0}, 2), 0);
	ck_assert(roots_quartic_entry((double[]){0, 1, 1, 0, 0}, 2) == INFINITY);
	ck_assert(roots_quartic_entry((double[]){-1e-18, 1, 1, 0, 0}, 2) == INFINITY);
	ck_assert_double_eq_tol(roots_quartic_entry((double[]){0, 1, -1, 0, 0}, 2), 1, 1e-15);
	ck_assert_double_eq_tol(roots_quadratic_entry(-1e-18, 1, -1, 2), 1, 1e-15);
	ck_assert_double_eq(roots_quartic_entry((double[]){0, 0, -1, 0, 0}, 2), 0);
	ck_assert(roots_quartic_entry((double[]){0, 0, 0, 0, 0}, 2) == INFINITY);
}
END_TEST

START_TEST(only_the_horizon_counts)
{
	const double c[5] = {1, -1, 0, 0, 0};
	ck_assert_double_eq_tol(roots_quartic_entry(c, 1.5), 1, 1e-15);
	ck_assert(roots_quartic_entry(c, 0.999) == INFINITY);
	ck_assert(roots_quartic_entry(c, 0) == INFINITY);
	ck_assert_double_eq(roots_quadratic_entry(1, -1, 0, 1), 1);
}
END_TEST

START_TEST(quadratic_does_not_cancel)
{
	double x[2];
	ck_assert_int_eq(roots_quadratic(1, -1e8, 1, x), 2);
	ck_assert_double_eq_tol(x[0], 1e-8, 1e-23);
	ck_assert_double_eq_tol(x[1], 1e8, 1e-7);
	ck_assert_int_eq(roots_quadratic(0, 2, -1, x), 1);
	ck_assert_double_eq(x[0], 0.5);
	ck_assert_int_eq(roots_quadratic(0, 0, 1, x), 0);
	ck_assert_int_eq(roots_quadratic(1, 0, 1, x), 0);
	ck_assert_int_eq(roots_quadratic(1, -2, 1, x), 1);
	ck_assert_int_eq(roots_quadratic(1, 0, 0, x), 1);
	ck_assert_double_eq(x[0], 0);
}
END_TEST

START_TEST(quadratic_agrees_with_extended_precision)
{
	struct random r = random_begin("quadratic_agrees_with_extended_precision");
	for (int i = 0; i < 100000; i++) {
		double c[5] = {decades(&r, -8, 2), decades(&r, -8, 2), random_u64(&r) % 8 ? decades(&r, -8, 2) : 0, 0,
			       0};
		struct tally tally = {0};
		judge(&tally, c, 3, roots_quadratic_entry(c[0], c[1], c[2], 3));
		ck_assert_msg(tally.missed + tally.invented == 0, "%a %a %a", c[0], c[1], c[2]);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("roots");
	TCase *quartic = tcase_create("quartic");
	tcase_set_timeout(quartic, 600);
	tcase_add_loop_test(quartic, quartic_finds_the_first_entry, 0, FAMILIES);
	tcase_add_test(quartic, quartic_agrees_with_gsl);
	suite_add_tcase(suite, quartic);
	TCase *named = tcase_create("named");
	tcase_add_test(named, start_on_the_root_counts_by_approach);
	tcase_add_test(named, only_the_horizon_counts);
	tcase_add_test(named, quadratic_does_not_cancel);
	tcase_add_test(named, quadratic_agrees_with_extended_precision);
	suite_add_tcase(suite, named);
	return suite;
}
