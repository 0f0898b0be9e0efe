/* Where the bed lies in the frame, and how much smaller its copy is. */
#include "vision/scan_parts.h"

static const double SMALL_RADIUS_PX = 7.75; /* what a ball's radius should be in the small picture */
static const double BED_MARGIN = 0.012;	    /* m beyond the noses that still belong to the bed */

vec2 scan_to_full(const struct scan *scan, double x, double y)
{
	double half = (scan->factor - 1) / 2.0;
	return (vec2){scan->x0 + x * scan->factor + half, scan->y0 + y * scan->factor + half};
}

vec2 scan_from_full(const struct scan *scan, vec2 px)
{
	double half = (scan->factor - 1) / 2.0;
	return (vec2){(px.x - scan->x0 - half) / scan->factor, (px.y - scan->y0 - half) / scan->factor};
}

enum { BORDER_POINTS = 64 }; /* along the bed's border: a lens bends its edges */

static vec2 border_point(const struct table *table, int i)
{
	double hx = table->length / 2 + BED_MARGIN, hy = table->width / 2 + BED_MARGIN;
	int side = i / (BORDER_POINTS / 4);
	double k = 2.0 * (i % (BORDER_POINTS / 4)) / (BORDER_POINTS / 4) - 1;
	switch (side) {
	case 0:
		return (vec2){k * hx, -hy};
	case 1:
		return (vec2){hx, k * hy};
	case 2:
		return (vec2){-k * hx, hy};
	default:
		return (vec2){-hx, -k * hy};
	}
}

static bool border(const struct camera *camera, const struct table *table, vec2 px[BORDER_POINTS])
{
	for (int i = 0; i < BORDER_POINTS; i++)
		if (!camera_project(camera, border_point(table, i), 0, &px[i]))
			return false;
	return true;
}

static double middle_radius_px(const struct camera *camera, const struct table *table)
{
	vec2 a, b;
	double r = table->ball_radius;
	if (!camera_project(camera, (vec2){-r, 0}, r, &a) || !camera_project(camera, (vec2){r, 0}, r, &b))
		return 0;
	return vec2_dist(a, b) / 2;
}

static void fill_rows(struct scan *scan, const vec2 px[BORDER_POINTS])
{
	for (int y = 0; y < scan->height; y++) {
		double low = 1e9, high = -1e9, at = scan_to_full(scan, 0, y).y;
		for (int i = 0; i < BORDER_POINTS; i++) {
			vec2 a = px[i], b = px[(i + 1) % BORDER_POINTS];
			if ((a.y <= at) == (b.y <= at))
				continue;
			double x = a.x + (b.x - a.x) * (at - a.y) / (b.y - a.y);
			low = fmin(low, x);
			high = fmax(high, x);
		}
		int from = (int)ceil(scan_from_full(scan, (vec2){fmax(low, -1e6), 0}).x);
		int to = (int)floor(scan_from_full(scan, (vec2){fmin(high, 1e6), 0}).x) + 1;
		scan->row_from[y] = (int16_t)(low < high ? clamp_int(from, 0, scan->width) : 0);
		scan->row_to[y] = (int16_t)(low < high ? clamp_int(to, 0, scan->width) : 0);
	}
}

/* The part of the picture that the bed lies in, with some room: balls at its edge lean outwards. */
static void find_frame(struct scan *scan, const struct camera *camera, const vec2 px[BORDER_POINTS], double radius)
{
	double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
	for (int i = 0; i < BORDER_POINTS; i++) {
		x0 = fmin(x0, px[i].x), x1 = fmax(x1, px[i].x);
		y0 = fmin(y0, px[i].y), y1 = fmax(y1, px[i].y);
	}
	int room = (int)ceil(radius);
	int right = clamp_int((int)ceil(fmin(x1, 1e6)) + room, 0, camera->in.width);
	int bottom = clamp_int((int)ceil(fmin(y1, 1e6)) + room, 0, camera->in.height);
	scan->x0 = clamp_int((int)floor(fmax(x0, -1e6)) - room, 0, camera->in.width);
	scan->y0 = clamp_int((int)floor(fmax(y0, -1e6)) - room, 0, camera->in.height);
	int factor = (int)lround(radius / SMALL_RADIUS_PX);
	factor = factor < 1 ? 1 : factor;
	while ((right - scan->x0) / factor * ((bottom - scan->y0) / factor) > scan->capacity)
		factor++;
	scan->factor = factor;
	scan->width = (right - scan->x0) / factor;
	scan->height = (bottom - scan->y0) / factor;
}

bool scan_place(struct scan *scan, const struct camera *camera, const struct table *table)
{
	vec2 px[BORDER_POINTS];
	struct scan placed = *scan;
	double radius = middle_radius_px(camera, table);
	if (!(radius > 2) || !border(camera, table, px))
		return false;
	find_frame(&placed, camera, px, radius);
	if (placed.width < 4 * SCAN_CELL || placed.height < 2 * SCAN_CELL)
		return false;
	placed.cells_x = (placed.width + SCAN_CELL - 1) / SCAN_CELL;
	placed.cells_y = (placed.height + SCAN_CELL - 1) / SCAN_CELL;
	placed.half = placed.foreign + placed.cells_x * placed.cells_y;
	*scan = placed;
	fill_rows(scan, px);
	return true;
}
