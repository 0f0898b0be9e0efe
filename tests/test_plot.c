#include "app/commands/plot.h"

#include <cairo.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/commands/overlay.h"
#include "app/config/text_file.h"
#include "harness.h"
#include "physics/sim.h"
#include "scenes.h"

enum { ENTRIES = 1000 };
static struct table table;
static struct trace_entry entry[ENTRIES];
static struct trace trace;
static char err[256];

static void setup(void)
{
	table = scene_thesis_table();
	struct model model;
	struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){-0.5, 0}), ball_at(COLOUR_RED, (vec2){0.2, 0.01})};
	struct sim sim;
	ck_assert(model_from_name("simple", &model));
	trace_init(&trace, entry, ENTRIES);
	sim_init(&sim, &table, &model, ball, 2);
	sim_strike(&sim, 0, &(struct shot){.angle = 0, .speed = 2});
	ck_assert_int_eq(sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = ENTRIES}, &trace),
			 SIM_AT_REST);
}

static char *temporary(const char *end)
{
	static char path[64];
	snprintf(path, sizeof path, "/tmp/billiard-plot-%d%s", (int)getpid(), end);
	return path;
}

START_TEST(formats_by_name)
{
	ck_assert(plot_format_known("a.svg"));
	ck_assert(plot_format_known("/x/y.png"));
	ck_assert(!plot_format_known("a.gif"));
	ck_assert(!plot_format_known(".svg"));
	ck_assert(!plot_format_known(""));
}
END_TEST

/* Pixel of a table point in the PNG. */
static uint32_t pixel(cairo_surface_t *surface, double x, double y)
{
	int width = cairo_image_surface_get_width(surface), height = cairo_image_surface_get_height(surface);
	double scale = width / (table.length + 0.2);
	int px = (int)(width / 2.0 + x * scale), py = (int)(height / 2.0 - y * scale);
	const uint32_t *row = (const uint32_t *)(void *)(cairo_image_surface_get_data(surface) +
							 py * cairo_image_surface_get_stride(surface));
	return row[px] & 0xffffff;
}

START_TEST(png_shows_balls_where_they_are)
{
	const char *path = temporary(".png");
	ck_assert_msg(plot_trace(&table, &trace, path, err, sizeof err) == 0, "%s", err);
	cairo_surface_t *surface = cairo_image_surface_create_from_png(path);
	ck_assert_int_eq(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
	for (int i = 0; i < 2; i++) {
		struct ball end = trace_at(&trace, i, trace_end(&trace));
		if (end.phase == BALL_POTTED)
			continue;
		uint32_t rgb = pixel(surface, end.pos.x, end.pos.y);
		ck_assert_msg(i ? (rgb >> 16) > 150 && (rgb & 0xff) < 80 : rgb == 0xffffff, "ball %d is %06x", i, rgb);
	}
	ck_assert_uint_lt(pixel(surface, 0, 0.4915) >> 16, 60); /* a pocket */
	cairo_surface_destroy(surface);
	unlink(path);
}
END_TEST

START_TEST(svg_is_one)
{
	const char *path = temporary(".svg");
	char *text;
	size_t size;
	ck_assert_msg(plot_trace(&table, &trace, path, err, sizeof err) == 0, "%s", err);
	ck_assert_int_eq(text_file_read(path, 1 << 22, &text, &size, err, sizeof err), 0);
	ck_assert(strstr(text, "<svg") && strstr(text, "</svg>"));
	free(text);
	unlink(path);
}
END_TEST

START_TEST(what_cannot_be_written)
{
	ck_assert_int_lt(plot_trace(&table, &trace, "/nonexistent/a.png", err, sizeof err), 0);
	ck_assert(strncmp(err, "/nonexistent/a.png: ", 20) == 0);
	ck_assert_int_lt(plot_trace(&table, &trace, "/nonexistent/a.svg", err, sizeof err), 0);
}
END_TEST

START_TEST(overlay_without_calibration)
{
	static uint8_t pixels[64 * 48 * 3];
	struct image image = {pixels, 64, 48, (ptrdiff_t)64 * 3};
	static struct vision_result result;
	result.ball_count = 1;
	result.ball[0] = (struct vision_ball){.px = {32, 24}, .radius_px = 8, .colour = COLOUR_RED};
	struct overlay overlay = {.frame = &image, .table = &table, .result = &result};
	const char *path = temporary(".png");
	ck_assert_msg(overlay_write(&overlay, path, err, sizeof err) == 0, "%s", err);
	cairo_surface_t *surface = cairo_image_surface_create_from_png(path);
	ck_assert_int_eq(cairo_image_surface_get_width(surface), 64);
	ck_assert_int_eq(cairo_image_surface_get_height(surface), 48);
	cairo_surface_destroy(surface);
	unlink(path);
	ck_assert_int_lt(overlay_write(&overlay, "/nonexistent/a.png", err, sizeof err), 0);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("plot");
	TCase *tcase = tcase_create("pictures");
	tcase_add_checked_fixture(tcase, setup, NULL);
	tcase_add_test(tcase, formats_by_name);
	tcase_add_test(tcase, png_shows_balls_where_they_are);
	tcase_add_test(tcase, svg_is_one);
	tcase_add_test(tcase, what_cannot_be_written);
	tcase_add_test(tcase, overlay_without_calibration);
	suite_add_tcase(suite, tcase);
	return suite;
}
