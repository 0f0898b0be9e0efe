/* The ways of sharing open nodes: the same lists from each, none loses or doubles work, all end when told to. */
#include <errno.h>
#include <malloc.h>
#include <pthread.h>
#include <string.h>
#include <time.h>

#include "harness.h"
#include "scenes.h"
#include "search_scenes.h"

static const int crews[] = {1, 2, 8};
enum { CREWS = sizeof crews / sizeof *crews };

static double seconds(void *context)
{
	(void)context;
	struct timespec t;
	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Short windows, so that these searches have many. */
static struct planner *make(const struct table *table, const struct cost_profile *profile, enum plan_scheme scheme,
			    int workers)
{
	struct planner_def def = planner_def_default();
	struct planner *planner = NULL;
	def.table = table;
	if (profile)
		def.profile = *profile;
	def.scheme = scheme;
	def.workers = workers;
	def.sync_period = 0.005;
	def.sync_window = 0.0005;
	def.now = seconds;
	def.progress_plans = 3;
	ck_assert_int_eq(planner_create(&planner, &def), 0);
	return planner;
}

static bool same_shot(const struct plan_shot *a, const struct plan_shot *b)
{
	return a->hash == b->hash && a->cost == b->cost && memcmp(&a->shot, &b->shot, sizeof a->shot) == 0 &&
	       a->target == b->target && a->pocket == b->pocket && memcmp(a->chain, b->chain, sizeof a->chain) == 0 &&
	       a->points == b->points;
}

static void check_same_list(const struct plan_result *a, const struct plan_result *b)
{
	ck_assert_int_eq(a->plan_count, b->plan_count);
	for (int i = 0; i < a->plan_count; i++) {
		ck_assert(a->plan[i].cost == b->plan[i].cost);
		ck_assert_int_eq(a->plan[i].shot_count, b->plan[i].shot_count);
		for (int s = 0; s < a->plan[i].shot_count; s++)
			ck_assert(same_shot(&a->plan[i].shot[s], &b->plan[i].shot[s]));
	}
}

/* One request in every scheme at 1, 2 and 8 workers against batches at one worker. */
static void check_request(const struct table *table, const struct cost_profile *profile,
			  const struct plan_request *request, bool exhausts)
{
	struct planner *plain = make(table, profile, SCHEME_BATCH, 1);
	struct plan_result want = scene_run(plain, request);
	for (int scheme = 0; scheme < SCHEME_COUNT; scheme++)
		for (int c = 0; c < CREWS; c++) {
			struct planner *planner = make(table, profile, (enum plan_scheme)scheme, crews[c]);
			struct plan_result result = scene_run(planner, request);
			ck_assert(result.exhausted == want.exhausted);
			ck_assert(!exhausts || result.exhausted);
			check_same_list(&want, &result);
			if (!exhausts || request->plans == PLAN_MAX) {
				ck_assert_uint_eq(result.nodes, want.nodes);
				ck_assert_uint_eq(
					result.tried,
					want.tried); /* not sims: when a contact is proposed meanwhile depends */
			}
			planner_destroy(planner);
		}
	planner_destroy(plain);
}

START_TEST(exhaustive_lists_are_equal)
{
	struct random random = random_begin("exhaustive_lists_are_equal");
	struct table table = scene_thesis_table();
	for (int n = 0; n < 4; n++) {
		struct ball ball[BALL_MAX];
		int count = 3 + 2 * n;
		random.state += (uint64_t)_i;
		scene_random(&random, &table, 0.003, ball, count);
		struct plan_request request = scene_request(ball, count);
		request.target = n & 1 ? TARGET_RULES : TARGET_ANY;
		request.rails = 1;
		request.balls = 2;
		request.speeds = 2;
		request.depth = n < 2 ? 2 : 1;
		request.tolerances = 1;
		check_request(&table, NULL, &request, true);
		request.depth = 2;
		request.plans = 7; /* full lists: what costs more is pruned, in whatever order it comes */
		check_request(&table, NULL, &request, true);
	}
}
END_TEST

START_TEST(ball_in_hand)
{
	struct random random = random_begin("ball_in_hand");
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	scene_random(&random, &table, 0.003, ball, 4);
	struct plan_request request = scene_request(ball, 4);
	request.state.in_hand = true;
	request.plans = 20;
	check_request(&table, NULL, &request, true);
}
END_TEST

/* Nothing to pot, nothing to do at all. */
START_TEST(no_solution)
{
	struct table table = scene_thesis_table();
	struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){0.1, 0}), ball_at(COLOUR_RED, (vec2){0.9, 0})};
	struct plan_request request = scene_request(ball, 2);
	request.rails = 0;
	check_request(&table, NULL, &request, true);
}
END_TEST

