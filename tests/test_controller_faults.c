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

/* ---- lost, doubled, late, malformed ------------------------------------------------------------------------------ */

START_TEST(a_lost_request_or_answer_is_repeated)
{
	ctl_frames(MANY);
	int64_t id = ctl.c.request.id;
	/* Half a second after the first, and again: always the same one. */
	ck_assert(ctl.sent >= 3 && ctl.requests == 1);
	int64_t before = ctl.sent;
	while (ctl.sent == before)
		ctl_frames(1);
	double last = ctl.now;
	while (ctl.sent == before + 1)
		ctl_frames(1);
	ck_assert_double_le(ctl.now - last, 0.5 + 2e-6 * FRAME_US);
	ck_assert(ctl.requests == 1 && ctl.c.request.id == id);
	ck_assert(ctl_take(ctl_answer(PLAN_MESSAGE_OK, 0.5)));
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOWING);
}
END_TEST

START_TEST(a_request_that_somebody_else_cancelled_gets_a_new_id)
{
	ctl_frames(MANY);
	int64_t id = ctl.c.request.id;
	ck_assert(ctl_take(ctl_answer(PLAN_MESSAGE_CANCELLED, 0)));
	ck_assert_int_eq(ctl.c.fsm.state, FSM_PLANNING);
	ctl_frames((int)(ctl.config.infinity.plan_timeout * 30) + 5);
	ck_assert(ctl.c.request.id > id);
}
END_TEST

/* The camera saw the shot begin and nothing after it. */
START_TEST(a_shot_without_an_end_is_given_up)
{
	ctl_proposed();
	ctl_shot();
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOT);
	/* Something stands over the table. */
	ctl.state.occluded = 1;
	ctl_frames(MANY + 3);
	ck_assert_int_eq(ctl.c.fsm.state, FSM_WATCHING);
	ctl.state.occluded = 0;
	ctl_frames(MANY);
	ck_assert(ctl.c.fsm.state == FSM_PLANNING && ctl.requests == 2);
}
END_TEST

/* The refusal of a later improvement, or a repeated final answer, does not take the proposal off. */
START_TEST(no_plan_after_a_plan_changes_nothing)
{
	ctl_proposed();
	int64_t before = ctl.draws;
	ck_assert(ctl_take(ctl_answer(PLAN_MESSAGE_NONE, 0)));
	ck_assert(ctl_take(ctl_answer(PLAN_MESSAGE_REFUSED, 0)));
	ck_assert(ctl.c.fsm.state == FSM_SHOWING && ctl.c.draw.plan_id == ctl.c.request.id && ctl.draws == before);
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
}
END_TEST

/* Nor while the plan waits to be shown. */
START_TEST(no_plan_after_an_interim_plan_leaves_it)
{
	ctl_frames(MANY);
	billiard_plan_t *plan = ctl_answer(PLAN_MESSAGE_OK, 0.5);
	plan->is_final = 0;
	ck_assert(ctl_take(plan));
	ctl_take(ctl_answer(PLAN_MESSAGE_NONE, 0));
	ck_assert_int_eq(ctl.c.fsm.state, FSM_PLANNING);
	ctl_frames(10);
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOWING);
	ck_assert(ctl.c.has_plan && !ctl.c.has_none);
}
END_TEST

/* Only a final "none" is one: better answers may still come. */
START_TEST(an_interim_no_plan_waits_for_the_final_one)
{
	ctl_frames(MANY);
	billiard_plan_t *plan = ctl_answer(PLAN_MESSAGE_NONE, 0);
	plan->is_final = 0;
	ck_assert(ctl_take(plan));
	ck_assert_int_eq(ctl.c.fsm.state, FSM_PLANNING);
	ck_assert(ctl_take(ctl_answer(PLAN_MESSAGE_OK, 0.5)));
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOWING);
}
END_TEST

START_TEST(late_and_foreign_answers_are_ignored)
{
	ck_assert(!ctl_take(ctl_answer(PLAN_MESSAGE_OK, 0.5))); /* nothing was asked: id 0 */
	ctl_frames(MANY);
	billiard_plan_t *plan = ctl_answer(PLAN_MESSAGE_OK, 0.5);
	plan->request_id--;
	ck_assert(!ctl_take(plan));
	plan = ctl_answer(PLAN_MESSAGE_OK, NAN);
	ck_assert(!ctl_take(plan));
	ck_assert(ctl.c.fsm.state == FSM_PLANNING && !ctl.c.has_plan && ctl.c.proposals == 0);
}
END_TEST

