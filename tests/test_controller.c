#include "controller_rig.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/light/animation.h"
#include "app/planner/plan_message.h"
#include "app/planner/request_message.h"
#include "app/process/ball_message.h"
#include "app/process/bus.h"
#include "app/process/message_table.h"
#include "app/process/text.h"
#include "harness.h"
#include "vision/vision.h"

/* ---- the way of a proposal --------------------------------------------------------------------------------------- */

START_TEST(a_resting_table_is_asked_for_once)
{
	ctl_frames((int)(30 * ctl.config.infinity.still_time));
	ck_assert_int_eq(ctl.requests, 0);
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
	ck_assert_int_eq(ctl.c.fsm.state, FSM_PLANNING);
	ck_assert_int_gt(ctl.c.request.id, 0);
	ck_assert_int_eq(ctl.c.request.ball_count, 4);
	ck_assert(ctl.c.request.depth == ctl.config.planner.depth && ctl.c.request.rails == ctl.config.planner.rails &&
		  ctl.c.request.max_balls == ctl.config.planner.balls &&
		  ctl.c.request.speeds == ctl.config.planner.speeds &&
		  ctl.c.request.plans == ctl.config.planner.plans &&
		  ctl.c.request.budget_s == ctl.config.planner.budget);
	for (int i = 0; i < 4; i++)
		ck_assert(ctl.c.request.balls[i].x == ctl.state.balls[i].x &&
			  ctl.c.request.balls[i].y == ctl.state.balls[i].y &&
			  ctl.c.request.balls[i].colour == ctl.state.balls[i].colour);
	ck_assert_str_eq((const char *)ctl.c.request.balls[2].name, "RED1");
	struct plan_request r;
	char err[96];
	ck_assert_msg(plan_request_from_message(&r, &ctl.c.request, &ctl.config.table, err, sizeof err) == 0, "%s",
		      err);
}
END_TEST

/* One frame with vision's doubts before it: the table's, and ball i's. */
static void doubtful_frame(int8_t doubt, int i)
{
	billiard_vision_doubt_t message = {
		.utime = ctl.state.utime + FRAME_US, .doubt = doubt, .ball_count = ctl.state.ball_count};
	message.ball_doubt[i] = doubt & (DOUBT_PLACE | DOUBT_COLOUR | DOUBT_HIDDEN);
	controller_doubt(&ctl.c, &message);
	ctl_frame();
}

/* What vision doubts is not asked for; when it does not any more, it is, once. */
START_TEST(a_position_in_doubt_is_not_asked_for)
{
	static const int8_t wrong[] = {DOUBT_PLACE, DOUBT_HIDDEN, DOUBT_UNJUDGED};
	for (int k = 0; k < 3; k++) {
		ctl_setup();
		for (int i = 0; i < MANY; i++)
			doubtful_frame(wrong[k], 1);
		ck_assert_int_eq(ctl.requests, 0);
		for (int i = 0; i < MANY; i++)
			doubtful_frame(0, 1);
		ck_assert_int_eq(ctl.requests, 1);
	}
	/* A red that may be brown is a ball to be potted where any is; the cue ball must be sure. */
	ctl_setup();
	ctl.config.infinity.rules = false;
	for (int i = 0; i < MANY; i++)
		doubtful_frame(DOUBT_COLOUR, 0);
	ck_assert_int_eq(ctl.requests, 0);
	for (int i = 0; i < MANY; i++)
		doubtful_frame(DOUBT_COLOUR, 1);
	ck_assert_int_eq(ctl.requests, 1);
	ctl_setup();
	ctl.config.infinity.rules = true;
	for (int i = 0; i < MANY; i++)
		doubtful_frame(DOUBT_COLOUR, 1);
	ck_assert_int_eq(ctl.requests, 0);
	/* Doubts that got lost on the way are doubts; a vision that never told any has none. */
	ctl_setup();
	doubtful_frame(0, 0);
	for (int i = 0; i < MANY; i++)
		ctl_frame();
	ck_assert_int_eq(ctl.requests, 0);
	ctl_setup();
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
}
END_TEST

