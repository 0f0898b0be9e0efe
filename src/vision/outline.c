#include "vision/outline.h"

#include <math.h>

static const double FULL_TURN = 6.283185307179586;

static void cross(const double a[3], const double b[3], double out[3])
{
	out[0] = a[1] * b[2] - a[2] * b[1];
	out[1] = a[2] * b[0] - a[0] * b[2];
	out[2] = a[0] * b[1] - a[1] * b[0];
}

static double norm3(const double a[3])
{
	return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* Unit vectors across the line of sight; the first lies in the bed's plane. */
static bool across(const double sight[3], double u[3], double v[3])
{
	double n = norm3(sight);
	double up[3] = {0, 0, 1};
	cross(up, sight, u);
	double k = norm3(u);
	if (k < 1e-9 * n) {
		u[0] = 1, u[1] = 0, u[2] = 0;
		k = 1;
	}
	for (int i = 0; i < 3; i++)
		u[i] /= k;
	cross(sight, u, v);
	for (int i = 0; i < 3; i++)
		v[i] /= n;
	return n > 0;
}

static void normals(struct outline *o)
{
	vec2 middle = {0, 0};
	for (int i = 0; i < OUTLINE_POINTS; i++)
		middle = vec2_madd(middle, 1.0 / OUTLINE_POINTS, o->point[i]);
	o->radius_px = 0;
	for (int i = 0; i < OUTLINE_POINTS; i++) {
		vec2 before = o->point[(i + OUTLINE_POINTS - 1) % OUTLINE_POINTS],
		     after = o->point[(i + 1) % OUTLINE_POINTS];
		vec2 normal = vec2_unit(vec2_perp(vec2_sub(after, before)));
		vec2 out = vec2_sub(o->point[i], middle);
		o->normal[i] = vec2_dot(normal, out) < 0 ? vec2_scale(normal, -1) : normal;
		o->radius_px += vec2_norm(out) / OUTLINE_POINTS;
	}
}

bool outline_of_ball(const struct camera *camera, vec2 pos, double radius, double scale, struct outline *out)
{
	double eye[3], u[3], v[3];
	camera_centre(camera, eye);
	double sight[3] = {pos.x - eye[0], pos.y - eye[1], radius - eye[2]};
	double distance = norm3(sight);
	if (!(distance > 2 * radius) || !across(sight, u, v))
		return false;
	double back = radius * radius / (distance * distance);
	double r = radius * sqrt(1 - back) * scale;
	double middle[3] = {pos.x - back * sight[0], pos.y - back * sight[1], radius - back * sight[2]};
	/* Rotation by the angle between points, applied again and again. */
	double c = 1, s = 0, dc = cos(FULL_TURN / OUTLINE_POINTS), ds = sin(FULL_TURN / OUTLINE_POINTS);
	for (int i = 0; i < OUTLINE_POINTS; i++) {
		double p[3];
		for (int k = 0; k < 3; k++)
			p[k] = middle[k] + r * (c * u[k] + s * v[k]);
		if (!camera_project(camera, (vec2){p[0], p[1]}, p[2], &out->point[i]))
			return false;
		double next = c * dc - s * ds;
		s = s * dc + c * ds;
		c = next;
	}
	normals(out);
	return camera_project(camera, pos, radius, &out->centre);
}

bool outline_jacobian(const struct camera *camera, vec2 pos, double radius, double out[4])
{
	const double h = 1e-4;
	vec2 a, b, c, d;
	if (!camera_project(camera, (vec2){pos.x - h, pos.y}, radius, &a) ||
	    !camera_project(camera, (vec2){pos.x + h, pos.y}, radius, &b) ||
	    !camera_project(camera, (vec2){pos.x, pos.y - h}, radius, &c) ||
	    !camera_project(camera, (vec2){pos.x, pos.y + h}, radius, &d))
		return false;
	out[0] = (b.x - a.x) / (2 * h);
	out[1] = (d.x - c.x) / (2 * h);
	out[2] = (b.y - a.y) / (2 * h);
	out[3] = (d.y - c.y) / (2 * h);
	return true;
}
