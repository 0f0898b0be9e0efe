/* billiard-planner from outside: requests and answers on a real bus, faults, floods. */
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "app/planner/plan_check.h"
#include "app/planner/request_message.h"
#include "app/planner/plan_message.h"
#include "app/process/process.h"
#include "harness.h"
#include "planner_client.h"
#include "scenes.h"
#include "search_scenes.h"

static struct planner_client client;
static struct config config; /* too large for the stack */

static void begin(const char *scheme, int workers)
{
	char err[640];
	ck_assert_msg(config_load(&config, "config/thesis.conf", err, sizeof err) == 0, "%s", err);
	client_begin(&client, &(struct planner_setup){scheme, workers, NULL});
}

static void teardown(void)
{
	client_end(&client);
}

/* Done in milliseconds, in batches and alone. */
static void fill_quick(void)
{
	struct ball ball[3] = {ball_at(COLOUR_WHITE, (vec2){-0.3, 0}), ball_at(COLOUR_RED, (vec2){0.35, 0.2}),
			       ball_at(COLOUR_BLUE, (vec2){0, 0.1})};
	client_fill(&client, ball, 3);
}

/* Goes on until it is ended. */
static void fill_endless(void)
{
	struct ball ball[BALL_MAX];
	scene_after_break(&config.table, 2, ball);
	client_fill(&client, ball, BALL_MAX);
	client.request.depth = 4;
	client.request.rails = 3;
	client.request.max_balls = 3;
	client.request.speeds = 20;
	client.request.plans = PLAN_MAX;
}

static bool gives(const char *text)
{
	return strstr((const char *)client.plan.reason, text) != NULL;
}

START_TEST(first_then_better_then_final)
{
	begin(NULL, 2);
	fill_endless();
	client.request.budget_s = 0.5;
	client_ask(&client);
	ck_assert(client_wait_first(&client, 10));
	const billiard_plan_t *first = &client.first_plan;
	ck_assert(first->sequence == 0 && !first->is_final && first->entry_count == 1);
	ck_assert_int_gt(first->entries[0].shots[0].keyframe_count, 0);
	ck_assert(plan_check(first, &config.table));
	double cost = first->entries[0].cost;
	int shots = first->entries[0].shot_count;
	ck_assert(client_wait(&client, 10));
	ck_assert_int_eq(client.plan.status, PLAN_MESSAGE_OK);
	ck_assert_int_eq(client.plan.entry_count, PLAN_MESSAGE_ENTRIES);
	ck_assert_int_ge(client.plan.sequence, 1);
	ck_assert(client.plan.entries[0].shot_count > shots || client.plan.entries[0].cost <= cost);
	ck_assert(plan_check(&client.plan, &config.table));
}
END_TEST

/* What the same search gives in this process. */
static void search_here(billiard_plan_t *out)
{
	static struct trace_entry scratch[PLAN_TRACE_MAX];
	struct plan_request request;
	struct plan_result result;
	char err[100];
	struct planner *planner = scene_planner(&config.table, config.model_name, &config.profile, 1);
	ck_assert_int_eq(plan_request_from_message(&request, &client.request, &config.table, err, sizeof err), 0);
	result = scene_run(planner, &request);
	plan_message_begin(out, &client.request);
	plan_message_fill(out, &result, &config.table, &config.model, scratch);
	planner_destroy(planner);
}

/* The final answer to a node budget, bit for bit but for when and after how many others it came: at any number of
 * workers, in every scheme, the same as in this process. */
START_TEST(node_budgets_repeat)
{
	static const struct {
		const char *scheme;
		int workers;
	} way[] = {{"batch", 1}, {"batch", 2}, {"windows", 8}, {"queue", 2}, {"steal", 1}, {"steal", 8}};
	static billiard_plan_t want;
	begin(way[_i].scheme, way[_i].workers);
	fill_endless();
	client.request.budget_nodes = 1500;
	client_ask(&client);
	ck_assert(client_wait(&client, 60));
	search_here(&want);
	want.utime = client.plan.utime;
	want.sequence = client.plan.sequence;
	want.seconds = client.plan.seconds;
	want.is_final = 1;
	ck_assert(memcmp(&want, &client.plan, sizeof want) == 0);
}
END_TEST

START_TEST(newer_requests_replace_older_ones)
{
	begin("windows", 2);
	for (int i = 0; i < 10; i++) {
		int64_t cancelled = client.cancelled;
		fill_endless();
		client_ask(&client);
		int64_t former = client.id;
		if (i % 2)
			ck_assert(client_wait_first(&client, 10));
		fill_quick();
		client_ask(&client);
		ck_assert(client_wait(&client, 10));
		ck_assert_int_eq(client.plan.status, PLAN_MESSAGE_OK);
		ck_assert_int_eq(client.cancelled, cancelled + 1);
		ck_assert(client.other.request_id == former && client.other.status == PLAN_MESSAGE_CANCELLED);
	}
	fill_endless();
	client_ask(&client);
	ck_assert(client_wait_first(&client, 10));
	client_cancel(&client, client.id);
	ck_assert(client_wait(&client, 10));
	ck_assert_int_eq(client.plan.status, PLAN_MESSAGE_CANCELLED);
	ck_assert_int_gt(client.plan.entry_count, 0); /* the best so far */
}
END_TEST

