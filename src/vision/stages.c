#include "vision/stages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "physics/table.h"
#include "vision/calibration.h"
#include "vision/detector.h"

struct colour {
	uint8_t b, g, r;
};
static const struct colour GREEN = {40, 255, 40}, RED = {60, 60, 255}, BLUE = {255, 160, 40}, WHITE = {255, 255, 255},
			   YELLOW = {0, 230, 255}, MAGENTA = {255, 60, 255};

/* ---- drawing
 * --------------------------------------------------------------------------------------------------------- */

static bool begin(struct image *out, const struct image *frame)
{
	*out = (struct image){.width = frame->width, .height = frame->height, .stride = 3 * (ptrdiff_t)frame->width};
	out->data = calloc((size_t)frame->height, (size_t)out->stride);
	return out->data != NULL;
}

static void end(const struct stage_watch *watch, const char *name, struct image *picture)
{
	watch->show(watch->user, name, picture->data ? picture : NULL);
	free(picture->data);
}

/* The frame itself, darker so that lines stand out. */
static bool begin_frame(struct image *out, const struct image *frame)
{
	if (!begin(out, frame))
		return false;
	for (int y = 0; y < frame->height; y++)
		for (ptrdiff_t x = 0; x < out->stride; x++)
			out->data[y * out->stride + x] = (uint8_t)(frame->data[y * frame->stride + x] * 3 / 5);
	return true;
}

static void put(struct image *out, int x, int y, struct colour colour)
{
	if (x < 0 || y < 0 || x >= out->width || y >= out->height)
		return;
	uint8_t *p = out->data + y * out->stride + 3 * (ptrdiff_t)x;
	p[0] = colour.b, p[1] = colour.g, p[2] = colour.r;
}

/* Places may be far outside of the picture, where they do not fit into an int. */
static void dot(struct image *out, vec2 p, struct colour colour)
{
	if (fabs(p.x) < 1e6 && fabs(p.y) < 1e6)
		put(out, (int)lround(p.x), (int)lround(p.y), colour);
}

static void line(struct image *out, vec2 a, vec2 b, struct colour colour)
{
	double far = fmax(fabs(b.x - a.x), fabs(b.y - a.y));
	int steps = far < 1e5 ? (int)far + 1 : 0;
	for (int i = 0; i <= steps && steps > 0; i++)
		dot(out, vec2_madd(a, (double)i / steps, vec2_sub(b, a)), colour);
}

static void cross(struct image *out, vec2 p, struct colour colour)
{
	const double arm = 3;
	line(out, (vec2){p.x - arm, p.y - arm}, (vec2){p.x + arm, p.y + arm}, colour);
	line(out, (vec2){p.x - arm, p.y + arm}, (vec2){p.x + arm, p.y - arm}, colour);
}

/* A small pixel of the scan covers factor x factor of the picture's. */
static void fill_small(struct image *out, const struct scan *scan, int x, int y, struct colour colour)
{
	for (int i = 0; i < scan->factor * scan->factor; i++)
		put(out, scan->x0 + x * scan->factor + i % scan->factor, scan->y0 + y * scan->factor + i / scan->factor,
		    colour);
}

/* ---- stages
 * ---------------------------------------------------------------------------------------------------------- */

/* Draws what lies at one height of the table. */
struct table_pen {
	struct image *out;
	const struct camera *camera;
	double z; /* m */
	struct colour colour;
};

/* Straight on the table is not straight through a lens: in steps. */
static void table_line(const struct table_pen *pen, vec2 a, vec2 b)
{
	enum { STEPS = 24 };
	vec2 from, to;
	for (int i = 0; i < STEPS; i++)
		if (camera_project(pen->camera, vec2_madd(a, (double)i / STEPS, vec2_sub(b, a)), pen->z, &from) &&
		    camera_project(pen->camera, vec2_madd(a, (i + 1.0) / STEPS, vec2_sub(b, a)), pen->z, &to))
			line(pen->out, from, to, pen->colour);
}

static void table_box(const struct table_pen *pen, vec2 mid, vec2 half)
{
	static const int sx[] = {-1, 1, 1, -1}, sy[] = {-1, -1, 1, 1};
	for (int i = 0; i < 4; i++) {
		int k = (i + 1) % 4;
		vec2 a = {mid.x + sx[i] * half.x, mid.y + sy[i] * half.y};
		vec2 b = {mid.x + sx[k] * half.x, mid.y + sy[k] * half.y};
		table_line(pen, a, b);
	}
}

