/* The queue against a plain list. */
#include "harness.h"

#include <math.h>

#include "physics/queue.h"

struct list {
	struct event own[BALL_MAX];
	double pair[BALL_MAX][BALL_MAX];
};

static bool list_first(const struct list *list, int count, struct event *event)
{
	bool found = false;
	for (int i = 0; i < count; i++) {
		if (list->own[i].time < INFINITY && (!found || event_compare(&list->own[i], event) < 0)) {
			*event = list->own[i];
			found = true;
		}
		for (int k = 0; k < i; k++) {
			struct event e = {list->pair[k][i], EVENT_BALL_BALL, (int16_t)k, (int16_t)i};
			if (e.time < INFINITY && (!found || event_compare(&e, event) < 0)) {
				*event = e;
				found = true;
			}
		}
	}
	return found;
}

/* Few different times, so that ties are common. */
static double random_time(struct random *r)
{
	return random_u64(r) % 3 == 0 ? INFINITY : (double)(random_u64(r) % 6);
}

START_TEST(agrees_with_a_list)
{
	struct random r = random_begin("agrees_with_a_list");
	for (int round = 0; round < 300; round++) {
		int count = 1 + (int)(random_u64(&r) % BALL_MAX);
		static struct queue queue;
		static struct list list;
		queue_init(&queue, count);
		struct event got, want;
		ck_assert(!queue_first(&queue, &got));
		for (int i = 0; i < BALL_MAX; i++) {
			list.own[i].time = INFINITY;
			for (int k = 0; k < BALL_MAX; k++)
				list.pair[k][i] = INFINITY;
		}
		for (int n = 0; n < 300; n++) {
			int a = (int)(random_u64(&r) % (unsigned)count), b = (int)(random_u64(&r) % (unsigned)count);
			double time = random_time(&r);
			if (a == b) {
				enum event_kind kind = random_u64(&r) & 1 ? EVENT_CUSHION : EVENT_ROLLING_REST;
				list.own[a] = (struct event){time, kind, (int16_t)a, (int16_t)(random_u64(&r) % 3)};
				queue_set_own(&queue, a, &list.own[a]);
			} else {
				int low = a < b ? a : b, high = a < b ? b : a;
				list.pair[low][high] = time;
				queue_set_pair(&queue, low, high, time);
				ck_assert(queue_pair(&queue, low, high) == time);
			}
			bool found = list_first(&list, count, &want);
			ck_assert(queue_first(&queue, &got) == found);
			ck_assert(!found || event_compare(&got, &want) == 0);
		}
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("queue");
	TCase *tcase = tcase_create("queue");
	tcase_add_test(tcase, agrees_with_a_list);
	suite_add_tcase(suite, tcase);
	return suite;
}
