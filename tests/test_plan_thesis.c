/* The ranked lists that the thesis' own program found (5.6.1 to 5.6.4), in its model with its cost. */
#include "harness.h"
#include "search_scenes.h"
#include "scenes.h"
#include "thesis_lists.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/position.h"

enum { PATH_SIZE = 512 };

/* What our own search reaches of each list; where balls meet several times, theirs turn on lost digits. */
static const struct list {
	const char *situation, *key;
	int rails, depth, speeds, found, in_order;
} list[] = {
	{"situation1", "rails_0_depth_1_speeds_1", 0, 1, 1, 7, 7},
	{"situation1", "rails_0_depth_1_speeds_3", 0, 1, 3, 20, 20},
	{"situation1", "rails_3_depth_1_speeds_1", 3, 1, 1, 31, 10},
	{"situation2", "rails_0_depth_2_speeds_1", 0, 2, 1, 5, 5},
	{"situation2", "rails_3_depth_2_speeds_1", 3, 2, 1, 91, 10},
};

START_TEST(lists_of_the_thesis)
{
	const struct list *l = &list[_i];
	const char *folder = test_data_folder("lists_of_the_thesis");
	if (!folder)
		return;
	char path[PATH_SIZE], err[PATH_SIZE];
	struct table table = scene_thesis_table();
	struct position position;
	snprintf(path, sizeof path, "%s/positions/%s.txt", folder, l->situation);
	ck_assert_msg(position_read(&position, &table, path, err, sizeof err) == 0, "%s", err);
	snprintf(path, sizeof path, "%s/positions/thesis_results.json", folder);
	json_t *all = json_load_file(path, 0, NULL);
	json_t *want = json_object_get(json_object_get(json_object_get(all, l->situation), l->key), "ranked");
	ck_assert_int_gt((int)json_array_size(want), 0);
	struct plan_request request = scene_request(position.ball, position.count);
	request.target = TARGET_COLOUR;
	request.target_colour = COLOUR_RED;
	request.rails = l->rails;
	request.depth = l->depth;
	request.speeds = l->speeds;
	struct planner *planner = scene_planner(&table, "thesis", NULL, 1);
	struct plan_result result = scene_run(planner, &request);
	int found = 0, last = -1;
	for (size_t i = 0; i < json_array_size(want); i++) {
		int rank = thesis_rank(&position, &result, json_array_get(want, i));
		found += rank >= 0;
		if ((int)i < l->in_order) {
			ck_assert_msg(rank > last, "%s %s: number %zu is at %d after %d", l->situation, l->key, i, rank,
				      last);
			last = rank;
		}
	}
	printf("%s %s: %d of %zu, ours %d\n", l->situation, l->key, found, json_array_size(want), result.plan_count);
	ck_assert_int_ge(found, l->found);
	ck_assert(result.exhausted);
	planner_destroy(planner);
	json_decref(all);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("plan_thesis");
	TCase *tc = tcase_create("lists");
	tcase_set_timeout(tc, 60);
	tcase_add_loop_test(tc, lists_of_the_thesis, 0, sizeof list / sizeof list[0]);
	suite_add_tcase(suite, tc);
	return suite;
}
