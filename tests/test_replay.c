/* A demo recorded with lcm-logger and played again with lcm-logplayer to vision, infinity and planner: the same
 * proposals come out. */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/planner/plan_message.h"
#include "app/process/process.h"
#include "bus_fixture.h"
#include "harness.h"

enum { SHOTS = 3, PROPOSAL_MAX = 16, TEXT_SIZE = 2000 };
static struct bus *bus;
static char conf[128];

/* The final first proposal for each table that came to rest. */
static struct proposal {
	int64_t id;
	int colour, pocket;
	vec2 cue, target;    /* m */
	double angle, speed; /* rad, m/s */
} proposal[PROPOSAL_MAX];
static int proposal_count;

static bool on_plan(void *context, const void *message)
{
	(void)context;
	const billiard_plan_t *plan = message;
	const billiard_plan_shot_t *s = &plan->entries[0].shots[0];
	if (!plan->is_final || plan->status != PLAN_MESSAGE_OK || s->target < 0)
		return true;
	for (int i = 0; i < proposal_count; i++)
		if (proposal[i].id == plan->request_id)
			return true;
	ck_assert_int_lt(proposal_count, PROPOSAL_MAX);
	int cue = s->chain[0];
	proposal[proposal_count++] = (struct proposal){plan->request_id,
						       plan->colours[s->target],
						       s->pocket,
						       {s->start_x[cue], s->start_y[cue]},
						       {s->start_x[s->target], s->start_y[s->target]},
						       s->angle,
						       s->speed};
	return true;
}

/* A search that ends by its count of nodes, not by the clock; fast balls, and a player who waits until it has ended on
 * a busy machine, too. */
static void write_conf(void)
{
	char command[1200], cwd[512];
	ck_assert_ptr_nonnull(getcwd(cwd, sizeof cwd));
	snprintf(conf, sizeof conf, "%s", fixture_file("table.conf"));
	snprintf(command, sizeof command,
		 "sed -e 's#\"colours.json\"#\"%s/config/colours.json\"#' -e 's/time_scale = [0-9.]*/time_scale = 4/' "
		 "-e 's/think_time = [0-9.]*/think_time = 3500/' -e 's/still_time = [0-9.]*/still_time = 400/' "
		 "-e 's/budget_nodes = [0-9]*/budget_nodes = 2000/' -e 's/budget = [0-9.]*/budget = 0.0/' "
		 "config/thesis-table.conf >%s",
		 cwd, conf);
	ck_assert_int_eq(system(command), 0);
}

static pid_t awaited;
static int awaited_status;
static bool has_ended(void)
{
	awaited_status = fixture_end(awaited, 0);
	return awaited_status >= 0;
}

static void wait_end(pid_t pid, double seconds, const char *what)
{
	char said[TEXT_SIZE];
	awaited = pid;
	bool ended = fixture_wait(bus, has_ended, seconds);
	fixture_said(pid, 2, said, sizeof said);
	ck_assert_msg(ended && awaited_status == 0, "%s: status %d, %s", what, awaited_status, said);
}

static bool heard_vision, heard_infinity, heard_planner;
static bool on_status(void *context, const void *message)
{
	(void)context;
	const char *name = (const char *)((const billiard_status_t *)message)->process;
	heard_vision |= strcmp(name, "billiard-vision") == 0;
	heard_infinity |= strcmp(name, "billiard-infinity") == 0;
	heard_planner |= strcmp(name, "billiard-planner") == 0;
	return true;
}

static bool all_there(void)
{
	return heard_vision && heard_infinity && heard_planner;
}

static bool log_is_there(void)
{
	return access(fixture_file("demo.log"), R_OK) == 0;
}

