#include "vision/fit.h"

#include <math.h>

#include "vision_scene.h"

static const double mm = 1e-3;

/* A point is on the silhouette when its ray touches the sphere: an independent view of the same thing. */
static double ray_to_centre(const struct camera *camera, vec2 px, vec2 pos, double radius)
{
	double eye[3];
	vec2 floor;
	camera_centre(camera, eye);
	ck_assert(camera_unproject(camera, px, 0, &floor));
	double ray[3] = {floor.x - eye[0], floor.y - eye[1], -eye[2]},
	       d[3] = {pos.x - eye[0], pos.y - eye[1], radius - eye[2]};
	double cx = ray[1] * d[2] - ray[2] * d[1], cy = ray[2] * d[0] - ray[0] * d[2],
	       cz = ray[0] * d[1] - ray[1] * d[0];
	return sqrt((cx * cx + cy * cy + cz * cz) / (ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2]));
}

START_TEST(test_outline_rays_touch_the_sphere)
{
	struct random r = random_begin("outline");
	for (int i = 0; i < 200; i++) {
		struct camera camera = scene_camera(random_in(&r, -0.2, 0.2), random_in(&r, -0.2, 0.2));
		camera.in.k1 = random_in(&r, -0.1, 0.1);
		vec2 pos = {random_in(&r, -0.9, 0.9), random_in(&r, -0.45, 0.45)};
		struct outline o;
		ck_assert(outline_of_ball(&camera, pos, 0.02615, 1, &o));
		for (int k = 0; k < OUTLINE_POINTS; k++) {
			ck_assert_double_eq_tol(ray_to_centre(&camera, o.point[k], pos, 0.02615), 0.02615, 1e-9);
			ck_assert_double_eq_tol(vec2_norm(o.normal[k]), 1, 1e-9);
			ck_assert_double_gt(vec2_dot(o.normal[k], vec2_sub(o.point[k], o.centre)), 0);
		}
	}
}
END_TEST

START_TEST(test_jacobian_against_differences)
{
	struct camera camera = scene_camera(0.1, 0.1);
	double j[4];
	vec2 pos = {0.5, -0.3}, a, b;
	ck_assert(outline_jacobian(&camera, pos, 0.02615, j));
	camera_project(&camera, pos, 0.02615, &a);
	camera_project(&camera, (vec2){pos.x + 1e-6, pos.y + 2e-6}, 0.02615, &b);
	ck_assert_double_eq_tol(b.x - a.x, 1e-6 * j[0] + 2e-6 * j[1], 1e-7);
	ck_assert_double_eq_tol(b.y - a.y, 1e-6 * j[2] + 2e-6 * j[3], 1e-7);
}
END_TEST

static struct fit begin(vec2 pos)
{
	return (struct fit){.pos = pos, .scale = 1, .expected_scale = 1, .scale_spread = 0.02, .cloth = {120, 150, 95}};
}

START_TEST(test_fit_finds_painted_balls)
{
	struct random r = random_begin("fit");
	struct camera camera = scene_camera(0.03, -0.02);
	struct table table = scene_table();
	struct image_buffer image = {0};
	enum { COUNT = 15 };
	struct scene_ball ball[COUNT];
	for (int i = 0; i < COUNT; i++)
		ball[i] = (struct scene_ball){{-0.85 + 0.42 * (i % 5) + random_in(&r, -0.05, 0.05),
					       -0.38 + 0.38 * (i / 5) + random_in(&r, -0.05, 0.05)},
					      {(uint8_t)random_in(&r, 0, 60), (uint8_t)random_in(&r, 0, 60), 220}};
	scene_paint(&camera, &table, ball, COUNT, 3, &r, &image);
	struct fit_view view = {.frame = &image.image, .camera = &camera, .radius = table.ball_radius};
	for (int i = 0; i < COUNT; i++) {
		double angle = random_in(&r, 0, 6.28);
		struct fit fit = begin(vec2_madd(ball[i].pos, 4 * mm, vec2_from_angle(angle)));
		ck_assert(fit_refine(&view, &fit, 4));
		ck_assert_double_lt(vec2_dist(fit.pos, ball[i].pos), 0.12 * mm);
		ck_assert_double_eq_tol(fit.scale, 1, 0.01);
		ck_assert_double_gt(fit.support, 0.95);
	}
	image_buffer_finish(&image);
}
END_TEST

START_TEST(test_touching_balls_do_not_draw_each_other)
{
	struct random r = random_begin("fit_touching");
	struct camera camera = scene_camera(0, 0);
	struct table table = scene_table();
	struct image_buffer image = {0};
	double d = 2 * table.ball_radius;
	struct scene_ball ball[3] = {{{0.6, 0.2}, {20, 20, 220}},
				     {{0.6 + d, 0.2}, {20, 20, 220}},
				     {{0.6 + d / 2, 0.2 + 0.8660254 * d}, {20, 20, 220}}};
	scene_paint(&camera, &table, ball, 3, 2, &r, &image);
	struct fit fit[3];
	for (int i = 0; i < 3; i++)
		fit[i] = begin(vec2_add(ball[i].pos, (vec2){1 * mm, -1 * mm}));
	for (int round = 0; round < 3; round++) {
		struct fit other[3];
		for (int i = 0; i < 3; i++) {
			if (round == 0)
				outline_of_ball(&camera, fit[i].pos, table.ball_radius, 1, &fit[i].outline);
			other[i] = fit[i];
		}
		struct fit_view view = {.frame = &image.image,
					.camera = &camera,
					.radius = table.ball_radius,
					.other = other,
					.other_count = 3};
		for (int i = 0; i < 3; i++)
			ck_assert(fit_refine(&view, &fit[i], 2));
	}
	for (int i = 0; i < 3; i++)
		ck_assert_double_lt(vec2_dist(fit[i].pos, ball[i].pos), 0.6 * mm);
	image_buffer_finish(&image);
}
END_TEST

START_TEST(test_no_ball_no_fit)
{
	struct random r = random_begin("fit_nothing");
	struct camera camera = scene_camera(0, 0);
	struct table table = scene_table();
	struct image_buffer image = {0};
	scene_paint(&camera, &table, NULL, 0, 3, &r, &image);
	struct fit_view view = {.frame = &image.image, .camera = &camera, .radius = table.ball_radius};
	struct fit fit = begin((vec2){0.1, 0.1});
	ck_assert(!fit_refine(&view, &fit, 3) || fit.support < 0.3);
	/* Beyond the picture. */
	fit = begin((vec2){3, 2});
	ck_assert(!fit_refine(&view, &fit, 3) || fit.support < 0.3);
	image_buffer_finish(&image);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("fit");
	TCase *tc = tcase_create("fit");
	tcase_add_test(tc, test_outline_rays_touch_the_sphere);
	tcase_add_test(tc, test_jacobian_against_differences);
	tcase_add_test(tc, test_fit_finds_painted_balls);
	tcase_add_test(tc, test_touching_balls_do_not_draw_each_other);
	tcase_add_test(tc, test_no_ball_no_fit);
	tcase_set_timeout(tc, 60);
	suite_add_tcase(suite, tc);
	return suite;
}