START_TEST(an_answer_is_drawn_and_stays)
{
	ctl_proposed();
	ck_assert(ctl_draws_well());
	ck_assert_int_eq(ctl.c.draw.plan_id, ctl.c.request.id);
	ck_assert_int_gt(ctl.c.draw.item_count, 0);
	ck_assert(ctl_moves_well() && ctl.c.animation.keyframe_count == 1 && ctl.c.animation.run);
	int64_t before = ctl.draws;
	ctl_frames(MANY);
	ck_assert(ctl.draws == before && ctl.requests == 1 && ctl.c.proposals == 1);
}
END_TEST

START_TEST(a_shot_takes_it_off_and_asks_anew)
{
	ctl_proposed();
	int64_t id = ctl.c.request.id;
	ctl_shot();
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOT);
	ck_assert(ctl.c.draw.plan_id == 0 && ctl.c.draw.item_count == 0 && ctl.c.animation.keyframe_count == 0);
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.c.fsm.state, FSM_PLANNING);
	ck_assert_int_gt(ctl.c.request.id, id);
	ck_assert_int_eq(ctl.cancels, 0);
}
END_TEST

START_TEST(motion_while_planning_cancels)
{
	ctl_frames(MANY);
	int64_t id = ctl.c.request.id;
	ctl_shot();
	ck_assert_int_eq(ctl.cancels, 1);
	ck_assert(ctl_take(ctl_answer(PLAN_MESSAGE_OK, 0.5)));
	ck_assert(ctl.c.fsm.state == FSM_WATCHING && ctl.c.draw.plan_id == 0 && ctl.c.proposals == 0);
	ctl_frames(MANY);
	ck_assert_int_gt(ctl.c.request.id, id);
}
END_TEST

START_TEST(improved_answers_replace_repeated_ones_do_not)
{
	ctl_proposed();
	billiard_plan_t *plan = ctl_answer(PLAN_MESSAGE_OK, 0.9);
	plan->sequence = 3;
	plan->entries[0].cost = -1;
	ck_assert(ctl_take(plan));
	ck_assert_double_eq(ctl.c.plan.entries[0].shots[0].angle, 0.9);
	plan = ctl_answer(PLAN_MESSAGE_OK, 0.2);
	plan->sequence = 2; /* late, however good it was */
	plan->entries[0].cost = -9;
	ck_assert(ctl_take(plan));
	ck_assert_double_eq(ctl.c.plan.entries[0].shots[0].angle, 0.9);
	ck_assert_int_eq(ctl.c.proposals, 1);
}
END_TEST

/* What is drawn first stays: only what is better by the margin takes its place. */
START_TEST(a_proposal_changes_only_for_a_better_one)
{
	ctl_frames(MANY);
	billiard_plan_t *plan = ctl_answer(PLAN_MESSAGE_OK, 0.5);
	plan->entries[0].cost = 2;
	ck_assert(ctl_take(plan));
	int64_t before = ctl.draws;
	ctl_flush();
	plan = ctl_answer(PLAN_MESSAGE_OK, 0.9);
	plan->sequence = 1;
	plan->entries[0].cost = 2 - 0.9 * ctl.config.infinity.better_margin * 2;
	ck_assert(ctl_take(plan));
	ctl_flush();
	ck_assert_int_eq(ctl.draws, before + 1);
	ck_assert_double_eq(ctl.c.plan.entries[0].shots[0].angle, 0.5);
	plan = ctl_answer(PLAN_MESSAGE_OK, 0.9);
	plan->sequence = 2;
	plan->entries[0].cost = 2 - 1.1 * ctl.config.infinity.better_margin * 2;
	ck_assert(ctl_take(plan));
	ck_assert_double_eq(ctl.c.plan.entries[0].shots[0].angle, 0.9);
	/* Who looks at another one is not interrupted. */
	ctl_command("next", "");
	plan = ctl_answer(PLAN_MESSAGE_OK, 0.1);
	plan->sequence = 3;
	plan->entries[0].cost = -100;
	ck_assert(ctl_take(plan));
	ck_assert_double_eq(ctl.c.plan.entries[0].shots[0].angle, 0.9);
}
END_TEST

