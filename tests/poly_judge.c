#include "poly_judge.h"

#include <float.h>
#include <math.h>

static long double value(const long double *c, int degree, long double t)
{
	long double v = c[degree];
	for (int i = degree - 1; i >= 0; i--)
		v = v * t + c[i];
	return v;
}

long double judge_value(const long double c[JUDGE_DEGREE + 1], long double t)
{
	return value(c, JUDGE_DEGREE, t);
}

long double judge_slope(const long double c[JUDGE_DEGREE + 1], long double t)
{
	return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * 4 * c[4]));
}

long double judge_noise(const long double c[JUDGE_DEGREE + 1], long double t)
{
	long double sum = 0, power = 1;
	for (int i = 0; i <= JUDGE_DEGREE; i++, power *= t)
		sum += fabsl(c[i]) * power;
	return 32 * (long double)DBL_EPSILON * sum;
}

static long double bisect(const long double *c, int degree, long double low, long double high)
{
	bool rises = value(c, degree, high) > 0;
	for (int i = 0; i < 70; i++) {
		long double middle = 0.5L * (low + high);
		if ((value(c, degree, middle) > 0) == rises)
			high = middle;
		else
			low = middle;
	}
	return 0.5L * (low + high);
}

/* Points of [0, horizon] between which the polynomial is monotone, ends included. */
static int monotone_ends(const long double *c, int degree, long double horizon, long double *end)
{
	int count = 0;
	end[count++] = 0;
	if (degree >= 2) {
		long double d[JUDGE_DEGREE], inner[JUDGE_DEGREE + 2];
		for (int i = 0; i < degree; i++)
			d[i] = (i + 1) * c[i + 1];
		int n = monotone_ends(d, degree - 1, horizon, inner);
		for (int i = 0; i + 1 < n; i++) {
			long double a = value(d, degree - 1, inner[i]), b = value(d, degree - 1, inner[i + 1]);
			if ((a > 0) != (b > 0))
				end[count++] = bisect(d, degree - 1, inner[i], inner[i + 1]);
		}
	}
	end[count++] = horizon;
	return count;
}

struct judge_entry judge_first_entry(const long double c[JUDGE_DEGREE + 1], long double horizon)
{
	long double end[JUDGE_DEGREE + 2];
	int n = monotone_ends(c, JUDGE_DEGREE, horizon, end);
	for (int i = 0; i + 1 < n; i++) {
		long double a = judge_value(c, end[i]), b = judge_value(c, end[i + 1]);
		if (b < a && b < -judge_noise(c, end[i + 1])) {
			long double root = a <= 0 ? end[i] : bisect(c, JUDGE_DEGREE, end[i], end[i + 1]);
			return (struct judge_entry){true, root, end[i + 1]};
		}
	}
	return (struct judge_entry){false, 0, 0};
}
