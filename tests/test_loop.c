/* All services together: under `billiard run`, and when each is killed in turn. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/clock.h"
#include "app/process/process.h"
#include "harness.h"
#include "service_fixture.h"

static int64_t threshold;
static pid_t judge;
static int judge_status;

/* ---- the loop ---------------------------------------------------------------------------------------------------- */

static bool proposal_newer(void)
{
	return heard.draw.plan_id > threshold;
}

static bool sees_balls(void)
{
	return heard.state.calibration != 0 && heard.state.ball_count >= 15;
}

/* Killing any one and starting it again brings proposals back; nobody else is touched. */
START_TEST(the_loop_survives_the_death_of_each)
{
	pid_t pid[PROGRAM_COUNT];
	for (int i = 0; i < PROGRAM_COUNT; i++)
		pid[i] = service_start(programs[i]);
	ck_assert_msg(fixture_wait(bus, sees_balls, 15), "%d balls, %s", heard.state.ball_count, heard.state.reason);
	for (int i = 0; i < PROGRAM_COUNT; i++) {
		/* A request made after the restart. */
		kill(pid[i], SIGKILL);
		ck_assert_int_eq(fixture_end(pid[i], 2), 128 + SIGKILL);
		pid[i] = service_start(programs[i]);
		threshold = clock_utime();
		ck_assert_msg(fixture_wait(bus, proposal_newer, 30),
			      "no proposal after the restart of %s; infinity is %s, %d balls", programs[i],
			      service_status(pid[2])->state, heard.state.ball_count);
		for (int k = 0; k < PROGRAM_COUNT; k++)
			ck_assert_msg(kill(pid[k], 0) == 0, "%s died with %s", programs[k], programs[i]);
	}
	for (int i = 0; i < PROGRAM_COUNT; i++)
		kill(pid[i], SIGTERM);
	for (int i = 0; i < PROGRAM_COUNT; i++) {
		char said[TEXT_SIZE];
		int status = fixture_end(pid[i], 2);
		fixture_said(pid[i], 2, said, sizeof said);
		ck_assert_msg(status == 0, "%s: status %d: %s", programs[i], status, said);
	}
}
END_TEST

/* ---- the rules ---------------------------------------------------------------------------------------------------- */

static bool has_ended(void)
{
	return (judge_status = fixture_end(judge, 0)) >= 0;
}

/* Played by the rules on the virtual table: nothing is proposed for what does not lie there, once a rest, and ball on and ball in hand are
 * those of the truth. The judge compares what was asked with TRUTH. */
START_TEST(the_game_is_kept_by_the_rules)
{
	char command[900], path[160], said[TEXT_SIZE];
	snprintf(path, sizeof path, "%s", fixture_file("rules.conf"));
	snprintf(command, sizeof command,
		 "sed -e 's/rules = false/rules = true/' -e 's/time_scale = 8/time_scale = 2/' -e 's/still_time = "
		 "250/still_time = 400/' %s >%s",
		 conf, path);
	ck_assert_int_eq(system(command), 0);
	for (int i = 0; i < PROGRAM_COUNT; i++)
		fixture_start(programs[i], (const char *[]){"-c", path, NULL});
	judge = fixture_start("billiard", (const char *[]){"judge", "-c", path, "--live", "--shots", "10", "--seconds",
							   "90", "--json", NULL});
	ck_assert(fixture_wait(bus, has_ended, 120));
	fixture_said(judge, 1, said, sizeof said);
	printf("loop: %s", said);
	fflush(stdout);
	ck_assert_ptr_nonnull(strstr(said, "\"shots\":1"));
	ck_assert_ptr_nonnull(strstr(said, "\"wrong\":0,"));
	ck_assert_ptr_nonnull(strstr(said, "\"more_than_one_request\":0,"));
	ck_assert_ptr_nonnull(strstr(said, "\"changed_after_drawn\":0,"));
	ck_assert_ptr_nonnull(strstr(said, "\"ball_on_wrong\":0,\"in_hand_wrong\":0,"));
}
END_TEST

/* ---- billiard run, status, control ------------------------------------------------------------------------------- */

static pid_t pid_of(const char *program)
{
	for (int i = heard.status_count - 1; i >= 0; i--)
		if (strcmp((const char *)heard.status[i].process, program) == 0 &&
		    strcmp((const char *)heard.status[i].state, "stopped") != 0)
			return heard.status[i].pid;
	return 0;
}

static bool all_run(void)
{
	for (int i = 0; i < PROGRAM_COUNT; i++)
		if (!pid_of(programs[i]))
			return false;
	return true;
}

static bool started_again(void)
{
	return pid_of("billiard-planner") != (pid_t)threshold;
}

static bool is_paused(void)
{
	const billiard_status_t *s = service_status(pid_of("billiard-infinity"));
	return s && strcmp((const char *)s->state, "PAUSED") == 0;
}

/* Runs a command to its end; its status, and what it said on stdout. */
static int call(const char *const *arguments, char *said)
{
	pid_t pid = fixture_start("billiard", arguments);
	int status = fixture_end(pid, 20);
	fixture_said(pid, 1, said, TEXT_SIZE);
	return status;
}

