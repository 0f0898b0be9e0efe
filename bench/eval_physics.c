/* Agreement with the recorded shots of another simulator, set by set, in numbers for eval.json. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "report.h"
#include "shot_compare.h"

enum { BREAK_EVENTS = 5 };

struct tally {
	int shots, same, failed;
	double dt, dpos;
};

static void add(struct tally *tally, const json_t *root, const json_t *shot, const char *set)
{
	static struct shot_file file;
	char err[300];
	tally->shots++;
	if (shot_from_collection(root, shot, &file, err, sizeof err) < 0) {
		fprintf(stderr, "%s\n", err);
		tally->failed++;
		return;
	}
	/* A break is chaotic: only its first events can agree. */
	size_t most = strstr(set, "break") ? BREAK_EVENTS : 0;
	struct shot_comparison c = shot_compare(&file, json_object_get(shot, "events"), most);
	if (c.same) {
		tally->same++;
		tally->dt = fmax(tally->dt, c.dt);
		tally->dpos = fmax(tally->dpos, c.dpos);
	} else {
		printf("  %s, shot %lld: differs at %.6f s\n", set, json_integer_value(json_object_get(shot, "id")),
		       c.time);
	}
}

static void report_set(struct report *report, const char *set, const struct tally *tally)
{
	const struct {
		const char *what;
		double value;
		const char *unit;
	} row[] = {
		{"shots", tally->shots, "count"},	  {"same_order", tally->same, "count"},
		{"failed", tally->failed, "count"},	  {"max_dt_us", tally->dt * 1e6, "us"},
		{"max_dpos_um", tally->dpos * 1e6, "um"},
	};
	char name[128];
	for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
		snprintf(name, sizeof name, "shots.%s.%s", set, row[i].what);
		report_number(report, name, row[i].value, row[i].unit);
	}
}

int main(int argc, char **argv)
{
	if (argc != 3) {
		fprintf(stderr, "usage: %s BUILD DATA\n", argv[0]);
		return EXIT_FAILURE;
	}
	char path[512];
	snprintf(path, sizeof path, "%s/shots/pooltool_shots.json", argv[2]);
	json_error_t error;
	json_t *root = json_load_file(path, 0, &error), *setup, *shot;
	if (!root) {
		printf("eval physics: SKIPPED, %s: %s\n", path, error.text);
		return EXIT_SUCCESS;
	}
	struct report *report = report_open(argv[1], "eval.json");
	const char *set;
	json_object_foreach(json_object_get(root, "sets"), set, setup)
	{
		struct tally tally = {0};
		size_t i;
		json_array_foreach(json_object_get(root, "shots"), i, shot)
		{
			if (strcmp(json_string_value(json_object_get(shot, "set")), set) == 0)
				add(&tally, root, shot, set);
		}
		report_set(report, set, &tally);
	}
	json_decref(root);
	return report_close(report) < 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}
