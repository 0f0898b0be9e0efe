#include "vision/fit.h"

#include <math.h>
#include <string.h>

#include "vision/linear.h"

/* How the rim is sampled: samples to either side of it (wide: in the first step), and their distance over the radius.
 */
struct sampling {
	int wide, narrow;
	double step;
};
enum { REACH_MAX = 10 };
static const struct sampling FINE = {10, 7, 1 / 28.0}, COARSE = {6, 4, 1 / 16.0};
static const double CONTRAST_MIN = 12; /* levels; a weaker edge is noise */
static const double CONTRAST_FULL = 40;
/* How far an edge usually lies off, px; edges side by side err alike, so each counts less than its own noise would say.
 */
static const double EDGE_PX = 0.9;
/* In a crease between balls the own dark limb belongs to the outside: the edge is seen this far inside of the rim. */
static const double CREASE_PX = -0.5, CREASE_SPREAD_PX = 0.8, CREASE_REACH = 1.5;
static const float CREASE_CHROMA2 = 0.16f * 0.16f, CREASE_SHADE = 0.33f;
static const double STEEP_REACH = 0.108; /* radii around the half way that are searched */
static const double EDGES_MIN = 0.3;	 /* share of open rays with any edge at all */
static const double EXPLAINED_MIN = 0.3; /* share of them that one outline explains */
static const double SUPPORT_PX = 1.1;	 /* an edge this near is where it should be */

struct edge {
	bool hidden, found;
	bool crease;   /* between two balls: the outside is no cloth but a neighbour or its dark foot */
	double offset; /* px along the normal, outwards */
	double weight;
	double contrast;
};

/* Bilinear, BGR; the place must lie inside of the frame. */
static inline void sample(const struct image *im, float x, float y, float out[3])
{
	int ix = (int)x, iy = (int)y;
	float fx = x - (float)ix, fy = y - (float)iy;
	const uint8_t *a = im->data + iy * im->stride + 3 * (ptrdiff_t)ix, *b = a + im->stride;
	float w00 = (1 - fx) * (1 - fy), w10 = fx * (1 - fy), w01 = (1 - fx) * fy, w11 = fx * fy;
	for (int c = 0; c < 3; c++)
		out[c] = w00 * (float)a[c] + w10 * (float)a[c + 3] + w01 * (float)b[c] + w11 * (float)b[c + 3];
}

/* With a margin for the rounding to float between here and sample(). */
static bool is_inside(const struct image *im, double x, double y)
{
	return x >= 0 && y >= 0 && x < im->width - 1.01 && y < im->height - 1.01;
}

/* Where the profile v (1 inside, 0 outside) falls through a half nearest to the middle. */
static bool half_crossing(const float *v, int count, double *at)
{
	double best = 1e9;
	for (int j = 0; j + 1 < count; j++) {
		if (!(v[j] >= 0.5f && v[j + 1] < 0.5f))
			continue;
		double t = j + (double)((v[j] - 0.5f) / (v[j] - v[j + 1])) - (count - 1) / 2.0;
		if (fabs(t) < fabs(best))
			best = t;
	}
	*at = best;
	return best < 1e8;
}

/* The steepest place near there. Shading makes the levels to either side slope, and with them the half way; the
 * steepest place stays. */
static double steepest(const float *v, int count, double half, double reach)
{
	double sum = 0, moment = 0, middle = (count - 1) / 2.0;
	for (int j = 0; j + 1 < count; j++) {
		double t = j + 0.5 - middle, fall = v[j] - v[j + 1];
		if (fall <= 0 || fabs(t - half) > reach)
			continue;
		sum += fall * fall * fall;
		moment += fall * fall * fall * t;
	}
	return sum > 0 ? moment / sum : half;
}

/* Neither plain, lit nor shaded cloth. */
static bool is_foreign(const float p[3], const float c[3])
{
	float pc = p[0] * c[0] + p[1] * c[1] + p[2] * c[2], cc = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
	float pp = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
	return pp - pc * pc / cc > CREASE_CHROMA2 * (pp + 0.04f * cc) || pc < CREASE_SHADE * cc;
}

struct ray {
	vec2 p, n;   /* px; unit, outwards */
	int reach;   /* samples to either side */
	double step; /* px between them */
};

