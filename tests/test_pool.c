/* The worker pool: every item once, on a worker of its own, and all seen by the caller. */
#include "harness.h"

#include <errno.h>
#include <stdatomic.h>

#include "search/plan.h"
#include "search/pool.h"

enum { ITEMS = 1000 };

struct tally {
	int seen[ITEMS]; /* each written by whoever has the item */
	atomic_int busy[PLAN_WORKERS_MAX];
	atomic_int wrong;
	int workers;
};

static void count_item(void *context, int item, int worker)
{
	struct tally *tally = context;
	if (worker < 0 || worker >= tally->workers || atomic_fetch_add(&tally->busy[worker], 1) != 0)
		atomic_fetch_add(&tally->wrong, 1);
	tally->seen[item]++;
	atomic_fetch_sub(&tally->busy[worker], 1);
}

START_TEST(each_item_once)
{
	static const int workers[] = {1, 2, 3, 8, PLAN_WORKERS_MAX};
	struct tally tally = {.workers = workers[_i]};
	struct pool *pool;
	ck_assert_int_eq(pool_create(&pool, tally.workers), 0);
	int want = 0;
	for (int round = 0; round < 200; round++) {
		int count = round % 3 == 0 ? round % 5 : ITEMS;
		pool_for(pool, count, count_item, &tally);
		want += count;
	}
	int sum = 0;
	for (int i = 0; i < ITEMS; i++)
		sum += tally.seen[i];
	ck_assert_int_eq(sum, want);
	for (int i = 5; i < ITEMS; i++)
		ck_assert_int_eq(tally.seen[i], tally.seen[5]);
	ck_assert_int_eq(atomic_load(&tally.wrong), 0);
	pool_destroy(pool);
}
END_TEST

START_TEST(bad_sizes)
{
	struct pool *pool = (struct pool *)1;
	ck_assert_int_eq(pool_create(&pool, 0), -EINVAL);
	ck_assert_ptr_null(pool);
	ck_assert_int_eq(pool_create(&pool, 1000), -EINVAL);
	pool_destroy(NULL);
}
END_TEST

START_TEST(unused_pool_ends)
{
	struct pool *pool;
	for (int i = 0; i < 50; i++) {
		ck_assert_int_eq(pool_create(&pool, 8), 0);
		pool_destroy(pool);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("pool");
	TCase *tc = tcase_create("pool");
	tcase_set_timeout(tc, 60);
	tcase_add_loop_test(tc, each_item_once, 0, 5);
	tcase_add_test(tc, bad_sizes);
	tcase_add_test(tc, unused_pool_ends);
	suite_add_tcase(suite, tc);
	return suite;
}
