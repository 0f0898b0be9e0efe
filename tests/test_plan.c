/* The planner: proposals that do what they say, the same at any number of workers, in fixed memory, at any moment. */
#include "harness.h"
#include "search_scenes.h"
#include "scenes.h"

#include <errno.h>
#include <malloc.h>
#include <pthread.h>
#include <semaphore.h>
#include <string.h>
#include <time.h>

enum { TRACE_MAX = 4096 };

static struct trace_entry entry[TRACE_MAX];

static const char *const models[] = {"thesis", "simple", "simple-elastic", "real"};

/* Each shot again from its own start, and each next start from the rules. */
static void check_plan(const struct table *table, const struct model *model, const struct plan *plan, int count)
{
	for (int s = 0; s < plan->shot_count; s++) {
		const struct plan_shot *shot = &plan->shot[s];
		struct trace trace;
		trace_init(&trace, entry, TRACE_MAX);
		ck_assert(plan_shot_replay(table, model, shot, count, &trace));
		if (shot->target < 0)
			continue;
		bool falls = false;
		for (int i = 0; i < shot->potted_count; i++)
			falls |= shot->potted[i].ball == shot->target && shot->potted[i].pocket == shot->pocket;
		ck_assert(falls);
		ck_assert_int_eq(shot->foul, 0);
		ck_assert_int_gt(shot->points, 0);
		ck_assert_int_eq(shot->chain[shot->chain_count], -1);
	}
}

/* Random positions of 2 to 22 balls on both tables in all models: what is proposed comes true. */
static void check_random(int first, int positions, struct random *random)
{
	struct table table[2] = {scene_thesis_table(), scene_snooker_table()};
	int shots = 0;
	for (int n = first; n < first + positions; n++) {
		struct ball ball[BALL_MAX];
		struct model model;
		const struct table *t = &table[n & 1];
		const char *name = models[n / 2 % 4];
		int count = 2 + n % 21;
		scene_random(random, t, 0.005, ball, count);
		struct plan_request request = scene_request(ball, count);
		request.target = n % 3 == 0 ? TARGET_RULES : TARGET_ANY;
		request.rails = n % 4;
		request.balls = 2;
		request.depth = n % 5 == 0 ? 2 : 1;
		request.budget.nodes = 1500;
		request.plans = 20;
		ck_assert(model_from_name(name, &model));
		struct planner *planner = scene_planner(t, name, NULL, 1);
		struct plan_result result = scene_run(planner, &request);
		ck_assert_int_gt(result.plan_count, 0);
		for (int i = 0; i < result.plan_count; i++) {
			check_plan(t, &model, &result.plan[i], count);
			shots += result.plan[i].shot_count;
		}
		planner_destroy(planner);
	}
	ck_assert_int_gt(shots, positions);
}

START_TEST(proposals_come_true)
{
	struct random random = random_begin("proposals_come_true");
	random.state += (uint64_t)_i;
	check_random(125 * _i, 125, &random);
}
END_TEST

START_TEST(costs_are_in_order)
{
	struct random random = random_begin("costs_are_in_order");
	struct table table = scene_thesis_table();
	struct planner *planner = scene_planner(&table, "thesis", NULL, 1);
	for (int n = 0; n < 20; n++) {
		struct ball ball[BALL_MAX];
		scene_random(&random, &table, 0.005, ball, 8);
		struct plan_request request = scene_request(ball, 8);
		request.rails = 2;
		struct plan_result result = scene_run(planner, &request);
		for (int i = 0; i + 1 < result.plan_count; i++)
			ck_assert(result.plan[i].cost <= result.plan[i + 1].cost);
		for (int i = 0; i < result.plan_count; i++) {
			const struct plan_shot *shot = &result.plan[i].shot[0];
			ck_assert_double_eq_tol(result.plan[i].cost, shot->cost, 1e-12);
			ck_assert(shot->cost >= shot->search_cost);
		}
		/* fewer wanted: the first of the same list */
		struct plan first[3];
		int kept = result.plan_count < 3 ? result.plan_count : 3;
		memcpy(first, result.plan, (size_t)kept * sizeof first[0]);
		request.plans = 3;
		result = scene_run(planner, &request);
		ck_assert_int_eq(result.plan_count, kept);
		for (int i = 0; i < kept; i++)
			ck_assert(result.plan[i].shot[0].hash == first[i].shot[0].hash);
	}
	planner_destroy(planner);
}
END_TEST