/* One that is not final is shown when it has stayed the same for a tenth of a second. */
START_TEST(a_proposal_is_shown_when_it_has_settled)
{
	ctl_frames(MANY);
	for (int i = 0; i < 20; i++) {
		billiard_plan_t *plan = ctl_answer(PLAN_MESSAGE_OK, 0.1 * i);
		plan->is_final = 0;
		plan->sequence = i;
		ck_assert(ctl_take(plan));
		ctl_frames(2);
		ck_assert_int_eq(ctl.c.fsm.state, FSM_PLANNING);
	}
	ctl_frames(2);
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOWING);
	ck_assert_double_eq(ctl.c.plan.entries[0].shots[0].angle, 0.1 * 19);
	/* The last one says the same: nothing is drawn anew but what it adds. */
	billiard_plan_t *plan = ctl_answer(PLAN_MESSAGE_OK, 0.1 * 19);
	plan->sequence = 20;
	ck_assert(ctl_take(plan));
	ck_assert(ctl.c.plan.is_final && ctl.c.proposals == 1);
}
END_TEST

/* What an answer adds to a proposal (a better estimate, the shots after it) does not make it wait. */
START_TEST(answers_that_keep_the_proposal_do_not_put_it_off)
{
	ctl_frames(MANY);
	int frames = (int)(1e6 * ctl.config.infinity.show_time / FRAME_US) + 2;
	for (int i = 0; i < frames; i++) {
		billiard_plan_t *plan = ctl_answer(PLAN_MESSAGE_OK, 0.5);
		plan->is_final = 0;
		plan->sequence = i;
		ck_assert(ctl_take(plan));
		ctl_frames(1);
	}
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOWING);
	ck_assert_int_eq(ctl.c.proposals, 1);
}
END_TEST

START_TEST(no_plan_is_said_on_the_table)
{
	ctl_frames(MANY);
	billiard_plan_t *plan = ctl_answer(PLAN_MESSAGE_NONE, 0);
	text_set(plan->reason, sizeof plan->reason, "no shot found");
	ck_assert(ctl_take(plan));
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOWING);
	ck_assert_str_eq(ctl.c.drawn_note, "no shot found");
	ck_assert(ctl_command("halo", ""));
	ck_assert_str_eq(ctl.c.drawn_note, "no shot found");
	ctl_command("next", "");
	ctl_command("previous", "");
	ck_assert_int_eq(ctl.c.draw.plan_id, 0);
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
}
END_TEST

/* ---- commands ---------------------------------------------------------------------------------------------------- */

START_TEST(pause_and_resume)
{
	ctl_proposed();
	ck_assert(ctl_command("pause", ""));
	ck_assert(ctl.c.fsm.state == FSM_PAUSED && ctl.c.draw.plan_id == 0);
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
	ck_assert(ctl_command("resume", ""));
	ctl_frames(MANY);
	ck_assert(ctl.c.fsm.state == FSM_PLANNING && ctl.requests == 2);
	ck_assert(ctl_command("infinity", ""));
	ck_assert(ctl.c.fsm.state == FSM_PAUSED && ctl.cancels == 1);
}
END_TEST

START_TEST(next_and_previous_go_round)
{
	ctl_proposed();
	ck_assert_int_eq(ctl.c.animation.keyframe_count, 1);
	double first = ctl.c.animation.keyframes[0].vx;
	ctl_command("next", "");
	ck_assert_int_eq(ctl.c.entry, 1);
	ck_assert_double_ne(ctl.c.animation.keyframes[0].vx, first);
	ctl_command("next", "");
	ck_assert_int_eq(ctl.c.entry, 0);
	ctl_command("previous", "");
	ck_assert_int_eq(ctl.c.entry, 1);
}
END_TEST

