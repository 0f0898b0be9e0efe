/* Requests from outside: whatever the fields hold, they are refused with a reason or searched without harm. */
#include "harness.h"
#include "search_scenes.h"
#include "scenes.h"

#include <errno.h>
#include <string.h>

/* A good request of which some fields are then spoilt. */
static struct plan_request usual(struct random *random, const struct table *table)
{
	struct ball ball[BALL_MAX];
	int count = 2 + (int)(random_u64(random) % 20);
	scene_random(random, table, 0.001, ball, count);
	struct plan_request request = scene_request(ball, count);
	request.plans = 5;
	request.budget.nodes = 40;
	return request;
}

static int wild_int(struct random *random)
{
	static const int wild[] = {0, 1, 2, 3, 4, -1, 7, 22, 23, 50, 1000000, -2147483647};
	return wild[random_u64(random) % (sizeof wild / sizeof wild[0])];
}

static double wild_double(struct random *random)
{
	static const double wild[] = {0, -0.0, 1e-300, 0.1, -0.9, 1e9, -1e300};
	uint64_t r = random_u64(random) % 10;
	return r == 7 ? NAN : r == 8 ? INFINITY : r == 9 ? -INFINITY : wild[r];
}

static void spoil(struct random *random, struct plan_request *request)
{
	struct ball *ball = &request->ball[random_u64(random) % BALL_MAX];
	switch (random_u64(random) % 16) {
	case 0:
		request->ball_count = wild_int(random);
		break;
	case 1:
		request->depth = wild_int(random);
		break;
	case 2:
		request->rails = wild_int(random);
		break;
	case 3:
		request->balls = wild_int(random);
		break;
	case 4:
		request->speeds = wild_int(random);
		break;
	case 5:
		request->plans = wild_int(random);
		break;
	case 6:
		request->tolerances = wild_int(random);
		break;
	case 7:
		request->target = (enum plan_target_kind)(random_u64(random) % 6);
		break;
	case 8:
		request->target_colour = (enum ball_colour)(random_u64(random) % 12);
		break;
	case 9:
		request->target_ball = wild_int(random);
		break;
	case 10:
		request->state.on = (enum rules_on)(random_u64(random) % 6);
		break;
	case 11:
		request->state.in_hand = true;
		break;
	case 12:
		ball->pos.x = wild_double(random);
		break;
	case 13:
		ball->pos.y = wild_double(random);
		break;
	case 14:
		ball->colour = (enum ball_colour)(random_u64(random) % 12);
		break;
	default:
		ball->phase = (enum ball_phase)(random_u64(random) % 5);
		break;
	}
}

START_TEST(spoilt_requests)
{
	struct random random = random_begin("spoilt_requests");
	struct table table = scene_thesis_table();
	struct planner *planner = scene_planner(&table, "thesis", NULL, 1);
	int refused = 0, searched = 0;
	for (int n = 0; n < 3000; n++) {
		struct plan_request request = usual(&random, &table);
		for (uint64_t i = random_u64(&random) % 4; i > 0; i--)
			spoil(&random, &request);
		char err[200] = "";
		struct plan_result result;
		int checked = plan_request_check(&table, &request, err, sizeof err);
		ck_assert(checked == 0 || (checked == -EINVAL && err[0] != 0));
		int ran = planner_run(planner, &request, NULL, NULL, &result, err, sizeof err);
		ck_assert_int_eq(ran, checked);
		refused += ran != 0;
		searched += ran == 0;
		if (ran == 0)
			ck_assert(result.plan_count <= request.plans);
	}
	ck_assert_int_gt(refused, 500);
	ck_assert_int_gt(searched, 500);
	planner_destroy(planner);
}
END_TEST

START_TEST(reasons_fit_any_buffer)
{
	struct table table = scene_thesis_table();
	struct plan_request request = plan_request_default();
	for (size_t size = 0; size < 40; size++) {
		char err[64];
		memset(err, 'x', sizeof err);
		ck_assert_int_eq(plan_request_check(&table, &request, err, size), -EINVAL);
		for (size_t i = size; i < sizeof err; i++)
			ck_assert_int_eq(err[i], 'x');
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("request");
	TCase *tc = tcase_create("request");
	tcase_set_timeout(tc, 120);
	tcase_add_test(tc, spoilt_requests);
	tcase_add_test(tc, reasons_fit_any_buffer);
	suite_add_tcase(suite, tc);
	return suite;
}