/* A chain is played at its least speed and at steps above it, up to the player's largest and no further. */
START_TEST(start_speeds_are_steps)
{
	struct table table = scene_thesis_table();
	struct cost_profile profile = cost_profile_thesis();
	struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){0, -0.2}), ball_at(COLOUR_RED, (vec2){0, 0.2})};
	profile.speed_step = 0.25;
	profile.max_speed = 2.1;
	profile.aims = 1;
	int pocket = table_pocket(&table, "TOP-CENTER");
	for (int speeds = 1; speeds <= 12; speeds++) {
		struct plan_request request = scene_request(ball, 2);
		request.speeds = speeds;
		struct planner *planner = scene_planner(&table, "thesis", &profile, 1);
		struct plan_result result = scene_run(planner, &request);
		double least = INFINITY, most = 0;
		int played = 0;
		for (int i = 0; i < result.plan_count; i++) {
			const struct plan_shot *shot = &result.plan[i].shot[0];
			if (shot->pocket != pocket || shot->chain_count != 2)
				continue;
			least = fmin(least, shot->shot.speed);
			most = fmax(most, shot->shot.speed);
			played++;
		}
		int possible = 1 + (int)((profile.max_speed - least) / profile.speed_step);
		ck_assert_int_gt(possible, 3);
		ck_assert_int_lt(possible, 12);
		ck_assert_int_eq(played, speeds < possible ? speeds : possible);
		ck_assert_double_eq_tol(most, least + (played - 1) * profile.speed_step, 1e-12);
		ck_assert(most <= profile.max_speed);
		planner_destroy(planner);
	}
}
END_TEST

/* The same list, bit for bit, at 1, 2 and 8 workers, exhausted and cut short by nodes, with tolerances. */
START_TEST(workers_do_not_matter)
{
	static const int workers[] = {1, 2, 8};
	static const uint64_t budgets[] = {0, 100, 777, 3000};
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	struct random random = random_begin("workers_do_not_matter");
	for (int n = 0; n < 4; n++) {
		scene_random(&random, &table, 0.002, ball, 9);
		uint64_t want[4] = {0};
		for (int w = 0; w < 3; w++) {
			struct planner *planner = scene_planner(&table, n & 1 ? "real" : "thesis", NULL, workers[w]);
			for (int b = 0; b < 4; b++) {
				struct plan_request request = scene_request(ball, 9);
				request.target = TARGET_RULES;
				request.rails = 1 + n % 2;
				request.depth = 2;
				request.plans = 50;
				request.tolerances = 3;
				request.budget.nodes = budgets[b];
				struct plan_result result = scene_run(planner, &request);
				uint64_t hash = scene_hash(&result, 9);
				if (w == 0)
					want[b] = hash;
				ck_assert(hash == want[b]);
				if (budgets[b] > 0)
					ck_assert(result.nodes + result.sims <= budgets[b] + 1000);
				else
					ck_assert(result.exhausted);
			}
			planner_destroy(planner);
		}
	}
}
END_TEST