/* Colours along the ray, inside first, projected onto the way from the outside's colour to the inside's. */
static bool profile(const struct image *im, const struct ray *ray, const float cloth[3], float *v, struct edge *edge)
{
	vec2 p = ray->p, n = ray->n;
	int reach = ray->reach;
	double step = ray->step;
	int count = 2 * reach + 1, ends = reach / 2;
	float colour[2 * REACH_MAX + 1][3], in[3] = {0}, out[3] = {0}, d[3], dd = 0;
	double far = reach * step;
	if (!is_inside(im, p.x - far * n.x, p.y - far * n.y) || !is_inside(im, p.x + far * n.x, p.y + far * n.y))
		return false;
	for (int j = 0; j < count; j++) {
		double t = (j - reach) * step;
		sample(im, (float)(p.x + t * n.x), (float)(p.y + t * n.y), colour[j]);
	}
	for (int j = 0; j < ends; j++)
		for (int c = 0; c < 3; c++) {
			in[c] += colour[j][c] / (float)ends;
			out[c] += colour[count - 1 - j][c] / (float)ends;
		}
	for (int c = 0; c < 3; c++) {
		d[c] = in[c] - out[c];
		dd += d[c] * d[c];
	}
	edge->crease = is_foreign(out, cloth);
	edge->contrast = sqrt((double)dd);
	if (edge->contrast < CONTRAST_MIN)
		return false;
	for (int j = 0; j < count; j++)
		v[j] = ((colour[j][0] - out[0]) * d[0] + (colour[j][1] - out[1]) * d[1] +
			(colour[j][2] - out[2]) * d[2]) /
		       dd;
	return true;
}

/* Distance from the nearest neighbour's middle over its radius, at an image point. */
static double nearest_neighbour(const struct fit_view *view, const struct fit *self, vec2 p)
{
	double nearest = INFINITY;
	for (int i = 0; i < view->other_count; i++) {
		const struct fit *o = &view->other[i];
		double apart = vec2_dist(o->pos, self->pos);
		if (o != self && apart > 0.5 * view->radius && apart < 3.5 * view->radius)
			nearest = fmin(nearest, vec2_dist(p, o->outline.centre) / o->outline.radius_px);
	}
	return nearest;
}

static void find_edges(const struct fit_view *view, const struct fit *fit, int reach, double step_share,
		       struct edge edge[OUTLINE_POINTS])
{
	double step = fit->outline.radius_px * step_share;
	for (int i = 0; i < OUTLINE_POINTS; i++) {
		vec2 p = fit->outline.point[i], n = fit->outline.normal[i];
		float v[2 * REACH_MAX + 1];
		struct ray ray = {p, n, reach, step};
		double at;
		edge[i] = (struct edge){0};
		if (view->coarse && i % 2 == 1) {
			edge[i].hidden = true;
			continue;
		}
		double near = nearest_neighbour(view, fit, vec2_madd(p, 0.7 * reach * step, n));
		edge[i].hidden = near < 1;
		if (edge[i].hidden || !profile(view->frame, &ray, fit->cloth, v, &edge[i]) ||
		    !half_crossing(v, 2 * reach + 1, &at))
			continue;
		edge[i].found = true;
		edge[i].crease = edge[i].crease && near < CREASE_REACH;
		edge[i].offset = steepest(v, 2 * reach + 1, at, STEEP_REACH / step_share) * step;
		edge[i].weight = fmin(1, edge[i].contrast / CONTRAST_FULL);
	}
}

enum { SHIFT_X, SHIFT_Y, GROWTH, CREASE, UNKNOWNS };

/* Least squares for shift, growth and the creases' common offset (px), with Tukey's weights. */
static void solve_shift(const struct fit *fit, const struct edge edge[OUTLINE_POINTS], double cut, double x[UNKNOWNS])
{
	double px = fit->outline.radius_px, unit = px / 15.5;
	double scale_w = EDGE_PX / (fit->scale_spread * px), crease_w = EDGE_PX / CREASE_SPREAD_PX;
	memset(x, 0, UNKNOWNS * sizeof(*x));
	for (int round = 0; round < 3; round++) {
		double a[UNKNOWNS * UNKNOWNS] = {0}, b[UNKNOWNS] = {0};
		a[0] = a[UNKNOWNS + 1] = 1e-6;
		a[GROWTH * (UNKNOWNS + 1)] = scale_w * scale_w;
		b[GROWTH] = -scale_w * scale_w * (fit->scale - fit->expected_scale) * px;
		a[CREASE * (UNKNOWNS + 1)] = crease_w * crease_w;
		b[CREASE] = crease_w * crease_w * CREASE_PX * unit;
		for (int i = 0; i < OUTLINE_POINTS; i++) {
			if (!edge[i].found)
				continue;
			double row[UNKNOWNS] = {fit->outline.normal[i].x, fit->outline.normal[i].y, 1, edge[i].crease};
			double off = edge[i].offset;
			for (int k = 0; k < UNKNOWNS; k++)
				off -= row[k] * x[k];
			double q = off / cut, w = edge[i].weight;
			w *= round == 0 ? 1 / (1 + q * q) : fabs(q) < 1 ? (1 - q * q) * (1 - q * q) : 0;
			for (int j = 0; j < UNKNOWNS; j++) {
				b[j] += w * row[j] * edge[i].offset;
				for (int k = 0; k < UNKNOWNS; k++)
					a[UNKNOWNS * j + k] += w * row[j] * row[k];
			}
		}
		if (!solve_spd(a, b, UNKNOWNS))
			return;
		memcpy(x, b, sizeof(b));
	}
}

