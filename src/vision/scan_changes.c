/* What has changed since the marks were made. */
#include "vision/scan_parts.h"

#include <stdlib.h>
#include <string.h>

static const double CHANGE_FACTOR = 1.8, CHANGE_FLOOR = 12; /* against the usual difference; 1/16 level */

void scan_dilate(struct scan *scan)
{
	const uint8_t *core = scan->changed + scan->cells_x * scan->cells_y;
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++) {
			int any = 0;
			for (int y = cy > 0 ? cy - 1 : 0; y <= cy + 1 && y < scan->cells_y; y++)
				for (int x = cx > 0 ? cx - 1 : 0; x <= cx + 1 && x < scan->cells_x; x++)
					any |= core[y * scan->cells_x + x];
			scan->changed[cy * scan->cells_x + cx] = (uint8_t)any;
		}
}

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
	struct scan_box b = scan_cell_box(scan, cx, cy);
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
	scan_copy(scan, frame);
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++)
			scan->difference[cy * scan->cells_x + cx] = cell_difference(scan, cx, cy);
	scan->usual = usual_difference(scan);
	double limit = CHANGE_FACTOR * scan->usual + CHANGE_FLOOR;
	for (int i = 0; i < cells; i++)
		core[i] = scan->difference[i] > limit;
	scan_dilate(scan);
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
			struct scan_box b = scan_cell_box(scan, cx, cy);
			for (int y = b.y0; y < b.y1; y++) {
				ptrdiff_t at = 3 * ((ptrdiff_t)y * scan->width + b.x0);
				memcpy(scan->reference + at, scan->bgr + at, 3 * (size_t)(b.x1 - b.x0));
				scan_mark_row(scan, y, b.x0, b.x1);
			}
			scan_count(scan, cx, cy);
		}
}
