#include "app/commands/status_print.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/cmd.h"
#include "app/commands/status_listen.h"
#include "app/process/text.h"
#include "harness.h"

static billiard_status_t status;
static struct status_heard heard;

static void set(uint8_t *bytes, size_t size, const char *text)
{
	text_set(bytes, size, text);
}
#define SET(member, text) set(status.member, sizeof status.member, text)

static void setup(void)
{
	memset(&heard, 0, sizeof heard);
	memset(&status, 0, sizeof status);
	status.pid = 17;
	status.utime = 5000000;
	status.started_utime = 2000000;
	status.error_utime = 3000000;
	SET(process, "billiard-vision");
	SET(state, "photo K\xc3\xb6"
		   "ln \"1\".png");
	SET(error, "a\\b: \xe2\x82\xac");
	status.metric_count = 2;
	SET(metrics[0].name, "frames");
	SET(metrics[0].unit, "1");
	status.metrics[0].value = 30;
	SET(metrics[1].name, "work");
	SET(metrics[1].unit, "\xc2\xb5s");
	status.metrics[1].value = NAN;
}

/* Whatever the texts: what comes out is JSON that holds them. */
START_TEST(json_escapes)
{
	json_t *object = status_json(&status);
	char *text = json_dumps(object, JSON_COMPACT);
	json_t *back = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
	ck_assert_ptr_nonnull(back);
	ck_assert_str_eq(json_string_value(json_object_get(back, "state")), "photo K\xc3\xb6"
									    "ln \"1\".png");
	ck_assert_str_eq(json_string_value(json_object_get(back, "error")), "a\\b: \xe2\x82\xac");
	json_t *work = json_object_get(json_object_get(back, "metrics"), "work");
	ck_assert_str_eq(json_string_value(json_object_get(work, "unit")), "\xc2\xb5s");
	ck_assert(json_is_null(json_object_get(work, "value"))); /* JSON has no NaN, and the line must not be lost */
	ck_assert_double_eq(json_number_value(json_object_get(back, "up_s")), 3);
	ck_assert_double_eq(json_number_value(json_object_get(back, "error_age_s")), 2);
	json_decref(back);
	json_decref(object);
	free(text);
}
END_TEST

/* Any bytes: a line of JSON each time. */
START_TEST(random_bytes_are_json)
{
	struct random random = random_begin("random_bytes_are_json");
	for (int round = 0; round < 2000; round++) {
		for (size_t i = 0; i < sizeof status.state; i++)
			status.state[i] = (uint8_t)random_u64(&random);
		for (size_t i = 0; i < sizeof status.metrics[0].name; i++)
			status.metrics[0].name[i] = (uint8_t)random_u64(&random);
		json_t *object = status_json(&status);
		ck_assert_ptr_nonnull(object);
		char *text = json_dumps(object, JSON_COMPACT);
		ck_assert_ptr_nonnull(text);
		ck_assert_ptr_null(strchr(text, '\n'));
		free(text);
		json_decref(object);
	}
}
END_TEST

START_TEST(lines_for_people)
{
	char *text = NULL;
	size_t size;
	FILE *file = open_memstream(&text, &size);
	status_print_line(&status, file);
	fclose(file);
	ck_assert_msg(strstr(text, "K\xc3\xb6"
				   "ln \"1\".png") &&
			      strstr(text, ", frames 30,") && strstr(text, " \xc2\xb5s\n") &&
			      strstr(text, "last error, 2 s ago: a\\b: \xe2\x82\xac\n"),
		      "%s", text);
	free(text);
}
END_TEST

START_TEST(texts_from_outside)
{
	json_t *good = cmd_json_text("K\xc3\xb6ln"), *bad = cmd_json_text("K\xf6ln");
	ck_assert_str_eq(json_string_value(good), "K\xc3\xb6ln");
	ck_assert_str_eq(json_string_value(bad), "K?ln");
	json_decref(good);
	json_decref(bad);
}
END_TEST

START_TEST(newest_of_each_process)
{
	ck_assert(status_take(&heard, &status));
	status.received = 5;
	ck_assert(status_take(&heard, &status));
	ck_assert_int_eq(heard.count, 1);
	ck_assert_int_eq(heard.status[0].received, 5);
	status.pid = 18;
	ck_assert(status_take(&heard, &status));
	ck_assert_int_eq(heard.count, 2);
	ck_assert(status_knows(&heard, "billiard-vision"));
	ck_assert(!status_knows(&heard, "billiard-visio"));
	ck_assert(!status_knows(&heard, "billiard-planner"));
}
END_TEST

START_TEST(counts_and_room)
{
	status.metric_count = (int)(sizeof status.metrics / sizeof status.metrics[0]);
	ck_assert(status_take(&heard, &status));
	status.metric_count++;
	ck_assert(!status_take(&heard, &status));
	status.metric_count = -1;
	ck_assert(!status_take(&heard, &status));
	status.metric_count = 0;
	for (int i = 1; i < STATUS_PROCESS_MAX; i++) {
		status.pid = 100 + i;
		ck_assert(status_take(&heard, &status));
	}
	status.pid = 1000;
	ck_assert(!status_take(&heard, &status));
	status.pid = 101;
	ck_assert(status_take(&heard, &status)); /* a known one still has its place */
	ck_assert_int_eq(heard.count, STATUS_PROCESS_MAX);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("status");
	TCase *tcase = tcase_create("status");
	tcase_add_checked_fixture(tcase, setup, NULL);
	tcase_add_test(tcase, json_escapes);
	tcase_add_test(tcase, random_bytes_are_json);
	tcase_add_test(tcase, lines_for_people);
	tcase_add_test(tcase, texts_from_outside);
	tcase_add_test(tcase, newest_of_each_process);
	tcase_add_test(tcase, counts_and_room);
	suite_add_tcase(suite, tcase);
	return suite;
}
