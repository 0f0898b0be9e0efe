#include "vision/scan.h"

#include <math.h>
#include <string.h>

#include "vision/seeds.h"
#include "vision_scene.h"

static struct scan scan;
static struct seeds seeds;
static struct camera camera;
static struct table table;
static struct image_buffer image;

static void setup(void)
{
	table = scene_table();
	camera = scene_camera(0.01, -0.01);
	ck_assert_int_eq(scan_init(&scan, 1280, 720), 0);
	ck_assert_int_eq(seeds_init(&seeds, 1280, 720), 0);
	ck_assert(scan_place(&scan, &camera, &table));
	ck_assert(seeds_place(&seeds, &scan, &camera, &table));
}

static void teardown(void)
{
	scan_finish(&scan);
	seeds_finish(&seeds);
	image_buffer_finish(&image);
}

/* Pixels of a round patch on the bed become gain times what they are. */
static void lighten(vec2 at, double radius_px, const double gain[3])
{
	vec2 px;
	ck_assert(camera_project(&camera, at, 0, &px));
	for (int y = (int)(px.y - radius_px); y <= px.y + radius_px; y++)
		for (int x = (int)(px.x - radius_px); x <= px.x + radius_px; x++)
			for (int c = 0; c < 3 && hypot(x - px.x, y - px.y) < radius_px; c++) {
				uint8_t *p = image.image.data + y * image.image.stride + 3 * x + c;
				*p = (uint8_t)fmin(255, gain[c] * *p);
			}
}

static int marked_around(vec2 at)
{
	vec2 px;
	int count = 0;
	ck_assert(camera_project(&camera, at, 0, &px));
	px = scan_from_full(&scan, px);
	for (int y = (int)px.y - 5; y <= (int)px.y + 5; y++)
		for (int x = (int)px.x - 5; x <= (int)px.x + 5; x++)
			count += scan.mark[y * scan.width + x] >= SCAN_FOREIGN;
	return count;
}

START_TEST(test_light_and_shade_are_cloth_balls_are_not)
{
	struct random r = random_begin("scan_marks");
	struct scene_ball ball[2] = {{{0.3, 0.1}, {20, 20, 210}}, {{-0.4, -0.2}, {200, 110, 20}}};
	scene_paint(&camera, &table, ball, 2, 3, &r, &image);
	/* Uneven light over the whole bed, a shadow, the projector's light. */
	for (int y = 0; y < 720; y++)
		for (int x = 0; x < 3 * 1280; x++) {
			uint8_t *p = image.image.data + y * image.image.stride + x;
			*p = (uint8_t)(*p * (0.75 + 0.3 * x / 3840.0));
		}
	lighten((vec2){0.6, 0.3}, 12, (double[3]){0.5, 0.5, 0.5});
	lighten((vec2){-0.6, 0.3}, 12, (double[3]){1.3, 1.3, 1.3});
	ck_assert(scan_frame(&scan, &image.image));
	ck_assert_int_eq(marked_around((vec2){0.6, 0.3}), 0);
	ck_assert_int_eq(marked_around((vec2){-0.6, 0.3}), 0);
	ck_assert_int_eq(marked_around((vec2){0, 0}), 0);
	ck_assert_int_gt(marked_around(ball[0].pos), 100);
	ck_assert_int_gt(marked_around(ball[1].pos), 100);
	/* The cloth's colour is known under the ball. */
	vec2 px;
	float cloth[3];
	camera_project(&camera, ball[0].pos, 0, &px);
	scan_cloth_at(&scan, px, cloth);
	ck_assert_float_eq_tol(cloth[1], (float)(150 * (0.75 + 0.3 * px.x / 1280)), 4);
}
END_TEST

START_TEST(test_seeds_lie_on_balls)
{
	struct random r = random_begin("seeds");
	struct scene_ball ball[12];
	for (int i = 0; i < 12; i++)
		ball[i] = (struct scene_ball){{-0.8 + 0.14 * i, -0.35 + 0.06 * i + 0.1 * (i % 2)}, {20, 20, 210}};
	scene_paint(&camera, &table, ball, 12, 3, &r, &image);
	ck_assert(scan_frame(&scan, &image.image));
	for (int pass = 0; pass < 2; pass++) {
		seeds_find(&seeds, &scan, pass == 0 ? NULL : scan.changed);
		for (int i = 0; i < 12; i++) {
			vec2 px;
			double near = 1e9;
			camera_project(&camera, ball[i].pos, table.ball_radius, &px);
			for (int k = 0; k < seeds.count; k++)
				near = fmin(near, vec2_dist(seeds.seed[k].px, px));
			ck_assert_double_lt(near, 2.5);
		}
		ck_assert_int_lt(seeds.count, 12 + 14);
	}
}
END_TEST

START_TEST(test_only_what_changed)
{
	struct random r = random_begin("scan_changes");
	struct scene_ball ball = {{0.2, 0.1}, {20, 20, 210}};
	scene_paint(&camera, &table, &ball, 1, 3, &r, &image);
	ck_assert(scan_frame(&scan, &image.image));
	scene_paint(&camera, &table, &ball, 1, 3, &r, &image);
	ck_assert_int_eq(scan_changes(&scan, &image.image), 0);
	vec2 before = ball.pos;
	ball.pos.x += 0.003;
	scene_paint(&camera, &table, &ball, 1, 3, &r, &image);
	int changed = scan_changes(&scan, &image.image);
	ck_assert_int_gt(changed, 0);
	ck_assert_int_lt(changed, 40);
	ball.pos.x += 0.3;
	scene_paint(&camera, &table, &ball, 1, 3, &r, &image);
	scan_changes(&scan, &image.image);
	scan_update(&scan);
	ck_assert_int_eq(marked_around(before), 0);
	ck_assert_int_gt(marked_around(ball.pos), 100);
}
END_TEST

