#include "vision/region.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { STRIDE = 2, FREE = 0, TAKEN = 1 };

int region_init(struct region *region, int width, int height)
{
	size_t n = ((size_t)width / STRIDE + 1) * ((size_t)height / STRIDE + 1);
	*region = (struct region){.capacity = (int)n};
	region->state = malloc(n);
	region->queue = malloc(n * sizeof(*region->queue));
	if (region->state && region->queue)
		return 0;
	region_finish(region);
	return -ENOMEM;
}

void region_finish(struct region *region)
{
	free(region->state);
	free(region->queue);
	*region = (struct region){0};
}

/* Coarse pixels of one look. */
struct grid {
	struct region *region;
	const struct scan *scan;
	int width, height;
};

static bool is_foreign(const struct grid *g, int x, int y)
{
	return g->scan->mark[STRIDE * y * g->scan->width + STRIDE * x] >= SCAN_FOREIGN / 2;
}

/* Visits the coarse pixels of a disc that are still free: puts the foreign ones into the queue (NULL: none) and takes
 * all. */
static int take_disc(const struct grid *g, const struct region_disc *disc, int *queue)
{
	const struct scan *s = g->scan;
	vec2 mid = scan_from_full(s, disc->px);
	double r = disc->radius / s->factor / STRIDE, cx = mid.x / STRIDE, cy = mid.y / STRIDE;
	int count = 0, y1 = (int)(cy + r), x1 = (int)(cx + r);
	for (int y = cy > r ? (int)(cy - r) : 0; y <= y1 && y < g->height; y++)
		for (int x = cx > r ? (int)(cx - r) : 0; x <= x1 && x < g->width; x++) {
			uint8_t *state = &g->region->state[y * g->width + x];
			if (*state != FREE || (x - cx) * (x - cx) + (y - cy) * (y - cy) > r * r)
				continue;
			*state = TAKEN;
			if (queue && is_foreign(g, x, y))
				queue[count++] = y * g->width + x;
		}
	return count;
}

/* The four neighbours of a coarse pixel that are foreign and free go into the queue; how many. */
static int spread(const struct grid *g, int at, int *queue)
{
	static const int dx[] = {-1, 1, 0, 0}, dy[] = {0, 0, -1, 1};
	int count = 0, x = at % g->width, y = at / g->width;
	for (int i = 0; i < 4; i++) {
		int nx = x + dx[i], ny = y + dy[i];
		if (nx < 0 || ny < 0 || nx >= g->width || ny >= g->height)
			continue;
		uint8_t *state = &g->region->state[ny * g->width + nx];
		if (*state == TAKEN || !is_foreign(g, nx, ny))
			continue;
		*state = TAKEN;
		queue[count++] = ny * g->width + nx;
	}
	return count;
}

int region_beyond(struct region *region, const struct scan *scan, const struct region_disc *disc, int count, int limit)
{
	struct grid g = {region, scan, scan->width / STRIDE, scan->height / STRIDE};
	int beyond = 0;
	memset(region->state, FREE, (size_t)g.width * (size_t)g.height);
	for (int i = 1; i < count; i++)
		take_disc(&g, &disc[i], NULL);
	int tail = take_disc(&g, &disc[0], region->queue);
	for (int head = 0; head < tail && beyond < limit; head++) {
		int more = spread(&g, region->queue[head], region->queue + tail);
		tail += more;
		beyond += more * STRIDE * STRIDE;
	}
	return beyond;
}
