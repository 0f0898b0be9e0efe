/* Speed of the vision beside the old way's, circle Hough, on the same frames in the same run; and error against truth.
 */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/config/colour_file.h"
#include "app/virtual/table_camera.h"
#include "hough_cv.h"
#include "vision/calibration.h"
#include "vision/capture_cv.h"
#include "vision/detector.h"
#include "vision_eval.h"

static const double mm = 1000, FOUND = 0.015, ms = 1000;
enum { FRAMES = 40, BALLS = 22, HOUGH_MAX = 200 };
static_assert((int)HOUGH_MAX >= (int)SEED_MAX, "add_result takes either");

struct way {
	struct numbers ms, error;
	int lost, ghosts;
};

struct bench {
	struct config config;
	struct colour_model colours;
	struct colour_classifier classifier;
	struct table_camera *camera;
	struct image_buffer image;
	struct ball ball[BALLS];
	struct calibration calibration;
	struct detector detector;
	struct vision *stream;
	struct way votes, coarse, cold, tracked, hough;
	struct numbers hough_alone, markers, markers_near, photo_cold, photo_hough;
};

static void add_result(struct bench *b, struct way *way, const vec2 *pos, int count, double seconds)
{
	bool used[HOUGH_MAX] = {false};
	numbers_add(&way->ms, ms * seconds);
	for (int i = 0; i < BALLS; i++) {
		int best = -1;
		double near = FOUND;
		for (int k = 0; k < count; k++)
			if (!used[k] && vec2_dist(pos[k], b->ball[i].pos) < near) {
				near = vec2_dist(pos[k], b->ball[i].pos);
				best = k;
			}
		way->lost += best < 0;
		if (best >= 0) {
			used[best] = true;
			numbers_add(&way->error, mm * near);
		}
	}
	for (int k = 0; k < count; k++)
		way->ghosts += !used[k];
}

/* Twenty-one balls at rest and the white one rolling. */
static void lay_out(struct bench *b)
{
	b->ball[0] = ball_at(COLOUR_WHITE, (vec2){-0.8, 0.03});
	for (int i = 1; i < BALLS; i++)
		b->ball[i] = ball_at(i < 7 ? (enum ball_colour)(i + 1) : COLOUR_RED,
				     (vec2){-0.8 + 0.24 * ((i - 1) % 7) + 0.01 * (i / 7),
					    -0.36 + 0.36 * ((i - 1) / 7) + (i < 8 || i > 14 ? 0 : 0.12)});
}

static void run_cold(struct bench *b, const struct camera *camera)
{
	vec2 pos[DETECT_MAX];
	double before = eval_seconds();
	bool seen = detector_place(&b->detector, camera) && detector_frame(&b->detector, &b->image.image, camera);
	double after = eval_seconds();
	int count = seen ? b->detector.count : 0;
	for (int i = 0; i < count; i++)
		pos[i] = b->detector.candidate[i].fit.pos;
	add_result(b, &b->cold, pos, count, after - before);
}

/* Cheaper: votes only; votes and half the samples of a fit that knows no neighbours. */
static void run_cheaper(struct bench *b, const struct camera *camera)
{
	vec2 pos[SEED_MAX];
	struct detector *d = &b->detector;
	double radius = b->config.table.ball_radius, before = eval_seconds();
	int count = 0, fitted = 0;
	if (!detector_place(d, camera) || !scan_frame(&d->scan, &b->image.image))
		return;
	seeds_find(&d->seeds, &d->scan, d->scan.changed);
	for (int i = 0; i < d->seeds.count; i++)
		if (camera_unproject(camera, d->seeds.seed[i].px, radius, &pos[count]) &&
		    detect_possible(d->table, pos[count]))
			count++;
	double after = eval_seconds();
	add_result(b, &b->votes, pos, count, after - before);
	struct fit_view view = {.frame = &b->image.image, .camera = camera, .radius = radius, .coarse = true};
	for (int i = 0; i < count; i++) {
		struct fit fit = {.pos = pos[i], .scale = 1, .expected_scale = 1, .scale_spread = 0.02};
		vec2 px;
		camera_project(camera, pos[i], 0, &px);
		scan_cloth_at(&d->scan, px, fit.cloth);
		if (fit_refine(&view, &fit, 2) && fit.support > 0.5)
			pos[fitted++] = fit.pos;
	}
	add_result(b, &b->coarse, pos, fitted, eval_seconds() - before);
}

