/* Errors, lost balls, ghosts and colours on the photographs, with the tables of thesis 5.1 and 5.4. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/config/colour_file.h"
#include "app/commands/overlay.h"
#include "vision_eval.h"

static const double mm = 1000;
enum { IMAGE_MAX = 400, SET_COUNT = 4, WORST_MAX = 6 };
static const char *const set_name[SET_COUNT] = {"projector_off", "without_halo", "with_halo_2", "with_halo_and_text"};

struct picture {
	char path[512], name[96];
	const json_t *entry;
	int set;      /* of set_name, -1 none */
	double worst; /* mm */
	struct vision_result result;
	struct colour_sample sample[VISION_BALL_MAX];
	enum ball_colour label[VISION_BALL_MAX]; /* UNKNOWN: not labelled */
};

struct photos {
	struct picture picture[IMAGE_MAX];
	int count, lost, ghosts, uncalibrated, arm_balls, unlabelled;
	struct numbers dx, dy, error, by_colour[COLOUR_COUNT], measured, touching, ms;
	int confusion[COLOUR_COUNT][COLOUR_COUNT]; /* true, found */
};

static double number(const json_t *object, const char *key)
{
	return json_number_value(json_object_get(object, key));
}

static enum ball_colour type_of(const json_t *object)
{
	enum ball_colour colour;
	const char *type = json_string_value(json_object_get(object, "type"));
	return type && ball_colour_from_name(type, &colour) ? colour : COLOUR_UNKNOWN;
}

/* Best pairs first, each ball once: pair[i] is the ball of entry i, or -1. Places in mm (px of balls when in_px). */
static void pair_up(const json_t *list, const struct vision_result *r, bool in_px, double limit, int *pair)
{
	bool used[VISION_BALL_MAX] = {false};
	size_t n = json_array_size(list);
	for (size_t i = 0; i < n; i++)
		pair[i] = -1;
	for (;;) {
		double best = limit;
		int bi = -1, bk = -1;
		for (size_t i = 0; i < n; i++) {
			const json_t *e = json_array_get(list, i);
			vec2 at = {number(e, in_px ? "px" : "x_mm"), number(e, in_px ? "py" : "y_mm")};
			for (int k = 0; k < r->ball_count && pair[i] < 0; k++) {
				double d = vec2_dist(in_px ? r->ball[k].px : vec2_scale(r->ball[k].pos, mm), at);
				if (!used[k] && d <= best) {
					best = d;
					bi = (int)i;
					bk = k;
				}
			}
		}
		if (bi < 0)
			return;
		pair[bi] = bk;
		used[bk] = true;
	}
}

static void compare_places(struct photos *p, struct picture *pic)
{
	const json_t *list = json_object_get(pic->entry, "reference");
	int pair[64], found = 0;
	if (!list)
		return;
	pair_up(list, &pic->result, false, 15, pair);
	for (size_t i = 0; i < json_array_size(list); i++) {
		const json_t *e = json_array_get(list, i);
		if (pair[i] < 0) {
			p->lost++;
			printf("  lost: %s, %.0f %.0f mm\n", pic->name, number(e, "x_mm"), number(e, "y_mm"));
			continue;
		}
		const struct vision_ball *b = &pic->result.ball[pair[i]];
		double dx = b->pos.x * mm - number(e, "x_mm"), dy = b->pos.y * mm - number(e, "y_mm");
		numbers_add(&p->dx, dx);
		numbers_add(&p->dy, dy);
		numbers_add(&p->error, hypot(dx, dy));
		numbers_add(&p->by_colour[b->colour], hypot(dx, dy));
		pic->worst = fmax(pic->worst, hypot(dx, dy));
		found++;
	}
	p->ghosts += pic->result.ball_count - found;
}

static void compare_colours(struct photos *p, struct picture *pic)
{
	const json_t *list = json_object_get(pic->entry, "classes");
	int pair[64];
	for (int k = 0; k < VISION_BALL_MAX; k++)
		pic->label[k] = COLOUR_UNKNOWN;
	if (!list)
		return;
	pair_up(list, &pic->result, true, 10 * pic->result.camera.in.width / 1280.0, pair);
	for (size_t i = 0; i < json_array_size(list); i++) {
		if (pair[i] < 0) {
			p->unlabelled++;
			continue;
		}
		enum ball_colour truth = type_of(json_array_get(list, i));
		pic->label[pair[i]] = truth;
		p->confusion[truth][pic->result.ball[pair[i]].colour]++;
	}
}

