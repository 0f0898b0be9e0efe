#include "app/light/animation.h"

#include <math.h>
#include <string.h>

#include "app/light/keyframe.h"
#include "app/process/message_table.h"
#include "harness.h"

static billiard_animation_t message;
static struct animation animation;
static bool changed;

static void setup(void)
{
	memset(&message, 0, sizeof message);
	memset(&animation, 0, sizeof animation);
	message.utime = 5;
	message.plan_id = 7;
	message.run = 1;
	message.rate = 2;
	message.pause = 1;
	message.ball_count = 2;
	message.keyframe_count = 2;
	message.keyframes[0] = (billiard_keyframe_t){.end = 4, .vx = 0.5};
	message.keyframes[1] = (billiard_keyframe_t){.begin = 1, .end = 3, .ball = 1};
}

START_TEST(repeated_messages_do_not_begin_it_anew)
{
	ck_assert(!animation_is_shown(&animation) && !animation_runs(&animation));
	ck_assert(animation_take(&animation, &message, 10, &changed) && changed);
	ck_assert(animation_is_shown(&animation) && animation_runs(&animation));
	ck_assert_double_eq(animation_time(&animation, 11), 2);
	ck_assert(animation_take(&animation, &message, 11, &changed) && !changed);
	ck_assert_double_eq(animation_time(&animation, 11.5), 3);
}
END_TEST

/* A restart carries the same motion: only its time tells. */
START_TEST(a_restart_begins_it_anew)
{
	animation_take(&animation, &message, 10, &changed);
	message.utime++;
	ck_assert(animation_take(&animation, &message, 11.5, &changed) && changed);
	ck_assert_double_eq(animation_time(&animation, 11.5), 0);
	message.utime++;
	message.position = 1.5;
	ck_assert(animation_take(&animation, &message, 12, &changed) && changed);
	ck_assert_double_eq(animation_time(&animation, 12), 1.5);
}
END_TEST

START_TEST(another_motion_replaces_it_whatever_its_time)
{
	animation_take(&animation, &message, 10, &changed);
	message.keyframes[0].vx = 0.25;
	ck_assert(animation_take(&animation, &message, 11, &changed) && changed);
	ck_assert_double_eq(animation.message.keyframes[0].vx, 0.25);
	message.keyframe_count = 1;
	ck_assert(animation_take(&animation, &message, 11, &changed) && changed);
	message.plan_id = 8;
	ck_assert(animation_take(&animation, &message, 11, &changed) && changed);
	message.keyframe_count = 0;
	ck_assert(animation_take(&animation, &message, 11, &changed) && changed);
	ck_assert(!animation_is_shown(&animation) && !animation_runs(&animation));
}
END_TEST

START_TEST(a_standing_one_stands)
{
	message.run = 0;
	message.position = 2.5;
	animation_take(&animation, &message, 10, &changed);
	ck_assert(animation_is_shown(&animation) && !animation_runs(&animation));
	ck_assert_double_eq(animation_time(&animation, 99), 2.5);
}
END_TEST

START_TEST(contradictory_ones_change_nothing)
{
	static struct animation before;
	animation_take(&animation, &message, 10, &changed);
	before = animation;
	message.utime++;
	message.ball_count = 1; /* a keyframe names the other */
	ck_assert(!animation_take(&animation, &message, 11, &changed) && !changed);
	message.ball_count = 2;
	message.keyframes[1].end = 0.5;
	ck_assert(!animation_take(&animation, &message, 11, &changed) && !changed);
	ck_assert_int_eq(memcmp(&animation, &before, sizeof before), 0);
}
END_TEST

/* ---- keyframes --------------------------------------------------------------------------------------------------- */

START_TEST(keyframes_stay_on_the_table)
{
	struct random random = random_begin("keyframe");
	int refused = 0;
	for (int i = 0; i < 20000; i++) {
		billiard_keyframe_t k = {.begin = random_in(&random, 0, 5), .ball = 3};
		k.end = k.begin + random_in(&random, 0, 4);
		k.x = random_in(&random, -MESSAGE_PLACE_MAX, MESSAGE_PLACE_MAX);
		k.vx = random_in(&random, -9, 9);
		k.ax = i % 5 ? random_in(&random, -9, 9) : 0;
		bool ok = keyframe_check(&k, 4);
		/* The judge: looked at step by step, a hair beyond what is allowed. */
		double farthest = 0;
		for (int n = 0; n <= 200; n++)
			farthest = fmax(farthest, fabs(keyframe_at(&k, (k.end - k.begin) * n / 200).x));
		ck_assert(!ok || farthest <= MESSAGE_PLACE_MAX + 1e-9);
		ck_assert(ok || farthest > MESSAGE_PLACE_MAX - 0.01);
		refused += !ok;
		billiard_keyframe_t across = {
			.begin = k.begin, .end = k.end, .ball = 3, .y = k.x, .vy = k.vx, .ay = k.ax};
		ck_assert_int_eq(keyframe_check(&across, 4), ok);
	}
	ck_assert(refused > 1000 && refused < 19000);
}
END_TEST

START_TEST(keyframes_name_a_ball_and_end_after_they_begin)
{
	billiard_keyframe_t k = {.begin = 1, .end = 1, .ball = 3};
	ck_assert(keyframe_check(&k, 4) && !keyframe_check(&k, 3));
	k.end = nextafter(1, 0);
	ck_assert(!keyframe_check(&k, 4));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("animation");
	TCase *taken = tcase_create("taken");
	tcase_add_checked_fixture(taken, setup, NULL);
	tcase_add_test(taken, repeated_messages_do_not_begin_it_anew);
	tcase_add_test(taken, a_restart_begins_it_anew);
	tcase_add_test(taken, another_motion_replaces_it_whatever_its_time);
	tcase_add_test(taken, a_standing_one_stands);
	tcase_add_test(taken, contradictory_ones_change_nothing);
	tcase_add_test(taken, keyframes_stay_on_the_table);
	tcase_add_test(taken, keyframes_name_a_ball_and_end_after_they_begin);
	suite_add_tcase(suite, taken);
	return suite;
}
