#include "vision/pose.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "vision/linear.h"

enum { SIDE = 6, FIRST_YAW = 7, UNKNOWN_MAX = FIRST_YAW + MARKER_MAX, STEP_MAX = 60 };
static const double STEP_ROTATION = 1e-6, STEP_LENGTH = 1e-6; /* of the numeric derivatives: rad, m */
static const double WORST_RESIDUAL_PX = 8;		      /* at 1280 px; more is no table */

/* One marker: where it lies, how it is turned, what was seen of it. */
struct placed {
	vec2 centre;
	double yaw;
	const struct marker_view *seen;
};

struct problem {
	struct camera camera;
	double half, height;
	struct placed marker[MARKER_MAX];
	int count;
};

static bool gather(const struct marker_layout *layout, const struct marker_view *view, int count, struct problem *p)
{
	p->half = layout->side / 2;
	p->height = layout->height;
	p->count = 0;
	for (int i = 0; i < count; i++)
		for (int k = 0; k < layout->count; k++)
			if (layout->marker[k].id == view[i].id && p->count < MARKER_MAX)
				p->marker[p->count++] = (struct placed){layout->marker[k].centre, 0, &view[i]};
	return p->count >= 3;
}

static vec2 seen_corner(const struct placed *m, int k)
{
	return (vec2){m->seen->x[k], m->seen->y[k]};
}

static vec2 seen_centre(const struct placed *m)
{
	const struct marker_view *v = m->seen;
	return (vec2){(v->x[0] + v->x[1] + v->x[2] + v->x[3]) / 4, (v->y[0] + v->y[1] + v->y[2] + v->y[3]) / 4};
}

/* Corners as ArUco lists them, clockwise from the top left, in a frame with z towards the viewer. */
static vec2 corner_on_table(const struct problem *p, const struct placed *m, int k)
{
	static const double sx[4] = {-1, 1, 1, -1}, sy[4] = {1, 1, -1, -1};
	double c = cos(m->yaw) * p->half, s = sin(m->yaw) * p->half;
	return (vec2){m->centre.x + c * sx[k] - s * sy[k], m->centre.y + s * sx[k] + c * sy[k]};
}

static double residuals(const struct problem *p, double *out)
{
	double sum = 0;
	for (int i = 0; i < p->count; i++)
		for (int k = 0; k < 4; k++) {
			vec2 px;
			if (!camera_project(&p->camera, corner_on_table(p, &p->marker[i], k), p->height, &px))
				return INFINITY;
			vec2 d = vec2_sub(px, seen_corner(&p->marker[i], k));
			out[8 * i + 2 * k] = d.x;
			out[8 * i + 2 * k + 1] = d.y;
			sum += vec2_norm2(d);
		}
	return sum;
}

static void rotate(double r[9], const double w[3])
{
	double angle = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
	if (angle < 1e-15)
		return;
	double x = w[0] / angle, y = w[1] / angle, z = w[2] / angle;
	double c = cos(angle), s = sin(angle), v = 1 - c;
	double e[9] = {c + x * x * v,	  x * y * v - z * s, x * z * v + y * s, y * x * v + z * s, c + y * y * v,
		       y * z * v - x * s, z * x * v - y * s, z * y * v + x * s, c + z * z * v};
	double old[9];
	memcpy(old, r, sizeof(old));
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++)
			r[3 * i + j] = e[3 * i] * old[j] + e[3 * i + 1] * old[3 + j] + e[3 * i + 2] * old[6 + j];
}

/* Unknowns: rotation vector, translation, half side, yaw of each marker. A white border that blooms makes the black
 * square look smaller than it is, by up to 5 %: the side as seen is none of the pose's business. */
static void move(struct problem *p, const double *step)
{
	rotate(p->camera.pose.r, step);
	for (int i = 0; i < 3; i++)
		p->camera.pose.t[i] += step[3 + i];
	p->half += step[SIDE];
	for (int i = 0; i < p->count; i++)
		p->marker[i].yaw += step[FIRST_YAW + i];
}

/* Normal equations at the present estimate. */
static bool linearise(const struct problem *p, const double *res, double *ata, double *atb)
{
	int n = FIRST_YAW + p->count, rows = 8 * p->count;
	double jac[UNKNOWN_MAX][8 * MARKER_MAX];
	for (int u = 0; u < n; u++) {
		double step[UNKNOWN_MAX] = {0}, h = u >= 3 && u <= SIDE ? STEP_LENGTH : STEP_ROTATION;
		step[u] = h;
		struct problem q = *p;
		move(&q, step);
		if (!isfinite(residuals(&q, jac[u])))
			return false;
		for (int r = 0; r < rows; r++)
			jac[u][r] = (jac[u][r] - res[r]) / h;
	}
	for (int a = 0; a < n; a++) {
		atb[a] = 0;
		for (int r = 0; r < rows; r++)
			atb[a] -= jac[a][r] * res[r];
		for (int b = 0; b < n; b++) {
			ata[a * n + b] = 0;
			for (int r = 0; r < rows; r++)
				ata[a * n + b] += jac[a][r] * jac[b][r];
		}
	}
	return true;
}

