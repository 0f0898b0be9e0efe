/* Rendered frames, whose truth is known: error against noise, exposure, white balance, blur and overlay. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/colour_file.h"
#include "app/virtual/table_camera.h"
#include "vision_eval.h"

static const double mm = 1000, FOUND = 0.015;
enum { FRAMES = 12, BALLS = 22, RINGS = 1500 };

/* One condition. */
struct weather {
	const char *name;
	double noise, exposure;
	double blue, red; /* gains after the camera */
	int blur;	  /* passes of a 3 x 3 box */
	bool overlay;
};

struct stage {
	struct config config;
	struct table_camera *camera;
	struct vision *vision;
	struct image_buffer image, scratch;
	struct ball ball[BALLS];
	uint64_t random;
};

struct score {
	int balls, lost, ghosts, colours;
	struct numbers free, packed;
};

/* splitmix64 */
static double uniform(struct stage *s, double low, double high)
{
	uint64_t z = (s->random += 0x9e3779b97f4a7c15u);
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return low + (high - low) * ((double)((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

static bool is_free(const struct stage *s, int count, vec2 p)
{
	const struct table *t = &s->config.table;
	for (int i = 0; i < count; i++)
		if (vec2_dist(s->ball[i].pos, p) < 2 * t->ball_radius + 1e-4)
			return false;
	for (int i = 0; i < t->pocket_count; i++)
		if (vec2_dist(t->pocket[i].centre, p) < 1.15 * t->pocket[i].radius)
			return false;
	return true;
}

/* Every third frame has the rack. */
static void lay_out(struct stage *s, int frame)
{
	const struct table *t = &s->config.table;
	double hx = t->length / 2 - t->ball_radius, hy = t->width / 2 - t->ball_radius, d = 2 * t->ball_radius + 1e-4;
	int count = 0;
	for (int row = 0; row < 5 && frame % 3 == 2; row++)
		for (int i = 0; i <= row; i++)
			s->ball[count++] = ball_at(COLOUR_RED, (vec2){0.45 + row * d * 0.8660255, (i - row / 2.0) * d});
	while (count < BALLS) {
		vec2 p = {uniform(s, -hx, hx), uniform(s, -hy, hy)};
		int left = BALLS - 1 - count;
		enum ball_colour colour = left == 0  ? COLOUR_WHITE
					  : left < 7 ? (enum ball_colour)(left + 1)
						     : COLOUR_RED;
		if (is_free(s, count, p))
			s->ball[count++] = ball_at(colour, p);
	}
}

static void dot(uint32_t *pixel, int width, int height, double x, double y)
{
	for (int dy = -2; dy <= 2; dy++)
		for (int dx = -2; dx <= 2; dx++) {
			int px = (int)x + dx, py = (int)y + dy;
			if (px >= 0 && py >= 0 && px < width && py < height)
				pixel[py * width + px] = 0xffffff;
		}
}

/* Rings around the balls and lines across the table, in white light. */
static void project_overlay(struct stage *s)
{
	int w = s->config.projector.width, h = s->config.projector.height;
	const double *m = s->config.projector.homography;
	uint32_t *pixel = calloc((size_t)w * (size_t)h, sizeof(*pixel));
	if (!pixel)
		abort();
	for (int b = 0; b < BALLS; b++)
		for (int i = 0; i < RINGS; i++) {
			vec2 ring = vec2_madd(s->ball[b].pos, 0.052, vec2_from_angle(i * 6.2831853 / RINGS));
			vec2 line = vec2_madd(s->ball[b].pos, (double)i / RINGS,
					      vec2_sub(s->ball[(b + 1) % 5].pos, s->ball[b].pos));
			for (int k = 0; k < 2; k++) {
				vec2 p = k == 0 ? ring : line;
				double q = m[6] * p.x + m[7] * p.y + m[8];
				dot(pixel, w, h, (m[0] * p.x + m[1] * p.y + m[2]) / q,
				    (m[3] * p.x + m[4] * p.y + m[5]) / q);
			}
		}
	table_camera_light(s->camera, pixel, w, h, w * 4);
	free(pixel);
}

static void box_blur(struct stage *s)
{
	const struct image *in = &s->image.image;
	if (image_buffer_reserve(&s->scratch, in->width, in->height) < 0)
		abort();
	memcpy(s->scratch.image.data, in->data, (size_t)in->stride * (size_t)in->height);
	for (int y = 1; y < in->height - 1; y++)
		for (ptrdiff_t x = 3; x < in->stride - 3; x++) {
			int sum = 4;
			for (int k = -1; k <= 1; k++)
				for (int i = -3; i <= 3; i += 3)
					sum += s->scratch.image.data[(y + k) * in->stride + x + i];
			in->data[y * in->stride + x] = (uint8_t)(sum / 9);
		}
}

static void spoil(struct stage *s, const struct weather *w)
{
	for (int i = 0; i < w->blur; i++)
		box_blur(s);
	const double gain[3] = {w->blue, 1, w->red};
	for (int y = 0; y < s->image.image.height && (w->blue != 1 || w->red != 1); y++)
		for (ptrdiff_t x = 0; x < s->image.image.stride; x++) {
			uint8_t *p = &s->image.image.data[y * s->image.image.stride + x];
			*p = (uint8_t)fmin(255, gain[x % 3] * *p);
		}
}

static void judge(struct score *score, const struct stage *s, const struct vision_result *r, bool rack)
{
	bool used[VISION_BALL_MAX] = {false};
	score->balls += BALLS;
	for (int i = 0; i < BALLS; i++) {
		int best = -1;
		double near = FOUND;
		for (int k = 0; k < r->ball_count; k++) {
			double d = vec2_dist(r->ball[k].pos, s->ball[i].pos);
			if (!used[k] && d < near) {
				near = d;
				best = k;
			}
		}
		score->lost += best < 0;
		if (best < 0)
			continue;
		used[best] = true;
		numbers_add(rack && i < 15 ? &score->packed : &score->free, mm * near);
		score->colours += r->ball[best].colour == s->ball[i].colour;
	}
	for (int k = 0; k < r->ball_count; k++)
		score->ghosts += !used[k];
}

static void run(struct report *report, struct stage *s, const struct weather *w)
{
	struct score score = {0};
	struct vision_result r;
	char err[256], name[96];
	s->random = 2021;
	s->config.virtual_table.noise = w->noise;
	s->config.virtual_table.exposure = w->exposure;
	if (table_camera_create(&s->camera, &s->config, err, sizeof(err)) < 0) {
		printf("  %s: %s\n", w->name, err);
		return;
	}
	for (int f = 0; f < FRAMES; f++) {
		lay_out(s, f);
		if (w->overlay)
			project_overlay(s);
		table_camera_render(s->camera, s->ball, BALLS, (uint64_t)f, &s->image.image);
		spoil(s, w);
		if (vision_detect(s->vision, &s->image.image, &r, err, sizeof(err)) == 0)
			judge(&score, s, &r, f % 3 == 2);
	}
	table_camera_destroy(s->camera);
	printf("  %-16s lost %d, ghosts %d, colours %d of %d, free median %.3f max %.2f mm, rack median %.3f max %.2f "
	       "mm\n",
	       w->name, score.lost, score.ghosts, score.colours, score.balls, numbers_quantile(&score.free, 0.5),
	       numbers_quantile(&score.free, 1), numbers_quantile(&score.packed, 0.5),
	       numbers_quantile(&score.packed, 1));
	snprintf(name, sizeof(name), "vision.rendered.%s.median_mm", w->name);
	report_number(report, name, numbers_quantile(&score.free, 0.5), "mm");
	snprintf(name, sizeof(name), "vision.rendered.%s.lost_and_ghosts", w->name);
	report_number(report, name, score.lost + score.ghosts, "count");
	if (strcmp(w->name, "overlay") == 0) {
		eval_bar(report, "vision.rendered.free_median_mm", numbers_quantile(&score.free, 0.5), "mm", 0.2);
		eval_bar(report, "vision.rendered.free_max_mm", numbers_quantile(&score.free, 1), "mm", 1);
		eval_bar(report, "vision.rendered.rack_max_mm", numbers_quantile(&score.packed, 1), "mm", 1.5);
	}
	free(score.free.value);
	free(score.packed.value);
}

void eval_rendered(struct report *report, const struct config *config)
{
	static const struct weather weather[] = {
		{"plain", 2, 1, 1, 1, 0, false},	 {"overlay", 2, 1, 1, 1, 0, true},
		{"noise_5", 5, 1, 1, 1, 0, true},	 {"noise_10", 10, 1, 1, 1, 0, true},
		{"noise_20", 20, 1, 1, 1, 0, true},	 {"exposure_0.2", 2, 0.2, 1, 1, 0, true},
		{"exposure_0.4", 2, 0.4, 1, 1, 0, true}, {"exposure_1.5", 2, 1.5, 1, 1, 0, true},
		{"exposure_2.5", 2, 2.5, 1, 1, 0, true}, {"warm", 2, 1, 0.75, 1.25, 0, true},
		{"cold", 2, 1, 1.25, 0.75, 0, true},	 {"blur_1", 2, 1, 1, 1, 1, true},
		{"blur_3", 2, 1, 1, 1, 3, true},	 {"blur_6", 2, 1, 1, 1, 6, true},
	};
	static struct stage s;
	struct colour_model colours;
	char err[640];
	s.config = *config;
	if (colour_file_read(config->colours, &colours, err, sizeof(err)) < 0) {
		printf("rendered frames: SKIPPED, %s\n", err);
		return;
	}
	s.vision = eval_vision(config, &colours);
	if (image_buffer_reserve(&s.image, config->camera.width, config->camera.height) < 0)
		abort();
	puts("rendered frames:");
	for (size_t i = 0; i < sizeof(weather) / sizeof(*weather); i++)
		run(report, &s, &weather[i]);
	vision_destroy(s.vision);
	image_buffer_finish(&s.image);
	image_buffer_finish(&s.scratch);
}
