#include <math.h>

#include "app/virtual/table_camera_state.h"

/* Arm and cue are capsules parallel to the bed: each pixel's ray is cut with the plane of their height. */

struct limb {
	vec2 from, to; /* m */
	double radius; /* m */
	double height; /* m above the bed */
	float grey[3]; /* red, green, blue, grey levels under full light */
};

struct span {
	int x0, y0, x1, y1; /* px, the last ones outside */
};

static const double CUE_LENGTH = 1.45, CUE_RADIUS = 0.006, CUE_HEIGHT = 0.045; /* m */
static const double HAND_RADIUS = 0.045, HAND_HEIGHT = 0.045, FINGERS = 0.06;  /* m */
static const double SLEEVE_RADIUS = 0.05, SLEEVE_HEIGHT = 0.12;		       /* m */
static const double SHADOW_SOFT = 0.02;					       /* m, half width of the penumbra */
static const float SHADOW = 0.42f;					       /* light lost in its middle */

static double from_segment(const struct limb *limb, vec2 p)
{
	vec2 way = vec2_sub(limb->to, limb->from), to = vec2_sub(p, limb->from);
	double length2 = vec2_dot(way, way), t = length2 > 0 ? fmax(0, fmin(1, vec2_dot(to, way) / length2)) : 0;
	return vec2_dist(to, vec2_madd((vec2){0, 0}, t, way));
}

/* Pixels that may show the capsule when it lies that high. */
static struct span span_of(const struct table_camera *camera, const struct limb *limb, double height, double more)
{
	int width = camera->camera.in.width, rows = camera->camera.in.height;
	double x0 = width, y0 = rows, x1 = -1, y1 = -1, r = limb->radius + more;
	for (int k = 0; k < 8; k++) {
		vec2 end = k & 4 ? limb->to : limb->from, at = {end.x + (k & 1 ? r : -r), end.y + (k & 2 ? r : -r)}, px;
		if (!camera_project(&camera->camera, at, height, &px))
			return (struct span){0};
		x0 = fmin(x0, px.x), y0 = fmin(y0, px.y), x1 = fmax(x1, px.x), y1 = fmax(y1, px.y);
	}
	return (struct span){(int)fmin(width, fmax(0, floor(x0))), (int)fmin(rows, fmax(0, floor(y0))),
			     (int)fmax(0, fmin(width, ceil(x1) + 1)), (int)fmax(0, fmin(rows, ceil(y1) + 1))};
}

static vec2 cloth_of(const struct table_camera *camera, int i)
{
	return (vec2){camera->cloth[2 * i], camera->cloth[2 * i + 1]};
}

/* The point of that height on the way from a point of the bed to one above the table. */
static vec2 raised(vec2 p, const double above[3], double height)
{
	return vec2_madd(p, height / above[2], vec2_sub((vec2){above[0], above[1]}, p));
}

static void draw_limb_shadow(struct table_camera *camera, const struct limb *limb)
{
	const double *lamp = camera->lamp_at;
	double k = limb->height / lamp[2];
	struct limb fallen = *limb;
	fallen.from = vec2_madd((vec2){0, 0}, 1 / (1 - k), vec2_madd(limb->from, -k, (vec2){lamp[0], lamp[1]}));
	fallen.to = vec2_madd((vec2){0, 0}, 1 / (1 - k), vec2_madd(limb->to, -k, (vec2){lamp[0], lamp[1]}));
	struct span span = span_of(camera, &fallen, 0, 2 * SHADOW_SOFT);
	for (int y = span.y0; y < span.y1; y++)
		for (int x = span.x0; x < span.x1; x++) {
			int i = y * camera->camera.in.width + x;
			double d = from_segment(limb, raised(cloth_of(camera, i), lamp, limb->height));
			double inside = (limb->radius + SHADOW_SOFT - d) / (2 * SHADOW_SOFT);
			if (inside <= 0)
				continue;
			float left = 1 - SHADOW * (float)fmin(1, inside) * (float)fmin(1, limb->radius / SHADOW_SOFT);
			for (int c = 0; c < 3; c++)
				camera->work[3 * i + c] = (uint16_t)((float)camera->work[3 * i + c] * left);
		}
}

static void draw_limb(struct table_camera *camera, const struct limb *limb)
{
	const double *eye = camera->scene.eye;
	double pixel = (eye[2] - limb->height) / camera->camera.in.fx; /* m */
	struct span span = span_of(camera, limb, limb->height, 2 * pixel);
	for (int y = span.y0; y < span.y1; y++)
		for (int x = span.x0; x < span.x1; x++) {
			int i = y * camera->camera.in.width + x;
			double d = from_segment(limb, raised(cloth_of(camera, i), eye, limb->height));
			float share = (float)fmax(0, fmin(1, (limb->radius - d) / pixel + 0.5));
			if (share <= 0)
				continue;
			double across = fmin(1, d / limb->radius);
			float light =
				table_camera_gain(camera, x, y) * (float)(0.55 + 0.45 * sqrt(1 - across * across));
			for (int c = 0; c < 3; c++) {
				uint16_t *level = &camera->work[3 * i + 2 - c];
				float sum = (1 - share) * (float)*level +
					    share * LEVEL * light * table_camera_linear(limb->grey[c]);
				*level = (uint16_t)fminf(LEVEL_MAX, sum);
			}
		}
}

void table_camera_draw_arm(struct table_camera *camera, const struct table_arm *arm)
{
	struct limb limb[3];
	int n = 0;
	if (arm->cue && vec2_dist(arm->bridge, arm->tip) > 0) {
		vec2 back = vec2_unit(vec2_sub(arm->bridge, arm->tip));
		limb[n++] = (struct limb){
			arm->tip, vec2_madd(arm->tip, CUE_LENGTH, back), CUE_RADIUS, CUE_HEIGHT, {215, 175, 115}};
	}
	if (arm->hand) {
		vec2 way = vec2_sub(arm->bridge, arm->elbow);
		vec2 tips = vec2_norm(way) > 0 ? vec2_madd(arm->bridge, FINGERS / vec2_norm(way), way) : arm->bridge;
		limb[n++] = (struct limb){arm->bridge, tips, HAND_RADIUS, HAND_HEIGHT, {205, 150, 120}};
		limb[n++] = (struct limb){arm->elbow, arm->bridge, SLEEVE_RADIUS, SLEEVE_HEIGHT, {44, 46, 62}};
	}
	for (int i = 0; i < n; i++)
		draw_limb_shadow(camera, &limb[i]);
	for (int i = 0; i < n; i++)
		draw_limb(camera, &limb[i]);
}
