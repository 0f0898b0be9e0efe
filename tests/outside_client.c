/* A client of the planner that knows nothing of this project but the types in lcmtypes/: compiled by tests/planner.sh
 * on its own, against what lcm-gen makes of them and LCM's library. Asks for a position, prints the first proposal. */
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <lcm/lcm.h>

#include "billiard_plan_request_t.h"
#include "billiard_plan_t.h"

static const int64_t ID = 4711;

static void on_plan(const lcm_recv_buf_t *buf, const char *channel, const billiard_plan_t *plan, void *user)
{
	(void)buf, (void)channel;
	if (plan->request_id == ID && plan->is_final)
		*(billiard_plan_t *)user = *plan;
}

static void put(billiard_plan_request_t *request, const char *name, int colour, double x, double y)
{
	billiard_ball_t *ball = &request->balls[request->ball_count++];
	strncpy((char *)ball->name, name, sizeof ball->name - 1);
	ball->colour = (int8_t)colour;
	ball->x = x;
	ball->y = y;
	ball->confidence = 1;
}

int main(int argc, char **argv)
{
	static billiard_plan_request_t request = {.id = 4711, .depth = 1, .max_balls = 1, .speeds = 1, .plans = 3};
	static billiard_plan_t plan;
	lcm_t *lcm = lcm_create(argc > 1 ? argv[1] : NULL);
	if (!lcm)
		return 2;
	billiard_plan_t_subscribe(lcm, "PLAN", on_plan, &plan);
	put(&request, "cue", 0, -0.3, 0);
	put(&request, "red", 1, 0.35, 0.2);
	for (int i = 0; i < 50 && !plan.is_final;
	     i++) { /* repeated: the planner may still be starting, and LCM may lose messages */
		request.utime = (int64_t)time(NULL) * 1000000;
		billiard_plan_request_t_publish(lcm, "PLAN_REQUEST", &request);
		while (lcm_handle_timeout(lcm, 200) > 0 && !plan.is_final)
			;
	}
	lcm_destroy(lcm);
	if (!plan.is_final || plan.status != 0 || plan.entry_count < 1 ||
	    strcmp((const char *)plan.names[1], "red") != 0)
		return 1;
	const billiard_plan_shot_t *shot = &plan.entries[0].shots[0];
	printf("%s into pocket %d: angle %.4f rad, %.3f m/s, %d keyframes\n", (const char *)plan.names[shot->target],
	       shot->pocket, shot->angle, shot->speed, shot->keyframe_count);
	return shot->target == 1 && shot->potted_count == 1 && shot->keyframe_count > 0 ? 0 : 1;
}
