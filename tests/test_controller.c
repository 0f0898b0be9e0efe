#include "app/process/text.h"
#include "app/process/ball_message.h"
#include "app/planner/request_message.h"
#include "app/light/animation.h"
#include "app/planner/plan_message.h"
#include "app/control/controller.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/bus.h"
#include "app/process/message_table.h"
#include "harness.h"
#include "vision/vision.h"

/* The controller fed with messages as they come from the bus; nothing else is real. 30 frames a second. */
enum { FRAME_US = 33333, MANY = 60 };
static struct config config; /* too large for the stack */
static struct controller c;
static billiard_table_state_t state;
static double now;
static int64_t draws, requests, sent, cancels, last_id; /* requests: each once; sent: repeated ones, too */

static void place(int i, enum ball_colour colour, double x, double y)
{
	struct ball ball = ball_at(colour, (vec2){x, y});
	ball_to_message(&state.balls[i], &ball, "", i + 1);
}

/* As from the bus: what its table does not allow reaches no controller. */
static bool see(const billiard_table_state_t *message)
{
	char reason[128];
	return message_check(&message_table_state, message, reason, sizeof reason) &&
	       controller_state(&c, message, now);
}

static bool take(const billiard_plan_t *message)
{
	char reason[128];
	return message_check(&message_plan, message, reason, sizeof reason) && controller_plan(&c, message, now);
}

static bool draws_well(void)
{
	char reason[128];
	return message_check(&message_draw_list, &c.draw, reason, sizeof reason) && draw_check(&c.draw);
}

static bool moves_well(void)
{
	char reason[128];
	return message_check(&message_animation, &c.animation, reason, sizeof reason) && animation_check(&c.animation);
}

static void setup(void)
{
	char err[640];
	ck_assert_msg(config_load(&config, "config/thesis-table.conf", err, sizeof err) == 0, "%s", err);
	controller_init(&c, &config);
	state = (billiard_table_state_t){.utime = 1000000, .calibration = 1, .markers = 4, .ball_count = 4};
	place(0, COLOUR_WHITE, -0.3, 0);
	place(1, COLOUR_RED, 0.3, 0.2);
	place(2, COLOUR_RED, 0.5, -0.2);
	place(3, COLOUR_BLACK, 0.8938, 0);
	now = 100;
	draws = requests = sent = cancels = last_id = 0;
}

/* What the process around it would send. */
static struct controller_output flush(void)
{
	struct controller_output out = c.output;
	c.output = (struct controller_output){0};
	draws += out.draw;
	sent += out.request;
	requests += out.request && c.request.id != last_id;
	last_id = out.request ? c.request.id : last_id;
	cancels += out.cancel;
	return out;
}

static bool frame(void)
{
	state.utime += FRAME_US;
	state.seq++;
	now += 1e-6 * FRAME_US;
	bool ok = see(&state);
	controller_tick(&c, now);
	flush();
	return ok;
}

static void frames(int count)
{
	for (int i = 0; i < count; i++)
		ck_assert(frame());
}

/* Balls roll for some frames and stop elsewhere. */
static void shot(void)
{
	for (int i = 0; i < 10; i++) {
		state.balls[0].x += 0.01;
		frame();
	}
}

static billiard_plan_t *answer(int8_t status, double angle)
{
	static billiard_plan_t plan;
	plan_message_begin(&plan, &c.request);
	plan.status = status;
	plan.is_final = 1;
	if (status != PLAN_MESSAGE_OK)
		return &plan;
	plan.entry_count = 2;
	for (int i = 0; i < 2; i++) {
		plan.entries[i].shot_count = 1;
		billiard_plan_shot_t *s = &plan.entries[i].shots[0];
		*s = (billiard_plan_shot_t){.angle = angle + i,
					    .speed = 1,
					    .target = 1,
					    .pocket = (int16_t)i,
					    .chain_count = 2,
					    .chain = {0, 1, -1, -1}};
		for (int k = 0; k < plan.ball_count; k++) {
			s->start_x[k] = c.request.balls[k].x;
			s->start_y[k] = c.request.balls[k].y;
			s->start_on[k] = 1;
		}
		s->keyframe_first = plan.keyframe_count;
		s->keyframe_count = 1;
		plan.keyframes[plan.keyframe_count++] = (billiard_keyframe_t){.end = 2,
									      .phase = BALL_ROLLING,
									      .event = EVENT_STRIKE,
									      .x = s->start_x[0],
									      .y = s->start_y[0],
									      .vx = cos(s->angle),
									      .vy = sin(s->angle)};
	}
	return &plan;
}

static bool command(const char *name, const char *argument)
{
	billiard_command_t m = {.utime = 1};
	text_set(m.name, sizeof m.name, name);
	text_set(m.argument, sizeof m.argument, argument);
	bool ok = controller_command(&c, &m, now);
	flush();
	return ok;
}