/* Levenberg-Marquardt. */
static double refine(struct problem *p)
{
	int n = FIRST_YAW + p->count;
	double res[8 * MARKER_MAX], damping = 1e-3, cost = residuals(p, res);
	for (int s = 0; s < STEP_MAX && isfinite(cost) && damping < 1e12; s++) {
		double ata[UNKNOWN_MAX * UNKNOWN_MAX], atb[UNKNOWN_MAX];
		if (!linearise(p, res, ata, atb))
			return INFINITY;
		for (int i = 0; i < n; i++)
			ata[i * n + i] *= 1 + damping;
		struct problem q = *p;
		if (!solve_spd(ata, atb, n))
			return INFINITY;
		move(&q, atb);
		double qres[8 * MARKER_MAX], qcost = residuals(&q, qres);
		if (!(qcost < cost)) {
			damping *= 10;
			continue;
		}
		bool done = cost - qcost < 1e-12 * cost;
		*p = q;
		memcpy(res, qres, sizeof(res));
		cost = qcost;
		damping *= 0.1;
		if (done)
			break;
	}
	return cost;
}

/* Affine map table -> normalised image by least squares over the centres: m[0..2] for x, m[3..5] for y. */
static bool affine(const struct problem *p, double m[6])
{
	for (int axis = 0; axis < 2; axis++) {
		double a[9] = {0}, b[3] = {0};
		for (int i = 0; i < p->count; i++) {
			vec2 c = p->marker[i].centre, s = seen_centre(&p->marker[i]);
			double row[3] = {c.x, c.y, 1};
			double v = axis ? (s.y - p->camera.in.cy) / p->camera.in.fy
					: (s.x - p->camera.in.cx) / p->camera.in.fx;
			for (int j = 0; j < 3; j++) {
				b[j] += row[j] * v;
				for (int k = 0; k < 3; k++)
					a[3 * j + k] += row[j] * row[k];
			}
		}
		for (int j = 0; j < 3; j++)
			a[4 * j] += 1e-12;
		if (!solve_spd(a, b, 3))
			return false;
		memcpy(m + 3 * axis, b, sizeof(b));
	}
	return true;
}

/* Start: a camera that looks straight down, scaled and turned like the affine map. The image's y axis runs against the
 * table's, so the map must be a reflection. */
static bool start(struct problem *p)
{
	double m[6];
	if (!affine(p, m))
		return false;
	double det = m[0] * m[4] - m[1] * m[3];
	if (!(det < -1e-9))
		return false;
	double depth = 1 / sqrt(-det), angle = atan2(m[3] + m[1], m[0] - m[4]);
	double c = cos(angle), s = sin(angle);
	double r[9] = {c, s, 0, s, -c, 0, 0, 0, -1};
	memcpy(p->camera.pose.r, r, sizeof(r));
	p->camera.pose.t[0] = m[2] * depth;
	p->camera.pose.t[1] = m[5] * depth;
	p->camera.pose.t[2] = depth + p->height;
	for (int i = 0; i < p->count; i++) {
		struct placed *k = &p->marker[i];
		vec2 along = vec2_add(vec2_sub(seen_corner(k, 1), seen_corner(k, 0)),
				      vec2_sub(seen_corner(k, 2), seen_corner(k, 3)));
		k->yaw = atan2(s * along.x - c * along.y, c * along.x + s * along.y);
	}
	return true;
}

static double plane_residual(const struct problem *p)
{
	double sum = 0;
	for (int i = 0; i < p->count; i++)
		for (int k = 0; k < 4; k++) {
			vec2 pos;
			if (!camera_unproject(&p->camera, seen_corner(&p->marker[i], k), p->height, &pos))
				return INFINITY;
			sum += vec2_norm2(vec2_sub(pos, corner_on_table(p, &p->marker[i], k)));
		}
	return sqrt(sum / (4 * p->count));
}

bool pose_from_markers(const struct marker_layout *layout, const struct marker_view *view, int count,
		       struct camera *camera, struct pose_fit *fit)
{
	struct problem p = {.camera = *camera};
	if (!gather(layout, view, count, &p) || !start(&p))
		return false;
	double cost = refine(&p);
	double px = sqrt(cost / (4 * p.count));
	if (!(px < WORST_RESIDUAL_PX * camera->in.width / 1280))
		return false;
	*camera = p.camera;
	*fit = (struct pose_fit){px, plane_residual(&p)};
	return true;
}
