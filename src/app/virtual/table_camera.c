#include "app/virtual/table_camera.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/virtual/table_camera_state.h"

enum { SAMPLES = 8 }; /* across a pixel on edges of the still scene */
static const double PI = 3.14159265358979323846;
static const float VIGNETTE = 0.25f; /* light lost in the picture's corners */
static const double FAR = 1000;	     /* m: rays that miss the plane of the bed */
/* Lamps, as shares of the table's length: projector and lamp of the thesis' room throw shadows to +y and to the left.
 */
static const double PROJECTOR_AT[3] = {-0.05, -0.65, 1.0}, LAMP_AT[3] = {0.16, 0.06, 1.25};
static const float GAMMA = 2.2f; /* of the sRGB curve, about */
/* The projector's white on green cloth, by colour. */
static const float PROJECTOR_WHITE[3] = {0.75f, 1.0f, 1.1f};

/* ---- geometry ---- */

static void multiply(const double a[9], const double b[9], double out[9])
{
	for (int i = 0; i < 9; i++)
		out[i] = a[i / 3 * 3] * b[i % 3] + a[i / 3 * 3 + 1] * b[i % 3 + 3] + a[i / 3 * 3 + 2] * b[i % 3 + 6];
}

/* Looks straight down with +x to the right, then turned about its own x and y axes. */
static struct camera_pose pose_of(const struct config_virtual *def, double marker_height)
{
	double cx = cos(def->camera_tilt_x), sx = sin(def->camera_tilt_x), cy = cos(def->camera_tilt_y),
	       sy = sin(def->camera_tilt_y);
	const double down[9] = {1, 0, 0, 0, -1, 0, 0, 0, -1};
	const double about_x[9] = {1, 0, 0, 0, cx, -sx, 0, sx, cx}, about_y[9] = {cy, 0, sy, 0, 1, 0, -sy, 0, cy};
	const double eye[3] = {def->camera_x, def->camera_y, def->camera_height + marker_height};
	double tilted[9];
	struct camera_pose pose;
	multiply(about_x, down, tilted);
	multiply(about_y, tilted, pose.r);
	for (int i = 0; i < 3; i++)
		pose.t[i] = -(pose.r[3 * i] * eye[0] + pose.r[3 * i + 1] * eye[1] + pose.r[3 * i + 2] * eye[2]);
	return pose;
}

/* Place of the projector's picture that lights a point. */
static vec2 spot_of(const struct table_camera *camera, vec2 at, double height)
{
	const double *h = camera->projector.homography, *from = camera->projector_at;
	double k = from[2] / (from[2] - height);
	vec2 p = {from[0] + k * (at.x - from[0]), from[1] + k * (at.y - from[1])};
	double w = h[6] * p.x + h[7] * p.y + h[8];
	if (!(w > 1e-9))
		return (vec2){-1, -1};
	/* Cairo counts from a pixel's corner, samples are taken between its middles */
	return (vec2){(h[0] * p.x + h[1] * p.y + h[2]) / w - 0.5, (h[3] * p.x + h[4] * p.y + h[5]) / w - 0.5};
}

