#include "controller_rig.h"

#include <math.h>

#include "app/light/animation.h"
#include "app/light/draw.h"
#include "app/planner/plan_message.h"
#include "app/planner/request_message.h"
#include "app/process/ball_message.h"
#include "app/process/message_table.h"
#include "app/process/text.h"
#include "harness.h"

struct controller_rig ctl; /* too large for the stack */

void ctl_place(int i, enum ball_colour colour, double x, double y)
{
	struct ball ball = ball_at(colour, (vec2){x, y});
	ball_to_message(&ctl.state.balls[i], &ball, "", i + 1);
}

bool ctl_see(const billiard_table_state_t *message)
{
	char reason[128];
	return message_check(&message_table_state, message, reason, sizeof reason) &&
	       controller_state(&ctl.c, message, ctl.now);
}

bool ctl_take(const billiard_plan_t *message)
{
	char reason[128];
	return message_check(&message_plan, message, reason, sizeof reason) &&
	       controller_plan(&ctl.c, message, ctl.now);
}

bool ctl_draws_well(void)
{
	char reason[128];
	return message_check(&message_draw_list, &ctl.c.draw, reason, sizeof reason) && draw_check(&ctl.c.draw);
}

bool ctl_moves_well(void)
{
	char reason[128];
	return message_check(&message_animation, &ctl.c.animation, reason, sizeof reason) &&
	       animation_check(&ctl.c.animation);
}

void ctl_setup(void)
{
	char err[640];
	ck_assert_msg(config_load(&ctl.config, "config/thesis.conf", err, sizeof err) == 0, "%s", err);
	controller_init(&ctl.c, &ctl.config);
	ctl.state = (billiard_table_state_t){.utime = 1000000, .calibration = 1, .markers = 4, .ball_count = 4};
	ctl_place(0, COLOUR_WHITE, -0.3, 0);
	ctl_place(1, COLOUR_RED, 0.3, 0.2);
	ctl_place(2, COLOUR_RED, 0.5, -0.2);
	ctl_place(3, COLOUR_BLACK, 0.8938, 0);
	ctl.now = 100;
	ctl.draws = ctl.requests = ctl.sent = ctl.cancels = ctl.last_id = 0;
}

struct controller_output ctl_flush(void)
{
	struct controller_output out = ctl.c.output;
	ctl.c.output = (struct controller_output){0};
	ctl.draws += out.draw;
	ctl.sent += out.request;
	ctl.requests += out.request && ctl.c.request.id != ctl.last_id;
	ctl.last_id = out.request ? ctl.c.request.id : ctl.last_id;
	ctl.cancels += out.cancel;
	return out;
}

bool ctl_frame(void)
{
	ctl.state.utime += FRAME_US;
	ctl.state.seq++;
	ctl.now += 1e-6 * FRAME_US;
	bool ok = ctl_see(&ctl.state);
	controller_tick(&ctl.c, ctl.now);
	ctl_flush();
	return ok;
}

void ctl_frames(int count)
{
	for (int i = 0; i < count; i++)
		ck_assert(ctl_frame());
}

void ctl_shot(void)
{
	for (int i = 0; i < 10; i++) {
		ctl.state.balls[0].x += 0.01;
		ctl_frame();
	}
}

billiard_plan_t *ctl_answer(int8_t status, double angle)
{
	static billiard_plan_t plan;
	plan_message_begin(&plan, &ctl.c.request);
	plan.status = status;
	plan.is_final = 1;
	if (status != PLAN_MESSAGE_OK)
		return &plan;
	plan.entry_count = 2;
	for (int i = 0; i < 2; i++) {
		plan.entries[i].shot_count = 1;
		billiard_plan_shot_t *s = &plan.entries[i].shots[0];
		*s = (billiard_plan_shot_t){.angle = angle + i,
					    .speed = 1,
					    .target = 1,
					    .pocket = (int16_t)i,
					    .chain_count = 2,
					    .chain = {0, 1, -1, -1}};
		for (int k = 0; k < plan.ball_count; k++) {
			s->start_x[k] = ctl.c.request.balls[k].x;
			s->start_y[k] = ctl.c.request.balls[k].y;
			s->start_on[k] = 1;
		}
		s->keyframe_first = plan.keyframe_count;
		s->keyframe_count = 1;
		plan.keyframes[plan.keyframe_count++] = (billiard_keyframe_t){.end = 2,
									      .phase = BALL_ROLLING,
									      .event = EVENT_STRIKE,
									      .x = s->start_x[0],
									      .y = s->start_y[0],
									      .vx = cos(s->angle),
									      .vy = sin(s->angle)};
	}
	return &plan;
}

bool ctl_command(const char *name, const char *argument)
{
	billiard_command_t m = {.utime = 1};
	text_set(m.name, sizeof m.name, name);
	text_set(m.argument, sizeof m.argument, argument);
	bool ok = controller_command(&ctl.c, &m, ctl.now);
	ctl_flush();
	return ok;
}

void ctl_proposed(void)
{
	ctl_frames(MANY);
	ck_assert(ctl_take(ctl_answer(PLAN_MESSAGE_OK, 0.5)));
	ctl_flush();
	ck_assert_int_eq(ctl.c.fsm.state, FSM_SHOWING);
}