START_TEST(doubled_and_late_frames_are_ignored)
{
	ctl_frames(MANY);
	struct controller *before = malloc(sizeof *before);
	ck_assert_ptr_nonnull(before);
	*before = ctl.c;
	ck_assert(!ctl_see(&ctl.state));
	ctl.state.utime -= 10 * FRAME_US;
	ck_assert(!ctl_see(&ctl.state));
	ck_assert_int_eq(memcmp(&ctl.c, before, sizeof ctl.c), 0);
	free(before);
}
END_TEST

START_TEST(malformed_frames_change_nothing)
{
	ctl_frames(MANY);
	struct controller *before = malloc(sizeof *before);
	billiard_table_state_t good = ctl.state;
	ck_assert_ptr_nonnull(before);
	*before = ctl.c;
#define BAD(field, value)                                                                                              \
	(ctl.state = good, ctl.state.utime += FRAME_US, ctl.state.field = (value),                                     \
	 ck_assert_msg(!ctl_see(&ctl.state), #field " = " #value))
	BAD(ball_count, -1);
	BAD(ball_count, 23);
	BAD(ball_count, INT32_MAX);
	BAD(ball_count, INT32_MIN);
	BAD(balls[1].x, NAN);
	BAD(balls[1].y, INFINITY);
	BAD(balls[1].x, 1e300);
	BAD(balls[1].colour, 9);
	BAD(balls[1].colour, -1);
	BAD(balls[1].phase, 77);
	BAD(utime, -1);
	BAD(utime, INT64_MIN);
	BAD(utime, INT64_MAX);
	ck_assert_int_eq(memcmp(&ctl.c, before, sizeof ctl.c), 0);
	free(before);
}
END_TEST

START_TEST(a_clock_that_was_set_back_does_not_stop_it)
{
	ctl_proposed();
	int64_t id = ctl.c.request.id;
	ctl.state.utime = 5; /* or another recording */
	ctl_frames(3);
	ctl_shot();
	ctl_frames(MANY);
	ck_assert(ctl.c.fsm.state == FSM_PLANNING && ctl.c.request.id > id);
}
END_TEST

START_TEST(lost_calibration_clears_and_says_why)
{
	ctl_proposed();
	ctl.state.calibration = 0;
	ctl.state.ball_count = 0;
	text_set(ctl.state.reason, sizeof ctl.state.reason, "2 of 4 markers");
	ctl_frames(10);
	ck_assert_int_eq(ctl.c.fsm.state, FSM_BLIND);
	ck_assert_str_eq(ctl.c.drawn_note, "not calibrated: 2 of 4 markers");
	ck_assert(ctl.c.draw.plan_id == 0 && ctl_draws_well());
	text_set(ctl.state.reason, sizeof ctl.state.reason, "no markers");
	ctl_frames(1);
	ck_assert_str_eq(ctl.c.drawn_note, "not calibrated: no markers");
	int64_t before = ctl.draws;
	ctl_frames(10);
	ck_assert_int_eq(ctl.draws, before);
	ctl_setup();
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.c.fsm.state, FSM_PLANNING);
}
END_TEST

START_TEST(a_hand_that_passes_changes_nothing)
{
	ctl_proposed();
	int64_t before = ctl.draws;
	ctl.state.occluded = 1;
	ctl_frames(MANY);
	ctl.state.occluded = 0;
	ctl_frames(MANY);
	ck_assert(ctl.c.fsm.state == FSM_SHOWING && ctl.draws == before && ctl.requests == 1);
}
END_TEST

START_TEST(a_ball_taken_away_asks_anew)
{
	ctl_proposed();
	ctl.state.ball_count = 3;
	ctl_frames(MANY);
	ck_assert(ctl.c.fsm.state == FSM_PLANNING && ctl.requests == 2 && ctl.c.request.ball_count == 3);
}
END_TEST

START_TEST(a_false_white_is_left_out)
{
	ctl_frames(3);
	ctl_place(4, COLOUR_WHITE, 0.7, 0.3);
	ctl.state.ball_count = 5;
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.c.request.ball_count, 4);
	ck_assert_double_eq(ctl.c.request.balls[0].x, -0.3);
}
END_TEST

/* The cue ball is the same one wherever it stands in the list. */
START_TEST(a_false_white_before_the_cue_ball_is_left_out)
{
	ctl_frames(3);
	for (int i = 4; i > 0; i--)
		ctl.state.balls[i] = ctl.state.balls[i - 1];
	ctl_place(0, COLOUR_WHITE, 0.7, 0.3);
	ctl.state.balls[0].track = 9;
	ctl.state.ball_count = 5;
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.c.request.ball_count, 4);
	ck_assert_int_eq(ctl.c.asked.ball[ctl.c.asked.cue].colour, COLOUR_WHITE);
	ck_assert_double_eq(ctl.c.asked.ball[ctl.c.asked.cue].pos.x, -0.3);
}
END_TEST

