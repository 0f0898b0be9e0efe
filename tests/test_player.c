#include "harness.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/virtual/player.h"
#include "scenes.h"

static struct table table;
static struct model model;
static char err[200];

static const struct config_virtual exact = {.time_scale = 1, .seed = 1};

static struct virtual_table *begin(const struct config_virtual *def, bool rules, const struct ball *ball, int count)
{
	struct virtual_table *vt = malloc(sizeof(*vt));
	table = scene_thesis_table();
	ck_assert(model_from_name("thesis", &model));
	player_init(vt, &table, &model, def, rules, ball, count);
	return vt;
}

static struct virtual_table *begin_rack(const struct config_virtual *def, bool rules)
{
	struct ball ball[BALL_MAX];
	table = scene_thesis_table();
	player_rack(&table, ball);
	return begin(def, rules, ball, BALL_MAX);
}

/* Cue ball straight behind a ball that lies before the middle of the right cushion's lower pocket. */
static int straight_pot(struct ball ball[3], enum ball_colour colour, double *angle)
{
	table = scene_thesis_table();
	vec2 pocket = table.pocket[table_pocket(&table, "BOTTOM-RIGHT")].centre, way = vec2_unit((vec2){-1, 0.6});
	ball[0] = ball_at(COLOUR_WHITE, vec2_madd(pocket, 0.7, way));
	ball[1] = ball_at(colour, vec2_madd(pocket, 0.25, way));
	ball[2] = ball_at(COLOUR_RED, (vec2){-0.3, 0.3});
	*angle = atan2(-way.y, -way.x);
	return 3;
}

static void run_to_end(struct virtual_table *vt, double now)
{
	ck_assert(vt->running);
	ck_assert(player_tick(vt, now + vt->result.duration / vt->time_scale + 1e-6));
	ck_assert(!vt->running);
}

START_TEST(rack_is_a_legal_position)
{
	struct ball ball[BALL_MAX];
	struct table tables[2] = {scene_thesis_table(), scene_snooker_table()};
	for (int t = 0; t < 2; t++) {
		int first, second, count[COLOUR_COUNT] = {0};
		player_rack(&tables[t], ball);
		ck_assert_int_eq(table_check_balls(&tables[t], ball, BALL_MAX, &first, &second, err, sizeof(err)), 0);
		for (int i = 0; i < BALL_MAX; i++)
			count[ball[i].colour]++;
		ck_assert_int_eq(count[COLOUR_RED], 15);
		ck_assert_int_eq(count[COLOUR_WHITE], 1);
		ck_assert_int_eq(count[COLOUR_BLACK], 1);
		ck_assert_double_le(ball[0].pos.x, tables[t].baulk_d_centre.x);
		ck_assert_double_le(vec2_dist(ball[0].pos, tables[t].baulk_d_centre), tables[t].baulk_d_radius);
	}
}
END_TEST

START_TEST(exact_player_pots_a_straight_ball)
{
	struct ball ball[3], seen[BALL_MAX];
	double angle;
	int n = straight_pot(ball, COLOUR_RED, &angle);
	struct virtual_table *vt = begin(&exact, false, ball, n);
	ck_assert_int_eq(player_play(vt, &(struct shot){.angle = angle, .speed = 1.0}, 10, err, sizeof(err)), 0);
	ck_assert_double_eq(vt->result.played.angle, angle);
	ck_assert_double_eq(vt->result.played.speed, 1.0);
	player_balls(vt, 10, seen);
	ck_assert_double_eq_tol(seen[0].pos.x, ball[0].pos.x, 1e-12);
	player_balls(vt, 10.2, seen);
	ck_assert_double_gt(vec2_dist(seen[0].pos, ball[0].pos), 0.1);
	ck_assert(!player_tick(vt, 10 + vt->result.duration / 2));
	run_to_end(vt, 10);
	ck_assert(!player_tick(vt, 1000));
	ck_assert_int_eq(vt->result.first, 1);
	ck_assert_int_ge(vt->result.potted_count, 1);
	ck_assert_int_eq(vt->result.potted[0].ball, 1);
	ck_assert_int_eq(vt->result.potted[0].pocket, table_pocket(&table, "BOTTOM-RIGHT"));
	ck_assert(vt->ball[1].phase == BALL_POTTED);
	free(vt);
}
END_TEST

