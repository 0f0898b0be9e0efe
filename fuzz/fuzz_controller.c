/* Sequences of messages to the controller: table states, plans, commands, time. Whatever comes, nothing crashes, what goes out passes the
 * tables that receivers hold it to, and a proposal is on the table only while the controller shows one. Two bytes a step: what, how much. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/config.h"
#include "app/control/controller.h"
#include "app/light/animation.h"
#include "app/planner/plan_message.h"
#include "app/process/ball_message.h"
#include "app/process/message_table.h"
#include "app/process/text.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { FRAME_US = 33333, STEPS_MAX = 400 };
static struct config config;
static struct controller controller;
static billiard_table_state_t state;
static billiard_plan_t plan;
static double now;
static int64_t shown_plan, last_id; /* what was sent last: proposal on the table, request */
static int shown_keyframes;

static void load(void)
{
	char err[640];
	if (config.name[0])
		return;
	if (config_load(&config, "config/thesis-table.conf", err, sizeof err) < 0) {
		fprintf(stderr, "%s\n", err);
		exit(1);
	}
}

static void begin(void)
{
	static const struct {
		enum ball_colour colour;
		double x, y;
	} balls[] = {
		{COLOUR_WHITE, -0.3, 0}, {COLOUR_RED, 0.3, 0.2}, {COLOUR_RED, 0.5, -0.2}, {COLOUR_BLACK, 0.8938, 0}};
	controller_init(&controller, &config);
	memset(&plan, 0, sizeof plan);
	state = (billiard_table_state_t){.utime = 1000000, .calibration = 1, .ball_count = 4};
	for (int i = 0; i < 4; i++) {
		struct ball ball = ball_at(balls[i].colour, (vec2){balls[i].x, balls[i].y});
		ball_to_message(&state.balls[i], &ball, "", i + 1);
	}
	now = 100;
	shown_plan = last_id = shown_keyframes = 0;
}

/* ---- what must hold after every step --------------------------------------------------------------------------------- */

static void hold(bool holds, const char *what)
{
	if (holds)
		return;
	fprintf(stderr, "controller: %s, in state %s\n", what, fsm_state_name(controller.fsm.state));
	abort();
}

static void sent_draw(void)
{
	char reason[128];
	hold(message_check(&message_draw_list, &controller.draw, reason, sizeof reason), reason);
	hold(draw_check(&controller.draw), "a contradictory list");
	shown_plan = controller.draw.plan_id;
}

static void sent_animation(void)
{
	char reason[128];
	hold(message_check(&message_animation, &controller.animation, reason, sizeof reason), reason);
	hold(animation_check(&controller.animation), "a contradictory animation");
	shown_keyframes = controller.animation.keyframe_count;
}

static void sent_request(void)
{
	char reason[128];
	hold(message_check(&message_plan_request, &controller.request, reason, sizeof reason), reason);
	hold(controller.request.id >= last_id, "a request with an older id");
	last_id = controller.request.id;
}

static void flush(void)
{
	struct controller_output out = controller.output;
	bool showing = controller.fsm.state == FSM_SHOWING;
	controller.output = (struct controller_output){0};
	if (out.draw)
		sent_draw();
	if (out.animation)
		sent_animation();
	hold(!out.cancel || out.cancel_id <= last_id, "a cancel for what was never asked");
	if (out.request)
		sent_request();
	hold(showing || shown_plan == 0, "a proposal stays on the table");
	hold(showing || shown_keyframes == 0, "an animation stays on the table");
	hold(shown_plan == 0 || shown_plan == controller.request.id, "the proposal of another request");
}

/* ---- steps ------------------------------------------------------------------------------------------------------------ */

static void frame(void)
{
	char reason[128];
	state.utime += FRAME_US;
	now += 1e-6 * FRAME_US;
	if (message_check(&message_table_state, &state, reason, sizeof reason))
		controller_state(&controller, &state, now);
	flush();
	controller_tick(&controller, now);
	flush();
}

static void frames(int count)
{
	for (int i = 0; i < count; i++)
		frame();
}

