/* The open nodes: order, fixed memory. */
#include "harness.h"

#include <errno.h>

#include "search/frontier.h"

enum { EACH = sizeof(struct node) + sizeof(struct frontier_entry) + sizeof(uint32_t) };

START_TEST(best_first_and_stable)
{
	struct random random = random_begin("best_first_and_stable");
	struct frontier frontier;
	ck_assert_int_eq(frontier_init(&frontier, 5000 * EACH), 0);
	for (int round = 0; round < 3; round++) {
		frontier_clear(&frontier);
		ck_assert(isinf(frontier_best(&frontier)));
		for (uint32_t i = 0; i < 5000; i++) {
			struct node node = {.cost = (double)(random_u64(&random) % 100), .state = i};
			frontier_push(&frontier, &node);
			/* leave some early, so that slots are used again */
			if (i % 7 == 6)
				frontier_pop(&frontier);
		}
		struct node last = {.cost = -1};
		while (frontier.count > 0) {
			ck_assert(frontier_best(&frontier) >= last.cost);
			struct node node = frontier_pop(&frontier);
			ck_assert(node.cost > last.cost || node.state > last.state);
			last = node;
		}
		ck_assert(!frontier.overflow);
	}
	frontier_finish(&frontier);
}
END_TEST

static void check_order(const int cost[], int count)
{
	struct frontier frontier;
	ck_assert_int_eq(frontier_init(&frontier, 8 * EACH), 0);
	for (int i = 0; i < count; i++)
		frontier_push(&frontier, &(struct node){.cost = cost[i]});
	for (int i = 0; i < count; i++)
		ck_assert_double_eq(frontier_pop(&frontier).cost, i);
	frontier_finish(&frontier);
}

/* Every order in which up to seven can come: a heap goes wrong at its ends. */
START_TEST(every_order_of_a_few)
{
	for (int count = 1, orders = 1; count <= 7; count++, orders *= count)
		for (int k = 0; k < orders; k++) {
			int cost[7], rest = k;
			for (int i = 0; i < count; i++) {
				int at = rest % (i + 1);
				rest /= i + 1;
				cost[i] = cost[at];
				cost[at] = i;
			}
			check_order(cost, count);
		}
}
END_TEST

START_TEST(full_keeps_the_best)
{
	struct random random = random_begin("full_keeps_the_best");
	struct frontier frontier;
	ck_assert_int_eq(frontier_init(&frontier, 100 * EACH), 0);
	double best = INFINITY;
	for (int i = 0; i < 10000; i++) {
		struct node node = {.cost = random_in(&random, 0, 1)};
		best = fmin(best, node.cost);
		frontier_push(&frontier, &node);
		ck_assert_double_eq(frontier_best(&frontier), best);
		ck_assert_int_le(frontier.count, 100);
	}
	ck_assert(frontier.overflow);
	frontier_finish(&frontier);
}
END_TEST

START_TEST(too_small)
{
	struct frontier frontier;
	ck_assert_int_eq(frontier_init(&frontier, 1), -EINVAL);
	frontier_finish(&frontier);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("frontier");
	TCase *tc = tcase_create("frontier");
	tcase_set_timeout(tc, 30);
	tcase_add_test(tc, best_first_and_stable);
	tcase_add_test(tc, every_order_of_a_few);
	tcase_add_test(tc, full_keeps_the_best);
	tcase_add_test(tc, too_small);
	suite_add_tcase(suite, tc);
	return suite;
}
