#include "app/commands/cmd.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "app/process/options.h"
#include "harness.h"

static char said[2048];

/* Runs with stdout and stderr going into said. */
static int heard(int (*run)(void *context), void *context)
{
	fflush(stdout);
	fflush(stderr);
	FILE *file = tmpfile();
	ck_assert_ptr_nonnull(file);
	int out = dup(1), err = dup(2);
	dup2(fileno(file), 1);
	dup2(fileno(file), 2);
	int status = run(context);
	fflush(stdout);
	fflush(stderr);
	dup2(out, 1);
	dup2(err, 2);
	close(out);
	close(err);
	rewind(file);
	size_t n = fread(said, 1, sizeof said - 1, file);
	said[n] = 0;
	fclose(file);
	return status;
}

/* ---- numbers ----------------------------------------------------------------------------------------------------- */

struct number {
	const char *text;
	double value;
};

START_TEST(numbers)
{
	const struct number good[] = {{"0", 0}, {"-10", -10}, {"2e4", 20000}, {"+.5", 0.5}, {"1.25", 1.25}};
	for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
		double value = 77;
		ck_assert(option_number(good[i].text, -10, 20000, &value));
		ck_assert_double_eq(value, good[i].value);
	}
	const char *const bad[] = {"",	   "x",	    "1x",      " 1",	"1 ",  "nan", "inf", "-inf",
				   "0x10", "1e999", "-10.001", "20001", "1,5", "--",  "."};
	for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
		double value = 77;
		ck_assert_msg(!option_number(bad[i], -10, 20000, &value), "\"%s\" was taken", bad[i]);
		ck_assert_double_eq(value, 77);
	}
}
END_TEST

/* ---- JSON and configuration -------------------------------------------------------------------------------------- */

static int print(void *context)
{
	return cmd_json_line(context);
}

START_TEST(json_lines)
{
	ck_assert_int_eq(heard(print, json_pack("{s:f, s:[s]}", "x", -565.8, "ids", "RED1")), CMD_OK);
	ck_assert_str_eq(said, "{\"x\":-565.8,\"ids\":[\"RED1\"]}\n");
	ck_assert_int_eq(heard(print, NULL), CMD_FAILED);
	ck_assert_str_eq(said, "");
}
END_TEST

static int load(void *context)
{
	static struct config config;
	return cmd_config(&config, context);
}

START_TEST(configurations)
{
	ck_assert_int_eq(heard(load, "config/snooker-12ft.conf"), CMD_OK);
	ck_assert_int_eq(heard(load, "/nonexistent"), CMD_BAD_INPUT);
	ck_assert_str_eq(said, "/nonexistent: No such file or directory\n");
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("cmd");
	TCase *tcase = tcase_create("shared");
	tcase_add_test(tcase, numbers);
	tcase_add_test(tcase, json_lines);
	tcase_add_test(tcase, configurations);
	suite_add_tcase(suite, tcase);
	return suite;
}
