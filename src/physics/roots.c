#include "physics/roots.h"

#include <math.h>
#include <stdbool.h>

#include "physics/tolerances.h"

int roots_quadratic(double a, double b, double c, double root[2])
{
	if (a == 0) {
		if (b == 0)
			return 0;
		root[0] = -c / b;
		return 1;
	}
	double disc = b * b - 4 * a * c;
	if (disc < 0)
		return 0;
	/* b and the square root are added with equal sign: no cancellation; the other root by Vieta */
	double q = -0.5 * (b + copysign(sqrt(disc), b));
	double x = q / a, y = q != 0 ? c / q : x;
	root[0] = x < y ? x : y;
	root[1] = x < y ? y : x;
	return root[0] == root[1] ? 1 : 2;
}

double roots_quadratic_entry(double c0, double c1, double c2, double horizon)
{
	if (c0 <= 0) {
		if (c1 < 0 || (c1 == 0 && c2 < 0))
			return 0;
		c0 = 0;
	}
	double t;
	if (c2 < 0 && c1 >= 0) {
		/* rises first, falls later: the larger root */
		t = (c1 + sqrt(c1 * c1 - 4 * c2 * c0)) / (-2 * c2);
	} else if (c1 < 0) {
		double disc = c1 * c1 - 4 * c2 * c0;
		if (disc < 0)
			return INFINITY;
		t = 2 * c0 / (-c1 + sqrt(disc));
	} else {
		return INFINITY;
	}
	return t <= horizon ? t : INFINITY;
}

/* A polynomial on the unit interval. */
struct quartic {
	double c0, c1, c2, c3, c4;
};

/* Value and slope by pairs of terms (Estrin): the sums run side by side. */
static inline double value(const struct quartic *q, double s)
{
	double s2 = s * s;
	return (q->c0 + s * q->c1) + s2 * ((q->c2 + s * q->c3) + s2 * q->c4);
}

static inline double slope(const struct quartic *q, double s)
{
	return (q->c1 + s * (2 * q->c2)) + s * s * (3 * q->c3 + s * (4 * q->c4));
}

/* The Bernstein coefficients bound the polynomial: all positive, no root. */
static inline bool positive_hull(const struct quartic *q)
{
	double b1 = q->c0 + 0.25 * q->c1;
	double b2 = q->c0 + 0.5 * q->c1 + q->c2 / 6;
	double b3 = q->c0 + 0.75 * q->c1 + 0.5 * q->c2 + 0.25 * q->c3;
	double b4 = q->c0 + q->c1 + q->c2 + q->c3 + q->c4;
	return b1 > 0 && b2 > 0 && b3 > 0 && b4 > 0;
}

static inline bool falls_at_start(const struct quartic *q)
{
	if (q->c1 != 0)
		return q->c1 < 0;
	if (q->c2 != 0)
		return q->c2 < 0;
	return q->c3 != 0 ? q->c3 < 0 : q->c4 < 0;
}

/* Rising from a root at 0: the same entries without that root. */
static void divide_by_start(struct quartic *q)
{
	for (int i = 0; i < 4; i++) {
		*q = (struct quartic){q->c1, q->c2, q->c3, q->c4, 0};
		if (q->c0 != 0)
			return;
	}
}

/* The last step, from an iterate that rounding has put on the root's other side; within [low, high]. */
static double last_step(double s, double v, double d, double low, double high)
{
	double next = s - v / d;
	return next < low ? low : next > high ? high : next;
}

/* Half the curvature. */
static inline double bend(const struct quartic *q, double s)
{
	return q->c2 + s * (3 * q->c3 + s * (6 * q->c4));
}

/* The least half curvature between low and high; at least 0 in a convex piece. */
static double least_bend(const struct quartic *q, double low, double high)
{
	double a = bend(q, low), b = bend(q, high), least = a < b ? a : b;
	if (q->c4 > 0) {
		double vertex = -q->c3 / (4 * q->c4);
		if (vertex > low && vertex < high)
			least = bend(q, vertex);
	}
	return least > 0 ? least : 0;
}

