#include "vision/seeds.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vision/outline.h"

enum { KNOTS_X = 9, KNOTS_Y = 5 };
static const int EDGE_MIN2 = 14 * 14;  /* squared difference over two small pixels, levels */
static const double VOTE_SHARE = 0.20; /* of the outline's length that must have voted */
static const double COVER_MIN = 0.5;   /* of the inside that must not be cloth */
static const double APART = 0.8;       /* seeds closer than this many radii are one */

int seeds_init(struct seeds *seeds, int width, int height)
{
	size_t n = (size_t)width * (size_t)height, cells = n / (SCAN_CELL * SCAN_CELL) + (size_t)(width + height) + 4;
	*seeds = (struct seeds){.capacity = width * height};
	seeds->vote = calloc(n, sizeof(*seeds->vote));
	seeds->sum = calloc(n, sizeof(*seeds->sum));
	seeds->shape = calloc(cells, sizeof(*seeds->shape));
	if (seeds->vote && seeds->sum && seeds->shape)
		return 0;
	seeds_finish(seeds);
	return -ENOMEM;
}

void seeds_finish(struct seeds *seeds)
{
	free(seeds->vote);
	free(seeds->sum);
	free(seeds->shape);
	*seeds = (struct seeds){0};
}

/* Second moments of the outline's points: for an ellipse they are half its matrix. */
/* at: px of the scan. */
static bool shape_at(const struct scan *scan, const struct camera *camera, const struct table *table, vec2 at,
		     struct seed_shape *out)
{
	vec2 pos;
	struct outline o;
	double r = table->ball_radius;
	if (!camera_unproject(camera, scan_to_full(scan, at.x, at.y), r, &pos) ||
	    !outline_of_ball(camera, pos, r, 1, &o))
		return false;
	vec2 middle = {0, 0};
	for (int i = 0; i < OUTLINE_POINTS; i++)
		middle = vec2_madd(middle, 1.0 / OUTLINE_POINTS, o.point[i]);
	double xx = 0, xy = 0, yy = 0, k = 2.0 / OUTLINE_POINTS / (scan->factor * scan->factor);
	for (int i = 0; i < OUTLINE_POINTS; i++) {
		vec2 d = vec2_sub(o.point[i], middle);
		xx += k * d.x * d.x;
		xy += k * d.x * d.y;
		yy += k * d.y * d.y;
	}
	*out = (struct seed_shape){(float)xx, (float)xy, (float)yy};
	return true;
}

static float mix(float a, float b, float share)
{
	return a + share * (b - a);
}

static struct seed_shape mix_shapes(struct seed_shape a, struct seed_shape b, float share)
{
	return (struct seed_shape){mix(a.xx, b.xx, share), mix(a.xy, b.xy, share), mix(a.yy, b.yy, share)};
}

/* Shapes change slowly: a coarse grid over the picture, cells in between. */
bool seeds_place(struct seeds *seeds, const struct scan *scan, const struct camera *camera, const struct table *table)
{
	struct seed_shape knot[KNOTS_Y][KNOTS_X];
	for (int j = 0; j < KNOTS_Y; j++)
		for (int i = 0; i < KNOTS_X; i++) {
			vec2 at = {(double)i * scan->width / (KNOTS_X - 1), (double)j * scan->height / (KNOTS_Y - 1)};
			if (!shape_at(scan, camera, table, at, &knot[j][i]))
				return false;
		}
	for (int cy = 0; cy < scan->cells_y; cy++)
		for (int cx = 0; cx < scan->cells_x; cx++) {
			float x = ((float)cx + 0.5f) / (float)scan->cells_x * (KNOTS_X - 1);
			float y = ((float)cy + 0.5f) / (float)scan->cells_y * (KNOTS_Y - 1);
			int i = (int)x, j = (int)y;
			struct seed_shape top = mix_shapes(knot[j][i], knot[j][i + 1], x - (float)i);
			struct seed_shape bottom = mix_shapes(knot[j + 1][i], knot[j + 1][i + 1], x - (float)i);
			seeds->shape[cy * scan->cells_x + cx] = mix_shapes(top, bottom, y - (float)j);
		}
	return true;
}

