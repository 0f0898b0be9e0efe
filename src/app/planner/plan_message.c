#include "app/planner/plan_message.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "app/process/bus.h"
#include "physics/motion.h"

/* ---- balls ---------------------------------------------------------------------------------------------------------- */

void ball_to_message(billiard_ball_t *out, const struct ball *ball, const char *name, int track)
{
	*out = (billiard_ball_t){
		.track = track,
		.colour = (int8_t)ball->colour,
		.phase = (int8_t)ball->phase,
		.x = ball->pos.x,
		.y = ball->pos.y,
		.vx = ball->vel.x,
		.vy = ball->vel.y,
		.confidence = 1,
	};
	bus_set_text(out->name, sizeof out->name, name);
}

bool ball_from_message(struct ball *out, const billiard_ball_t *ball)
{
	if (ball->colour < 0 || ball->colour >= COLOUR_COUNT || ball->phase < 0 || ball->phase > BALL_POTTED)
		return false;
	struct ball b = ball_at((enum ball_colour)ball->colour, (vec2){ball->x, ball->y});
	b.vel = (vec2){ball->vx, ball->vy};
	b.phase = (enum ball_phase)ball->phase;
	if (!ball_is_finite(&b) || fabs(b.pos.x) > 100 || fabs(b.pos.y) > 100)
		return false;
	*out = b;
	return true;
}

/* ---- request -------------------------------------------------------------------------------------------------------- */

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

/* ---- plan ----------------------------------------------------------------------------------------------------------- */

void plan_message_begin(billiard_plan_t *out, const billiard_plan_request_t *request)
{
	memset(out, 0, sizeof *out);
	out->request_id = request->id;
	int count = request->ball_count < 0 ? 0 : request->ball_count > BALL_MAX ? BALL_MAX : request->ball_count;
	out->ball_count = count;
	for (int i = 0; i < count; i++) {
		memcpy(out->names[i], request->balls[i].name, sizeof out->names[i]);
		out->colours[i] = request->balls[i].colour;
	}
}

static void fill_shot(billiard_plan_shot_t *out, const struct plan_shot *shot, int ball_count)
{
	*out = (billiard_plan_shot_t){
		.angle = shot->shot.angle,
		.speed = shot->shot.speed,
		.side = shot->shot.side,
		.follow = shot->shot.follow,
		.elevation = shot->shot.elevation,
		.target = shot->target,
		.pocket = shot->pocket,
		.chain = {-1, -1, -1, -1},
		.chain_count = (int8_t)shot->chain_count,
		.rails = (int8_t)shot->rails,
		.potted_count = (int8_t)shot->potted_count,
		.points = shot->points,
		.foul = shot->foul,
		.cost = shot->cost,
		.tolerance_angle = shot->tolerance_angle,
		.tolerance_speed = shot->tolerance_speed,
		.success = isfinite(shot->success) ? shot->success : -1,
		.hash = (int64_t)shot->hash,
	};
	for (int i = 0; i < shot->chain_count; i++)
		out->chain[i] = shot->chain[i];
	for (int i = 0; i < shot->potted_count; i++) {
		out->potted_ball[i] = shot->potted[i].ball;
		out->potted_pocket[i] = shot->potted[i].pocket;
	}
	for (int i = 0; i < ball_count; i++) {
		out->start_x[i] = shot->start[i].pos.x;
		out->start_y[i] = shot->start[i].pos.y;
		out->start_on[i] = shot->start[i].phase != BALL_POTTED;
	}
}

static bool add_keyframe(billiard_plan_t *out, const struct table *table, const struct ball *state, int ball,
			 double begin, double end, enum event_kind event)
{
	if (out->keyframe_count == PLAN_MESSAGE_KEYFRAMES)
		return false;
	vec2 a = motion_acceleration(state, table);
	out->keyframes[out->keyframe_count++] = (billiard_keyframe_t){
		.begin = begin,
		.end = end,
		.ball = (int16_t)ball,
		.phase = (int8_t)state->phase,
		.event = (int8_t)event,
		.x = state->pos.x,
		.y = state->pos.y,
		.vx = state->vel.x,
		.vy = state->vel.y,
		.ax = a.x,
		.ay = a.y,
	};
	return true;
}

