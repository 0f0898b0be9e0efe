#include "thesis_lists.h"

#include <string.h>

static const double degree = M_PI / 180;

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

int thesis_rank(const struct position *position, const struct plan_result *result, json_t *want)
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
