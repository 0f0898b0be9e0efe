/* The cloth: its colour over the whole bed, and cell by cell. */
#include "vision/scan_parts.h"

#include <stdlib.h>
#include <string.h>

static const float CLOTH_CHROMA = 0.11f; /* off the cloth's direction, relative to its length: still cloth */
static const float CLOTH_SHADE_MIN = 0.5f, CLOTH_SHADE_MAX = 1.4f;
enum { CELL_STEP = 2 };			   /* of a cell, every second pixel of every second row tells enough */
static const float CELL_MIN_SHARE = 0.15f; /* of a cell's pixels that must be cloth before it is believed */

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

bool scan_learn(struct scan *scan)
{
	if (!cloth_mean(scan))
		return false;
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++)
			cell_colour(scan, cx, cy);
	fill_cells(scan);
	return true;
}

void scan_cloth_at(const struct scan *scan, vec2 px, float out[3])
{
	vec2 small = scan_from_full(scan, px);
	scan_cell_at(scan, (float)small.x, (float)small.y, out);
}

void scan_relearn(struct scan *scan)
{
	int row = scan->relearn_row < scan->cells_y ? scan->relearn_row : 0;
	scan->relearn_row = row + 1;
	for (int cx = 0; cx < scan->cells_x; cx++) {
		int at = row * scan->cells_x + cx;
		float before[3], weight = scan->cell_weight[at];
		memcpy(before, scan->cell + 3 * at, sizeof(before));
		cell_colour(scan, cx, row);
		if (scan->cell_weight[at] > 0)
			continue;
		/* Covered just now: what was known still holds. */
		memcpy(scan->cell + 3 * at, before, sizeof(before));
		scan->cell_weight[at] = weight;
	}
}
