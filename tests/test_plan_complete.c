/* Completeness: what playing every direction forward finds, the search proposes. */
#include "harness.h"
#include "brute_force.h"
#include "search_scenes.h"
#include "scenes.h"

static void found_pots(const struct plan_result *result, uint8_t found[BALL_MAX])
{
	for (int i = 0; i < result->plan_count; i++) {
		const struct plan_shot *shot = &result->plan[i].shot[0];
		if (shot->target >= 0)
			found[shot->target] |= (uint8_t)(1u << shot->pocket);
	}
}

/* 200 positions take make eval; here every fifth. */
START_TEST(nothing_is_missed)
{
	static const struct brute_fan fan = {.angles = 720, .speed = {1, 2, 3.5, 5}, .speed_count = 4};
	struct random random = random_begin("nothing_is_missed");
	struct table table = scene_thesis_table();
	struct cost_profile profile = brute_profile();
	struct planner *planner = scene_planner(&table, "thesis", &profile, 1);
	struct model model;
	int pots = 0;
	ck_assert(model_from_name("thesis", &model));
	for (int n = 0; n < 40; n++) {
		struct ball ball[BALL_MAX];
		struct brute_result brute;
		uint8_t found[BALL_MAX] = {0};
		int count = 2 + n % 11;
		scene_random(&random, &table, 0.002, ball, count);
		brute_force(&table, &model, ball, count, &fan, cost_profile_thesis().clearance, &brute);
		struct plan_request request = scene_request(ball, count);
		request.speeds = 10;
		request.balls = 2;
		struct plan_result result = scene_run(planner, &request);
		found_pots(&result, found);
		for (int b = 0; b < count; b++)
			for (int p = 0; p < table.pocket_count; p++) {
				bool by_force = brute.pots[b] >> p & 1;
				pots += by_force;
				ck_assert_msg(!by_force || (found[b] >> p & 1),
					      "position %d: ball %d into %s at %.3f deg", n, b, table.pocket[p].name,
					      brute.angle[b][p] * 180 / M_PI);
			}
	}
	ck_assert_int_gt(pots, 100);
	planner_destroy(planner);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("plan_complete");
	TCase *tc = tcase_create("complete");
	tcase_set_timeout(tc, 120);
	tcase_add_test(tc, nothing_is_missed);
	suite_add_tcase(suite, tc);
	return suite;
}
