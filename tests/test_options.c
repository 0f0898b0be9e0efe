#include "app/process/options.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/commands/cmd.h"
#include "harness.h"

struct line {
	const char *file, *text, *choice;
	double number;
	int whole;
	bool flag;
	char guard;
};

static const char *names(void)
{
	return "one, two-and-a-half, three";
}

static const struct option_row rows[] = {
	{.name = "file",
	 .letter = 'f',
	 .type = OPTION_FILE,
	 .offset = offsetof(struct line, file),
	 .value = "FILE",
	 .help = "a file"},
	{.name = "text", .type = OPTION_TEXT, .offset = offsetof(struct line, text), .value = "T", .help = "a text"},
	{.name = "choice",
	 .type = OPTION_CHOICE,
	 .offset = offsetof(struct line, choice),
	 .value = "C",
	 .help = "which",
	 .names = names},
	{.name = "number",
	 .type = OPTION_NUMBER,
	 .offset = offsetof(struct line, number),
	 .value = "N",
	 .help = "how much",
	 .low = -1,
	 .high = 2.5},
	{.name = "whole",
	 .letter = 'w',
	 .type = OPTION_WHOLE,
	 .offset = offsetof(struct line, whole),
	 .value = "N",
	 .help = "how many",
	 .low = 1,
	 .high = 4},
	{.name = "flag", .letter = 'x', .type = OPTION_FLAG, .offset = offsetof(struct line, flag), .help = ".whether"},
	{.name = NULL},
};

static struct options table = {
	.name = "try",
	.summary = "a try",
	.operands = "THING...",
	.operand_min = 1,
	.operand_max = 2,
	.wants = "wants one or two things",
	.row = rows,
	.notes = "a note",
};

static void setup(void)
{
	table.operand_min = 1;
	table.operand_max = 2;
	table.in_order = false;
	table.operand_names = NULL;
}

static char said[8192];
static struct line line;
static char *argv[16];
static int argc, first;

/* Reads a command line, words parted by blanks; what is printed goes to said. */
static enum options_outcome read_line(const char *text)
{
	static char words[256];
	snprintf(words, sizeof words, "%s", text);
	argc = 0;
	static char name[] = "billiard try";
	argv[argc++] = name;
	for (char *word = strtok(words, " "); word; word = strtok(NULL, " "))
		argv[argc++] = word;
	argv[argc] = NULL;
	line = (struct line){.number = 7, .whole = 7, .guard = 42};
	fflush(stdout);
	FILE *file = tmpfile();
	int out = dup(1), err = dup(2);
	dup2(fileno(file), 1);
	dup2(fileno(file), 2);
	enum options_outcome outcome = options_read(&table, argc, argv, &line, &first);
	fflush(stdout);
	fflush(stderr);
	dup2(out, 1);
	dup2(err, 2);
	close(out);
	close(err);
	rewind(file);
	said[fread(said, 1, sizeof said - 1, file)] = '\0';
	fclose(file);
	ck_assert_int_eq(line.guard, 42);
	return outcome;
}

START_TEST(members_are_filled)
{
	ck_assert_int_eq(read_line("-f a --text b --choice=two-and-a-half --number -1 -w 4 -x thing"), OPTIONS_READ);
	ck_assert_str_eq(said, "");
	ck_assert_str_eq(line.file, "a");
	ck_assert_str_eq(line.text, "b");
	ck_assert_str_eq(line.choice, "two-and-a-half");
	ck_assert_double_eq(line.number, -1);
	ck_assert_int_eq(line.whole, 4);
	ck_assert(line.flag);
	ck_assert_str_eq(argv[first], "thing");
}
END_TEST

START_TEST(what_is_not_given_stays)
{
	ck_assert_int_eq(read_line("thing other"), OPTIONS_READ);
	ck_assert_ptr_null(line.file);
	ck_assert_double_eq(line.number, 7);
	ck_assert_int_eq(line.whole, 7);
	ck_assert(!line.flag);
	ck_assert_int_eq(argc - first, 2);
}
END_TEST

