#include "app/virtual/judge.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/light/draw.h"
#include "app/process/ball_message.h"
#include "harness.h"
#include "search/plan.h"
#include "search/rules.h"

static const double R = 0.02615;
static struct judge *judge;
static int64_t now; /* us */

/* The table as the test lays it, and what the loop says of it. */
static struct ball ball[BALL_MAX];
static bool gone[BALL_MAX];
static int count;

static void set_up(void)
{
	judge = malloc(sizeof *judge);
	judge_init(judge, R);
	now = 1000000000;
	count = 0;
	memset(gone, 0, sizeof gone);
	const struct ball start[] = {ball_at(COLOUR_WHITE, (vec2){-0.6, 0.1}), ball_at(COLOUR_RED, (vec2){0.3, 0.2}),
				     ball_at(COLOUR_RED, (vec2){0.5, -0.2}), ball_at(COLOUR_BLACK, (vec2){0.89, 0})};
	for (; count < 4; count++)
		ball[count] = start[count];
}

static void tear_down(void)
{
	free(judge);
}

static int fill(billiard_ball_t *out)
{
	int n = 0;
	for (int i = 0; i < count; i++)
		if (!gone[i])
			ball_to_message(&out[n++], &ball[i], "", i + 1);
	return n;
}

static void truth(bool moving)
{
	billiard_table_state_t t = {.utime = now, .calibration = 1, .moving = moving};
	t.ball_count = fill(t.balls);
	judge_truth(judge, now, &t);
}

/* That many seconds of rest, ten frames each. */
static void rest(double seconds)
{
	for (int i = 0; i < (int)(10 * seconds + 0.5); i++) {
		truth(false);
		now += 100000;
	}
}

/* A shot of a second that leaves the cue ball elsewhere. */
static void shot(void)
{
	for (int i = 0; i < 10; i++) {
		ball[0].pos.x += 0.01;
		truth(true);
		now += 100000;
	}
}

/* What would be asked for now, by the rules when on is given. */
static billiard_plan_request_t request(int on)
{
	billiard_plan_request_t r = {.utime = now, .id = now - 100000, .target_kind = TARGET_RULES, .on = (int8_t)on};
	r.ball_count = fill(r.balls);
	return r;
}

static void ask(const billiard_plan_request_t *r)
{
	judge_request(judge, now, r);
	now += 1000;
}

static void answer(const billiard_plan_request_t *r, double angle, int target)
{
	static billiard_plan_t plan;
	plan = (billiard_plan_t){.request_id = r->id, .entry_count = 1};
	billiard_plan_shot_t *s = &plan.entries[0].shots[0];
	plan.entries[0].shot_count = 1;
	*s = (billiard_plan_shot_t){.angle = angle, .speed = 1, .target = (int16_t)target, .pocket = 3};
	for (int i = 0; i < r->ball_count; i++)
		s->start_x[i] = r->balls[i].x, s->start_y[i] = r->balls[i].y;
	judge_plan(judge, &plan);
}

static void draw(int64_t id, double mark)
{
	static billiard_draw_list_t list;
	draw_clear(&list);
	list.plan_id = id;
	list.utime = now;
	if (mark > 0)
		draw_ring(&list, (vec2){0, 0}, mark, 0.002, 0xffffffff);
	judge_draw(judge, now, &list);
	now += 1000;
}

static const struct judge_report *finish(void)
{
	judge_finish(judge, now);
	return &judge->report;
}