START_TEST(run_starts_all_restarts_one_and_stops_all)
{
	char said[TEXT_SIZE];
	pid_t run = fixture_start("billiard", (const char *[]){"run", "-c", conf, NULL});
	ck_assert(fixture_wait(bus, all_run, 15));
	ck_assert_int_eq(call((const char *[]){"status", "-c", conf, "--json", NULL}, said), 0);
	for (int i = 0; i < PROGRAM_COUNT; i++)
		ck_assert_msg(strstr(said, programs[i]) != NULL, "no %s in %s", programs[i], said);
	ck_assert_ptr_null(strstr(said, "silent"));
	threshold = pid_of("billiard-planner");
	kill((pid_t)threshold, SIGKILL);
	ck_assert(fixture_wait(bus, started_again, 5));
	ck_assert_int_eq(call((const char *[]){"control", "-c", conf, "pause", NULL}, said), 0);
	ck_assert(fixture_wait(bus, is_paused, 3));
	kill(run, SIGINT);
	ck_assert_int_eq(fixture_end(run, 4), 0);
	for (int i = 0; i < heard.status_count; i++)
		ck_assert_msg(kill(heard.status[i].pid, 0) < 0, "%s stays", heard.status[i].process);
}
END_TEST

static bool infinity_started_again(void)
{
	pid_t pid = pid_of("billiard-infinity");
	return pid && pid != (pid_t)threshold;
}

/* A service that is there and does nothing any more: three seconds are forgiven, then another takes its place. */
START_TEST(a_service_that_hangs_is_replaced)
{
	pid_t run = fixture_start("billiard", (const char *[]){"run", "-c", conf, NULL});
	ck_assert(fixture_wait(bus, all_run, 15));
	threshold = pid_of("billiard-infinity");
	kill((pid_t)threshold, SIGSTOP);
	ck_assert(!fixture_wait(bus, infinity_started_again, 3));
	kill((pid_t)threshold, SIGCONT);
	ck_assert(!fixture_wait(bus, infinity_started_again, 4));
	kill((pid_t)threshold, SIGSTOP);
	ck_assert(fixture_wait(bus, infinity_started_again, 12));
	kill(run, SIGINT);
	ck_assert_int_eq(fixture_end(run, 4), 0);
}
END_TEST

static bool all_gone(void)
{
	for (int i = 0; i < heard.status_count; i++)
		if (kill(heard.status[i].pid, 0) == 0)
			return false;
	return true;
}

START_TEST(no_service_outlives_a_killed_run)
{
	pid_t run = fixture_start("billiard", (const char *[]){"run", "-c", conf, NULL});
	ck_assert(fixture_wait(bus, all_run, 15));
	kill(run, SIGKILL);
	ck_assert_int_eq(fixture_end(run, 1), 128 + SIGKILL);
	ck_assert(fixture_wait(bus, all_gone, 5));
}
END_TEST

START_TEST(run_gives_up_when_no_service_can_start)
{
	char said[TEXT_SIZE];
	pid_t run =
		fixture_start("billiard", (const char *[]){"run", "-c", conf, "--bus", "udpm://999.1.1.1:7667", NULL});
	ck_assert_int_eq(fixture_end(run, 10), 2);
	fixture_said(run, 2, said, sizeof said);
	ck_assert_ptr_nonnull(strstr(said, "999.1.1.1"));
	ck_assert_ptr_nonnull(strstr(said, "not started again"));
}
END_TEST

START_TEST(status_says_who_is_silent)
{
	char said[TEXT_SIZE];
	service_start("billiard-planner");
	ck_assert_int_eq(call((const char *[]){"status", "-c", conf, NULL}, said), 1);
	ck_assert_ptr_nonnull(strstr(said, "billiard-planner"));
	const char *line = strstr(said, "billiard-vision");
	ck_assert(line && strstr(line, "silent"));
}
END_TEST

START_TEST(wrong_use_of_the_bus_commands)
{
	service_refused("billiard", (const char *[]){"run", "-c", "/nowhere.conf", NULL}, "/nowhere.conf");
	service_refused("billiard", (const char *[]){"run", "-c", conf, "extra", NULL}, "extra");
	service_refused("billiard", (const char *[]){"status", "-c", "/nowhere.conf", NULL}, "/nowhere.conf");
	service_refused("billiard", (const char *[]){"status", "-c", conf, "--seconds", "soon", NULL}, "--seconds");
	service_refused("billiard", (const char *[]){"status", "-c", conf, "--bus", "nonsense", NULL}, "nonsense");
	service_refused("billiard", (const char *[]){"control", "-c", conf, NULL}, "name");
	service_refused("billiard", (const char *[]){"control", "-c", conf, "a", "b", "c", NULL}, "name");
}
END_TEST

Suite *test_suite(void)
{
	fixture_begin();
	Suite *suite = suite_create("loop");
	TCase *commands = tcase_create("commands");
	tcase_set_timeout(commands, 60);
	tcase_add_checked_fixture(commands, service_setup, service_teardown);
	tcase_add_test(commands, run_starts_all_restarts_one_and_stops_all);
	tcase_add_test(commands, a_service_that_hangs_is_replaced);
	tcase_add_test(commands, no_service_outlives_a_killed_run);
	tcase_add_test(commands, run_gives_up_when_no_service_can_start);
	tcase_add_test(commands, status_says_who_is_silent);
	tcase_add_test(commands, wrong_use_of_the_bus_commands);
	suite_add_tcase(suite, commands);
	TCase *loop = tcase_create("loop");
	tcase_set_timeout(loop, 200);
	tcase_add_checked_fixture(loop, service_setup, service_teardown);
	tcase_add_test(loop, the_game_is_kept_by_the_rules);
	tcase_add_test(loop, the_loop_survives_the_death_of_each);
	suite_add_tcase(suite, loop);
	return suite;
}