/* It can only be played as one. */
START_TEST(a_ball_of_unknown_colour_is_asked_for_as_a_red)
{
	ctl_place(2, COLOUR_UNKNOWN, 0.5, -0.2);
	ctl_frames(MANY);
	ck_assert(ctl.c.request.ball_count == 4 && ctl.c.request.balls[2].colour == COLOUR_RED);
	ck_assert_str_eq((const char *)ctl.c.request.balls[2].name, "RED1");
}
END_TEST

/* After a red that fell a colour is on, by the rules. */
START_TEST(a_red_that_fell_makes_a_colour_the_ball_on)
{
	ctl.config.infinity.rules = true;
	ctl_proposed();
	ck_assert(ctl.c.request.target_kind == TARGET_RULES && ctl.c.request.on == ON_RED);
	ctl.state.balls[1] = ctl.state.balls[3];
	ctl.state.ball_count = 3;
	ctl_shot();
	ctl_frames(MANY);
	ck_assert(ctl.c.request.ball_count == 3 && ctl.c.request.on == ON_COLOUR);
}
END_TEST

START_TEST(overlaps_of_a_camera_are_settled_in_the_request)
{
	ctl_place(1, COLOUR_RED, 0.3, 0.2);
	ctl_place(2, COLOUR_RED, 0.3 + 0.0523 - 0.001, 0.2);
	ctl_frames(MANY);
	struct plan_request r;
	char err[96];
	ck_assert_msg(plan_request_from_message(&r, &ctl.c.request, &ctl.config.table, err, sizeof err) == 0, "%s",
		      err);
	/* Nothing moved on the table: no new request. */
	ck_assert(ctl_take(ctl_answer(PLAN_MESSAGE_OK, 0.5)));
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
}
END_TEST

/* ---- what cannot be, what is silent --------------------------------------------------------------------------------- */

/* One ball in two tracks, 13 mm apart: nothing is asked, the table says it, and goes on when one of them is gone. */
START_TEST(one_ball_seen_twice_is_not_asked_for)
{
	ctl_place(4, COLOUR_RED, 0.313, 0.2);
	ctl.state.ball_count = 5;
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 0);
	ck_assert_int_eq(ctl.c.report.verdict, STABILITY_UNSURE);
	ctl_frames(MANY);
	ck_assert_str_eq(ctl.c.drawn_note, "RED at (300, 200): cannot lie there");
	ctl.state.ball_count = 4;
	ctl_frames(MANY);
	ck_assert(ctl.requests == 1 && ctl.c.request.ball_count == 4);
}
END_TEST

/* By the rules a colour is there once. */
START_TEST(a_colour_seen_twice_is_not_asked_for_by_the_rules)
{
	ctl.config.infinity.rules = true;
	ctl_place(2, COLOUR_BLACK, 0.5, -0.2);
	ctl_frames(2 * MANY);
	ck_assert_int_eq(ctl.requests, 0);
	ck_assert_ptr_nonnull(strstr(ctl.c.drawn_note, "BLACK"));
	ctl.config.infinity.rules = false;
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
}
END_TEST

/* What is asked for is what lies there, in a pocket's jaws, too. */
START_TEST(a_ball_in_the_jaws_is_asked_for_where_it_hangs)
{
	ctl_place(3, COLOUR_BLUE, -0.9299, -0.3964);
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
	ck_assert_double_eq_tol(ctl.c.request.balls[3].x, -0.9299, 5e-4);
	ck_assert_double_eq_tol(ctl.c.request.balls[3].y, -0.3964, 5e-4);
	struct plan_request r;
	char err[96];
	ck_assert_msg(plan_request_from_message(&r, &ctl.c.request, &ctl.config.table, err, sizeof err) == 0, "%s",
		      err);
}
END_TEST

START_TEST(a_nudge_of_more_than_half_a_millimetre_asks_anew)
{
	ctl_proposed();
	ctl.state.balls[1].x += 0.0004;
	ctl_frames(MANY);
	ck_assert(ctl.requests == 1 && ctl.c.fsm.state == FSM_SHOWING);
	ctl.state.balls[1].x += 0.0003;
	ctl_frames(MANY);
	ck_assert(ctl.requests == 2 && ctl.c.request.balls[1].x == ctl.state.balls[1].x);
}
END_TEST