static void compare_rest(struct photos *p, const struct picture *pic)
{
	const json_t *list = json_object_get(pic->entry, "measured");
	const struct vision_result *r = &pic->result;
	int pair[64];
	pair_up(list, r, false, 30, pair);
	for (size_t i = 0; i < json_array_size(list); i++) {
		const json_t *e = json_array_get(list, i);
		vec2 at = {number(e, "x_mm"), number(e, "y_mm")};
		numbers_add(&p->measured, pair[i] < 0 ? 30 : vec2_dist(vec2_scale(r->ball[pair[i]].pos, mm), at));
	}
	if (strncmp(pic->name, "specials", 8) == 0)
		p->arm_balls = r->ball_count;
	for (int i = 0; i < r->ball_count; i++)
		for (int k = 0; k < i; k++) {
			double d = mm * vec2_dist(r->ball[i].pos, r->ball[k].pos);
			if (d < 54.5)
				numbers_add(&p->touching, d);
		}
}

static void look_at(struct photos *p, struct vision *vision, struct image_buffer *image, const json_t *entry,
		    const char *data)
{
	char err[256];
	struct picture *pic = &p->picture[p->count];
	const char *name = json_string_value(json_object_get(entry, "image"));
	snprintf(pic->name, sizeof(pic->name), "%s", name);
	snprintf(pic->path, sizeof(pic->path), "%s/photos/%s", data, name);
	pic->entry = entry;
	pic->set = -1;
	for (int s = 0; s < SET_COUNT; s++)
		if (strncmp(name, set_name[s], strlen(set_name[s])) == 0 && name[strlen(set_name[s])] == '/')
			pic->set = s;
	if (image_read(pic->path, image, err, sizeof(err)) < 0) {
		printf("  %s\n", err);
		return;
	}
	double before = eval_seconds();
	if (vision_detect(vision, &image->image, &pic->result, err, sizeof(err)) < 0 ||
	    pic->result.calibration == CALIBRATION_NONE)
		p->uncalibrated++;
	numbers_add(&p->ms, 1000 * (eval_seconds() - before));
	vision_samples(vision, pic->sample);
	p->count++;
	compare_places(p, pic);
	compare_colours(p, pic);
	compare_rest(p, pic);
}

/* Colours of a set by a model that has seen neither it nor its twin. */
static double colours_left_out(const struct photos *p, int set)
{
	static struct colour_sample sample[IMAGE_MAX * VISION_BALL_MAX];
	struct colour_model model;
	char err[256];
	int n = 0, right = 0, all = 0;
	bool twins = set == 1 || set == 3;
	for (int i = 0; i < p->count; i++) {
		const struct picture *pic = &p->picture[i];
		if (pic->set < 0 || pic->set == set || (twins && (pic->set == 1 || pic->set == 3)))
			continue;
		for (int k = 0; k < pic->result.ball_count; k++)
			if (pic->label[k] != COLOUR_UNKNOWN) {
				sample[n] = pic->sample[k];
				sample[n++].colour = pic->label[k];
			}
	}
	if (colour_learn(sample, n, &model, err, sizeof(err)) < 0)
		return 0;
	struct colour_classifier classifier = colour_classifier(&model);
	for (int i = 0; i < p->count; i++) {
		const struct picture *pic = &p->picture[i];
		struct colour_feature feature[VISION_BALL_MAX];
		struct colour_verdict verdict[VISION_BALL_MAX];
		if (pic->set != set)
			continue;
		for (int k = 0; k < pic->result.ball_count; k++)
			feature[k] = pic->sample[k].feature;
		colour_assign(&classifier, feature, pic->result.ball_count, verdict);
		for (int k = 0; k < pic->result.ball_count; k++)
			if (pic->label[k] != COLOUR_UNKNOWN) {
				all++;
				right += verdict[k].colour == pic->label[k];
			}
	}
	return all > 0 ? 100.0 * right / all : 0;
}

static void report_colours(struct report *report, const struct photos *p)
{
	char name[96];
	for (int s = 0; s < SET_COUNT; s++) {
		int right = 0, all = 0;
		for (int i = 0; i < p->count; i++)
			for (int k = 0; p->picture[i].set == s && k < p->picture[i].result.ball_count; k++)
				if (p->picture[i].label[k] != COLOUR_UNKNOWN) {
					all++;
					right += p->picture[i].label[k] == p->picture[i].result.ball[k].colour;
				}
		snprintf(name, sizeof(name), "vision.colours.%s_percent", set_name[s]);
		eval_floor(report, name, all > 0 ? 100.0 * right / all : 0, "%", 99);
		snprintf(name, sizeof(name), "vision.colours.%s_not_learned_percent", set_name[s]);
		eval_floor(report, name, colours_left_out(p, s), "%", 98);
	}
	printf("  true colour (row) and found (column), as thesis table 5.4:\n  %8s", "");
	for (int k = 0; k < COLOUR_COUNT; k++)
		printf(" %7s", ball_colour_name((enum ball_colour)k));
	for (int t = 0; t < COLOUR_CLASSES; t++) {
		printf("\n  %8s", ball_colour_name((enum ball_colour)t));
		for (int k = 0; k < COLOUR_COUNT; k++)
			printf(" %7d", p->confusion[t][k]);
	}
	puts("");
}

