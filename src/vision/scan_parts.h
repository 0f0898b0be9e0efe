/* What the files of the scan share among themselves; nobody else includes it. */
#ifndef BILLIARD_VISION_SCAN_PARTS_H
#define BILLIARD_VISION_SCAN_PARTS_H

#include <math.h>

#include "vision/scan.h"

static inline int clamp_int(int v, int low, int high)
{
	return v < low ? low : v > high ? high : v;
}

/* Corners of a cell, small pixels; x1 and y1 are beyond it. */
struct scan_box {
	int x0, y0, x1, y1;
};

static inline struct scan_box scan_cell_box(const struct scan *scan, int cx, int cy)
{
	struct scan_box b = {cx * SCAN_CELL, cy * SCAN_CELL, (cx + 1) * SCAN_CELL, (cy + 1) * SCAN_CELL};
	b.x1 = b.x1 < scan->width ? b.x1 : scan->width;
	b.y1 = b.y1 < scan->height ? b.y1 : scan->height;
	return b;
}

/* Cell coordinate and share of a small pixel: cells hold the colour of their middles. */
static inline int scan_cell_of(float at, int cells, float *share)
{
	float v = (at + 0.5f) / SCAN_CELL - 0.5f;
	int i = (int)floorf(v);
	i = clamp_int(i, 0, cells > 1 ? cells - 2 : 0);
	float f = v - (float)i;
	*share = f < 0 ? 0 : f > 1 ? 1 : f;
	return i;
}

static inline void scan_cell_at(const struct scan *scan, float x, float y, float out[3])
{
	float fx, fy;
	int i = scan_cell_of(x, scan->cells_x, &fx), j = scan_cell_of(y, scan->cells_y, &fy);
	const float *a = scan->cell + 3 * (j * scan->cells_x + i);
	const float *b = scan->cells_y > 1 ? a + 3 * scan->cells_x : a;
	int right = scan->cells_x > 1 ? 3 : 0;
	for (int c = 0; c < 3; c++) {
		float top = a[c] + fx * (a[right + c] - a[c]), bottom = b[c] + fx * (b[right + c] - b[c]);
		out[c] = top + fy * (bottom - top);
	}
}

/* scan_copy.c: the frame's bed into scan->bgr, smaller. */
void scan_copy(struct scan *scan, const struct image *frame);
/* scan_cloth.c: the cloth's colour, of the whole bed and of every cell. False when there is none. */
bool scan_learn(struct scan *scan);
/* scan_marks.c: how little the small pixels [x0, x1) of a row look like cloth; then how many of a cell's do. */
void scan_mark_row(struct scan *scan, int y, int x0, int x1);
void scan_count(struct scan *scan, int cx, int cy);
/* scan_changes.c: the cells of the core (behind scan->changed) and those around them into scan->changed. */
void scan_dilate(struct scan *scan);

#endif
