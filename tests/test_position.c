#include "app/config/position.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "harness.h"
#include "scenes.h"

enum { ERR_SIZE = 256 };
static struct table table;
static struct position position;
static char err[ERR_SIZE];

static void setup(void)
{
	table = scene_thesis_table();
	memset(&position, 0x5a, sizeof position);
	err[0] = 0;
}

static int parse(const char *text)
{
	return position_parse(&position, &table, "p.txt", text, strlen(text), err, sizeof err);
}

/* ---- what is accepted -------------------------------------------------------------------------------------------- */

START_TEST(thesis_example)
{
	ck_assert_msg(parse("WHITE0, WHITE, -300, 0\nRED1, RED, -150, -300\nV, 1200, 340\n") == 0, "%s", err);
	ck_assert_int_eq(position.count, 2);
	ck_assert_str_eq(position.name[0], "WHITE0");
	ck_assert_double_eq(position.ball[0].pos.x, -0.3);
	ck_assert_double_eq(position.ball[1].pos.y, -0.3);
	ck_assert_int_eq(position.ball[1].colour, COLOUR_RED);
	ck_assert_int_eq(position.ball[1].phase, BALL_REST);
	ck_assert(position.has_velocity);
	ck_assert_double_eq(position.velocity.x, 1.2);
	ck_assert_double_eq(position.velocity.y, 0.34);
	ck_assert_int_eq(position_cue(&position), 0);
	ck_assert_int_eq(position_find(&position, "RED1"), 1);
	ck_assert_int_eq(position_find(&position, "RED2"), -1);
}
END_TEST

START_TEST(comments_blanks_and_line_ends)
{
	ck_assert_msg(parse("# all\r\n\r\n  \t\r\nR ,RED,\t1.5e1 , +0 # trailing, with, commas, and, "
			    "more\r\n#\nU,UNKNOWN,-200,.5") == 0,
		      "%s", err);
	ck_assert_int_eq(position.count, 2);
	ck_assert_double_eq(position.ball[0].pos.x, 0.015);
	ck_assert_double_eq(position.ball[1].pos.y, 0.0005);
	ck_assert(!position.has_velocity);
	ck_assert_int_eq(position_cue(&position), -1);
}
END_TEST

START_TEST(touching_balls)
{
	ck_assert_msg(parse("A, RED, 0, 0\nB, RED, 52.3, 0\nC, RED, -52.25, 0\n") == 0, "%s", err);
}
END_TEST

/* Any position that can be written down is read back to the digit. */
START_TEST(random_positions_come_back)
{
	struct random random = random_begin("random_positions_come_back");
	for (int round = 0; round < 200; round++) {
		char text[4096] = "";
		vec2 at[BALL_MAX];
		int count = 1 + (int)(random_u64(&random) % BALL_MAX);
		for (int i = 0; i < count; i++) {
			at[i] = (vec2){-0.9 + 0.08 * i, random_in(&random, -0.4, 0.4)};
			char line[96];
			snprintf(line, sizeof line, "B%d,%s,%.17g,%.17g\n", i, i ? "RED" : "WHITE", at[i].x * 1000,
				 at[i].y * 1000);
			strcat(text, line);
		}
		ck_assert_msg(parse(text) == 0, "%s", err);
		ck_assert_int_eq(position.count, count);
		for (int i = 0; i < count; i++)
			ck_assert_double_eq_tol(vec2_dist(position.ball[i].pos, at[i]), 0, 1e-15);
	}
}
END_TEST

/* What `billiard detect --json` prints. */
START_TEST(seen_balls)
{
	ck_assert_msg(
		parse("{\"image\":\"a.png\",\"calibrated\":true,\"balls\":[{\"type\":\"RED\",\"x\":-565.8,\"y\":1,"
		      "\"px\":3},{\"type\":\"WHITE\",\"x\":0,\"y\":0},{\"type\":\"RED\",\"x\":100,\"y\":100}]}\n") == 0,
		"%s", err);
	ck_assert_int_eq(position.count, 3);
	ck_assert_str_eq(position.name[0], "RED1");
	ck_assert_str_eq(position.name[1], "WHITE1");
	ck_assert_str_eq(position.name[2], "RED2");
	ck_assert_double_eq_tol(position.ball[0].pos.x, -0.5658, 1e-15);
	ck_assert_int_eq(position_cue(&position), 1);
	ck_assert(!position.has_velocity);
}
END_TEST

