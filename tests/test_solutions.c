/* The list of best sequences: order, limit, ties. */
#include "harness.h"

#include <stdlib.h>

#include "search/solutions.h"

START_TEST(keeps_the_best_in_order)
{
	struct random random = random_begin("keeps_the_best_in_order");
	struct solutions *list = calloc(1, sizeof *list);
	double all[500];
	for (int limit = 1; limit <= 60; limit += 7) {
		list->count = 0;
		list->limit = limit;
		for (int i = 0; i < 500; i++) {
			struct solution s = {.cost = (double)(random_u64(&random) % 200), .key = random_u64(&random)};
			all[i] = s.cost;
			bool full = list->count == limit;
			double worst = full ? solutions_at(list, limit - 1)->cost : INFINITY;
			bool kept = solutions_add(list, &s);
			if (s.cost != worst)
				ck_assert_int_eq(kept, s.cost < worst);
		}
		ck_assert_int_eq(list->count, limit);
		for (int rank = 0; rank < limit; rank++) {
			double cost = solutions_at(list, rank)->cost;
			int below = 0, at_most = 0;
			for (int i = 0; i < 500; i++) {
				below += all[i] < cost;
				at_most += all[i] <= cost;
			}
			ck_assert(below <= rank && rank < at_most);
		}
	}
	free(list);
}
END_TEST

/* Equal costs: the key decides, whatever came first. */
START_TEST(ties_do_not_depend_on_the_order)
{
	struct random random = random_begin("ties_do_not_depend_on_the_order");
	struct solutions *list = calloc(1, sizeof *list);
	uint64_t want[8] = {0};
	for (int round = 0; round < 20; round++) {
		uint64_t key[30];
		for (int i = 0; i < 30; i++)
			key[i] = (uint64_t)i * 977;
		for (int i = 29; i > 0; i--) {
			int k = (int)(random_u64(&random) % (uint64_t)(i + 1));
			uint64_t swap = key[i];
			key[i] = key[k];
			key[k] = swap;
		}
		list->count = 0;
		list->limit = 8;
		for (int i = 0; i < 30; i++)
			solutions_add(list, &(struct solution){.cost = 1, .key = key[i]});
		for (int i = 0; i < 8; i++) {
			if (round == 0)
				want[i] = solutions_at(list, i)->key;
			ck_assert_uint_eq(solutions_at(list, i)->key, want[i]);
		}
	}
	free(list);
}
END_TEST

/* What makes two solutions different makes their keys different: ties are ordered by them. */
START_TEST(keys_tell_solutions_apart)
{
	static struct state state[1];
	struct task task = {.state = state};
	struct record record = {
		.shot = {.angle = 0.5, .speed = 1}, .target = 3, .pocket = 2, .chain_count = 1, .chain = {4}};
	uint64_t key[6];
	key[0] = solution_make(&task, 0, &record).key;
	ck_assert_uint_eq(solution_make(&task, 0, &record).key, key[0]);
	struct record other[5] = {record, record, record, record, record};
	other[0].pocket = 1;
	other[1].target = 2;
	other[2].shot.angle = 0.6;
	other[3].shot.speed = 2;
	other[4].chain[0] = 5;
	for (int i = 0; i < 5; i++) {
		key[i + 1] = solution_make(&task, 0, &other[i]).key;
		for (int k = 0; k <= i; k++)
			ck_assert_uint_ne(key[i + 1], key[k]);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("solutions");
	TCase *tc = tcase_create("solutions");
	tcase_add_test(tc, keeps_the_best_in_order);
	tcase_add_test(tc, ties_do_not_depend_on_the_order);
	tcase_add_test(tc, keys_tell_solutions_apart);
	suite_add_tcase(suite, tc);
	return suite;
}
