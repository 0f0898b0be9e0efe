#include "app/process/clock.h"
#include "app/process/ball_message.h"
#include "app/planner/plan_check.h"
#include "app/process/message_table.h"
#include "app/planner/planner_service.h"

#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/planner/plan_message.h"
#include "app/process/process.h"
#include "harness.h"
#include "scenes.h"

static struct config config; /* too large for the stack */
static struct planner_service *service;
static billiard_plan_request_t request;
static billiard_plan_t answer, last;

static void setup(void)
{
	char err[640];
	ck_assert_msg(config_load(&config, "config/thesis.conf", err, sizeof err) == 0, "%s", err);
	config.planner.workers = 2;
	ck_assert_msg(planner_service_create(&service, &config, err, sizeof err) == 0, "%s", err);
}

static void teardown(void)
{
	planner_service_destroy(service);
	service = NULL;
}

/* quick: done in milliseconds; else it searches until it is told to stop. */
static billiard_plan_request_t *make(int64_t id, bool quick)
{
	static const struct {
		enum ball_colour colour;
		vec2 at;
	} ball[] = {{COLOUR_WHITE, {-0.3, 0}},
		    {COLOUR_RED, {0.35, 0.2}},
		    {COLOUR_RED, {0.6, -0.3}},
		    {COLOUR_BLUE, {0, 0.1}}};
	struct ball rack[SCENE_RACK_COUNT];
	request = (billiard_plan_request_t){.id = id, .depth = 1, .max_balls = 1, .speeds = 1, .plans = 3};
	if (!quick) {
		request.depth = 4;
		request.rails = 3;
		request.max_balls = 3;
		request.speeds = 20;
		request.plans = 256;
		scene_rack(&config.table, rack);
		request.ball_count = SCENE_RACK_COUNT;
	} else {
		request.ball_count = 4;
	}
	for (int i = 0; i < request.ball_count; i++) {
		struct ball b = quick ? ball_at(ball[i].colour, ball[i].at) : rack[i];
		char name[16];
		snprintf(name, sizeof name, "BALL%d", i);
		ball_to_message(&request.balls[i], &b, name, i + 1);
	}
	return &request;
}

/* Next answer; waits for it. */
static void next(void)
{
	struct pollfd fd = {planner_service_descriptor(service), POLLIN, 0};
	while (!planner_service_answer(service, &answer))
		ck_assert_msg(poll(&fd, 1, 20000) == 1, "no answer came");
}

static void final(void)
{
	do
		next();
	while (!answer.is_final);
}

static bool no_more(void)
{
	struct planner_service_figures f;
	do
		planner_service_figures(service, &f);
	while (f.busy);
	return !planner_service_answer(service, &answer);
}

START_TEST(answers_name_their_request_and_end_with_a_final_one)
{
	ck_assert(planner_service_request(service, make(7, true)));
	int32_t sequence = 0;
	do {
		next();
		ck_assert_int_eq(answer.request_id, 7);
		ck_assert_int_ge(answer.sequence, sequence);
		sequence = answer.sequence + 1;
	} while (!answer.is_final);
	ck_assert_int_eq(answer.status, PLAN_MESSAGE_OK);
	ck_assert(plan_check(&answer, &config.table));
	ck_assert_str_eq((const char *)answer.names[2], "BALL2");
	ck_assert(no_more());
}
END_TEST

START_TEST(the_same_request_gives_the_same_plans)
{
	planner_service_request(service, make(1, true));
	final();
	last = answer;
	planner_service_request(service, make(2, true));
	final();
	ck_assert_int_eq(answer.request_id, 2);
	ck_assert_int_eq(memcmp(answer.entries, last.entries, sizeof answer.entries), 0);
	ck_assert_int_eq(memcmp(answer.keyframes, last.keyframes, sizeof answer.keyframes), 0);
	ck_assert(answer.nodes == last.nodes && answer.sims == last.sims);
}
END_TEST

