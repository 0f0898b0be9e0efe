#include "vision/colour.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "app/config/colour_file.h"
#include "vision_scene.h"

static const float CLOTH[3] = {120, 150, 95};
/* BGR of painted balls, by enum ball_colour. */
static const uint8_t PAINT[COLOUR_CLASSES][3] = {{215, 235, 240}, {25, 15, 200},  {20, 170, 240},  {90, 110, 15},
						 {30, 45, 150},	  {200, 110, 20}, {150, 130, 235}, {30, 25, 30}};

/* A ball of one colour, its light changed by gain, with noise. */
static struct colour_feature look(struct random *r, enum ball_colour colour, double gain)
{
	enum { SIDE = 40 };
	static uint8_t data[SIDE * SIDE * 3];
	struct image image = {data, SIDE, SIDE, SIDE * 3};
	struct outline o = {.centre = {20, 20}, .radius_px = 15.5};
	float cloth[3];
	for (int i = 0; i < SIDE * SIDE * 3; i++)
		data[i] = (uint8_t)fmin(fmax(gain * PAINT[colour][i % 3] + 8 * scene_gauss(r), 0), 255);
	for (int c = 0; c < 3; c++)
		cloth[c] = (float)gain * CLOTH[c];
	return colour_measure(&image, &o, cloth);
}

static struct colour_model learned(struct random *r)
{
	struct colour_sample sample[COLOUR_CLASSES * 20];
	struct colour_model model;
	char err[128];
	for (int i = 0; i < COLOUR_CLASSES * 20; i++) {
		enum ball_colour colour = (enum ball_colour)(i % COLOUR_CLASSES);
		sample[i] = (struct colour_sample){look(r, colour, random_in(r, 0.85, 1.05)), random_in(r, 0.95, 1),
						   colour};
	}
	ck_assert_int_eq(colour_learn(sample, COLOUR_CLASSES * 20, &model, err, sizeof(err)), 0);
	ck_assert_int_eq(colour_model_check(&model, err, sizeof(err)), 0);
	return model;
}

START_TEST(test_learned_colours_are_told_apart_in_other_light)
{
	struct random r = random_begin("colours");
	struct colour_model model = learned(&r);
	struct colour_classifier classifier = colour_classifier(&model);
	for (int round = 0; round < 50; round++) {
		struct colour_feature feature[COLOUR_CLASSES];
		struct colour_verdict verdict[COLOUR_CLASSES];
		double gain = random_in(&r, 0.6, 1.1);
		for (int k = 0; k < COLOUR_CLASSES; k++)
			feature[k] = look(&r, (enum ball_colour)k, gain);
		colour_assign(&classifier, feature, COLOUR_CLASSES, verdict);
		for (int k = 0; k < COLOUR_CLASSES; k++)
			ck_assert_int_eq(verdict[k].colour, k);
	}
}
END_TEST

START_TEST(test_at_most_one_of_each_and_none_forced)
{
	struct random r = random_begin("colours_unique");
	struct colour_model model = learned(&r);
	struct colour_classifier classifier = colour_classifier(&model);
	for (int round = 0; round < 200; round++) {
		struct colour_feature feature[22];
		struct colour_verdict verdict[22];
		int seen[COLOUR_COUNT] = {0}, count = 1 + (int)random_in(&r, 0, 21.99);
		for (int i = 0; i < count; i++)
			feature[i] = look(&r, (enum ball_colour)random_in(&r, 0, 7.99), random_in(&r, 0.7, 1.1));
		colour_assign(&classifier, feature, count, verdict);
		for (int i = 0; i < count; i++) {
			seen[verdict[i].colour]++;
			ck_assert(verdict[i].confidence >= 0 && verdict[i].confidence <= 1);
		}
		for (int k = 0; k < COLOUR_CLASSES; k++)
			ck_assert(k == COLOUR_RED || seen[k] <= 1);
	}
	/* Reds alone stay reds. */
	struct colour_feature red[15];
	struct colour_verdict verdict[15];
	for (int i = 0; i < 15; i++)
		red[i] = look(&r, COLOUR_RED, 1);
	colour_assign(&classifier, red, 15, verdict);
	for (int i = 0; i < 15; i++)
		ck_assert_int_eq(verdict[i].colour, COLOUR_RED);
}
END_TEST

