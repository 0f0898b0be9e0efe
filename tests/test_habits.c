#include "app/virtual/habits.h"

#include <math.h>

#include "harness.h"
#include "scenes.h"

static struct table table;
static struct ball ball[3];
static struct habits habits;
static struct habits_view view;
static struct config_virtual def;
static double now;

static void set_up(void)
{
	table = scene_thesis_table();
	ball[0] = ball_at(COLOUR_WHITE, (vec2){-0.4, 0.1});
	ball[1] = ball_at(COLOUR_RED, (vec2){0.3, 0.2});
	ball[2] = ball_at(COLOUR_BLACK, (vec2){0.8, 0});
	def = (struct config_virtual){
		.seed = 3, .think_time = 1, .habit = {.aim_time = 2, .leave_time = 0.5, .patience = 10}};
	view = (struct habits_view){.ball = ball, .count = 3, .at_rest = true};
	now = 100;
}

static void begin(void)
{
	habits_init(&habits, &table, &def);
}

/* Lets time pass until he strikes, at most so long. NAN: he did not. */
static double strike_within(double seconds, struct shot *shot)
{
	for (double end = now + seconds; now < end; now += 0.05) {
		struct habits_act act = habits_tick(&habits, &view, now);
		if (act.strike) {
			*shot = act.shot;
			return now;
		}
	}
	return NAN;
}

START_TEST(he_thinks_aims_and_strikes_what_is_drawn)
{
	struct shot shot;
	begin();
	ck_assert(isnan(strike_within(5, &shot)));
	view.proposal = 7;
	view.shot = (struct shot){.angle = 0.3, .speed = 2, .side = 0.1};
	double from = now, at = strike_within(20, &shot);
	ck_assert_double_eq_tol(at - from, def.think_time + def.habit.aim_time, 0.2);
	ck_assert_double_eq(shot.angle, 0.3);
	ck_assert_double_eq(shot.side, 0.1);
}
END_TEST

START_TEST(nobody_is_over_the_table_but_when_he_aims_and_leaves)
{
	struct shot shot;
	begin();
	ck_assert(!habits_arm(&habits, &view, now).hand);
	view.proposal = 7;
	view.shot = (struct shot){.angle = 0, .speed = 1};
	strike_within(def.think_time + 0.3, &shot);
	struct table_arm arm = habits_arm(&habits, &view, now);
	ck_assert(arm.cue && arm.hand);
	ck_assert_double_lt(arm.tip.x, ball[0].pos.x - table.ball_radius);
	ck_assert_double_lt(arm.bridge.x, arm.tip.x);
	ck_assert_double_eq_tol(arm.tip.y, ball[0].pos.y, 1e-12);
	ck_assert(!isnan(strike_within(5, &shot)));
	view.at_rest = false;
	ck_assert(habits_arm(&habits, &view, now + 0.1).hand);
	strike_within(def.habit.leave_time + 0.2, &shot);
	ck_assert(!habits_arm(&habits, &view, now).hand);
}
END_TEST

START_TEST(he_never_waits_for_ever)
{
	struct shot shot;
	begin();
	double at = strike_within(60, &shot);
	ck_assert_double_eq_tol(at - 100, def.habit.patience + def.habit.aim_time, 0.3);
	/* a proposal that was played is none any more */
	set_up();
	view.proposal = 9;
	begin();
	ck_assert(!isnan(strike_within(60, &shot)));
	double played = now;
	now += 0.05;
	at = strike_within(60, &shot);
	ck_assert_double_ge(at - played, 2);
	/* without a cue ball nobody can play */
	ball[0].phase = BALL_POTTED;
	now += 0.05;
	ck_assert(isnan(strike_within(60, &shot)));
}
END_TEST

START_TEST(a_second_shot_follows_at_once)
{
	struct shot shot;
	def.habit.quick = 1;
	view.proposal = 7;
	begin();
	ck_assert(!isnan(strike_within(20, &shot)));
	view.at_rest = false;
	now += 0.05;
	ck_assert(isnan(strike_within(3, &shot)));
	view.at_rest = true;
	double from = now;
	ck_assert_double_lt(strike_within(20, &shot) - from, 0.3);
	/* but not a third one */
	view.at_rest = false;
	now += 0.05;
	strike_within(1, &shot);
	view.at_rest = true;
	from = now;
	view.proposal = 8;
	ck_assert_double_ge(strike_within(20, &shot) - from, 1);
}
END_TEST

START_TEST(a_touched_ball_stays_free_and_near)
{
	def.habit.touch = 1;
	def.habit.patience = 0;
	int touched = 0;
	for (uint64_t seed = 1; seed < 40; seed++) {
		set_up();
		def.habit.touch = 1;
		def.seed = seed;
		begin();
		for (int i = 0; i < 100; i++, now += 0.05) {
			struct habits_act act = habits_tick(&habits, &view, now);
			if (act.touched < 0)
				continue;
			touched++;
			double far = vec2_dist(act.to, ball[act.touched].pos);
			ck_assert(far > 0.0029 && far < 0.0301);
		}
		ck_assert(!habits_arm(&habits, &view, now).hand);
	}
	ck_assert_int_gt(touched, 20);
	ck_assert_int_lt(touched, 40);
}
END_TEST

START_TEST(the_same_seed_is_the_same_person)
{
	def.habit.other = 0.5;
	def.habit.wipe = 0.5;
	view.proposal = 7;
	struct habits other;
	begin();
	habits_init(&other, &table, &def);
	for (int i = 0; i < 2000; i++, now += 0.05) {
		struct habits_act a = habits_tick(&habits, &view, now), b = habits_tick(&other, &view, now);
		ck_assert(a.strike == b.strike && a.touched == b.touched);
		if (a.strike) {
			ck_assert_double_eq(a.shot.angle, b.shot.angle);
			view.proposal++;
		}
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("habits");
	TCase *person = tcase_create("person");
	tcase_add_checked_fixture(person, set_up, NULL);
	tcase_add_test(person, he_thinks_aims_and_strikes_what_is_drawn);
	tcase_add_test(person, nobody_is_over_the_table_but_when_he_aims_and_leaves);
	tcase_add_test(person, he_never_waits_for_ever);
	tcase_add_test(person, a_second_shot_follows_at_once);
	tcase_add_test(person, a_touched_ball_stays_free_and_near);
	tcase_add_test(person, the_same_seed_is_the_same_person);
	suite_add_tcase(suite, person);
	return suite;
}
