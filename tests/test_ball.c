#include "harness.h"

#include <math.h>

#include "physics/ball.h"

START_TEST(colours_have_names)
{
	for (int i = 0; i < COLOUR_COUNT; i++) {
		enum ball_colour back = COLOUR_COUNT;
		ck_assert(ball_colour_from_name(ball_colour_name((enum ball_colour)i), &back));
		ck_assert_int_eq((int)back, i);
	}
	enum ball_colour colour = COLOUR_PINK;
	ck_assert(!ball_colour_from_name("red", &colour));
	ck_assert(!ball_colour_from_name("", &colour));
	ck_assert_int_eq(colour, COLOUR_PINK);
	ck_assert_str_eq(ball_colour_name((enum ball_colour)99), "UNKNOWN");
	ck_assert_str_eq(ball_colour_name((enum ball_colour)(-1)), "UNKNOWN");
}
END_TEST

START_TEST(phases_have_names)
{
	ck_assert_str_eq(ball_phase_name(BALL_REST), "REST");
	ck_assert_str_eq(ball_phase_name(BALL_POTTED), "POTTED");
	ck_assert_str_eq(ball_phase_name((enum ball_phase)99), "UNKNOWN");
}
END_TEST

START_TEST(finite_means_every_number)
{
	struct ball ball = ball_at(COLOUR_RED, (vec2){1, 2});
	ck_assert(ball_is_finite(&ball));
	ck_assert_int_eq(ball.phase, BALL_REST);
	double *number[] = {&ball.pos.x,   &ball.pos.y,	  &ball.vel.x,	&ball.vel.y,
			    &ball.spin[0], &ball.spin[1], &ball.spin[2]};
	for (int i = 0; i < 7; i++) {
		double keep = *number[i];
		*number[i] = NAN;
		ck_assert(!ball_is_finite(&ball));
		*number[i] = -INFINITY;
		ck_assert(!ball_is_finite(&ball));
		*number[i] = keep;
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("ball");
	TCase *tcase = tcase_create("ball");
	tcase_add_test(tcase, colours_have_names);
	tcase_add_test(tcase, phases_have_names);
	tcase_add_test(tcase, finite_means_every_number);
	suite_add_tcase(suite, tcase);
	return suite;
}
