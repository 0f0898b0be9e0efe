/* Detection on the real photographs: the bars that must hold at every change. The finer figures are make eval's. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/colour_file.h"
#include "app/config/config.h"
#include "vision_scene.h"

struct sums {
	int images, balls, lost, ghosts, labelled, right;
	double error[2000];
	int errors;
};

static int by_value(const void *a, const void *b)
{
	const double *x = a, *y = b;
	return (*x > *y) - (*x < *y);
}

static double number(const json_t *object, const char *key)
{
	return json_number_value(json_object_get(object, key));
}

static int nearest(const struct vision_result *r, const bool *used, vec2 at, bool in_px, double reach)
{
	int best = -1;
	for (int i = 0; i < r->ball_count; i++) {
		double d = vec2_dist(in_px ? r->ball[i].px : r->ball[i].pos, at);
		if (!used[i] && d < reach) {
			reach = d;
			best = i;
		}
	}
	return best;
}

static void compare(const json_t *entry, const struct vision_result *r, struct sums *s)
{
	size_t i;
	const json_t *ball;
	bool used[VISION_BALL_MAX] = {false}, classed[VISION_BALL_MAX] = {false};
	json_t *reference = json_object_get(entry, "reference"), *classes = json_object_get(entry, "classes");
	json_array_foreach(reference, i, ball)
	{
		vec2 at = {number(ball, "x_mm") / 1000, number(ball, "y_mm") / 1000};
		int k = nearest(r, used, at, false, 0.015);
		s->balls++;
		s->lost += k < 0;
		if (k < 0)
			continue;
		used[k] = true;
		s->error[s->errors++] = 1000 * vec2_dist(r->ball[k].pos, at);
	}
	for (int k = 0; k < r->ball_count && reference; k++)
		s->ghosts += !used[k];
	json_array_foreach(classes, i, ball)
	{
		int k = nearest(r, classed, (vec2){number(ball, "px"), number(ball, "py")}, true,
				10 * r->camera.in.width / 1280.0);
		if (k < 0)
			continue;
		classed[k] = true;
		s->labelled++;
		s->right += strcmp(ball_colour_name(r->ball[k].colour),
				   json_string_value(json_object_get(ball, "type"))) == 0;
	}
}

static struct vision *make_vision(struct config *config, struct colour_model *colours)
{
	char err[640];
	struct vision *vision;
	ck_assert_msg(config_load(config, "config/thesis-table.conf", err, sizeof(err)) == 0, "%s", err);
	ck_assert_msg(colour_file_read(config->colours, colours, err, sizeof(err)) == 0, "%s", err);
	struct vision_def def = config_vision_def(config, colours);
	ck_assert_msg(vision_create(&vision, &def, err, sizeof(err)) == 0, "%s", err);
	return vision;
}

START_TEST(test_photographs)
{
	static struct config config;
	static struct sums s;
	struct colour_model colours;
	struct image_buffer image = {0};
	const char *data = test_data_folder("photographs");
	char path[512], err[256];
	size_t i;
	json_t *entry;
	if (!data)
		return;
	snprintf(path, sizeof(path), "%s/photos/labels.json", data);
	json_t *labels = json_load_file(path, 0, NULL);
	ck_assert_ptr_nonnull(labels);
	struct vision *vision = make_vision(&config, &colours);
	json_array_foreach(labels, i, entry)
	{
		const char *name = json_string_value(json_object_get(entry, "image"));
		struct vision_result r;
		snprintf(path, sizeof(path), "%s/photos/%s", data, name);
		ck_assert_msg(image_read(path, &image, err, sizeof(err)) == 0, "%s", err);
		ck_assert_msg(vision_detect(vision, &image.image, &r, err, sizeof(err)) == 0, "%s", err);
		ck_assert_msg(r.calibration == CALIBRATION_FRESH, "%s: %s", name, r.reason);
		compare(entry, &r, &s);
		s.images++;
		if (strncmp(name, "specials", 8) == 0) {
			ck_assert_int_eq(r.ball_count, 22);
			ck_assert(r.occluded);
		}
	}
	qsort(s.error, (size_t)s.errors, sizeof(*s.error), by_value);
	printf("photographs: %d images, %d balls, %d lost, %d ghosts, median %.2f mm, colours %d of %d\n", s.images,
	       s.balls, s.lost, s.ghosts, s.error[s.errors / 2], s.right, s.labelled);
	ck_assert_int_eq(s.lost, 0);
	ck_assert_int_eq(s.ghosts, 0);
	ck_assert_double_lt(s.error[s.errors / 2], 1.6);
	ck_assert_int_ge(100 * s.right, 99 * s.labelled);
	vision_destroy(vision);
	image_buffer_finish(&image);
	json_decref(labels);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("vision_photos");
	TCase *tc = tcase_create("photos");
	tcase_add_test(tc, test_photographs);
	tcase_set_timeout(tc, 180);
	suite_add_tcase(suite, tc);
	return suite;
}
