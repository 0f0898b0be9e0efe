#include "vision/scan.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SMALL_RADIUS_PX = 7.75; /* what a ball's radius should be in the small picture */
static const double BED_MARGIN = 0.012;	    /* m beyond the noses that still belong to the bed */
static const float CLOTH_CHROMA = 0.11f;    /* off the cloth's direction, relative to its length: still cloth */
static const float CLOTH_SHADE_MIN = 0.5f, CLOTH_SHADE_MAX = 1.4f;
enum { CELL_STEP = 2 };			   /* of a cell, every second pixel of every second row tells enough */
static const float CELL_MIN_SHARE = 0.15f; /* of a cell's pixels that must be cloth before it is believed */

int scan_init(struct scan *scan, int width, int height)
{
	size_t n = (size_t)width * (size_t)height, cells = n / (SCAN_CELL * SCAN_CELL) + (size_t)(width + height) + 4;
	*scan = (struct scan){.capacity = width * height};
	scan->bgr = malloc(3 * n);
	scan->mark = malloc(n);
	scan->row_from = calloc((size_t)(width + height), sizeof(*scan->row_from));
	scan->row_to = calloc((size_t)(width + height), sizeof(*scan->row_to));
	scan->cell = calloc(3 * cells, sizeof(*scan->cell));
	scan->cell_weight = calloc(2 * cells, sizeof(*scan->cell_weight));
	scan->reference = malloc(3 * n);
	scan->changed = calloc(2 * cells, sizeof(*scan->changed));
	scan->difference = calloc(cells, sizeof(*scan->difference));
	scan->foreign = calloc(2 * cells, sizeof(*scan->foreign));
	if (scan->bgr && scan->mark && scan->row_from && scan->row_to && scan->cell && scan->cell_weight &&
	    scan->reference && scan->changed && scan->difference && scan->foreign)
		return 0;
	scan_finish(scan);
	return -ENOMEM;
}

void scan_finish(struct scan *scan)
{
	free(scan->bgr);
	free(scan->mark);
	free(scan->row_from);
	free(scan->row_to);
	free(scan->cell);
	free(scan->cell_weight);
	free(scan->reference);
	free(scan->changed);
	free(scan->difference);
	free(scan->foreign);
	*scan = (struct scan){0};
}

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

/* ---- place
 * ----------------------------------------------------------------------------------------------------------- */

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