/* A ball carried 300 mm by hand, slowly: light for where it was is gone at once, and what comes is for where it is. */
START_TEST(a_ball_carried_300_mm)
{
	ctl_proposed();
	for (int i = 0; i < 90; i++) {
		ctl.state.occluded = 1;
		ctl.state.balls[2].x -= 0.3 / 90;
		ctl_frames(1);
		if (i > 3)
			ck_assert_int_eq(ctl.c.draw.plan_id, 0);
	}
	ctl.state.occluded = 0;
	ctl_frames(MANY);
	ck_assert(ctl.requests == 2 && ctl.c.request.balls[2].x == ctl.state.balls[2].x);
}
END_TEST

/* A drift of 2 mm/s: no proposal while it goes on. */
START_TEST(a_drift_of_2_mm_s_takes_the_proposal_off)
{
	ctl_proposed();
	for (int i = 0; i < 150; i++) {
		ctl.state.balls[2].y += 0.002 / 30;
		ctl_frames(1);
		if (i > 15)
			ck_assert_int_eq(ctl.c.draw.plan_id, 0);
	}
	ck_assert_int_eq(ctl.requests, 1);
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 2);
}
END_TEST

/* An arm over the table for a minute, no proposal yet: after two seconds the table says what it waits for. */
START_TEST(an_arm_for_a_minute_is_told)
{
	ctl.state.occluded = 1;
	for (int i = 0; i < 60 * 30; i++) {
		ctl_frames(1);
		if (i > 75)
			ck_assert_str_eq(ctl.c.drawn_note, "something is over the table");
	}
	ck_assert_int_eq(ctl.requests, 0);
	ck_assert_int_eq(ctl.c.report.verdict, STABILITY_UNSURE);
	ck_assert_str_eq((const char *)ctl.c.report.word, "something is over the table");
	ck_assert(!ctl.c.report.conditions[STABILITY_CLEAR].holds && ctl.c.report.conditions[STABILITY_STILL].holds);
	ctl.state.occluded = 0;
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
}
END_TEST

/* Lights off and on: the same balls lie there, the same proposal comes back, nothing is asked. */
START_TEST(lights_off_and_on)
{
	ctl_proposed();
	int64_t id = ctl.c.request.id;
	ctl.state.calibration = 0;
	ctl_frames(MANY);
	ck_assert(ctl.c.fsm.state == FSM_BLIND && ctl.c.draw.plan_id == 0);
	ctl.state.calibration = 1;
	ctl_frames(MANY);
	ck_assert(ctl.c.fsm.state == FSM_SHOWING && ctl.c.draw.plan_id == id && ctl.requests == 1);
}
END_TEST

/* A ball that blinks: seen in nine of ten frames only. */
START_TEST(a_blinking_ball_is_told)
{
	for (int i = 0; i < 150; i++) {
		ctl.state.ball_count = i % 10 ? 4 : 3;
		ctl_frames(1);
	}
	ck_assert_int_eq(ctl.requests, 0);
	ck_assert_str_eq(ctl.c.drawn_note, "a ball comes and goes");
	ctl_frames(MANY);
	ck_assert_int_eq(ctl.requests, 1);
}
END_TEST

/* Two false white balls beside the cue ball: they are left out. Without it, nobody guesses which is the cue ball. */
START_TEST(two_false_whites)
{
	ctl_frames(3);
	ctl_place(4, COLOUR_WHITE, 0.7, 0.3);
	ctl_place(5, COLOUR_WHITE, 0.7, -0.3);
	ctl.state.ball_count = 6;
	ctl_frames(MANY);
	ck_assert(ctl.requests == 1 && ctl.c.request.ball_count == 4 && ctl.c.request.balls[0].x == -0.3);
	ctl_shot();
	ctl.state.balls[0] = ctl.state.balls[5];
	ctl.state.ball_count = 5;
	ctl_frames(2 * MANY);
	ck_assert_int_eq(ctl.requests, 1);
	ck_assert_str_eq(ctl.c.drawn_note, "which white ball is the cue ball?");
}
END_TEST

/* Vision is silent: told within a second, in every state; with the frames the proposal comes back. */
START_TEST(silence_of_vision_is_told_within_a_second)
{
	ctl_proposed();
	int64_t id = ctl.c.request.id;
	double last = ctl.now;
	while (ctl.c.draw.plan_id) {
		ctl.now += 0.05;
		controller_tick(&ctl.c, ctl.now);
		ctl_flush();
		ck_assert_double_le(ctl.now - last, 1);
	}
	ck_assert_str_eq(ctl.c.drawn_note, "no pictures: billiard-vision is silent");
	ck_assert_int_eq(ctl.c.fsm.state, FSM_BLIND);
	int64_t before = ctl.draws;
	for (int i = 0; i < 100; i++)
		controller_tick(&ctl.c, ctl.now += 0.05);
	ctl_flush();
	ck_assert_int_eq(ctl.draws, before);
	ctl_frames(MANY);
	ck_assert(ctl.c.fsm.state == FSM_SHOWING && ctl.c.draw.plan_id == id && ctl.requests == 1);
}
END_TEST