START_TEST(colours_come_back_while_reds_remain)
{
	struct ball ball[3];
	double angle;
	int n = straight_pot(ball, COLOUR_BLUE, &angle);
	struct virtual_table *vt = begin(&exact, false, ball, n);
	ck_assert_int_eq(player_play(vt, &(struct shot){.angle = angle, .speed = 0.8}, 0, err, sizeof(err)), 0);
	run_to_end(vt, 0);
	ck_assert_int_eq(vt->result.potted[0].ball, 1);
	ck_assert(vt->ball[1].phase == BALL_REST);
	ck_assert_double_le(vec2_dist(vt->ball[1].pos, table.spot[COLOUR_BLUE]), 1e-9);
	free(vt);
}
END_TEST

START_TEST(last_colour_stays_off)
{
	struct ball ball[3];
	double angle;
	straight_pot(ball, COLOUR_BLACK, &angle);
	struct virtual_table *vt = begin(&exact, false, ball, 2);
	ck_assert(!player_is_done(vt));
	ck_assert_int_eq(player_play(vt, &(struct shot){.angle = angle, .speed = 0.8}, 0, err, sizeof(err)), 0);
	run_to_end(vt, 0);
	if (!vt->result.cue_potted)
		ck_assert(player_is_done(vt));
	free(vt);
}
END_TEST

START_TEST(potted_cue_ball_comes_back_into_the_d)
{
	struct ball ball[2];
	table = scene_thesis_table();
	vec2 pocket = table.pocket[0].centre;
	ball[0] = ball_at(COLOUR_WHITE, (vec2){-0.5, -0.2});
	ball[1] = ball_at(COLOUR_RED,
			  (vec2){table.baulk_d_centre.x - table.baulk_d_radius / 2, 0}); /* where it would go first */
	struct virtual_table *vt = begin(&exact, false, ball, 2);
	vec2 way = vec2_sub(pocket, ball[0].pos);
	ck_assert_int_eq(
		player_play(vt, &(struct shot){.angle = atan2(way.y, way.x), .speed = 1.5}, 0, err, sizeof(err)), 0);
	run_to_end(vt, 0);
	ck_assert(vt->result.cue_potted);
	ck_assert_int_gt(vt->result.foul, 0);
	ck_assert(vt->ball[0].phase == BALL_REST);
	ck_assert_double_le(vt->ball[0].pos.x, table.baulk_d_centre.x);
	ck_assert_double_le(vec2_dist(vt->ball[0].pos, table.baulk_d_centre), table.baulk_d_radius);
	ck_assert_double_ge(vec2_dist(vt->ball[0].pos, vt->ball[1].pos), 2 * table.ball_radius);
	free(vt);
}
END_TEST

/* After any shot of a long random game the position is one that the next shot can be played from. */
START_TEST(random_game_stays_legal)
{
	struct random random = random_begin("random_game_stays_legal");
	struct config_virtual def = {.time_scale = 3, .seed = 7, .error_angle = 0.01, .error_speed = 0.1};
	struct virtual_table *vt = begin_rack(&def, true);
	double now = 0;
	for (int i = 0; i < 60 && !player_is_done(vt); i++) {
		struct shot shot = {.angle = random_in(&random, -3, 3), .speed = random_in(&random, 0.5, 6)};
		struct ball seen[BALL_MAX];
		ck_assert_int_eq(player_play(vt, &shot, now, err, sizeof(err)), 0);
		for (int k = 0; k < 20; k++) {
			player_balls(vt, now + k * vt->result.duration / 60, seen);
			for (int b = 0; b < vt->count; b++)
				ck_assert(ball_is_finite(&seen[b]));
		}
		run_to_end(vt, now);
		now += 100;
		struct ball on[BALL_MAX];
		int first, second, n = 0;
		bool cue = false;
		for (int b = 0; b < vt->count; b++)
			if (vt->ball[b].phase != BALL_POTTED) {
				cue |= vt->ball[b].colour == COLOUR_WHITE;
				on[n++] = vt->ball[b];
			}
		ck_assert(cue);
		ck_assert_msg(table_check_balls(&table, on, n, &first, &second, err, sizeof(err)) == 0, "shot %d: %s",
			      i, err);
	}
	ck_assert_int_gt((int)vt->shots, 10);
	free(vt);
}
END_TEST