static void move_ball(int how)
{
	int ball = how & 3, way = how >> 2 & 3;
	double far = 0.002 * (1 << (how >> 4 & 7));
	state.balls[ball].x += way & 1 ? far : -far;
	state.balls[ball].y += way & 2 ? far : -far;
	frame();
}

static void change_balls(int how)
{
	if (how & 1 && state.ball_count < BALL_MAX) {
		struct ball ball = ball_at((enum ball_colour)(how >> 1 & 7), (vec2){0.01 * (how >> 4) - 0.8, 0.3});
		ball_to_message(&state.balls[state.ball_count], &ball, "", state.ball_count + 1);
		state.ball_count++;
	} else if (state.ball_count > 0) {
		state.ball_count--;
	}
	frame();
}

/* An answer to the present request as a planner would give it. */
static void make_plan(int how)
{
	plan_message_begin(&plan, &controller.request);
	plan.status = (int8_t)(how & 3);
	plan.is_final = how >> 2 & 1;
	plan.sequence = how >> 3 & 3;
	plan.entry_count = plan.status == PLAN_MESSAGE_OK ? 1 + (how >> 5 & 1) : 0;
	for (int i = 0; i < plan.entry_count; i++) {
		billiard_plan_shot_t *s = &plan.entries[i].shots[0];
		plan.entries[i].shot_count = 1;
		*s = (billiard_plan_shot_t){.angle = 0.1 * how, .speed = 1, .target = -1, .pocket = -1};
		for (int k = 0; k < plan.ball_count; k++) {
			s->start_x[k] = controller.request.balls[k].x;
			s->start_y[k] = controller.request.balls[k].y;
			s->start_on[k] = 1;
		}
		s->keyframe_first = plan.keyframe_count;
		s->keyframe_count = 1;
		plan.keyframes[plan.keyframe_count++] = (billiard_keyframe_t){
			.end = 1, .phase = BALL_ROLLING, .x = s->start_x[0], .y = s->start_y[0], .vx = 0.5 + i};
	}
}

static void take_plan(void)
{
	char reason[128];
	if (message_check(&message_plan, &plan, reason, sizeof reason))
		controller_plan(&controller, &plan, now);
	flush();
}

static void command(int how)
{
	static const char *const names[] = {
		"pause", "resume", "next",	"previous",	  "infinity",	       "halo",		 "paths",
		"table", "info",   "animation", "animation-stop", "animation-restart", "animation-seek", "cancel"};
	static const char *const arguments[] = {"0.5", "-0.5", "1e9", "nan"};
	enum { COUNT = sizeof names / sizeof names[0] };
	billiard_command_t message = {.utime = state.utime};
	text_set(message.name, sizeof message.name, names[how % COUNT]);
	text_set(message.argument, sizeof message.argument, arguments[how / COUNT % 4]);
	controller_command(&controller, &message, now);
	flush();
}

/* Bytes of a message spoiled at a place that the input chooses. */
static void spoil(void *message, size_t size, int where, int what)
{
	size_t at = (size_t)where * 8 % size;
	((uint8_t *)message)[at + ((size_t)what & 7) % (size - at)] ^= (uint8_t)what;
}

static void step(int what, int how)
{
	switch (what % 10) {
	case 0:
	case 1:
		frames(how % 64);
		break;
	case 2:
		move_ball(how);
		break;
	case 3:
		change_balls(how);
		break;
	case 4:
		state.calibration = (int8_t)(how % 3);
		state.occluded = how >> 4 & 1;
		frame();
		break;
	case 5:
		make_plan(how);
		take_plan();
		break;
	case 6:
		spoil(&plan, 2048, what / 10, how);
		take_plan();
		break;
	case 7:
		command(how);
		break;
	case 8:
		spoil(&state, sizeof state, what / 10 * 4, how);
		frame();
		break;
	default:
		now += how;
		state.utime += how & 1 ? -1000000 * how : 1000000 * how;
		controller_tick(&controller, now);
		flush();
	}
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	load();
	begin();
	flush();
	for (size_t i = 0; i + 1 < size && i < 2 * STEPS_MAX; i += 2)
		step(data[i], data[i + 1]);
	return 0;
}
