/* The pose over time: what the average of the markers' corners is made of. */
#include "vision/calibration.h"

#include <math.h>
#include <string.h>

#include "vision_scene.h"

static const double dt = 1 / 30.0;
static struct calibration calibration;
static struct camera camera;
static struct table table;
static struct image_buffer image;
static char reason[96];

static void setup(void)
{
	static struct marker_layout layout;
	char err[128];
	layout = scene_markers();
	table = scene_table();
	camera = scene_camera(0.01, -0.01);
	ck_assert_msg(calibration_init(&calibration, &layout, 0, 10, err, sizeof(err)) == 0, "%s", err);
}

static void teardown(void)
{
	calibration_finish(&calibration);
	image_buffer_finish(&image);
}

/* The first `markers` of them; the last one of these lies off by so much along x. */
static void paint(int markers, double off)
{
	struct marker_layout shown = scene_markers();
	shown.count = markers;
	shown.marker[markers - 1].centre.x += off;
	struct random r = {1};
	scene_paint(&camera, &table, NULL, 0, 0, &r, &image);
	scene_paint_markers(&camera, &shown, &image);
}

static enum calibration_news look(int frame)
{
	reason[0] = '\0';
	const struct calibration_frame view = {&image.image, &camera.in, frame * dt, false};
	return calibration_track(&calibration, &view, reason, sizeof(reason));
}

/* Off by less than a bump in its first frame, right in all others: no more of it is left than of any other frame. */
START_TEST(test_late_marker_does_not_keep_its_first_corner)
{
	int frame = 0;
	paint(3, 0);
	for (; frame < 60; frame++)
		look(frame);
	paint(4, 0.0015);
	ck_assert_int_eq(look(frame++), CALIBRATION_REFINED);
	double first = calibration.seen[3].x[0];
	paint(4, 0);
	for (int i = 0; i < 19; i++)
		ck_assert_int_eq(look(frame++), CALIBRATION_REFINED);
	double mean = calibration.seen[3].x[0];
	calibration_reset(&calibration);
	look(frame);
	double truth = calibration.seen[3].x[0];
	ck_assert_double_gt(fabs(first - truth), 0.5);
	ck_assert_double_lt(fabs(mean - truth), fabs(first - truth) / 15);
}
END_TEST

/* A step inside and a step outside of what noise does: 1.5 px at 1280. */
START_TEST(test_bump)
{
	int frame = 0;
	vec2 a, b;
	camera_project(&camera, (vec2){0, 0}, 0.0381, &a);
	camera_project(&camera, (vec2){0.001, 0}, 0.0381, &b);
	double px_per_m = vec2_dist(a, b) / 0.001;
	for (int i = 0; i < 2; i++) {
		calibration_reset(&calibration);
		paint(4, 0);
		ck_assert_int_eq(look(frame++), CALIBRATION_MOVED);
		ck_assert_int_eq(look(frame++), CALIBRATION_REFINED);
		paint(4, (i == 0 ? 1.3 : 1.7) / px_per_m);
		ck_assert_int_eq(look(frame++), i == 0 ? CALIBRATION_REFINED : CALIBRATION_MOVED);
	}
}
END_TEST

/* The pose outlives its markers for `keep`, and not for longer. */
START_TEST(test_pose_age)
{
	paint(4, 0);
	look(0);
	paint(2, 0);
	ck_assert_int_eq(look((int)lround(calibration.keep / dt)), CALIBRATION_SAME);
	ck_assert_int_eq(look((int)lround(calibration.keep / dt) + 1), CALIBRATION_LOST);
	ck_assert(strstr(reason, "no markers") != NULL);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("calibration");
	TCase *tc = tcase_create("calibration");
	tcase_add_checked_fixture(tc, setup, teardown);
	tcase_add_test(tc, test_late_marker_does_not_keep_its_first_corner);
	tcase_add_test(tc, test_bump);
	tcase_add_test(tc, test_pose_age);
	tcase_set_timeout(tc, 120);
	suite_add_tcase(suite, tc);
	return suite;
}