/* To a table with a proposal on it. */
static void proposed(void)
{
	frames(MANY);
	ck_assert(take(answer(PLAN_MESSAGE_OK, 0.5)));
	flush();
	ck_assert_int_eq(c.fsm.state, FSM_SHOWING);
}

/* ---- the way of a proposal --------------------------------------------------------------------------------------- */

START_TEST(a_resting_table_is_asked_for_once)
{
	frames((int)(30 * config.infinity.still_time));
	ck_assert_int_eq(requests, 0);
	frames(MANY);
	ck_assert_int_eq(requests, 1);
	ck_assert_int_eq(c.fsm.state, FSM_PLANNING);
	ck_assert_int_gt(c.request.id, 0);
	ck_assert_int_eq(c.request.ball_count, 4);
	ck_assert(c.request.depth == config.planner.depth && c.request.rails == config.planner.rails &&
		  c.request.max_balls == config.planner.balls && c.request.speeds == config.planner.speeds &&
		  c.request.plans == config.planner.plans && c.request.budget_s == config.planner.budget);
	for (int i = 0; i < 4; i++)
		ck_assert(c.request.balls[i].x == state.balls[i].x && c.request.balls[i].y == state.balls[i].y &&
			  c.request.balls[i].colour == state.balls[i].colour);
	ck_assert_str_eq((const char *)c.request.balls[2].name, "RED1");
	struct plan_request r;
	char err[96];
	ck_assert_msg(plan_request_from_message(&r, &c.request, &config.table, err, sizeof err) == 0, "%s", err);
}
END_TEST

/* One frame with vision's doubts before it: the table's, and ball i's. */
static void doubtful_frame(int8_t doubt, int i)
{
	billiard_vision_doubt_t message = {
		.utime = state.utime + FRAME_US, .doubt = doubt, .ball_count = state.ball_count};
	message.ball_doubt[i] = doubt & (DOUBT_PLACE | DOUBT_COLOUR | DOUBT_HIDDEN);
	controller_doubt(&c, &message);
	frame();
}

/* What vision doubts is not asked for; when it does not any more, it is, once. */
START_TEST(a_position_in_doubt_is_not_asked_for)
{
	static const int8_t wrong[] = {DOUBT_PLACE, DOUBT_HIDDEN, DOUBT_UNJUDGED};
	for (int k = 0; k < 3; k++) {
		setup();
		for (int i = 0; i < MANY; i++)
			doubtful_frame(wrong[k], 1);
		ck_assert_int_eq(requests, 0);
		for (int i = 0; i < MANY; i++)
			doubtful_frame(0, 1);
		ck_assert_int_eq(requests, 1);
	}
	/* A red that may be brown is a ball to be potted where any is; the cue ball must be sure. */
	setup();
	config.infinity.rules = false;
	for (int i = 0; i < MANY; i++)
		doubtful_frame(DOUBT_COLOUR, 0);
	ck_assert_int_eq(requests, 0);
	for (int i = 0; i < MANY; i++)
		doubtful_frame(DOUBT_COLOUR, 1);
	ck_assert_int_eq(requests, 1);
	setup();
	config.infinity.rules = true;
	for (int i = 0; i < MANY; i++)
		doubtful_frame(DOUBT_COLOUR, 1);
	ck_assert_int_eq(requests, 0);
	/* Doubts that got lost on the way are doubts; a vision that never told any has none. */
	setup();
	doubtful_frame(0, 0);
	for (int i = 0; i < MANY; i++)
		frame();
	ck_assert_int_eq(requests, 0);
	setup();
	frames(MANY);
	ck_assert_int_eq(requests, 1);
}
END_TEST

START_TEST(an_answer_is_drawn_and_stays)
{
	proposed();
	ck_assert(draws_well());
	ck_assert_int_eq(c.draw.plan_id, c.request.id);
	ck_assert_int_gt(c.draw.item_count, 0);
	ck_assert(moves_well() && c.animation.keyframe_count == 1 && c.animation.run);
	int64_t before = draws;
	frames(MANY);
	ck_assert(draws == before && requests == 1 && c.proposals == 1);
}
END_TEST

START_TEST(a_shot_takes_it_off_and_asks_anew)
{
	proposed();
	int64_t id = c.request.id;
	shot();
	ck_assert_int_eq(c.fsm.state, FSM_SHOT);
	ck_assert(c.draw.plan_id == 0 && c.draw.item_count == 0 && c.animation.keyframe_count == 0);
	frames(MANY);
	ck_assert_int_eq(c.fsm.state, FSM_PLANNING);
	ck_assert_int_gt(c.request.id, id);
	ck_assert_int_eq(cancels, 0);
}
END_TEST

