/* The game kept from what is seen at rests: scenes as a camera sees them, with simulated shots as the judge. */
#include "app/control/keeper.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness.h"
#include "physics/model.h"
#include "physics/sim.h"
#include "scenes.h"

static struct table table;
static struct keeper k;
static double now;
static const double NUDGE = 0.0005; /* m */

static void setup(void)
{
	table = scene_thesis_table();
	k = (struct keeper){0};
	now = 10;
}

/* track NULL: new identities. */
static struct layout position(const struct ball *ball, int count, const int *track)
{
	struct layout layout = {.cue = -1};
	for (int i = 0; i < count; i++) {
		if (ball[i].phase == BALL_POTTED)
			continue;
		if (ball[i].colour == COLOUR_WHITE)
			layout.cue = layout.count;
		layout.track[layout.count] = track ? track[i] : i + 1;
		layout.ball[layout.count++] = ball_at(ball[i].colour, ball[i].pos);
	}
	return layout;
}

/* Some rests for a game in the middle: white, two reds, the colours on their spots. */
static struct layout middle(int reds)
{
	static const vec2 red[] = {{0.4, 0.2}, {0.3, -0.25}, {-0.1, 0.3}};
	struct ball ball[BALL_MAX] = {ball_at(COLOUR_WHITE, (vec2){0.1, 0.1})};
	int n = 1;
	for (int i = 0; i < reds; i++)
		ball[n++] = ball_at(COLOUR_RED, red[i]);
	for (enum ball_colour c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++)
		ball[n++] = ball_at(c, table.spot[c]);
	return position(ball, n, NULL);
}

static int index_of(const struct layout *layout, enum ball_colour colour)
{
	for (int i = 0; i < layout->count; i++)
		if (layout->ball[i].colour == colour)
			return i;
	return -1;
}

static void take_off(struct layout *layout, enum ball_colour colour)
{
	int i = index_of(layout, colour), last = layout->count - 1;
	ck_assert_int_ge(i, 0);
	layout->ball[i] = layout->ball[last];
	layout->track[i] = layout->track[last];
	layout->count = last;
	layout->cue = index_of(layout, COLOUR_WHITE);
}

static void put(struct layout *layout, enum ball_colour colour, vec2 pos)
{
	layout->track[layout->count] = 50 + layout->count;
	layout->ball[layout->count++] = ball_at(colour, pos);
	layout->cue = index_of(layout, COLOUR_WHITE);
}

static void frame(const struct layout *layout)
{
	now += 1.0 / 30;
	keeper_frame(&k, &table, layout, now, false);
}

static bool rest(const struct layout *layout)
{
	for (int i = 0; i < 5; i++)
		frame(layout);
	return keeper_rest(&k, &table, layout, NUDGE, now);
}

/* The cue ball rolls to a place, meets a ball on the way, which moves a little (or not: -1). */
static void play(struct layout *layout, enum ball_colour meets)
{
	int i = meets == COLOUR_UNKNOWN ? -1 : index_of(layout, meets);
	for (int step = 0; step < 6; step++) {
		layout->ball[layout->cue].pos.x += 0.01;
		if (i >= 0 && step > 2)
			layout->ball[i].pos.y += 0.004;
		frame(layout);
	}
}

START_TEST(a_red_a_colour_a_red)
{
	struct layout now_there = middle(3);
	ck_assert(rest(&now_there));
	ck_assert_int_eq(k.game.state.on, ON_RED);
	play(&now_there, COLOUR_RED);
	take_off(&now_there, COLOUR_RED);
	ck_assert(rest(&now_there));
	ck_assert(k.game.state.on == ON_COLOUR && k.game.score[0] == 1 && k.game.turn == 0 && k.game.break_points == 1);
	/* The blue: it is wanted back on its spot, and until it is there nobody is asked for. */
	char demand[GAME_TEXT_SIZE];
	play(&now_there, COLOUR_BLUE);
	take_off(&now_there, COLOUR_BLUE);
	ck_assert(rest(&now_there));
	game_demand(&k.game, demand);
	ck_assert_str_eq(demand, "PUT BLUE HERE");
	ck_assert(k.game.wish_count == 1 && vec2_dist(k.game.wish[0].place, table.spot[COLOUR_BLUE]) < 1e-9);
	ck_assert(k.game.score[0] == 6 && k.game.break_points == 6 && k.game.state.on == ON_RED);
	put(&now_there, COLOUR_BLUE, table.spot[COLOUR_BLUE]);
	rest(&now_there);
	game_demand(&k.game, demand);
	ck_assert_str_eq(demand, "");
	ck_assert(k.game.turn == 0 && k.game.score[0] == 6 && k.game.state.on == ON_RED && k.game.shots == 2);
}
END_TEST