START_TEST(the_animation_stops_seeks_and_restarts)
{
	ctl_proposed();
	ctl.now += 0.5;
	ctl_command("animation-stop", "");
	ck_assert_int_eq(ctl.c.animation.run, 0);
	ck_assert_double_eq_tol(ctl.c.animation.position, 0.5 * ctl.config.infinity.animation_rate, 1e-9);
	ctl_command("animation-seek", "1");
	ck_assert_double_eq_tol(ctl.c.animation.position, 1.5, 1e-9);
	ctl_command("animation-seek", "1000000");
	ck_assert_double_eq(ctl.c.animation.position, 2);
	ctl_command("animation-seek", "-99");
	ck_assert_double_eq(ctl.c.animation.position, 0);
	ck_assert(!ctl_command("animation-seek", "nan") && !ctl_command("animation-seek", "") &&
		  !ctl_command("animation-nonsense", ""));
	ctl_command("animation-stop", "");
	ctl.now += 0.25;
	ctl_command("animation-seek", "0.5");
	ck_assert_double_eq_tol(ctl.c.animation.position, 0.75, 1e-9);
	ck_assert(ctl_moves_well());
	ctl_command("animation-restart", "");
	ck_assert(ctl.c.animation.position == 0 && ctl.c.animation.run);
	ctl_command("animation", "");
	ck_assert_int_eq(ctl.c.animation.keyframe_count, 0);
	ctl_command("animation", "");
	ck_assert_int_eq(ctl.c.animation.keyframe_count, 1);
}
END_TEST

START_TEST(commands_for_others_are_left_to_them)
{
	ctl_proposed();
	billiard_command_t m = {.utime = 1};
	text_set(m.name, sizeof m.name, "pause");
	text_set(m.target, sizeof m.target, "billiard-vision");
	ck_assert(controller_command(&ctl.c, &m, ctl.now));
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOWING);
	ck_assert(ctl_command("snapshot", "x.png") && ctl_command("", "") && ctl_command("cancel", "5"));
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOWING);
}
END_TEST

/* ---- everything at once ------------------------------------------------------------------------------------------ */

static uint64_t hash(uint64_t h, const void *data, size_t size)
{
	const uint8_t *p = data;
	for (size_t i = 0; i < size; i++)
		h = (h ^ p[i]) * 0x100000001b3u;
	return h;
}

/* A long run with losses, repetitions, spoiled numbers, hands and commands. Never a crash, nothing invalid goes out,
 * and the same run gives the same messages. */
static uint64_t storm(uint64_t seed, bool rules)
{
	static const char *const commands[] = {
		"pause",    "resume",	 "next",	   "previous",		"halo",	  "paths", "table", "info",
		"infinity", "animation", "animation-stop", "animation-restart", "cancel", "x",	   "game"};
	struct random random = {seed};
	uint64_t h = 1469598103934665603u;
	ctl_setup();
	ctl.config.infinity.rules = rules;
	for (int i = 0; i < 4000; i++) {
		unsigned what = (unsigned)(random_u64(&random) % 40);
		if (what == 0)
			ctl_command(commands[random_u64(&random) % (sizeof commands / sizeof commands[0])],
				    rules ? "undo" : "0.5");
		else if (what == 1)
			ctl_shot();
		else if (what == 2)
			ctl_take(ctl_answer((int8_t)(random_u64(&random) % 6), random_in(&random, -4, 4)));
		else if (what == 3)
			ctl.state.occluded = !ctl.state.occluded;
		else if (what == 4)
			ctl.state.calibration = (int8_t)(random_u64(&random) % 3);
		else if (what == 5)
			((uint8_t *)&ctl.state.balls)[random_u64(&random) % sizeof ctl.state.balls[0]] ^=
				(uint8_t)random_u64(&random);
		else if (what == 6)
			ctl_place(0, COLOUR_WHITE, random_in(&random, -0.9, 0.9), random_in(&random, -0.4, 0.4));
		ctl_frame();
		ck_assert(ctl_draws_well());
		ck_assert(ctl_moves_well());
		h = hash(h, &ctl.c.draw, sizeof ctl.c.draw);
		h = hash(h, &ctl.c.animation, sizeof ctl.c.animation);
		h = hash(h, &ctl.c.request, sizeof ctl.c.request);
	}
	return h;
}

