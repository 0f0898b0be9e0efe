#include "app/planner/plan_message.h"

#include <math.h>
#include <string.h>

#include "physics/motion.h"

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

static billiard_keyframe_t keyframe_of(const struct ball *state, int ball, const struct table *table)
{
	vec2 a = motion_acceleration(state, table);
	return (billiard_keyframe_t){
		.ball = (int16_t)ball,
		.phase = (int8_t)state->phase,
		.x = state->pos.x,
		.y = state->pos.y,
		.vx = state->vel.x,
		.vy = state->vel.y,
		.ax = a.x,
		.ay = a.y,
	};
}

static bool add_keyframe(billiard_plan_t *out, const billiard_keyframe_t *keyframe, double end)
{
	if (out->keyframe_count == PLAN_MESSAGE_KEYFRAMES)
		return false;
	out->keyframes[out->keyframe_count] = *keyframe;
	out->keyframes[out->keyframe_count++].end = end;
	return true;
}

/* Keyframes of one ball: one per stretch of closed-form motion. False when there is no room. */
static bool add_ball(billiard_plan_t *out, const struct trace *trace, int ball)
{
	billiard_keyframe_t keyframe = keyframe_of(&trace->start[ball], ball, trace->table);
	keyframe.event = EVENT_STRIKE;
	for (int i = 0; i < trace->count; i++) {
		const struct trace_entry *e = &trace->entry[i];
		bool second = e->event.kind == EVENT_BALL_BALL && e->event.other == ball;
		/* The states at the start are those after the strike. */
		if ((e->event.ball != ball && !second) || e->event.kind == EVENT_STRIKE)
			continue;
		if (!add_keyframe(out, &keyframe, e->event.time))
			return false;
		keyframe = keyframe_of(&e->after[second], ball, trace->table);
		keyframe.begin = e->event.time;
		keyframe.event = (int8_t)e->event.kind;
	}
	return add_keyframe(out, &keyframe, trace_end(trace));
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

void plan_message_animation(billiard_animation_t *out, const billiard_plan_t *plan, int entry, int shot)
{
	const billiard_plan_shot_t *s = &plan->entries[entry].shots[shot];
	*out = (billiard_animation_t){.plan_id = plan->request_id, .run = 1, .rate = 1, .ball_count = plan->ball_count};
	memcpy(out->colours, plan->colours, sizeof out->colours);
	out->keyframe_count = s->keyframe_count;
	memcpy(out->keyframes, plan->keyframes + s->keyframe_first,
	       (size_t)s->keyframe_count * sizeof out->keyframes[0]);
}
