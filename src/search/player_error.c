#include "search/player_error.h"

static const double TIP_MAX = 0.9;		     /* of the radius: beyond it the ball is missed */
static const double ELEVATION_MAX = 80 * M_PI / 180; /* rad */
static const double SPEED_MIN = 0.01;		     /* m/s */

static double polynomial(const double *c, int count, double x)
{
	double sum = 0;
	for (int i = 0; i < count; i++)
		sum = sum * x + c[i];
	return sum;
}

double normal_quantile(double p)
{
	static const double a[] = {-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
				   1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
	static const double b[] = {-5.447609879822406e+01, 1.615858368580409e+02,  -1.556989798598866e+02,
				   6.680131188771972e+01,  -1.328068155288572e+01, 1};
	static const double c[] = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
				   -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
	static const double d[] = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
				   3.754408661907416e+00, 1};
	static const double tail = 0.02425;
	if (p < tail || p > 1 - tail) {
		double q = sqrt(-2 * log(p < tail ? p : 1 - p));
		double x = polynomial(c, 6, q) / polynomial(d, 5, q);
		return p < tail ? x : -x;
	}
	double q = p - 0.5, r = q * q;
	return polynomial(a, 6, r) * q / polynomial(b, 6, r);
}

/* A number in [0, 1) from a seed and a dimension: splitmix64. */
static double shift_of(uint64_t seed, int dimension)
{
	uint64_t z = seed + (uint64_t)(dimension + 1) * 0x9e3779b97f4a7c15u;
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* The positive root of x^(d+1) = x + 1. */
static double golden(int d)
{
	double x = 2;
	for (int i = 0; i < 60; i++)
		x = pow(1 + x, 1.0 / (d + 1));
	return x;
}

void player_error_points(struct deviate *point, int count, uint64_t seed)
{
	double root = golden(ERROR_DIMENSIONS), step = 1;
	for (int k = 0; k < ERROR_DIMENSIONS; k++) {
		step /= root;
		double shift = seed ? shift_of(seed, k) : 0.5;
		for (int i = 0; i < count; i++) {
			double at = shift + (i + 1) * step;
			at -= floor(at);
			at = fmin(fmax(at, 1e-6), 1 - 1e-6);
			point[i].z[k] = normal_quantile(at);
		}
	}
}

static double clamp(double x, double low, double high)
{
	return fmin(high, fmax(low, x));
}

struct shot player_error_apply(const struct player_error *error, const struct shot *shot, const struct deviate *d)
{
	struct shot out = *shot;
	out.angle += error->angle_bias + error->angle * d->z[0];
	out.speed = clamp(shot->speed * (1 + error->speed_bias + error->speed * d->z[1]), SPEED_MIN, SHOT_SPEED_MAX);
	out.side += error->side_bias + error->tip * d->z[2];
	out.follow += error->follow_bias + error->tip * d->z[3];
	double off = hypot(out.side, out.follow);
	if (off > TIP_MAX) {
		out.side *= TIP_MAX / off;
		out.follow *= TIP_MAX / off;
	}
	out.elevation = clamp(shot->elevation + error->elevation_bias + error->elevation * d->z[4], 0, ELEVATION_MAX);
	return out;
}
