#include "app/process/clock.h"
#include "app/process/supervisor.h"

#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/process/process.h"
#include "harness.h"

/* The supervised programs are scripts beside the test program, where a supervisor looks for them. Each writes a line
 * when it starts. */
static char folder[PATH_MAX], starts[64], name[24];
static struct supervisor supervisor;
static sd_event *event;

static const char *script_path(void)
{
	static char path[PATH_MAX + 32];
	snprintf(path, sizeof path, "%s/%s", folder, name);
	return path;
}

static void write_script(const char *body)
{
	FILE *f = fopen(script_path(), "w");
	ck_assert_ptr_nonnull(f);
	fprintf(f, "#!/bin/sh\necho \"$$ $*\" >>%s\n%s\n", starts, body);
	fclose(f);
	ck_assert_int_eq(chmod(script_path(), 0755), 0);
}

static void setup(void)
{
	char self[PATH_MAX];
	ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
	ck_assert_int_gt(n, 0);
	self[n] = '\0';
	snprintf(folder, sizeof folder, "%s", dirname(self));
	snprintf(name, sizeof name, "child-%d", (int)getpid());
	strcpy(starts, "/tmp/billiard-starts-XXXXXX");
	int fd = mkstemp(starts);
	ck_assert_int_ge(fd, 0);
	close(fd);
	ck_assert_int_ge(sd_event_new(&event), 0);
	supervisor_init(&supervisor, event, "some.conf", "memq://");
}

static void teardown(void)
{
	supervisor_finish(&supervisor);
	sd_event_unref(event);
	unlink(script_path());
	unlink(starts);
}

static int start_lines(char *first, size_t size)
{
	char line[512];
	int count = 0;
	FILE *f = fopen(starts, "r");
	while (f && fgets(line, sizeof line, f))
		if (count++ == 0 && first)
			snprintf(first, size, "%s", line);
	if (f)
		fclose(f);
	return count;
}

static void start(const char *arguments)
{
	char err[300];
	ck_assert_msg(supervisor_start(&supervisor, name, arguments, err, sizeof err) == 0, "%s", err);
}

/* Runs the loop until so many starts were seen. */
static void run_until_starts(int count, double seconds)
{
	double end = clock_seconds() + seconds;
	while (start_lines(NULL, 0) < count) {
		ck_assert_msg(clock_seconds() < end, "%d starts seen", start_lines(NULL, 0));
		ck_assert_int_ge(sd_event_run(event, 10000), 0);
	}
}

START_TEST(arguments_are_handed_on)
{
	char line[512];
	write_script("exec sleep 100");
	start("--source dir:x  --hold 3");
	run_until_starts(1, 5);
	start_lines(line, sizeof line);
	ck_assert_str_eq(strchr(line, ' '), " -c some.conf --bus memq:// --source dir:x --hold 3\n");
	ck_assert_int_eq(atoi(line), supervisor.service[0].pid);
}
END_TEST

START_TEST(what_fails_is_started_again)
{
	write_script("exit 1");
	start("");
	run_until_starts(3, 10);
	ck_assert_int_ge(supervisor.service[0].restarts, 2);
}
END_TEST

START_TEST(what_is_killed_is_started_again)
{
	write_script("exec sleep 100");
	start("");
	run_until_starts(1, 5);
	pid_t first = supervisor.service[0].pid;
	kill(first, SIGKILL);
	run_until_starts(2, 5);
	ck_assert_int_ne(supervisor.service[0].pid, first);
}
END_TEST

START_TEST(bad_use_is_not_tried_again)
{
	write_script("exit 2");
	start("");
	ck_assert_int_eq(sd_event_loop(event), 2);
	ck_assert_int_eq(start_lines(NULL, 0), 1);
}
END_TEST

