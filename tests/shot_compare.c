#include "shot_compare.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const double TIE = 2e-6; /* s */
enum { EVENT_LIMIT = 10000 };

int shot_from_collection(const json_t *root, const json_t *shot, struct shot_file *out, char *err, size_t err_size)
{
	const char *name = json_string_value(json_object_get(shot, "set"));
	json_t *set = json_object_get(json_object_get(root, "sets"), name);
	json_t *table =
		json_object_get(json_object_get(root, "tables"), json_string_value(json_object_get(set, "table")));
	json_t *one = json_pack("{s:O, s:O, s:O, s:O, s:O, s:O}", "table", table, "params",
				json_object_get(set, "ball_params"), "models", json_object_get(set, "models"), "cue",
				json_object_get(shot, "cue"), "balls", json_object_get(shot, "balls"), "post_strike",
				json_object_get(shot, "post_strike"));
	char *text = one ? json_dumps(one, JSON_REAL_PRECISION(17)) : NULL;
	int r = text ? shot_file_parse(out, name, text, strlen(text), err, err_size) : -EINVAL;
	if (!text)
		snprintf(err, err_size, "%s: not a complete shot", name);
	free(text);
	json_decref(one);
	return r;
}

/* Our events as a JSON list; NULL when the simulation does not end. */
static json_t *simulate(const struct shot_file *file)
{
	char *text = NULL, *rest = NULL;
	size_t size = 0;
	FILE *out = open_memstream(&text, &size);
	int r = out ? shot_file_run(file, EVENT_LIMIT, out) : -ENOMEM;
	if (out)
		fclose(out);
	json_t *events = r == 0 ? json_array() : NULL;
	for (char *line = strtok_r(text, "\n", &rest); events && line; line = strtok_r(NULL, "\n", &rest))
		json_array_append_new(events, json_loads(line, 0, NULL));
	free(text);
	return events;
}

static double number(const json_t *object, const char *key)
{
	return json_number_value(json_object_get(object, key));
}

static bool is_marker(const json_t *event)
{
	const char *type = json_string_value(json_object_get(event, "type"));
	return strcmp(type, "none") == 0 || strcmp(type, "stick_ball") == 0;
}

static bool same_event(const json_t *ours, const json_t *theirs)
{
	const char *a = json_string_value(json_object_get(ours, "event"));
	if (strcmp(a, json_string_value(json_object_get(theirs, "type"))) != 0)
		return false;
	const json_t *i = json_object_get(ours, "ids"), *k = json_object_get(theirs, "ids");
	return json_equal(i, k) || (json_array_size(i) == 2 && json_equal(json_array_get(i, 0), json_array_get(k, 1)) &&
				    json_equal(json_array_get(i, 1), json_array_get(k, 0)));
}

static double place_difference(const json_t *ours, const json_t *theirs)
{
	double worst = 0;
	const char *id;
	json_t *state;
	json_object_foreach(json_object_get((json_t *)theirs, "post"), id, state)
	{
		const json_t *r = json_object_get(state, "r");
		const json_t *o = json_object_get(json_object_get(json_object_get(ours, "post"), id), "r");
		double x = json_number_value(json_array_get(o, 0)) - json_number_value(json_array_get(r, 0));
		double y = json_number_value(json_array_get(o, 1)) - json_number_value(json_array_get(r, 1));
		worst = fmax(worst, hypot(x, y));
	}
	return worst;
}

/* Index in ours of the next event that is theirs, at most TIE after the first left; -1 when there is none. */
static int find(const json_t *ours, const json_t *theirs)
{
	double first = number(json_array_get(ours, 0), "t");
	for (size_t k = 0; k < json_array_size(ours); k++) {
		const json_t *mine = json_array_get(ours, k);
		if (number(mine, "t") - first > TIE)
			return -1;
		if (same_event(mine, theirs))
			return (int)k;
	}
	return -1;
}

struct shot_comparison shot_compare(const struct shot_file *file, const json_t *recorded, size_t most)
{
	struct shot_comparison c = {.same = true};
	json_t *ours = simulate(file), *theirs;
	size_t i, seen = 0;
	c.same = ours != NULL;
	json_array_foreach(recorded, i, theirs)
	{
		if (is_marker(theirs) || !c.same || (most > 0 && seen == most))
			continue;
		int k = find(ours, theirs);
		c.time = number(theirs, "t");
		c.same = k >= 0;
		if (!c.same)
			continue;
		const json_t *mine = json_array_get(ours, (size_t)k);
		c.dt = fmax(c.dt, fabs(number(mine, "t") - c.time));
		c.dpos = fmax(c.dpos, place_difference(mine, theirs));
		json_array_remove(ours, (size_t)k);
		seen++;
	}
	if (c.same && most == 0 && json_array_size(ours) > 0) {
		c.same = false;
		c.time = number(json_array_get(ours, 0), "t");
	}
	json_decref(ours);
	return c;
}