START_TEST(a_good_run_is_good)
{
	truth(false);
	for (int k = 0; k < 5; k++) {
		rest(1);
		billiard_plan_request_t r = request(ON_RED);
		ask(&r);
		answer(&r, 0.1, 1);
		draw(r.id, 0.01);
		rest(2);
		shot();
		draw(0, 0);
		rest(0.1);
	}
	const struct judge_report *p = finish();
	ck_assert_int_eq(p->shots, 5);
	ck_assert_int_eq(p->rests, 6);
	ck_assert_int_eq(p->requests, 5);
	ck_assert_int_eq(p->wrong, 0);
	ck_assert_int_eq(p->more_than_one_request, 0);
	ck_assert_int_eq(p->changed_after_drawn, 0);
	ck_assert_int_eq(p->proposed_pots, 5);
	ck_assert_int_eq(p->made, 0);
	ck_assert_int_eq(p->ball_on_wrong, 0);
	/* four rests after a shot, each drawn after 1.1 s; the light of five shots for a second each */
	ck_assert_int_eq(p->rest_to_drawn.count, 4);
	ck_assert_double_eq_tol(judge_times_share(&p->rest_to_drawn, 0.5), 1101, 2);
	ck_assert_int_eq(p->stale_light.count, 5);
	ck_assert_double_eq_tol(p->stale_light.max, 1000, 2);
}
END_TEST

/* Each wrong request by its cause, and only by that. */
START_TEST(a_wrong_request_is_counted_by_its_cause)
{
	char text[JUDGE_TEXT_SIZE];
	for (int cause = 0; cause < JUDGE_CAUSE_COUNT; cause++) {
		judge_init(judge, R);
		rest(1);
		billiard_plan_request_t r = request(ON_RED);
		billiard_ball_t *last = &r.balls[r.ball_count - 1];
		struct ball extra = ball_at(COLOUR_RED, cause == JUDGE_GHOST ? (vec2){0, 0} : (vec2){0.3 + 2 * R, 0.2});
		if (cause == JUDGE_DOUBLE || cause == JUDGE_GHOST)
			ball_to_message(&r.balls[r.ball_count++], &extra, "", 9);
		else if (cause == JUDGE_MISSING)
			r.ball_count--;
		else if (cause == JUDGE_COLOUR)
			last->colour = COLOUR_BROWN;
		else
			last->y += 0.0051;
		ask(&r);
		ck_assert_int_eq(judge->report.wrong, 1);
		ck_assert_int_eq(judge->report.wrong_by[cause], 1);
		ck_assert(judge_finding(judge, text, sizeof text));
		ck_assert_ptr_nonnull(strstr(text, judge_cause_name((enum judge_cause)cause)));
		ck_assert(!judge_finding(judge, text, sizeof text));
	}
}
END_TEST

START_TEST(up_to_five_millimetres_are_right)
{
	rest(1);
	billiard_plan_request_t r = request(ON_RED);
	for (int i = 0; i < r.ball_count; i++)
		r.balls[i].x += 0.0049;
	ask(&r);
	ck_assert_int_eq(judge->report.wrong, 0);
}
END_TEST

/* A request is held against the frame that it was made from, not against what has happened since. */
START_TEST(a_request_belongs_to_its_frame)
{
	rest(1);
	billiard_plan_request_t r = request(ON_RED);
	shot();
	ask(&r);
	ck_assert_int_eq(judge->report.wrong, 0);
}
END_TEST

START_TEST(a_repeated_request_is_no_second_one)
{
	rest(1);
	billiard_plan_request_t r = request(ON_RED);
	ask(&r);
	ask(&r);
	ck_assert_int_eq(judge->report.requests, 1);
	ck_assert_int_eq(judge->report.repeated, 1);
	r.id += 7;
	ask(&r);
	ck_assert_int_eq(judge->report.requests, 2);
	ck_assert_int_eq(finish()->more_than_one_request, 1);
}
END_TEST

START_TEST(a_rest_in_silence_is_told_once)
{
	char text[JUDGE_TEXT_SIZE];
	rest(0.2);
	shot();
	rest(6);
	ck_assert(judge_finding(judge, text, sizeof text));
	ck_assert_ptr_nonnull(strstr(text, "silent"));
	rest(6);
	ck_assert(!judge_finding(judge, text, sizeof text));
	ck_assert_int_eq(finish()->without_request, 1);
}
END_TEST

START_TEST(a_nudged_ball_is_a_new_rest)
{
	rest(1);
	ball[2].pos.x += 0.0004;
	rest(1);
	ck_assert_int_eq(judge->report.rests, 1);
	ball[2].pos.x += 0.0006;
	rest(1);
	ck_assert_int_eq(judge->report.rests, 2);
	ck_assert_int_eq(judge->report.shots, 0);
}
END_TEST

