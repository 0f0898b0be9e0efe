#include "app/control/controller.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/process/text.h"
#include "app/process/ball_message.h"
#include "app/planner/plan_check.h"
#include "app/light/animation.h"
#include "app/planner/plan_message.h"
#include "app/control/words.h"
#include "vision/vision.h"

/* What a camera's errors may do to a layout; more is no error but a wrong position. */
static const double SHIFT_MAX = 0.006, OVERLAP_MAX = 0.005; /* m */
static const double POT_WAIT = 1;			    /* s a proposal that pots nothing waits for one that does */
static const double SHOT_TIME = 60; /* s after which a shot that nobody saw come to rest is given up */

static struct stability_limits stability_limits_of(const struct config_infinity *c)
{
	return (struct stability_limits){.still_distance = c->still_distance,
					 .cue_distance = c->cue_distance,
					 .still_time = c->still_time,
					 .cue_time = c->cue_time,
					 .lost_time = c->lost_time,
					 .new_time = c->new_time,
					 .clear_time = c->clear_time,
					 .moving_time = c->moving_time,
					 .blind_time = c->blind_time};
}

void controller_init(struct controller *c, const struct config *config)
{
	*c = (struct controller){
		.config = config,
		.fsm = {FSM_BLIND, 0},
		.options = draw_options_default(),
		.animate = true,
		.note = "waiting for the camera",
		.last_arrival = -1,
		.unsure_since = -1,
	};
	struct stability_limits limits = stability_limits_of(&config->infinity);
	stability_init(&c->stability, &limits);
	draw_clear(&c->draw);
	c->output.draw = true;
}

/* ---- actions -------------------------------------------------------------------------------------------------------- */

static void note(struct controller *c, const char *text)
{
	snprintf(c->note, sizeof c->note, "%s", text);
}

/* Spots that balls are wanted on, and where the cue ball may be placed. */
static void draw_game(struct controller *c)
{
	const struct game *game = &c->keeper.game;
	double radius = c->config->table.ball_radius;
	if (!c->config->infinity.rules || c->fsm.state == FSM_SHOT || c->fsm.state == FSM_PAUSED)
		return;
	for (int i = 0; i < game->wish_count; i++)
		draw_ring(&c->draw, game->wish[i].place, 1.2 * radius, 0.2 * radius,
			  draw_ball_rgba((int)game->wish[i].colour));
	if (game->state.in_hand || keeper_cue_fell(&c->keeper, &c->config->table))
		draw_region_in_hand(&c->draw, &c->config->table, c->seen.ball, c->seen.count);
}

/* Rings only where balls are known to rest. */
static void draw_nothing(struct controller *c, const char *text)
{
	bool at_rest = c->fsm.state == FSM_PLANNING || c->fsm.state == FSM_SHOWING;
	bool empty = c->draw.plan_id == 0 && (text[0] || c->draw.item_count == 0);
	if (!at_rest && empty && strcmp(c->drawn_note, text) == 0)
		return;
	snprintf(c->drawn_note, sizeof c->drawn_note, "%s", text);
	draw_clear(&c->draw);
	draw_idle(&c->draw, &c->config->table,
		  &(struct draw_resting){c->seen.ball, at_rest ? c->seen.count : 0, c->drawn_note}, &c->options);
	draw_game(c);
	c->draw.plan_id = 0;
	c->animation = (billiard_animation_t){0};
	c->output.draw = c->output.animation = true;
}

