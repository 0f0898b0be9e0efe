#include "vision/camera.h"

#include <math.h>

#include "vision_scene.h"

static struct camera bent_camera(struct random *r)
{
	struct camera camera = scene_camera(random_in(r, -0.2, 0.2), random_in(r, -0.2, 0.2));
	camera.in.k1 = random_in(r, -0.2, 0.1);
	camera.in.k2 = random_in(r, -0.05, 0.05);
	camera.in.p1 = random_in(r, -0.002, 0.002);
	camera.in.p2 = random_in(r, -0.002, 0.002);
	return camera;
}

START_TEST(test_unproject_undoes_project)
{
	struct random r = random_begin("camera_round_trip");
	for (int i = 0; i < 2000; i++) {
		struct camera camera = bent_camera(&r);
		vec2 pos = {random_in(&r, -0.9, 0.9), random_in(&r, -0.45, 0.45)}, px, back;
		double z = random_in(&r, 0, 0.05);
		ck_assert(camera_project(&camera, pos, z, &px));
		ck_assert(camera_unproject(&camera, px, z, &back));
		ck_assert_double_lt(vec2_dist(pos, back), 1e-9);
	}
}
END_TEST

START_TEST(test_centre_projects_from_anywhere)
{
	struct camera camera = scene_camera(0.1, -0.05);
	double eye[3];
	camera_centre(&camera, eye);
	/* Two heights on one ray meet in one pixel. */
	vec2 low, px, high_px;
	ck_assert(camera_unproject(&camera, (vec2){300, 200}, 0, &low));
	vec2 high = {eye[0] + 0.7 * (low.x - eye[0]), eye[1] + 0.7 * (low.y - eye[1])};
	ck_assert(camera_project(&camera, low, 0, &px));
	ck_assert(camera_project(&camera, high, 0.3 * eye[2], &high_px));
	ck_assert_double_lt(vec2_dist(px, high_px), 1e-9);
}
END_TEST

START_TEST(test_behind_the_camera_is_nothing)
{
	struct camera camera = scene_camera(0, 0);
	vec2 px, pos;
	ck_assert(!camera_project(&camera, (vec2){0, 0}, 2, &px));
	/* A plane above the camera is behind it. */
	ck_assert(!camera_unproject(&camera, (vec2){640, 360}, 3, &pos));
}
END_TEST

START_TEST(test_scale_keeps_directions)
{
	struct camera camera = scene_camera(0.05, 0.02), large = camera;
	ck_assert(camera_scale(&camera.in, 1920, 1080, &large.in));
	for (int i = 0; i < 50; i++) {
		vec2 a, b, pos = {-0.9 + 0.036 * i, 0.3};
		camera_project(&camera, pos, 0, &a);
		camera_project(&large, pos, 0, &b);
		/* Images begin at -0.5: pixel borders scale, not centres. */
		ck_assert_double_eq_tol((a.x + 0.5) * 1.5 - 0.5, b.x, 1e-9);
		ck_assert_double_eq_tol((a.y + 0.5) * 1.5 - 0.5, b.y, 1e-9);
	}
	ck_assert(!camera_scale(&camera.in, 1280, 960, &large.in));
	ck_assert(!camera_scale(&camera.in, 0, 0, &large.in));
	ck_assert(!camera_scale(&camera.in, 1, 1, &large.in));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("camera");
	TCase *tc = tcase_create("camera");
	tcase_add_test(tc, test_unproject_undoes_project);
	tcase_add_test(tc, test_centre_projects_from_anywhere);
	tcase_add_test(tc, test_behind_the_camera_is_nothing);
	tcase_add_test(tc, test_scale_keeps_directions);
	suite_add_tcase(suite, tc);
	return suite;
}
