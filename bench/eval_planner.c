/* Soak of the planner on a bus of its own: random positions and limits, cancels, replaced and repeated requests,
 * floods, bytes that are no messages, SIGKILL, SIGTERM, SIGSTOP. EVAL_SOAK seconds (600). Every request that is not
 * replaced must be answered, in time, by a plan that holds; memory must not grow. */
#include <check.h>
#include <libgen.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/process/clock.h"
#include "app/planner/plan_check.h"
#include "app/planner/plan_message.h"
#include "app/process/process.h"
#include "planner_client.h"
#include "report.h"
#include "scenes.h"
#include "search_scenes.h"

static struct planner_client client;
static struct config config;
static struct {
	double requests, unanswered, wrong, late, faults, restarts, worst;
} seen;

static int pick(struct random *random, int count)
{
	return (int)(random_u64(random) % (uint64_t)count);
}

/* Any position, any limits, half a second at most. */
static void fill(struct random *random)
{
	struct ball ball[BALL_MAX];
	int count = 2 + pick(random, 21);
	if (pick(random, 4) == 0) {
		count = BALL_MAX;
		scene_after_break(&config.table, pick(random, 50), ball);
	} else {
		scene_random(random, &config.table, 0.002, ball, count);
	}
	client_fill(&client, ball, count);
	billiard_plan_request_t *r = &client.request;
	r->target_kind = (int8_t)pick(random, 2);
	r->on = (int8_t)pick(random, 2);
	r->in_hand = ball[0].phase == BALL_POTTED || pick(random, 10) == 0;
	r->depth = 1 + pick(random, 4);
	r->rails = pick(random, 4);
	r->max_balls = 1 + pick(random, 3);
	r->speeds = 1 + pick(random, 5);
	r->plans = 1 + pick(random, PLAN_MAX);
	r->budget_nodes = pick(random, 2) ? 1 + pick(random, 5000) : 0;
	r->budget_s = random_in(random, 0.005, 0.5);
}

static void no_answer(void)
{
	static char said[1 << 20];
	fixture_said(client.pid, STDERR_FILENO, said, sizeof said);
	size_t length = strlen(said), skipped = length > 1000 ? length - 1000 : 0;
	printf("request %lld: no final answer; the planner (%s) said:\n%s", (long long)client.id,
	       kill(client.pid, 0) == 0 && fixture_end(client.pid, 0) < 0 ? "running" : "ended", said + skipped);
	fflush(stdout);
	seen.unanswered++;
}

/* Other load on the machine, or the request itself? */
static void ask_again(double over)
{
	const billiard_plan_request_t *r = &client.request;
	double again = 1e9;
	for (int i = 0; i < 5; i++) {
		client_ask(&client);
		client_wait(&client, 20);
		again = fmin(again, client.last - client.sent - r->budget_s);
	}
	printf("request %lld: %.0f ms over its budget of %.0f, the best of five more times %.0f; %d balls, depth %d, "
	       "rails %d, "
	       "chains %d, speeds %d, plans %d, on %d, in hand %d, nodes %lld\n",
	       (long long)client.id, 1e3 * over, 1e3 * r->budget_s, 1e3 * again, r->ball_count, r->depth, r->rails,
	       r->max_balls, r->speeds, r->plans, r->on, r->in_hand, (long long)r->budget_nodes);
	fflush(stdout);
}

static void expect_answer(int wanted)
{
	double slack = 1; /* s; other load on the machine */
	if (!client_wait(&client, client.request.budget_s + 20)) {
		no_answer();
		return;
	}
	double over = client.last - client.sent - fmax(client.request.budget_s, 0);
	if (over > 0.05)
		ask_again(over);
	seen.late += over > slack;
	seen.worst = fmax(seen.worst, over);
	if (client.plan.status != wanted || !plan_check(&client.plan, &config.table)) {
		seen.wrong++;
		printf("request %lld: status %d, wanted %d, %.90s\n", (long long)client.id, client.plan.status, wanted,
		       (const char *)client.plan.reason);
	}
}

static void plain(struct random *random)
{
	fill(random);
	client_ask(&client);
	expect_answer(PLAN_MESSAGE_OK);
}

static void cancelled(struct random *random)
{
	fill(random);
	client.request.depth = 4;
	client.request.rails = 3;
	client.request.budget_nodes = 0;
	client.request.budget_s = 5;
	client_ask(&client);
	client_wait_first(&client, 0.001 * pick(random, 50));
	client_cancel(&client, client.id);
	if (!client_wait(&client, 20))
		no_answer(); /* whether it was cancelled in time depends */
}

static void replaced(struct random *random)
{
	for (int i = 1 + pick(random, 50); i > 0; i--) {
		fill(random);
		client_ask(&client);
		client_wait_first(&client, 0.0005 * pick(random, 10));
		seen.requests++;
	}
	expect_answer(PLAN_MESSAGE_OK);
}

