/* Contact shots: a fan of directions in which a ball on is met first, over any cushions; the leave decides. */
#include <string.h>

#include "search/value_state.h"

enum { DIRECTIONS_MIN = 64, FAN_EVENTS = 16, SPEED_COUNT = 8, TRIALS = 6 };
static const double SPEEDS[SPEED_COUNT] = {0.6, 0.9, 1.3, 1.8, 2.4, 3.1, 3.9, 4.8};
static const double FAN_SPEED = 2.4;  /* m/s, for finding out what is met first */
static const double FAN_SHARE = 0.15; /* of all simulations */

/* The object ball that is met first in that direction; -1 none. */
static int first_met(struct value_search *v, struct value_worker *worker, const struct value_root *root, double angle)
{
	struct sim *sim = &worker->work.sim;
	struct event event;
	struct shot shot = {.angle = angle, .speed = FAN_SPEED};
	sim_init(sim, v->table, &v->model, root->ball, v->request.ball_count);
	sim_strike(sim, v->request.cue, &shot);
	for (int i = 0; i < FAN_EVENTS && sim_step(sim, &event); i++) {
		if (event.kind == EVENT_POCKET)
			return -1;
		if (event.kind == EVENT_BALL_BALL)
			return event.ball == v->request.cue ? event.other : event.ball;
	}
	return -1;
}

/* Directions of the fan that meet a ball on, thinned out evenly. */
static void find_directions(struct fan *fan)
{
	struct value_search *v = fan->value;
	const struct value_root *root = &v->request.root[0];
	int found = 0;
	for (int i = 0; i < FAN && !value_is_over(v); i++) {
		double angle = 2 * M_PI * i / FAN - M_PI; /* as atan2 has it */
		int met = first_met(v, &v->worker[0], root, angle);
		if (met >= 0 && rules_ball_on(&root->rules, root->ball, v->request.ball_count, met))
			fan->angle[found++] = angle;
	}
	v->worker[0].sims += FAN / 8;
	int most = (int)(FAN_SHARE * (double)v->request.sims / SPEED_COUNT);
	most = most < DIRECTIONS_MIN ? DIRECTIONS_MIN : most > FAN_DIRECTIONS ? FAN_DIRECTIONS : most;
	fan->count = found < most ? found : most;
	for (int i = 0; i < fan->count && found > most; i++)
		fan->angle[i] = fan->angle[i * found / most];
}

/* What falls by rule makes the contact a pot: plants, cushions and kisses that no chain was built for. */
static void name_pot(const struct value_search *v, struct record *record)
{
	const struct value_root *root = &v->request.root[0];
	for (int i = 0; i < record->potted_count && record->points > 0; i++) {
		int ball = record->potted[i].ball;
		if (!rules_ball_on(&root->rules, root->ball, v->request.ball_count, ball) ||
		    !(root->wanted >> ball & 1))
			continue;
		record->target = (int16_t)ball;
		record->pocket = record->potted[i].pocket;
		return;
	}
}

/* How often a pot that the fan found falls, by a few samples. */
static double chance_of(struct value_search *v, struct value_worker *worker, const struct record *record)
{
	int good = 0;
	for (int i = 0; i < TRIALS; i++) {
		struct record trial = *record;
		struct rules_outcome outcome;
		trial.shot = player_error_apply(&v->estimator.error, &record->shot, &v->point[i]);
		good += value_play(v, worker, 0, &trial, &outcome) && trial.foul == 0 && shot_is_as_meant(&trial);
	}
	return (good + 0.5) / (TRIALS + 1);
}

static void direction_item(void *context, int item, int worker)
{
	struct fan *fan = context;
	struct value_search *v = fan->value;
	struct rules_outcome outcome;
	for (int k = 0; k < 2; k++)
		fan->best[item][k].value = -INFINITY;
	for (int s = 0; s < SPEED_COUNT && SPEEDS[s] <= v->request.max_speed && !value_is_over(v); s++) {
		struct stroke stroke = {.root = 0, .opening = -1};
		struct record *record = &stroke.record;
		memset(record, 0, sizeof *record);
		record->shot = (struct shot){.angle = fan->angle[item], .speed = SPEEDS[s]};
		record->target = record->pocket = -1;
		record->success = NAN;
		memset(record->chain, -1, sizeof record->chain);
		record->chain[0] = (int16_t)v->request.cue;
		if (!value_play(v, &v->worker[worker], 0, record, &outcome) || record->foul != 0)
			continue;
		record->chain[1] = (int16_t)rules_first_contact(&v->worker[worker].work.trace, v->request.cue);
		record->chain_count = record->chain[1] >= 0 ? 2 : 1;
		stroke.value = value_of_outcome(v, &v->worker[worker], record, &outcome, false);
		name_pot(v, record);
		if (record->target >= 0)
			stroke.value *= chance_of(v, &v->worker[worker], record);
		if (stroke.value > fan->best[item][0].value) {
			fan->best[item][1] = fan->best[item][0];
			fan->best[item][0] = stroke;
		} else if (stroke.value > fan->best[item][1].value) {
			fan->best[item][1] = stroke;
		}
	}
}

static void add(struct value_search *v, const struct stroke *stroke, int first)
{
	int at = v->stroke_count;
	if (!isfinite(stroke->value))
		return;
	while (at > first && stroke->value > v->stroke[at - 1].value)
		at--;
	if (at == first + VALUE_SAFETIES)
		return;
	if (v->stroke_count < first + VALUE_SAFETIES)
		v->stroke_count++;
	memmove(&v->stroke[at + 1], &v->stroke[at], (size_t)(v->stroke_count - 1 - at) * sizeof *stroke);
	v->stroke[at] = *stroke;
}

void value_find_safeties(struct value_search *v)
{
	struct fan *fan = &v->fan;
	fan->value = v;
	find_directions(fan);
	pool_for(v->pool, fan->count, direction_item, fan);
	int first = v->stroke_count;
	for (int i = 0; i < fan->count; i++)
		for (int k = 0; k < 2; k++)
			add(v, &fan->best[i][k], first);
	for (int i = first; i < v->stroke_count; i++)
		v->stroke[i].key = (uint32_t)i;
	value_sort(v);
}