static void expect_refused(const char *reason)
{
	client_ask(&client);
	ck_assert(client_wait(&client, 10));
	ck_assert_int_eq(client.plan.status, PLAN_MESSAGE_REFUSED);
	ck_assert_msg(gives(reason), "%s", (const char *)client.plan.reason);
}

/* Malformed, impossible, outdated: an answer with the reason each, and STATUS counts them. */
START_TEST(bad_requests_get_a_reason)
{
	begin(NULL, 0);
	fill_quick();
	client.request.ball_count = -7;
	expect_refused("ball_count");
	fill_quick();
	client.request.balls[1].x = client.request.balls[2].x;
	client.request.balls[1].y = client.request.balls[2].y;
	expect_refused("overlap");
	fill_quick();
	client.request.balls[0].colour = COLOUR_RED;
	expect_refused("white");
	fill_quick();
	client.request.depth = 50;
	expect_refused("depth");
	fill_quick();
	client.request.budget_s = -1;
	expect_refused("budget");
	/* an older id */
	fill_quick();
	client_ask(&client);
	ck_assert(client_wait(&client, 10));
	client.id -= 2;
	client_ask(&client);
	ck_assert(client_wait(&client, 10));
	ck_assert(client.plan.status == PLAN_MESSAGE_CANCELLED && gives("outdated"));
	client.id += 2;
	/* bytes that are no request */
	for (int size = 0; size < 40; size += 13) {
		int64_t refused = client.refused;
		bus_publish(client.bus, "PLAN_REQUEST", &bus_raw,
			    &(struct raw_message){"this is not a request, not even nearly", size});
		for (int i = 0; i < 100 && client.refused == refused; i++)
			client_wait(&client, 0), poll(NULL, 0, 20);
		ck_assert_int_eq(client.refused, refused + 1);
		ck_assert(client.other.request_id == 0 && strstr((const char *)client.other.reason, "malformed"));
	}
	for (int i = 0; i < 150 && !(client_metric(&client, "malformed") == 4); i++)
		client_wait(&client, 0), poll(NULL, 0, 20);
	ck_assert(client_metric(&client, "malformed") == 4);
	ck_assert(client_metric(&client, "refused") == 5);
	ck_assert(client_metric(&client, "outdated") == 1);
	ck_assert(client_metric(&client, "nodes") > 0);
}
END_TEST

/* Killed during a search: the next one answers the repeated request. */
START_TEST(killed_and_restarted)
{
	begin(NULL, 2);
	for (int i = 0; i < 3; i++) {
		fill_endless();
		client.request.budget_s = 0.3;
		client_ask(&client);
		ck_assert(client_wait_first(&client, 10));
		kill(client.pid, SIGKILL);
		ck_assert_int_eq(fixture_end(client.pid, 10), 128 + SIGKILL);
		client_start(&client);
		client_ask(&client);
		ck_assert(client_wait(&client, 10));
		ck_assert_int_eq(client.plan.status, PLAN_MESSAGE_OK);
	}
}
END_TEST

START_TEST(terminated_during_a_search)
{
	static const char *const schemes[] = {"batch", "windows", "queue", "steal"};
	begin(schemes[_i], 2);
	fill_endless();
	client_ask(&client);
	ck_assert(client_wait_first(&client, 10));
	kill(client.pid, SIGTERM);
	ck_assert_int_eq(fixture_end(client.pid, 10), 0);
}
END_TEST

START_TEST(stopped_and_continued)
{
	begin("windows", 2);
	fill_endless();
	client.request.budget_s = 3;
	client_ask(&client);
	ck_assert(client_wait_first(&client, 10));
	kill(client.pid, SIGSTOP);
	poll(NULL, 0, 2000);
	kill(client.pid, SIGCONT);
	ck_assert(client_wait(&client, 10));
	ck_assert_int_eq(client.plan.status, PLAN_MESSAGE_OK);
	fill_quick();
	client_ask(&client);
	ck_assert(client_wait(&client, 10));
}
END_TEST

/* Far more requests than can be worked on; the last one counts, and memory does not grow. */
START_TEST(flood)
{
	begin(NULL, 2);
	struct ball ball[BALL_MAX];
	scene_after_break(&config.table, 1, ball);
	long before = 0;
	for (int round = 0; round < 3; round++) {
		for (int i = 0; i < 500; i++) {
			client_fill(&client, ball, BALL_MAX);
			client.request.rails = 2;
			client_ask(&client);
			client_wait(&client, 0.001);
		}
		ck_assert(client_wait(&client, 20));
		ck_assert_int_eq(client.plan.status, PLAN_MESSAGE_OK);
		if (round == 0)
			before = client_memory(&client);
	}
	ck_assert_int_le(client_memory(&client), before + 1024);
}
END_TEST

Suite *test_suite(void)
{
	fixture_begin();
	Suite *suite = suite_create("planner_bus");
	TCase *tc = tcase_create("planner_bus");
	tcase_set_timeout(tc, 100);
	tcase_add_checked_fixture(tc, NULL, teardown);
	tcase_add_test(tc, first_then_better_then_final);
	tcase_add_loop_test(tc, node_budgets_repeat, 0, 6);
	tcase_add_test(tc, newer_requests_replace_older_ones);
	tcase_add_test(tc, bad_requests_get_a_reason);
	tcase_add_test(tc, killed_and_restarted);
	tcase_add_loop_test(tc, terminated_during_a_search, 0, 4);
	tcase_add_test(tc, stopped_and_continued);
	tcase_add_test(tc, flood);
	suite_add_tcase(suite, tc);
	return suite;
}