/* More nodes never make the best plan worse, and the same planner gives the same again. */
START_TEST(anytime)
{
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	scene_after_break(&table, 2, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.target = TARGET_ANY;
	request.rails = 1;
	struct planner *planner = scene_planner(&table, "thesis", NULL, 1);
	double best = INFINITY;
	for (uint64_t nodes = 20; nodes <= 20000; nodes *= 3) {
		request.budget.nodes = nodes;
		struct plan_result result = scene_run(planner, &request);
		uint64_t hash = scene_hash(&result, BALL_MAX);
		ck_assert_int_gt(result.plan_count, 0);
		if (result.plan[0].shot[0].target >= 0) {
			ck_assert(result.plan[0].cost <= best);
			best = result.plan[0].cost;
		}
		result = scene_run(planner, &request);
		ck_assert(scene_hash(&result, BALL_MAX) == hash);
	}
	ck_assert(best < INFINITY);
	planner_destroy(planner);
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
	watch->calls++;
	watch->last = result->plan[0].cost;
}

START_TEST(progress_tells_improvements)
{
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	struct random random = random_begin("progress_tells_improvements");
	scene_random(&random, &table, 0.01, ball, 8);
	struct plan_request request = scene_request(ball, 8);
	request.depth = 2;
	struct planner *planner = scene_planner(&table, "thesis", NULL, 1);
	struct plan_result result;
	struct watch watch = {0, 0};
	char err[100];
	ck_assert_int_eq(planner_run(planner, &request, on_progress, &watch, &result, err, sizeof err), 0);
	ck_assert_int_gt(watch.calls, 0);
	ck_assert_double_eq(watch.last, result.plan[0].cost);
	planner_destroy(planner);
}
END_TEST

/* Cancels once the search has told its first proposal. */
struct canceller {
	struct planner *planner;
	uint64_t run;
	sem_t told;
};

static void *cancel_then(void *context)
{
	struct canceller *canceller = context;
	while (sem_wait(&canceller->told) != 0)
		continue;
	planner_cancel(canceller->planner, canceller->run);
	return NULL;
}

static void tell(void *context, const struct plan_result *result)
{
	struct canceller *canceller = context;
	(void)result;
	sem_post(&canceller->told);
}

static double steady_clock(void *context)
{
	struct timespec now;
	(void)context;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

START_TEST(cancelled_from_another_thread)
{
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	scene_after_break(&table, 3, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.target = TARGET_ANY;
	request.rails = 3;
	request.depth = 4;
	request.speeds = 5;
	struct planner *planner = scene_planner(&table, "real", NULL, _i);
	struct plan_result result;
	char err[100];
	pthread_t thread;
	struct canceller canceller = {.planner = planner, .run = 7};
	request.run = 7;
	sem_init(&canceller.told, 0, 0);
	ck_assert_int_eq(pthread_create(&thread, NULL, cancel_then, &canceller), 0);
	ck_assert_int_eq(planner_run(planner, &request, tell, &canceller, &result, err, sizeof err), -ECANCELED);
	pthread_join(thread, NULL);
	ck_assert_int_eq(result.status, PLAN_CANCELLED);
	ck_assert(!result.exhausted);
	/* what is there holds, and the planner goes on */
	struct model model;
	model_from_name("real", &model);
	for (int i = 0; i < result.plan_count && i < 20; i++)
		check_plan(&table, &model, &result.plan[i], BALL_MAX);
	request.run++;
	request.depth = 1;
	request.rails = 0;
	result = scene_run(planner, &request);
	ck_assert_int_eq(result.status, PLAN_OK);
	planner_destroy(planner);
}
END_TEST

/* A cancel given between request and run is not lost; it counts for its run and those before, never for a later one, nor
 * for one without a number. */
START_TEST(cancelled_before_it_runs)
{
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	scene_after_break(&table, 3, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	struct planner_def def = planner_def_default();
	struct planner *planner;
	struct plan_result result;
	char err[100];
	def.table = &table;
	def.workers = 2;
	def.scheme = (enum plan_scheme)_i;
	def.now = steady_clock;
	ck_assert_int_eq(planner_create(&planner, &def), 0);
	planner_cancel(planner, 5);
	planner_cancel(planner, 3); /* takes nothing back */
	for (request.run = 0; request.run < 8; request.run++) {
		bool cancelled = request.run >= 1 && request.run <= 5;
		int rc = planner_run(planner, &request, NULL, NULL, &result, err, sizeof err);
		ck_assert_int_eq(rc, cancelled ? -ECANCELED : 0);
		ck_assert_int_eq(result.status, cancelled ? PLAN_CANCELLED : PLAN_OK);
		ck_assert_int_eq(result.exhausted, !cancelled);
	}
	planner_cancel(planner, UINT64_MAX);
	request.run = UINT64_MAX - 1;
	ck_assert_int_eq(planner_run(planner, &request, NULL, NULL, &result, err, sizeof err), -ECANCELED);
	planner_destroy(planner);
}
END_TEST

static double clock_steps(void *context)
{
	return *(double *)context += 0.001;
}

START_TEST(budget_in_seconds)
{
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	double time = 0;
	char err[100];
	scene_after_break(&table, 1, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.rails = 3;
	request.budget.seconds = 0.02;
	struct plan_result result;
	struct planner *planner = scene_planner(&table, "thesis", NULL, 1);
	ck_assert_int_eq(planner_run(planner, &request, NULL, NULL, &result, err, sizeof err), -EINVAL);
	planner_destroy(planner);
	struct planner_def def = planner_def_default();
	def.table = &table;
	def.now = clock_steps;
	def.now_context = &time;
	ck_assert_int_eq(planner_create(&planner, &def), 0);
	ck_assert_int_eq(planner_run(planner, &request, NULL, NULL, &result, err, sizeof err), 0);
	ck_assert(!result.exhausted);
	ck_assert_int_gt(result.plan_count, 0);
	ck_assert(time < 0.2);
	planner_destroy(planner);
}
END_TEST

/* A live budget is not searched away: time is kept to find the success of what is proposed, more of it when that decides
 * the order, and the whole still ends in time. */
START_TEST(time_is_kept_for_ranking)
{
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	scene_after_break(&table, 3, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.target = TARGET_ANY;
	request.rails = 3;
	request.depth = 4;
	request.speeds = 5;
	request.plans = 200;
	request.tolerances = 1;
	request.budget.seconds = _i ? 2 : 8; /* of a clock that goes on a millisecond whenever it is asked */
	double time = 0;
	char err[100];
	struct planner *planner;
	struct planner_def def = planner_def_default();
	def.table = &table;
	def.profile.ranking = _i ? RANK_SUCCESS : RANK_THESIS;
	def.profile.pocket_speed = 0.2;
	def.now = clock_steps;
	def.now_context = &time;
	ck_assert_int_eq(planner_create(&planner, &def), 0);
	struct plan_result result;
	ck_assert_int_eq(planner_run(planner, &request, NULL, NULL, &result, err, sizeof err), 0);
	ck_assert(!result.exhausted);
	int known = 0;
	for (int i = 0; i < result.plan_count; i++)
		for (int s = 0; s < result.plan[i].shot_count; s++)
			known += !isnan(result.plan[i].shot[s].success);
	ck_assert_int_ge(known, _i ? 5 : result.plan[0].shot_count);
	ck_assert(!isnan(result.plan[0].shot[0].success));
	ck_assert(time <= request.budget.seconds + 0.2);
	planner_destroy(planner);
}
END_TEST

/* No memory is taken by a search, and a planner stays within what it was given. */
START_TEST(memory_is_fixed)
{
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	scene_after_break(&table, 3, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.rails = 3;
	request.depth = 2;
	request.target = TARGET_ANY;
	request.budget.nodes = 3000;
	size_t before = mallinfo2().uordblks + mallinfo2().hblkhd;
	struct planner *planner = scene_planner(&table, "thesis", NULL, 1);
	size_t made = mallinfo2().uordblks + mallinfo2().hblkhd;
	ck_assert_uint_le(made - before, 32u << 20);
	scene_run(planner, &request);
	ck_assert_uint_eq(mallinfo2().uordblks + mallinfo2().hblkhd, made);
	planner_destroy(planner);
}
END_TEST

/* With room for few nodes the search still ends with a proposal, and says that it dropped some. */
START_TEST(little_memory)
{
	struct table table = scene_thesis_table();
	struct ball ball[BALL_MAX];
	struct planner *planner;
	struct planner_def def = planner_def_default();
	def.table = &table;
	def.memory = 1;
	ck_assert_int_eq(planner_create(&planner, &def), -EINVAL);
	ck_assert_ptr_null(planner);
	while (planner_create(&planner, &def) != 0) /* the least that is enough, to 1 % */
		def.memory += def.memory / 100 + 1000;
	ck_assert_uint_lt(def.memory, 32u << 20);
	scene_after_break(&table, 3, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.rails = 3;
	request.target = TARGET_ANY;
	struct plan_result result = scene_run(planner, &request);
	ck_assert_int_gt(result.plan_count, 0);
	planner_destroy(planner);
}
END_TEST

START_TEST(bad_definitions)
{
	struct table table = scene_thesis_table();
	struct planner *planner;
	struct planner_def def = planner_def_default();
	ck_assert_int_eq(planner_create(&planner, &def), -EINVAL);
	def.table = &table;
	def.workers = 0;
	ck_assert_int_eq(planner_create(&planner, &def), -EINVAL);
	def.workers = PLAN_WORKERS_MAX + 1;
	ck_assert_int_eq(planner_create(&planner, &def), -EINVAL);
	planner_destroy(NULL);
}
END_TEST

/* Profiles that the search could not work with, each spoilt in one place. */
START_TEST(bad_profiles)
{
	static const double bad[] = {-1, NAN, INFINITY, 0};
	struct table table = scene_thesis_table();
	struct planner_def def = planner_def_default();
	struct cost_profile *p = &def.profile;
	double *positive[] = {&p->max_cut, &p->max_speed, &p->pocket_speed, &p->speed_step};
	double *other[] = {&p->w_distance,    &p->w_angle,  &p->w_balls,     &p->w_rails,      &p->ball_cost,
			   &p->rail_cost,     &p->w_points, &p->w_speed,     &p->w_simulation, &p->clearance,
			   &p->cue_clearance, &p->cue_room, &p->error.angle, &p->error.speed};
	static const int aims[] = {0, -1, 10, 1000};
	struct planner *planner;
	def.table = &table;
	for (int n = 0; n < 4 + 14; n++) {
		double *field = n < 4 ? positive[n] : other[n - 4];
		for (int b = 0; b < (n < 4 ? 4 : 3); b++) {
			double good = *field;
			if (field == &p->speed_step && isinf(bad[b]))
				continue; /* one speed only: harmless */
			*field = bad[b];
			ck_assert_int_eq(planner_create(&planner, &def), -EINVAL);
			*field = good;
		}
	}
	for (int i = 0; i < 4; i++) {
		p->aims = aims[i];
		ck_assert_int_eq(planner_create(&planner, &def), -EINVAL);
	}
	p->aims = 9;
	p->max_speed = SHOT_SPEED_MAX;
	p->max_cut = M_PI / 2;
	ck_assert_int_eq(planner_create(&planner, &def), 0);
	planner_destroy(planner);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("plan");
	TCase *tc = tcase_create("plan");
	tcase_set_timeout(tc, 120);
	tcase_add_loop_test(tc, proposals_come_true, 0, 4);
	tcase_add_test(tc, costs_are_in_order);
	tcase_add_test(tc, start_speeds_are_steps);
	tcase_add_test(tc, workers_do_not_matter);
	tcase_add_test(tc, anytime);
	tcase_add_test(tc, progress_tells_improvements);
	tcase_add_loop_test(tc, cancelled_from_another_thread, 1, 3);
	tcase_add_loop_test(tc, cancelled_before_it_runs, 0, SCHEME_COUNT);
	tcase_add_test(tc, budget_in_seconds);
	tcase_add_loop_test(tc, time_is_kept_for_ranking, 0, 2);
	tcase_add_test(tc, memory_is_fixed);
	tcase_add_test(tc, little_memory);
	tcase_add_test(tc, bad_definitions);
	tcase_add_test(tc, bad_profiles);
	suite_add_tcase(suite, tc);
	return suite;
}
