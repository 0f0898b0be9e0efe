#include "vision/pose.h"

#include <math.h>

#include "vision/linear.h"
#include "vision/marker_edges.h"
#include "vision_scene.h"

/* Corners as a camera sees them; yaw turns each marker, shrink is how much smaller they look. */
static int see(const struct camera *camera, const struct marker_layout *layout, double yaw, double shrink,
	       struct marker_view *out)
{
	static const double sx[4] = {-1, 1, 1, -1}, sy[4] = {1, 1, -1, -1};
	for (int m = 0; m < layout->count; m++) {
		double half = layout->side / 2 * shrink, angle = yaw * (m + 1);
		out[m].id = layout->marker[m].id;
		for (int k = 0; k < 4; k++) {
			vec2 px, p = {half * sx[k], half * sy[k]};
			p = (vec2){cos(angle) * p.x - sin(angle) * p.y, sin(angle) * p.x + cos(angle) * p.y};
			ck_assert(camera_project(camera, vec2_add(layout->marker[m].centre, p), layout->height, &px));
			out[m].x[k] = px.x;
			out[m].y[k] = px.y;
		}
	}
	return layout->count;
}

static void check_same_camera(const struct camera *a, const struct camera *b, double tolerance_px)
{
	for (int i = 0; i < 9; i++) {
		vec2 p, q, pos = {(i % 3 - 1) * 0.9, (i / 3 - 1) * 0.45};
		ck_assert(camera_project(a, pos, 0.026, &p));
		ck_assert(camera_project(b, pos, 0.026, &q));
		ck_assert_double_lt(vec2_dist(p, q), tolerance_px);
	}
}

START_TEST(test_exact_corners_give_the_exact_pose)
{
	struct random r = random_begin("pose_exact");
	struct marker_layout layout = scene_markers();
	for (int i = 0; i < 100; i++) {
		struct marker_view view[MARKER_MAX];
		struct camera truth = scene_camera(random_in(&r, -0.25, 0.25), random_in(&r, -0.25, 0.25)),
			      found = truth;
		int count = see(&truth, &layout, random_in(&r, -0.8, 0.8), random_in(&r, 0.94, 1.02), view);
		struct pose_fit fit;
		ck_assert(pose_from_markers(&layout, view, count, &found, &fit));
		ck_assert_double_lt(fit.residual_px, 1e-5);
		check_same_camera(&truth, &found, 1e-4);
	}
}
END_TEST

START_TEST(test_three_markers_are_enough_two_are_not)
{
	struct marker_layout layout = scene_markers();
	struct camera truth = scene_camera(0.02, -0.01), found = truth;
	struct marker_view view[MARKER_MAX];
	struct pose_fit fit;
	int count = see(&truth, &layout, 0, 1, view);
	ck_assert(pose_from_markers(&layout, view, count - 1, &found, &fit));
	check_same_camera(&truth, &found, 1e-3);
	ck_assert(!pose_from_markers(&layout, view, 2, &found, &fit));
	ck_assert(!pose_from_markers(&layout, view, 0, &found, &fit));
}
END_TEST

START_TEST(test_nonsense_is_refused)
{
	struct marker_layout layout = scene_markers();
	struct camera truth = scene_camera(0, 0), found = truth;
	struct marker_view view[MARKER_MAX];
	struct pose_fit fit;
	int count = see(&truth, &layout, 0, 1, view);
	/* A marker that was moved to the middle of the table. */
	for (int k = 0; k < 4; k++) {
		view[2].x[k] -= 400;
		view[2].y[k] += 200;
	}
	ck_assert(!pose_from_markers(&layout, view, count, &found, &fit));
	/* Mirrored: seen from below. */
	see(&truth, &layout, 0, 1, view);
	for (int m = 0; m < count; m++)
		for (int k = 0; k < 4; k++)
			view[m].x[k] = 1280 - view[m].x[k];
	ck_assert(!pose_from_markers(&layout, view, count, &found, &fit));
	/* All in one place. */
	for (int m = 1; m < count; m++)
		for (int k = 0; k < 4; k++) {
			view[m].x[k] = view[0].x[k];
			view[m].y[k] = view[0].y[k];
		}
	ck_assert(!pose_from_markers(&layout, view, count, &found, &fit));
}
END_TEST

START_TEST(test_painted_markers_are_found_and_refined)
{
	struct random r = random_begin("marker_refine");
	struct marker_layout layout = scene_markers();
	struct table table = scene_table();
	struct camera truth = scene_camera(0.004, 0.002);
	struct image_buffer image = {0};
	struct marker_finder *finder;
	struct marker_view view[MARKER_MAX], exact[MARKER_MAX];
	char err[128];
	scene_paint(&truth, &table, NULL, 0, 2, &r, &image);
	scene_paint_markers(&truth, &layout, &image);
	ck_assert_int_eq(marker_finder_create(&finder, 4, 3, err, sizeof(err)), 0);
	ck_assert_int_eq(marker_find(finder, &image.image, view, MARKER_MAX), 4);
	see(&truth, &layout, 0, 1, exact);
	for (int m = 0; m < 4; m++) {
		ck_assert(marker_refine(&image.image, 5, &view[m]));
		for (int k = 0; k < 4; k++)
			ck_assert_double_lt(hypot(view[m].x[k] - exact[m].x[k], view[m].y[k] - exact[m].y[k]), 0.25);
	}
	/* Where there is none: nothing is refined, nothing changes. */
	struct marker_view nowhere = {0, {600, 630, 630, 600}, {300, 300, 330, 330}}, before = nowhere;
	ck_assert(!marker_refine(&image.image, 5, &nowhere));
	ck_assert_mem_eq(&nowhere, &before, sizeof(before));
	marker_finder_destroy(finder);
	image_buffer_finish(&image);
}
END_TEST

START_TEST(test_solve_spd_against_multiplication)
{
	struct random r = random_begin("solve_spd");
	for (int n = 1; n <= 8; n++)
		for (int round = 0; round < 50; round++) {
			double g[64], a[64], copy[64], x[8], b[8];
			for (int i = 0; i < n * n; i++)
				g[i] = random_in(&r, -1, 1);
			for (int i = 0; i < n; i++) {
				x[i] = random_in(&r, -5, 5);
				for (int j = 0; j < n; j++) {
					a[i * n + j] = i == j ? 0.1 : 0;
					for (int k = 0; k < n; k++)
						a[i * n + j] += g[i * n + k] * g[j * n + k];
				}
			}
			for (int i = 0; i < n; i++) {
				b[i] = 0;
				for (int j = 0; j < n; j++)
					b[i] += a[i * n + j] * x[j];
			}
			for (int i = 0; i < n * n; i++)
				copy[i] = a[i];
			ck_assert(solve_spd(copy, b, n));
			for (int i = 0; i < n; i++)
				ck_assert_double_eq_tol(b[i], x[i], 1e-9);
		}
	double singular[4] = {1, 1, 1, 1}, v[2] = {1, 1};
	ck_assert(!solve_spd(singular, v, 2));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("pose");
	TCase *tc = tcase_create("pose");
	tcase_add_test(tc, test_exact_corners_give_the_exact_pose);
	tcase_add_test(tc, test_three_markers_are_enough_two_are_not);
	tcase_add_test(tc, test_nonsense_is_refused);
	tcase_add_test(tc, test_painted_markers_are_found_and_refined);
	tcase_add_test(tc, test_solve_spd_against_multiplication);
	tcase_set_timeout(tc, 60);
	suite_add_tcase(suite, tc);
	return suite;
}
