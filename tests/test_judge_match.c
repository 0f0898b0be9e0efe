#include "app/virtual/judge_match.h"

#include "app/process/ball_message.h"
#include "harness.h"

static const double D = 0.0523;

static void add(struct judge_position *p, enum ball_colour colour, double x, double y)
{
	p->ball[p->count].at = (vec2){x, y};
	p->ball[p->count++].colour = colour;
}

static struct judge_position three(void)
{
	struct judge_position p = {0};
	add(&p, COLOUR_WHITE, -0.3, 0);
	add(&p, COLOUR_RED, 0.2, 0.1);
	add(&p, COLOUR_BLACK, 0.2 + D, 0.1);
	return p;
}

static struct judge_match match_of(const struct judge_position *real, const struct judge_position *believed)
{
	struct judge_match m;
	judge_match(real, believed, D, &m);
	return m;
}

START_TEST(the_same_position_has_no_fault_in_any_order)
{
	struct judge_position real = three(), turned = {0};
	for (int i = real.count; i-- > 0;)
		add(&turned, real.ball[i].colour, real.ball[i].at.x + 0.001, real.ball[i].at.y);
	struct judge_match m = match_of(&real, &turned);
	ck_assert_int_eq(m.missing + m.extra + m.doubles + m.colour_wrong, 0);
	ck_assert_double_eq_tol(m.max_error, 0.001, 1e-12);
	for (int i = 0; i < 3; i++)
		ck_assert_int_eq(m.believed_of[i], 2 - i);
}
END_TEST

START_TEST(each_fault_is_told_by_its_kind)
{
	struct judge_position real = three(), p = three();
	p.ball[2].colour = COLOUR_BLUE;
	ck_assert_int_eq(match_of(&real, &p).colour_wrong, 1);
	p = three();
	p.ball[1].at.x -= 0.0215;
	struct judge_match m = match_of(&real, &p);
	ck_assert_double_eq_tol(m.max_error, 0.0215, 1e-12);
	ck_assert_int_eq(m.missing + m.extra + m.colour_wrong, 0);
	p = three();
	p.count = 2;
	m = match_of(&real, &p);
	ck_assert_int_eq(m.missing, 1);
	ck_assert_int_eq(m.extra, 0);
	p = three();
	add(&p, COLOUR_RED, -0.8, -0.3);
	m = match_of(&real, &p);
	ck_assert_int_eq(m.extra, 1);
	ck_assert_int_eq(m.doubles, 0);
}
END_TEST

/* One ball in two tracks: both are pushed apart until they touch. */
START_TEST(a_ball_seen_twice_is_a_double)
{
	struct judge_position real = three(), p = three();
	p.ball[0].at.x -= D / 2;
	add(&p, COLOUR_WHITE, -0.3 + D / 2, 0);
	struct judge_match m = match_of(&real, &p);
	ck_assert_int_eq(m.extra, 1);
	ck_assert_int_eq(m.doubles, 1);
	ck_assert_int_eq(m.missing, 0);
}
END_TEST

START_TEST(an_empty_table_and_an_empty_belief)
{
	struct judge_position real = three(), none = {0};
	ck_assert_int_eq(match_of(&real, &none).missing, 3);
	ck_assert_int_eq(match_of(&none, &real).extra, 3);
	ck_assert_int_eq(match_of(&none, &none).missing, 0);
}
END_TEST

START_TEST(potted_balls_are_no_balls)
{
	struct judge_position p = three();
	billiard_ball_t ball[3];
	for (int i = 0; i < 3; i++) {
		struct ball b = ball_at(COLOUR_RED, (vec2){0.1 * i, 0});
		b.phase = i == 1 ? BALL_POTTED : BALL_REST;
		ball_to_message(&ball[i], &b, "", i + 1);
	}
	judge_position_from(&p, ball, 3);
	ck_assert_int_eq(p.count, 2);
	ck_assert_int_eq(p.ball[1].track, 3);
	judge_position_from(&p, ball, 0);
	ck_assert_int_eq(p.count, 0);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("judge_match");
	TCase *match = tcase_create("match");
	tcase_add_test(match, the_same_position_has_no_fault_in_any_order);
	tcase_add_test(match, each_fault_is_told_by_its_kind);
	tcase_add_test(match, a_ball_seen_twice_is_a_double);
	tcase_add_test(match, an_empty_table_and_an_empty_belief);
	tcase_add_test(match, potted_balls_are_no_balls);
	suite_add_tcase(suite, match);
	return suite;
}
