#include "search/cost.h"

enum { POINTS_MAX = 7 };

struct cost_profile cost_profile_thesis(void)
{
	return (struct cost_profile){
		.name = "thesis",
		.w_distance = 1,
		.w_angle = 1,
		.w_balls = 1,
		.w_rails = 1,
		.ball_cost = 0.5,
		.rail_cost = 2.0 / 3,
		.w_points = 0.5,
		.w_speed = 0.5,
		.w_simulation = 1,
		.max_cut = 87 * M_PI / 180,
		.max_speed = 5,
		.pocket_speed = 0.01,
		.speed_step = 1,
		.clearance = 0.01,
		.cue_clearance = 0.01,
		.cue_room = 0.0523,
		.error = {.angle = 0.125 * M_PI / 180, .speed = 0.05},
		.aims = 1,
		.program_speed = true,
		.any_first = true,
		.keep_flukes = true,
	};
}

double cost_distance(const struct table *table, double way2)
{
	return way2 / (table->length * table->length + table->width * table->width);
}

double cost_angle(double cos_angle)
{
	double x = 1 - cos_angle;
	return (3 - 2 * x) * x * x;
}

double cost_search(const struct table *table, const struct cost_profile *profile, const struct cost_way *way)
{
	double cost = profile->w_distance * cost_distance(table, way->way2) * way->carry +
		      profile->w_angle * way->angles + profile->w_rails * profile->rail_cost * way->rails;
	return way->strikes ? cost + profile->w_balls * profile->ball_cost : cost;
}

double cost_result(const struct cost_profile *profile, int points, double speed, double search_cost)
{
	double score = fmin((double)points / POINTS_MAX, 1);
	double effort = speed * speed / (profile->max_speed * profile->max_speed);
	double cost = profile->w_points * (1 - score) + profile->w_speed * effort;
	return cost * profile->w_simulation * search_cost;
}