START_TEST(motion_while_planning_cancels)
{
	frames(MANY);
	int64_t id = c.request.id;
	shot();
	ck_assert_int_eq(cancels, 1);
	ck_assert(take(answer(PLAN_MESSAGE_OK, 0.5)));
	ck_assert(c.fsm.state == FSM_WATCHING && c.draw.plan_id == 0 && c.proposals == 0);
	frames(MANY);
	ck_assert_int_gt(c.request.id, id);
}
END_TEST

START_TEST(improved_answers_replace_repeated_ones_do_not)
{
	proposed();
	billiard_plan_t *plan = answer(PLAN_MESSAGE_OK, 0.9);
	plan->sequence = 3;
	plan->entries[0].cost = -1;
	ck_assert(take(plan));
	ck_assert_double_eq(c.plan.entries[0].shots[0].angle, 0.9);
	plan = answer(PLAN_MESSAGE_OK, 0.2);
	plan->sequence = 2; /* late */
	ck_assert(take(plan));
	ck_assert_double_eq(c.plan.entries[0].shots[0].angle, 0.9);
	ck_assert_int_eq(c.proposals, 1);
}
END_TEST

/* What is drawn first stays: only what is better by the margin takes its place. */
START_TEST(a_proposal_changes_only_for_a_better_one)
{
	frames(MANY);
	billiard_plan_t *plan = answer(PLAN_MESSAGE_OK, 0.5);
	plan->entries[0].cost = 2;
	ck_assert(take(plan));
	int64_t before = draws;
	flush();
	plan = answer(PLAN_MESSAGE_OK, 0.9);
	plan->sequence = 1;
	plan->entries[0].cost = 2 - 0.9 * config.infinity.better_margin * 2;
	ck_assert(take(plan));
	flush();
	ck_assert_int_eq(draws, before + 1);
	ck_assert_double_eq(c.plan.entries[0].shots[0].angle, 0.5);
	plan = answer(PLAN_MESSAGE_OK, 0.9);
	plan->sequence = 2;
	plan->entries[0].cost = 2 - 1.1 * config.infinity.better_margin * 2;
	ck_assert(take(plan));
	ck_assert_double_eq(c.plan.entries[0].shots[0].angle, 0.9);
	/* Who looks at another one is not interrupted. */
	command("next", "");
	plan = answer(PLAN_MESSAGE_OK, 0.1);
	plan->sequence = 3;
	plan->entries[0].cost = -100;
	ck_assert(take(plan));
	ck_assert_double_eq(c.plan.entries[0].shots[0].angle, 0.9);
}
END_TEST

/* One that is not final is shown when it has stayed the same for a tenth of a second. */
START_TEST(a_proposal_is_shown_when_it_has_settled)
{
	frames(MANY);
	for (int i = 0; i < 20; i++) {
		billiard_plan_t *plan = answer(PLAN_MESSAGE_OK, 0.1 * i);
		plan->is_final = 0;
		plan->sequence = i;
		ck_assert(take(plan));
		frames(2);
		ck_assert_int_eq(c.fsm.state, FSM_PLANNING);
	}
	frames(2);
	ck_assert_int_eq(c.fsm.state, FSM_SHOWING);
	ck_assert_double_eq(c.plan.entries[0].shots[0].angle, 0.1 * 19);
	/* The last one says the same: nothing is drawn anew but what it adds. */
	billiard_plan_t *plan = answer(PLAN_MESSAGE_OK, 0.1 * 19);
	plan->sequence = 20;
	ck_assert(take(plan));
	ck_assert(c.plan.is_final && c.proposals == 1);
}
END_TEST

START_TEST(no_plan_is_said_on_the_table)
{
	frames(MANY);
	billiard_plan_t *plan = answer(PLAN_MESSAGE_NONE, 0);
	text_set(plan->reason, sizeof plan->reason, "no shot found");
	ck_assert(take(plan));
	ck_assert_int_eq(c.fsm.state, FSM_SHOWING);
	ck_assert_str_eq(c.drawn_note, "no shot found");
	ck_assert(command("halo", ""));
	ck_assert_str_eq(c.drawn_note, "no shot found");
	command("next", "");
	command("previous", "");
	ck_assert_int_eq(c.draw.plan_id, 0);
	frames(MANY);
	ck_assert_int_eq(requests, 1);
}
END_TEST

/* ---- lost, doubled, late, malformed ------------------------------------------------------------------------------ */