/* What Windows' editors make of a text: a mark before it, carriage returns. */
START_TEST(byte_order_mark)
{
	char path[] = "/tmp/billiard-position-XXXXXX";
	static const char text[] = "\xef\xbb\xbfW, WHITE, 1, 2\r\nR, RED, 300, 0\r\n";
	int fd = mkstemp(path);
	ck_assert_int_eq(write(fd, text, sizeof text - 1), (ssize_t)sizeof text - 1);
	close(fd);
	int code = position_read(&position, &table, path, err, sizeof err);
	unlink(path);
	ck_assert_msg(code == 0, "%s", err);
	ck_assert_str_eq(position.name[0], "W");
	ck_assert_int_eq(position.count, 2);
}
END_TEST

/* ---- what is refused --------------------------------------------------------------------------------------------- */

static const struct {
	const char *text, *message;
} bad[] = {
	{"W, WHITE, 0, 0\nX, WHITE, 100, 0\n", "p.txt:2: a second cue ball, X"},
	{"A, RED, 0, 0\n\nA, RED, 100, 0\n", "p.txt:3: A is there twice"},
	{"A, PURPLE, 0, 0\n", "p.txt:1: unknown type \"PURPLE\""},
	{"A, red, 0, 0\n", "p.txt:1: unknown type \"red\": in capitals, \"RED\""},
	{"A; RED; 0; 0\n", "p.txt:1: found ';', fields are parted by commas"},
	{"A, RED; 0, 0, 0\n", "p.txt:1: found ';', fields are parted by commas"},
	{"B\xc3\xa4ll, RED, 0, 0\n", "p.txt:1: field 1 holds a character that is not ASCII"},
	{"{\"balls\":[{\"type\":\"RED\",\"x\":1}]}", "p.txt:1: balls[0]: type, x and y are wanted"},
	{"{\"balls\":[{\"type\":\"red\",\"x\":1,\"y\":1}]}", "p.txt:1: unknown type \"red\": in capitals"},
	{"{\"balls\":[{\"type\":\"RED\",\"x\":1e9,\"y\":1}]}", "p.txt:1: balls[0]: not within +-100000 mm"},
	{"{\"balls\":[]}", "p.txt: no balls"},
	{"{\"balls\":{}}", "p.txt:1: a list \"balls\" is wanted"},
	{"{\"balls\":[\n", "p.txt:2: "},
	{"{\"balls\":[]}\n{\"balls\":[]}\n", "p.txt:2: end of file expected"},
	{"{\"calibrated\":false,\"reason\":\"no markers\",\"balls\":[]}", "p.txt:1: not calibrated: no markers"},
	{"A, RED, 0, 0\nB, RED, 50, 0\n", "p.txt:2: B overlaps A"},
	{"A, RED, 0, 0\nB, RED, 0, 0\n", "p.txt:2: B overlaps A"},
	{"A, RED, 0, 0\n# off\nB, RED, 950, 0\n", "p.txt:3: B: (950.0, 0.0) mm is not on the bed"},
	{"A, RED, nan, 0\n", "p.txt:1: \"nan\" is not a number"},
	{"A, RED, 0, inf\n", "p.txt:1: \"inf\" is not a number"},
	{"A, RED, 1e999, 0\n", "p.txt:1: \"1e999\" is not a number"},
	{"A, RED, 0x10, 0\n", "p.txt:1: \"0x10\" is not a number"},
	{"A, RED, 1 2, 0\n", "p.txt:1: field 3 is no word or number"},
	{"A, RED, , 0\n", "p.txt:1: \"\" is not a number"},
	{"A, RED, 1-, 0\n", "p.txt:1: \"1-\" is not a number"},
	{"A, RED, 0\n", "p.txt:1: found 3 fields"},
	{"A\n", "p.txt:1: found 1 fields"},
	{"A, RED, 0, 0, 0\n", "p.txt:1: more than 4 fields"},
	{", RED, 0, 0\n", "p.txt:1: an ID has 1 to 15 characters"},
	{"A234567890123456, RED, 0, 0\n", "p.txt:1: an ID has 1 to 15 characters"},
	{"W, WHITE, 0, 0\nV, 1, 2\nV, 1, 2\n", "p.txt:3: a second V line"},
	{"W, WHITE, 0, 0\nV, 20001, 0\n", "p.txt:2: \"20001\" is not a number within +-20000 mm/s"},
	{"W, WHITE, 0, 0\nV, 15000, 15000\n", "p.txt:2: faster than 20000 mm/s"},
	{"R, RED, 0, 0\nV, 1, 2\n", "p.txt: a V line but no cue ball"},
	{"", "p.txt: no balls"},
	{"# nothing\n", "p.txt: no balls"},
	{"A, RED, 0, 0\n\x01\n", "p.txt:2: field 1 is no word or number"},
};