START_TEST(a_newer_request_replaces_the_running_one)
{
	ck_assert(planner_service_request(service, make(1, false)));
	ck_assert(planner_service_request(service, make(2, true)));
	bool cancelled = false;
	for (;;) {
		next();
		if (answer.request_id == 1 && answer.is_final) {
			ck_assert_int_eq(answer.status, PLAN_MESSAGE_CANCELLED);
			cancelled = true;
		}
		if (answer.request_id == 2) {
			ck_assert(cancelled);
			if (answer.is_final)
				break;
		}
	}
	ck_assert_int_eq(answer.status, PLAN_MESSAGE_OK);
	/* The former one asked late is outdated. */
	ck_assert(!planner_service_request(service, make(1, true)));
	next();
	ck_assert(answer.request_id == 1 && answer.is_final && answer.status == PLAN_MESSAGE_CANCELLED);
	ck_assert_ptr_nonnull(strstr((const char *)answer.reason, "outdated"));
	ck_assert(no_more());
}
END_TEST

START_TEST(asked_again_it_repeats_the_last_answer)
{
	planner_service_request(service, make(5, true));
	final();
	last = answer;
	for (int i = 0; i < 3; i++) {
		ck_assert(planner_service_request(service, make(5, true)));
		next();
		ck_assert_int_eq(memcmp(&answer, &last, sizeof answer), 0);
		ck_assert(no_more());
	}
	struct planner_service_figures f;
	planner_service_figures(service, &f);
	ck_assert(f.requests == 1 && f.refused == 0 && f.cancelled == 0 && f.nodes > 0);
}
END_TEST

/* Answers wait until the loop comes: a final one is never overwritten, also not by another of the same request. */
START_TEST(final_answers_wait_side_by_side)
{
	struct planner_service_figures f;
	planner_service_request(service, make(5, true));
	do
		planner_service_figures(service, &f);
	while (f.last_final == 0 || f.busy);
	planner_service_refuse(service, &request, "refused meanwhile");
	int finals = 0;
	while (planner_service_answer(service, &answer))
		if (answer.is_final)
			ck_assert_int_eq(answer.status, finals++ == 0 ? PLAN_MESSAGE_OK : PLAN_MESSAGE_REFUSED);
	ck_assert_int_eq(finals, 2);
}
END_TEST

START_TEST(asked_again_while_it_runs_it_goes_on)
{
	planner_service_request(service, make(5, false));
	planner_service_request(service, make(5, false));
	planner_service_cancel(service, 4); /* another one's */
	struct planner_service_figures f;
	planner_service_figures(service, &f);
	ck_assert(f.requests == 1 && f.cancelled == 0);
	planner_service_cancel(service, 5);
	final();
	ck_assert(answer.request_id == 5 && answer.status == PLAN_MESSAGE_CANCELLED);
	ck_assert(no_more());
}
END_TEST

START_TEST(a_cancelled_request_is_answered_as_such_also_when_asked_again)
{
	for (int64_t id = 1; id < 30; id++) {
		planner_service_request(service, make(id, false));
		planner_service_cancel(service, id);
		final();
		ck_assert(answer.request_id == id && answer.status == PLAN_MESSAGE_CANCELLED);
		planner_service_request(service, make(id, false));
		final();
		ck_assert(answer.request_id == id && answer.status == PLAN_MESSAGE_CANCELLED);
	}
	ck_assert(no_more());
}
END_TEST

/* As billiard-planner does. */
static void ask(void)
{
	char reason[96];
	if (message_check(&message_plan_request, &request, reason, sizeof reason))
		planner_service_request(service, &request);
	else
		planner_service_refuse(service, &request, reason);
}

