/* The planner as its askers see it, on a bus of its own: from request to first and final plan, cancelling, ending,
 * starting again, idling, floods, memory. BENCH_QUICK=1: a few seconds of it, for a machine that cannot be had alone
 * for longer. */
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
#include "app/process/process.h"
#include "planner_client.h"
#include "report.h"
#include "scenes.h"
#include "search_scenes.h"

enum { POSITIONS = 240, CANCELS = 60, BUDGETS = 40, REQUESTS = 10000, ENDS = 8, FLOOD_SECONDS = 10, FLOOD_RATE = 500 };
static int part = 1; /* of those numbers: every so many */

static struct planner_client client;
static struct config config;

static int by_size(const void *a, const void *b)
{
	double x = *(const double *)a, y = *(const double *)b;
	return (x > y) - (x < y);
}

/* The share-th part of them is below; sorts. */
static double quantile(double *value, int count, double share)
{
	qsort(value, (size_t)count, sizeof *value, by_size);
	int at = (int)(share * count);
	return value[at < count ? at : count - 1];
}

static void stop(const char *what)
{
	fprintf(stderr, "bench: %s\n", what);
	fixture_cleanup();
	exit(EXIT_FAILURE);
}

/* A request as the controller makes it, for a position of 2 to 22 balls or one after a break. */
static void fill(struct random *random, int n)
{
	struct ball ball[BALL_MAX];
	int count = 2 + n % 21;
	if (n % 4 == 3) {
		count = BALL_MAX;
		scene_after_break(&config.table, n, ball);
	} else {
		scene_random(random, &config.table, 0.003, ball, count);
	}
	client_fill(&client, ball, count);
	client.request.depth = config.planner.depth;
	client.request.rails = config.planner.rails;
	client.request.max_balls = config.planner.balls;
	client.request.speeds = config.planner.speeds;
	client.request.plans = config.planner.plans;
}

static void fill_endless(int variant)
{
	struct ball ball[BALL_MAX];
	scene_after_break(&config.table, variant, ball);
	client_fill(&client, ball, BALL_MAX);
	client.request.depth = 4;
	client.request.rails = 3;
	client.request.max_balls = 3;
	client.request.speeds = 20;
	client.request.plans = PLAN_MAX;
}

static void number(struct report *report, const char *scheme, const char *what, double value, const char *unit)
{
	char name[80];
	snprintf(name, sizeof name, "planner.%s_%s", scheme, what);
	report_number(report, name, value, unit);
}

static void wait_final(void)
{
	if (!client_wait(&client, 60))
		stop("no final answer came");
}

/* nodes 0: with a live budget, in the configured scheme; else in batches. */
static void bench_latency(struct report *report, const char *scheme, int64_t nodes)
{
	static double first[POSITIONS];
	struct random random = {1};
	double cpu = client_cpu(&client);
	int positions = POSITIONS / part;
	for (int n = 0; n < positions; n++) {
		fill(&random, n);
		client.request.budget_nodes = nodes;
		client.request.budget_s = 0.05;
		client_ask(&client);
		wait_final();
		first[n] = 1e3 * (client.first - client.sent);
	}
	number(report, scheme, "first_median", quantile(first, positions, 0.5), "ms");
	number(report, scheme, "first_99", quantile(first, positions, 0.99), "ms");
	number(report, scheme, "cpu_a_request", 1e3 * (client_cpu(&client) - cpu) / positions, "ms");
}

/* From the request to the final plan of a search that fills its budget. */
static void bench_budget(struct report *report, const char *scheme)
{
	static double over[BUDGETS];
	int budgets = BUDGETS / part;
	for (int n = 0; n < budgets; n++) {
		fill_endless(n % 8);
		client.request.budget_s = 0.02 * (1 + n % 4);
		client_ask(&client);
		wait_final();
		over[n] = 1e3 * (client.last - client.sent - client.request.budget_s);
	}
	number(report, scheme, "over_budget_median", quantile(over, budgets, 0.5), "ms");
	number(report, scheme, "over_budget_worst", quantile(over, budgets, 1), "ms");
}

/* CPU time of the manager in searches of a second, its messages included. */
static void bench_manager(struct report *report, const char *scheme)
{
	for (int n = 0; n < 8 / part; n++) {
		fill_endless(n);
		client.request.budget_s = 1;
		client_ask(&client);
		wait_final();
	}
	client_wait(&client, 0.1);
	for (double end = clock_seconds() + 1.5; clock_seconds() < end;) { /* the next STATUS */
		poll(NULL, 0, 100);
		client_wait(&client, 0);
	}
	number(report, scheme, "manager_on_bus", client_metric(&client, "manager"), "%");
}