void stage_markers(const struct stage_watch *watch, const struct image *frame, const struct calibration *calibration,
		   const struct table *table)
{
	struct image out;
	if (!watch)
		return;
	const struct marker_layout *layout = calibration->layout;
	if (begin_frame(&out, frame) && calibration->valid) {
		vec2 half = {layout->side / 2, layout->side / 2}, bed = {table->length / 2, table->width / 2};
		const struct camera *camera = &calibration->camera;
		table_box(&(struct table_pen){&out, camera, 0, BLUE}, (vec2){0, 0}, bed);
		const struct table_pen pen = {&out, camera, layout->height, RED};
		for (int i = 0; i < layout->count; i++)
			table_box(&pen, layout->marker[i].centre, half);
	}
	for (int i = 0; i < 4 * calibration->seen_count && out.data; i++) {
		const struct marker_view *m = &calibration->seen[i / 4];
		cross(&out, (vec2){m->x[i % 4], m->y[i % 4]}, GREEN);
	}
	end(watch, "markers", &out);
}

void stage_scan(const struct stage_watch *watch, const struct image *frame, const struct scan *scan)
{
	struct image cloth, marks;
	if (!watch)
		return;
	bool both = begin(&cloth, frame);
	both = begin(&marks, frame) && both;
	for (int y = 0; y < scan->height && both; y++)
		for (int x = scan->row_from[y]; x < scan->row_to[y]; x++) {
			float c[3];
			uint8_t mark = scan->mark[y * scan->width + x];
			scan_cloth_at(scan, scan_to_full(scan, x, y), c);
			fill_small(&cloth, scan, x, y,
				   (struct colour){(uint8_t)(c[0] + 0.5f), (uint8_t)(c[1] + 0.5f),
						   (uint8_t)(c[2] + 0.5f)});
			fill_small(&marks, scan, x, y, (struct colour){mark, mark, mark});
		}
	end(watch, "cloth", &cloth);
	end(watch, "marks", &marks);
}

static void show_votes(const struct stage_watch *watch, const struct image *frame, const struct scan *scan,
		       const struct seeds *seeds)
{
	struct image out;
	int most = 1, n = scan->width * scan->height;
	for (int i = 0; i < n; i++)
		most = seeds->sum[i] > most ? seeds->sum[i] : most;
	bool room = begin(&out, frame);
	for (int i = 0; i < n && room; i++) {
		uint8_t v = (uint8_t)(255 * seeds->sum[i] / most);
		fill_small(&out, scan, i % scan->width, i / scan->width, (struct colour){v, v, v});
	}
	end(watch, "votes", &out);
}

void stage_seeds(const struct stage_watch *watch, const struct image *frame, const struct scan *scan,
		 const struct seeds *seeds)
{
	struct image out;
	if (!watch)
		return;
	show_votes(watch, frame, scan, seeds);
	int most = 1;
	for (int i = 0; i < seeds->count; i++)
		most = seeds->seed[i].votes > most ? seeds->seed[i].votes : most;
	bool room = begin_frame(&out, frame);
	for (int i = 0; i < seeds->count && room; i++) {
		uint8_t v = (uint8_t)(80 + 175 * seeds->seed[i].votes / most);
		cross(&out, seeds->seed[i].px, (struct colour){v, v, v});
	}
	end(watch, "seeds", &out);
}

static void draw_fit(struct image *out, const struct fit_view *view, const struct fit *fit)
{
	struct rim_point rim[OUTLINE_POINTS];
	const struct outline *o = &fit->outline;
	const struct colour colour[] = {
		[RIM_EDGE] = WHITE, [RIM_CREASE] = YELLOW, [RIM_BARE] = RED, [RIM_HIDDEN] = BLUE};
	for (int i = 0; i < OUTLINE_POINTS; i++)
		line(out, o->point[i], o->point[(i + 1) % OUTLINE_POINTS], GREEN);
	fit_rim(view, fit, rim);
	for (int i = 0; i < OUTLINE_POINTS; i++)
		dot(out, rim[i].px, colour[rim[i].state]);
}

void stage_fits(const struct stage_watch *watch, const char *name, const struct detector *detector)
{
	struct image out;
	struct fit_view fine = detector->view;
	struct fit fit[DETECT_MAX];
	if (!watch)
		return;
	bool room = begin_frame(&out, fine.frame);
	for (int i = 0; i < detector->count; i++)
		fit[i] = detector->candidate[i].fit;
	fine.other = fit;
	fine.other_count = detector->count;
	fine.coarse = false;
	for (int i = 0; i < detector->refused_count && room; i++)
		cross(&out, detector->refused[i].fit.outline.centre, MAGENTA);
	for (int i = 0; i < detector->count && room; i++)
		draw_fit(&out, &fine, &fit[i]);
	end(watch, name, &out);
}
