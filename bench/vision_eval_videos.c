/* Streams: ghosts, resting balls, trembling, with thesis table 5.3. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/colour_file.h"
#include "vision/capture_cv.h"
#include "vision/stabilise.h"
#include "vision_eval.h"

static const double mm = 1000, FOUND = 0.015;
enum { SHOT_BALLS = 22, WARM_UP = 5 };

struct watched {
	vec2 start;	/* m */
	int rest_until; /* frame of the file */
	bool seen;
	vec2 raw, steady; /* of the frame before */
	vec2 raw_px, steady_px;
	struct thesis_stabiliser thesis;
	vec2 thesis_pos;
};

struct streams {
	int frames, ghosts, rest_wanted, rest_found;
	struct numbers raw_px, steady_px, raw_mm, steady_mm, thesis_mm, tracked_ms;
};

static double number(const json_t *object, const char *key)
{
	return json_number_value(json_object_get(object, key));
}

/* Frame of the file in which a ball is first touched: the shot for the cue ball, its first event for another. */
static int rest_until(const json_t *shot, const char *id, int shot_frame)
{
	size_t i;
	const json_t *event;
	json_array_foreach(json_object_get(shot, "events"), i, event)
	{
		const char *ball = json_string_value(json_object_get(event, "ball"));
		if (ball && strcmp(ball, id) == 0)
			return shot_frame + (int)(number(event, "time_s") * 30) - 2;
	}
	return 1 << 30;
}

static int watch(const json_t *shot, struct watched *w)
{
	const json_t *segment = json_array_get(json_object_get(shot, "annotation_segments"), 0);
	const json_t *point = json_array_get(json_object_get(segment, "points"), 0);
	int shot_frame = (int)(number(point, "frame") + number(shot, "video_frame_offset"));
	size_t i;
	const json_t *ball;
	int count = 0;
	json_array_foreach(json_object_get(shot, "balls"), i, ball)
	{
		const json_t *pos = json_object_get(ball, "position_mm");
		if (count == SHOT_BALLS)
			break;
		w[count] = (struct watched){.start = {json_number_value(json_array_get(pos, 0)) / mm,
						      json_number_value(json_array_get(pos, 1)) / mm}};
		w[count].rest_until = rest_until(shot, json_string_value(json_object_get(ball, "id")), shot_frame);
		count++;
	}
	return count;
}

static const struct vision_ball *ball_near(const struct vision_result *r, vec2 at)
{
	const struct vision_ball *best = NULL;
	for (int i = 0; i < r->ball_count; i++)
		if (vec2_dist(r->ball[i].pos, at) < (best ? vec2_dist(best->pos, at) : FOUND))
			best = &r->ball[i];
	return best;
}

static void compare_frame(struct streams *s, struct watched *w, int frame, const struct vision_result *single,
			  const struct vision_result *tracked)
{
	const struct vision_ball *raw = ball_near(single, w->start), *steady = ball_near(tracked, w->start);
	s->rest_wanted++;
	s->rest_found += steady != NULL;
	if (!raw || !steady) {
		w->seen = false;
		return;
	}
	vec2 thesis = thesis_stabilise(&w->thesis, raw->pos, 0.02, 5);
	if (w->seen && frame > WARM_UP) {
		numbers_add(&s->raw_px, vec2_dist(raw->px, w->raw_px));
		numbers_add(&s->steady_px, vec2_dist(steady->px, w->steady_px));
		numbers_add(&s->raw_mm, mm * vec2_dist(raw->pos, w->raw));
		numbers_add(&s->steady_mm, mm * vec2_dist(steady->pos, w->steady));
		numbers_add(&s->thesis_mm, mm * vec2_dist(thesis, w->thesis_pos));
	}
	w->seen = true;
	w->raw = raw->pos;
	w->raw_px = raw->px;
	w->steady = steady->pos;
	w->steady_px = steady->px;
	w->thesis_pos = thesis;
}

