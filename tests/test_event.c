#include "harness.h"

#include <string.h>

#include "physics/event.h"

/* Few values, so that every kind of tie occurs. */
static struct event random_event(struct random *r)
{
	return (struct event){(double)(random_u64(r) % 3), (enum event_kind)(random_u64(r) % 3 + EVENT_BALL_BALL),
			      (int16_t)(random_u64(r) % 3), (int16_t)((int)(random_u64(r) % 3) - 1)};
}

static int sign(int x)
{
	return (x > 0) - (x < 0);
}

START_TEST(order_is_strict_and_total)
{
	struct random r = random_begin("order_is_strict_and_total");
	for (int i = 0; i < 20000; i++) {
		struct event a = random_event(&r), b = random_event(&r), c = random_event(&r);
		bool same = a.time == b.time && a.kind == b.kind && a.ball == b.ball && a.other == b.other;
		ck_assert((event_compare(&a, &b) == 0) == same);
		ck_assert_int_eq(sign(event_compare(&a, &b)), -sign(event_compare(&b, &a)));
		if (event_compare(&a, &b) < 0 && event_compare(&b, &c) < 0)
			ck_assert_int_lt(event_compare(&a, &c), 0);
	}
	struct event a = {1, EVENT_ROLLING_REST, 0, -1}, b = {1, EVENT_BALL_BALL, 5, 6},
		     c = {0.5, EVENT_SPINNING_REST, 9, -1};
	ck_assert_int_lt(event_compare(&b, &a), 0);
	ck_assert_int_lt(event_compare(&c, &b), 0);
}
END_TEST

START_TEST(kinds_have_names)
{
	ck_assert_str_eq(event_kind_name(EVENT_BALL_BALL), "ball_ball");
	ck_assert_str_eq(event_kind_name(EVENT_CUSHION), "ball_linear_cushion");
	ck_assert_str_eq(event_kind_name(EVENT_JAW), "ball_circular_cushion");
	ck_assert_str_eq(event_kind_name(EVENT_POCKET), "ball_pocket");
	ck_assert_str_eq(event_kind_name(EVENT_SLIDING_ROLLING), "sliding_rolling");
	ck_assert_str_eq(event_kind_name(EVENT_ROLLING_SPINNING), "rolling_spinning");
	ck_assert_str_eq(event_kind_name(EVENT_ROLLING_REST), "rolling_stationary");
	ck_assert_str_eq(event_kind_name(EVENT_SPINNING_REST), "spinning_stationary");
	ck_assert_str_eq(event_kind_name((enum event_kind)99), "none");
	for (int i = 0; i < EVENT_KIND_COUNT; i++) {
		for (int k = 0; k < i; k++)
			ck_assert_str_ne(event_kind_name((enum event_kind)i), event_kind_name((enum event_kind)k));
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("event");
	TCase *tcase = tcase_create("event");
	tcase_add_test(tcase, order_is_strict_and_total);
	tcase_add_test(tcase, kinds_have_names);
	suite_add_tcase(suite, tcase);
	return suite;
}
