#include "app/light/lease.h"

#include "app/light/draw.h"
#include "harness.h"

static struct lease lease;

static void setup(void)
{
	lease = (struct lease){0};
}

static void take(int64_t seq, double now)
{
	lease_take(&lease, &(billiard_lease_t){.seq = seq, .seconds = 0.9}, now);
}

START_TEST(pictures_without_a_lease_stay)
{
	ck_assert(!lease_is_over(&lease, 0) && !lease_is_over(&lease, 1e9));
	lease_picture(&lease, 5, 10);
	ck_assert(!lease_is_over(&lease, 1e9));
}
END_TEST

START_TEST(a_lease_that_is_renewed_goes_on_and_ends_when_it_is_not)
{
	lease_picture(&lease, 5, 10);
	for (double t = 10; t < 20; t += 0.25) {
		take(5, t);
		ck_assert(!lease_is_over(&lease, t + 0.8));
	}
	ck_assert(!lease_is_over(&lease, 19.75 + 0.89));
	ck_assert(lease_is_over(&lease, 19.75 + 0.91));
	/* It comes back with the next picture, or the next lease for this one. */
	lease_picture(&lease, 6, 30);
	ck_assert(!lease_is_over(&lease, 30.5));
	ck_assert(lease_is_over(&lease, 31));
	take(6, 32);
	ck_assert(!lease_is_over(&lease, 32.5));
}
END_TEST

/* The new picture was lost on the way: the old one is not kept alive by its lease. */
START_TEST(a_lease_for_another_picture_renews_nothing)
{
	lease_picture(&lease, 5, 10);
	take(5, 10);
	for (double t = 10.25; t < 12; t += 0.25)
		take(6, t);
	ck_assert(lease_is_over(&lease, 11));
	lease_picture(&lease, 6, 12);
	ck_assert(!lease_is_over(&lease, 12.5));
}
END_TEST

START_TEST(the_notice_is_one_line_beside_the_bed)
{
	static billiard_draw_list_t list;
	lease_notice(&list, 0.943);
	ck_assert(draw_check(&list) && list.item_count == 1 && list.items[0].kind == DRAW_TEXT);
	ck_assert_double_lt(list.ys[0] + list.items[0].radius, -0.943 / 2);
	ck_assert_int_eq(list.plan_id, 0);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("lease");
	TCase *all = tcase_create("all");
	tcase_add_checked_fixture(all, setup, NULL);
	tcase_add_test(all, pictures_without_a_lease_stay);
	tcase_add_test(all, a_lease_that_is_renewed_goes_on_and_ends_when_it_is_not);
	tcase_add_test(all, a_lease_for_another_picture_renews_nothing);
	tcase_add_test(all, the_notice_is_one_line_beside_the_bed);
	suite_add_tcase(suite, all);
	return suite;
}