static void run_tracked(struct bench *b, int frame)
{
	struct vision_result r;
	vec2 pos[VISION_BALL_MAX];
	char err[256];
	double before = eval_seconds();
	int rc = vision_track(b->stream, &b->image.image, frame / 30.0, &r, err, sizeof(err));
	double after = eval_seconds();
	for (int i = 0; rc == 0 && i < r.ball_count; i++)
		pos[i] = r.ball[i].pos;
	/* The first frame is a cold one. */
	if (frame > 0 && rc == 0)
		add_result(b, &b->tracked, pos, r.ball_count, after - before);
}

static void run_hough(struct bench *b, const struct camera *camera)
{
	double x[HOUGH_MAX], y[HOUGH_MAX];
	vec2 pos[HOUGH_MAX];
	int kept = 0;
	double before = eval_seconds();
	int count = hough_balls(&b->image.image, 15.5, x, y, HOUGH_MAX);
	double after = eval_seconds();
	/* Only what lies on the bed: the old program masked the rest. */
	for (int i = 0; i < count; i++)
		if (camera_unproject(camera, (vec2){x[i], y[i]}, b->config.table.ball_radius, &pos[kept]) &&
		    detect_possible(&b->config.table, pos[kept]))
			kept++;
	add_result(b, &b->hough, pos, kept, after - before - hough_seconds());
	numbers_add(&b->hough_alone, ms * hough_seconds());
}

static void run_markers(struct bench *b)
{
	struct marker_view view[MARKER_MAX];
	double before = eval_seconds();
	int count = marker_find(b->calibration.finder, &b->image.image, view, MARKER_MAX);
	double middle = eval_seconds();
	marker_find_near(b->calibration.finder, &b->image.image, view, count, view, MARKER_MAX);
	numbers_add(&b->markers, ms * (middle - before));
	numbers_add(&b->markers_near, ms * (eval_seconds() - middle));
}

static bool prepare(struct bench *b)
{
	char err[640] = "no memory";
	if (config_load(&b->config, "config/thesis-table.conf", err, sizeof(err)) < 0 ||
	    colour_file_read(b->config.colours, &b->colours, err, sizeof(err)) < 0 ||
	    table_camera_create(&b->camera, &b->config, err, sizeof(err)) < 0 ||
	    calibration_init(&b->calibration, &b->config.markers, 1, 10, err, sizeof(err)) < 0 ||
	    image_buffer_reserve(&b->image, b->config.camera.width, b->config.camera.height) < 0) {
		fprintf(stderr, "%s\n", err);
		return false;
	}
	b->classifier = colour_classifier(&b->colours);
	struct vision_def def = config_vision_def(&b->config, &b->colours);
	def.marker_interval = 1e6;
	if (vision_create(&b->stream, &def, err, sizeof(err)) < 0 ||
	    detector_init(&b->detector, &b->config.table, &b->classifier, b->image.image.width, b->image.image.height) <
		    0) {
		fprintf(stderr, "%s\n", err);
		return false;
	}
	return true;
}

/* Times on real photographs, where they are. */
static void time_photos(struct bench *b, const char *data)
{
	char source[512], err[256];
	struct capture *capture;
	struct capture_frame frame;
	snprintf(source, sizeof(source), "dir:%s/photos/with_halo_2", data);
	struct capture_def def = {.source = source};
	if (capture_open(&capture, &def, err, sizeof(err)) < 0) {
		printf("photographs: SKIPPED, %s\n", err);
		return;
	}
	while (capture_next(capture, &b->image, &frame, err, sizeof(err)) == 1) {
		double x[HOUGH_MAX], y[HOUGH_MAX];
		if (!calibration_single(&b->calibration, &b->image.image, &b->config.camera, err, sizeof(err)))
			continue;
		double before = eval_seconds();
		detector_place(&b->detector, &b->calibration.camera);
		detector_frame(&b->detector, &b->image.image, &b->calibration.camera);
		numbers_add(&b->photo_cold, ms * (eval_seconds() - before));
		hough_balls(&b->image.image, 15.5, x, y, HOUGH_MAX);
		numbers_add(&b->photo_hough, ms * hough_seconds());
	}
	capture_close(capture);
}