static void draw_shown(struct controller *c)
{
	c->drawn_note[0] = '\0';
	draw_clear(&c->draw);
	draw_proposal(&c->draw, &c->config->table, &(struct draw_subject){&c->plan, c->entry, c->shot}, &c->options);
	draw_game(c);
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

static void name_balls(billiard_plan_request_t *r, const struct layout *layout)
{
	char name[16];
	int number[COLOUR_COUNT] = {0};
	for (int i = 0; i < layout->count; i++) {
		enum ball_colour colour = layout->ball[i].colour;
		snprintf(name, sizeof name, "%s%d", ball_colour_name(colour), number[colour]++);
		ball_to_message(&r->balls[i], &layout->ball[i], name, layout->track[i]);
	}
}

static void request(struct controller *c, double now)
{
	const struct config_planner *p = &c->config->planner;
	bool rules = c->config->infinity.rules;
	c->asked = c->seen;
	c->asked_at = now;
	c->has_asked = true;
	c->has_plan = c->has_offer = c->has_none = c->was_cancelled = false;
	c->entry = c->shot = 0;
	billiard_plan_request_t *r = &c->request;
	/* The frame's time as id: larger than all former ones, also after a restart, and the same in a replay. */
	int64_t id = c->last_frame > c->request.id ? c->last_frame : c->request.id + 1;
	*r = (billiard_plan_request_t){
		.id = id,
		.ball_count = c->settled.count,
		.target_kind = rules ? TARGET_RULES : TARGET_ANY,
		.on = rules ? (int8_t)c->keeper.game.state.on : ON_ANY,
		.in_hand = rules && c->keeper.game.state.in_hand,
		.depth = p->depth,
		.rails = p->rails,
		.max_balls = p->balls,
		.speeds = p->speeds,
		.plans = p->plans,
		.budget_nodes = (int64_t)p->budget_nodes,
		.budget_s = p->budget,
	};
	name_balls(r, &c->settled);
	c->output.request = true;
}

/* The planner lost the request, or somebody else had it ended: then it knows the id as done, and only a new one helps. */
static void repeat(struct controller *c, double now)
{
	if (c->was_cancelled)
		request(c, now);
	else
		c->output.request = true;
}

static int wrap(int value, int count)
{
	return count > 0 ? (value % count + count) % count : 0;
}

static void show(struct controller *c, double now)
{
	if (!c->has_plan) {
		draw_nothing(c, c->none_reason);
		return;
	}
	draw_shown(c);
	animate_shown(c, now);
}

static void redraw(struct controller *c)
{
	char text[CONTROLLER_NOTE_SIZE];
	memcpy(text, c->drawn_note, sizeof text);
	if (c->draw.plan_id) {
		draw_shown(c);
		return;
	}
	c->draw.item_count = 1; /* what is there is to look otherwise: never the same */
	c->drawn_note[0] = '\0';
	draw_nothing(c, text);
}

static void perform_asking(struct controller *c, unsigned actions, double now)
{
	if (actions & FSM_DO_CANCEL) {
		c->output.cancel = true;
		c->output.cancel_id = c->request.id;
	}
	if (actions & FSM_DO_CLEAR)
		draw_nothing(c, "");
	if (actions & FSM_DO_FORGET)
		c->has_plan = c->has_offer = c->has_none = false;
	if (actions & FSM_DO_REQUEST)
		request(c, now);
	if (actions & FSM_DO_REPEAT)
		repeat(c, now);
}

static void perform_showing(struct controller *c, unsigned actions, double now)
{
	if (actions & FSM_DO_NEXT)
		c->entry = wrap(c->entry + 1, c->plan.entry_count);
	if (actions & FSM_DO_PREVIOUS)
		c->entry = wrap(c->entry - 1, c->plan.entry_count);
	if (actions & FSM_DO_SHOW)
		show(c, now);
	if (actions & FSM_DO_NOTE)
		draw_nothing(c, c->note);
	if (actions & FSM_DO_REDRAW)
		redraw(c);
}

static void event(struct controller *c, enum fsm_event e, double now)
{
	unsigned actions = fsm_step(&c->fsm, e, now);
	perform_asking(c, actions, now);
	perform_showing(c, actions, now);
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

void controller_doubt(struct controller *c, const billiard_vision_doubt_t *doubt)
{
	c->doubt = *doubt;
}

/* A colour matters when the rules are played, and the cue ball's always. */
static bool ball_is_doubted(const struct controller *c, const struct layout *layout, int i)
{
	int doubt = c->doubt.ball_doubt[i];
	bool colour = c->config->infinity.rules || layout->ball[i].colour == COLOUR_WHITE;
	return (doubt & (DOUBT_PLACE | DOUBT_HIDDEN)) || ((doubt & DOUBT_COLOUR) && colour);
}

/* A vision that tells its doubts tells them for every frame: where they are missing they were lost. */
static struct stability_view view_of(const struct controller *c, const billiard_table_state_t *state,
				     const struct layout *layout)
{
	struct stability_view view = {
		.time = 1e-6 * (double)state->utime, .occluded = state->occluded != 0, .doubted = -1};
	if (c->doubt.utime == 0)
		return view;
	view.looking = c->doubt.utime != state->utime || (c->doubt.doubt & DOUBT_UNJUDGED) ||
		       c->doubt.ball_count != layout->count;
	for (int i = 0; i < layout->count && !view.looking && view.doubted < 0; i++)
		if (ball_is_doubted(c, layout, i))
			view.doubted = i;
	return view;
}

/* Whether balls can lie as they are seen. What cannot be settled is no position. */
static bool holds_together(struct controller *c)
{
	/* Which colour a ball has matters by the rules. */
	int culprit = c->config->infinity.rules ? layout_second_of_colour(&c->seen) : -1;
	if (culprit >= 0) {
		words_of_ball(c->word, &c->seen.ball[culprit], "seen twice");
		return false;
	}
	const struct layout_limits limits = {SHIFT_MAX, OVERLAP_MAX, c->config->model.pocket == POCKET_MODEL_JAWS};
	c->settled = c->seen;
	if (layout_settle(&c->settled, &c->config->table, &limits, &culprit))
		return true;
	words_of_ball(c->word, &c->seen.ball[culprit], "cannot lie there");
	return false;
}

static void report(struct controller *c, enum stability_verdict verdict, const struct layout *layout)
{
	c->report = (billiard_stability_t){.utime = c->last_frame, .verdict = (int8_t)verdict};
	if (verdict != STABILITY_STABLE)
		text_set(c->report.word, sizeof c->report.word, c->word);
	words_report(c->report.conditions, &c->stability, layout);
	c->output.stability = true;
}

/* The game goes on with what lies there now; what has to be done before anybody plays becomes the note. True: there is something. */
static bool keep_game(struct controller *c)
{
	char demand[GAME_TEXT_SIZE];
	if (!c->config->infinity.rules)
		return false;
	if (keeper_rest(&c->keeper, &c->config->table, &c->seen, c->config->infinity.nudge_distance,
			1e-6 * (double)c->last_frame)) {
		c->output.game = true;
		c->has_plan = c->has_none = false; /* another shot is wanted, even where no ball lies elsewhere */
	}
	game_demand(&c->keeper.game, demand);
	note(c, demand);
	return demand[0] != '\0';
}

/* What was asked for, or has an answer, lies there still: a hand that passed changes nothing. */
static bool is_known(const struct controller *c)
{
	bool kept = c->has_plan || c->has_none || c->fsm.state == FSM_PLANNING;
	return c->has_asked && kept && !layout_differs(&c->asked, &c->seen, c->config->infinity.nudge_distance);
}

static void on_unsure(struct controller *c, double now)
{
	if (c->unsure_since < 0)
		c->unsure_since = now;
	if (now - c->unsure_since < c->config->infinity.tell_time)
		return;
	note(c, c->word);
	event(c, FSM_DOUBT, now);
}

static void on_verdict(struct controller *c, enum stability_verdict verdict, double now)
{
	if (verdict != STABILITY_UNSURE)
		c->unsure_since = -1;
	switch (verdict) {
	case STABILITY_LOST:
		note(c, c->word);
		event(c, FSM_LOST, now);
		break;
	case STABILITY_MOVING:
		event(c, FSM_MOVING, now);
		break;
	case STABILITY_STABLE:
		event(c, keep_game(c) ? FSM_WISH : is_known(c) ? FSM_SAME : FSM_STABLE, now);
		break;
	case STABILITY_UNSURE:
		on_unsure(c, now);
		break;
	}
}

static void say_blindness(struct controller *c, const billiard_table_state_t *state)
{
	bool fell = c->config->infinity.rules && keeper_cue_fell(&c->keeper, &c->config->table);
	if (state->calibration != 0 && fell)
		snprintf(c->word, sizeof c->word, "CUE BALL IN HAND: PLACE IT IN THE D");
	else
		words_of_blindness(c->word, state);
}

bool controller_state(struct controller *c, const billiard_table_state_t *state, double now)
{
	struct layout layout;
	/* A clock that was set back, or another log: begin anew after two seconds' worth of doubt. */
	if (state->utime <= c->last_frame && c->last_frame - state->utime < 2000000)
		return false;
	layout_from_message(&layout, state);
	c->last_frame = state->utime;
	c->last_arrival = now;
	struct stability_view view = view_of(c, state, &layout);
	bool seen = state->calibration != 0;
	enum stability_verdict verdict = stability_frame(&c->stability, seen ? &layout : NULL, &view);
	if (verdict == STABILITY_LOST)
		say_blindness(c, state);
	else
		words_of_obstacle(c->word, &c->stability, &layout, &view, &c->doubt);
	struct layout whole = layout;
	if (seen && layout.cue >= 0) {
		drop_false_whites(&layout);
		c->seen = layout;
	}
	if (seen && c->config->infinity.rules)
		keeper_frame(&c->keeper, &c->config->table, &layout, view.time, view.occluded);
	if (verdict == STABILITY_STABLE && !holds_together(c))
		verdict = STABILITY_UNSURE;
	report(c, verdict, &whole);
	on_verdict(c, verdict, now);
	return true;
}

/* ---- answers and commands ------------------------------------------------------------------------------------------- */

static bool same_first_shot(const billiard_plan_t *a, const billiard_plan_t *b)
{
	const billiard_plan_shot_t *s = &a->entries[0].shots[0], *t = &b->entries[0].shots[0];
	return s->angle == t->angle && s->speed == t->speed && s->side == t->side && s->follow == t->follow &&
	       s->elevation == t->elevation && s->target == t->target && s->pocket == t->pocket;
}

/* What is drawn stays: it makes way for the same shot with more to it, or for one that is better by a margin, and for neither once the
 * player looks at another proposal. */
static bool makes_way(const struct controller *c)
{
	if (!c->has_plan)
		return true;
	if (c->entry != 0)
		return false;
	double now = c->plan.entries[0].cost, then = c->offered.entries[0].cost;
	return same_first_shot(&c->plan, &c->offered) || then < now - c->config->infinity.better_margin * fabs(now);
}

/* A proposal is shown when it is final or has not changed for a while: for longer when it pots nothing, a pot mostly follows. */
static bool has_settled(const struct controller *c, double now)
{
	double wait = c->config->infinity.show_time;
	if (c->offered.entries[0].shots[0].target < 0)
		wait = fmax(wait, POT_WAIT);
	return c->offered.is_final || now - c->offered_since >= wait;
}

static void settle_offer(struct controller *c, double now)
{
	if (!c->has_offer || !has_settled(c, now))
		return;
	c->has_offer = false;
	if (!makes_way(c))
		return;
	c->proposals += !c->has_plan;
	c->plan = c->offered;
	c->has_plan = true;
	c->shot = 0;
	event(c, FSM_READY, now);
}

static void take_refusal(struct controller *c, const billiard_plan_t *plan, double now)
{
	if (!plan->is_final || c->has_plan || c->has_offer)
		return;
	text_get(c->none_reason, sizeof c->none_reason, plan->reason, sizeof plan->reason);
	note(c, c->none_reason);
	c->has_none = true;
	event(c, FSM_NONE, now);
}

bool controller_plan(struct controller *c, const billiard_plan_t *plan, double now)
{
	bool wanted = c->fsm.state == FSM_PLANNING || c->fsm.state == FSM_SHOWING;
	if (plan->request_id != c->request.id || !plan_check(plan, &c->config->table))
		return false;
	c->was_cancelled = plan->status == PLAN_MESSAGE_CANCELLED;
	if (c->was_cancelled || !wanted)
		return true;
	if (plan->status != PLAN_MESSAGE_OK) {
		take_refusal(c, plan, now);
		return true;
	}
	bool first = !c->has_plan && !c->has_offer;
	if (!first && plan->sequence < c->sequence)
		return true;
	if (!c->has_offer || !same_first_shot(&c->offered, plan))
		c->offered_since = now;
	c->sequence = plan->sequence;
	c->offered = *plan;
	c->has_offer = true;
	settle_offer(c, now);
	return true;
}

static bool toggle(struct controller *c, bool *what, double now)
{
	*what = !*what;
	event(c, FSM_REDRAW, now);
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

static bool correct_game(struct controller *c, const char *words, double now)
{
	char err[2 * GAME_TEXT_SIZE];
	if (!keeper_correct(&c->keeper, words, err, sizeof err))
		return false;
	c->output.game = true;
	event(c, FSM_ANEW, now);
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
	} events[] = {{"pause", FSM_PAUSE},
		      {"resume", FSM_RESUME},
		      {"infinity", FSM_TOGGLE},
		      {"next", FSM_NEXT},
		      {"previous", FSM_PREVIOUS}};
	for (size_t i = 0; i < sizeof events / sizeof events[0]; i++) {
		if (strcmp(name, events[i].name) == 0) {
			event(c, events[i].event, now);
			return true;
		}
	}
	if (strcmp(name, "game") == 0)
		return correct_game(c, argument, now);
	if (strcmp(name, "halo") == 0)
		return toggle(c, &c->options.halo, now);
	if (strcmp(name, "paths") == 0)
		return toggle(c, &c->options.other_paths, now);
	if (strcmp(name, "table") == 0)
		return toggle(c, &c->options.table, now);
	if (strcmp(name, "info") == 0)
		return toggle(c, &c->options.info, now);
	/* What is not known here may be another program's. */
	return strncmp(name, "animation", 9) != 0 || animation_control(c, name, argument, now);
}

/* Nobody sees the table any more: what is on it may be true no longer. */
static void hear_silence(struct controller *c, double now)
{
	if (c->last_arrival < 0)
		c->last_arrival = now;
	if (now - c->last_arrival < c->config->infinity.silence_time)
		return;
	note(c, "no pictures: billiard-vision is silent");
	event(c, FSM_SILENT, now);
}

static void miss_answer(struct controller *c, double now)
{
	if (c->fsm.state != FSM_PLANNING || c->has_offer || now - c->asked_at < c->config->infinity.silence_time)
		return;
	note(c, "no answer from the planner yet");
	if (strcmp(c->note, c->drawn_note) != 0)
		event(c, FSM_LATE, now);
}

void controller_tick(struct controller *c, double now)
{
	const struct fsm_limits limits = {c->config->infinity.plan_timeout, SHOT_TIME};
	hear_silence(c, now);
	miss_answer(c, now);
	if (c->fsm.state == FSM_PLANNING || c->fsm.state == FSM_SHOWING)
		settle_offer(c, now);
	if (fsm_timeout(&c->fsm, &limits, now) <= 0)
		event(c, FSM_TIMEOUT, now);
}
