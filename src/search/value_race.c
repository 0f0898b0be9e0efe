/* Who leads: strokes played with the player's errors, few times the many, many times the few (sequential halving). */
#include <stdlib.h>
#include <string.h>

#include "search/value_state.h"

/* Shares of all simulations for the rounds on estimates and for the second ply. */
static const double RACE_SHARE = 0.2, REFINE_SHARE = 0.15, DEEP_SHARE = 0.4;
/* Simulations that searching the next shot takes: three pots, twelve strokes, aims counted half. */
static const double NEXT_SIMS = 3 * 12 * 1.4;

enum { FIRST_FIELD = 40, LEAST_SAMPLES = 6 };

struct leave {
	vec2 at[VALUE_SAMPLES];
	int count;
};

static void note_leave(struct stroke *stroke, const struct leave *leave)
{
	if (leave->count == 0)
		return;
	double distance[VALUE_SAMPLES];
	vec2 sum = {0, 0};
	for (int i = 0; i < leave->count; i++)
		sum = vec2_add(sum, leave->at[i]);
	stroke->leave = vec2_scale(sum, 1.0 / leave->count);
	for (int i = 0; i < leave->count; i++) {
		double d = vec2_dist(leave->at[i], stroke->leave);
		int at = i;
		for (; at > 0 && d < distance[at - 1]; at--)
			distance[at] = distance[at - 1];
		distance[at] = d;
	}
	stroke->leave_radius = distance[leave->count / 2];
}

/* One more sample of a stroke. */
static void sample(struct value_search *v, struct value_worker *worker, struct stroke *stroke, int index,
		   struct leave *leave)
{
	struct record record = stroke->record;
	struct rules_outcome outcome;
	record.shot = player_error_apply(&v->estimator.error, &stroke->record.shot, &v->point[index]);
	stroke->samples++;
	if (!value_play(v, worker, stroke->root, &record, &outcome))
		return;
	bool good = record.foul == 0 && (record.target < 0 || shot_is_as_meant(&record));
	stroke->good += good;
	stroke->sum += value_of_outcome(v, worker, &record, &outcome, v->deep);
	if (good && !outcome.cue_potted)
		leave->at[leave->count++] = outcome.ball[v->request.cue].pos;
}

static void sample_item(void *context, int item, int worker)
{
	struct value_search *v = context;
	struct stroke *stroke = &v->stroke[v->first >= 0 ? v->first + item : v->order[item]];
	struct leave leave = {.count = 0};
	/* a round begins anew: its samples are the first of the sequence for everybody */
	struct stroke fresh = *stroke;
	fresh.sum = 0;
	fresh.left = 0;
	fresh.samples = fresh.good = 0;
	for (int i = 0; i < v->to_sample; i++) {
		if (value_is_over(v))
			return; /* what was known stays */
		sample(v, &v->worker[worker], &fresh, i, &leave);
	}
	fresh.value = fresh.sum / fresh.samples;
	fresh.plies = v->deep;
	if (!v->deep || stroke->samples < fresh.samples)
		fresh.chance = (double)fresh.good / fresh.samples;
	note_leave(&fresh, &leave);
	*stroke = fresh;
}

/* Each of the first field strokes is sampled count times. */
static void round_of(struct value_search *v, int field, int count, bool deep)
{
	if (field > v->stroke_count)
		field = v->stroke_count;
	if (count > VALUE_SAMPLES)
		count = VALUE_SAMPLES;
	count += count % 2; /* samples come in pairs */
	v->to_sample = count;
	v->deep = deep;
	v->first = -1;
	uint32_t before = v->stroke_count > 0 ? v->stroke[v->order[0]].key : 0;
	pool_for(v->pool, field, sample_item, v);
	/* those out of the race keep their place behind those in it */
	for (int i = field; i < v->stroke_count; i++)
		v->stroke[v->order[i]].left = i;
	value_sort(v);
	if (v->hooks && v->hooks->improved && v->stroke[v->order[0]].key != before && !value_is_over(v))
		v->hooks->improved(v->hooks->context);
}

/* ---- neighbours of those that lead -----------------------------------------------------------------------------------
 */

enum { LEADERS = 4, PASSES = 2, MOVES = 6 };

/* The stroke with one thing changed by a step: speed, follow, side; what no aim was found for is turned a little. */
static bool neighbour(struct value_search *v, const struct stroke *from, int move, double step, struct stroke *out)
{
	struct shot shot = from->record.shot;
	double sign = move % 2 ? -step : step;
	if (move < 2)
		shot.speed *= 1 + 0.14 * sign;
	else if (move < 4)
		shot.follow += 0.12 * sign;
	else if (from->opening >= 0)
		shot.side += 0.15 * sign;
	else
		shot.angle += 0.002 * sign;
	if (hypot(shot.side, shot.follow) > 0.5 || shot.speed > v->request.max_speed)
		return false;
	if (from->opening >= 0)
		return value_try(v, &v->worker[0], &v->opening[from->opening], &shot, out);
	struct rules_outcome outcome;
	*out = *from;
	out->record.shot = shot;
	return value_play(v, &v->worker[0], out->root, &out->record, &outcome) && out->record.foul == 0;
}

static void add_neighbours(struct value_search *v, double step)
{
	int leaders = v->stroke_count < LEADERS ? v->stroke_count : LEADERS;
	uint16_t leader[LEADERS];
	memcpy(leader, v->order, sizeof leader);
	for (int i = 0; i < leaders; i++)
		for (int move = 0; move < MOVES && v->stroke_count < VALUE_STROKES && !value_is_over(v); move++) {
			struct stroke *out = &v->stroke[v->stroke_count];
			if (!neighbour(v, &v->stroke[leader[i]], move, step, out))
				continue;
			out->key = (uint32_t)v->stroke_count++;
		}
}

/* Continuous in speed and tip: the best are moved a little, and what is better takes their place. */
static void refine(struct value_search *v)
{
	double sims = REFINE_SHARE * (double)v->request.sims;
	int count = 2 * (int)(sims / PASSES / (2 * LEADERS * MOVES));
	for (int pass = 0; pass < PASSES && count >= LEAST_SAMPLES && !value_is_over(v); pass++) {
		int first = v->stroke_count;
		add_neighbours(v, pass == 0 ? 1 : 0.5);
		v->to_sample = count < VALUE_SAMPLES ? count : VALUE_SAMPLES;
		v->deep = false;
		v->first = first;
		pool_for(v->pool, v->stroke_count - first, sample_item, v);
		value_sort(v);
	}
}

void value_race(struct value_search *v)
{
	double sims = RACE_SHARE * (double)v->request.sims;
	if (v->stroke_count == 0)
		return;
	if (v->hooks && v->hooks->improved && !value_is_over(v))
		v->hooks->improved(v->hooks->context);
	int field = FIRST_FIELD, rounds = 3;
	for (int i = 0; i < rounds && !value_is_over(v); i++) {
		int count = (int)(sims / rounds / field);
		if (count < LEAST_SAMPLES)
			count = LEAST_SAMPLES;
		round_of(v, field, count, false);
		field = field * 2 / 5;
	}
	refine(v);
	/* the second ply by halving, too: half of its samples for many leaders, half for few */
	double deep = DEEP_SHARE * (double)v->request.sims / NEXT_SIMS;
	int leaders = deep >= 120 ? 12 : 4;
	for (int i = 0; i < 2 && !value_is_over(v); i++, leaders /= 3) {
		int count = (int)(deep / 2 / leaders);
		if (count >= LEAST_SAMPLES - 1)
			round_of(v, leaders, count, true);
	}
}