static void report_errors(struct report *report, struct photos *p)
{
	struct numbers centred = {0};
	struct numbers dx = {0}, dy = {0};
	for (int i = 0; i < p->dx.count; i++) {
		numbers_add(&dx, p->dx.value[i]);
		numbers_add(&dy, p->dy.value[i]);
	}
	double mx = numbers_quantile(&dx, 0.5), my = numbers_quantile(&dy, 0.5);
	for (int i = 0; i < p->dx.count; i++)
		numbers_add(&centred, hypot(p->dx.value[i] - mx, p->dy.value[i] - my));
	eval_bar(report, "vision.reference.lost", p->lost, "count", 0);
	eval_bar(report, "vision.reference.ghosts", p->ghosts, "count", 0);
	eval_bar(report, "vision.reference.median_mm", numbers_quantile(&p->error, 0.5), "mm", 1.40);
	eval_bar(report, "vision.reference.p95_mm", numbers_quantile(&p->error, 0.95), "mm", 3.0);
	eval_bar(report, "vision.reference.max_mm", numbers_quantile(&p->error, 1), "mm", 6.0);
	eval_bar(report, "vision.reference.offset_removed_median_mm", numbers_quantile(&centred, 0.5), "mm", 1.10);
	printf("  constant offset %.2f, %.2f mm; quartiles as thesis table 5.2:\n", mx, my);
	for (int k = 0; k < COLOUR_COUNT; k++) {
		struct numbers *n = &p->by_colour[k];
		if (n->count > 0)
			printf("  %8s %4d balls: min %.3f, %.2f, %.2f, %.2f, max %.2f mm\n",
			       ball_colour_name((enum ball_colour)k), n->count, numbers_quantile(n, 0),
			       numbers_quantile(n, 0.25), numbers_quantile(n, 0.5), numbers_quantile(n, 0.75),
			       numbers_quantile(n, 1));
		free(n->value);
	}
	free(centred.value);
	free(dx.value);
	free(dy.value);
}

static void report_others(struct report *report, struct photos *p)
{
	double mean = 0, spread = 0;
	int n = p->touching.count;
	for (int i = 0; i < n; i++)
		mean += p->touching.value[i] / n;
	for (int i = 0; i < n; i++)
		spread += (p->touching.value[i] - mean) * (p->touching.value[i] - mean) / n;
	eval_bar(report, "vision.measured.rms_mm", numbers_rms(&p->measured), "mm", 2.5);
	report_number(report, "vision.touching.pairs", n, "count");
	report_number(report, "vision.touching.mean_mm", mean, "mm");
	eval_bar(report, "vision.touching.spread_mm", sqrt(spread), "mm", 1.0);
	eval_bar(report, "vision.arm.balls", p->arm_balls, "count", 22);
	report_number(report, "vision.photos.cold_with_markers_ms", numbers_quantile(&p->ms, 0.5), "ms");
}

/* Pictures of the worst, in BUILD/eval. */
static void draw_worst(struct photos *p, const struct config *config, struct image_buffer *image, const char *build)
{
	char path[512], err[256];
	snprintf(path, sizeof(path), "%s/eval", build);
	mkdir(path, 0777);
	for (int n = 0; n < WORST_MAX; n++) {
		struct picture *worst = &p->picture[0];
		for (int i = 1; i < p->count; i++)
			if (p->picture[i].worst > worst->worst)
				worst = &p->picture[i];
		if (worst->worst <= 0 || image_read(worst->path, image, err, sizeof(err)) < 0)
			return;
		snprintf(path, sizeof(path), "%s/eval/worst-%d.png", build, n + 1);
		struct overlay overlay = {.frame = &image->image, .table = &config->table, .result = &worst->result};
		if (overlay_write(&overlay, path, err, sizeof(err)) == 0)
			printf("  %s: %s, %.1f mm\n", path, worst->name, worst->worst);
		worst->worst = 0;
	}
}

void eval_photos(struct report *report, const struct config *config, const char *build, const char *data)
{
	static struct photos p;
	struct colour_model colours;
	struct image_buffer image = {0};
	char path[512], err[640];
	size_t i;
	json_t *entry;
	snprintf(path, sizeof(path), "%s/photos/labels.json", data);
	json_t *labels = json_load_file(path, 0, NULL);
	if (!labels || colour_file_read(config->colours, &colours, err, sizeof(err)) < 0) {
		printf("photographs: SKIPPED, %s or the colour file is not there\n", path);
		json_decref(labels);
		return;
	}
	struct vision *vision = eval_vision(config, &colours);
	json_array_foreach(labels, i, entry)
	{
		if (p.count < IMAGE_MAX)
			look_at(&p, vision, &image, entry, data);
	}
	printf("%d photographs, %d not calibrated, %d labelled balls not found\n", p.count, p.uncalibrated,
	       p.unlabelled);
	report_errors(report, &p);
	report_others(report, &p);
	report_colours(report, &p);
	draw_worst(&p, config, &image, build);
	vision_destroy(vision);
	image_buffer_finish(&image);
	json_decref(labels);
}