START_TEST(error_has_its_sigma_and_its_seed)
{
	struct config_virtual def = {.time_scale = 1, .seed = 5, .error_angle = 0.02, .error_speed = 0.05};
	struct ball ball[3];
	double angle, sum = 0, sum2 = 0, speed2 = 0;
	enum { SHOTS = 2000 };
	int n = straight_pot(ball, COLOUR_RED, &angle);
	struct virtual_table *vt = begin(&def, false, ball, 1), *same = begin(&def, false, ball, 1);
	(void)n;
	for (int i = 0; i < SHOTS; i++) {
		struct shot shot = {.angle = 0.3, .speed = 0.05};
		ck_assert_int_eq(player_play(vt, &shot, i * 100, err, sizeof(err)), 0);
		ck_assert_int_eq(player_play(same, &shot, i * 100, err, sizeof(err)), 0);
		ck_assert_double_eq(vt->result.played.angle, same->result.played.angle);
		double a = vt->result.played.angle - 0.3, s = vt->result.played.speed / 0.05 - 1;
		sum += a, sum2 += a * a, speed2 += s * s;
		run_to_end(vt, i * 100);
		run_to_end(same, i * 100);
		vt->ball[0] = same->ball[0] = ball[0];
	}
	/* 5 standard errors */
	ck_assert_double_eq_tol(sum / SHOTS, 0, 5 * 0.02 / sqrt(SHOTS));
	ck_assert_double_eq_tol(sqrt(sum2 / SHOTS), 0.02, 5 * 0.02 / sqrt(2 * SHOTS));
	ck_assert_double_eq_tol(sqrt(speed2 / SHOTS), 0.05, 5 * 0.05 / sqrt(2 * SHOTS));
	free(vt);
	free(same);
}
END_TEST

START_TEST(time_scale_only_changes_the_clock)
{
	struct config_virtual fast = {.time_scale = 5, .seed = 1};
	struct virtual_table *a = begin_rack(&exact, false), *b = begin_rack(&fast, false);
	struct shot shot = {.angle = 0.02, .speed = 4};
	struct ball at_a[BALL_MAX], at_b[BALL_MAX];
	ck_assert_int_eq(player_play(a, &shot, 0, err, sizeof(err)), 0);
	ck_assert_int_eq(player_play(b, &shot, 0, err, sizeof(err)), 0);
	player_balls(a, 1.0, at_a);
	player_balls(b, 0.2, at_b);
	for (int i = 0; i < BALL_MAX; i++)
		ck_assert_double_le(vec2_dist(at_a[i].pos, at_b[i].pos), 1e-9);
	ck_assert(!player_tick(a, b->result.duration / 5 + 1e-6));
	ck_assert(player_tick(b, b->result.duration / 5 + 1e-6));
	free(a);
	free(b);
}
END_TEST

START_TEST(bad_shots_are_refused_and_change_nothing)
{
	static const struct shot bad[] = {{.angle = NAN, .speed = 1},
					  {.speed = 0},
					  {.speed = -1},
					  {.speed = 21},
					  {.speed = NAN},
					  {.speed = 1, .side = 1},
					  {.speed = 1, .follow = NAN},
					  {.speed = 1, .elevation = 1.5708},
					  {.speed = 1, .elevation = -0.1}};
	struct virtual_table *vt = begin_rack(&exact, false);
	for (size_t i = 0; i < sizeof(bad) / sizeof(bad[0]); i++) {
		ck_assert_int_eq(player_play(vt, &bad[i], 0, err, sizeof(err)), -EINVAL);
		ck_assert(!vt->running && vt->shots == 0);
	}
	ck_assert_int_eq(player_play(vt, &(struct shot){.speed = 1}, 0, err, sizeof(err)), 0);
	ck_assert_int_eq(player_play(vt, &(struct shot){.speed = 1}, 0, err, sizeof(err)), -EBUSY);
	ck_assert_int_eq((int)vt->shots, 1);
	free(vt);
	struct ball red = ball_at(COLOUR_RED, (vec2){0, 0});
	vt = begin(&exact, false, &red, 1);
	ck_assert_int_eq(player_play(vt, &(struct shot){.speed = 1}, 0, err, sizeof(err)), -EINVAL);
	free(vt);
}
END_TEST