/* Keyframes of one ball: one per stretch of closed-form motion. False when there is no room. */
static bool add_ball(billiard_plan_t *out, const struct trace *trace, int ball)
{
	double end = trace_end(trace), begin = 0;
	struct ball state = trace->start[ball];
	enum event_kind event = EVENT_STRIKE;
	for (int i = 0; i < trace->count; i++) {
		const struct trace_entry *e = &trace->entry[i];
		bool second = e->event.kind == EVENT_BALL_BALL && e->event.other == ball;
		/* The states at the start are those after the strike. */
		if ((e->event.ball != ball && !second) || e->event.kind == EVENT_STRIKE)
			continue;
		if (!add_keyframe(out, trace->table, &state, ball, begin, e->event.time, event))
			return false;
		state = e->after[second];
		begin = e->event.time;
		event = e->event.kind;
	}
	return add_keyframe(out, trace->table, &state, ball, begin, end, event);
}

/* All balls of one shot, or none. */
static void add_keyframes(billiard_plan_t *out, billiard_plan_shot_t *shot, const struct trace *trace)
{
	int first = out->keyframe_count;
	shot->keyframe_first = first;
	for (int ball = 0; ball < trace->ball_count; ball++) {
		if (trace->start[ball].phase == BALL_POTTED)
			continue;
		if (!add_ball(out, trace, ball)) {
			memset(&out->keyframes[first], 0,
			       (size_t)(out->keyframe_count - first) * sizeof out->keyframes[0]);
			out->keyframe_count = first;
			return;
		}
	}
	shot->keyframe_count = out->keyframe_count - first;
}

void plan_message_fill(billiard_plan_t *out, const struct plan_result *result, const struct table *table,
		       const struct model *model, struct trace_entry *scratch)
{
	out->status = result->status == PLAN_CANCELLED ? PLAN_MESSAGE_CANCELLED
		      : result->plan_count	       ? PLAN_MESSAGE_OK
						       : PLAN_MESSAGE_NONE;
	out->found = result->found;
	out->nodes = (int64_t)result->nodes;
	out->sims = (int64_t)result->sims;
	out->entry_count = result->plan_count < PLAN_MESSAGE_ENTRIES ? result->plan_count : PLAN_MESSAGE_ENTRIES;
	out->keyframe_count = 0;
	/* Nothing of a former plan stays behind the counts: the same plans make the same message, bit for bit. */
	memset(out->entries, 0, sizeof out->entries);
	memset(out->keyframes, 0, sizeof out->keyframes);
	struct trace trace;
	for (int i = 0; i < out->entry_count; i++) {
		const struct plan *plan = &result->plan[i];
		billiard_plan_entry_t *entry = &out->entries[i];
		entry->cost = plan->cost;
		entry->shot_count = plan->shot_count < PLAN_MESSAGE_SHOTS ? plan->shot_count : PLAN_MESSAGE_SHOTS;
		for (int k = 0; k < entry->shot_count; k++) {
			fill_shot(&entry->shots[k], &plan->shot[k], out->ball_count);
			trace_init(&trace, scratch, PLAN_TRACE_MAX);
			plan_shot_replay(table, model, &plan->shot[k], out->ball_count, &trace);
			if (!trace.overflow)
				add_keyframes(out, &entry->shots[k], &trace);
		}
	}
}

/* ---- checks --------------------------------------------------------------------------------------------------------- */

/* What no table exceeds: m, m/s or m/s^2, s. Drawing then needs no care for overflow. */
static const double PLACE_MAX = 100, SPEED_MAX = 1000, TIME_MAX = 3600;

static bool in(long value, long low, long high)
{
	return value >= low && value <= high;
}

static bool within(double value, double limit)
{
	return fabs(value) <= limit; /* false for NaN */
}

static bool shot_ok(const billiard_plan_t *plan, const billiard_plan_shot_t *shot, const struct table *table)
{
	bool ok = in(shot->target, -1, plan->ball_count - 1) && in(shot->pocket, -1, table->pocket_count - 1) &&
		  in(shot->chain_count, 0, 4) && in(shot->potted_count, 0, 8) && within(shot->angle, 100) &&
		  within(shot->speed, 100) && within(shot->side, 1) && within(shot->follow, 1) &&
		  within(shot->elevation, 2) && isfinite(shot->cost) && isfinite(shot->tolerance_angle) &&
		  isfinite(shot->tolerance_speed) && within(shot->success, 1) &&
		  in(shot->keyframe_first, 0, plan->keyframe_count) &&
		  in(shot->keyframe_count, 0, plan->keyframe_count - shot->keyframe_first);
	for (int i = 0; ok && i < shot->chain_count; i++)
		ok = in(shot->chain[i], 0, plan->ball_count - 1);
	for (int i = 0; ok && i < shot->potted_count; i++)
		ok = in(shot->potted_ball[i], 0, plan->ball_count - 1) &&
		     in(shot->potted_pocket[i], 0, table->pocket_count - 1);
	for (int i = 0; ok && i < plan->ball_count; i++)
		ok = within(shot->start_x[i], PLACE_MAX) && within(shot->start_y[i], PLACE_MAX);
	return ok;
}

