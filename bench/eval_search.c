/* What the search finds, beside two judges: the lists of the thesis' own program, and playing everything forward. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/position.h"
#include "brute_force.h"
#include "report.h"
#include "scenes.h"
#include "search_scenes.h"
#include "thesis_lists.h"

enum { PATH_SIZE = 512, TOP = 10 };
static const double degree = M_PI / 180;

/* ---- the lists of the thesis' program
 * ---------------------------------------------------------------------------------- */

static void compare_list(struct report *report, struct planner *planner, const struct position *position,
			 const char *name, const char *key, const json_t *want)
{
	struct plan_request request = scene_request(position->ball, position->count);
	request.target = TARGET_COLOUR;
	request.target_colour = COLOUR_RED;
	if (sscanf(key, "rails_%d_depth_%d_speeds_%d", &request.rails, &request.depth, &request.speeds) != 3)
		return;
	struct plan_result result = scene_run(planner, &request);
	const json_t *ranked = json_object_get(want, "ranked");
	int found = 0, last = -1, size = (int)json_array_size(ranked);
	bool in_order = true;
	for (int i = 0; i < size; i++) {
		int rank = thesis_rank(position, &result, json_array_get(ranked, (size_t)i));
		found += rank >= 0;
		if (i < TOP) {
			in_order &= rank > last;
			last = rank;
		}
	}
	char label[128];
	snprintf(label, sizeof label, "plan.%s.%s.found_share", name, key);
	report_number(report, label, (double)found / size, "1");
	snprintf(label, sizeof label, "plan.%s.%s.first_in_order", name, key);
	report_number(report, label, in_order, "1");
}

static void eval_lists(struct report *report, const char *data)
{
	char path[PATH_SIZE], err[PATH_SIZE];
	struct table table = scene_thesis_table();
	snprintf(path, sizeof path, "%s/positions/thesis_results.json", data);
	json_t *all = json_load_file(path, 0, NULL);
	if (!all) {
		printf("SKIPPED, no lists at %s\n", path);
		return;
	}
	struct planner *planner = scene_planner(&table, "thesis", NULL, 1);
	const char *name, *key;
	json_t *lists, *want;
	json_object_foreach(all, name, lists)
	{
		struct position position;
		snprintf(path, sizeof path, "%s/positions/%s.txt", data, name);
		if (position_read(&position, &table, path, err, sizeof err) < 0) {
			printf("SKIPPED: %s\n", err);
			continue;
		}
		json_object_foreach(lists, key, want) compare_list(report, planner, &position, name, key, want);
	}
	planner_destroy(planner);
	json_decref(all);
}

/* ---- playing everything forward
 * ---------------------------------------------------------------------------------------- */

static void eval_complete(struct report *report, const char *model, int positions)
{
	static const struct brute_fan fan = {.angles = 1440, .speed = {1, 2, 3.5, 5}, .speed_count = 4};
	struct random random = random_begin("completeness");
	struct table table = scene_thesis_table();
	struct cost_profile all = brute_profile();
	struct planner *planner[2] = {scene_planner(&table, model, &all, 1), scene_planner(&table, model, NULL, 1)};
	struct model m;
	if (!model_from_name(model, &m))
		return;
	int pots = 0, missing[2] = {0, 0}, proposed = 0;
	for (int n = 0; n < positions; n++) {
		struct ball ball[BALL_MAX];
		struct brute_result brute;
		int count = 2 + n % 11;
		scene_random(&random, &table, 0.002, ball, count);
		brute_force(&table, &m, ball, count, &fan, cost_profile_thesis().clearance, &brute);
		for (int p = 0; p < 2; p++) {
			struct plan_request request = scene_request(ball, count);
			request.balls = 2;
			request.speeds = 10;
			struct plan_result result = scene_run(planner[p], &request);
			uint8_t found[BALL_MAX] = {0};
			for (int i = 0; i < result.plan_count; i++)
				if (result.plan[i].shot[0].target >= 0)
					found[result.plan[i].shot[0].target] |=
						(uint8_t)(1u << result.plan[i].shot[0].pocket);
			for (int b = 0; b < count; b++)
				for (int k = 0; k < table.pocket_count; k++) {
					bool by_force = brute.pots[b] >> k & 1, by_search = found[b] >> k & 1;
					pots += p == 0 && by_force;
					proposed += p == 0 && by_search;
					missing[p] += by_force && !by_search;
					if (p == 0 && by_force && !by_search)
						printf("  %s, position %d: ball %d into %s at %.3f deg, %.1f m/s\n",
						       model, n, b, table.pocket[k].name, brute.angle[b][k] / degree,
						       brute.speed[b][k]);
				}
		}
	}
	char label[128];
	const struct {
		const char *what;
		int value;
	} row[] = {{"pots_by_force", pots},
		   {"pots_proposed", proposed},
		   {"missing", missing[0]},
		   {"missing_thesis_profile", missing[1]}};
	for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
		snprintf(label, sizeof label, "plan.complete.%s.%s", model, row[i].what);
		report_number(report, label, row[i].value, "count");
	}
	planner_destroy(planner[0]);
	planner_destroy(planner[1]);
}

/* ---- cushion shots that land
 * -------------------------------------------------------------------------------------------- */

static void eval_refined(struct report *report, const char *model, int positions)
{
	struct random random = random_begin("refined");
	struct table table = scene_thesis_table();
	struct planner *planner = scene_planner(&table, model, NULL, 1);
	uint64_t tried = 0, landed = 0, refined = 0;
	for (int n = 0; n < positions; n++) {
		struct ball ball[BALL_MAX];
		int count = 3 + n % 8;
		scene_random(&random, &table, 0.01, ball, count);
		struct plan_request request = scene_request(ball, count);
		request.rails = 2;
		struct plan_result result = scene_run(planner, &request);
		tried += result.tried;
		landed += result.landed;
		refined += result.refined;
	}
	char label[128];
	snprintf(label, sizeof label, "plan.refine.%s.tried", model);
	report_number(report, label, (double)tried, "count");
	snprintf(label, sizeof label, "plan.refine.%s.land_at_the_mirror", model);
	report_number(report, label, (double)landed, "count");
	snprintf(label, sizeof label, "plan.refine.%s.land_refined", model);
	report_number(report, label, (double)refined, "count");
	planner_destroy(planner);
}

int main(int argc, char **argv)
{
	if (argc != 3) {
		fprintf(stderr, "usage: %s BUILD DATA\n", argv[0]);
		return 2;
	}
	const char *text = getenv("EVAL_POSITIONS");
	int positions = text ? atoi(text) : 200;
	struct report *report = report_open(argv[1], "eval.json");
	eval_lists(report, argv[2]);
	eval_complete(report, "thesis", positions);
	eval_refined(report, "simple", positions);
	eval_refined(report, "real", positions);
	return report_close(report) < 0;
}
