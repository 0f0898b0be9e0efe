#include <assert.h>
#include <math.h>

#include "app/virtual/table_camera_state.h"

/* Balls are drawn from the farthest to the nearest; each pixel's ray is cut with the sphere itself. */

enum { RIM_SAMPLES = 8 };	       /* across a pixel on a ball's rim */
enum { BLUR_MAX = 16 };		       /* places that a moving ball is drawn at, at most */
static const double BLUR_STEP = 0.002; /* m */

struct vec3 {
	double x, y, z; /* m */
};

struct sphere {
	struct vec3 centre;
	double radius;
	float albedo[3]; /* red, green, blue: share of LEVEL under full light */
	float cloth[3];	 /* light of the cloth around it, shares of LEVEL */
	float room[3];	 /* the room's light at its place, linear */
	vec2 vel;	 /* m/s */
};

struct box {
	int x0, y0, x1, y1; /* px, the last ones outside */
};

/* Light on a ball: from everywhere, from the lamp, from the projector's black. */
static const float AMBIENT = 0.42f, LAMP = 0.42f, GLOW = 0.22f;
/* What of the cloth's light each source gives, by colour: it is missing in a ball's shadow. */
static const float LAMP_SHARE[3] = {0.50f, 0.48f, 0.42f}, GLOW_SHARE[3] = {0.24f, 0.34f, 0.46f};
static const double LAMP_SOFT = 0.10, GLOW_SOFT = 0.03;	   /* half width of the penumbra, in radii */
static const float CONTACT = 0.50f;			   /* light lost right at the foot */
static const double SHADOW_REACH = 3.2;			   /* radii */
static const float SHINE_LAMP = 0.75f, SHINE_GLOW = 0.40f; /* shares of LEVEL */
static const float SHINE_POWER = 420;
static const float MIRROR = 0.04f; /* of phenolic resin, seen from straight above */

/* ---- vectors ---- */