/* One ended for good while the other waits to be started again: that one still is. */
START_TEST(bad_use_of_one_does_not_stop_the_others)
{
	char body[256];
	snprintf(body, sizeof body,
		 "case \"$*\" in *bad*) exit 2;; esac; [ $(wc -l <%s) -lt 4 ] && exit 1; exec sleep 100", starts);
	write_script(body);
	start("good");
	start("bad");
	run_until_starts(4, 10);
	ck_assert_int_gt(supervisor.service[0].pid, 0);
	ck_assert_int_eq(supervisor.service[1].pid, 0);
}
END_TEST

START_TEST(stop_ends_all_and_the_loop)
{
	write_script("exec sleep 100");
	start("a");
	start("b");
	run_until_starts(2, 5);
	pid_t a = supervisor.service[0].pid, b = supervisor.service[1].pid;
	double begin = clock_seconds();
	supervisor_stop(&supervisor, 5);
	supervisor_stop(&supervisor, 6);
	ck_assert_int_eq(sd_event_loop(event), 5);
	ck_assert_double_lt(clock_seconds() - begin, 2);
	ck_assert(kill(a, 0) < 0 && kill(b, 0) < 0);
}
END_TEST

START_TEST(what_does_not_listen_is_killed)
{
	write_script("trap '' TERM; while :; do sleep 0.1; done");
	start("");
	run_until_starts(1, 5);
	double begin = clock_seconds();
	supervisor_stop(&supervisor, 0);
	ck_assert_int_eq(sd_event_loop(event), 0);
	double took = clock_seconds() - begin;
	ck_assert(took > 2 && took < 8);
}
END_TEST

START_TEST(nothing_is_started_while_stopping)
{
	write_script("exit 1");
	start("");
	run_until_starts(1, 5);
	while (supervisor.service[0].pid)
		sd_event_run(event, 10000);
	supervisor_stop(&supervisor, 0);
	ck_assert_int_eq(sd_event_loop(event), 0);
	ck_assert_int_eq(start_lines(NULL, 0), 1);
}
END_TEST

START_TEST(finish_leaves_nobody)
{
	write_script("trap '' TERM; while :; do sleep 0.1; done");
	start("");
	run_until_starts(1, 5);
	pid_t pid = supervisor.service[0].pid;
	supervisor_finish(&supervisor);
	ck_assert(kill(pid, 0) < 0 && errno == ESRCH);
}
END_TEST

START_TEST(programs_that_are_not_there_are_errors)
{
	char err[300] = "";
	unlink(script_path());
	ck_assert_int_eq(supervisor_start(&supervisor, name, "", err, sizeof err), -ENOENT);
	ck_assert_ptr_nonnull(strstr(err, name));
}
END_TEST

START_TEST(there_is_room_for_so_many)
{
	char err[300];
	write_script("exec sleep 100");
	for (int i = 0; i < SUPERVISOR_MAX; i++)
		start("");
	ck_assert_int_eq(supervisor_start(&supervisor, name, "", err, sizeof err), -ENOSPC);
	run_until_starts(SUPERVISOR_MAX, 5);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("supervisor");
	TCase *children = tcase_create("children");
	tcase_set_timeout(children, 30);
	tcase_add_checked_fixture(children, setup, teardown);
	tcase_add_test(children, arguments_are_handed_on);
	tcase_add_test(children, what_fails_is_started_again);
	tcase_add_test(children, what_is_killed_is_started_again);
	tcase_add_test(children, bad_use_is_not_tried_again);
	tcase_add_test(children, bad_use_of_one_does_not_stop_the_others);
	tcase_add_test(children, stop_ends_all_and_the_loop);
	tcase_add_test(children, what_does_not_listen_is_killed);
	tcase_add_test(children, nothing_is_started_while_stopping);
	tcase_add_test(children, finish_leaves_nobody);
	tcase_add_test(children, programs_that_are_not_there_are_errors);
	tcase_add_test(children, there_is_room_for_so_many);
	suite_add_tcase(suite, children);
	return suite;
}