/* Difference across two small pixels in the channel where it is largest. */
static inline int edge_at(const uint8_t *p, ptrdiff_t row, int *gx, int *gy)
{
	int best = 0;
	for (int c = 0; c < 3; c++) {
		int x = p[3 + c] - p[-3 + c], y = p[row + c] - p[-row + c];
		int g = x * x + y * y;
		if (g > best) {
			best = g;
			*gx = x;
			*gy = y;
		}
	}
	return best;
}

static void vote(struct seeds *seeds, const struct scan *scan, float x, float y)
{
	int ix = (int)(x + 0.5f), iy = (int)(y + 0.5f);
	if (ix >= 1 && iy >= 1 && ix < scan->width - 1 && iy < scan->height - 1)
		seeds->vote[iy * scan->width + ix]++;
}

/* The rim itself is half cloth, and under a dark ball half shadow: its neighbours decide. */
static inline bool near_foreign(const uint8_t *mark, ptrdiff_t row)
{
	const int bar = SCAN_FOREIGN / 2;
	return mark[0] >= bar || mark[-1] >= bar || mark[1] >= bar || mark[-row] >= bar || mark[row] >= bar;
}

/* An edge lies on the outline of a ball one ellipse point inwards or outwards: which of them, colours do not say. */
static void vote_row(struct seeds *seeds, const struct scan *scan, int y, int x0, int x1)
{
	ptrdiff_t row = 3 * (ptrdiff_t)scan->width;
	const struct seed_shape *shapes = seeds->shape + y / SCAN_CELL * scan->cells_x;
	for (int x = x0; x < x1; x++) {
		int gx = 0, gy = 0;
		if (!near_foreign(scan->mark + y * scan->width + x, scan->width) ||
		    edge_at(scan->bgr + y * row + 3 * x, row, &gx, &gy) < EDGE_MIN2)
			continue;
		struct seed_shape s = shapes[x / SCAN_CELL];
		float ex = s.xx * (float)gx + s.xy * (float)gy, ey = s.xy * (float)gx + s.yy * (float)gy;
		float k = 1 / sqrtf((float)gx * ex + (float)gy * ey);
		vote(seeds, scan, (float)x + k * ex, (float)y + k * ey);
		vote(seeds, scan, (float)x - k * ex, (float)y - k * ey);
	}
}

/* Box of 3 x 3: votes miss by a pixel. */
static void smooth_row(struct seeds *seeds, const struct scan *scan, int y, int x0, int x1)
{
	int width = scan->width;
	const uint16_t *a = seeds->vote + (y - 1) * width, *b = a + width, *c = b + width;
	uint16_t *out = seeds->sum + y * width;
	for (int x = x0; x < x1; x++)
		out[x] = (uint16_t)(a[x - 1] + a[x] + a[x + 1] + b[x - 1] + b[x] + b[x + 1] + c[x - 1] + c[x] +
				    c[x + 1]);
}

/* Share of marked pixels within 0.75 of the ellipse. */
static double cover_at(const struct scan *scan, struct seed_shape s, double x, double y)
{
	double xx = s.xx, xy = s.xy, yy = s.yy, det = xx * yy - xy * xy, reach = 0.75 * 0.75;
	int r = (int)sqrt(0.6 * fmax(xx, yy)) + 1, in = 0, marked = 0;
	for (int dy = -r; dy <= r; dy += 2)
		for (int dx = -r; dx <= r; dx += 2) {
			double q = (yy * dx * dx - 2 * xy * dx * dy + xx * dy * dy) / det;
			int px = (int)x + dx, py = (int)y + dy;
			if (q > reach)
				continue;
			in++;
			if (px >= 0 && py >= 0 && px < scan->width && py < scan->height)
				marked += scan->mark[py * scan->width + px] >= SCAN_FOREIGN / 2;
		}
	return (double)marked / in;
}

static bool is_peak(const struct seeds *seeds, int width, int x, int y)
{
	const uint16_t *at = seeds->sum + y * width + x;
	for (int dy = -2; dy <= 2; dy++)
		for (int dx = -2; dx <= 2; dx++) {
			uint16_t other = at[dy * width + dx];
			bool before = dy < 0 || (dy == 0 && dx < 0);
			if (other > *at || (before && other == *at))
				return false;
		}
	return true;
}

