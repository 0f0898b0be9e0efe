#include "app/commands/plot.h"

#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/light/picture.h"

static const double px_per_m = 500;
static const double margin = 0.1;      /* m around the bed */
static const double path_step = 0.005; /* s between two points of a curved path */

struct rgb {
	double r, g, b;
};

static const struct rgb colour_table[COLOUR_COUNT] = {
	[COLOUR_WHITE] = {1, 1, 1},	  [COLOUR_RED] = {0.8, 0.1, 0.1},      [COLOUR_YELLOW] = {0.95, 0.8, 0.1},
	[COLOUR_GREEN] = {0, 0.35, 0.15}, [COLOUR_BROWN] = {0.45, 0.25, 0.1},  [COLOUR_BLUE] = {0.1, 0.2, 0.8},
	[COLOUR_PINK] = {1, 0.6, 0.7},	  [COLOUR_BLACK] = {0.05, 0.05, 0.05}, [COLOUR_UNKNOWN] = {0.6, 0.6, 0.6},
};

static void set_colour(cairo_t *cr, struct rgb c, double alpha)
{
	cairo_set_source_rgba(cr, c.r, c.g, c.b, alpha);
}

static bool ends_in(const char *path, const char *end)
{
	size_t n = strlen(path), m = strlen(end);
	return n > m && strcmp(path + n - m, end) == 0;
}

bool plot_format_known(const char *path)
{
	return ends_in(path, ".svg") || ends_in(path, ".png");
}

static void disc(cairo_t *cr, vec2 at, double radius)
{
	cairo_new_sub_path(cr);
	cairo_arc(cr, at.x, at.y, radius, 0, 2 * M_PI);
}

static void draw_table(cairo_t *cr, const struct table *table)
{
	cairo_set_source_rgb(cr, 0.93, 0.93, 0.9);
	cairo_paint(cr);
	cairo_rectangle(cr, -table->length / 2, -table->width / 2, table->length, table->width);
	cairo_set_source_rgb(cr, 0.25, 0.6, 0.4);
	cairo_fill(cr);
	cairo_set_source_rgb(cr, 0.15, 0.15, 0.15);
	for (int i = 0; i < table->pocket_count; i++)
		disc(cr, table->pocket[i].centre, table->pocket[i].radius);
	cairo_fill(cr);
	cairo_set_line_width(cr, 0.004);
	cairo_set_source_rgb(cr, 0.4, 0.25, 0.1);
	for (int i = 0; i < table->cushion_count; i++) {
		cairo_move_to(cr, table->cushion[i].a.x, table->cushion[i].a.y);
		cairo_line_to(cr, table->cushion[i].b.x, table->cushion[i].b.y);
	}
	for (int i = 0; i < table->jaw_count; i++)
		if (table->jaw[i].radius > 0)
			disc(cr, table->jaw[i].centre, table->jaw[i].radius);
	cairo_stroke(cr);
}

static void draw_ball(cairo_t *cr, const struct ball *ball, double radius, double alpha)
{
	disc(cr, ball->pos, radius);
	set_colour(cr, colour_table[ball->colour], alpha);
	cairo_fill_preserve(cr);
	cairo_set_line_width(cr, 0.001);
	cairo_set_source_rgba(cr, 0, 0, 0, alpha);
	cairo_stroke(cr);
}

/* Points at every event, so that corners are sharp, and between them in small steps. */
static void draw_path(cairo_t *cr, const struct trace *trace, int ball)
{
	cairo_move_to(cr, trace->start[ball].pos.x, trace->start[ball].pos.y);
	double begin = 0;
	for (int i = 0; i < trace->count; i++) {
		const struct event *event = &trace->entry[i].event;
		if (event->ball != ball && !(event->kind == EVENT_BALL_BALL && event->other == ball))
			continue;
		for (double t = begin + path_step; t < event->time; t += path_step) {
			vec2 at = trace_at(trace, ball, t).pos;
			cairo_line_to(cr, at.x, at.y);
		}
		vec2 at = trace->entry[i].after[event->ball == ball ? 0 : 1].pos;
		cairo_line_to(cr, at.x, at.y);
		begin = event->time;
	}
	cairo_set_line_width(cr, 0.003);
	set_colour(cr, colour_table[trace->start[ball].colour], 0.9);
	cairo_stroke(cr);
}

/* True when the trace ends before the balls do: more happened than it holds. */
static bool is_cut(const struct trace *trace)
{
	for (int i = 0; i < trace->ball_count; i++) {
		struct ball end = trace_at(trace, i, trace_end(trace));
		if (end.phase != BALL_REST && end.phase != BALL_POTTED)
			return true;
	}
	return trace->overflow;
}

static void draw_cut_note(cairo_t *cr, const struct table *table, const struct trace *trace)
{
	char text[80];
	snprintf(text, sizeof text, "cut after %d events, %.1f s: the balls still move", trace->count,
		 trace_end(trace));
	cairo_save(cr);
	cairo_translate(cr, -table->length / 2, -table->width / 2 - margin / 3);
	cairo_scale(cr, 1, -1); /* the table's y goes up, that of letters down */
	cairo_move_to(cr, 0, 0);
	cairo_set_font_size(cr, margin / 2);
	cairo_set_source_rgb(cr, 0.8, 0, 0);
	cairo_show_text(cr, text);
	cairo_restore(cr);
}

/* Pale where the end of a path is not the end of the way. */
static void draw_ends(cairo_t *cr, const struct table *table, const struct trace *trace)
{
	bool cut = is_cut(trace);
	for (int i = 0; i < trace->ball_count; i++) {
		struct ball end = trace_at(trace, i, trace_end(trace));
		if (end.phase != BALL_POTTED)
			draw_ball(cr, &end, table->ball_radius, cut ? 0.35 : 1);
	}
	if (cut)
		draw_cut_note(cr, table, trace);
}

struct plot {
	const struct table *table;
	const struct trace *trace;
	double width, height; /* px */
};

static void draw(cairo_t *cr, const void *context)
{
	const struct plot *plot = context;
	const struct trace *trace = plot->trace;
	cairo_translate(cr, plot->width / 2, plot->height / 2);
	cairo_scale(cr, px_per_m, -px_per_m);
	draw_table(cr, plot->table);
	for (int i = 0; i < trace->ball_count; i++)
		if (trace->start[i].phase != BALL_POTTED)
			draw_ball(cr, &trace->start[i], plot->table->ball_radius, 0.35);
	for (int i = 0; i < trace->ball_count; i++)
		if (trace->start[i].phase != BALL_POTTED)
			draw_path(cr, trace, i);
	draw_ends(cr, plot->table, trace);
}

static int save_png(const struct plot *plot, const char *path, char *err, size_t err_size)
{
	cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)plot->width, (int)plot->height);
	cairo_t *cr = cairo_create(surface);
	draw(cr, plot);
	int code = picture_save_png(cr, path, err, err_size);
	cairo_destroy(cr);
	cairo_surface_destroy(surface);
	return code;
}

int plot_trace(const struct table *table, const struct trace *trace, const char *path, char *err, size_t err_size)
{
	struct plot plot = {table, trace, (table->length + 2 * margin) * px_per_m,
			    (table->width + 2 * margin) * px_per_m};
	if (!ends_in(path, ".svg"))
		return save_png(&plot, path, err, err_size);
	struct picture picture = {plot.width, plot.height, draw, &plot};
	return picture_save_svg(&picture, path, err, err_size);
}
