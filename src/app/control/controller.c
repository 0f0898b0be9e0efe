#include "app/control/controller.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/process/text.h"
#include "app/process/ball_message.h"
#include "app/planner/plan_check.h"
#include "app/light/animation.h"
#include "app/planner/plan_message.h"
#include "vision/vision.h"

static const double SETTLE_MAX = 0.006; /* m a ball may be moved to take camera errors out of a layout */
static const double NEW_LAYOUT = 0.003; /* m a ball must lie elsewhere for a new proposal */

void controller_init(struct controller *c, const struct config *config)
{
	*c = (struct controller){
		.config = config,
		.fsm = {FSM_BLIND, 0},
		.options = draw_options_default(),
		.animate = true,
		.note = "waiting for the camera",
	};
	stability_init(&c->stability, config->infinity.still_distance, config->infinity.still_frames);
	draw_clear(&c->draw);
	c->output.draw = true;
}

/* ---- actions -------------------------------------------------------------------------------------------------------- */

static void note(struct controller *c, const char *text)
{
	snprintf(c->note, sizeof c->note, "%s", text);
}

/* Rings only where balls are known to rest. */
static void draw_nothing(struct controller *c, bool with_note)
{
	bool at_rest = c->fsm.state == FSM_PLANNING || c->fsm.state == FSM_SHOWING;
	snprintf(c->drawn_note, sizeof c->drawn_note, "%s", with_note ? c->note : "");
	draw_clear(&c->draw);
	draw_idle(&c->draw, &c->config->table,
		  &(struct draw_resting){c->seen.ball, at_rest ? c->seen.count : 0, c->drawn_note}, &c->options);
	c->draw.plan_id = 0;
	c->animation = (billiard_animation_t){0};
	c->output.draw = c->output.animation = true;
}

static void draw_shown(struct controller *c)
{
	draw_clear(&c->draw);
	draw_proposal(&c->draw, &c->config->table, &(struct draw_subject){&c->plan, c->entry, c->shot}, &c->options);
	c->draw.plan_id = c->plan.request_id;
	c->output.draw = true;
}

/* A better answer with the same first shot lets the animation go on. */
static void animate_shown(struct controller *c, double now)
{
	billiard_animation_t animation;
	plan_message_animation(&animation, &c->plan, c->entry, c->shot);
	if (!c->animate || animation_same_motion(&animation, &c->animation))
		return;
	animation.rate = c->config->infinity.animation_rate;
	animation.pause = c->config->infinity.animation_pause;
	animation.ball_radius = c->config->table.ball_radius;
	c->animation = animation;
	c->animation_since = now;
	c->output.animation = true;
}

static int count_reds(const struct layout *layout)
{
	int reds = 0;
	for (int i = 0; i < layout->count; i++)
		reds += layout->ball[i].colour == COLOUR_RED;
	return reds;
}

/* The ball on, as far as the layouts tell: a red fell since the last request: a colour; else what the position says. */
static struct rules_state ball_on(const struct controller *c)
{
	struct rules_state state = rules_state_from_position(c->seen.ball, c->seen.count);
	if (c->has_asked && count_reds(&c->seen) < count_reds(&c->asked))
		state.on = ON_COLOUR;
	return state;
}

static void request(struct controller *c)
{
	const struct config_planner *p = &c->config->planner;
	bool rules = c->config->infinity.rules;
	if (rules)
		c->rules = ball_on(c);
	c->asked = c->seen;
	c->has_asked = true;
	c->has_plan = c->was_cancelled = false;
	c->entry = c->shot = 0;
	billiard_plan_request_t *r = &c->request;
	/* The frame's time as id: larger than all former ones, also after a restart, and the same in a replay. */
	int64_t id = c->last_frame > c->request.id ? c->last_frame : c->request.id + 1;
	*r = (billiard_plan_request_t){
		.id = id,
		.ball_count = c->seen.count,
		.target_kind = rules ? TARGET_RULES : TARGET_ANY,
		.on = rules ? (int8_t)c->rules.on : ON_ANY,
		.in_hand = c->rules.in_hand,
		.depth = p->depth,
		.rails = p->rails,
		.max_balls = p->balls,
		.speeds = p->speeds,
		.plans = p->plans,
		.budget_nodes = (int64_t)p->budget_nodes,
		.budget_s = p->budget,
	};
	struct layout settled = c->seen;
	if (!layout_settle(&settled, c->config->table.length, c->config->table.width, c->config->table.ball_radius,
			   SETTLE_MAX))
		note(c, "balls seem to overlap");
	char name[16];
	int number[COLOUR_COUNT] = {0};
	for (int i = 0; i < settled.count; i++) {
		enum ball_colour colour = settled.ball[i].colour;
		snprintf(name, sizeof name, "%s%d", ball_colour_name(colour), number[colour]++);
		ball_to_message(&r->balls[i], &settled.ball[i], name, settled.track[i]);
	}
	c->output.request = true;
}

/* The planner lost the request, or somebody else had it ended: then it knows the id as done, and only a new one helps. */
static void repeat(struct controller *c)
{
	if (c->was_cancelled)
		request(c);
	else
		c->output.request = true;
}