START_TEST(a_change_of_the_first_shot_counts_once_a_rest)
{
	rest(1);
	billiard_plan_request_t r = request(ON_RED);
	ask(&r);
	answer(&r, 0.1, 1);
	draw(r.id, 0.01);
	draw(r.id, 0.01); /* repeated */
	draw(r.id, 0.02); /* another picture of the same shot */
	ck_assert_int_eq(judge->report.changed_after_drawn, 0);
	answer(&r, 0.2, 1); /* better, but not drawn */
	draw(r.id, 0.02);
	ck_assert_int_eq(judge->report.changed_after_drawn, 0);
	draw(r.id, 0.03);
	answer(&r, 0.3, 2);
	draw(r.id, 0.04);
	ck_assert_int_eq(judge->report.changed_after_drawn, 1);
}
END_TEST

START_TEST(light_for_a_wrong_request_is_stale_at_once)
{
	rest(1);
	billiard_plan_request_t r = request(ON_RED);
	r.balls[0].x += 0.01;
	ask(&r);
	draw(r.id, 0.01);
	rest(3);
	draw(0, 0);
	ck_assert_int_eq(judge->report.stale_light.count, 1);
	ck_assert_double_eq_tol(judge->report.stale_light.max, 3000, 3);
}
END_TEST

START_TEST(a_ring_where_no_ball_is_any_more_is_stale)
{
	static billiard_draw_list_t list;
	rest(1);
	draw_clear(&list);
	draw_ring(&list, ball[1].pos, 2.2 * R, 0.005, 0xffffffff);
	judge_draw(judge, now, &list);
	rest(1);
	ck_assert(!judge->is_stale);
	ball[1].pos.y += 0.05;
	rest(1);
	ck_assert(judge->is_stale);
}
END_TEST

/* Infinity is silent: its light is on for no longer than its last lease said. */
START_TEST(light_ends_with_its_lease)
{
	billiard_lease_t lease = {.seconds = 0.9};
	rest(1);
	billiard_plan_request_t r = request(ON_RED);
	ask(&r);
	draw(r.id, 0.01);
	judge_lease(judge, now, &lease);
	int64_t until = now + 900000;
	truth(true);
	now += 10000;
	int64_t from = now - 10000;
	for (int i = 0; i < 3; i++)
		shot();
	ck_assert(!judge->is_stale);
	ck_assert_int_eq(judge->report.stale_light.count, 1);
	ck_assert_double_eq_tol(judge->report.stale_light.max, 1e-3 * (double)(until - from), 2);
}
END_TEST

START_TEST(a_pot_that_was_proposed_is_made_when_it_falls)
{
	rest(1);
	billiard_plan_request_t r = request(ON_RED);
	ask(&r);
	answer(&r, 0.1, 2);
	draw(r.id, 0.01);
	truth(true);
	gone[2] = true;
	shot();
	rest(1);
	ck_assert_int_eq(judge->report.proposed_pots, 1);
	ck_assert_int_eq(judge->report.made, 1);
	/* the red fell: a colour is on */
	r = request(ON_COLOUR);
	ask(&r);
	r = request(ON_RED);
	r.id++;
	ask(&r);
	ck_assert_int_eq(judge->report.ball_on_wrong, 1);
}
END_TEST

START_TEST(a_cue_ball_that_fell_is_in_hand)
{
	rest(1);
	truth(true);
	gone[0] = true;
	shot();
	gone[0] = false;
	rest(1);
	billiard_plan_request_t r = request(ON_RED);
	ask(&r);
	ck_assert_int_eq(judge->report.in_hand_wrong, 1);
	shot();
	rest(1);
	r = request(ON_RED);
	ask(&r);
	ck_assert_int_eq(judge->report.in_hand_wrong, 1);
}
END_TEST