START_TEST(a_miss_gives_the_turn_away)
{
	struct layout there = middle(2);
	rest(&there);
	play(&there, COLOUR_RED);
	ck_assert(rest(&there));
	ck_assert(k.game.turn == 1 && k.game.score[0] == 0 && k.game.score[1] == 0 && k.game.state.on == ON_RED);
	/* Nothing met at all: a foul. */
	play(&there, COLOUR_UNKNOWN);
	ck_assert(rest(&there));
	ck_assert(k.game.turn == 0 && k.game.score[0] == 4 && k.game.foul == 4);
}
END_TEST

START_TEST(the_wrong_ball_first_is_a_foul_of_its_value)
{
	struct layout there = middle(2);
	rest(&there);
	play(&there, COLOUR_PINK);
	rest(&there);
	ck_assert(k.game.foul == 6 && k.game.score[1] == 6 && k.game.turn == 1);
}
END_TEST

/* The cue ball falls and comes back by hand: in hand until it is played again, wherever it is put meanwhile. */
START_TEST(an_in_off_gives_the_ball_in_hand)
{
	struct layout there = middle(2);
	rest(&there);
	play(&there, COLOUR_RED);
	/* Towards a pocket, gone for a second. */
	vec2 pocket = table.pocket[3].centre;
	for (int i = 1; i <= 5; i++) {
		there.ball[there.cue].pos = vec2_madd(pocket, 0.03 + 0.04 * (5 - i), table.pocket[3].normal);
		frame(&there);
	}
	take_off(&there, COLOUR_WHITE);
	for (int i = 0; i < 10; i++)
		frame(&there);
	ck_assert(keeper_cue_fell(&k, &table));
	for (int i = 0; i < 20; i++)
		frame(&there);
	put(&there, COLOUR_WHITE, vec2_add(table.baulk_d_centre, (vec2){-0.05, 0.02}));
	ck_assert(rest(&there));
	ck_assert(k.game.state.in_hand && k.game.turn == 1 && k.game.score[1] == 4);
	/* Put elsewhere in the D: still in hand, no shot. */
	for (int i = 0; i < 5; i++) {
		there.ball[there.cue].pos.y += 0.02;
		frame(&there);
	}
	rest(&there);
	ck_assert(k.game.state.in_hand && k.game.shots == 1);
	play(&there, COLOUR_RED);
	ck_assert(rest(&there));
	ck_assert(!k.game.state.in_hand && k.game.turn == 0 && k.game.shots == 2);
}
END_TEST

/* A colour that is back on its spot before the table rests is seen to have fallen all the same. */
START_TEST(a_colour_put_back_before_the_rest)
{
	struct layout there = middle(2);
	rest(&there);
	play(&there, COLOUR_RED);
	take_off(&there, COLOUR_RED);
	rest(&there);
	ck_assert_int_eq(k.game.state.on, ON_COLOUR);
	play(&there, COLOUR_PINK);
	int pink = index_of(&there, COLOUR_PINK);
	for (int i = 1; i <= 5; i++) {
		there.ball[pink].pos = vec2_madd(table.pocket[4].centre, 0.04 * (6 - i), table.pocket[4].normal);
		frame(&there);
	}
	take_off(&there, COLOUR_PINK);
	for (int i = 0; i < 12; i++)
		frame(&there);
	put(&there, COLOUR_PINK, table.spot[COLOUR_PINK]);
	rest(&there);
	ck_assert(k.game.score[0] == 7 && k.game.state.on == ON_RED && k.game.wish_count == 0 && k.game.turn == 0);
}
END_TEST

