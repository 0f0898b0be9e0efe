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

enum { SOBOL_BITS = 32 };

/* Primitive polynomials (degree, inner coefficients) and first direction numbers: Joe and Kuo 2008, dimensions 2 to 5;
 * the first dimension is van der Corput's sequence. */
static const struct {
	int degree;
	uint32_t inner, first[3];
} sobol_table[ERROR_DIMENSIONS] = {{0, 0, {0}}, {1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}}};

static void sobol_directions(int dimension, uint32_t direction[SOBOL_BITS])
{
	int degree = sobol_table[dimension].degree;
	for (int i = 0; i < SOBOL_BITS; i++) {
		if (degree == 0) {
			direction[i] = 1u << (SOBOL_BITS - 1 - i);
			continue;
		}
		if (i < degree) {
			direction[i] = sobol_table[dimension].first[i] << (SOBOL_BITS - 1 - i);
			continue;
		}
		direction[i] = direction[i - degree] ^ (direction[i - degree] >> degree);
		for (int k = 1; k < degree; k++)
			if (sobol_table[dimension].inner >> (degree - 1 - k) & 1)
				direction[i] ^= direction[i - k];
	}
}

/* 32 bits from a seed and a dimension: splitmix64. */
static uint32_t shift_of(uint64_t seed, int dimension)
{
	uint64_t z = seed + (uint64_t)(dimension + 1) * 0x9e3779b97f4a7c15u;
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return (uint32_t)((z ^ (z >> 31)) >> 32);
}

void player_error_points(struct deviate *point, int count, uint64_t seed)
{
	for (int k = 0; k < ERROR_DIMENSIONS; k++) {
		uint32_t direction[SOBOL_BITS], at = shift_of(seed, k);
		sobol_directions(k, direction);
		for (int i = 0; i < count; i++) {
			point[i].z[k] = normal_quantile((at + 0.5) * 0x1p-32);
			at ^= direction[__builtin_ctz((unsigned)i + 1)]; /* Gray code order */
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