static void run(struct streams *s, const struct config *config, const struct colour_model *colours, const json_t *shot,
		const char *data)
{
	char source[512], err[256];
	struct watched w[SHOT_BALLS];
	struct capture *capture;
	struct capture_frame frame;
	struct image_buffer image = {0};
	const char *video = json_string_value(json_object_get(shot, "video"));
	if (!video)
		return;
	snprintf(source, sizeof(source), "file:%s/videos/%s", data, video);
	struct capture_def def = {.source = source};
	if (capture_open(&capture, &def, err, sizeof(err)) < 0) {
		printf("  %s\n", err);
		return;
	}
	struct vision *single = eval_vision(config, colours), *stream = eval_vision(config, colours);
	int count = watch(shot, w), ghosts = 0, frames = 0;
	while (capture_next(capture, &image, &frame, err, sizeof(err)) == 1) {
		struct vision_result a = {0}, b = {0};
		double before = eval_seconds();
		vision_track(stream, &image.image, frame.time, &b, err, sizeof(err));
		if (frame.index > 0)
			numbers_add(&s->tracked_ms, 1000 * (eval_seconds() - before));
		bool resting = false;
		for (int i = 0; i < count; i++)
			resting = resting || frame.index < w[i].rest_until;
		if (resting)
			vision_detect(single, &image.image, &a, err, sizeof(err));
		for (int i = 0; i < count; i++)
			if (frame.index < w[i].rest_until)
				compare_frame(s, &w[i], frame.index, &a, &b);
		ghosts += b.ball_count > count ? b.ball_count - count : 0;
		frames++;
	}
	printf("  %s: %d frames, %d balls, %d ghosts\n", video, frames, count, ghosts);
	s->frames += frames;
	s->ghosts += ghosts;
	vision_destroy(single);
	vision_destroy(stream);
	capture_close(capture);
	image_buffer_finish(&image);
}

static void print_row(const char *what, struct numbers *n)
{
	double sum = 0;
	for (int i = 0; i < n->count; i++)
		sum += n->value[i];
	printf("  %-22s %6d: min %.4f, %.4f, %.4f, %.4f, max %.3f, sum %.2f mm\n", what, n->count,
	       numbers_quantile(n, 0), numbers_quantile(n, 0.25), numbers_quantile(n, 0.5), numbers_quantile(n, 0.75),
	       numbers_quantile(n, 1), sum);
}

static void summarise(struct report *report, struct streams *s)
{
	eval_bar(report, "vision.videos.ghosts_per_frame", s->frames > 0 ? (double)s->ghosts / s->frames : 0, "count",
		 0.01);
	eval_floor(report, "vision.videos.rest_found_percent",
		   s->rest_wanted > 0 ? 100.0 * s->rest_found / s->rest_wanted : 0, "%", 99.5);
	eval_bar(report, "vision.rest.raw_rms_px", numbers_rms(&s->raw_px), "px", 0.10);
	eval_bar(report, "vision.rest.steady_rms_px", numbers_rms(&s->steady_px), "px", 0.03);
	eval_bar(report, "vision.rest.steady_median_mm", numbers_quantile(&s->steady_mm, 0.5), "mm", 0.02);
	report_number(report, "vision.videos.tracked_median_ms", numbers_quantile(&s->tracked_ms, 0.5), "ms");
	report_number(report, "vision.videos.tracked_p95_ms", numbers_quantile(&s->tracked_ms, 0.95), "ms");
	printf("  movement of a resting ball between frames, as thesis table 5.3:\n");
	print_row("single frames", &s->raw_mm);
	print_row("thesis 4.1, 4.2 on them", &s->thesis_mm);
	print_row("tracked", &s->steady_mm);
}

void eval_videos(struct report *report, const struct config *config, const char *data)
{
	struct streams s = {0};
	struct colour_model colours;
	char path[512], err[640];
	size_t i;
	json_t *shot;
	snprintf(path, sizeof(path), "%s/shots/real_shots.json", data);
	json_t *root = json_load_file(path, 0, NULL);
	if (!root || colour_file_read(config->colours, &colours, err, sizeof(err)) < 0) {
		printf("videos: SKIPPED, %s or the colour file is not there\n", path);
		json_decref(root);
		return;
	}
	json_array_foreach(json_object_get(root, "shots"), i, shot) run(&s, config, &colours, shot, data);
	summarise(report, &s);
	json_decref(root);
}