static int wrap(int value, int count)
{
	return count > 0 ? (value % count + count) % count : 0;
}

static void perform(struct controller *c, unsigned actions, double now)
{
	if (actions & FSM_DO_CANCEL) {
		c->output.cancel = true;
		c->output.cancel_id = c->request.id;
	}
	if (actions & FSM_DO_CLEAR)
		draw_nothing(c, false);
	if (actions & FSM_DO_REQUEST)
		request(c);
	if (actions & FSM_DO_REPEAT)
		repeat(c);
	if (actions & FSM_DO_NEXT)
		c->entry = wrap(c->entry + 1, c->plan.entry_count);
	if (actions & FSM_DO_PREVIOUS)
		c->entry = wrap(c->entry - 1, c->plan.entry_count);
	if ((actions & FSM_DO_SHOW) && c->has_plan) {
		draw_shown(c);
		animate_shown(c, now);
	}
	if (actions & FSM_DO_NOTE)
		draw_nothing(c, true);
}

static void event(struct controller *c, enum fsm_event e, double now)
{
	perform(c, fsm_step(&c->fsm, e, now), now);
}

/* ---- what is seen --------------------------------------------------------------------------------------------------- */

/* Unknown colours count as red: they can only be played as one. */
static void layout_from_message(struct layout *out, const billiard_table_state_t *state)
{
	*out = (struct layout){.count = state->ball_count, .cue = -1};
	for (int i = 0; i < out->count; i++) {
		struct ball ball = ball_from_message(&state->balls[i]);
		out->ball[i] = ball_at(ball.colour == COLOUR_UNKNOWN ? COLOUR_RED : ball.colour, ball.pos);
		out->track[i] = state->balls[i].track;
	}
}

/* A second white ball is a false one: it is left out of what is planned for. */
static void drop_false_whites(struct layout *layout)
{
	int n = 0, cue = layout->cue;
	for (int i = 0; i < layout->count; i++) {
		if (layout->ball[i].colour == COLOUR_WHITE && i != cue)
			continue;
		if (i == cue)
			layout->cue = n;
		layout->ball[n] = layout->ball[i];
		layout->track[n] = layout->track[i];
		n++;
	}
	layout->count = n;
}

static void on_verdict(struct controller *c, enum stability_verdict verdict, double now)
{
	enum fsm_state s = c->fsm.state;
	switch (verdict) {
	case STABILITY_LOST:
		event(c, FSM_LOST, now);
		break;
	case STABILITY_MOVING:
		event(c, FSM_MOVING, now);
		break;
	case STABILITY_STABLE:
		/* While a proposal is up, only another layout counts: a hand that passed changes nothing. */
		if ((s != FSM_PLANNING && s != FSM_SHOWING) || !c->has_asked ||
		    layout_differs(&c->asked, &c->seen, NEW_LAYOUT))
			event(c, FSM_STABLE, now);
		break;
	case STABILITY_UNSURE:
		break;
	}
}

void controller_doubt(struct controller *c, const billiard_vision_doubt_t *doubt)
{
	c->doubt = *doubt;
}

/* A colour matters when the rules are played, and the cue ball's always. */
static bool colour_matters(const struct controller *c, const billiard_table_state_t *state)
{
	bool matters = c->config->infinity.rules;
	for (int i = 0; i < state->ball_count && i < c->doubt.ball_count; i++)
		matters =
			matters || ((c->doubt.ball_doubt[i] & DOUBT_COLOUR) && state->balls[i].colour == COLOUR_WHITE);
	return matters;
}

/* Why the position is not to be planned for although nothing moves; NULL: no reason. A vision that tells its doubts tells
 * them for every frame: where they are missing they were lost. */
static const char *doubted(const struct controller *c, const billiard_table_state_t *state)
{
	if (c->doubt.utime == 0)
		return NULL;
	if (c->doubt.utime != state->utime || (c->doubt.doubt & DOUBT_UNJUDGED))
		return "looking again";
	if (c->doubt.doubt & DOUBT_PLACE)
		return "a ball is not seen clearly";
	if (c->doubt.doubt & DOUBT_HIDDEN)
		return "a ball is hidden";
	if ((c->doubt.doubt & DOUBT_COLOUR) && colour_matters(c, state))
		return "a ball's colour is not sure";
	return NULL;
}

