/* Requests at the border: what is accepted, and why not. */
#include <errno.h>
#include <stdio.h>

#include "search/plan.h"

struct plan_request plan_request_default(void)
{
	return (struct plan_request){
		.target = TARGET_ANY,
		.target_ball = -1,
		.depth = 1,
		.rails = 0,
		.balls = 2,
		.speeds = 1,
		.plans = 10,
		.tolerances = 1,
	};
}

struct range {
	const char *name;
	int value, low, high;
};

static int check_ranges(const struct plan_request *request, char *err, size_t err_size)
{
	const struct range ranges[] = {
		{"ball_count", request->ball_count, 1, BALL_MAX},
		{"depth", request->depth, 1, PLAN_SHOTS_MAX},
		{"rails", request->rails, 0, PLAN_RAILS_MAX},
		{"balls", request->balls, 1, PLAN_CHAIN_MAX - 1},
		{"speeds", request->speeds, 1, 1000},
		{"plans", request->plans, 1, PLAN_MAX},
		{"tolerances", request->tolerances, 0, PLAN_MAX},
		{"target", (int)request->target, TARGET_ANY, TARGET_BALL},
		{"state", (int)request->state.on, ON_ANY, ON_CLEARANCE},
	};
	for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
		const struct range *r = &ranges[i];
		if (r->value < r->low || r->value > r->high) {
			snprintf(err, err_size, "%s is %d, allowed %d..%d", r->name, r->value, r->low, r->high);
			return -EINVAL;
		}
	}
	if (!(request->budget.seconds >= 0) || isinf(request->budget.seconds)) {
		snprintf(err, err_size, "budget is %g s, allowed 0 or more", request->budget.seconds);
		return -EINVAL;
	}
	return 0;
}

/* Exactly one white, whatever its phase: a potted one beside one on the table would leave it open which is played. */
static int check_cue_ball(const struct plan_request *request, char *err, size_t err_size)
{
	int cue = -1;
	for (int i = 0; i < request->ball_count; i++) {
		if (request->ball[i].colour != COLOUR_WHITE)
			continue;
		if (cue >= 0) {
			snprintf(err, err_size, "balls %d and %d are both white", cue, i);
			return -EINVAL;
		}
		cue = i;
	}
	if (cue < 0 || (request->ball[cue].phase == BALL_POTTED && !request->state.in_hand)) {
		snprintf(err, err_size, "there is no white ball on the table");
		return -EINVAL;
	}
	return 0;
}

static int check_balls(const struct plan_request *request, char *err, size_t err_size)
{
	for (int i = 0; i < request->ball_count; i++) {
		const struct ball *ball = &request->ball[i];
		if (ball->colour < COLOUR_WHITE || ball->colour >= COLOUR_COUNT) {
			snprintf(err, err_size, "ball %d has no known colour", i);
			return -EINVAL;
		}
		if (ball->phase != BALL_REST && ball->phase != BALL_POTTED) {
			snprintf(err, err_size, "ball %d is not at rest", i);
			return -EINVAL;
		}
	}
	return check_cue_ball(request, err, err_size);
}

/* Nobody errs by more than this: 1 sigma and bias. */
static const double ANGLE_MAX = 0.5, ELEVATION_MAX = 0.5; /* rad */
static const double SHARE_MAX = 1;

static int check_error(const struct plan_request *request, char *err, size_t err_size)
{
	const struct player_error *e = &request->error;
	const struct {
		const char *name;
		double value, low, high;
	} members[] = {
		{"error angle", e->angle, 0, ANGLE_MAX},
		{"error angle_bias", e->angle_bias, -ANGLE_MAX, ANGLE_MAX},
		{"error speed", e->speed, 0, SHARE_MAX},
		{"error speed_bias", e->speed_bias, -SHARE_MAX, SHARE_MAX},
		{"error tip", e->tip, 0, SHARE_MAX},
		{"error side_bias", e->side_bias, -SHARE_MAX, SHARE_MAX},
		{"error follow_bias", e->follow_bias, -SHARE_MAX, SHARE_MAX},
		{"error elevation", e->elevation, 0, ELEVATION_MAX},
		{"error elevation_bias", e->elevation_bias, -ELEVATION_MAX, ELEVATION_MAX},
	};
	for (size_t i = 0; i < sizeof members / sizeof members[0] && request->has_error; i++)
		if (!(members[i].value >= members[i].low && members[i].value <= members[i].high)) {
			snprintf(err, err_size, "%s is %g, allowed %g..%g", members[i].name, members[i].value,
				 members[i].low, members[i].high);
			return -EINVAL;
		}
	return 0;
}

static int check_target(const struct plan_request *request, char *err, size_t err_size)
{
	if (request->target == TARGET_BALL) {
		int b = request->target_ball;
		if (b < 0 || b >= request->ball_count || request->ball[b].phase == BALL_POTTED ||
		    request->ball[b].colour == COLOUR_WHITE) {
			snprintf(err, err_size, "target ball %d is not an object ball on the table", b);
			return -EINVAL;
		}
	}
	if (request->target != TARGET_COLOUR)
		return 0;
	for (int i = 0; i < request->ball_count; i++)
		if (request->ball[i].colour == request->target_colour && request->ball[i].phase != BALL_POTTED &&
		    request->target_colour != COLOUR_WHITE)
			return 0;
	snprintf(err, err_size, "target %s is not on the table", ball_colour_name(request->target_colour));
	return -EINVAL;
}

int plan_request_check(const struct table *table, const struct plan_request *request, char *err, size_t err_size)
{
	int first, second;
	int rc = check_ranges(request, err, err_size);
	if (rc == 0)
		rc = check_balls(request, err, err_size);
	if (rc == 0)
		rc = check_target(request, err, err_size);
	if (rc == 0)
		rc = check_error(request, err, err_size);
	if (rc == 0)
		rc = table_check_balls(table, request->ball, request->ball_count, &first, &second, err, err_size);
	return rc;
}