/* From a point above zero in a convex piece: the parabola with the least curvature of what is left lies below the
 * curve, so its root is not past the first root of the polynomial, and where it has none, neither has the piece: -1. */
static double safe_step(const struct quartic *q, double s, double right)
{
	double v = value(q, s), d = slope(q, s);
	double disc = d * d - 4 * least_bend(q, s, right) * v;
	if (disc < 0 || d >= 0)
		return -1;
	double next = s + 2 * v / (sqrt(disc) - d);
	return next <= right ? next : -1;
}

/* Convex piece: at most one falling root. Steps to the root of the osculating parabola converge with the third order
 * but may pass the root, or find none; whenever one leads out of the falling part, a safe step is taken from the last
 * point above zero instead. Returns -1 when there is no entry. */
static double convex_entry(const struct quartic *q, double left, double right)
{
	double s = left, low = left;
	bool safe = true;
	for (int i = 0; i < NEWTON_MAX; i++) {
		double v = value(q, s), d = slope(q, s);
		if (d < 0 && v <= 0 && safe)
			return s;
		if (d >= 0 && safe)
			return -1;
		if (d < 0) {
			double disc = d * d - 4 * bend(q, s) * v;
			low = v > 0 ? s : low;
			double root = sqrt(disc), step = 2 * v / (root - d), next = s + step;
			if (disc > 0 && next >= low && next <= right) {
				/* what the parabola leaves out, over its slope at the root */
				double cubic = fabs(q->c3 + 4 * q->c4 * s) + fabs(q->c4 * step);
				if (cubic * fabs(step * step * step) <= ROOT_CLOSE * next * root)
					return next;
				s = next;
				safe = false;
				continue;
			}
		}
		double next = safe_step(q, low, right);
		if (next < 0 || next == low)
			return next;
		s = next;
		safe = true;
	}
	return s;
}

/* Concave piece that starts at or above zero: it falls through zero once, if it ends below. Tangents lie above the
 * curve, so steps from the right end come down to the root from above. */
static double concave_entry(const struct quartic *q, double left, double right)
{
	double s = right, before = right;
	if (value(q, right) > 0 || slope(q, right) >= 0)
		return -1;
	for (int i = 0; i < NEWTON_MAX; i++) {
		double v = value(q, s), d = slope(q, s);
		if (d >= 0)
			return s;
		if (v >= 0)
			return last_step(s, v, d, s, before);
		double next = s - v / d;
		if (next < left)
			next = left;
		if (next == s)
			return s;
		before = s;
		s = next;
	}
	return s;
}

/* Inflection points inside (0, 1), ascending, then 1. */
static int piece_ends(const struct quartic *q, double end[3])
{
	double root[2];
	int count = 0;
	if (q->c2 >= 0 && q->c2 + 1.5 * q->c3 >= 0 && q->c2 + 3 * q->c3 + 6 * q->c4 >= 0) {
		end[0] = 1; /* the hull of the curvature: convex throughout */
		return 1;
	}
	int n = roots_quadratic(6 * q->c4, 3 * q->c3, q->c2, root);
	for (int i = 0; i < n; i++) {
		if (root[i] > 0 && root[i] < 1)
			end[count++] = root[i];
	}
	end[count++] = 1;
	return count;
}

double roots_quartic_entry(const double c[5], double horizon)
{
	double h2 = horizon * horizon;
	struct quartic q = {c[0], c[1] * horizon, c[2] * h2, c[3] * h2 * horizon, c[4] * h2 * h2};
	if (q.c0 <= 0) {
		if (falls_at_start(&q))
			return 0;
		divide_by_start(&q);
	}
	if (positive_hull(&q))
		return INFINITY;
	double end[3], left = 0;
	int pieces = piece_ends(&q, end);
	for (int i = 0; i < pieces; i++) {
		double middle = 0.5 * (left + end[i]);
		bool convex = bend(&q, middle) >= 0;
		double s = convex ? convex_entry(&q, left, end[i]) : concave_entry(&q, left, end[i]);
		if (s >= 0)
			return s * horizon;
		left = end[i];
	}
	return INFINITY;
}