static int clamp_int(int v, int low, int high)
{
	return v < low ? low : v > high ? high : v;
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

bool scan_place(struct scan *scan, const struct camera *camera, const struct table *table)
{
	vec2 px[BORDER_POINTS];
	double radius = middle_radius_px(camera, table);
	if (!(radius > 2) || !border(camera, table, px))
		return false;
	double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
	for (int i = 0; i < BORDER_POINTS; i++) {
		x0 = fmin(x0, px[i].x), x1 = fmax(x1, px[i].x);
		y0 = fmin(y0, px[i].y), y1 = fmax(y1, px[i].y);
	}
	/* Room around the bed: balls at its edge lean outwards in the picture. */
	int room = (int)ceil(radius);
	int left = clamp_int((int)floor(fmax(x0, -1e6)) - room, 0, camera->in.width);
	int top = clamp_int((int)floor(fmax(y0, -1e6)) - room, 0, camera->in.height);
	int right = clamp_int((int)ceil(fmin(x1, 1e6)) + room, 0, camera->in.width);
	int bottom = clamp_int((int)ceil(fmin(y1, 1e6)) + room, 0, camera->in.height);
	int factor = (int)lround(radius / SMALL_RADIUS_PX);
	factor = factor < 1 ? 1 : factor;
	while ((right - left) / factor * ((bottom - top) / factor) > scan->capacity)
		factor++;
	scan->factor = factor;
	scan->x0 = left;
	scan->y0 = top;
	scan->width = (right - left) / factor;
	scan->height = (bottom - top) / factor;
	if (scan->width < 4 * SCAN_CELL || scan->height < 2 * SCAN_CELL)
		return false;
	scan->cells_x = (scan->width + SCAN_CELL - 1) / SCAN_CELL;
	scan->cells_y = (scan->height + SCAN_CELL - 1) / SCAN_CELL;
	scan->half = scan->foreign + scan->cells_x * scan->cells_y;
	fill_rows(scan, px);
	return true;
}

/* ---- copy
 * ------------------------------------------------------------------------------------------------------------ */

enum { STRIP = 64 };

/* Downwards first: that loop runs over plain bytes. */
static void shrink_two(const uint8_t *restrict a, const uint8_t *restrict b, uint8_t *restrict out, int count)
{
	uint16_t sum[6 * STRIP];
	for (int from = 0; from < count; from += STRIP) {
		int n = count - from < STRIP ? count - from : STRIP;
		for (int i = 0; i < 6 * n; i++)
			sum[i] = (uint16_t)(a[6 * from + i] + b[6 * from + i] + 1);
		for (int i = 0; i < n; i++)
			for (int c = 0; c < 3; c++)
				out[3 * (from + i) + c] = (uint8_t)((sum[6 * i + c] + sum[6 * i + c + 3]) >> 2);
	}
}

static void shrink_any(const uint8_t *in, ptrdiff_t stride, int factor, uint8_t *out, int count)
{
	int area = factor * factor;
	for (int i = 0; i < count; i++, in += 3 * factor, out += 3)
		for (int c = 0; c < 3; c++) {
			int sum = area / 2;
			for (int y = 0; y < factor; y++)
				for (int x = 0; x < factor; x++)
					sum += in[y * stride + 3 * x + c];
			out[c] = (uint8_t)(sum / area);
		}
}

static void copy_small(struct scan *scan, const struct image *frame, int x0, int y0, int x1, int y1)
{
	for (int y = y0; y < y1; y++) {
		const uint8_t *in = frame->data + (scan->y0 + y * scan->factor) * frame->stride +
				    3 * (scan->x0 + x0 * scan->factor);
		uint8_t *out = scan->bgr + 3 * (y * scan->width + x0);
		if (scan->factor == 2)
			shrink_two(in, in + frame->stride, out, x1 - x0);
		else
			shrink_any(in, frame->stride, scan->factor, out, x1 - x0);
	}
}

/* ---- cloth
 * ----------------------------------------------------------------------------------------------------------- */

/* The fullest bin of a coarse histogram: the cloth is most of what is seen. */
static bool cloth_mode(const struct scan *scan, float mode[3])
{
	uint32_t count[4096] = {0}, best = 0, total = 0;
	int at = 0;
	for (int y = 0; y < scan->height; y += 2)
		for (int x = scan->row_from[y]; x < scan->row_to[y]; x += 3) {
			const uint8_t *p = scan->bgr + 3 * (y * scan->width + x);
			int bin = (p[0] >> 4) << 8 | (p[1] >> 4) << 4 | p[2] >> 4;
			total++;
			if (++count[bin] > best) {
				best = count[bin];
				at = bin;
			}
		}
	mode[0] = (float)(at >> 8) * 16 + 8;
	mode[1] = (float)((at >> 4) & 15) * 16 + 8;
	mode[2] = (float)(at & 15) * 16 + 8;
	/* Black or blown out is no cloth. */
	return total > 0 && mode[0] + mode[1] + mode[2] > 60 && mode[0] + mode[1] + mode[2] < 735;
}

/* Along and across the cloth's direction: shade = how bright, returned: how far off, squared, relative to the pixel. */
static inline float off_cloth(const float p[3], const float c[3], float *shade)
{
	float pc = p[0] * c[0] + p[1] * c[1] + p[2] * c[2], cc = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
	float pp = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
	*shade = pc / cc;
	float across = pp - pc * pc / cc;
	return (across > 0 ? across : 0) / (pp + 1);
}

static bool is_cloth(const uint8_t *p, const float cloth[3], float chroma2)
{
	float shade, v[3] = {p[0], p[1], p[2]};
	return off_cloth(v, cloth, &shade) < chroma2 && shade > CLOTH_SHADE_MIN && shade < CLOTH_SHADE_MAX;
}

/* Mean of what is within reach of the mode, twice: the mode's bin is coarse and the light uneven. */
static bool cloth_mean(struct scan *scan)
{
	if (!cloth_mode(scan, scan->cloth))
		return false;
	for (int round = 0; round < 2; round++) {
		float chroma = round == 0 ? 2 * CLOTH_CHROMA : CLOTH_CHROMA;
		double sum[3] = {0}, n = 0;
		for (int y = 0; y < scan->height; y += 3)
			for (int x = scan->row_from[y]; x < scan->row_to[y]; x += 3) {
				const uint8_t *p = scan->bgr + 3 * (y * scan->width + x);
				if (!is_cloth(p, scan->cloth, chroma * chroma))
					continue;
				for (int c = 0; c < 3; c++)
					sum[c] += p[c];
				n++;
			}
		if (n < 50)
			return false;
		for (int c = 0; c < 3; c++)
			scan->cloth[c] = (float)(sum[c] / n);
	}
	return true;
}

/* Mean colour of a cell's cloth around its median brightness: rings, shadows and ball edges fall out. */
static void cell_colour(struct scan *scan, int cx, int cy)
{
	int hist[64] = {0}, n = 0, x1 = (cx + 1) * SCAN_CELL, y1 = (cy + 1) * SCAN_CELL;
	x1 = x1 < scan->width ? x1 : scan->width;
	y1 = y1 < scan->height ? y1 : scan->height;
	uint8_t luma[SCAN_CELL * SCAN_CELL];
	const uint8_t *pixel[SCAN_CELL * SCAN_CELL];
	for (int y = cy * SCAN_CELL; y < y1; y += CELL_STEP)
		for (int x = cx * SCAN_CELL; x < x1; x += CELL_STEP) {
			const uint8_t *p = scan->bgr + 3 * (y * scan->width + x);
			if (x < scan->row_from[y] || x >= scan->row_to[y] ||
			    !is_cloth(p, scan->cloth, 1.5f * 1.5f * CLOTH_CHROMA * CLOTH_CHROMA))
				continue;
			luma[n] = (uint8_t)((p[0] + p[1] + p[2]) / 12);
			hist[luma[n]]++;
			pixel[n++] = p;
		}
	int median = 0;
	for (int sum = hist[0]; 2 * sum < n && median < 63; sum += hist[++median])
		;
	float total[3] = {0}, kept = 0;
	for (int i = 0; i < n; i++) {
		if (abs(luma[i] - median) > 3)
			continue;
		for (int c = 0; c < 3; c++)
			total[c] += pixel[i][c];
		kept++;
	}
	int at = cy * scan->cells_x + cx;
	bool believed = kept > CELL_MIN_SHARE * SCAN_CELL * SCAN_CELL / (CELL_STEP * CELL_STEP);
	scan->cell_weight[at] = believed ? kept : 0;
	for (int c = 0; c < 3; c++)
		scan->cell[3 * at + c] = believed ? total[c] / kept : 0;
}

/* Mean of the neighbours that are known; 0 when none is. */
static float from_neighbours(const struct scan *scan, int cx, int cy, float out[3])
{
	float weight = 0;
	out[0] = out[1] = out[2] = 0;
	for (int y = cy - 1; y <= cy + 1; y++)
		for (int x = cx - 1; x <= cx + 1; x++) {
			if (x < 0 || y < 0 || x >= scan->cells_x || y >= scan->cells_y)
				continue;
			int at = y * scan->cells_x + x;
			float w = scan->cell_weight[at] > 0;
			weight += w;
			for (int c = 0; c < 3; c++)
				out[c] += w * scan->cell[3 * at + c];
		}
	for (int c = 0; c < 3 && weight > 0; c++)
		out[c] /= weight;
	return weight;
}

/* Cells under balls and arms take their neighbours' colour, ring by ring. */
static void fill_cells(struct scan *scan)
{
	int cells = scan->cells_x * scan->cells_y;
	float *fresh = scan->cell_weight + cells;
	for (int round = 0; round < scan->cells_x + scan->cells_y; round++) {
		int missing = 0;
		memset(fresh, 0, sizeof(*fresh) * (size_t)cells);
		for (int cy = 0; cy < scan->cells_y; cy++)
			for (int cx = 0; cx < scan->cells_x; cx++) {
				int at = cy * scan->cells_x + cx;
				float mean[3];
				if (scan->cell_weight[at] > 0)
					continue;
				missing++;
				if (from_neighbours(scan, cx, cy, mean) < 2)
					continue;
				memcpy(scan->cell + 3 * at, mean, sizeof(mean));
				fresh[at] = 1;
			}
		for (int i = 0; i < cells; i++)
			scan->cell_weight[i] += fresh[i];
		if (missing == 0)
			return;
	}
	for (int i = 0; i < cells; i++)
		if (scan->cell_weight[i] <= 0)
			memcpy(scan->cell + 3 * i, scan->cloth, sizeof(scan->cloth));
}

static void learn_cells(struct scan *scan)
{
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++)
			cell_colour(scan, cx, cy);
	fill_cells(scan);
}