static void bench_cancel(struct report *report, const char *scheme)
{
	static double took[CANCELS];
	int cancels = CANCELS / part;
	for (int n = 0; n < cancels; n++) {
		fill_endless(n % 8);
		client_ask(&client);
		if (!client_wait_first(&client, 10))
			stop("no first answer came");
		poll(NULL, 0, 5 + n % 7);
		double begin = clock_seconds();
		client_cancel(&client, client.id);
		wait_final();
		took[n] = 1e3 * (client.last - begin);
	}
	number(report, scheme, "cancel_median", quantile(took, cancels, 0.5), "ms");
	number(report, scheme, "cancel_99", quantile(took, cancels, 0.99), "ms");
}

static void bench_ends(struct report *report, const char *scheme)
{
	double end = 0, again = 0;
	for (int i = 0; i < ENDS / part; i++) {
		fill_endless(i);
		client_ask(&client);
		client_wait_first(&client, 10);
		double begin = clock_seconds();
		kill(client.pid, i % 2 ? SIGKILL : SIGTERM);
		fixture_end(client.pid, 10);
		double ended = clock_seconds();
		if (i % 2 == 0)
			end = fmax(end, 1e3 * (ended - begin));
		client_start(&client);
		client.request.budget_s = 0.05;
		client_ask(&client);
		wait_final();
		again = fmax(again, client.first - ended);
	}
	number(report, scheme, "sigterm_worst", end, "ms");
	number(report, scheme, "restart_to_answer_worst", again, "s");
}

static void bench_idle(struct report *report)
{
	enum { IDLE = 10 };
	double cpu = client_cpu(&client);
	client_wait(&client, 0.1);
	sleep(IDLE);
	report_number(report, "planner.idle_cpu", 100 * (client_cpu(&client) - cpu) / IDLE, "%");
}

static void bench_flood(struct report *report)
{
	double begin = clock_seconds();
	int64_t finals = client.finals;
	for (int i = 0; i < FLOOD_RATE * FLOOD_SECONDS; i++) {
		fill_endless(i % 8);
		client.request.budget_s = 0.05;
		client_ask(&client);
		double left = begin + (double)(i + 1) / FLOOD_RATE - clock_seconds();
		client_wait(&client, left > 0 ? left : 0);
	}
	wait_final();
	report_number(report, "planner.flood_requests", FLOOD_RATE * FLOOD_SECONDS, "count");
	report_number(report, "planner.flood_finals", (double)(client.finals - finals), "count");
	report_number(report, "planner.flood_last", 1e3 * (client.last - client.sent), "ms");
}

static void bench_memory(struct report *report)
{
	struct random random = {2};
	long before = 0;
	double begin = clock_seconds();
	for (int n = 0; n < REQUESTS; n++) {
		fill(&random, n);
		client.request.depth = 1;
		client_ask(&client);
		wait_final();
		if (n == REQUESTS / 10)
			before = client_memory(&client);
	}
	report_number(report, "planner.memory_growth", (double)(client_memory(&client) - before), "KiB");
	report_number(report, "planner.request_mean", 1e3 * (clock_seconds() - begin) / REQUESTS, "ms");
}

/* A test only because the client is made of Check's assertions. */
START_TEST(bench)
{
	static const char *const schemes[] = {"batch", "windows", "queue", "steal"};
	char self[4096], err[640];
	part = getenv("BENCH_QUICK") ? 4 : 1;
	ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
	if (n < 0 || config_load(&config, "config/thesis.conf", err, sizeof err) != 0)
		stop("no configuration");
	self[n] = '\0';
	struct report *report = report_open(dirname(dirname(self)), "bench.json");
	for (int i = 0; i < 4; i++) {
		client_begin(&client, &(struct planner_setup){schemes[i], 2, NULL});
		if (i > 0) /* in batches it works along */
			bench_manager(report, schemes[i]);
		bench_latency(report, schemes[i], 0);
		bench_budget(report, schemes[i]);
		bench_cancel(report, schemes[i]);
		bench_ends(report, schemes[i]);
		client_end(&client);
	}
	client_begin(&client, &(struct planner_setup){NULL, 0, NULL});
	if (part == 1)
		bench_idle(report);
	bench_latency(report, "shipped", (int64_t)config.planner.budget_nodes);
	if (part == 1) {
		bench_memory(report);
		bench_flood(report);
	}
	client_end(&client);
	ck_assert_int_eq(report_close(report), 0);
}
END_TEST

int main(void)
{
	fixture_begin();
	Suite *suite = suite_create("planner_bus");
	TCase *tc = tcase_create("bench");
	tcase_set_timeout(tc, 0);
	tcase_add_test(tc, bench);
	suite_add_tcase(suite, tc);
	SRunner *runner = srunner_create(suite);
	srunner_set_fork_status(runner, CK_NOFORK);
	srunner_run_all(runner, CK_SILENT);
	int failed = srunner_ntests_failed(runner);
	if (failed)
		srunner_print(runner, CK_NORMAL);
	srunner_free(runner);
	return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
