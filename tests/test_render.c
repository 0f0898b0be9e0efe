#include "harness.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/light/draw.h"
#include "app/light/render.h"

enum { WIDTH = 960, HEIGHT = 540 };
static billiard_draw_list_t list;
static billiard_animation_t animation;

/* 400 px per m, the table's centre in the middle of the picture, y up. */
static struct config_projector plain_projector(void)
{
	return (struct config_projector){.width = WIDTH,
					 .height = HEIGHT,
					 .homography = {400, 0, WIDTH / 2, 0, -400, HEIGHT / 2, 0, 0, 1},
					 .font = "DejaVu Sans"};
}

static struct render *begin(const struct config_projector *projector)
{
	struct render *render;
	char err[200];
	ck_assert_int_eq(render_create(&render, projector, err, sizeof(err)), 0);
	draw_clear(&list);
	return render;
}

static uint32_t pixel(const struct render *render, int x, int y)
{
	int width, height, stride;
	const uint32_t *p = render_pixels(render, &width, &height, &stride);
	ck_assert(x >= 0 && x < width && y >= 0 && y < height);
	return p[y * stride / 4 + x] & 0xffffff;
}

static int lit_pixels(const struct render *render, int x0, int y0, int x1, int y1)
{
	int n = 0;
	for (int y = y0; y < y1; y++)
		for (int x = x0; x < x1; x++)
			n += pixel(render, x, y) != 0;
	return n;
}

START_TEST(nothing_is_black)
{
	struct config_projector projector = plain_projector();
	struct render *render = begin(&projector);
	render_draw(render, &list, NULL, 0);
	ck_assert_int_eq(lit_pixels(render, 0, 0, WIDTH, HEIGHT), 0);
	render_destroy(render);
}
END_TEST

START_TEST(things_lie_where_the_homography_puts_them)
{
	struct config_projector projector = plain_projector();
	struct render *render = begin(&projector);
	draw_ring(&list, (vec2){0.5, 0.25}, 0.01, 0.024, 0xff0000ff);
	draw_polyline(&list, (vec2[]){{-0.5, -0.25}, {0.25, -0.25}}, 2, 0.01, 0x00ff00ff);
	draw_ring(&list, (vec2){-0.5, 0.25}, 0.05, 0.01, 0x0000ffff);
	render_draw(render, &list, NULL, 0);
	ck_assert_uint_eq(pixel(render, 680, 170), 0xff0000);
	ck_assert_uint_eq(pixel(render, 400, 370), 0x00ff00);
	ck_assert_uint_eq(pixel(render, 400, 365), 0);
	ck_assert_uint_eq(pixel(render, 280, 170), 0);
	ck_assert_uint_eq(pixel(render, 300, 170), 0x0000ff);
	ck_assert_uint_eq(pixel(render, 280, 150), 0x0000ff);
	render_destroy(render);
}
END_TEST

START_TEST(circles_follow_the_perspective)
{
	struct config_projector projector = plain_projector();
	double h[9] = {380, 25, 470, -15, -410, 280, 0.12, -0.2, 1};
	memcpy(projector.homography, h, sizeof(h));
	struct render *render = begin(&projector);
	vec2 centre = {0.4, 0.2};
	draw_ring(&list, centre, 0.1, 0.008, 0xffffffff);
	render_draw(render, &list, NULL, 0);
	for (int i = 0; i < 24; i++) {
		vec2 p = vec2_madd(centre, 0.1, vec2_from_angle(0.1 + i * 0.26));
		double w = h[6] * p.x + h[7] * p.y + 1;
		ck_assert_uint_gt(pixel(render, (int)((h[0] * p.x + h[1] * p.y + h[2]) / w),
					(int)((h[3] * p.x + h[4] * p.y + h[5]) / w)),
				  0x808080);
	}
	render_destroy(render);
}
END_TEST

START_TEST(dashes_have_gaps)
{
	struct config_projector projector = plain_projector();
	struct render *render = begin(&projector);
	draw_dashed(&list, (vec2[]){{-1, 0}, {1, 0}}, 2, 0.01, 0xffffffff);
	render_draw(render, &list, NULL, 0);
	int changes = 0;
	for (int x = 100; x < 860; x++)
		changes += (pixel(render, x, 270) > 0x808080) != (pixel(render, x - 1, 270) > 0x808080);
	ck_assert_int_ge(changes, 50);
	render_destroy(render);
}
END_TEST

