/* Plane vectors. A value type: the only typedef'd struct of the project. */
#ifndef BILLIARD_PHYSICS_VEC2_H
#define BILLIARD_PHYSICS_VEC2_H

#include <math.h>
#include <stdbool.h>

typedef struct {
	double x, y;
} vec2;

static inline vec2 vec2_add(vec2 a, vec2 b)
{
	return (vec2){a.x + b.x, a.y + b.y};
}
static inline vec2 vec2_sub(vec2 a, vec2 b)
{
	return (vec2){a.x - b.x, a.y - b.y};
}
static inline vec2 vec2_scale(vec2 a, double k)
{
	return (vec2){k * a.x, k * a.y};
}
/* a + k b */
static inline vec2 vec2_madd(vec2 a, double k, vec2 b)
{
	return (vec2){a.x + k * b.x, a.y + k * b.y};
}
static inline double vec2_dot(vec2 a, vec2 b)
{
	return a.x * b.x + a.y * b.y;
}
/* z component of the cross product: positive when b lies counter-clockwise of a. */
static inline double vec2_cross(vec2 a, vec2 b)
{
	return a.x * b.y - a.y * b.x;
}
/* a turned by +90 degrees. */
static inline vec2 vec2_perp(vec2 a)
{
	return (vec2){-a.y, a.x};
}
static inline double vec2_norm2(vec2 a)
{
	return a.x * a.x + a.y * a.y;
}
static inline double vec2_norm(vec2 a)
{
	return sqrt(vec2_norm2(a));
}
static inline double vec2_dist(vec2 a, vec2 b)
{
	return vec2_norm(vec2_sub(a, b));
}
/* Unit vector along a; the zero vector stays zero. */
static inline vec2 vec2_unit(vec2 a)
{
	double n = vec2_norm(a);
	return n > 0 ? vec2_scale(a, 1 / n) : (vec2){0, 0};
}
static inline vec2 vec2_from_angle(double rad)
{
	return (vec2){cos(rad), sin(rad)};
}
static inline bool vec2_is_finite(vec2 a)
{
	return isfinite(a.x) && isfinite(a.y);
}

#endif
