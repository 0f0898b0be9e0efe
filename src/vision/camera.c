#include "vision/camera.h"

#include <assert.h>
#include <math.h>

static const double MIN_DEPTH = 1e-6; /* m; nearer points are behind the camera */
static const double ASPECT_TOLERANCE = 0.01;
enum { UNDISTORT_STEPS = 20 };

bool camera_scale(const struct camera_intrinsics *in, int width, int height, struct camera_intrinsics *out)
{
	assert(in->width > 0 && in->height > 0);
	if (width <= 0 || height <= 0)
		return false;
	double sx = (double)width / in->width, sy = (double)height / in->height;
	if (fabs(sx / sy - 1) > ASPECT_TOLERANCE)
		return false;
	*out = *in;
	out->width = width;
	out->height = height;
	out->fx = in->fx * sx;
	out->fy = in->fy * sy;
	/* Pixel centres lie at whole numbers: the image begins at -0.5. */
	out->cx = (in->cx + 0.5) * sx - 0.5;
	out->cy = (in->cy + 0.5) * sy - 0.5;
	return true;
}

/* OpenCV's model, on normalised coordinates. */
static vec2 distort(const struct camera_intrinsics *in, vec2 n)
{
	double r2 = n.x * n.x + n.y * n.y;
	double radial = 1 + r2 * (in->k1 + r2 * (in->k2 + r2 * in->k3));
	return (vec2){n.x * radial + 2 * in->p1 * n.x * n.y + in->p2 * (r2 + 2 * n.x * n.x),
		      n.y * radial + in->p1 * (r2 + 2 * n.y * n.y) + 2 * in->p2 * n.x * n.y};
}

static bool is_distorted(const struct camera_intrinsics *in)
{
	return in->k1 != 0 || in->k2 != 0 || in->k3 != 0 || in->p1 != 0 || in->p2 != 0;
}

/* Newton with the distortion's own Jacobian by differences: converges in a few steps for every lens that images a
 * table. */
static vec2 undistort(const struct camera_intrinsics *in, vec2 d)
{
	const double h = 1e-6;
	vec2 n = d;
	for (int i = 0; i < UNDISTORT_STEPS; i++) {
		vec2 f = distort(in, n), fx = distort(in, (vec2){n.x + h, n.y}), fy = distort(in, (vec2){n.x, n.y + h});
		double a = (fx.x - f.x) / h, b = (fy.x - f.x) / h, c = (fx.y - f.y) / h, e = (fy.y - f.y) / h;
		double det = a * e - b * c;
		if (fabs(det) < 1e-9)
			break;
		vec2 step = {(e * (d.x - f.x) - b * (d.y - f.y)) / det, (a * (d.y - f.y) - c * (d.x - f.x)) / det};
		n = vec2_add(n, step);
		if (vec2_norm2(step) < 1e-24)
			break;
	}
	return n;
}

bool camera_project(const struct camera *camera, vec2 pos, double z, vec2 *px)
{
	const double *r = camera->pose.r, *t = camera->pose.t;
	double depth = r[6] * pos.x + r[7] * pos.y + r[8] * z + t[2];
	if (!(depth > MIN_DEPTH))
		return false;
	vec2 n = {(r[0] * pos.x + r[1] * pos.y + r[2] * z + t[0]) / depth,
		  (r[3] * pos.x + r[4] * pos.y + r[5] * z + t[1]) / depth};
	if (is_distorted(&camera->in))
		n = distort(&camera->in, n);
	*px = (vec2){camera->in.fx * n.x + camera->in.cx, camera->in.fy * n.y + camera->in.cy};
	return true;
}

bool camera_unproject(const struct camera *camera, vec2 px, double z, vec2 *pos)
{
	const double *r = camera->pose.r;
	vec2 n = {(px.x - camera->in.cx) / camera->in.fx, (px.y - camera->in.cy) / camera->in.fy};
	if (is_distorted(&camera->in))
		n = undistort(&camera->in, n);
	double centre[3];
	camera_centre(camera, centre);
	double ray[3];
	for (int i = 0; i < 3; i++)
		ray[i] = r[i] * n.x + r[3 + i] * n.y + r[6 + i];
	if (fabs(ray[2]) < 1e-12)
		return false;
	double k = (z - centre[2]) / ray[2];
	if (!(k > 0) || !isfinite(k))
		return false;
	*pos = (vec2){centre[0] + k * ray[0], centre[1] + k * ray[1]};
	return true;
}

void camera_centre(const struct camera *camera, double out[3])
{
	const double *r = camera->pose.r, *t = camera->pose.t;
	for (int i = 0; i < 3; i++)
		out[i] = -(r[i] * t[0] + r[3 + i] * t[1] + r[6 + i] * t[2]);
}