/* The places for text are reckoned without a font: no text may be wider than reckoned there. */
START_TEST(text_stays_in_its_box)
{
	static const char *texts[] = {"1.2 m/s  BOTTOM-CENTER  1/2", "MWMWMWMW", "gjpqy", "NO PROPOSAL"};
	struct config_projector projector = plain_projector();
	struct render *render = begin(&projector);
	for (size_t i = 0; i < sizeof(texts) / sizeof(texts[0]); i++) {
		draw_clear(&list);
		draw_text(&list, (vec2){-0.8, 0}, 0.055, 0xffffffff, texts[i]);
		render_draw(render, &list, NULL, 0);
		int left = 480 - 320, right = left + (int)ceil(400 * draw_text_width(texts[i], 0.055));
		int top = 270 - 22, bottom = 270 + 6;
		int inside = lit_pixels(render, left - 1, top, right, bottom);
		ck_assert_int_gt(inside, 50);
		ck_assert_int_eq(lit_pixels(render, 0, 0, WIDTH, HEIGHT), inside);
	}
	render_destroy(render);
}
END_TEST

START_TEST(layers_order_what_overlaps)
{
	struct config_projector projector = plain_projector();
	struct render *render = begin(&projector);
	draw_ring(&list, (vec2){0, 0}, 0.025, 0.06, 0x0000ffff);
	draw_polyline(&list, (vec2[]){{-0.2, 0}, {0.2, 0}}, 2, 0.02, 0xff0000ff);
	render_draw(render, &list, NULL, 0);
	ck_assert_uint_eq(pixel(render, 480, 270), 0x0000ff);
	list.items[0].layer = -100;
	list.items[1].layer = 100;
	render_draw(render, &list, NULL, 0);
	ck_assert_uint_eq(pixel(render, 480, 270), 0xff0000);
	render_destroy(render);
}
END_TEST

static void put_keyframe(int ball, double begin, double end, vec2 pos, vec2 vel, vec2 acc, int phase)
{
	animation.keyframes[animation.keyframe_count++] = (billiard_keyframe_t){.begin = begin,
										.end = end,
										.ball = (int16_t)ball,
										.phase = (int8_t)phase,
										.x = pos.x,
										.y = pos.y,
										.vx = vel.x,
										.vy = vel.y,
										.ax = acc.x,
										.ay = acc.y};
}

START_TEST(animated_balls_move_by_their_keyframes)
{
	memset(&animation, 0, sizeof(animation));
	animation.ball_count = 3;
	animation.ball_radius = 0.026;
	put_keyframe(0, 0, 1, (vec2){0, 0}, (vec2){0.5, 0}, (vec2){-0.2, 0}, BALL_ROLLING);
	put_keyframe(1, 1, 2, (vec2){0.5, 0}, (vec2){0, 0.1}, (vec2){0, 0}, BALL_ROLLING);
	put_keyframe(0, 1, 2, (vec2){0.4, 0}, (vec2){0, 0}, (vec2){0, 0}, BALL_REST);
	put_keyframe(1, 2, 2, (vec2){0.5, 0.1}, (vec2){0, 0}, (vec2){0, 0}, BALL_POTTED);
	put_keyframe(2, 0, 9, (vec2){-0.5, 0}, (vec2){0, 0}, (vec2){0, 0}, BALL_REST);
	vec2 pos;
	ck_assert(!render_animated(&animation, 2, 1, &pos)); /* lies where the real one lies */
	ck_assert(render_animated(&animation, 0, 0.5, &pos));
	ck_assert_double_eq_tol(pos.x, 0.25 - 0.025, 1e-12);
	ck_assert(!render_animated(&animation, 1, 0.5, &pos));
	ck_assert(render_animated(&animation, 1, 1.5, &pos));
	ck_assert_double_eq_tol(pos.y, 0.05, 1e-12);
	ck_assert(!render_animated(&animation, 1, 2.5, &pos));
	ck_assert(render_animated(&animation, 0, 50, &pos));
	ck_assert_double_eq_tol(pos.x, 0.4, 1e-12);
	struct config_projector projector = plain_projector();
	struct render *render = begin(&projector);
	render_draw(render, &list, &animation, 1.2);
	ck_assert_int_gt(lit_pixels(render, 480 + 160 - 12, 258, 480 + 160 + 12, 282), 50);
	ck_assert_int_eq(lit_pixels(render, 0, 0, 480, HEIGHT), 0);
	render_destroy(render);
}
END_TEST