/* Balls come back one after the other by hand, the cue ball last; nobody can play before. */
START_TEST(a_hand_brings_what_comes_back)
{
	struct ball ball[3], seen[BALL_MAX];
	struct config_virtual slow = exact;
	double angle, end;
	vec2 where;
	slow.habit.place_time = 2;
	int n = straight_pot(ball, COLOUR_BLUE, &angle);
	struct virtual_table *vt = begin(&slow, false, ball, n);
	ck_assert(!player_place(vt, 0, &where));
	ck_assert_int_eq(player_play(vt, &(struct shot){.angle = angle, .speed = 0.8}, 0, err, sizeof(err)), 0);
	run_to_end(vt, 0);
	end = vt->result.duration + 1e-6;
	player_balls(vt, end, seen);
	ck_assert(seen[1].phase == BALL_POTTED);
	ck_assert(player_place(vt, end + 1.9, &where));
	ck_assert_double_le(vec2_dist(where, table.spot[COLOUR_BLUE]), 1e-9);
	player_balls(vt, end + 1.9, seen);
	ck_assert(seen[1].phase == BALL_POTTED);
	player_place(vt, end + 2.1, &where);
	player_balls(vt, end + 2.1, seen);
	ck_assert(seen[1].phase == BALL_REST);
	ck_assert_double_le(vec2_dist(seen[1].pos, table.spot[COLOUR_BLUE]), 1e-9);
	player_place(vt, end + 4.2, &where);
	ck_assert(!player_place(vt, end + 4.3, &where));
	free(vt);
}
END_TEST

START_TEST(scattered_balls_are_a_position_to_play)
{
	struct table tables[2] = {scene_thesis_table(), scene_snooker_table()};
	for (int t = 0; t < 2; t++)
		for (uint64_t seed = 0; seed < 200; seed++) {
			struct ball ball[BALL_MAX], again[BALL_MAX];
			int count[COLOUR_COUNT] = {0}, first, second, n = player_scatter(&tables[t], seed, ball);
			ck_assert_int_eq(table_check_balls(&tables[t], ball, n, &first, &second, err, sizeof(err)), 0);
			for (int i = 0; i < n; i++)
				count[ball[i].colour]++;
			ck_assert_int_eq(count[COLOUR_WHITE], 1);
			ck_assert(count[COLOUR_RED] >= 1 && count[COLOUR_RED] <= 10);
			for (int c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++)
				ck_assert_int_eq(count[c], 1);
			ck_assert_int_eq(player_scatter(&tables[t], seed, again), n);
			ck_assert_mem_eq(again, ball, sizeof(*ball) * (size_t)n);
		}
}
END_TEST

/* What the configuration says of the table that is there is not what the planner reckons with. */
START_TEST(a_slower_cloth_stops_the_ball_earlier)
{
	struct ball ball[1] = {ball_at(COLOUR_WHITE, (vec2){-0.8, 0.1})};
	struct config_virtual slow = exact;
	slow.cloth = 2;
	slow.bounce = 1;
	struct virtual_table *a = begin(&exact, false, ball, 1), *b = begin(&slow, false, ball, 1);
	ck_assert_int_eq(player_play(a, &(struct shot){.angle = 0, .speed = 0.5}, 0, err, sizeof(err)), 0);
	ck_assert_int_eq(player_play(b, &(struct shot){.angle = 0, .speed = 0.5}, 0, err, sizeof(err)), 0);
	run_to_end(a, 0);
	run_to_end(b, 0);
	double way = a->ball[0].pos.x + 0.8, slow_way = b->ball[0].pos.x + 0.8;
	ck_assert_double_lt(slow_way, 0.75 * way);
	ck_assert_double_gt(slow_way, 0.45 * way);
	free(a);
	free(b);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("player");
	TCase *shots = tcase_create("shots"), *errors = tcase_create("errors");
	tcase_set_timeout(shots, 60);
	tcase_add_test(shots, rack_is_a_legal_position);
	tcase_add_test(shots, exact_player_pots_a_straight_ball);
	tcase_add_test(shots, colours_come_back_while_reds_remain);
	tcase_add_test(shots, last_colour_stays_off);
	tcase_add_test(shots, potted_cue_ball_comes_back_into_the_d);
	tcase_add_test(shots, random_game_stays_legal);
	tcase_add_test(shots, time_scale_only_changes_the_clock);
	tcase_add_test(errors, error_has_its_sigma_and_its_seed);
	tcase_add_test(errors, bad_shots_are_refused_and_change_nothing);
	tcase_add_test(errors, a_hand_brings_what_comes_back);
	tcase_add_test(errors, scattered_balls_are_a_position_to_play);
	tcase_add_test(errors, a_slower_cloth_stops_the_ball_earlier);
	suite_add_tcase(suite, shots);
	suite_add_tcase(suite, errors);
	return suite;
}
