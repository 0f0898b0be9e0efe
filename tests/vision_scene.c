#include "vision_scene.h"

#include <math.h>
#include <string.h>

#include "vision/marker_image_cv.h"

enum { SUB = 4 }; /* samples a side of a pixel */
static const uint8_t CLOTH[3] = {120, 150, 95}, AROUND[3] = {30, 40, 90};

struct table scene_table(void)
{
	struct table table = {.length = 1.881, .width = 0.943, .ball_radius = 0.02615, .pocket_count = 6};
	for (int i = 0; i < 6; i++)
		table.pocket[i] = (struct pocket){
			.centre = {(i % 3 - 1) * 0.9405, (i / 3 * 2 - 1) * (i % 3 == 1 ? 0.4915 : 0.4715)},
			.radius = 0.05};
	return table;
}

struct marker_layout scene_markers(void)
{
	return (struct marker_layout){
		.dictionary_count = 4,
		.dictionary_bits = 3,
		.side = 0.05,
		.height = 0.0381,
		.count = 4,
		.marker = {{0, {-0.8615, -0.543}}, {1, {0.8605, -0.543}}, {2, {0.8605, 0.541}}, {3, {-0.8615, 0.542}}}};
}

struct camera scene_camera(double tilt_x, double tilt_y)
{
	double cx = cos(tilt_x), sx = sin(tilt_x), cy = cos(tilt_y), sy = sin(tilt_y);
	/* Looking down, image x along table x: diag(1, -1, -1), then turned about the camera's own axes. */
	double r[9] = {cy, sx * sy, -cx * sy, 0, -cx, -sx, -sy, sx * cy, -cx * cy};
	struct camera camera = {.in = {1280, 720, 917.126, 917.236, 649.895, 359.575, 0, 0, 0, 0, 0}};
	memcpy(camera.pose.r, r, sizeof(r));
	for (int i = 0; i < 3; i++)
		camera.pose.t[i] = -r[3 * i + 2] * 1.57;
	return camera;
}

/* Colour of the ray through a pixel: the nearest sphere it meets, or the bed. */
static const uint8_t *trace(const struct camera *camera, const struct table *table, const struct scene_ball *ball,
			    int count, vec2 px)
{
	double eye[3], ray[3], best = INFINITY;
	vec2 floor;
	const uint8_t *colour = AROUND;
	camera_centre(camera, eye);
	if (!camera_unproject(camera, px, 0, &floor))
		return AROUND;
	ray[0] = floor.x - eye[0], ray[1] = floor.y - eye[1], ray[2] = -eye[2];
	if (fabs(floor.x) < table->length / 2 + 0.02 && fabs(floor.y) < table->width / 2 + 0.02)
		colour = CLOTH;
	for (int i = 0; i < count; i++) {
		double d[3] = {ball[i].pos.x - eye[0], ball[i].pos.y - eye[1], table->ball_radius - eye[2]};
		double dr = d[0] * ray[0] + d[1] * ray[1] + d[2] * ray[2],
		       rr = ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2];
		double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
		double under = dr * dr - rr * (dd - table->ball_radius * table->ball_radius);
		if (under > 0 && dr / rr < best) {
			best = dr / rr;
			colour = ball[i].bgr;
		}
	}
	return colour;
}

double scene_gauss(struct random *random)
{
	double u = random_in(random, 1e-12, 1), v = random_in(random, 0, 6.283185307179586);
	return sqrt(-2 * log(u)) * cos(v);
}

static bool near_ball(const struct camera *camera, const struct table *table, const struct scene_ball *ball, int count,
		      vec2 px)
{
	for (int i = 0; i < count; i++) {
		vec2 p;
		if (camera_project(camera, ball[i].pos, table->ball_radius, &p) && vec2_dist(p, px) < 24)
			return true;
	}
	return false;
}

void scene_paint(const struct camera *camera, const struct table *table, const struct scene_ball *ball, int count,
		 double noise, struct random *random, struct image_buffer *out)
{
	ck_assert_int_eq(image_buffer_reserve(out, camera->in.width, camera->in.height), 0);
	for (int y = 0; y < camera->in.height; y++)
		for (int x = 0; x < camera->in.width; x++) {
			double sum[3] = {0};
			/* Only rims need more than one sample. */
			int sub = near_ball(camera, table, ball, count, (vec2){x, y}) ? SUB : 1;
			for (int i = 0; i < sub * sub; i++) {
				vec2 px = {x + (i % sub + 0.5) / sub - 0.5, y + (i / sub + 0.5) / sub - 0.5};
				const uint8_t *c = trace(camera, table, ball, count, px);
				for (int k = 0; k < 3; k++)
					sum[k] += c[k] / (double)(sub * sub);
			}
			for (int k = 0; k < 3; k++) {
				double v = sum[k] + (noise > 0 ? noise * scene_gauss(random) : 0);
				out->image.data[y * out->image.stride + 3 * x + k] =
					(uint8_t)fmin(fmax(v + 0.5, 0), 255);
			}
		}
}

/* Share of a marker that is white at u, v in -1..1 of its black square; paper reaches to 1.45. */
static int marker_white(const uint8_t *bits, int side, double u, double v)
{
	if (fabs(u) > 1 || fabs(v) > 1)
		return 1;
	int cells = side + 2, cx = (int)((u + 1) / 2 * cells), cy = (int)((v + 1) / 2 * cells);
	if (cx < 1 || cy < 1 || cx > side || cy > side)
		return 0;
	return bits[(cy - 1) * side + cx - 1] != 0;
}

void scene_paint_markers(const struct camera *camera, const struct marker_layout *layout, struct image_buffer *out)
{
	double half = layout->side / 2;
	int side = layout->dictionary_bits;
	for (int m = 0; m < layout->count; m++) {
		uint8_t bits[MARKER_BITS_MAX * MARKER_BITS_MAX];
		ck_assert(marker_bits(layout->dictionary_count, side, layout->marker[m].id, bits));
		vec2 mid;
		ck_assert(camera_project(camera, layout->marker[m].centre, layout->height, &mid));
		for (int y = (int)mid.y - 30; y <= (int)mid.y + 30; y++)
			for (int x = (int)mid.x - 30; x <= (int)mid.x + 30; x++) {
				if (x < 0 || y < 0 || x >= out->image.width || y >= out->image.height)
					continue;
				int white = 0, inside = 0;
				for (int i = 0; i < 16; i++) {
					vec2 at, px = {x + (i % 4 + 0.5) / 4 - 0.5, y + (i / 4 + 0.5) / 4 - 0.5};
					camera_unproject(camera, px, layout->height, &at);
					double u = (at.x - layout->marker[m].centre.x) / half,
					       v = -(at.y - layout->marker[m].centre.y) / half;
					if (fabs(u) > 1.45 || fabs(v) > 1.45)
						continue;
					inside++;
					white += marker_white(bits, side, u, v);
				}
				if (inside == 16)
					memset(out->image.data + y * out->image.stride + 3 * x, 20 + white * 210 / 16,
					       3);
			}
	}
}