START_TEST(a_lost_request_or_answer_is_repeated)
{
	frames(MANY);
	int64_t id = c.request.id;
	/* Half a second after the first, and again: always the same one. */
	ck_assert(sent >= 3 && requests == 1);
	int64_t before = sent;
	while (sent == before)
		frames(1);
	double last = now;
	while (sent == before + 1)
		frames(1);
	ck_assert_double_le(now - last, 0.5 + 2e-6 * FRAME_US);
	ck_assert(requests == 1 && c.request.id == id);
	ck_assert(take(answer(PLAN_MESSAGE_OK, 0.5)));
	ck_assert_int_eq(c.fsm.state, FSM_SHOWING);
}
END_TEST

START_TEST(a_request_that_somebody_else_cancelled_gets_a_new_id)
{
	frames(MANY);
	int64_t id = c.request.id;
	ck_assert(take(answer(PLAN_MESSAGE_CANCELLED, 0)));
	ck_assert_int_eq(c.fsm.state, FSM_PLANNING);
	frames((int)(config.infinity.plan_timeout * 30) + 5);
	ck_assert(c.request.id > id);
}
END_TEST

/* The camera saw the shot begin and nothing after it. */
START_TEST(a_shot_without_an_end_is_given_up)
{
	proposed();
	shot();
	ck_assert_int_eq(c.fsm.state, FSM_SHOT);
	/* Something stands over the table. */
	state.occluded = 1;
	frames(MANY + 3);
	ck_assert_int_eq(c.fsm.state, FSM_WATCHING);
	state.occluded = 0;
	frames(MANY);
	ck_assert(c.fsm.state == FSM_PLANNING && requests == 2);
}
END_TEST

/* The refusal of a later improvement, or a repeated final answer, does not take the proposal off. */
START_TEST(no_plan_after_a_plan_changes_nothing)
{
	proposed();
	int64_t before = draws;
	ck_assert(take(answer(PLAN_MESSAGE_NONE, 0)));
	ck_assert(take(answer(PLAN_MESSAGE_REFUSED, 0)));
	ck_assert(c.fsm.state == FSM_SHOWING && c.draw.plan_id == c.request.id && draws == before);
	frames(MANY);
	ck_assert_int_eq(requests, 1);
}
END_TEST

/* Only a final "none" is one: better answers may still come. */
START_TEST(an_interim_no_plan_waits_for_the_final_one)
{
	frames(MANY);
	billiard_plan_t *plan = answer(PLAN_MESSAGE_NONE, 0);
	plan->is_final = 0;
	ck_assert(take(plan));
	ck_assert_int_eq(c.fsm.state, FSM_PLANNING);
	ck_assert(take(answer(PLAN_MESSAGE_OK, 0.5)));
	ck_assert_int_eq(c.fsm.state, FSM_SHOWING);
}
END_TEST

START_TEST(late_and_foreign_answers_are_ignored)
{
	ck_assert(!take(answer(PLAN_MESSAGE_OK, 0.5))); /* nothing was asked: id 0 */
	frames(MANY);
	billiard_plan_t *plan = answer(PLAN_MESSAGE_OK, 0.5);
	plan->request_id--;
	ck_assert(!take(plan));
	plan = answer(PLAN_MESSAGE_OK, NAN);
	ck_assert(!take(plan));
	ck_assert(c.fsm.state == FSM_PLANNING && !c.has_plan && c.proposals == 0);
}
END_TEST

START_TEST(doubled_and_late_frames_are_ignored)
{
	frames(MANY);
	struct controller *before = malloc(sizeof *before);
	ck_assert_ptr_nonnull(before);
	*before = c;
	ck_assert(!see(&state));
	state.utime -= 10 * FRAME_US;
	ck_assert(!see(&state));
	ck_assert_int_eq(memcmp(&c, before, sizeof c), 0);
	free(before);
}
END_TEST

