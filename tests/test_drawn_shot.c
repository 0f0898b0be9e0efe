#include "app/virtual/drawn_shot.h"

#include <math.h>
#include <string.h>

#include "harness.h"
#include "physics/ball.h"

static struct drawn_shot drawn;
static billiard_plan_t plan;
static billiard_animation_t animation;
static struct shot shot;

static void set_up(void)
{
	memset(&drawn, 0, sizeof drawn);
}

/* An answer with two entries: shots at angle and angle + 1. */
static void answer(int64_t id, int sequence, double angle)
{
	plan = (billiard_plan_t){.request_id = id, .sequence = sequence, .entry_count = 2};
	for (int e = 0; e < 2; e++) {
		plan.entries[e].shot_count = 1;
		plan.entries[e].shots[0] =
			(billiard_plan_shot_t){.angle = angle + e, .speed = 2, .side = 0.1 * sequence};
	}
	drawn_shot_plan(&drawn, &plan);
}

static void animate(int64_t id, double angle)
{
	animation = (billiard_animation_t){.plan_id = id, .ball_count = 2, .keyframe_count = 2};
	animation.colours[0] = COLOUR_RED;
	animation.colours[1] = COLOUR_WHITE;
	animation.keyframes[0] = (billiard_keyframe_t){.ball = 0, .begin = 0.5, .vx = 1};
	animation.keyframes[1] = (billiard_keyframe_t){.ball = 1, .vx = 2 * cos(angle), .vy = 2 * sin(angle)};
}

START_TEST(nothing_is_known_of_what_was_not_answered)
{
	ck_assert(!drawn_shot_find(&drawn, 7, NULL, &shot));
	answer(8, 0, 0.3);
	ck_assert(!drawn_shot_find(&drawn, 7, NULL, &shot));
}
END_TEST

START_TEST(without_an_animation_it_is_the_best_of_the_newest_answer)
{
	answer(7, 0, 0.3);
	answer(7, 1, 0.7);
	animate(6, 0.3);
	ck_assert(drawn_shot_find(&drawn, 7, NULL, &shot));
	ck_assert_double_eq(shot.angle, 0.7);
	ck_assert(drawn_shot_find(&drawn, 7, &animation, &shot));
	ck_assert_double_eq(shot.angle, 0.7);
}
END_TEST

/* A better answer that came and was not drawn, an entry that was stepped to: what moves on the table counts. */
START_TEST(what_is_animated_is_what_is_drawn)
{
	answer(7, 0, 0.3);
	answer(7, 1, 0.7);
	const double angle[] = {0.3, 1.3, 0.7, 1.7};
	for (int i = 0; i < 4; i++) {
		animate(7, angle[i]);
		ck_assert(drawn_shot_find(&drawn, 7, &animation, &shot));
		ck_assert_double_eq(shot.angle, angle[i]);
		ck_assert_double_eq(shot.side, i < 2 ? 0 : 0.1);
	}
	/* the same direction, a turn further */
	animate(7, 0.7 - 2 * acos(-1));
	ck_assert(drawn_shot_find(&drawn, 7, &animation, &shot));
	ck_assert_double_eq(shot.angle, 0.7);
}
END_TEST

START_TEST(a_long_session_fits)
{
	for (int64_t id = 1; id < 50; id++)
		answer(id, 0, 0.01 * (double)id);
	ck_assert(drawn_shot_find(&drawn, 49, NULL, &shot));
	ck_assert_double_eq(shot.angle, 0.49);
	ck_assert(!drawn_shot_find(&drawn, 49 - DRAWN_PLANS, NULL, &shot));
	plan = (billiard_plan_t){.request_id = 99};
	drawn_shot_plan(&drawn, &plan);
	ck_assert(!drawn_shot_find(&drawn, 99, NULL, &shot));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("drawn_shot");
	TCase *tcase = tcase_create("shot");
	tcase_add_checked_fixture(tcase, set_up, NULL);
	tcase_add_test(tcase, nothing_is_known_of_what_was_not_answered);
	tcase_add_test(tcase, without_an_animation_it_is_the_best_of_the_newest_answer);
	tcase_add_test(tcase, what_is_animated_is_what_is_drawn);
	tcase_add_test(tcase, a_long_session_fits);
	suite_add_tcase(suite, tcase);
	return suite;
}
