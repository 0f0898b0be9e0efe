/* The judge of play: repeatable, fair, and a player without error does what is proposed to him. */
#include "harness.h"
#include "scenes.h"
#include "search_scenes.h"

#include <stdio.h>
#include <string.h>

#include "app/commands/match.h"

static const double degree = M_PI / 180;

static struct match_setting setting_for(const struct table *table, double angle, double speed)
{
	struct match_setting setting = {
		.table = table, .error = {.angle = angle * degree, .speed = speed}, .seed = 7, .from_break = false};
	ck_assert(model_from_name("real", &setting.model));
	return setting;
}

static struct match_side side_for(const struct match_setting *setting, int workers, uint64_t nodes)
{
	struct cost_profile profile = cost_profile_thesis();
	profile.ranking = RANK_VALUE;
	profile.program_speed = profile.any_first = profile.keep_flukes = false;
	profile.clearance = profile.cue_clearance = 0.002;
	struct match_side side = {.planner = scene_planner(setting->table, "real", &profile, workers)};
	side.request = plan_request_default();
	side.request.balls = 1;
	side.request.plans = 5;
	side.request.budget.nodes = nodes;
	side.request.has_error = true;
	side.request.error = setting->error;
	return side;
}

static struct match_count visits(const struct match_setting *setting, int workers, int count)
{
	struct match_count sum = {.visits = 0};
	struct match_side side = side_for(setting, workers, 3000);
	for (int i = 0; i < count; i++) {
		struct match_count part = {.visits = 0};
		match_visit(setting, &side, i, &part);
		match_add(&sum, &part);
	}
	planner_destroy(side.planner);
	return sum;
}

START_TEST(same_seed_same_visits)
{
	struct table table = scene_snooker_table();
	struct match_setting setting = setting_for(&table, 0.1, 0.03);
	struct match_count a = visits(&setting, 1, 2), b = visits(&setting, 2, 2);
	ck_assert_mem_eq(&a, &b, sizeof a);
	ck_assert_int_eq(a.visits, 2);
	setting.seed++;
	struct match_count c = visits(&setting, 1, 2);
	ck_assert_msg(memcmp(&a, &c, sizeof a) != 0, "another seed, the same visits");
}
END_TEST

/* Without an error the proposal happens as it was simulated: every pot falls. */
START_TEST(perfect_player)
{
	struct table table = scene_snooker_table();
	struct match_setting setting = setting_for(&table, 0, 0);
	struct match_count sum = visits(&setting, 1, 3);
	printf("perfect player: %d of %d pots, %.1f points a visit, %d fouls\n", sum.pots_made, sum.pots_proposed,
	       sum.points / sum.visits, sum.fouls);
	ck_assert_int_ge(sum.pots_proposed, 3);
	ck_assert_int_ge(100 * sum.pots_made, 99 * sum.pots_proposed);
	ck_assert_int_eq(sum.fouls, 0);
}
END_TEST

/* What is counted adds up, in a frame as in its sides; the break goes in turn. */
START_TEST(frames_add_up)
{
	struct table table = scene_thesis_table();
	struct match_setting setting = setting_for(&table, 0.5, 0.1);
	setting.from_break = true;
	struct match_side side[2] = {side_for(&setting, 1, 1500), side_for(&setting, 1, 1500)};
	struct match_frame frame[2];
	struct match_count count[2][2];
	memset(count, 0, sizeof count);
	for (int i = 0; i < 2; i++) {
		match_frame_play(&setting, side, i, count[i], &frame[i]);
		int shots = count[i][0].shots + count[i][1].shots;
		ck_assert_int_le(shots - frame[i].shots, 1); /* the last shot leaves the loop */
		ck_assert_int_ge(shots - frame[i].shots, 0);
		ck_assert(frame[i].winner < 0 || frame[i].points[frame[i].winner] > frame[i].points[!frame[i].winner]);
	}
	for (int i = 0; i < 2; i++)
		planner_destroy(side[i].planner);
}
END_TEST

/* The side whose turn it is to break plays the first shot: with the other's planner answering nothing there is none. */
START_TEST(breaks_in_turn)
{
	struct table table = scene_thesis_table();
	struct match_setting setting = setting_for(&table, 2, 0.2);
	setting.from_break = true;
	for (int frame = 0; frame < 2; frame++) {
		struct match_side side[2] = {side_for(&setting, 1, 300), side_for(&setting, 1, 300)};
		struct match_count count[2];
		struct match_frame result;
		memset(count, 0, sizeof count);
		side[!frame].request.depth = 0; /* refused */
		match_frame_play(&setting, side, frame, count, &result);
		ck_assert_int_ge(count[frame].shots, 1);
		ck_assert_int_eq(count[!frame].shots, 0);
		planner_destroy(side[0].planner);
		planner_destroy(side[1].planner);
	}
}
END_TEST

/* Positions of the middle of a frame: on the bed, apart, 3 to 10 reds, all colours; the same for a seed. */
START_TEST(positions)
{
	struct table table = scene_snooker_table();
	struct match_setting setting = setting_for(&table, 0, 0);
	for (int i = 0; i < 200; i++) {
		struct ball ball[BALL_MAX], again[BALL_MAX];
		int first, second, reds = 0, count = match_position(&setting, i, ball);
		char err[200];
		ck_assert_int_eq(count, match_position(&setting, i, again));
		for (int k = 0; k < count; k++) {
			ck_assert(vec2_dist(ball[k].pos, again[k].pos) == 0);
			reds += ball[k].colour == COLOUR_RED;
		}
		ck_assert(reds >= 3 && reds <= 10 && count == reds + 7);
		ck_assert_msg(table_check_balls(&table, ball, count, &first, &second, err, sizeof err) == 0, "%d: %s",
			      i, err);
	}
	setting.from_break = true;
	struct ball ball[BALL_MAX];
	ck_assert_int_eq(match_position(&setting, 0, ball), BALL_MAX);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("match");
	TCase *tc = tcase_create("match");
	tcase_set_timeout(tc, 120);
	tcase_add_test(tc, positions);
	tcase_add_test(tc, same_seed_same_visits);
	tcase_add_test(tc, perfect_player);
	tcase_add_test(tc, frames_add_up);
	tcase_add_test(tc, breaks_in_turn);
	suite_add_tcase(suite, tc);
	return suite;
}
