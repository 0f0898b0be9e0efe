#include "app/planner/request_message.h"

#include <errno.h>
#include <stdio.h>

#include "app/process/ball_message.h"

static int refuse(char *err, size_t err_size, const char *field, long long found, const char *allowed)
{
	snprintf(err, err_size, "%s: found %lld, allowed %s", field, found, allowed);
	return -EINVAL;
}

static int check_fields(const billiard_plan_request_t *m, char *err, size_t err_size)
{
	if (m->id <= 0)
		return refuse(err, err_size, "id", (long long)m->id, "1 and more");
	if (m->ball_count < 1 || m->ball_count > BALL_MAX)
		return refuse(err, err_size, "ball_count", m->ball_count, "1..22");
	if (m->target_kind < 0 || m->target_kind > TARGET_BALL)
		return refuse(err, err_size, "target_kind", m->target_kind, "0..3");
	if (m->target_colour < 0 || m->target_colour >= COLOUR_COUNT)
		return refuse(err, err_size, "target_colour", m->target_colour, "0..8");
	if (m->on < 0 || m->on > ON_CLEARANCE)
		return refuse(err, err_size, "on", m->on, "0..3");
	if (m->budget_nodes < 0)
		return refuse(err, err_size, "budget_nodes", (long long)m->budget_nodes, "0 and more");
	if (!(m->budget_s >= 0 && m->budget_s <= 3600)) {
		snprintf(err, err_size, "budget_s: found %g, allowed 0..3600", m->budget_s);
		return -EINVAL;
	}
	return 0;
}

int plan_request_from_message(struct plan_request *out, const billiard_plan_request_t *m, const struct table *table,
			      char *err, size_t err_size)
{
	int r = check_fields(m, err, err_size);
	if (r < 0)
		return r;
	struct plan_request request = plan_request_default();
	for (int i = 0; i < m->ball_count; i++) {
		if (!ball_from_message(&request.ball[i], &m->balls[i])) {
			snprintf(err, err_size, "ball %d: colour, phase or place out of range", i);
			return -EINVAL;
		}
		request.ball[i].vel = (vec2){0, 0};
		if (request.ball[i].phase != BALL_POTTED)
			request.ball[i].phase = BALL_REST;
	}
	request.ball_count = m->ball_count;
	request.state = (struct rules_state){.on = (enum rules_on)m->on, .in_hand = m->in_hand != 0};
	request.target = (enum plan_target_kind)m->target_kind;
	request.target_colour = (enum ball_colour)m->target_colour;
	request.target_ball = m->target_ball;
	request.depth = m->depth;
	request.rails = m->rails;
	request.balls = m->max_balls;
	request.speeds = m->speeds;
	request.plans = m->plans;
	request.budget = (struct plan_budget){(uint64_t)m->budget_nodes, m->budget_s};
	r = plan_request_check(table, &request, err, err_size);
	if (r == 0)
		*out = request;
	return r;
}