/* Two that look pink, one of them a little like red as well: the other keeps the pink, though it is the less likely pink. */
START_TEST(test_who_has_less_to_lose_gives_way)
{
	struct colour_model model = {.unknown_distance = 9};
	for (int k = COLOUR_RED; k <= COLOUR_PINK; k += COLOUR_PINK - COLOUR_RED) {
		model.class[k] = (struct colour_class){.samples = 9, .scale = 1, .scale_spread = 0.02};
		model.class[k].mean[0] = k == COLOUR_RED ? 0.1 : 0;
		for (int i = 0; i < COLOUR_FEATURES; i++)
			model.class[k].covariance[i][i] = 0.01;
	}
	struct colour_classifier classifier = colour_classifier(&model);
	struct colour_feature feature[2] = {{{0}}, {{-0.2}}};
	for (int swap = 0; swap < 2; swap++) {
		struct colour_verdict verdict[2];
		colour_assign(&classifier, feature, 2, verdict);
		ck_assert_int_eq(verdict[swap].colour, COLOUR_RED);
		ck_assert_int_eq(verdict[1 - swap].colour, COLOUR_PINK);
		/* It is more like what it must not be. */
		ck_assert_double_lt(verdict[swap].confidence, 0.5);
		ck_assert_double_gt(verdict[1 - swap].confidence, 0.9);
		struct colour_feature first = feature[0];
		feature[0] = feature[1];
		feature[1] = first;
	}
}
END_TEST

START_TEST(test_order_does_not_matter)
{
	struct random r = random_begin("colours_order");
	struct colour_model model = learned(&r);
	struct colour_classifier classifier = colour_classifier(&model);
	struct colour_feature feature[10], turned[10];
	struct colour_verdict a[10], b[10];
	for (int i = 0; i < 10; i++)
		feature[i] = look(&r, (enum ball_colour)(i % 3), random_in(&r, 0.8, 1.1));
	for (int i = 0; i < 10; i++)
		turned[i] = feature[9 - i];
	colour_assign(&classifier, feature, 10, a);
	colour_assign(&classifier, turned, 10, b);
	for (int i = 0; i < 10; i++)
		ck_assert_int_eq(a[i].colour, b[9 - i].colour);
}
END_TEST

START_TEST(test_what_is_like_no_ball_is_unknown)
{
	struct random r = random_begin("colours_unknown");
	struct colour_model model = learned(&r);
	struct colour_classifier classifier = colour_classifier(&model);
	struct colour_feature odd = {{3, -3, 2, 4, -4, 0.1}};
	struct colour_verdict verdict;
	colour_assign(&classifier, &odd, 1, &verdict);
	ck_assert_int_eq(verdict.colour, COLOUR_UNKNOWN);
	ck_assert_int_eq(colour_likeliest(&classifier, &odd), COLOUR_UNKNOWN);
	/* Nothing learned: everything is unknown. */
	struct colour_model empty = {.unknown_distance = 5};
	classifier = colour_classifier(&empty);
	colour_assign(&classifier, &odd, 1, &verdict);
	ck_assert_int_eq(verdict.colour, COLOUR_UNKNOWN);
}
END_TEST

START_TEST(test_bad_models_are_named)
{
	struct random r = random_begin("colour_model_check");
	struct colour_model good = learned(&r), bad = good;
	char err[160];
	bad.class[COLOUR_PINK].mean[2] = NAN;
	ck_assert_int_lt(colour_model_check(&bad, err, sizeof(err)), 0);
	ck_assert_ptr_nonnull(strstr(err, "PINK"));
	bad = good;
	bad.class[COLOUR_BLUE].covariance[0][1] += 0.01;
	ck_assert_int_lt(colour_model_check(&bad, err, sizeof(err)), 0);
	ck_assert_ptr_nonnull(strstr(err, "BLUE"));
	bad = good;
	bad.class[COLOUR_RED].covariance[0][1] = bad.class[COLOUR_RED].covariance[1][0] = 50;
	ck_assert_int_lt(colour_model_check(&bad, err, sizeof(err)), 0);
	ck_assert_ptr_nonnull(strstr(err, "positive definite"));
	bad = good;
	bad.unknown_distance = 0;
	ck_assert_int_lt(colour_model_check(&bad, err, sizeof(err)), 0);
	/* Too few samples of a class. */
	struct colour_sample two[2] = {{{{0}}, 1, COLOUR_RED}, {{{0}}, 1, COLOUR_RED}};
	ck_assert_int_lt(colour_learn(two, 2, &bad, err, sizeof(err)), 0);
	ck_assert_ptr_nonnull(strstr(err, "RED"));
}
END_TEST