/* The black on its spot is struck away at once, falls, and is back on its spot before the table rests. */
START_TEST(a_black_back_on_its_spot)
{
	struct layout there = middle(2);
	rest(&there);
	play(&there, COLOUR_RED);
	take_off(&there, COLOUR_RED);
	rest(&there);
	vec2 from = there.ball[there.cue].pos, to = vec2_add(table.spot[COLOUR_BLACK], (vec2){-0.06, 0.01});
	for (int i = 1; i <= 5; i++) {
		there.ball[there.cue].pos = vec2_madd(from, 0.2 * i, vec2_sub(to, from));
		frame(&there);
	}
	take_off(&there, COLOUR_BLACK);
	for (int i = 0; i < 12; i++)
		frame(&there);
	put(&there, COLOUR_BLACK, table.spot[COLOUR_BLACK]);
	rest(&there);
	ck_assert(k.game.score[0] == 8 && k.game.state.on == ON_RED && k.game.turn == 0);
}
END_TEST

/* A cue ball that is struck away from a pocket and not followed for a few frames has not fallen. */
START_TEST(a_fast_cue_ball_near_a_pocket_has_not_fallen)
{
	struct layout there = middle(2), gone;
	there.ball[there.cue].pos = vec2_madd(table.pocket[1].centre, 0.15, table.pocket[1].normal);
	rest(&there);
	gone = there;
	take_off(&gone, COLOUR_WHITE);
	frame(&gone);
	frame(&gone);
	for (int i = 0; i < 20; i++) {
		there.ball[there.cue].pos = vec2_add(table.baulk_d_centre, (vec2){-0.2 + 0.02 * i, 0.1});
		frame(&there);
	}
	rest(&there);
	ck_assert(!k.game.state.in_hand);
}
END_TEST

/* It falls as the last ball and a hand that no frame shows has put it into the D: no ball flies like that. */
START_TEST(a_cue_ball_put_back_between_two_frames)
{
	struct layout there = middle(2);
	rest(&there);
	play(&there, COLOUR_RED);
	for (int i = 0; i < 6; i++) {
		there.ball[there.cue].pos = vec2_madd(table.pocket[3].centre, 0.3 - 0.04 * i, table.pocket[3].normal);
		frame(&there);
	}
	there.ball[there.cue].pos = table.baulk_d_centre;
	rest(&there);
	ck_assert(k.game.state.in_hand && k.game.foul == 4);
}
END_TEST

/* The red that was met first falls without having been seen to move; then the pink is met. No foul. */
START_TEST(a_red_that_was_gone_before_it_was_seen_to_move)
{
	struct layout there = middle(2);
	rest(&there);
	play(&there, COLOUR_PINK);
	take_off(&there, COLOUR_RED);
	rest(&there);
	ck_assert(k.game.foul == 0 && k.game.score[0] == 1 && k.game.state.on == ON_COLOUR);
}
END_TEST

START_TEST(hands_are_no_shots)
{
	struct layout there = middle(2);
	rest(&there);
	/* Touched: some millimetres. */
	there.ball[there.cue].pos.x += 0.008;
	rest(&there);
	ck_assert(k.game.shots == 0 && k.game.turn == 0);
	/* An object ball carried off. */
	int red = index_of(&there, COLOUR_RED);
	there.ball[red].pos.y -= 0.1;
	rest(&there);
	ck_assert(k.game.shots == 0 && k.game.score[1] == 0);
	ck_assert(!rest(&there));
}
END_TEST

START_TEST(the_clearance_ends_the_frame)
{
	struct layout there = middle(0);
	rest(&there);
	ck_assert_int_eq(k.game.state.on, ON_CLEARANCE);
	int points = 0;
	for (enum ball_colour c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++) {
		ck_assert(!k.game.over);
		play(&there, c);
		take_off(&there, c);
		ck_assert(rest(&there));
		points += (int)c;
		ck_assert(k.game.score[0] == points && k.game.wish_count == 0 && k.game.turn == 0);
	}
	char demand[GAME_TEXT_SIZE];
	game_demand(&k.game, demand);
	ck_assert(k.game.over && points == 27);
	ck_assert_str_eq(demand, "FRAME OVER  27 : 0");
	/* Set up again: the next frame. */
	there = middle(3);
	ck_assert(rest(&there));
	ck_assert(!k.game.over && k.game.frame == 2 && k.game.score[0] == 0);
}
END_TEST