/* ---- marks
 * ----------------------------------------------------------------------------------------------------------- */

/* Cell coordinate and share of a small pixel: cells hold the colour of their middles. */
static inline int cell_of(float at, int cells, float *share)
{
	float v = (at + 0.5f) / SCAN_CELL - 0.5f;
	int i = (int)floorf(v);
	i = clamp_int(i, 0, cells > 1 ? cells - 2 : 0);
	float f = v - (float)i;
	*share = f < 0 ? 0 : f > 1 ? 1 : f;
	return i;
}

static void cell_at(const struct scan *scan, float x, float y, float out[3])
{
	float fx, fy;
	int i = cell_of(x, scan->cells_x, &fx), j = cell_of(y, scan->cells_y, &fy);
	const float *a = scan->cell + 3 * (j * scan->cells_x + i);
	const float *b = scan->cells_y > 1 ? a + 3 * scan->cells_x : a;
	int right = scan->cells_x > 1 ? 3 : 0;
	for (int c = 0; c < 3; c++) {
		float top = a[c] + fx * (a[right + c] - a[c]), bottom = b[c] + fx * (b[right + c] - b[c]);
		out[c] = top + fy * (bottom - top);
	}
}

void scan_cloth_at(const struct scan *scan, vec2 px, float out[3])
{
	vec2 small = scan_from_full(scan, px);
	cell_at(scan, (float)small.x, (float)small.y, out);
}