START_TEST(options_and_operands_in_any_order)
{
	ck_assert_int_eq(read_line("thing -w 2 - --flag"), OPTIONS_READ);
	ck_assert_int_eq(line.whole, 2);
	ck_assert(line.flag);
	ck_assert_str_eq(argv[first], "thing");
	ck_assert_str_eq(argv[first + 1], "-");
}
END_TEST

START_TEST(options_end_at_the_first_operand)
{
	table.in_order = true;
	ck_assert_int_eq(read_line("-w 2 thing --flag"), OPTIONS_READ);
	ck_assert(!line.flag);
	ck_assert_str_eq(argv[first + 1], "--flag");
}
END_TEST

static const struct {
	const char *text, *said;
} bad[] = {
	{"-w 5x thing", "--whole: found \"5x\", allowed a whole number 1 to 4\n"},
	{"-w 0 thing", "--whole: found \"0\", allowed a whole number 1 to 4\n"},
	{"-w 5 thing", "--whole: found \"5\", allowed a whole number 1 to 4\n"},
	{"-w 4294967298 thing", "--whole: found \"4294967298\", allowed a whole number 1 to 4\n"},
	{"-w 1.0 thing", "--whole: found \"1.0\", allowed a whole number 1 to 4\n"},
	{"--number 0.5abc thing", "--number: found \"0.5abc\", allowed a number -1 to 2.5\n"},
	{"--number nan thing", "--number: found \"nan\", allowed a number -1 to 2.5\n"},
	{"--number 0x1 thing", "--number: found \"0x1\", allowed a number -1 to 2.5\n"},
	{"--number 2.500001 thing", "--number: found \"2.500001\", allowed a number -1 to 2.5\n"},
	{"--number -1.000001 thing", "--number: found \"-1.000001\", allowed a number -1 to 2.5\n"},
	{"--choice on thing", "--choice: found \"on\", allowed one, two-and-a-half, three\n"},
	{"--choice one, thing", "--choice: found \"one,\", allowed one, two-and-a-half, three\n"},
	{"--choice= thing", "--choice: found \"\", allowed one, two-and-a-half, three\n"},
	{"", "billiard try: wants one or two things (see billiard try --help)\n"},
	{"a b c", "billiard try: wants one or two things (see billiard try --help)\n"},
	{"--dance a", "billiard try: unrecognized option '--dance'\n"},
	{"-q a", "billiard try: invalid option -- 'q'\n"},
	{"a --number", "billiard try: option '--number' requires an argument\n"},
	{"--flag=1 a", "billiard try: option '--flag' doesn't allow an argument\n"},
};

START_TEST(refused_with_one_line)
{
	ck_assert_int_eq(read_line(bad[_i].text), OPTIONS_REFUSED);
	ck_assert_str_eq(said, bad[_i].said);
	if (strstr(bad[_i].text, "thing")) {
		ck_assert_double_eq(line.number, 7);
		ck_assert_int_eq(line.whole, 7);
		ck_assert_ptr_null(line.choice);
	}
}
END_TEST

START_TEST(extra_words)
{
	table.operand_min = table.operand_max = 0;
	ck_assert_int_eq(read_line("--flag now"), OPTIONS_REFUSED);
	ck_assert_str_eq(said, "billiard try: unexpected argument \"now\" (see billiard try --help)\n");
	ck_assert_int_eq(read_line("--flag"), OPTIONS_READ);
}
END_TEST

START_TEST(help_says_all)
{
	ck_assert_int_eq(read_line("--help --dance"), OPTIONS_ANSWERED);
	ck_assert_str_eq(said, "usage: billiard try [OPTION...] THING...\na try\n\n"
			       "  -f, --file FILE        a file\n"
			       "  --text T               a text\n"
			       "  --choice C             which: one, two-and-a-half, three\n"
			       "  --number N             how much, -1 to 2.5\n"
			       "  -w, --whole N          how many, 1 to 4\n"
			       "  -x, --flag             .whether\n"
			       "  -h, --help             says this\n\na note\n");
}
END_TEST

/* What a table prints into memory. Caller frees. */
static char *printed(const char *option, bool man)
{
	char *text = NULL;
	size_t size;
	FILE *file = open_memstream(&text, &size);
	if (man)
		options_man(&table, "0.1", file);
	else
		options_complete(&table, option, file);
	fclose(file);
	return text;
}

