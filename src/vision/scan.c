#include "vision/scan.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "vision/scan_parts.h"

enum { BUSY_PIXELS = 6 }; /* half marked ones that make a cell worth a look */

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

bool scan_frame(struct scan *scan, const struct image *frame)
{
	scan_copy(scan, frame);
	return scan_again(scan);
}

bool scan_again(struct scan *scan)
{
	if (!scan_learn(scan))
		return false;
	for (int y = 0; y < scan->height; y++)
		scan_mark_row(scan, y, 0, scan->width);
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++)
			scan_count(scan, cx, cy);
	uint8_t *core = scan->changed + scan->cells_x * scan->cells_y;
	for (int i = 0; i < scan->cells_x * scan->cells_y; i++)
		core[i] = scan->half[i] >= BUSY_PIXELS;
	scan_dilate(scan);
	memcpy(scan->reference, scan->bgr, 3 * (size_t)scan->width * (size_t)scan->height);
	return true;
}