/* How far from cloth a pixel is, in three steps. Off the cloth's direction counts whatever the brightness; dark only
 * where no shadow reaches; bright (a white ball has little colour of its own) only beyond the projector's light. */
static const float OFF_SURE = 0.16f * 0.16f, OFF_HALF = 0.113f * 0.113f; /* squared, of the pixel's own length */
static const float OFF_FLOOR = 0.04f; /* of the cloth's length, squared: noise of dark pixels */
static const float DARK_SURE = 0.28f * 0.28f, DARK_HALF = 0.334f * 0.334f, LIGHT_SURE = 1.6f * 1.6f,
		   LIGHT_HALF = 1.458f * 1.458f;

static const float WHITE_LEVEL = 250, CLOTH_LEVEL = 220;
enum { BUSY_PIXELS = 6 }; /* half marked ones that make a cell worth a look */
enum { RUN = 8 };	  /* pixels that share a cloth colour */

/* Straight loops over arrays: the compiler makes vectors of them. */
static void mark_run(const uint8_t *restrict p, const float cloth[3], uint8_t *restrict mark)
{
	float b[RUN], g[RUN], r[RUN];
	float cc = cloth[0] * cloth[0] + cloth[1] * cloth[1] + cloth[2] * cloth[2], inverse = 1 / cc;
	for (int i = 0; i < RUN; i++) {
		b[i] = p[3 * i];
		g[i] = p[3 * i + 1];
		r[i] = p[3 * i + 2];
	}
	int level[RUN], cloth_is_dimmer = cloth[0] < CLOTH_LEVEL || cloth[1] < CLOTH_LEVEL || cloth[2] < CLOTH_LEVEL;
	for (int i = 0; i < RUN; i++) {
		float pc = b[i] * cloth[0] + g[i] * cloth[1] + r[i] * cloth[2];
		float pp = b[i] * b[i] + g[i] * g[i] + r[i] * r[i];
		float along = pc * pc * inverse, off = pp - along, unit = pp + OFF_FLOOR * cc;
		/* Blown out, where cloth is not: white, whatever the exposure. */
		float least = b[i] < g[i] ? b[i] : g[i];
		least = least < r[i] ? least : r[i];
		int white = (least >= WHITE_LEVEL) & cloth_is_dimmer;
		int sure = white | (off > OFF_SURE * unit) | (along < DARK_SURE * cc) | (along > LIGHT_SURE * cc);
		int half = white | (off > OFF_HALF * unit) | (along < DARK_HALF * cc) | (along > LIGHT_HALF * cc);
		level[i] = sure * 191 + half * 64;
	}
	for (int i = 0; i < RUN; i++)
		mark[i] = (uint8_t)level[i];
}