/* A whole cell brighter by half a level is noise, by one level it is a change: of that cell and those around it. */
START_TEST(test_least_change)
{
	struct random r = {1};
	int mid = (scan.cells_y / 2) * scan.cells_x + scan.cells_x / 2;
	scene_paint(&camera, &table, NULL, 0, 0, &r, &image);
	ck_assert(scan_frame(&scan, &image.image));
	for (int rows = 8; rows <= 16; rows += 8) {
		scene_paint(&camera, &table, NULL, 0, 0, &r, &image);
		for (int y = 0; y < rows * scan.factor; y++) {
			vec2 px = scan_to_full(&scan, scan.cells_x / 2 * SCAN_CELL, scan.cells_y / 2 * SCAN_CELL);
			int top = (int)(px.y - (scan.factor - 1) / 2.0), left = (int)(px.x - (scan.factor - 1) / 2.0);
			uint8_t *p = image.image.data + (top + y) * image.image.stride + 3 * left;
			for (int x = 0; x < 3 * SCAN_CELL * scan.factor; x++)
				p[x]++;
		}
		ck_assert_int_eq(scan_changes(&scan, &image.image), rows == 16 ? 9 : 0);
		ck_assert_int_eq(scan.changed[mid], rows == 16);
		ck_assert_int_eq(scan.difference[mid], rows);
	}
}
END_TEST

START_TEST(test_no_cloth_no_scan)
{
	static const int grey[] = {0, 10, 255};
	ck_assert_int_eq(image_buffer_reserve(&image, 1280, 720), 0);
	for (int i = 0; i < 3; i++) {
		memset(image.image.data, grey[i], 1280 * 720 * 3);
		ck_assert(!scan_frame(&scan, &image.image));
	}
}
END_TEST

START_TEST(test_places_that_are_none)
{
	struct camera away = camera;
	struct scan before = scan;
	away.pose.t[0] += 5;
	ck_assert(!scan_place(&scan, &away, &table));
	away = camera;
	away.pose.t[2] = -1;
	ck_assert(!scan_place(&scan, &away, &table));
	/* Far too high: balls of a pixel. */
	away = camera;
	away.pose.t[2] += 20;
	ck_assert(!scan_place(&scan, &away, &table));
	/* Larger than life, and nearly out of the picture. */
	away = camera;
	away.in.cx += 1150;
	ck_assert(!scan_place(&scan, &away, &table));
	ck_assert_msg(memcmp(&scan, &before, sizeof(scan)) == 0, "half updated");
	/* Any size of frame fits into the same memory. */
	for (int width = 640; width <= 7680; width *= 2) {
		struct camera other = camera;
		ck_assert(camera_scale(&camera.in, width, width * 9 / 16, &other.in));
		ck_assert(scan_place(&scan, &other, &table));
		ck_assert_int_le(scan.width * scan.height, scan.capacity);
	}
}
END_TEST

/* Light that grows slowly is followed everywhere, round by round, for ever. */
START_TEST(test_every_row_is_learned_again)
{
	struct random r = random_begin("scan_relearn");
	scene_paint(&camera, &table, NULL, 0, 2, &r, &image);
	ck_assert(scan_frame(&scan, &image.image));
	float before[3], after[3];
	vec2 px;
	for (int round = 0; round < 3; round++) {
		for (ptrdiff_t i = 0; i < 720 * image.image.stride; i++)
			image.image.data[i] = (uint8_t)fmin(255, 1.1 * image.image.data[i]);
		ck_assert(camera_project(&camera, (vec2){0.5, -0.3}, 0, &px));
		scan_cloth_at(&scan, px, before);
		for (int row = 0; row < scan.cells_y; row++) {
			scan_changes(&scan, &image.image);
			scan_relearn(&scan);
			ck_assert(scan.relearn_row >= 0 && scan.relearn_row <= scan.cells_y);
		}
		scan_cloth_at(&scan, px, after);
		ck_assert_float_eq_tol(after[1] / before[1], 1.1f, 0.02f);
	}
	/* A place with fewer rows begins somewhere in it. */
	struct camera small = camera;
	ck_assert(camera_scale(&camera.in, 640, 360, &small.in));
	scan.relearn_row = scan.cells_y;
	ck_assert(scan_place(&scan, &small, &table));
	ck_assert_int_eq(image_buffer_reserve(&image, 640, 360), 0);
	scene_paint(&small, &table, NULL, 0, 2, &r, &image);
	ck_assert(scan_frame(&scan, &image.image));
	scan_relearn(&scan);
	ck_assert_int_le(scan.relearn_row, scan.cells_y);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("scan");
	TCase *tc = tcase_create("scan");
	tcase_add_checked_fixture(tc, setup, teardown);
	tcase_add_test(tc, test_light_and_shade_are_cloth_balls_are_not);
	tcase_add_test(tc, test_seeds_lie_on_balls);
	tcase_add_test(tc, test_only_what_changed);
	tcase_add_test(tc, test_least_change);
	tcase_add_test(tc, test_no_cloth_no_scan);
	tcase_add_test(tc, test_places_that_are_none);
	tcase_add_test(tc, test_every_row_is_learned_again);
	tcase_set_timeout(tc, 60);
	suite_add_tcase(suite, tc);
	return suite;
}