static void record(const char *log)
{
	const char *logger[] = {"-q", "-f", "-c", "CAMERA", log, NULL};
	const char *demo[] = {
		"demo", "-c", conf, "--shots", "3", "--out", NULL, "--position", "config/demo-position.txt", NULL};
	char out[128];
	snprintf(out, sizeof out, "%s", fixture_file("demo"));
	demo[6] = out;
	pid_t recorder = fixture_start("/usr/bin/lcm-logger", logger);
	ck_assert(fixture_wait(bus, log_is_there, 5));
	wait_end(fixture_start("billiard", demo), 90, "demo");
	kill(recorder, SIGTERM);
	wait_end(recorder, 5, "lcm-logger");
}

static void replay(const char *log)
{
	const char *const services[] = {"billiard-vision", "billiard-infinity", "billiard-planner"};
	pid_t pid[3];
	heard_vision = heard_infinity = heard_planner = false;
	for (int i = 0; i < 3; i++) {
		const char *arguments[] = {"-c", conf, i == 0 ? "--source" : NULL, "lcm:CAMERA", NULL};
		pid[i] = fixture_start(services[i], arguments);
	}
	ck_assert(fixture_wait(bus, all_there, 10));
	wait_end(fixture_start("/usr/bin/lcm-logplayer", (const char *[]){"-e", "CAMERA", log, NULL}), 120,
		 "lcm-logplayer");
	for (int i = 0; i < 3; i++) {
		kill(pid[i], SIGTERM);
		wait_end(pid[i], 3, services[i]);
	}
}

static void compare(const struct proposal *a, const struct proposal *b, int number)
{
	double angle = fabs(remainder(a->angle - b->angle, 2 * 3.141592653589793)) * 57.29577951308232;
	printf("replay: shot %d: %s -> pocket %d, cue ball %.3f mm apart, angle %.4f deg apart, speed %.2f %% "
	       "apart%s\n",
	       number, ball_colour_name((enum ball_colour)a->colour), a->pocket, 1e3 * vec2_dist(a->cue, b->cue), angle,
	       100 * fabs(b->speed / a->speed - 1),
	       a->angle == b->angle && a->speed == b->speed ? " (the same bits)" : "");
	ck_assert_int_eq(a->colour, b->colour);
	ck_assert_int_eq(a->pocket, b->pocket);
	ck_assert_double_lt(vec2_dist(a->target, b->target), 0.003);
	ck_assert_double_lt(angle, 0.5);
	ck_assert_double_lt(fabs(b->speed / a->speed - 1), 0.05);
}

START_TEST(a_recorded_demo_gives_the_same_proposals_again)
{
	struct proposal first[PROPOSAL_MAX];
	char log[128];
	if (access("/usr/bin/lcm-logger", X_OK) < 0) {
		printf("replay: SKIPPED, no lcm-logger (package liblcm-bin)\n");
		return;
	}
	write_conf();
	snprintf(log, sizeof log, "%s", fixture_file("demo.log"));
	bus = fixture_bus();
	ck_assert_int_eq(bus_subscribe(bus, &(struct bus_subscription){"PLAN", &bus_plan, BUS_EACH, on_plan, NULL}), 0);
	ck_assert_int_eq(
		bus_subscribe(bus, &(struct bus_subscription){"STATUS", &bus_status, BUS_EACH, on_status, NULL}), 0);
	record(log);
	int count = proposal_count < SHOTS ? proposal_count : SHOTS;
	ck_assert_int_eq(count, SHOTS);
	memcpy(first, proposal, sizeof first);
	proposal_count = 0;
	replay(log);
	ck_assert_int_ge(proposal_count, SHOTS);
	for (int i = 0; i < SHOTS; i++)
		compare(&first[i], &proposal[i], i + 1);
	bus_close(bus);
}
END_TEST

Suite *test_suite(void)
{
	fixture_begin();
	Suite *suite = suite_create("replay");
	TCase *log = tcase_create("log");
	tcase_set_timeout(log, 240);
	tcase_add_checked_fixture(log, NULL, fixture_cleanup);
	tcase_add_test(log, a_recorded_demo_gives_the_same_proposals_again);
	suite_add_tcase(suite, log);
	return suite;
}