START_TEST(points_that_cannot_be_shown_are_left_out)
{
	struct config_projector projector = plain_projector();
	projector.homography[6] = -2; /* x = 0.5 is on the projector's own plane */
	struct render *render = begin(&projector);
	draw_polyline(&list, (vec2[]){{0.4999999999, 0}, {90, 0}}, 2, 0.01, 0xffffffff);
	draw_ring(&list, (vec2){0.5, 0}, 0.1, 0.01, 0xffffffff);
	draw_text(&list, (vec2){0.7, 0}, 0.05, 0xffffffff, "behind");
	render_draw(render, &list, NULL, 0);
	ck_assert_int_eq(lit_pixels(render, 0, 0, WIDTH, HEIGHT), 0);
	render_destroy(render);
}
END_TEST

static char *read_file(const char *path, size_t *size)
{
	FILE *file = fopen(path, "rb");
	ck_assert_ptr_nonnull(file);
	char *data = malloc(1 << 20);
	*size = fread(data, 1, 1 << 20, file);
	fclose(file);
	return data;
}

START_TEST(same_list_same_bytes)
{
	struct config_projector projector = plain_projector();
	char err[200], path[2][64];
	size_t size[2];
	char *data[2];
	for (int i = 0; i < 2; i++) {
		struct render *render = begin(&projector);
		draw_text(&list, (vec2){-0.8, 0}, 0.055, 0xffffffff, "1.2 m/s");
		draw_ring(&list, (vec2){0.3, 0.1}, 0.05, 0.005, 0xc0ffffff);
		if (i == 1)
			render_draw(render, &list, NULL, 0); /* drawing again must leave nothing behind */
		render_draw(render, &list, NULL, 0);
		snprintf(path[i], sizeof(path[i]), "/tmp/billiard-test-render-%d-%d.png", (int)getpid(), i);
		ck_assert_int_eq(render_write_png(render, path[i], err, sizeof(err)), 0);
		data[i] = read_file(path[i], &size[i]);
		unlink(path[i]);
		render_destroy(render);
	}
	ck_assert_uint_eq(size[0], size[1]);
	ck_assert_int_eq(memcmp(data[0], data[1], size[0]), 0);
	free(data[0]);
	free(data[1]);
}
END_TEST

START_TEST(bad_projectors_are_refused)
{
	struct render *render;
	char err[200] = "";
	struct config_projector projector = plain_projector();
	projector.width = 0;
	ck_assert_int_eq(render_create(&render, &projector, err, sizeof(err)), -EINVAL);
	ck_assert_ptr_null(render);
	ck_assert_ptr_nonnull(strstr(err, "width"));
	projector = plain_projector();
	projector.homography[3] = NAN;
	ck_assert_int_eq(render_create(&render, &projector, err, sizeof(err)), -EINVAL);
	projector = plain_projector();
	memset(projector.homography, 0, sizeof(projector.homography));
	ck_assert_int_eq(render_create(&render, &projector, err, sizeof(err)), -EINVAL);
	render_destroy(NULL);
}
END_TEST

START_TEST(unwritable_picture_says_where)
{
	struct config_projector projector = plain_projector();
	struct render *render = begin(&projector);
	char err[200] = "";
	ck_assert_int_lt(render_write_png(render, "/nonexistent/picture.png", err, sizeof(err)), 0);
	ck_assert_ptr_nonnull(strstr(err, "/nonexistent/picture.png"));
	render_destroy(render);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("render");
	TCase *items = tcase_create("items"), *pictures = tcase_create("pictures");
	tcase_add_test(items, nothing_is_black);
	tcase_add_test(items, things_lie_where_the_homography_puts_them);
	tcase_add_test(items, circles_follow_the_perspective);
	tcase_add_test(items, dashes_have_gaps);
	tcase_add_test(items, text_stays_in_its_box);
	tcase_add_test(items, layers_order_what_overlaps);
	tcase_add_test(items, animated_balls_move_by_their_keyframes);
	tcase_add_test(items, points_that_cannot_be_shown_are_left_out);
	tcase_add_test(pictures, same_list_same_bytes);
	tcase_add_test(pictures, bad_projectors_are_refused);
	tcase_add_test(pictures, unwritable_picture_says_where);
	suite_add_tcase(suite, items);
	suite_add_tcase(suite, pictures);
	return suite;
}