/* One row, in runs; the last one is filled up. */
static void mark_row(struct scan *scan, int y, int x0, int x1)
{
	uint8_t *mark = scan->mark + y * scan->width;
	const uint8_t *bgr = scan->bgr + 3 * (ptrdiff_t)y * scan->width;
	int from = clamp_int(scan->row_from[y], x0, x1), to = clamp_int(scan->row_to[y], from, x1);
	memset(mark + x0, 0, (size_t)(from - x0));
	memset(mark + to, 0, (size_t)(x1 - to));
	for (int x = from; x < to; x += RUN) {
		float cloth[3];
		cell_at(scan, (float)x + RUN / 2.0f, (float)y, cloth);
		if (x + RUN <= to) {
			mark_run(bgr + 3 * x, cloth, mark + x);
			continue;
		}
		uint8_t pixel[3 * RUN] = {0}, last[RUN];
		memcpy(pixel, bgr + 3 * x, 3 * (size_t)(to - x));
		mark_run(pixel, cloth, last);
		memcpy(mark + x, last, (size_t)(to - x));
	}
}

/* Corners of a cell, small pixels; x1 and y1 are beyond it. */
struct box {
	int x0, y0, x1, y1;
};

static struct box cell_box(const struct scan *scan, int cx, int cy)
{
	struct box b = {cx * SCAN_CELL, cy * SCAN_CELL, (cx + 1) * SCAN_CELL, (cy + 1) * SCAN_CELL};
	b.x1 = b.x1 < scan->width ? b.x1 : scan->width;
	b.y1 = b.y1 < scan->height ? b.y1 : scan->height;
	return b;
}

static void count_foreign(struct scan *scan, int cx, int cy)
{
	struct box b = cell_box(scan, cx, cy);
	int foreign = 0, half = 0;
	for (int y = b.y0; y < b.y1; y++)
		for (int x = b.x0; x < b.x1; x++) {
			foreign += scan->mark[y * scan->width + x] >> 7;
			half += (scan->mark[y * scan->width + x] >> 6) != 0;
		}
	scan->foreign[cy * scan->cells_x + cx] = (uint16_t)foreign;
	scan->half[cy * scan->cells_x + cx] = (uint16_t)half;
}

static void dilate(struct scan *scan, const uint8_t *core)
{
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++) {
			int any = 0;
			for (int y = cy > 0 ? cy - 1 : 0; y <= cy + 1 && y < scan->cells_y; y++)
				for (int x = cx > 0 ? cx - 1 : 0; x <= cx + 1 && x < scan->cells_x; x++)
					any |= core[y * scan->cells_x + x];
			scan->changed[cy * scan->cells_x + cx] = (uint8_t)any;
		}
}