START_TEST(corrections_and_undo)
{
	char err[200];
	struct layout there = middle(2);
	rest(&there);
	play(&there, COLOUR_RED);
	take_off(&there, COLOUR_RED);
	rest(&there);
	ck_assert(keeper_correct(&k, "undo", err, sizeof err));
	ck_assert(k.game.state.on == ON_RED && k.game.score[0] == 0);
	ck_assert(keeper_correct(&k, "score 30 21", err, sizeof err) && keeper_correct(&k, "turn 2", err, sizeof err) &&
		  keeper_correct(&k, "on colour", err, sizeof err) && keeper_correct(&k, "hand on", err, sizeof err));
	ck_assert(k.game.score[0] == 30 && k.game.score[1] == 21 && k.game.turn == 1 && k.game.state.on == ON_COLOUR &&
		  k.game.state.in_hand);
	ck_assert(keeper_correct(&k, "foul 7", err, sizeof err) && k.game.score[0] == 37 && k.game.turn == 0);
	ck_assert(keeper_correct(&k, "again", err, sizeof err) && k.game.turn == 1);
	static const char *const wrong[] = {"",	      "score", "score 1", "score -1 0",	 "turn 3", "on blue", "foul 3",
					    "foul 8", "hand",  "hand up", "score 1 2 3", "x",	   "undo it"};
	for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
		struct game before = k.game;
		ck_assert_msg(!keeper_correct(&k, wrong[i], err, sizeof err), "%s", wrong[i]);
		ck_assert(memcmp(&before, &k.game, sizeof before) == 0 && err[0]);
	}
	for (int i = 0; i < 6; i++)
		ck_assert(keeper_correct(&k, "undo", err, sizeof err));
	ck_assert(k.game.score[0] == 0 && k.game.turn == 0 && k.game.state.on == ON_RED);
	ck_assert(!keeper_correct(&k, "undo", err, sizeof err));
}
END_TEST

START_TEST(a_game_survives_as_text)
{
	static char text[2000];
	char err[200];
	struct layout there = middle(2);
	rest(&there);
	ck_assert(keeper_correct(&k, "score 30 21", err, sizeof err) &&
		  keeper_correct(&k, "on colour", err, sizeof err));
	ck_assert(game_write(&k.game, text, sizeof text));
	struct game back;
	ck_assert(game_read(&back, text));
	ck_assert(back.score[0] == 30 && back.score[1] == 21 && back.state.on == ON_COLOUR &&
		  back.rest.count == there.count);
	/* A new keeper takes it up where the balls lie as they lay. */
	struct keeper old = k;
	k = (struct keeper){0};
	keeper_restore(&k, &back);
	rest(&there);
	ck_assert(k.game.score[0] == 30 && k.game.state.on == ON_COLOUR && k.game.frame == old.game.frame);
	ck_assert(!game_write(&k.game, text, 40));
	/* Whatever the file holds: a game or none. */
	struct random random = random_begin("game text");
	for (int i = 0; i < 3000; i++) {
		ck_assert(game_write(&old.game, text, sizeof text));
		size_t size = strlen(text);
		for (int n = 0; n < 3; n++)
			text[random_u64(&random) % size] = (char)(32 + random_u64(&random) % 95);
		if (game_read(&back, text))
			ck_assert(back.rest.count <= BALL_MAX && (back.turn == 0 || back.turn == 1) &&
				  back.state.on <= ON_CLEARANCE);
	}
}
END_TEST

/* Simulated shots, seen at 30 frames a second with a camera's noise: the rules applied to the simulation are the judge of what the game
 * makes of what was seen. */
enum { ENTRIES = 8192 };
static struct trace trace;
static struct trace_entry entries[ENTRIES];
static struct sim sim;

/* As it is seen at a time of the shot: white last in the layout or not there. */
static void see_shot(const struct layout *from, double t, struct random *random)
{
	struct ball ball[BALL_MAX];
	struct layout seen;
	for (int i = 0; i < from->count; i++) {
		ball[i] = trace_at(&trace, i, t);
		ball[i].pos =
			vec2_add(ball[i].pos, (vec2){random_in(random, -2e-4, 2e-4), random_in(random, -2e-4, 2e-4)});
	}
	seen = position(ball, from->count, from->track);
	frame(&seen);
}

/* What lies there at the end: balls that come back are put down by hand, the cue ball in the D. */
static struct layout after_shot(const struct rules_outcome *out, const struct layout *from)
{
	struct ball ball[BALL_MAX];
	int track[BALL_MAX];
	for (int i = 0; i < from->count; i++)
		ball[i] = out->ball[i], track[i] = from->track[i];
	for (int i = 0; i < from->count; i++)
		if (ball[i].colour == COLOUR_WHITE && ball[i].phase == BALL_POTTED)
			ball[i] = ball_at(COLOUR_WHITE, vec2_add(table.baulk_d_centre, (vec2){-0.1, 0.06}));
	return position(ball, from->count, track);
}