START_TEST(refused_with_place)
{
	struct position before = position;
	ck_assert_int_eq(parse(bad[_i].text), -EINVAL);
	ck_assert_msg(strncmp(err, bad[_i].message, strlen(bad[_i].message)) == 0, "\n   got %s\nwanted %s", err,
		      bad[_i].message);
	ck_assert_msg(memcmp(&before, &position, sizeof position) == 0, "position was touched");
}
END_TEST

START_TEST(too_many_balls)
{
	char text[2048] = "";
	for (int i = 0; i <= BALL_MAX; i++)
		sprintf(text + strlen(text), "B%d, RED, %d, 0\n", i, -900 + 60 * i);
	ck_assert_int_eq(parse(text), -EINVAL);
	ck_assert_str_eq(err, "p.txt:23: more than 22 balls");
}
END_TEST

START_TEST(unreadable_files)
{
	ck_assert_int_eq(position_read(&position, &table, "/nonexistent.txt", err, sizeof err), -ENOENT);
	ck_assert_str_eq(err, "/nonexistent.txt: No such file or directory");
	ck_assert_int_eq(position_read(&position, &table, "/tmp", err, sizeof err), -EISDIR);
	ck_assert_int_eq(position_read(&position, &table, "/dev/zero", err, sizeof err), -EFBIG);
}
END_TEST

/* Random bytes of the alphabet that matters: never a crash, and what is accepted is a valid position. */
START_TEST(random_texts)
{
	static const char alphabet[] = "AV,,,,RED WHITE0123456789.-+e#\n\n\r\t\x7f\xc3;{}[]\":";
	struct random random = random_begin("random_texts");
	for (int round = 0; round < 100000; round++) {
		char text[64];
		size_t size = random_u64(&random) % sizeof text;
		for (size_t i = 0; i < size; i++)
			text[i] = alphabet[random_u64(&random) % (sizeof alphabet - 1)];
		if (position_parse(&position, &table, "p.txt", text, size, err, sizeof err) < 0) {
			ck_assert_msg(strncmp(err, "p.txt:", 6) == 0, "%s", err);
			continue;
		}
		int first, second;
		ck_assert_int_ge(position.count, 1);
		ck_assert_int_eq(
			table_check_balls(&table, position.ball, position.count, &first, &second, err, sizeof err), 0);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("position");
	TCase *good = tcase_create("accepted");
	tcase_add_checked_fixture(good, setup, NULL);
	tcase_add_test(good, thesis_example);
	tcase_add_test(good, comments_blanks_and_line_ends);
	tcase_add_test(good, touching_balls);
	tcase_add_test(good, random_positions_come_back);
	tcase_add_test(good, seen_balls);
	tcase_add_test(good, byte_order_mark);
	suite_add_tcase(suite, good);
	TCase *refused = tcase_create("refused");
	tcase_add_checked_fixture(refused, setup, NULL);
	tcase_set_timeout(refused, 60);
	tcase_add_loop_test(refused, refused_with_place, 0, sizeof bad / sizeof *bad);
	tcase_add_test(refused, too_many_balls);
	tcase_add_test(refused, unreadable_files);
	tcase_add_test(refused, random_texts);
	suite_add_tcase(suite, refused);
	return suite;
}