static struct vec3 sub(struct vec3 a, struct vec3 b)
{
	return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static struct vec3 madd(struct vec3 a, double k, struct vec3 b)
{
	return (struct vec3){a.x + k * b.x, a.y + k * b.y, a.z + k * b.z};
}

static double dot(struct vec3 a, struct vec3 b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct vec3 unit(struct vec3 a)
{
	double k = 1 / sqrt(dot(a, a));
	return (struct vec3){k * a.x, k * a.y, k * a.z};
}

static struct vec3 from_array(const double v[3])
{
	return (struct vec3){v[0], v[1], v[2]};
}

/* ---- shadows on the cloth ---- */

/* 0 in the light, 1 where the sphere hides the whole lamp. */
static double hidden(const struct sphere *sphere, struct vec3 p, struct vec3 lamp, double soft)
{
	struct vec3 way = sub(lamp, p), to = sub(sphere->centre, p);
	double along = dot(to, way), off2 = dot(to, to) - along * along / dot(way, way),
	       reach = (1 + soft) * sphere->radius;
	if (along <= 0 || off2 >= reach * reach)
		return 0;
	double t = fmin(1, (1 + soft - sqrt(fmax(0, off2)) / sphere->radius) / (2 * soft));
	return t * t * (3 - 2 * t);
}

static void shade_pixel(struct table_camera *camera, const struct sphere *sphere, int i)
{
	struct vec3 p = {camera->cloth[2 * i], camera->cloth[2 * i + 1], 0}, foot = sub(p, sphere->centre);
	double lamp = hidden(sphere, p, from_array(camera->lamp_at), LAMP_SOFT);
	double glow = hidden(sphere, p, from_array(camera->projector_at), GLOW_SOFT);
	double far = (foot.x * foot.x + foot.y * foot.y) / (sphere->radius * sphere->radius);
	float contact = far < 4 ? CONTACT * (float)((1 - far / 4) * (1 - far / 4)) : 0;
	if (lamp <= 0 && glow <= 0 && contact <= 0)
		return;
	for (int c = 0; c < 3; c++) {
		int k = 3 * i + 2 - c;
		if (camera->lit[k] == 0)
			continue;
		float base = (float)camera->base[k], picture = (float)(camera->lit[k] - camera->base[k]);
		float lost = (float)lamp * LAMP_SHARE[c] * base + (float)glow * (GLOW_SHARE[c] * base + picture);
		float left = 1 - lost / (float)camera->lit[k];
		camera->work[k] = (uint16_t)((float)camera->work[k] * left * (1 - contact));
	}
}

/* Pixels that may show any of the cube around the place; empty when it is out of the picture. */
static struct box box_around(const struct table_camera *camera, struct vec3 centre, double half, double half_z)
{
	int width = camera->camera.in.width, height = camera->camera.in.height;
	double x0 = width, y0 = height, x1 = -1, y1 = -1;
	for (int k = 0; k < 8; k++) {
		vec2 at = {centre.x + (k & 1 ? half : -half), centre.y + (k & 2 ? half : -half)}, px;
		if (!camera_project(&camera->camera, at, centre.z + (k & 4 ? half_z : -half_z), &px))
			return (struct box){0};
		x0 = fmin(x0, px.x), y0 = fmin(y0, px.y), x1 = fmax(x1, px.x), y1 = fmax(y1, px.y);
	}
	return (struct box){(int)fmin(width, fmax(0, floor(x0) - 1)), (int)fmin(height, fmax(0, floor(y0) - 1)),
			    (int)fmax(0, fmin(width, ceil(x1) + 2)), (int)fmax(0, fmin(height, ceil(y1) + 2))};
}

static void draw_shadow(struct table_camera *camera, const struct sphere *sphere)
{
	struct vec3 foot = {sphere->centre.x, sphere->centre.y, 0};
	struct box box = box_around(camera, foot, SHADOW_REACH * sphere->radius, 0);
	for (int y = box.y0; y < box.y1; y++)
		for (int x = box.x0; x < box.x1; x++) {
			int i = y * camera->camera.in.width + x;
			if (camera->surface[i] == SURFACE_BED || camera->surface[i] == SURFACE_UNDER_NOSE)
				shade_pixel(camera, sphere, i);
		}
}

/* ---- balls ---- */

/* Grey levels under full light; above 255 the sensor clips, as it does on the thesis' photographs. */
static const float ALBEDO[COLOUR_COUNT][3] = {
	[COLOUR_WHITE] = {300, 285, 255}, [COLOUR_RED] = {245, 8, 26},	  [COLOUR_YELLOW] = {300, 240, 26},
	[COLOUR_GREEN] = {14, 158, 166},  [COLOUR_BROWN] = {214, 64, 42}, [COLOUR_BLUE] = {8, 148, 232},
	[COLOUR_PINK] = {300, 145, 168},  [COLOUR_BLACK] = {46, 28, 40},  [COLOUR_UNKNOWN] = {160, 160, 160},
};

/* How much of the cloth a polished ball mirrors (Schlick): nothing in the middle, where it shows the dark room above,
 * nearly all at the rim. This is why dark balls look smaller than they are. */
static float mirror(struct vec3 normal, struct vec3 to_eye)
{
	double cosine = fmax(0, fmin(1, dot(normal, to_eye))), up = 2 * cosine * normal.z - to_eye.z;
	float k = 1 - (float)cosine, below = (float)fmax(0, fmin(1, 0.5 - 2 * up));
	return below * (MIRROR + (1 - MIRROR) * k * k * k * k * k);
}

/* Whether what the surface mirrors is a pocket. At the rim that is what is seen right beside it: there a ball before
 * the dark has no bright rim. */
static bool mirrors_pocket(const struct table *table, struct vec3 at, struct vec3 normal, struct vec3 to_eye)
{
	struct vec3 way = madd((struct vec3){-to_eye.x, -to_eye.y, -to_eye.z}, 2 * dot(normal, to_eye), normal);
	if (way.z >= 0)
		return false;
	vec2 met = {at.x - way.x * at.z / way.z, at.y - way.y * at.z / way.z};
	for (int i = 0; i < table->pocket_count; i++)
		if (vec2_dist(table->pocket[i].centre, met) < table->pocket[i].radius)
			return true;
	return false;
}

/* Blinn and Phong: how much of a lamp the surface mirrors into the eye. */
static float shine(struct vec3 normal, struct vec3 to_lamp, struct vec3 to_eye)
{
	double k = dot(normal, unit(madd(to_lamp, 1, to_eye)));
	return k > 0.95 ? powf((float)k, SHINE_POWER) : 0;
}

static void shade_ball(const struct table_camera *camera, const struct sphere *sphere, struct vec3 at,
		       struct vec3 normal, struct vec3 eye, float light[3])
{
	struct vec3 to_lamp = unit(sub(from_array(camera->lamp_at), at)),
		    to_glow = unit(sub(from_array(camera->projector_at), at));
	struct vec3 to_eye = unit(sub(eye, at));
	float lamp = (float)fmax(0, dot(normal, to_lamp)), glow = (float)fmax(0, dot(normal, to_glow)), picture[3];
	float around = mirror(normal, to_eye),
	      mirrored = SHINE_LAMP * shine(normal, to_lamp, to_eye) + SHINE_GLOW * shine(normal, to_glow, to_eye);
	float cloth = around > 0 && !mirrors_pocket(&camera->table, at, normal, to_eye) ? around : 0;
	table_camera_picture_at(camera, (vec2){at.x, at.y}, at.z, picture);
	for (int c = 0; c < 3; c++) {
		float drawn = picture[c] > 0 ? powf(1 + picture[c], 2.2f) - 1 : 0;
		float room = AMBIENT * (0.75f + 0.25f * (float)normal.z) + LAMP * lamp + GLOW * glow;
		light[c] = (1 - around) * sphere->albedo[c] * (room * sphere->room[c] + glow * drawn) +
			   cloth * sphere->cloth[c] + mirrored * sphere->room[c];
	}
}

/* A ray from the eye: where it passes the ball. */
struct pass {
	double distance;	/* of the ray from the centre, radii */
	struct vec3 at, normal; /* where it enters; beside the ball the nearest point of its rim */
};

/* False when the ray passes farther than reach (radii) from the centre. to: from the eye to the centre. */
static bool pass_ball(const struct sphere *sphere, struct vec3 to, struct vec3 way, double reach, struct pass *pass)
{
	double r2 = sphere->radius * sphere->radius, along = dot(to, way) / dot(way, way);
	struct vec3 nearest = sub((struct vec3){along * way.x, along * way.y, along * way.z}, to);
	double off2 = dot(nearest, nearest);
	if (along <= 0 || off2 > reach * reach * r2)
		return false;
	double back = off2 < r2 ? sqrt((r2 - off2) / dot(way, way)) : 0;
	pass->distance = sqrt(off2 / r2);
	pass->normal = unit(madd(nearest, -back, way));
	pass->at = madd(sphere->centre, sphere->radius, pass->normal);
	return true;
}

static vec2 cloth_of(const struct table_camera *camera, int x, int y)
{
	const float *p = &camera->cloth[2 * (y * camera->camera.in.width + x)];
	return (vec2){p[0], p[1]};
}

/* Does the ray meet the sphere? to: from the eye to its centre. */
static bool meets(const struct sphere *sphere, struct vec3 to, struct vec3 way)
{
	double along = dot(to, way);
	return along > 0 && along * along > (dot(to, to) - sphere->radius * sphere->radius) * dot(way, way);
}

/* Share of the pixel that the ball covers. */
static float coverage(const struct table_camera *camera, const struct sphere *sphere, struct vec3 eye, int x, int y)
{
	int x0 = x > 0 ? x - 1 : x, y0 = y > 0 ? y - 1 : y, hits = 0;
	vec2 at = cloth_of(camera, x, y), right = vec2_sub(cloth_of(camera, x0 + 1, y), cloth_of(camera, x0, y));
	vec2 down = vec2_sub(cloth_of(camera, x, y0 + 1), cloth_of(camera, x, y0));
	struct vec3 to = sub(sphere->centre, eye);
	for (int k = 0; k < RIM_SAMPLES * RIM_SAMPLES; k++) {
		double u = (k % RIM_SAMPLES + 0.5) / RIM_SAMPLES - 0.5, v = (k / RIM_SAMPLES + 0.5) / RIM_SAMPLES - 0.5;
		vec2 cloth = vec2_madd(vec2_madd(at, u, right), v, down);
		hits += meets(sphere, to, (struct vec3){cloth.x - eye.x, cloth.y - eye.y, -eye.z});
	}
	return (float)hits / (RIM_SAMPLES * RIM_SAMPLES);
}

static void blend(struct table_camera *camera, int i, const float light[3], float gain, float share)
{
	for (int c = 0; c < 3; c++) {
		uint16_t *level = &camera->work[3 * i + 2 - c];
		float sum = (1 - share) * (float)*level + share * LEVEL * gain * light[c];
		*level = (uint16_t)fminf(LEVEL_MAX, sum);
	}
}

/* Places that a moving ball is drawn at: one for each BLUR_STEP of its way while the shutter is open. */
static int blur_samples(const struct table_camera *camera, const struct sphere *sphere)
{
	double way = vec2_norm(sphere->vel) * camera->def.exposure_time;
	return way < BLUR_STEP / 4 ? 1 : 1 + (int)fmin(BLUR_MAX - 1, way / BLUR_STEP);
}

/* One pixel of a moving ball: the mean over the time that its row is exposed. */
static void draw_moving_pixel(struct table_camera *camera, const struct sphere *sphere, struct vec3 eye, double rim,
			      const int at[2])
{
	vec2 cloth = cloth_of(camera, at[0], at[1]);
	int n = blur_samples(camera, sphere);
	double row = camera->def.shutter_time * ((double)at[1] / camera->camera.in.height - 0.5);
	float light[3] = {0, 0, 0}, one[3], sum = 0;
	for (int k = 0; k < n; k++) {
		double t = row + camera->def.exposure_time * ((k + 0.5) / n - 0.5);
		struct sphere now = *sphere;
		struct pass pass;
		now.centre.x += t * now.vel.x;
		now.centre.y += t * now.vel.y;
		if (!pass_ball(&now, sub(now.centre, eye), (struct vec3){cloth.x - eye.x, cloth.y - eye.y, -eye.z},
			       1 + rim, &pass))
			continue;
		float share = (float)fmax(0, fmin(1, 0.5 + (1 - pass.distance) / (2 * rim)));
		shade_ball(camera, &now, pass.at, pass.normal, eye, one);
		for (int c = 0; c < 3; c++)
			light[c] += share * one[c];
		sum += share;
	}
	if (sum <= 0)
		return;
	for (int c = 0; c < 3; c++)
		light[c] /= sum;
	blend(camera, at[1] * camera->camera.in.width + at[0], light, table_camera_gain(camera, at[0], at[1]),
	      sum / (float)n);
}

static void draw_moving(struct table_camera *camera, const struct sphere *sphere, struct vec3 eye)
{
	double way = 0.5 * vec2_norm(sphere->vel) * (camera->def.exposure_time + camera->def.shutter_time);
	struct box box = box_around(camera, sphere->centre, sphere->radius + way, sphere->radius);
	struct vec3 to = sub(sphere->centre, eye);
	double rim = 0.95 * sqrt(dot(to, to)) / fmin(camera->camera.in.fx, camera->camera.in.fy) / sphere->radius;
	for (int y = box.y0; y < box.y1; y++)
		for (int x = box.x0; x < box.x1; x++)
			draw_moving_pixel(camera, sphere, eye, rim, (const int[]){x, y});
}

static void draw_ball(struct table_camera *camera, const struct sphere *sphere, struct vec3 eye)
{
	struct box box = box_around(camera, sphere->centre, sphere->radius, sphere->radius);
	struct vec3 to = sub(sphere->centre, eye);
	/* half a pixel's diagonal at the ball, in radii, and a little more for the slant in the corners */
	double rim = 0.95 * sqrt(dot(to, to)) / fmin(camera->camera.in.fx, camera->camera.in.fy) / sphere->radius;
	for (int y = box.y0; y < box.y1; y++)
		for (int x = box.x0; x < box.x1; x++) {
			vec2 cloth = cloth_of(camera, x, y);
			struct pass pass;
			if (!pass_ball(sphere, to, (struct vec3){cloth.x - eye.x, cloth.y - eye.y, -eye.z}, 1 + rim,
				       &pass))
				continue;
			float share = pass.distance < 1 - rim ? 1 : coverage(camera, sphere, eye, x, y), light[3];
			if (share <= 0)
				continue;
			shade_ball(camera, sphere, pass.at, pass.normal, eye, light);
			blend(camera, y * camera->camera.in.width + x, light, table_camera_gain(camera, x, y), share);
		}
}

/* Mean light of the cloth beside a ball: right below it there may be a line. */
static void cloth_around(const struct table_scene *scene, vec2 pos, double radius, float light[3])
{
	for (int k = 0; k < 4; k++) {
		vec2 beside = {pos.x + (k & 1 ? 1.5 : -1.5) * radius, pos.y + (k & 2 ? 1.5 : -1.5) * radius};
		float rgb[3];
		table_scene_colour(scene, beside, SURFACE_BED, rgb);
		for (int c = 0; c < 3; c++)
			light[c] += table_camera_linear(rgb[c]) / 4;
	}
}

/* The balls that are seen, the farthest from the eye first. */
static int sort_spheres(const struct table_camera *camera, const struct ball *ball, int count, struct vec3 eye,
			struct sphere *out)
{
	int n = 0;
	for (int i = 0; i < count; i++) {
		assert(ball_is_finite(&ball[i]) && ball[i].colour >= 0 && ball[i].colour < COLOUR_COUNT);
		if (ball[i].phase == BALL_POTTED)
			continue;
		struct sphere sphere = {.centre = {ball[i].pos.x, ball[i].pos.y, camera->table.ball_radius},
					.radius = camera->table.ball_radius,
					.vel = ball[i].vel};
		table_scene_light(&camera->scene, ball[i].pos, sphere.room);
		cloth_around(&camera->scene, ball[i].pos, sphere.radius, sphere.cloth);
		for (int c = 0; c < 3; c++) {
			sphere.albedo[c] = table_camera_linear(ALBEDO[ball[i].colour][c]);
			sphere.room[c] = powf(sphere.room[c], 2.2f);
		}
		struct vec3 to = sub(sphere.centre, eye);
		int k = n++;
		for (; k > 0; k--) {
			struct vec3 other = sub(out[k - 1].centre, eye);
			if (dot(other, other) >= dot(to, to))
				break;
			out[k] = out[k - 1];
		}
		out[k] = sphere;
	}
	return n;
}

void table_camera_draw_balls(struct table_camera *camera, const struct ball *ball, int count)
{
	struct sphere sphere[BALL_MAX];
	struct vec3 eye = from_array(camera->scene.eye);
	int n = sort_spheres(camera, ball, count, eye, sphere);
	for (int i = 0; i < n; i++)
		draw_shadow(camera, &sphere[i]);
	for (int i = 0; i < n; i++) {
		bool still = blur_samples(camera, &sphere[i]) == 1 &&
			     vec2_norm(sphere[i].vel) * camera->def.shutter_time < BLUR_STEP / 4;
		(still ? draw_ball : draw_moving)(camera, &sphere[i], eye);
	}
}