/* Middle of the votes around a peak: half a small pixel better than the peak itself. */
static vec2 peak_centre(const struct seeds *seeds, const struct scan *scan, int x, int y)
{
	double sx = 0, sy = 0, s = 0;
	for (int dy = -2; dy <= 2; dy++)
		for (int dx = -2; dx <= 2; dx++) {
			double v = seeds->vote[(y + dy) * scan->width + x + dx];
			sx += v * dx;
			sy += v * dy;
			s += v;
		}
	return scan_to_full(scan, x + (s > 0 ? sx / s : 0), y + (s > 0 ? sy / s : 0));
}

/* Keeps the list sorted by votes; the weakest falls out when it is full. */
static void insert(struct seeds *seeds, struct seed seed)
{
	if (seeds->count == SEED_MAX && seed.votes <= seeds->seed[SEED_MAX - 1].votes)
		return;
	int at = seeds->count < SEED_MAX ? seeds->count++ : SEED_MAX - 1;
	for (; at > 0 && seeds->seed[at - 1].votes < seed.votes; at--)
		seeds->seed[at] = seeds->seed[at - 1];
	seeds->seed[at] = seed;
}

static void collect_row(struct seeds *seeds, const struct scan *scan, int y, int x0, int x1)
{
	const struct seed_shape *shapes = seeds->shape + y / SCAN_CELL * scan->cells_x;
	for (int x = x0; x < x1; x++) {
		int votes = seeds->sum[y * scan->width + x];
		if (votes < 4)
			continue;
		struct seed_shape s = shapes[x / SCAN_CELL];
		double around = 6.2832 * sqrt(0.5 * ((double)s.xx + (double)s.yy));
		if (votes < VOTE_SHARE * around || !is_peak(seeds, scan->width, x, y))
			continue;
		double cover = cover_at(scan, s, x, y);
		if (cover >= COVER_MIN)
			insert(seeds, (struct seed){peak_centre(seeds, scan, x, y), votes, cover});
	}
}

static void drop_doubles(struct seeds *seeds, const struct scan *scan)
{
	double apart = APART * sqrt((double)seeds->shape[scan->cells_x * (scan->cells_y / 2) + scan->cells_x / 2].xx) *
		       scan->factor;
	int kept = 0;
	for (int i = 0; i < seeds->count; i++) {
		bool isolated = true;
		for (int j = 0; j < kept && isolated; j++)
			isolated = vec2_dist(seeds->seed[i].px, seeds->seed[j].px) > apart;
		if (isolated)
			seeds->seed[kept++] = seeds->seed[i];
	}
	seeds->count = kept;
}

/* The next run of active cells in a row of small pixels, at or after *x: [*x, *end). */
static bool next_run(const struct scan *scan, const uint8_t *active, int y, int *x, int *end)
{
	int last = scan->width - 3, cell = *x / SCAN_CELL;
	const uint8_t *row = active ? active + y / SCAN_CELL * scan->cells_x : NULL;
	if (!row) {
		*end = last;
		return *x < last;
	}
	while (cell < scan->cells_x && !row[cell])
		*x = ++cell * SCAN_CELL;
	while (cell < scan->cells_x && row[cell])
		cell++;
	*end = cell * SCAN_CELL < last ? cell * SCAN_CELL : last;
	return *x < *end;
}

typedef void row_pass(struct seeds *seeds, const struct scan *scan, int y, int x0, int x1);

static void run_pass(struct seeds *seeds, const struct scan *scan, const uint8_t *active, row_pass *pass)
{
	for (int y = 3; y < scan->height - 3; y++)
		for (int x = 3, end; next_run(scan, active, y, &x, &end); x = end)
			pass(seeds, scan, y, x, end);
}

void seeds_find(struct seeds *seeds, const struct scan *scan, const uint8_t *active)
{
	size_t n = (size_t)scan->width * (size_t)scan->height;
	seeds->count = 0;
	if (active && !memchr(active, 1, (size_t)(scan->cells_x * scan->cells_y)))
		return;
	memset(seeds->vote, 0, sizeof(*seeds->vote) * n);
	memset(seeds->sum, 0, sizeof(*seeds->sum) * n);
	run_pass(seeds, scan, active, vote_row);
	run_pass(seeds, scan, active, smooth_row);
	run_pass(seeds, scan, active, collect_row);
	drop_doubles(seeds, scan);
}