START_TEST(bad_requests_are_refused_with_the_reason)
{
	make(1, true);
	request.ball_count = 99;
	ask();
	final();
	ck_assert(answer.status == PLAN_MESSAGE_REFUSED && answer.request_id == 1 && answer.entry_count == 0);
	ck_assert_ptr_nonnull(strstr((const char *)answer.reason, "ball_count"));
	ck_assert(plan_check(&answer, &config.table));
	make(2, true);
	request.balls[1].x = NAN;
	ask();
	final();
	ck_assert_int_eq(answer.status, PLAN_MESSAGE_REFUSED);
	ck_assert_ptr_nonnull(strstr((const char *)answer.reason, "balls[1].x: found nan"));
	make(3, true);
	request.depth = 9; /* the search's own limit */
	ask();
	final();
	ck_assert(answer.status == PLAN_MESSAGE_REFUSED && answer.request_id == 3);
	/* After that it works as before. */
	planner_service_request(service, make(4, true));
	final();
	ck_assert_int_eq(answer.status, PLAN_MESSAGE_OK);
	struct planner_service_figures f;
	planner_service_figures(service, &f);
	ck_assert_int_eq(f.refused, 3);
}
END_TEST

/* The clock of the asker was set back: after two seconds of quiet its requests are taken again. */
START_TEST(older_requests_are_taken_after_a_while)
{
	planner_service_request(service, make(1000, true));
	final();
	ck_assert(!planner_service_request(service, make(10, true)));
	final();
	double begin = clock_seconds();
	while (!planner_service_request(service, make(10, true))) {
		final();
		ck_assert(answer.request_id == 10 && answer.status == PLAN_MESSAGE_CANCELLED);
		ck_assert_double_lt(clock_seconds() - begin, 10);
	}
	final();
	ck_assert_int_eq(answer.request_id, 10);
}
END_TEST

START_TEST(bursts_are_survived)
{
	struct random random = random_begin("planner_service burst");
	int64_t id = 0;
	for (int i = 0; i < 300; i++) {
		uint64_t what = random_u64(&random) % 6;
		if (what < 3)
			planner_service_request(service, make(++id, what));
		else if (what == 3)
			planner_service_request(service,
						make(id > 2 ? id - (int64_t)(random_u64(&random) % 3) : 1, true));
		else if (what == 4)
			planner_service_cancel(service, id);
		else
			planner_service_answer(service, &answer);
	}
	planner_service_request(service, make(++id, true));
	do
		next();
	while (answer.request_id != id || !answer.is_final);
	ck_assert_int_eq(answer.status, PLAN_MESSAGE_OK);
	ck_assert(no_more());
}
END_TEST

START_TEST(it_can_be_destroyed_at_any_moment)
{
	char err[200];
	for (int i = 0; i < 12; i++) {
		struct timespec wait = {0, i * 400000};
		planner_service_request(service, make(i + 1, false));
		if (i % 3)
			nanosleep(&wait, NULL); /* a different point of the search each time */
		teardown();
		ck_assert_msg(planner_service_create(&service, &config, err, sizeof err) == 0, "%s", err);
	}
	planner_service_destroy(NULL);
}
END_TEST

START_TEST(too_little_memory_is_said)
{
	struct planner_service *other;
	char err[200] = "";
	config.planner.memory = 1 << 20;
	ck_assert_int_lt(planner_service_create(&other, &config, err, sizeof err), 0);
	ck_assert(!other && strstr(err, "memory_mib"));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("planner_service");
	TCase *life = tcase_create("requests");
	tcase_set_timeout(life, 120);
	tcase_add_checked_fixture(life, setup, teardown);
	tcase_add_test(life, answers_name_their_request_and_end_with_a_final_one);
	tcase_add_test(life, the_same_request_gives_the_same_plans);
	tcase_add_test(life, a_newer_request_replaces_the_running_one);
	tcase_add_test(life, asked_again_it_repeats_the_last_answer);
	tcase_add_test(life, final_answers_wait_side_by_side);
	tcase_add_test(life, asked_again_while_it_runs_it_goes_on);
	tcase_add_test(life, a_cancelled_request_is_answered_as_such_also_when_asked_again);
	tcase_add_test(life, bad_requests_are_refused_with_the_reason);
	tcase_add_test(life, older_requests_are_taken_after_a_while);
	tcase_add_test(life, bursts_are_survived);
	tcase_add_test(life, it_can_be_destroyed_at_any_moment);
	tcase_add_test(life, too_little_memory_is_said);
	suite_add_tcase(suite, life);
	return suite;
}