START_TEST(completion)
{
	const char *const wanted[][2] = {
		{NULL, "--file\n--text\n--choice\n--number\n--whole\n--flag\n--help\n"},
		{"--choice", "one\ntwo-and-a-half\nthree\n"},
		{"--file", ""},
		{"choice", ""},
		{"--", ""},
	};
	for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
		char *text = printed(wanted[i][0], false);
		ck_assert_str_eq(text, wanted[i][1]);
		free(text);
	}
	table.operand_names = names;
	char *text = printed(NULL, false);
	ck_assert_ptr_nonnull(strstr(text, "--help\none\ntwo-and-a-half\nthree\n"));
	free(text);
}
END_TEST

/* No line of a text may become a request of troff. */
START_TEST(man_page)
{
	char *text = printed(NULL, true);
	ck_assert_ptr_nonnull(strstr(text, "\n.SH NAME\nbilliard\\-try \\- a try\n"));
	ck_assert_ptr_nonnull(strstr(text, "\n.TP\n.B \\-w, \\-\\-whole N\nhow many, 1 to 4\n"));
	ck_assert_ptr_nonnull(strstr(text, "\n\\&.whether\n"));
	free(text);
}
END_TEST

/* The tables of the commands: names, letters and members once each, ranges that are ranges, defaults inside. */
enum { COMMANDS = 10 };
static const struct options *const commands[COMMANDS] = {
	&detect_options, &plan_options,	   &simulate_options, &calibrate_options, &run_options,
	&status_options, &control_options, &demo_options,     &judge_options,	  &match_options};

START_TEST(tables_are_sound)
{
	const struct options *o = commands[_i];
	ck_assert(o->name && o->summary && o->operands && o->notes && o->operand_min <= o->operand_max);
	ck_assert(o->operand_max == 0 || o->wants);
	int count = 0;
	for (const struct option_row *row = o->row; row->name; row++, count++) {
		ck_assert_msg(row->help != NULL, "%s --%s", o->name, row->name);
		ck_assert_int_eq(row->type == OPTION_FLAG, row->value == NULL);
		ck_assert_msg(row->type != OPTION_CHOICE || row->names, "%s --%s", o->name, row->name);
		if (row->type == OPTION_NUMBER || row->type == OPTION_WHOLE)
			ck_assert_msg(row->low < row->high, "%s --%s", o->name, row->name);
		ck_assert_str_ne(row->name, "help");
		for (const struct option_row *other = o->row; other != row; other++) {
			ck_assert_str_ne(row->name, other->name);
			ck_assert_msg(row->offset != other->offset, "%s --%s", o->name, row->name);
			ck_assert(!row->letter || row->letter != other->letter);
		}
	}
	ck_assert_int_le(count, OPTIONS_ROWS_MAX);
}
END_TEST

START_TEST(names_of_targets_are_colours)
{
	const struct option_row *row = plan_options.row;
	while (strcmp(row->name, "target") != 0)
		row++;
	for (int c = COLOUR_RED; c <= COLOUR_BLACK; c++)
		ck_assert(option_is_name(row->names(), ball_colour_name((enum ball_colour)c)));
	ck_assert(option_is_name(row->names(), "any") && option_is_name(row->names(), "rules"));
	ck_assert(!option_is_name(row->names(), "WHITE") && !option_is_name(row->names(), ""));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("options");
	TCase *tcase = tcase_create("options");
	tcase_add_checked_fixture(tcase, setup, NULL);
	tcase_add_test(tcase, members_are_filled);
	tcase_add_test(tcase, what_is_not_given_stays);
	tcase_add_test(tcase, options_and_operands_in_any_order);
	tcase_add_test(tcase, options_end_at_the_first_operand);
	tcase_add_loop_test(tcase, refused_with_one_line, 0, sizeof bad / sizeof *bad);
	tcase_add_test(tcase, extra_words);
	tcase_add_test(tcase, help_says_all);
	tcase_add_test(tcase, completion);
	tcase_add_test(tcase, man_page);
	tcase_add_loop_test(tcase, tables_are_sound, 0, COMMANDS);
	tcase_add_test(tcase, names_of_targets_are_colours);
	suite_add_tcase(suite, tcase);
	return suite;
}