START_TEST(storms_are_survived_and_repeatable)
{
	struct random random = random_begin("controller storm");
	for (int i = 0; i < 3; i++) {
		uint64_t seed = random_u64(&random);
		ck_assert_uint_eq(storm(seed, false), storm(seed, false));
		/* Afterwards a calm table gets its proposal. */
		billiard_table_state_t spoiled = ctl.state;
		struct controller *survivor = malloc(sizeof *survivor);
		ck_assert_ptr_nonnull(survivor);
		*survivor = ctl.c;
		double then = ctl.now;
		ctl_setup();
		ctl.c = *survivor;
		free(survivor);
		ctl.state.utime = spoiled.utime;
		ctl.now = then;
		ctl_command("resume", "");
		ctl_shot();
		ctl_frames(MANY);
		ck_assert_int_eq(ctl.c.fsm.state, FSM_PLANNING);
	}
}
END_TEST

/* The same with the game kept: whatever is seen, scores stay numbers and wishes balls. */
START_TEST(storms_by_the_rules_are_survived_and_repeatable)
{
	struct random random = random_begin("controller storm by the rules");
	for (int i = 0; i < 4; i++) {
		uint64_t seed = random_u64(&random);
		ck_assert_uint_eq(storm(seed, true), storm(seed, true));
		const struct game *game = &ctl.c.keeper.game;
		ck_assert(game->score[0] >= 0 && game->score[1] >= 0 && game->wish_count >= 0 &&
			  game->wish_count <= GAME_WISHES && (game->turn == 0 || game->turn == 1));
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("controller");
	TCase *way = tcase_create("proposals");
	tcase_add_checked_fixture(way, ctl_setup, NULL);
	tcase_add_test(way, a_resting_table_is_asked_for_once);
	tcase_add_test(way, a_position_in_doubt_is_not_asked_for);
	tcase_add_test(way, an_answer_is_drawn_and_stays);
	tcase_add_test(way, a_shot_takes_it_off_and_asks_anew);
	tcase_add_test(way, motion_while_planning_cancels);
	tcase_add_test(way, improved_answers_replace_repeated_ones_do_not);
	tcase_add_test(way, a_proposal_changes_only_for_a_better_one);
	tcase_add_test(way, a_proposal_is_shown_when_it_has_settled);
	tcase_add_test(way, answers_that_keep_the_proposal_do_not_put_it_off);
	tcase_add_test(way, no_plan_is_said_on_the_table);
	suite_add_tcase(suite, way);
	TCase *commands = tcase_create("commands");
	tcase_add_checked_fixture(commands, ctl_setup, NULL);
	tcase_add_test(commands, pause_and_resume);
	tcase_add_test(commands, next_and_previous_go_round);
	tcase_add_test(commands, the_animation_stops_seeks_and_restarts);
	tcase_add_test(commands, commands_for_others_are_left_to_them);
	suite_add_tcase(suite, commands);
	TCase *storms = tcase_create("storms");
	tcase_add_checked_fixture(storms, ctl_setup, NULL);
	tcase_set_timeout(storms, 60);
	tcase_add_test(storms, storms_are_survived_and_repeatable);
	tcase_add_test(storms, storms_by_the_rules_are_survived_and_repeatable);
	suite_add_tcase(suite, storms);
	return suite;
}