START_TEST(silence_of_the_planner_is_told_within_a_second)
{
	while (ctl.requests == 0)
		ctl_frames(1);
	ctl_frames(31);
	ck_assert_str_eq(ctl.c.drawn_note, "no answer from the planner yet");
	ck_assert(ctl.c.fsm.state == FSM_PLANNING && ctl.sent == 2);
	ck_assert(ctl_take(ctl_answer(PLAN_MESSAGE_OK, 0.5)));
	ck_assert(ctl.c.fsm.state == FSM_SHOWING && ctl.c.draw.plan_id == ctl.c.request.id);
}
END_TEST

/* Rings stand around balls that rest; when one moves they go, whatever the controller does just then. */
START_TEST(rings_go_when_a_ball_moves_while_planning)
{
	ctl_proposed();
	ctl.state.balls[1].y += 0.01;
	while (ctl.c.fsm.state != FSM_PLANNING)
		ctl_frame();
	ctl_frames(MANY); /* no answer: rings and a note */
	ck_assert_int_gt(ctl.c.draw.item_count, 0);
	ctl_shot();
	ck_assert(ctl.c.draw.item_count == 0 && ctl.c.fsm.state == FSM_WATCHING);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("controller_faults");
	TCase *faults = tcase_create("faults");
	tcase_add_checked_fixture(faults, ctl_setup, NULL);
	tcase_set_timeout(faults, 60);
	tcase_add_test(faults, a_lost_request_or_answer_is_repeated);
	tcase_add_test(faults, a_request_that_somebody_else_cancelled_gets_a_new_id);
	tcase_add_test(faults, a_shot_without_an_end_is_given_up);
	tcase_add_test(faults, no_plan_after_a_plan_changes_nothing);
	tcase_add_test(faults, no_plan_after_an_interim_plan_leaves_it);
	tcase_add_test(faults, an_interim_no_plan_waits_for_the_final_one);
	tcase_add_test(faults, late_and_foreign_answers_are_ignored);
	tcase_add_test(faults, doubled_and_late_frames_are_ignored);
	tcase_add_test(faults, malformed_frames_change_nothing);
	tcase_add_test(faults, a_clock_that_was_set_back_does_not_stop_it);
	tcase_add_test(faults, lost_calibration_clears_and_says_why);
	tcase_add_test(faults, a_hand_that_passes_changes_nothing);
	tcase_add_test(faults, a_ball_taken_away_asks_anew);
	tcase_add_test(faults, a_false_white_is_left_out);
	tcase_add_test(faults, a_false_white_before_the_cue_ball_is_left_out);
	tcase_add_test(faults, a_ball_of_unknown_colour_is_asked_for_as_a_red);
	tcase_add_test(faults, a_red_that_fell_makes_a_colour_the_ball_on);
	tcase_add_test(faults, overlaps_of_a_camera_are_settled_in_the_request);
	suite_add_tcase(suite, faults);
	TCase *doubt = tcase_create("doubt and silence");
	tcase_add_checked_fixture(doubt, ctl_setup, NULL);
	tcase_set_timeout(doubt, 60);
	tcase_add_test(doubt, one_ball_seen_twice_is_not_asked_for);
	tcase_add_test(doubt, a_colour_seen_twice_is_not_asked_for_by_the_rules);
	tcase_add_test(doubt, a_ball_in_the_jaws_is_asked_for_where_it_hangs);
	tcase_add_test(doubt, a_nudge_of_more_than_half_a_millimetre_asks_anew);
	tcase_add_test(doubt, a_ball_carried_300_mm);
	tcase_add_test(doubt, a_drift_of_2_mm_s_takes_the_proposal_off);
	tcase_add_test(doubt, an_arm_for_a_minute_is_told);
	tcase_add_test(doubt, lights_off_and_on);
	tcase_add_test(doubt, a_blinking_ball_is_told);
	tcase_add_test(doubt, two_false_whites);
	tcase_add_test(doubt, silence_of_vision_is_told_within_a_second);
	tcase_add_test(doubt, silence_of_the_planner_is_told_within_a_second);
	tcase_add_test(doubt, rings_go_when_a_ball_moves_while_planning);
	suite_add_tcase(suite, doubt);
	return suite;
}