float table_camera_linear(float grey)
{
	float x = grey / 255;
	return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

float table_camera_gain(const struct table_camera *camera, int x, int y)
{
	float w = (float)camera->camera.in.width / 2, h = (float)camera->camera.in.height / 2;
	float dx = ((float)x - w) / w, dy = ((float)y - h) / h;
	return (float)camera->def.exposure * (1 - VIGNETTE * (dx * dx + dy * dy) / 2);
}

/* ---- the still scene ---- */

static void map_cloth(struct table_camera *camera)
{
	int width = camera->camera.in.width, height = camera->camera.in.height;
	for (int i = 0; i < width * height; i++) {
		vec2 p;
		if (!camera_unproject(&camera->camera, (vec2){i % width, i / width}, 0, &p) || vec2_norm(p) > FAR)
			p = (vec2){FAR, FAR};
		camera->cloth[2 * i] = (float)p.x;
		camera->cloth[2 * i + 1] = (float)p.y;
	}
}

struct footprint {
	vec2 at, right, down; /* middle of a pixel on z = 0, and the way to the next pixels */
};

static vec2 cloth_at(const struct table_camera *camera, int x, int y)
{
	const float *p = &camera->cloth[2 * (y * camera->camera.in.width + x)];
	return (vec2){p[0], p[1]};
}

static struct footprint footprint_of(const struct table_camera *camera, int x, int y)
{
	int last_x = camera->camera.in.width - 1, last_y = camera->camera.in.height - 1;
	int x0 = x < last_x ? x : x - 1, y0 = y < last_y ? y : y - 1;
	return (struct footprint){cloth_at(camera, x, y),
				  vec2_sub(cloth_at(camera, x0 + 1, y), cloth_at(camera, x0, y)),
				  vec2_sub(cloth_at(camera, x, y0 + 1), cloth_at(camera, x, y0))};
}

static vec2 within(const struct footprint *f, double u, double v)
{
	return vec2_madd(vec2_madd(f->at, u, f->right), v, f->down);
}

static bool is_plain(const struct table_scene *scene, const struct footprint *f, enum surface middle)
{
	for (int k = 0; k < 4; k++)
		if (table_scene_surface(scene, within(f, k % 2 - 0.5, k / 2 - 0.5)) != middle)
			return false;
	return true;
}

static void add_light(const struct table_scene *scene, vec2 p, enum surface surface, float weight, float light[3])
{
	float rgb[3];
	table_scene_colour(scene, p, surface, rgb);
	for (int c = 0; c < 3; c++)
		light[c] += weight * table_camera_linear(rgb[c]);
}

static void mean_light(const struct table_scene *scene, const struct footprint *f, float light[3])
{
	for (int k = 0; k < SAMPLES * SAMPLES; k++) {
		vec2 p = within(f, (k % SAMPLES + 0.5) / SAMPLES - 0.5, (k / SAMPLES + 0.5) / SAMPLES - 0.5);
		add_light(scene, p, table_scene_surface(scene, p), 1.0f / (SAMPLES * SAMPLES), light);
	}
}

static uint16_t to_level(float light)
{
	float level = light * LEVEL + 0.5f;
	return level >= LEVEL_MAX ? LEVEL_MAX : level <= 0 ? 0 : (uint16_t)level;
}

static void paint_pixel(struct table_camera *camera, int x, int y)
{
	int i = y * camera->camera.in.width + x;
	struct footprint f = footprint_of(camera, x, y);
	enum surface surface = table_scene_surface(&camera->scene, f.at);
	float light[3] = {0, 0, 0}, gain = table_camera_gain(camera, x, y);
	vec2 at;
	if (is_plain(&camera->scene, &f, surface))
		add_light(&camera->scene, f.at, surface, 1, light);
	else
		mean_light(&camera->scene, &f, light);
	for (int c = 0; c < 3; c++)
		camera->base[3 * i + 2 - c] = to_level(gain * light[c]);
	double height = table_scene_meet(&camera->scene, f.at, surface, &at);
	vec2 spot = spot_of(camera, at, height);
	camera->surface[i] = (uint8_t)surface;
	camera->spot[2 * i] = (float)fmax(-1e6, fmin(1e6, spot.x));
	camera->spot[2 * i + 1] = (float)fmax(-1e6, fmin(1e6, spot.y));
}

/* ---- the projector's picture ---- */

static void unpack(uint32_t pixel, float weight, float rgb[3])
{
	for (int c = 0; c < 3; c++)
		rgb[c] += weight * (float)(pixel >> (16 - 8 * c) & 255) / 255;
}

/* Bilinear; false where the picture is black or ends. */
static bool sample(const struct shown_picture *picture, float x, float y, float rgb[3])
{
	if (!(x >= 0 && y >= 0 && x < (float)(picture->width - 1) && y < (float)(picture->height - 1)))
		return false;
	int i = (int)x, j = (int)y;
	float u = x - (float)i, v = y - (float)j;
	const uint32_t *p = &picture->pixels[j * picture->width + i], *q = p + picture->width;
	if (!((p[0] | p[1] | q[0] | q[1]) & 0xffffff))
		return false;
	rgb[0] = rgb[1] = rgb[2] = 0;
	unpack(p[0], (1 - u) * (1 - v), rgb);
	unpack(p[1], u * (1 - v), rgb);
	unpack(q[0], (1 - u) * v, rgb);
	unpack(q[1], u * v, rgb);
	for (int c = 0; c < 3; c++)
		rgb[c] *= PROJECTOR_WHITE[c];
	return true;
}

void table_camera_picture_at(const struct table_camera *camera, vec2 at, double height, float rgb[3])
{
	rgb[0] = rgb[1] = rgb[2] = 0;
	if (camera->picture.dark)
		return;
	vec2 spot = spot_of(camera, at, height);
	if (sample(&camera->picture, (float)spot.x, (float)spot.y, rgb))
		for (int c = 0; c < 3; c++)
			rgb[c] *= (float)camera->def.projector_light;
}

/* Full white makes the table's grey levels larger by projector_light of what the room's light makes them. */
static void light_table(struct table_camera *camera)
{
	size_t count = (size_t)camera->camera.in.width * (size_t)camera->camera.in.height;
	float share = (float)camera->def.projector_light;
	memcpy(camera->lit, camera->base, 3 * count * sizeof(*camera->lit));
	if (camera->picture.dark)
		return;
	for (size_t i = 0; i < count; i++) {
		float rgb[3];
		if (!sample(&camera->picture, camera->spot[2 * i], camera->spot[2 * i + 1], rgb))
			continue;
		for (size_t c = 0; c < 3; c++)
			camera->lit[3 * i + 2 - c] =
				to_level((float)camera->base[3 * i + 2 - c] / LEVEL * powf(1 + share * rgb[c], GAMMA));
	}
}

void table_camera_light(struct table_camera *camera, const uint32_t *pixels, int width, int height, int stride)
{
	camera->picture.dark = pixels == NULL;
	if (pixels) {
		assert(width == camera->picture.width && height == camera->picture.height && stride >= 4 * width);
		for (int y = 0; y < height; y++)
			memcpy(camera->picture.pixels + (ptrdiff_t)y * width,
			       (const char *)pixels + (ptrdiff_t)y * stride, (size_t)width * 4);
	}
	light_table(camera);
}

/* ---- sensor ---- */

static uint64_t mix(uint64_t z)
{
	z += 0x9e3779b97f4a7c15u;
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return z ^ (z >> 31);
}

/* Box and Muller. */
static void fill_noise(struct table_camera *camera)
{
	double sigma = camera->def.noise * GREY;
	for (uint64_t i = 0; i < NOISE_COUNT; i += 2) {
		double u = ((double)(mix(camera->def.seed ^ i) >> 11) + 1) * 0x1p-53;
		double v = (double)(mix(camera->def.seed ^ (i + 1)) >> 11) * 0x1p-53, r = sigma * sqrt(-2 * log(u));
		camera->noise[i] = (int16_t)fmax(-32000, fmin(32000, r * cos(2 * PI * v)));
		camera->noise[i + 1] = (int16_t)fmax(-32000, fmin(32000, r * sin(2 * PI * v)));
	}
}

/* The lens spreads a point over 1 2 1 / 4 pixels both ways; column holds the row already spread downwards, in LEVEL
 * * 4. */
static void blur_down(const uint16_t *above, const uint16_t *row, const uint16_t *below, int count, uint32_t *column)
{
	for (int i = 0; i < count; i++)
		column[i] = (uint32_t)above[i] + 2u * row[i] + below[i];
}

static void fill_grey(struct table_camera *camera)
{
	for (int i = 0; i <= LEVEL; i++) {
		float x = (float)i / LEVEL;
		float y = x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f;
		camera->grey[i] = (uint16_t)(255 * GREY * y + 0.5f);
	}
}

static uint8_t to_byte(int grey)
{
	int rounded = (grey + GREY / 2) / GREY;
	return grey < 0 ? 0 : rounded > 255 ? 255 : (uint8_t)rounded;
}

enum { GAIN = 256 }; /* 1 */

static void expose_row(const struct table_camera *camera, unsigned at, uint8_t *out)
{
	const uint32_t *column = camera->column;
	int count = 3 * camera->camera.in.width;
	uint32_t gain = (uint32_t)(GAIN * camera->disturbance.gain + 0.5);
	for (int i = 0; i < count; i++) {
		uint32_t left = column[i < 3 ? i : i - 3], right = column[i >= count - 3 ? i : i + 3];
		uint32_t level = (left + 2 * column[i] + right) / 16 * gain / GAIN;
		int grey = camera->grey[level < LEVEL ? level : LEVEL];
		out[i] = to_byte(grey + camera->noise[(at + (unsigned)i) % NOISE_COUNT]);
	}
}

static void expose(const struct table_camera *camera, uint64_t frame, struct image *out)
{
	int width = camera->camera.in.width, height = camera->camera.in.height;
	ptrdiff_t step = 3 * (ptrdiff_t)width;
	for (int y = 0; y < height; y++) {
		const uint16_t *row = camera->work + y * step;
		blur_down(y > 0 ? row - step : row, row, y < height - 1 ? row + step : row, 3 * width, camera->column);
		unsigned at = (unsigned)mix(camera->def.seed ^ mix(frame * 8192 + (uint64_t)y)) % NOISE_COUNT;
		expose_row(camera, at, out->data + y * out->stride);
	}
}

/* A camera that was turned a little shows nearly the same picture elsewhere. Its edge is repeated. */
static void shift(const struct table_camera *camera, struct image *out)
{
	int dx = camera->disturbance.shift_x, dy = camera->disturbance.shift_y, width = out->width,
	    height = out->height;
	for (int k = 0; (dx || dy) && k < height; k++) {
		int y = dy > 0 ? height - 1 - k : k, from = y - dy < 0 ? 0 : y - dy >= height ? height - 1 : y - dy;
		uint8_t *row = out->data + y * out->stride;
		const uint8_t *source = out->data + from * out->stride;
		int n = width - abs(dx);
		memmove(row + (dx > 0 ? 3 * dx : 0), source + (dx < 0 ? -3 * dx : 0), 3 * (size_t)n);
	}
}

void table_camera_disturb(struct table_camera *camera, const struct table_disturbance *disturbance)
{
	camera->disturbance = disturbance ? *disturbance : (struct table_disturbance){.gain = 1};
	assert(camera->disturbance.gain >= 0 && camera->disturbance.gain <= 32);
	assert(abs(camera->disturbance.shift_x) <= 64 && abs(camera->disturbance.shift_y) <= 64);
}

void table_camera_render(struct table_camera *camera, const struct ball *ball, int count, uint64_t frame,
			 struct image *out)
{
	int width = camera->camera.in.width, height = camera->camera.in.height;
	assert(out->width == width && out->height == height && out->stride >= 3 * width);
	assert(count >= 0 && count <= BALL_MAX);
	memcpy(camera->work, camera->lit, 3 * (size_t)width * (size_t)height * sizeof(*camera->work));
	table_camera_draw_balls(camera, ball, count);
	table_camera_draw_arm(camera, &camera->disturbance.arm);
	expose(camera, frame, out);
	shift(camera, out);
}

/* ---- life ---- */

static int check(const struct config *config, char *err, size_t err_size)
{
	const char *reason = NULL;
	const struct config_virtual *v = &config->virtual_table;
	if (config->camera.width < 2 || config->camera.height < 2 || config->camera.width > 8192 ||
	    config->camera.height > 8192)
		reason = "camera: width and height must be 2 to 8192 px";
	else if (!(config->camera.fx > 0 && config->camera.fy > 0))
		reason = "camera: fx and fy must be positive";
	else if (!(v->camera_height > 0.1 && v->exposure > 0 && v->noise >= 0 && v->projector_light >= 0))
		reason = "virtual_table: camera_height, exposure, noise or projector_light out of range";
	else if (config->projector.width < 1 || config->projector.height < 1 || config->projector.width > 8192 ||
		 config->projector.height > 8192)
		reason = "projector: width and height must be 1 to 8192 px";
	if (!reason)
		return 0;
	snprintf(err, err_size, "%s", reason);
	return -EINVAL;
}

static bool take_memory(struct table_camera *camera)
{
	size_t count = (size_t)camera->camera.in.width * (size_t)camera->camera.in.height;
	struct shown_picture *picture = &camera->picture;
	camera->cloth = malloc(2 * count * sizeof(*camera->cloth));
	camera->spot = malloc(2 * count * sizeof(*camera->spot));
	camera->surface = malloc(count);
	camera->base = malloc(3 * count * sizeof(*camera->base));
	camera->lit = malloc(3 * count * sizeof(*camera->lit));
	camera->work = malloc(3 * count * sizeof(*camera->work));
	camera->column = malloc(3 * (size_t)camera->camera.in.width * sizeof(*camera->column));
	camera->grey = malloc((LEVEL + 1) * sizeof(*camera->grey));
	camera->noise = malloc(NOISE_COUNT * sizeof(*camera->noise));
	picture->pixels = malloc((size_t)picture->width * (size_t)picture->height * 4);
	return camera->cloth && camera->spot && camera->surface && camera->base && camera->lit && camera->work &&
	       camera->column && camera->grey && camera->noise && picture->pixels;
}

static void set_up(struct table_camera *camera, const struct config *config)
{
	camera->table = config->table;
	camera->projector = config->projector;
	camera->disturbance.gain = 1;
	camera->def = config->virtual_table;
	camera->camera = (struct camera){config->camera, pose_of(&config->virtual_table, config->markers.height)};
	camera->picture = (struct shown_picture){
		.width = config->projector.width, .height = config->projector.height, .dark = true};
	for (int i = 0; i < 3; i++) {
		camera->projector_at[i] = PROJECTOR_AT[i] * config->table.length;
		camera->lamp_at[i] = LAMP_AT[i] * config->table.length;
	}
}

int table_camera_create(struct table_camera **out, const struct config *config, char *err, size_t err_size)
{
	*out = NULL;
	int status = check(config, err, err_size);
	if (status < 0)
		return status;
	struct table_camera *camera = calloc(1, sizeof(*camera));
	if (!camera)
		goto no_memory;
	set_up(camera, config);
	double eye[3];
	camera_centre(&camera->camera, eye);
	status = table_scene_init(&camera->scene, &camera->table, &config->markers, eye, err, err_size);
	if (status < 0) {
		table_camera_destroy(camera);
		return status;
	}
	if (!take_memory(camera))
		goto no_memory;
	map_cloth(camera);
	for (int i = 0; i < camera->camera.in.width * camera->camera.in.height; i++)
		paint_pixel(camera, i % camera->camera.in.width, i / camera->camera.in.width);
	fill_grey(camera);
	fill_noise(camera);
	light_table(camera);
	*out = camera;
	return 0;
no_memory:
	table_camera_destroy(camera);
	snprintf(err, err_size, "no memory for the virtual camera");
	return -ENOMEM;
}

void table_camera_destroy(struct table_camera *camera)
{
	if (!camera)
		return;
	free(camera->cloth);
	free(camera->spot);
	free(camera->surface);
	free(camera->base);
	free(camera->lit);
	free(camera->work);
	free(camera->column);
	free(camera->grey);
	free(camera->noise);
	free(camera->picture.pixels);
	free(camera);
}

const struct camera *table_camera_truth(const struct table_camera *camera)
{
	return &camera->camera;
}
