#include "app/planner/request_message.h"

#include "app/process/ball_message.h"

int plan_request_from_message(struct plan_request *out, const billiard_plan_request_t *m, const struct table *table,
			      char *err, size_t err_size)
{
	struct plan_request request = plan_request_default();
	for (int i = 0; i < m->ball_count; i++) {
		request.ball[i] = ball_from_message(&m->balls[i]);
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
	int r = plan_request_check(table, &request, err, err_size);
	if (r == 0)
		*out = request;
	return r;
}