static void tell_game(const char *process, double on, double in_hand, double moving)
{
	billiard_status_t s = {.metric_count = 3};
	const char *const name[] = {"ball on", "in hand", "moving"};
	const double value[] = {on, in_hand, moving};
	snprintf((char *)s.process, sizeof s.process, "%s", process);
	for (int i = 0; i < 3; i++) {
		snprintf((char *)s.metrics[i].name, sizeof s.metrics[i].name, "%s", name[i]);
		s.metrics[i].value = value[i];
	}
	judge_status(judge, &s);
}

/* A red that fell after a foul: only the table itself knows. */
START_TEST(the_tables_own_word_on_the_game_counts)
{
	rest(1);
	truth(true);
	gone[2] = true;
	shot();
	tell_game("billiard-table", ON_COLOUR, 0, 1); /* of a table in motion: not of this rest */
	rest(1);
	tell_game("billiard-table", ON_RED, 0, 0);
	tell_game("billiard-planner", ON_COLOUR, 1, 0);
	tell_game("billiard-table", 77, 1, 0);
	billiard_plan_request_t r = request(ON_RED);
	ask(&r);
	ck_assert_int_eq(judge->report.ball_on_wrong, 0);
	ck_assert_int_eq(judge->report.in_hand_wrong, 0);
	r.id++, r.on = ON_COLOUR;
	ask(&r);
	ck_assert_int_eq(judge->report.ball_on_wrong, 1);
}
END_TEST

/* Planned from anywhere while it is in the hand. */
START_TEST(a_cue_ball_in_the_hand_lies_nowhere)
{
	gone[0] = true;
	rest(1);
	gone[0] = false;
	billiard_plan_request_t r = request(ON_RED);
	r.in_hand = 1;
	ask(&r);
	ck_assert_int_eq(judge->report.wrong, 0);
}
END_TEST

START_TEST(what_is_seen_at_rest_is_counted_frame_by_frame)
{
	rest(1.5);
	billiard_table_state_t s = {.utime = now - 100000, .calibration = 1};
	s.ball_count = fill(s.balls);
	judge_state(judge, &s);
	s.balls[3].colour = COLOUR_RED;
	judge_state(judge, &s);
	s.occluded = 1;
	judge_state(judge, &s);
	ck_assert_int_eq(judge->report.frames, 2);
	ck_assert_int_eq(judge->report.frames_wrong, 1);
}
END_TEST

START_TEST(shares_of_times)
{
	static struct judge_times t;
	ck_assert_double_eq(judge_times_share(&t, 0.5), 0);
	for (int i = 1; i <= 100; i++)
		t.bin[10 * i]++, t.count++;
	ck_assert_double_eq(judge_times_share(&t, 0.5), 500);
	ck_assert_double_eq(judge_times_share(&t, 0.99), 990);
	ck_assert_double_eq(judge_times_share(&t, 1), 1000);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("judge");
	TCase *run = tcase_create("run");
	tcase_add_checked_fixture(run, set_up, tear_down);
	tcase_add_test(run, a_good_run_is_good);
	tcase_add_test(run, a_wrong_request_is_counted_by_its_cause);
	tcase_add_test(run, up_to_five_millimetres_are_right);
	tcase_add_test(run, a_request_belongs_to_its_frame);
	tcase_add_test(run, a_repeated_request_is_no_second_one);
	tcase_add_test(run, a_rest_in_silence_is_told_once);
	tcase_add_test(run, a_nudged_ball_is_a_new_rest);
	tcase_add_test(run, a_change_of_the_first_shot_counts_once_a_rest);
	tcase_add_test(run, light_for_a_wrong_request_is_stale_at_once);
	tcase_add_test(run, a_ring_where_no_ball_is_any_more_is_stale);
	tcase_add_test(run, light_ends_with_its_lease);
	tcase_add_test(run, a_pot_that_was_proposed_is_made_when_it_falls);
	tcase_add_test(run, a_cue_ball_that_fell_is_in_hand);
	tcase_add_test(run, the_tables_own_word_on_the_game_counts);
	tcase_add_test(run, a_cue_ball_in_the_hand_lies_nowhere);
	tcase_add_test(run, what_is_seen_at_rest_is_counted_frame_by_frame);
	tcase_add_test(run, shares_of_times);
	suite_add_tcase(suite, run);
	return suite;
}
