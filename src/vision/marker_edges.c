#include "vision/marker_edges.h"

#include <math.h>
#include <stdlib.h>

#include "physics/vec2.h"

enum { EDGE_SAMPLES = 24, EDGE_SAMPLES_MIN = 14, PROFILE = 17, ROUNDS = 3, BALANCE = 10 };
static const double BALANCE_STEP = 0.25; /* px */
static const double ENDS = 0.12;	 /* of a side, next to the corners, is not measured */
static const double CONTRAST_MIN = 25;	 /* levels between border and paper */
static const double CORNER_MOVE_MAX = 6; /* px; further off something else was measured */
static const double OUTLIER_PX = 0.5;

struct line {
	vec2 point, normal; /* px; unit */
};

static double grey_at(const struct image *im, vec2 p)
{
	int x = (int)p.x, y = (int)p.y;
	double fx = p.x - x, fy = p.y - y, g[4];
	for (int k = 0; k < 4; k++) {
		const uint8_t *q = im->data + (y + k / 2) * im->stride + 3 * (ptrdiff_t)(x + k % 2);
		g[k] = (q[0] + 2 * q[1] + q[2]) / 4.0;
	}
	return (1 - fy) * ((1 - fx) * g[0] + fx * g[1]) + fy * ((1 - fx) * g[2] + fx * g[3]);
}

static bool is_inside(const struct image *im, vec2 p)
{
	return p.x >= 1 && p.y >= 1 && p.x < im->width - 2 && p.y < im->height - 2;
}

/* Where an edge is looked for: around p, along out (unit), which points from the black border to the white paper, as far as
 * reach to both sides. */
struct probe {
	const struct image *im;
	vec2 p, out;
	double reach; /* px */
};

/* The place with as much grey missing on its white side as there is too much on its black side: right for every even
 * blur, where the half way is off by up to a tenth of a pixel for a sharp edge between pixels. */
static double balanced(const struct probe *probe, double half, double low, double high)
{
	double sum = 0;
	for (int i = -BALANCE; i <= BALANCE; i++) {
		vec2 at = vec2_madd(probe->p, half + i * BALANCE_STEP, probe->out);
		double share = (grey_at(probe->im, at) - low) / (high - low);
		sum += fmin(fmax(share, 0), 1) * (abs(i) == BALANCE ? 0.5 : 1);
	}
	return half + BALANCE_STEP * (BALANCE - sum);
}

/* Where the grey crosses the middle between its ends: px along out. */
static bool edge_at(const struct probe *probe, double *offset)
{
	const struct image *im = probe->im;
	vec2 p = probe->p, out = probe->out;
	double reach = probe->reach;
	double v[PROFILE], step = 2 * reach / (PROFILE - 1);
	double margin = reach + BALANCE * BALANCE_STEP;
	if (!is_inside(im, vec2_madd(p, margin, out)) || !is_inside(im, vec2_madd(p, -margin, out)))
		return false;
	for (int i = 0; i < PROFILE; i++)
		v[i] = grey_at(im, vec2_madd(p, i * step - reach, out));
	double low = (v[0] + v[1] + v[2]) / 3, high = (v[PROFILE - 1] + v[PROFILE - 2] + v[PROFILE - 3]) / 3;
	if (high - low < CONTRAST_MIN)
		return false;
	double half = (low + high) / 2, best = 1e9;
	for (int i = 0; i + 1 < PROFILE; i++) {
		double at = (i + (half - v[i]) / (v[i + 1] - v[i])) * step - reach;
		if (v[i] < half && v[i + 1] >= half && fabs(at) < fabs(best))
			best = at;
	}
	if (!(fabs(best) < reach))
		return false;
	*offset = balanced(probe, best, low, high);
	return true;
}

static bool counts(const struct line *line, vec2 p)
{
	return !line || fabs(vec2_dot(vec2_sub(p, line->point), line->normal)) < OUTLIER_PX;
}

/* Total least squares through the points near a former line (NULL: all). False when too few are left. */
static bool fit_line(const vec2 *point, int count, const struct line *former, struct line *out)
{
	vec2 sum = {0, 0};
	double xx = 0, xy = 0, yy = 0;
	int n = 0;
	for (int i = 0; i < count; i++)
		if (counts(former, point[i])) {
			sum = vec2_add(sum, point[i]);
			n++;
		}
	if (n < EDGE_SAMPLES_MIN)
		return false;
	vec2 mean = vec2_scale(sum, 1.0 / n);
	for (int i = 0; i < count; i++)
		if (counts(former, point[i])) {
			vec2 d = vec2_sub(point[i], mean);
			xx += d.x * d.x;
			xy += d.x * d.y;
			yy += d.y * d.y;
		}
	double angle = 0.5 * atan2(2 * xy, xx - yy);
	*out = (struct line){mean, {-sin(angle), cos(angle)}};
	return true;
}

/* The side from the probe's place along way (px). */
static bool measure_side(const struct probe *corner, vec2 way, struct line *line)
{
	vec2 point[EDGE_SAMPLES];
	int count = 0;
	for (int i = 0; i < EDGE_SAMPLES; i++) {
		double k = ENDS + (1 - 2 * ENDS) * i / (EDGE_SAMPLES - 1), offset;
		struct probe probe = *corner;
		probe.p = vec2_madd(corner->p, k, way);
		if (edge_at(&probe, &offset))
			point[count++] = vec2_madd(probe.p, offset, probe.out);
	}
	struct line rough;
	return fit_line(point, count, NULL, &rough) && fit_line(point, count, &rough, line);
}

static bool intersect(const struct line *a, const struct line *b, vec2 *out)
{
	double det = vec2_cross(a->normal, b->normal);
	if (fabs(det) < 0.3)
		return false;
	double da = vec2_dot(a->normal, a->point), db = vec2_dot(b->normal, b->point);
	*out = (vec2){(da * b->normal.y - db * a->normal.y) / det, (db * a->normal.x - da * b->normal.x) / det};
	return true;
}

static bool refine_once(const struct image *frame, int cells, vec2 corner[4])
{
	struct line side[4];
	vec2 fresh[4],
		middle = vec2_scale(vec2_add(vec2_add(corner[0], corner[1]), vec2_add(corner[2], corner[3])), 0.25);
	for (int k = 0; k < 4; k++) {
		vec2 a = corner[k], along = vec2_sub(corner[(k + 1) % 4], a);
		vec2 out = vec2_unit(vec2_perp(along));
		if (vec2_dot(out, vec2_sub(a, middle)) < 0)
			out = vec2_scale(out, -1);
		/* Not across the black border into the marker's bits. */
		double reach = fmin(0.8 * vec2_norm(along) / cells, 3.5);
		if (!measure_side(&(struct probe){frame, a, out, reach}, along, &side[k]))
			return false;
	}
	for (int k = 0; k < 4; k++)
		if (!intersect(&side[(k + 3) % 4], &side[k], &fresh[k]) ||
		    vec2_dist(fresh[k], corner[k]) > CORNER_MOVE_MAX)
			return false;
	for (int k = 0; k < 4; k++)
		corner[k] = fresh[k];
	return true;
}

bool marker_refine(const struct image *frame, int cells, struct marker_view *view)
{
	vec2 corner[4];
	for (int k = 0; k < 4; k++)
		corner[k] = (vec2){view->x[k], view->y[k]};
	for (int round = 0; round < ROUNDS; round++)
		if (!refine_once(frame, cells, corner))
			return false;
	for (int k = 0; k < 4; k++) {
		view->x[k] = corner[k].x;
		view->y[k] = corner[k].y;
	}
	return true;
}