static int count_left(const struct layout *layout)
{
	return layout->count - (layout->cue >= 0);
}

/* Plays frames by chance; returns shots, counts wrong balls on, balls in hand, scores. */
static int play_by_chance(uint64_t seed, int shots, int wrong[3])
{
	struct model model;
	struct random random = {seed};
	ck_assert(model_from_name("thesis", &model));
	setup();
	struct layout there = middle(3);
	struct rules_state truth = rules_state_from_position(there.ball, there.count);
	int score[2] = {0}, turn = 0, played = 0;
	rest(&there);
	for (; played < shots && count_left(&there) > 0; played++) {
		struct shot shot = {.angle = random_in(&random, -3.14, 3.14), .speed = random_in(&random, 1, 5)};
		struct rules_outcome out;
		trace_init(&trace, entries, ENTRIES);
		sim_init(&sim, &table, &model, there.ball, there.count);
		sim_strike(&sim, there.cue, &shot);
		if (sim_run(&sim, &(struct sim_limits){60, ENTRIES - 1}, &trace) != SIM_AT_REST)
			continue;
		for (double t = 1.0 / 30; t < trace_end(&trace) + 0.3; t += 1.0 / 30)
			see_shot(&there, t, &random);
		rules_judge(&table, &truth, &trace, -1, &out);
		bool goes_on = out.foul == 0 && out.points > 0;
		turn = goes_on ? turn : 1 - turn;
		score[turn] += out.foul + out.points;
		truth = goes_on ? out.next : rules_opponent(&table, &out, there.count);
		there = after_shot(&out, &there);
		rest(&there);
		if (out.ends)
			break;
		wrong[0] += k.game.state.on != truth.on;
		wrong[1] += k.game.state.in_hand != truth.in_hand;
		wrong[2] += k.game.score[0] != score[0] || k.game.score[1] != score[1] || k.game.turn != turn;
		/* The next shot is judged from the truth, not from a former fault. */
		k.game.state = truth;
		k.game.turn = turn;
		memcpy(k.game.score, score, sizeof score);
	}
	return played;
}

START_TEST(what_was_seen_of_shots_gives_what_the_rules_say)
{
	struct random random = random_begin("game shots");
	int wrong[3] = {0}, shots = 0;
	for (int i = 0; i < 40; i++)
		shots += play_by_chance(random_u64(&random), 25, wrong);
	printf("game: %d shots, ball on wrong %d, ball in hand wrong %d, score or turn wrong %d\n", shots, wrong[0],
	       wrong[1], wrong[2]);
	fflush(stdout);
	ck_assert_int_gt(shots, 500);
	ck_assert_int_le(wrong[0] * 500, shots);
	ck_assert_int_eq(wrong[1], 0);
	ck_assert_int_le(wrong[2] * 100, shots);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("game");
	TCase *scenes = tcase_create("scenes");
	tcase_add_checked_fixture(scenes, setup, NULL);
	tcase_add_test(scenes, a_red_a_colour_a_red);
	tcase_add_test(scenes, a_miss_gives_the_turn_away);
	tcase_add_test(scenes, the_wrong_ball_first_is_a_foul_of_its_value);
	tcase_add_test(scenes, an_in_off_gives_the_ball_in_hand);
	tcase_add_test(scenes, a_colour_put_back_before_the_rest);
	tcase_add_test(scenes, a_black_back_on_its_spot);
	tcase_add_test(scenes, a_fast_cue_ball_near_a_pocket_has_not_fallen);
	tcase_add_test(scenes, a_cue_ball_put_back_between_two_frames);
	tcase_add_test(scenes, a_red_that_was_gone_before_it_was_seen_to_move);
	tcase_add_test(scenes, hands_are_no_shots);
	tcase_add_test(scenes, the_clearance_ends_the_frame);
	tcase_add_test(scenes, corrections_and_undo);
	tcase_add_test(scenes, a_game_survives_as_text);
	suite_add_tcase(suite, scenes);
	TCase *shots = tcase_create("shots");
	tcase_set_timeout(shots, 120);
	tcase_add_test(shots, what_was_seen_of_shots_gives_what_the_rules_say);
	suite_add_tcase(suite, shots);
	return suite;
}