/* A node budget is worked on in batches whatever the scheme: the same at any number of workers. */
START_TEST(node_budgets_repeat)
{
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	scene_after_break(&table, 2, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.target = TARGET_ANY;
	request.rails = 1;
	request.depth = 2;
	request.plans = 40;
	request.budget.nodes = 2500;
	check_request(&table, NULL, &request, false);
}
END_TEST

struct watch {
	int calls;
	double last;
};

static void on_progress(void *context, const struct plan_result *result)
{
	struct watch *watch = context;
	ck_assert_int_gt(result->plan_count, 0);
	ck_assert_int_le(result->plan_count, 3);
	ck_assert_int_ge(result->found, result->plan_count);
	ck_assert(result->plan[0].shot_count > 0);
	watch->calls++;
	watch->last = result->plan[0].cost;
}

/* Improvements are told as they come and end with the best; the figures say where the search stands. */
START_TEST(progress_and_figures)
{
	struct random random = random_begin("progress_and_figures");
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	scene_random(&random, &table, 0.01, ball, 9);
	struct plan_request request = scene_request(ball, 9);
	request.target = TARGET_ANY;
	request.depth = 2;
	request.rails = 1;
	request.plans = 50;
	struct planner *planner = make(&table, NULL, (enum plan_scheme)_i, 2);
	struct plan_figures before, after;
	struct plan_result result;
	char err[100];
	planner_figures(planner, &before);
	ck_assert_uint_eq(before.nodes, 0);
	for (int n = 1; n <= 2; n++) {
		struct watch watch = {0, 0};
		planner_figures(planner, &before);
		ck_assert_int_eq(planner_run(planner, &request, on_progress, &watch, &result, err, sizeof err), 0);
		ck_assert_int_gt(watch.calls, 0);
		ck_assert_double_eq(watch.last, result.plan[0].cost);
		planner_figures(planner, &after);
		ck_assert_uint_eq(after.nodes - before.nodes, result.nodes);
		ck_assert_uint_ge(result.sims, after.sims - before.sims);
		ck_assert_int_eq(after.busy, 0);
		ck_assert_uint_eq(after.open, 0);
		ck_assert_int_eq(after.depth, result.plan[0].shot_count);
	}
	planner_destroy(planner);
}
END_TEST

/* What goes on long enough to be cut short. */
static struct plan_request long_request(const struct table *table)
{
	struct ball ball[BALL_MAX];
	scene_after_break(table, 3, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.target = TARGET_ANY;
	request.rails = 3;
	request.depth = 4;
	request.speeds = 5;
	request.run = 1;
	return request;
}

static void *cancel_soon(void *planner)
{
	nanosleep(&(struct timespec){0, 20 * 1000 * 1000}, NULL); /* before the search begins or in it */
	planner_cancel(planner, 1);
	return NULL;
}

START_TEST(cancelled_and_used_again)
{
	struct table table = scene_thesis_table();
	struct planner *planner = make(&table, NULL, (enum plan_scheme)(_i / CREWS), crews[_i % CREWS]);
	struct plan_request request = long_request(&table);
	struct plan_result result;
	char err[100];
	pthread_t thread;
	ck_assert_int_eq(pthread_create(&thread, NULL, cancel_soon, planner), 0);
	ck_assert_int_eq(planner_run(planner, &request, NULL, NULL, &result, err, sizeof err), -ECANCELED);
	pthread_join(thread, NULL);
	ck_assert_int_eq(result.status, PLAN_CANCELLED);
	ck_assert(!result.exhausted);
	request.run = 2; /* the cancel was for the first */
	request.depth = 1;
	request.rails = 0;
	result = scene_run(planner, &request);
	ck_assert(result.exhausted);
	ck_assert_int_eq(result.status, PLAN_OK);
	planner_destroy(planner);
}
END_TEST

/* A live budget ends the search with what there is; only that scheme has windows. */
START_TEST(live_budget)
{
	struct table table = scene_thesis_table();
	struct planner *planner = make(&table, NULL, (enum plan_scheme)_i, 2);
	struct plan_request request = long_request(&table);
	struct plan_figures figures;
	request.budget.seconds = 0.3;
	struct plan_result result = scene_run(planner, &request);
	ck_assert(!result.exhausted);
	ck_assert_int_gt(result.plan_count, 0);
	planner_figures(planner, &figures);
	ck_assert_uint_gt(figures.nodes, 0);
	if (_i == SCHEME_WINDOWS)
		ck_assert_uint_gt(figures.windows_held + figures.windows_missed + figures.windows_blocked, 0);
	else
		ck_assert_uint_eq(figures.windows_held + figures.windows_missed + figures.windows_blocked, 0);
	planner_destroy(planner);
}
END_TEST

/* Little room: nodes and positions are dropped, nothing breaks, and the result says so. */
START_TEST(overflow_is_told)
{
	struct table table = scene_thesis_table();
	struct planner *planner = NULL;
	struct planner_def def = planner_def_default();
	def.table = &table;
	def.scheme = (enum plan_scheme)_i;
	def.workers = 2;
	def.now = seconds;
	size_t little = 1, enough = 64u << 20;
	while (enough - little > 4096) { /* the least that is accepted, to some 30 nodes */
		def.memory = little + (enough - little) / 2;
		int rc = planner_create(&planner, &def);
		*(rc == 0 ? &enough : &little) = def.memory;
		planner_destroy(planner);
	}
	def.memory = enough + 4096;
	ck_assert_int_eq(planner_create(&planner, &def), 0);
	struct plan_request request = long_request(&table);
	request.depth = 1;
	struct plan_result result = scene_run(planner, &request);
	ck_assert(!result.exhausted);
	planner_destroy(planner);
}
END_TEST

START_TEST(no_memory_is_taken_by_searches)
{
	struct table table = scene_thesis_table();
	struct plan_request request = long_request(&table);
	request.budget.seconds = 0.05;
	for (int scheme = 0; scheme < SCHEME_COUNT; scheme++) {
		struct planner *planner = make(&table, NULL, (enum plan_scheme)scheme, 2);
		scene_run(planner, &request);
		size_t made = mallinfo2().uordblks + mallinfo2().hblkhd;
		for (int i = 0; i < 5; i++)
			scene_run(planner, &request);
		ck_assert_uint_eq(mallinfo2().uordblks + mallinfo2().hblkhd, made);
		planner_destroy(planner);
	}
}
END_TEST

START_TEST(bad_definitions)
{
	struct table table = scene_thesis_table();
	struct planner *planner;
	struct planner_def def = planner_def_default();
	def.table = &table;
	def.scheme = SCHEME_WINDOWS;
	ck_assert_int_eq(planner_create(&planner, &def), -EINVAL); /* windows need a clock */
	def.now = seconds;
	ck_assert_int_eq(planner_create(&planner, &def), 0);
	planner_destroy(planner);
	def.sync_window = def.sync_period / 2 + 0.001; /* one worker and the manager do not fit */
	ck_assert_int_eq(planner_create(&planner, &def), -EINVAL);
	def.sync_window = 0;
	ck_assert_int_eq(planner_create(&planner, &def), -EINVAL);
	def.scheme = SCHEME_COUNT;
	ck_assert_int_eq(planner_create(&planner, &def), -EINVAL);
}
END_TEST

START_TEST(names)
{
	enum plan_scheme found = SCHEME_QUEUE;
	for (int i = 0; i < SCHEME_COUNT; i++) {
		ck_assert(scheme_from_name(scheme_name((enum plan_scheme)i), &found));
		ck_assert_int_eq((int)found, i);
	}
	ck_assert(!scheme_from_name("", &found));
	ck_assert(!scheme_from_name("Batch", &found));
	ck_assert_int_eq((int)found, SCHEME_COUNT - 1);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("scheme");
	TCase *tc = tcase_create("scheme");
	tcase_set_timeout(tc, 120);
	tcase_add_loop_test(tc, exhaustive_lists_are_equal, 0, 3);
	tcase_add_test(tc, ball_in_hand);
	tcase_add_test(tc, no_solution);
	tcase_add_test(tc, node_budgets_repeat);
	tcase_add_loop_test(tc, progress_and_figures, 0, SCHEME_COUNT);
	tcase_add_loop_test(tc, cancelled_and_used_again, 0, SCHEME_COUNT * CREWS);
	tcase_add_loop_test(tc, live_budget, 0, SCHEME_COUNT);
	tcase_add_loop_test(tc, overflow_is_told, 0, SCHEME_COUNT);
	tcase_add_test(tc, no_memory_is_taken_by_searches);
	tcase_add_test(tc, bad_definitions);
	tcase_add_test(tc, names);
	suite_add_tcase(suite, tc);
	return suite;
}