bool scan_frame(struct scan *scan, const struct image *frame)
{
	copy_small(scan, frame, 0, 0, scan->width, scan->height);
	if (!cloth_mean(scan))
		return false;
	learn_cells(scan);
	for (int y = 0; y < scan->height; y++)
		mark_row(scan, y, 0, scan->width);
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++)
			count_foreign(scan, cx, cy);
	uint8_t *core = scan->changed + scan->cells_x * scan->cells_y;
	for (int i = 0; i < scan->cells_x * scan->cells_y; i++)
		core[i] = scan->half[i] >= BUSY_PIXELS;
	dilate(scan, core);
	memcpy(scan->reference, scan->bgr, 3 * (size_t)scan->width * (size_t)scan->height);
	return true;
}

/* ---- changes
 * --------------------------------------------------------------------------------------------------------- */

static const double CHANGE_FACTOR = 1.8, CHANGE_FLOOR = 12; /* against the usual difference; 1/16 level */

static int row_difference(const uint8_t *restrict a, const uint8_t *restrict b, int count)
{
	int sum = 0;
	if (count == 3 * SCAN_CELL) {
		for (int i = 0; i < 3 * SCAN_CELL; i++)
			sum += abs(a[i] - b[i]);
		return sum;
	}
	for (int i = 0; i < count; i++)
		sum += abs(a[i] - b[i]);
	return sum;
}

static uint16_t cell_difference(const struct scan *scan, int cx, int cy)
{
	struct box b = cell_box(scan, cx, cy);
	int sum = 0, count = 3 * (b.x1 - b.x0);
	for (int y = b.y0; y < b.y1; y++) {
		ptrdiff_t at = 3 * ((ptrdiff_t)y * scan->width + b.x0);
		sum += row_difference(scan->bgr + at, scan->reference + at, count);
	}
	int mean = 16 * sum / (count * (b.y1 - b.y0));
	return (uint16_t)(mean < 4095 ? mean : 4095);
}

/* The usual difference is noise: the median of all cells. */
static int usual_difference(const struct scan *scan)
{
	static const int bins = 512;
	int hist[512] = {0}, cells = scan->cells_x * scan->cells_y, sum = 0, at = 0;
	for (int i = 0; i < cells; i++)
		hist[scan->difference[i] < bins ? scan->difference[i] : bins - 1]++;
	for (sum = hist[0]; 2 * sum < cells && at < bins - 1;)
		sum += hist[++at];
	return at;
}

int scan_changes(struct scan *scan, const struct image *frame)
{
	int cells = scan->cells_x * scan->cells_y, count = 0;
	uint8_t *core = scan->changed + cells;
	copy_small(scan, frame, 0, 0, scan->width, scan->height);
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++)
			scan->difference[cy * scan->cells_x + cx] = cell_difference(scan, cx, cy);
	double limit = CHANGE_FACTOR * usual_difference(scan) + CHANGE_FLOOR;
	for (int i = 0; i < cells; i++)
		core[i] = scan->difference[i] > limit;
	dilate(scan, core);
	for (int i = 0; i < cells; i++)
		count += scan->changed[i];
	return count;
}

void scan_update(struct scan *scan)
{
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++) {
			if (!scan->changed[cy * scan->cells_x + cx])
				continue;
			struct box b = cell_box(scan, cx, cy);
			for (int y = b.y0; y < b.y1; y++) {
				ptrdiff_t at = 3 * ((ptrdiff_t)y * scan->width + b.x0);
				memcpy(scan->reference + at, scan->bgr + at, 3 * (size_t)(b.x1 - b.x0));
				mark_row(scan, y, b.x0, b.x1);
			}
			count_foreign(scan, cx, cy);
		}
}

void scan_relearn(struct scan *scan, int cell_row)
{
	assert(cell_row >= 0 && cell_row < scan->cells_y);
	for (int cx = 0; cx < scan->cells_x; cx++) {
		int at = cell_row * scan->cells_x + cx;
		float before[3], weight = scan->cell_weight[at];
		memcpy(before, scan->cell + 3 * at, sizeof(before));
		cell_colour(scan, cx, cell_row);
		if (scan->cell_weight[at] > 0)
			continue;
		/* Covered just now: what was known still holds. */
		memcpy(scan->cell + 3 * at, before, sizeof(before));
		scan->cell_weight[at] = weight;
	}
}