/* ---- the file
 * -------------------------------------------------------------------------------------------------------- */

static char *temporary(void)
{
	static char path[64];
	snprintf(path, sizeof(path), "/tmp/billiard-colour-%ld.json", (long)getpid());
	return path;
}

START_TEST(test_file_keeps_every_bit)
{
	struct random r = random_begin("colour_file");
	struct colour_model model = learned(&r), back;
	char err[256];
	ck_assert_int_eq(colour_file_write(temporary(), &model, err, sizeof(err)), 0);
	ck_assert_int_eq(colour_file_read(temporary(), &back, err, sizeof(err)), 0);
	for (int k = 0; k < COLOUR_CLASSES; k++) {
		ck_assert_mem_eq(model.class[k].mean, back.class[k].mean, sizeof(back.class[k].mean));
		ck_assert_mem_eq(model.class[k].covariance, back.class[k].covariance, sizeof(back.class[k].covariance));
		ck_assert(model.class[k].scale == back.class[k].scale &&
			  model.class[k].samples == back.class[k].samples);
	}
	unlink(temporary());
}
END_TEST

static void expect_error(const char *text, const char *place)
{
	struct colour_model model = {.unknown_distance = 42};
	char err[256] = "";
	FILE *file = fopen(temporary(), "w");
	ck_assert_ptr_nonnull(file);
	fputs(text, file);
	fclose(file);
	ck_assert_int_lt(colour_file_read(temporary(), &model, err, sizeof(err)), 0);
	ck_assert_msg(strstr(err, place) && strstr(err, temporary()), "\"%s\" should name %s", err, place);
	ck_assert(model.unknown_distance == 42);
	unlink(temporary());
}

START_TEST(test_file_errors_name_the_place)
{
	struct colour_model model;
	char err[256];
	expect_error("", ":");
	expect_error("{\n\"unknown_distance\": 9,\n\"classes\": {", ":3");
	expect_error("[1]", "object");
	expect_error("{\"classes\": {}}", "unknown_distance");
	expect_error("{\n\"unknown_distance\": \"far\",\n\"classes\": {}}", ":2");
	expect_error("{\n\"unknown_distance\": 9,\n\"classes\": {\n\"MAUVE\": {}}}", ":4: MAUVE");
	expect_error("{\n\"unknown_distance\": 9,\n\"classes\": {\n\"RED\": {\n\"samples\": 0}}}", ":5: RED.samples");
	expect_error("{\n\"unknown_distance\": 9,\n\"classes\": {\n\"RED\": {\"samples\": 5, \"scale\": 1, "
		     "\"scale_spread\": 1,\n"
		     "\"mean\": [1, 2]}}}",
		     ":5: RED.mean");
	expect_error("{\"unknown_distance\": -1, \"classes\": {}}", "unknown_distance");
	ck_assert_int_lt(colour_file_read("/nowhere/colours.json", &model, err, sizeof(err)), 0);
	ck_assert_ptr_nonnull(strstr(err, "/nowhere/colours.json"));
	ck_assert_int_lt(colour_file_write("/nowhere/colours.json", &model, err, sizeof(err)), 0);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("colour");
	TCase *tc = tcase_create("colour");
	tcase_add_test(tc, test_learned_colours_are_told_apart_in_other_light);
	tcase_add_test(tc, test_at_most_one_of_each_and_none_forced);
	tcase_add_test(tc, test_who_has_less_to_lose_gives_way);
	tcase_add_test(tc, test_order_does_not_matter);
	tcase_add_test(tc, test_what_is_like_no_ball_is_unknown);
	tcase_add_test(tc, test_bad_models_are_named);
	tcase_add_test(tc, test_file_keeps_every_bit);
	tcase_add_test(tc, test_file_errors_name_the_place);
	suite_add_tcase(suite, tc);
	return suite;
}