static bool keyframe_ok(const billiard_keyframe_t *k, int ball_count)
{
	return in(k->ball, 0, ball_count - 1) && in(k->phase, 0, BALL_POTTED) &&
	       in(k->event, 0, EVENT_KIND_COUNT - 1) && k->begin >= 0 && k->begin <= k->end && k->end <= TIME_MAX &&
	       within(k->x, PLACE_MAX) && within(k->y, PLACE_MAX) && within(k->vx, SPEED_MAX) &&
	       within(k->vy, SPEED_MAX) && within(k->ax, SPEED_MAX) && within(k->ay, SPEED_MAX);
}

bool plan_message_check(const billiard_plan_t *plan, const struct table *table)
{
	bool ok = plan->request_id > 0 && in(plan->status, PLAN_MESSAGE_OK, PLAN_MESSAGE_REFUSED) &&
		  in(plan->ball_count, 0, BALL_MAX) && in(plan->entry_count, 0, PLAN_MESSAGE_ENTRIES) &&
		  in(plan->keyframe_count, 0, PLAN_MESSAGE_KEYFRAMES) &&
		  (plan->status != PLAN_MESSAGE_OK || plan->entry_count > 0);
	for (int i = 0; ok && i < plan->ball_count; i++)
		ok = in(plan->colours[i], 0, COLOUR_COUNT - 1);
	for (int i = 0; ok && i < plan->keyframe_count; i++)
		ok = keyframe_ok(&plan->keyframes[i], plan->ball_count);
	for (int i = 0; ok && i < plan->entry_count; i++) {
		const billiard_plan_entry_t *entry = &plan->entries[i];
		ok = in(entry->shot_count, 1, PLAN_MESSAGE_SHOTS) && isfinite(entry->cost);
		for (int k = 0; ok && k < entry->shot_count; k++)
			ok = shot_ok(plan, &entry->shots[k], table);
	}
	return ok;
}

void plan_message_animation(billiard_animation_t *out, const billiard_plan_t *plan, int entry, int shot)
{
	const billiard_plan_shot_t *s = &plan->entries[entry].shots[shot];
	*out = (billiard_animation_t){.plan_id = plan->request_id, .run = 1, .rate = 1, .ball_count = plan->ball_count};
	memcpy(out->colours, plan->colours, sizeof out->colours);
	out->keyframe_count = s->keyframe_count;
	memcpy(out->keyframes, plan->keyframes + s->keyframe_first,
	       (size_t)s->keyframe_count * sizeof out->keyframes[0]);
}

bool plan_message_same_motion(const billiard_animation_t *a, const billiard_animation_t *b)
{
	return a->plan_id == b->plan_id && a->keyframe_count == b->keyframe_count &&
	       memcmp(a->keyframes, b->keyframes, (size_t)a->keyframe_count * sizeof a->keyframes[0]) == 0;
}

double plan_message_animation_length(const billiard_animation_t *animation)
{
	double end = 0;
	for (int i = 0; i < animation->keyframe_count; i++)
		end = fmax(end, animation->keyframes[i].end);
	return end;
}

double plan_message_animation_time(const billiard_animation_t *animation, double elapsed)
{
	if (!animation->run)
		return animation->position;
	double length = plan_message_animation_length(animation), period = length + animation->pause;
	return period > 0 ? fmin(fmod(animation->position + animation->rate * elapsed, period), length) : 0;
}

bool plan_message_animation_check(const billiard_animation_t *a)
{
	bool ok = in(a->keyframe_count, 0, PLAN_MESSAGE_KEYFRAMES) && in(a->ball_count, 0, BALL_MAX) && a->rate >= 0 &&
		  a->rate <= 100 && a->pause >= 0 && a->pause <= TIME_MAX && a->position >= 0 &&
		  a->position <= TIME_MAX && a->ball_radius >= 0 && a->ball_radius < 1;
	for (int i = 0; ok && i < a->ball_count; i++)
		ok = in(a->colours[i], 0, COLOUR_COUNT - 1);
	for (int i = 0; ok && i < a->keyframe_count; i++)
		ok = keyframe_ok(&a->keyframes[i], a->ball_count);
	return ok;
}
