/* Shots that another simulator recorded, beside our own simulation of them. */
#ifndef BILLIARD_TESTS_SHOT_COMPARE_H
#define BILLIARD_TESTS_SHOT_COMPARE_H

#include <jansson.h>

#include "app/config/shot_file.h"

/* One shot of a collection {"tables", "sets", "shots"} as shot_file_parse() takes it. 0 or a negative errno with the reason. */
int shot_from_collection(const json_t *root, const json_t *shot, struct shot_file *out, char *err, size_t err_size);

struct shot_comparison {
	bool same;	 /* every event, in the same order; what lies within 2e-6 s may swap */
	double time;	 /* s, of the first event that differs */
	double dt, dpos; /* s, m: largest differences over the equal events */
};

/* Simulates and compares with the recorded events, the first `most` of them (0: all). */
struct shot_comparison shot_compare(const struct shot_file *file, const json_t *recorded, size_t most);

#endif
