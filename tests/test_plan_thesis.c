/* The ranked lists that the thesis' own program found (5.6.1 to 5.6.4), in its model with its cost. */
#include "harness.h"
#include "search_scenes.h"
#include "scenes.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/position.h"

enum { PATH_SIZE = 512 };
static const double degree = M_PI / 180;

/* What our own search reaches of each list; theirs lose digits where balls meet several times. */
static const struct list {
	const char *situation, *key;
	int rails, depth, speeds, found, in_order;
} list[] = {
	{"situation1", "rails_0_depth_1_speeds_1", 0, 1, 1, 7, 7},
	{"situation1", "rails_0_depth_1_speeds_3", 0, 1, 3, 20, 20},
	{"situation1", "rails_3_depth_1_speeds_1", 3, 1, 1, 31, 10},
	{"situation2", "rails_0_depth_2_speeds_1", 0, 2, 1, 5, 5},
	{"situation2", "rails_3_depth_2_speeds_1", 3, 2, 1, 83, 10},
};

static bool potted_same(const struct position *position, const struct plan_shot *shot, json_t *potted)
{
	if (json_array_size(potted) != (size_t)shot->potted_count)
		return false;
	for (int i = 0; i < shot->potted_count; i++) {
		bool found = false;
		for (size_t k = 0; k < json_array_size(potted); k++)
			found |= strcmp(json_string_value(json_array_get(json_array_get(potted, k), 0)),
					position->name[shot->potted[i].ball]) == 0;
		if (!found)
			return false;
	}
	return true;
}

static bool shot_same(const struct position *position, const struct plan_shot *shot, json_t *want)
{
	double angle = json_number_value(json_object_get(want, "angle_deg"));
	double speed = json_number_value(json_object_get(want, "speed_mm_s"));
	return fabs(remainder(shot->shot.angle / degree - angle, 360)) <= 0.2 &&
	       fabs(1000 * shot->shot.speed / speed - 1) <= 0.02 &&
	       potted_same(position, shot, json_object_get(want, "potted"));
}

/* Rank of the wanted sequence in ours, -1 when it is not there. */
static int rank_of(const struct position *position, const struct plan_result *result, json_t *want)
{
	json_t *shots = json_object_get(want, "shots");
	for (int i = 0; i < result->plan_count; i++) {
		const struct plan *plan = &result->plan[i];
		bool same = json_array_size(shots) == (size_t)plan->shot_count;
		for (int s = 0; same && s < plan->shot_count; s++)
			same = shot_same(position, &plan->shot[s], json_array_get(shots, (size_t)s));
		if (same)
			return i;
	}
	return -1;
}

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
		int rank = rank_of(&position, &result, json_array_get(want, i));
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