/* crease_px: how far inside edges of creases are seen. */
static void judge(struct fit *fit, const struct edge edge[OUTLINE_POINTS], double crease_px)
{
	double good = 0, sum = 0, contrast = 0;
	fit->rays = 0;
	for (int i = 0; i < OUTLINE_POINTS; i++) {
		fit->rays += !edge[i].hidden;
		double off = edge[i].offset - (edge[i].crease ? crease_px : 0);
		if (!edge[i].found || fabs(off) > SUPPORT_PX * fit->outline.radius_px / 15.5)
			continue;
		good++;
		sum += off * off;
		contrast += edge[i].contrast;
	}
	fit->support = fit->rays > 0 ? good / fit->rays : 0;
	fit->residual_px = good > 0 ? sqrt(sum / good) : 0;
	fit->contrast = good > 0 ? contrast / good : 0;
}

/* Share of the open rays whose edges the solution explains. */
static double edges_explained(const struct fit *fit, const struct edge edge[OUTLINE_POINTS], double cut,
			      const double x[UNKNOWNS])
{
	int good = 0, open = 0;
	for (int i = 0; i < OUTLINE_POINTS; i++) {
		double off = edge[i].offset - fit->outline.normal[i].x * x[SHIFT_X] -
			     fit->outline.normal[i].y * x[SHIFT_Y] - x[GROWTH] - (edge[i].crease ? x[CREASE] : 0);
		good += edge[i].found && fabs(off) < cut;
		open += !edge[i].hidden;
	}
	return open > 0 ? (double)good / open : 0;
}

static double edges_found(const struct edge edge[OUTLINE_POINTS])
{
	int found = 0, open = 0;
	for (int i = 0; i < OUTLINE_POINTS; i++) {
		found += edge[i].found;
		open += !edge[i].hidden;
	}
	return open > 0 ? (double)found / open : 0;
}

bool fit_refine(const struct fit_view *view, struct fit *fit, int steps)
{
	const struct sampling *how = view->coarse ? &COARSE : &FINE;
	vec2 from = fit->pos;
	struct edge edge[OUTLINE_POINTS];
	double shift[UNKNOWNS] = {0};
	for (int s = 0; s <= steps; s++) {
		bool last = s == steps;
		if (!outline_of_ball(view->camera, fit->pos, view->radius, fit->scale, &fit->outline))
			return false;
		find_edges(view, fit, s == 0 && view->coarse ? how->wide : how->narrow, how->step, edge);
		if (last)
			break;
		/* Nothing like a rim: no use going on. */
		if (s == 0 && edges_found(edge) < EDGES_MIN)
			return false;
		double j[4];
		double unit = fit->outline.radius_px / 15.5;
		solve_shift(fit, edge, (s == 0 ? 4 : 2) * unit, shift);
		if (s == 0 && edges_explained(fit, edge, 2 * unit, shift) < EXPLAINED_MIN)
			return false;
		if (!outline_jacobian(view->camera, fit->pos, view->radius, j))
			return false;
		double det = j[0] * j[3] - j[1] * j[2];
		fit->pos.x += (j[3] * shift[SHIFT_X] - j[1] * shift[SHIFT_Y]) / det;
		fit->pos.y += (j[0] * shift[SHIFT_Y] - j[2] * shift[SHIFT_X]) / det;
		fit->scale += shift[GROWTH] / fit->outline.radius_px;
		fit->scale = fmin(fmax(fit->scale, 0.85), 1.12);
		if (!(vec2_dist(fit->pos, from) < 0.6 * view->radius))
			return false;
	}
	judge(fit, edge, shift[CREASE]);
	return true;
}

void fit_rim(const struct fit_view *view, const struct fit *fit, struct rim_point out[OUTLINE_POINTS])
{
	struct edge edge[OUTLINE_POINTS];
	find_edges(view, fit, FINE.narrow, FINE.step, edge);
	for (int i = 0; i < OUTLINE_POINTS; i++) {
		out[i].px = vec2_madd(fit->outline.point[i], edge[i].offset, fit->outline.normal[i]);
		out[i].state = edge[i].hidden	? RIM_HIDDEN
			       : !edge[i].found ? RIM_BARE
			       : edge[i].crease ? RIM_CREASE
						: RIM_EDGE;
	}
}
