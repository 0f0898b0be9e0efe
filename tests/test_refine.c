/* Aims refined against the simulation: more cushion shots land, and near the middle of what was aimed at. */
#include "harness.h"
#include "search_scenes.h"
#include "scenes.h"

#include <stdio.h>

START_TEST(more_shots_land)
{
	static const char *const name[] = {"simple", "real"};
	struct random random = random_begin("more_shots_land");
	struct table table = scene_thesis_table();
	struct planner *planner = scene_planner(&table, name[_i], NULL, 1);
	uint64_t tried = 0, landed = 0, refined = 0;
	for (int n = 0; n < 20; n++) {
		struct ball ball[BALL_MAX];
		scene_random(&random, &table, 0.01, ball, 5);
		struct plan_request request = scene_request(ball, 5);
		request.rails = 1;
		request.target = TARGET_ANY;
		struct plan_result result = scene_run(planner, &request);
		ck_assert_uint_le(result.landed, result.tried);
		ck_assert_uint_le(result.refined, result.tried);
		tried += result.tried;
		landed += result.landed;
		refined += result.refined;
	}
	printf("%s: %d tried, %d land, %d refined\n", name[_i], (int)tried, (int)landed, (int)refined);
	ck_assert_uint_gt(tried, 200);
	ck_assert_uint_gt(refined, 2 * landed);
	ck_assert_uint_gt(2 * refined, tried);
	planner_destroy(planner);
}
END_TEST

/* Mirrors are exact in the thesis' model: nothing is refined, and aims are those of the geometry. */
START_TEST(mirrors_need_none)
{
	struct random random = random_begin("mirrors_need_none");
	struct table table = scene_thesis_table();
	struct planner *planner = scene_planner(&table, "thesis", NULL, 1);
	struct ball ball[BALL_MAX];
	scene_random(&random, &table, 0.01, ball, 5);
	struct plan_request request = scene_request(ball, 5);
	request.rails = 2;
	struct plan_result result = scene_run(planner, &request);
	ck_assert_uint_eq(result.refined, 0);
	ck_assert_uint_le(result.sims, result.tried + 2); /* a contact shot, while there was no pot */
	planner_destroy(planner);
}
END_TEST

/* One red, one cushion: the first ball leaves the contact for the pocket's middle, not for its edge. */
START_TEST(refined_to_the_middle)
{
	static struct trace_entry entry[256];
	struct table table = scene_thesis_table();
	struct model model;
	struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){-0.5, -0.2}), ball_at(COLOUR_RED, (vec2){0.3, 0.1})};
	struct plan_request request = scene_request(ball, 2);
	request.rails = 1;
	ck_assert(model_from_name("real", &model));
	struct planner *planner = scene_planner(&table, "real", NULL, 1);
	struct plan_result result = scene_run(planner, &request);
	int looked = 0;
	for (int i = 0; i < result.plan_count; i++) {
		const struct plan_shot *shot = &result.plan[i].shot[0];
		struct trace trace;
		trace_init(&trace, entry, 256);
		ck_assert(plan_shot_replay(&table, &model, shot, 2, &trace));
		for (int k = 0; k < trace.count; k++) {
			const struct trace_entry *e = &trace.entry[k];
			if (e->event.kind == EVENT_CUSHION && e->event.ball == 1 &&
			    !table.cushion[e->event.other].main_rail)
				break; /* over a jaw: the edge was the aim that worked */
			if (e->event.kind != EVENT_POCKET || e->event.ball != 1)
				continue;
			const struct pocket *p = &table.pocket[shot->pocket];
			vec2 way = vec2_unit(k > 0 ? trace_at(&trace, 1, e->event.time - 1e-6).vel : (vec2){1, 0});
			double beside = fabs(vec2_cross(way, vec2_sub(p->centre, e->after[0].pos)));
			ck_assert(beside < 0.9 * p->radius);
			looked++;
		}
	}
	ck_assert_int_gt(looked, 2);
	planner_destroy(planner);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("refine");
	TCase *tc = tcase_create("refine");
	tcase_set_timeout(tc, 60);
	tcase_add_loop_test(tc, more_shots_land, 0, 2);
	tcase_add_test(tc, mirrors_need_none);
	tcase_add_test(tc, refined_to_the_middle);
	suite_add_tcase(suite, tc);
	return suite;
}