static double median(struct numbers *n)
{
	return numbers_quantile(n, 0.5);
}

static void report_way(struct report *report, const char *name, struct way *way, double bar)
{
	char key[96];
	snprintf(key, sizeof(key), "vision.%s_ms", name);
	eval_bar(report, key, median(&way->ms), "ms", bar);
	snprintf(key, sizeof(key), "vision.%s_median_error_mm", name);
	report_number(report, key, median(&way->error), "mm");
	printf("    %d lost, %d ghosts in %d frames\n", way->lost, way->ghosts, way->ms.count);
}

/* name, ms, mm: for the drawing. */
static void write_table(struct bench *b, const char *build)
{
	char path[256];
	snprintf(path, sizeof(path), "%s/vision.csv", build);
	FILE *file = fopen(path, "w");
	if (!file) {
		perror(path);
		return;
	}
	fprintf(file, "way,ms,median_mm\ncircle Hough,%.3f,%.3f\n", median(&b->hough.ms), median(&b->hough.error));
	fprintf(file, "votes only,%.3f,%.3f\n", median(&b->votes.ms), median(&b->votes.error));
	fprintf(file, "coarse fit,%.3f,%.3f\n", median(&b->coarse.ms), median(&b->coarse.error));
	fprintf(file, "cold,%.3f,%.3f\n", median(&b->cold.ms), median(&b->cold.error));
	fprintf(file, "cold with marker search,%.3f,%.3f\n", median(&b->cold.ms) + median(&b->markers),
		median(&b->cold.error));
	fprintf(file, "tracked,%.3f,%.3f\n", median(&b->tracked.ms), median(&b->tracked.error));
	if (fclose(file) != 0)
		perror(path);
}

int main(int argc, char **argv)
{
	static struct bench b;
	if (argc != 2) {
		fprintf(stderr, "usage: %s BUILD\n", argv[0]);
		return 2;
	}
	if (!prepare(&b))
		return 1;
	lay_out(&b);
	const struct camera *camera = table_camera_truth(b.camera);
	for (int f = 0; f < FRAMES; f++) {
		b.ball[0].pos.x += 0.5 / 30;
		table_camera_render(b.camera, b.ball, BALLS, (uint64_t)f, &b.image.image);
		run_cold(&b, camera);
		run_cheaper(&b, camera);
		run_tracked(&b, f);
		run_hough(&b, camera);
		run_markers(&b);
	}
	struct report *report = report_open(argv[1], "bench.json");
	report_way(report, "cold", &b.cold, 10);
	report_way(report, "votes_only", &b.votes, NAN);
	report_way(report, "coarse_fit", &b.coarse, NAN);
	report_way(report, "tracked", &b.tracked, 3);
	report_way(report, "hough", &b.hough, NAN);
	report_number(report, "vision.hough_circles_alone_ms", median(&b.hough_alone), "ms");
	eval_bar(report, "vision.cold_over_hough_circles", median(&b.cold.ms) / median(&b.hough_alone), "ratio", 0.5);
	eval_bar(report, "vision.tracked_over_hough_circles", median(&b.tracked.ms) / median(&b.hough_alone), "ratio",
		 0.15);
	report_number(report, "vision.markers_ms", median(&b.markers), "ms");
	report_number(report, "vision.markers_near_ms", median(&b.markers_near), "ms");
	const char *data = getenv("DATA");
	time_photos(&b, data ? data : DATA);
	if (b.photo_hough.count > 0) {
		eval_bar(report, "vision.photos.cold_ms", median(&b.photo_cold), "ms", 10);
		report_number(report, "vision.photos.hough_circles_alone_ms", median(&b.photo_hough), "ms");
		eval_bar(report, "vision.photos.cold_over_hough_circles",
			 median(&b.photo_cold) / median(&b.photo_hough), "ratio", 0.5);
		eval_bar(report, "vision.photos.tracked_over_hough_circles",
			 median(&b.tracked.ms) / median(&b.photo_hough), "ratio", 0.15);
	}
	write_table(&b, argv[1]);
	return report_close(report) < 0;
}