START_TEST(malformed_frames_change_nothing)
{
	frames(MANY);
	struct controller *before = malloc(sizeof *before);
	billiard_table_state_t good = state;
	ck_assert_ptr_nonnull(before);
	*before = c;
#define BAD(field, value)                                                                                              \
	(state = good, state.utime += FRAME_US, state.field = (value), ck_assert_msg(!see(&state), #field " = " #value))
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
	ck_assert_int_eq(memcmp(&c, before, sizeof c), 0);
	free(before);
}
END_TEST

START_TEST(a_clock_that_was_set_back_does_not_stop_it)
{
	proposed();
	int64_t id = c.request.id;
	state.utime = 5; /* or another recording */
	frames(3);
	shot();
	frames(MANY);
	ck_assert(c.fsm.state == FSM_PLANNING && c.request.id > id);
}
END_TEST

START_TEST(lost_calibration_clears_and_says_why)
{
	proposed();
	state.calibration = 0;
	state.ball_count = 0;
	text_set(state.reason, sizeof state.reason, "2 of 4 markers");
	frames(10);
	ck_assert_int_eq(c.fsm.state, FSM_BLIND);
	ck_assert_str_eq(c.drawn_note, "not calibrated: 2 of 4 markers");
	ck_assert(c.draw.plan_id == 0 && draws_well());
	text_set(state.reason, sizeof state.reason, "no markers");
	frames(1);
	ck_assert_str_eq(c.drawn_note, "not calibrated: no markers");
	int64_t before = draws;
	frames(10);
	ck_assert_int_eq(draws, before);
	setup();
	frames(MANY);
	ck_assert_int_eq(c.fsm.state, FSM_PLANNING);
}
END_TEST

START_TEST(a_hand_that_passes_changes_nothing)
{
	proposed();
	int64_t before = draws;
	state.occluded = 1;
	frames(MANY);
	state.occluded = 0;
	frames(MANY);
	ck_assert(c.fsm.state == FSM_SHOWING && draws == before && requests == 1);
}
END_TEST

START_TEST(a_ball_taken_away_asks_anew)
{
	proposed();
	state.ball_count = 3;
	frames(MANY);
	ck_assert(c.fsm.state == FSM_PLANNING && requests == 2 && c.request.ball_count == 3);
}
END_TEST

START_TEST(a_false_white_is_left_out)
{
	frames(3);
	place(4, COLOUR_WHITE, 0.7, 0.3);
	state.ball_count = 5;
	frames(MANY);
	ck_assert_int_eq(c.request.ball_count, 4);
	ck_assert_double_eq(c.request.balls[0].x, -0.3);
}
END_TEST

/* It can only be played as one. */
START_TEST(a_ball_of_unknown_colour_is_asked_for_as_a_red)
{
	place(2, COLOUR_UNKNOWN, 0.5, -0.2);
	frames(MANY);
	ck_assert(c.request.ball_count == 4 && c.request.balls[2].colour == COLOUR_RED);
	ck_assert_str_eq((const char *)c.request.balls[2].name, "RED1");
}
END_TEST

/* After a red that fell a colour is on, by the rules. */
START_TEST(a_red_that_fell_makes_a_colour_the_ball_on)
{
	config.infinity.rules = true;
	proposed();
	ck_assert(c.request.target_kind == TARGET_RULES && c.request.on == ON_RED);
	state.balls[1] = state.balls[3];
	state.ball_count = 3;
	shot();
	frames(MANY);
	ck_assert(c.request.ball_count == 3 && c.request.on == ON_COLOUR);
}
END_TEST

START_TEST(overlaps_of_a_camera_are_settled_in_the_request)
{
	place(1, COLOUR_RED, 0.3, 0.2);
	place(2, COLOUR_RED, 0.3 + 0.0523 - 0.001, 0.2);
	frames(MANY);
	struct plan_request r;
	char err[96];
	ck_assert_msg(plan_request_from_message(&r, &c.request, &config.table, err, sizeof err) == 0, "%s", err);
	/* Nothing moved on the table: no new request. */
	ck_assert(take(answer(PLAN_MESSAGE_OK, 0.5)));
	frames(MANY);
	ck_assert_int_eq(requests, 1);
}
END_TEST

/* ---- what cannot be, what is silent --------------------------------------------------------------------------------- */

/* One ball in two tracks, 13 mm apart: nothing is asked, the table says it, and goes on when one of them is gone. */
START_TEST(one_ball_seen_twice_is_not_asked_for)
{
	place(4, COLOUR_RED, 0.313, 0.2);
	state.ball_count = 5;
	frames(MANY);
	ck_assert_int_eq(requests, 0);
	ck_assert_int_eq(c.report.verdict, STABILITY_UNSURE);
	frames(MANY);
	ck_assert_str_eq(c.drawn_note, "RED at (300, 200): cannot lie there");
	state.ball_count = 4;
	frames(MANY);
	ck_assert(requests == 1 && c.request.ball_count == 4);
}
END_TEST

/* By the rules a colour is there once. */
START_TEST(a_colour_seen_twice_is_not_asked_for_by_the_rules)
{
	config.infinity.rules = true;
	place(2, COLOUR_BLACK, 0.5, -0.2);
	frames(2 * MANY);
	ck_assert_int_eq(requests, 0);
	ck_assert_ptr_nonnull(strstr(c.drawn_note, "BLACK"));
	config.infinity.rules = false;
	frames(MANY);
	ck_assert_int_eq(requests, 1);
}
END_TEST

/* What is asked for is what lies there, in a pocket's jaws, too. */
START_TEST(a_ball_in_the_jaws_is_asked_for_where_it_hangs)
{
	place(3, COLOUR_BLUE, -0.9299, -0.3964);
	frames(MANY);
	ck_assert_int_eq(requests, 1);
	ck_assert_double_eq_tol(c.request.balls[3].x, -0.9299, 5e-4);
	ck_assert_double_eq_tol(c.request.balls[3].y, -0.3964, 5e-4);
	struct plan_request r;
	char err[96];
	ck_assert_msg(plan_request_from_message(&r, &c.request, &config.table, err, sizeof err) == 0, "%s", err);
}
END_TEST

START_TEST(a_nudge_of_more_than_half_a_millimetre_asks_anew)
{
	proposed();
	state.balls[1].x += 0.0004;
	frames(MANY);
	ck_assert(requests == 1 && c.fsm.state == FSM_SHOWING);
	state.balls[1].x += 0.0003;
	frames(MANY);
	ck_assert(requests == 2 && c.request.balls[1].x == state.balls[1].x);
}
END_TEST

/* A ball carried 300 mm by hand, slowly: light for where it was is gone at once, and what comes is for where it is. */
START_TEST(a_ball_carried_300_mm)
{
	proposed();
	for (int i = 0; i < 90; i++) {
		state.occluded = 1;
		state.balls[2].x -= 0.3 / 90;
		frames(1);
		if (i > 3)
			ck_assert_int_eq(c.draw.plan_id, 0);
	}
	state.occluded = 0;
	frames(MANY);
	ck_assert(requests == 2 && c.request.balls[2].x == state.balls[2].x);
}
END_TEST

/* A drift of 2 mm/s: no proposal while it goes on. */
START_TEST(a_drift_of_2_mm_s_takes_the_proposal_off)
{
	proposed();
	for (int i = 0; i < 150; i++) {
		state.balls[2].y += 0.002 / 30;
		frames(1);
		if (i > 15)
			ck_assert_int_eq(c.draw.plan_id, 0);
	}
	ck_assert_int_eq(requests, 1);
	frames(MANY);
	ck_assert_int_eq(requests, 2);
}
END_TEST

/* An arm over the table for a minute, no proposal yet: after two seconds the table says what it waits for. */
START_TEST(an_arm_for_a_minute_is_told)
{
	state.occluded = 1;
	for (int i = 0; i < 60 * 30; i++) {
		frames(1);
		if (i > 75)
			ck_assert_str_eq(c.drawn_note, "something is over the table");
	}
	ck_assert_int_eq(requests, 0);
	ck_assert_int_eq(c.report.verdict, STABILITY_UNSURE);
	ck_assert_str_eq((const char *)c.report.word, "something is over the table");
	ck_assert(!c.report.conditions[STABILITY_CLEAR].holds && c.report.conditions[STABILITY_STILL].holds);
	state.occluded = 0;
	frames(MANY);
	ck_assert_int_eq(requests, 1);
}
END_TEST

/* Lights off and on: the same balls lie there, the same proposal comes back, nothing is asked. */
START_TEST(lights_off_and_on)
{
	proposed();
	int64_t id = c.request.id;
	state.calibration = 0;
	frames(MANY);
	ck_assert(c.fsm.state == FSM_BLIND && c.draw.plan_id == 0);
	state.calibration = 1;
	frames(MANY);
	ck_assert(c.fsm.state == FSM_SHOWING && c.draw.plan_id == id && requests == 1);
}
END_TEST

/* A ball that blinks: seen in nine of ten frames only. */
START_TEST(a_blinking_ball_is_told)
{
	for (int i = 0; i < 150; i++) {
		state.ball_count = i % 10 ? 4 : 3;
		frames(1);
	}
	ck_assert_int_eq(requests, 0);
	ck_assert_str_eq(c.drawn_note, "a ball comes and goes");
	frames(MANY);
	ck_assert_int_eq(requests, 1);
}
END_TEST

/* Two false white balls beside the cue ball: they are left out. Without it, nobody guesses which is the cue ball. */
START_TEST(two_false_whites)
{
	frames(3);
	place(4, COLOUR_WHITE, 0.7, 0.3);
	place(5, COLOUR_WHITE, 0.7, -0.3);
	state.ball_count = 6;
	frames(MANY);
	ck_assert(requests == 1 && c.request.ball_count == 4 && c.request.balls[0].x == -0.3);
	shot();
	state.balls[0] = state.balls[5];
	state.ball_count = 5;
	frames(2 * MANY);
	ck_assert_int_eq(requests, 1);
	ck_assert_str_eq(c.drawn_note, "which white ball is the cue ball?");
}
END_TEST

/* Vision is silent: told within a second, in every state; with the frames the proposal comes back. */
START_TEST(silence_of_vision_is_told_within_a_second)
{
	proposed();
	int64_t id = c.request.id;
	double last = now;
	while (c.draw.plan_id) {
		now += 0.05;
		controller_tick(&c, now);
		flush();
		ck_assert_double_le(now - last, 1);
	}
	ck_assert_str_eq(c.drawn_note, "no pictures: billiard-vision is silent");
	ck_assert_int_eq(c.fsm.state, FSM_BLIND);
	int64_t before = draws;
	for (int i = 0; i < 100; i++)
		controller_tick(&c, now += 0.05);
	flush();
	ck_assert_int_eq(draws, before);
	frames(MANY);
	ck_assert(c.fsm.state == FSM_SHOWING && c.draw.plan_id == id && requests == 1);
}
END_TEST

START_TEST(silence_of_the_planner_is_told_within_a_second)
{
	while (requests == 0)
		frames(1);
	frames(31);
	ck_assert_str_eq(c.drawn_note, "no answer from the planner yet");
	ck_assert(c.fsm.state == FSM_PLANNING && sent == 2);
	ck_assert(take(answer(PLAN_MESSAGE_OK, 0.5)));
	ck_assert(c.fsm.state == FSM_SHOWING && c.draw.plan_id == c.request.id);
}
END_TEST

/* Rings stand around balls that rest; when one moves they go, whatever the controller does just then. */
START_TEST(rings_go_when_a_ball_moves_while_planning)
{
	proposed();
	state.balls[1].y += 0.01;
	while (c.fsm.state != FSM_PLANNING)
		frame();
	frames(MANY); /* no answer: rings and a note */
	ck_assert_int_gt(c.draw.item_count, 0);
	shot();
	ck_assert(c.draw.item_count == 0 && c.fsm.state == FSM_WATCHING);
}
END_TEST

/* ---- commands ---------------------------------------------------------------------------------------------------- */

START_TEST(pause_and_resume)
{
	proposed();
	ck_assert(command("pause", ""));
	ck_assert(c.fsm.state == FSM_PAUSED && c.draw.plan_id == 0);
	frames(MANY);
	ck_assert_int_eq(requests, 1);
	ck_assert(command("resume", ""));
	frames(MANY);
	ck_assert(c.fsm.state == FSM_PLANNING && requests == 2);
	ck_assert(command("infinity", ""));
	ck_assert(c.fsm.state == FSM_PAUSED && cancels == 1);
}
END_TEST

START_TEST(next_and_previous_go_round)
{
	proposed();
	ck_assert_int_eq(c.animation.keyframe_count, 1);
	double first = c.animation.keyframes[0].vx;
	command("next", "");
	ck_assert_int_eq(c.entry, 1);
	ck_assert_double_ne(c.animation.keyframes[0].vx, first);
	command("next", "");
	ck_assert_int_eq(c.entry, 0);
	command("previous", "");
	ck_assert_int_eq(c.entry, 1);
}
END_TEST

START_TEST(the_animation_stops_seeks_and_restarts)
{
	proposed();
	now += 0.5;
	command("animation-stop", "");
	ck_assert_int_eq(c.animation.run, 0);
	ck_assert_double_eq_tol(c.animation.position, 0.5 * config.infinity.animation_rate, 1e-9);
	command("animation-seek", "1");
	ck_assert_double_eq_tol(c.animation.position, 1.5, 1e-9);
	command("animation-seek", "1000000");
	ck_assert_double_eq(c.animation.position, 2);
	command("animation-seek", "-99");
	ck_assert_double_eq(c.animation.position, 0);
	ck_assert(!command("animation-seek", "nan") && !command("animation-seek", "") &&
		  !command("animation-nonsense", ""));
	command("animation-stop", "");
	now += 0.25;
	command("animation-seek", "0.5");
	ck_assert_double_eq_tol(c.animation.position, 0.75, 1e-9);
	ck_assert(moves_well());
	command("animation-restart", "");
	ck_assert(c.animation.position == 0 && c.animation.run);
	command("animation", "");
	ck_assert_int_eq(c.animation.keyframe_count, 0);
	command("animation", "");
	ck_assert_int_eq(c.animation.keyframe_count, 1);
}
END_TEST

START_TEST(commands_for_others_are_left_to_them)
{
	proposed();
	billiard_command_t m = {.utime = 1};
	text_set(m.name, sizeof m.name, "pause");
	text_set(m.target, sizeof m.target, "billiard-vision");
	ck_assert(controller_command(&c, &m, now));
	ck_assert_int_eq(c.fsm.state, FSM_SHOWING);
	ck_assert(command("snapshot", "x.png") && command("", "") && command("cancel", "5"));
	ck_assert_int_eq(c.fsm.state, FSM_SHOWING);
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
static uint64_t storm(uint64_t seed)
{
	static const char *const commands[] = {
		"pause",    "resume",	 "next",	   "previous",		"halo",	  "paths", "table", "info",
		"infinity", "animation", "animation-stop", "animation-restart", "cancel", "x"};
	struct random random = {seed};
	uint64_t h = 1469598103934665603u;
	setup();
	for (int i = 0; i < 4000; i++) {
		unsigned what = (unsigned)(random_u64(&random) % 40);
		if (what == 0)
			command(commands[random_u64(&random) % (sizeof commands / sizeof commands[0])], "0.5");
		else if (what == 1)
			shot();
		else if (what == 2)
			take(answer((int8_t)(random_u64(&random) % 6), random_in(&random, -4, 4)));
		else if (what == 3)
			state.occluded = !state.occluded;
		else if (what == 4)
			state.calibration = (int8_t)(random_u64(&random) % 3);
		else if (what == 5)
			((uint8_t *)&state.balls)[random_u64(&random) % sizeof state.balls[0]] ^=
				(uint8_t)random_u64(&random);
		else if (what == 6)
			place(0, COLOUR_WHITE, random_in(&random, -0.9, 0.9), random_in(&random, -0.4, 0.4));
		frame();
		ck_assert(draws_well());
		ck_assert(moves_well());
		h = hash(h, &c.draw, sizeof c.draw);
		h = hash(h, &c.animation, sizeof c.animation);
		h = hash(h, &c.request, sizeof c.request);
	}
	return h;
}

START_TEST(storms_are_survived_and_repeatable)
{
	struct random random = random_begin("controller storm");
	for (int i = 0; i < 3; i++) {
		uint64_t seed = random_u64(&random);
		ck_assert_uint_eq(storm(seed), storm(seed));
		/* Afterwards a calm table gets its proposal. */
		billiard_table_state_t spoiled = state;
		struct controller *survivor = malloc(sizeof *survivor);
		ck_assert_ptr_nonnull(survivor);
		*survivor = c;
		double then = now;
		setup();
		c = *survivor;
		free(survivor);
		state.utime = spoiled.utime;
		now = then;
		command("resume", "");
		shot();
		frames(MANY);
		ck_assert_int_eq(c.fsm.state, FSM_PLANNING);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("controller");
	TCase *way = tcase_create("proposals");
	tcase_add_checked_fixture(way, setup, NULL);
	tcase_add_test(way, a_resting_table_is_asked_for_once);
	tcase_add_test(way, a_position_in_doubt_is_not_asked_for);
	tcase_add_test(way, an_answer_is_drawn_and_stays);
	tcase_add_test(way, a_shot_takes_it_off_and_asks_anew);
	tcase_add_test(way, motion_while_planning_cancels);
	tcase_add_test(way, improved_answers_replace_repeated_ones_do_not);
	tcase_add_test(way, a_proposal_changes_only_for_a_better_one);
	tcase_add_test(way, a_proposal_is_shown_when_it_has_settled);
	tcase_add_test(way, no_plan_is_said_on_the_table);
	suite_add_tcase(suite, way);
	TCase *faults = tcase_create("faults");
	tcase_add_checked_fixture(faults, setup, NULL);
	tcase_set_timeout(faults, 60);
	tcase_add_test(faults, a_lost_request_or_answer_is_repeated);
	tcase_add_test(faults, a_request_that_somebody_else_cancelled_gets_a_new_id);
	tcase_add_test(faults, a_shot_without_an_end_is_given_up);
	tcase_add_test(faults, no_plan_after_a_plan_changes_nothing);
	tcase_add_test(faults, an_interim_no_plan_waits_for_the_final_one);
	tcase_add_test(faults, late_and_foreign_answers_are_ignored);
	tcase_add_test(faults, doubled_and_late_frames_are_ignored);
	tcase_add_test(faults, malformed_frames_change_nothing);
	tcase_add_test(faults, a_clock_that_was_set_back_does_not_stop_it);
	tcase_add_test(faults, lost_calibration_clears_and_says_why);
	tcase_add_test(faults, a_hand_that_passes_changes_nothing);
	tcase_add_test(faults, a_ball_taken_away_asks_anew);
	tcase_add_test(faults, a_false_white_is_left_out);
	tcase_add_test(faults, a_ball_of_unknown_colour_is_asked_for_as_a_red);
	tcase_add_test(faults, a_red_that_fell_makes_a_colour_the_ball_on);
	tcase_add_test(faults, overlaps_of_a_camera_are_settled_in_the_request);
	tcase_add_test(faults, storms_are_survived_and_repeatable);
	suite_add_tcase(suite, faults);
	TCase *doubt = tcase_create("doubt and silence");
	tcase_add_checked_fixture(doubt, setup, NULL);
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
	TCase *commands = tcase_create("commands");
	tcase_add_checked_fixture(commands, setup, NULL);
	tcase_add_test(commands, pause_and_resume);
	tcase_add_test(commands, next_and_previous_go_round);
	tcase_add_test(commands, the_animation_stops_seeks_and_restarts);
	tcase_add_test(commands, commands_for_others_are_left_to_them);
	suite_add_tcase(suite, commands);
	return suite;
}