static void refused(struct random *random)
{
	fill(random);
	billiard_plan_request_t *r = &client.request;
	switch (pick(random, 6)) {
	case 0:
		r->ball_count = -pick(random, 100);
		break;
	case 1:
		r->balls[0].x = NAN;
		break;
	case 2:
		r->balls[1].x = r->balls[0].x, r->balls[1].y = r->balls[0].y;
		r->balls[0].phase = r->balls[1].phase = BALL_REST;
		break;
	case 3:
		r->depth = 5 + pick(random, 100);
		break;
	case 4:
		r->balls[0].colour = COLOUR_BLUE;
		break;
	default:
		r->budget_s = -1;
	}
	client_ask(&client);
	expect_answer(PLAN_MESSAGE_REFUSED);
}

static void garbage(struct random *random)
{
	uint64_t bytes[300];
	for (size_t i = 0; i < sizeof bytes / sizeof *bytes; i++)
		bytes[i] = random_u64(random);
	for (int i = 0; i < 20; i++) {
		struct raw_message raw = {bytes, pick(random, sizeof bytes)};
		bus_publish(client.bus, i % 2 ? "PLAN_REQUEST" : "COMMAND", &bus_raw, &raw);
	}
	seen.faults++;
	plain(random);
}

/* During a search; a request repeated to the next process is answered. */
static void ended(struct random *random)
{
	fill(random);
	client_ask(&client);
	client_wait_first(&client, 0.001 * pick(random, 20));
	kill(client.pid, pick(random, 2) ? SIGKILL : SIGTERM);
	fixture_end(client.pid, 10);
	client_start(&client);
	client.id++;
	client_ask(&client);
	expect_answer(PLAN_MESSAGE_OK);

	seen.restarts++;
}

static void stopped(struct random *random)
{
	fill(random);
	client.request.budget_s = 0.5;
	client_ask(&client);
	client_wait_first(&client, 0.01);
	kill(client.pid, SIGSTOP);
	poll(NULL, 0, pick(random, 300));
	kill(client.pid, SIGCONT);
	expect_answer(PLAN_MESSAGE_OK);
	seen.faults++;
}

static void repeated(struct random *random)
{
	fill(random);
	client_ask(&client);
	for (int i = 0; i < 5; i++) {
		client_repeat(&client);
		client_wait(&client, 0.001 * pick(random, 20));
	}
	expect_answer(PLAN_MESSAGE_OK);
}

START_TEST(soak)
{
	static void (*const act[])(struct random * random) = {plain,	plain,	 plain,	  plain,    cancelled,
							      replaced, refused, garbage, repeated, stopped};
	const char *text = getenv("EVAL_SOAK");
	double seconds = text ? strtod(text, NULL) : 600, end = clock_seconds() + seconds;
	char self[4096], err[640];
	ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
	ck_assert(n > 0 && config_load(&config, "config/thesis.conf", err, sizeof err) == 0);
	self[n] = '\0';
	struct random random = random_begin("soak of the planner");
	client_begin(&client, &(struct planner_setup){NULL, 2, NULL});
	long before = 0, growth = 0;
	for (int i = 1; clock_seconds() < end && seen.unanswered == 0; i++) {
		seen.requests++;
		if (i % 500 == 0)
			ended(&random);
		else
			act[pick(&random, sizeof act / sizeof *act)](&random);
		if (i % 500 == 100)
			before = client_memory(&client);
		if (i % 500 == 499)
			growth = client_memory(&client) - before > growth ? client_memory(&client) - before : growth;
	}
	client_end(&client);
	struct report *report = report_open(dirname(dirname(self)), "eval.json");
	report_number(report, "planner.soak_seconds", seconds, "s");
	report_number(report, "planner.soak_requests", seen.requests, "count");
	report_number(report, "planner.soak_unanswered", seen.unanswered, "count");
	report_number(report, "planner.soak_wrong", seen.wrong, "count");
	report_number(report, "planner.soak_late", seen.late, "count");
	report_number(report, "planner.soak_worst_over_budget", 1e3 * seen.worst, "ms");
	report_number(report, "planner.soak_faults", seen.faults, "count");
	report_number(report, "planner.soak_restarts", seen.restarts, "count");
	report_number(report, "planner.soak_memory_growth", (double)growth, "KiB");
	ck_assert_int_eq(report_close(report), 0);
	ck_assert(seen.unanswered == 0 && seen.wrong == 0 && growth < 1024);
}
END_TEST

int main(void)
{
	fixture_begin();
	Suite *suite = suite_create("soak");
	TCase *tc = tcase_create("soak");
	tcase_set_timeout(tc, 0);
	tcase_add_test(tc, soak);
	suite_add_tcase(suite, tc);
	SRunner *runner = srunner_create(suite);
	srunner_set_fork_status(runner, CK_NOFORK);
	srunner_run_all(runner, CK_NORMAL);
	int failed = srunner_ntests_failed(runner);
	srunner_free(runner);
	return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
