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

struct controller_rig rig; /* too large for the stack */

void rig_place(int i, enum ball_colour colour, double x, double y)
{
	struct ball ball = ball_at(colour, (vec2){x, y});
	ball_to_message(&rig.state.balls[i], &ball, "", i + 1);
}

bool rig_see(const billiard_table_state_t *message)
{
	char reason[128];
	return message_check(&message_table_state, message, reason, sizeof reason) &&
	       controller_state(&rig.c, message, rig.now);
}

bool rig_take(const billiard_plan_t *message)
{
	char reason[128];
	return message_check(&message_plan, message, reason, sizeof reason) &&
	       controller_plan(&rig.c, message, rig.now);
}

bool rig_draws_well(void)
{
	char reason[128];
	return message_check(&message_draw_list, &rig.c.draw, reason, sizeof reason) && draw_check(&rig.c.draw);
}

bool rig_moves_well(void)
{
	char reason[128];
	return message_check(&message_animation, &rig.c.animation, reason, sizeof reason) &&
	       animation_check(&rig.c.animation);
}

void rig_setup(void)
{
	char err[640];
	ck_assert_msg(config_load(&rig.config, "config/thesis-table.conf", err, sizeof err) == 0, "%s", err);
	controller_init(&rig.c, &rig.config);
	rig.state = (billiard_table_state_t){.utime = 1000000, .calibration = 1, .markers = 4, .ball_count = 4};
	rig_place(0, COLOUR_WHITE, -0.3, 0);
	rig_place(1, COLOUR_RED, 0.3, 0.2);
	rig_place(2, COLOUR_RED, 0.5, -0.2);
	rig_place(3, COLOUR_BLACK, 0.8938, 0);
	rig.now = 100;
	rig.draws = rig.requests = rig.sent = rig.cancels = rig.last_id = 0;
}

struct controller_output rig_flush(void)
{
	struct controller_output out = rig.c.output;
	rig.c.output = (struct controller_output){0};
	rig.draws += out.draw;
	rig.sent += out.request;
	rig.requests += out.request && rig.c.request.id != rig.last_id;
	rig.last_id = out.request ? rig.c.request.id : rig.last_id;
	rig.cancels += out.cancel;
	return out;
}

bool rig_frame(void)
{
	rig.state.utime += FRAME_US;
	rig.state.seq++;
	rig.now += 1e-6 * FRAME_US;
	bool ok = rig_see(&rig.state);
	controller_tick(&rig.c, rig.now);
	rig_flush();
	return ok;
}

void rig_frames(int count)
{
	for (int i = 0; i < count; i++)
		ck_assert(rig_frame());
}

void rig_shot(void)
{
	for (int i = 0; i < 10; i++) {
		rig.state.balls[0].x += 0.01;
		rig_frame();
	}
}

billiard_plan_t *rig_answer(int8_t status, double angle)
{
	static billiard_plan_t plan;
	plan_message_begin(&plan, &rig.c.request);
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
			s->start_x[k] = rig.c.request.balls[k].x;
			s->start_y[k] = rig.c.request.balls[k].y;
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

bool rig_command(const char *name, const char *argument)
{
	billiard_command_t m = {.utime = 1};
	text_set(m.name, sizeof m.name, name);
	text_set(m.argument, sizeof m.argument, argument);
	bool ok = controller_command(&rig.c, &m, rig.now);
	rig_flush();
	return ok;
}

void rig_proposed(void)
{
	rig_frames(MANY);
	ck_assert(rig_take(rig_answer(PLAN_MESSAGE_OK, 0.5)));
	rig_flush();
	ck_assert_int_eq(rig.c.fsm.state, FSM_SHOWING);
}
