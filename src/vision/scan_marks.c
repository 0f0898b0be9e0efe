/* How little each small pixel looks like cloth. */
#include "vision/scan_parts.h"

#include <string.h>

/* How far from cloth a pixel is, in three steps. Off the cloth's direction counts whatever the brightness; dark only
 * where no shadow reaches; bright (a white ball has little colour of its own) only beyond the projector's light. */
static const float OFF_SURE = 0.16f * 0.16f, OFF_HALF = 0.113f * 0.113f; /* squared, of the pixel's own length */
static const float OFF_FLOOR = 0.04f; /* of the cloth's length, squared: noise of dark pixels */
static const float DARK_SURE = 0.28f * 0.28f, DARK_HALF = 0.334f * 0.334f, LIGHT_SURE = 1.6f * 1.6f,
		   LIGHT_HALF = 1.458f * 1.458f;

static const float WHITE_LEVEL = 250, CLOTH_LEVEL = 220;
enum { RUN = 8 }; /* pixels that share a cloth colour */

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
void scan_mark_row(struct scan *scan, int y, int x0, int x1)
{
	uint8_t *mark = scan->mark + y * scan->width;
	const uint8_t *bgr = scan->bgr + 3 * (ptrdiff_t)y * scan->width;
	int from = clamp_int(scan->row_from[y], x0, x1), to = clamp_int(scan->row_to[y], from, x1);
	memset(mark + x0, 0, (size_t)(from - x0));
	memset(mark + to, 0, (size_t)(x1 - to));
	for (int x = from; x < to; x += RUN) {
		float cloth[3];
		scan_cell_at(scan, (float)x + RUN / 2.0f, (float)y, cloth);
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

void scan_count(struct scan *scan, int cx, int cy)
{
	struct scan_box b = scan_cell_box(scan, cx, cy);
	int foreign = 0, half = 0;
	for (int y = b.y0; y < b.y1; y++)
		for (int x = b.x0; x < b.x1; x++) {
			foreign += scan->mark[y * scan->width + x] >> 7;
			half += (scan->mark[y * scan->width + x] >> 6) != 0;
		}
	scan->foreign[cy * scan->cells_x + cx] = (uint16_t)foreign;
	scan->half[cy * scan->cells_x + cx] = (uint16_t)half;
}