bool controller_state(struct controller *c, const billiard_table_state_t *state, double now)
{
	struct layout layout;
	/* A clock that was set back, or another log: begin anew after two seconds' worth of doubt. */
	if (state->utime <= c->last_frame && c->last_frame - state->utime < 2000000)
		return false;
	layout_from_message(&layout, state);
	c->last_frame = state->utime;
	bool seen = state->calibration != 0;
	enum stability_verdict verdict = stability_frame(&c->stability, seen ? &layout : NULL, state->occluded != 0);
	const char *doubt = verdict == STABILITY_STABLE ? doubted(c, state) : NULL;
	if (doubt) {
		verdict = STABILITY_UNSURE;
		note(c, doubt);
	}
	if (!seen) {
		char reason[sizeof state->reason];
		text_get(reason, sizeof reason, state->reason, sizeof state->reason);
		snprintf(c->note, sizeof c->note, "not calibrated: %.70s", reason);
	} else if (layout.cue < 0) {
		note(c, "no cue ball");
	} else {
		drop_false_whites(&layout);
		c->seen = layout;
	}
	on_verdict(c, verdict, now);
	if (verdict == STABILITY_LOST && c->fsm.state == FSM_BLIND && strcmp(c->note, c->drawn_note) != 0)
		draw_nothing(c, true);
	return true;
}

/* ---- answers and commands ------------------------------------------------------------------------------------------- */

bool controller_plan(struct controller *c, const billiard_plan_t *plan, double now)
{
	bool wanted = c->fsm.state == FSM_PLANNING || c->fsm.state == FSM_SHOWING;
	if (plan->request_id != c->request.id || !plan_check(plan, &c->config->table))
		return false;
	c->was_cancelled = plan->status == PLAN_MESSAGE_CANCELLED;
	if (c->was_cancelled || !wanted)
		return true;
	if (plan->status != PLAN_MESSAGE_OK) {
		text_get(c->note, sizeof c->note, plan->reason, sizeof plan->reason);
		if (plan->is_final && !c->has_plan)
			event(c, FSM_NONE, now);
		return true;
	}
	if (c->has_plan && plan->sequence < c->plan.sequence)
		return true;
	c->proposals += !c->has_plan;
	c->plan = *plan;
	c->has_plan = true;
	c->entry = wrap(c->entry, plan->entry_count);
	c->shot = 0;
	event(c, FSM_READY, now);
	return true;
}

static bool toggle(struct controller *c, bool *what)
{
	*what = !*what;
	if (c->fsm.state == FSM_SHOWING && c->has_plan)
		draw_shown(c);
	else
		draw_nothing(c, c->fsm.state == FSM_BLIND || c->fsm.state == FSM_SHOWING);
	return true;
}

/* Lets the animation stand or run on from another place. */
static void move_animation(struct controller *c, double position, bool run, double now)
{
	c->animation.position = fmin(fmax(position, 0), animation_length(&c->animation));
	c->animation.run = run;
	c->animation_since = now;
}

static bool animation_control(struct controller *c, const char *name, const char *argument, double now)
{
	double at = animation_position(&c->animation, now - c->animation_since);
	bool shown = c->fsm.state == FSM_SHOWING && c->has_plan;
	if (strcmp(name, "animation") == 0) {
		c->animate = !c->animate;
		c->animation.keyframe_count = 0;
		if (shown)
			animate_shown(c, now);
	} else if (strcmp(name, "animation-stop") == 0) {
		move_animation(c, at, !c->animation.run, now);
	} else if (strcmp(name, "animation-seek") == 0) {
		double seconds = 0;
		if (sscanf(argument, "%lf", &seconds) != 1 || !isfinite(seconds))
			return false;
		move_animation(c, at + seconds, c->animation.run, now);
	} else if (strcmp(name, "animation-restart") == 0) {
		move_animation(c, 0, true, now);
	} else {
		return false;
	}
	c->output.animation = true;
	return true;
}

bool controller_command(struct controller *c, const billiard_command_t *command, double now)
{
	char name[sizeof command->name], target[sizeof command->target], argument[sizeof command->argument];
	text_get(name, sizeof name, command->name, sizeof command->name);
	text_get(target, sizeof target, command->target, sizeof command->target);
	text_get(argument, sizeof argument, command->argument, sizeof command->argument);
	if (target[0] && strcmp(target, "billiard-infinity") != 0)
		return true;
	static const struct {
		const char *name;
		enum fsm_event event;
	} events[] = {{"pause", FSM_PAUSE}, {"resume", FSM_RESUME}, {"next", FSM_NEXT}, {"previous", FSM_PREVIOUS}};
	for (size_t i = 0; i < sizeof events / sizeof events[0]; i++) {
		if (strcmp(name, events[i].name) == 0) {
			event(c, events[i].event, now);
			return true;
		}
	}
	if (strcmp(name, "infinity") == 0) {
		event(c, c->fsm.state == FSM_PAUSED ? FSM_RESUME : FSM_PAUSE, now);
		return true;
	}
	if (strcmp(name, "halo") == 0)
		return toggle(c, &c->options.halo);
	if (strcmp(name, "paths") == 0)
		return toggle(c, &c->options.other_paths);
	if (strcmp(name, "table") == 0)
		return toggle(c, &c->options.table);
	if (strcmp(name, "info") == 0)
		return toggle(c, &c->options.info);
	/* What is not known here may be another program's. */
	return strncmp(name, "animation", 9) != 0 || animation_control(c, name, argument, now);
}

void controller_tick(struct controller *c, double now)
{
	if (fsm_timeout(&c->fsm, c->config->infinity.plan_timeout, now) <= 0)
		event(c, FSM_TIMEOUT, now);
}
