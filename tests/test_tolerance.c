/* Tolerance and success against playing with a player's error; the order by success. */
#include "harness.h"
#include "search_scenes.h"
#include "scenes.h"

enum { SAMPLES = 2000 };

/* Standard normal, Box and Muller. */
static double normal(struct random *random)
{
	double u = random_in(random, 1e-300, 1), v = random_in(random, 0, 2 * M_PI);
	return sqrt(-2 * log(u)) * cos(v);
}

static bool falls(const struct table *table, const struct model *model, const struct plan_shot *shot, int count,
		  const struct shot *played)
{
	static struct sim sim;
	static struct trace_entry entry[2048];
	struct trace trace;
	bool target = false, cue = false;
	trace_init(&trace, entry, 2048);
	sim_init(&sim, table, model, shot->start, count);
	sim_strike(&sim, 0, played);
	sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = 2000}, &trace);
	for (int i = 0; i < trace.count; i++) {
		const struct event *event = &trace.entry[i].event;
		target |= event->kind == EVENT_POCKET && event->ball == shot->target && event->other == shot->pocket;
		cue |= event->kind == EVENT_POCKET && event->ball == 0;
	}
	return target && !cue;
}

static double sampled(struct random *random, const struct table *table, const struct model *model,
		      const struct cost_profile *profile, const struct plan_shot *shot, int count)
{
	int good = 0;
	for (int i = 0; i < SAMPLES; i++) {
		struct shot played = shot->shot;
		played.angle += profile->error.angle * normal(random);
		played.speed *= fmax(0.01, 1 + profile->error.speed * normal(random));
		good += falls(table, model, shot, count, &played);
	}
	return (double)good / SAMPLES;
}

static struct cost_profile player(void)
{
	struct cost_profile profile = cost_profile_thesis();
	profile.any_first = profile.keep_flukes = profile.program_speed = false;
	profile.error.angle = 0.2 * M_PI / 180;
	profile.error.speed = 0.04;
	profile.pocket_speed = 0.2;
	return profile;
}

/* The probability is that of the two errors on their own; what both together do may differ by some percent. */
START_TEST(success_is_what_sampling_gives)
{
	static const char *const name[] = {"thesis", "real"};
	struct random random = random_begin("success_is_what_sampling_gives");
	struct table table = scene_thesis_table();
	struct cost_profile profile = player();
	struct model model;
	double sum = 0;
	int shots = 0;
	ck_assert(model_from_name(name[_i], &model));
	struct planner *planner = scene_planner(&table, name[_i], &profile, 1);
	for (int n = 0; n < 8; n++) {
		struct ball ball[BALL_MAX];
		scene_random(&random, &table, 0.05, ball, 5);
		struct plan_request request = scene_request(ball, 5);
		request.target = TARGET_ANY;
		request.tolerances = 3;
		request.balls = 1;
		struct plan_result result = scene_run(planner, &request);
		for (int i = 0; i < result.plan_count && i < 3; i++) {
			const struct plan_shot *shot = &result.plan[i].shot[0];
			if (shot->target < 0)
				continue;
			ck_assert(shot->success >= 0 && shot->success <= 1);
			double difference = shot->success - sampled(&random, &table, &model, &profile, shot, 5);
			ck_assert_msg(fabs(difference) < 0.2, "%g off", difference);
			sum += fabs(difference);
			shots++;
		}
	}
	ck_assert_int_gt(shots, 10);
	ck_assert(sum / shots < 0.05);
	planner_destroy(planner);
}
END_TEST

START_TEST(within_the_tolerance_it_falls)
{
	struct random random = random_begin("within_the_tolerance_it_falls");
	struct table table = scene_thesis_table();
	struct cost_profile profile = player();
	struct model model;
	int good = 0, all = 0;
	ck_assert(model_from_name("thesis", &model));
	struct planner *planner = scene_planner(&table, "thesis", &profile, 1);
	for (int n = 0; n < 20; n++) {
		struct ball ball[BALL_MAX];
		scene_random(&random, &table, 0.03, ball, 6);
		struct plan_request request = scene_request(ball, 6);
		request.tolerances = 2;
		struct plan_result result = scene_run(planner, &request);
		for (int i = 0; i < result.plan_count && i < 2; i++) {
			const struct plan_shot *shot = &result.plan[i].shot[0];
			for (int k = -4; k <= 4 && shot->target >= 0; k++) {
				struct shot angle = shot->shot, speed = shot->shot;
				angle.angle += 0.99 * k / 4 * shot->tolerance_angle;
				speed.speed *= 1 + 0.99 * k / 4 * shot->tolerance_speed;
				good += falls(&table, &model, shot, 6, &angle) + falls(&table, &model, shot, 6, &speed);
				all += 2;
			}
		}
	}
	ck_assert_int_gt(all, 200);
	/* doubling may step over a gap */
	ck_assert(good > 0.98 * all);
	planner_destroy(planner);
}
END_TEST

START_TEST(order_by_success)
{
	struct random random = random_begin("order_by_success");
	struct table table = scene_thesis_table();
	struct cost_profile profile = player();
	struct ball ball[BALL_MAX];
	profile.ranking = RANK_SUCCESS;
	struct planner *planner = scene_planner(&table, "thesis", &profile, 2);
	for (int n = 0; n < 5; n++) {
		scene_random(&random, &table, 0.03, ball, 8);
		struct plan_request request = scene_request(ball, 8);
		request.plans = 5;
		request.rails = 1;
		request.depth = 1 + n % 2;
		struct plan_result result = scene_run(planner, &request);
		ck_assert_int_le(result.plan_count, 5);
		double last = 1;
		for (int i = 0; i < result.plan_count; i++) {
			double chance = 1;
			for (int s = 0; s < result.plan[i].shot_count; s++)
				chance *= result.plan[i].shot[s].success;
			ck_assert(result.plan[0].shot[0].target < 0 || chance <= last);
			last = chance;
		}
	}
	planner_destroy(planner);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("tolerance");
	TCase *tc = tcase_create("tolerance");
	tcase_set_timeout(tc, 120);
	tcase_add_loop_test(tc, success_is_what_sampling_gives, 0, 2);
	tcase_add_test(tc, within_the_tolerance_it_falls);
	tcase_add_test(tc, order_by_success);
	suite_add_tcase(suite, tc);
	return suite;
}
