#include "search/shot.h"

#include <assert.h>

static int cue_ball(const struct ball *ball, int count)
{
	for (int i = 0; i < count; i++)
		if (ball[i].colour == COLOUR_WHITE && ball[i].phase != BALL_POTTED)
			return i;
	return -1;
}

static void note_potted(const struct trace *trace, struct record *record)
{
	record->potted_count = 0;
	for (int i = 0; i < trace->count && record->potted_count < PLAN_POTTED_MAX; i++) {
		const struct event *event = &trace->entry[i].event;
		if (event->kind != EVENT_POCKET)
			continue;
		record->potted[record->potted_count].ball = event->ball;
		record->potted[record->potted_count].pocket = event->other;
		record->potted_count++;
	}
}

bool shot_play(struct workspace *work, const struct setting *from, struct record *record, struct rules_outcome *outcome)
{
	const struct sim_limits limits = {.max_time = INFINITY, .max_events = SHOT_EVENTS_MAX};
	int cue = cue_ball(from->ball, from->count);
	assert(cue >= 0);
	sim_init(&work->sim, from->table, from->model, from->ball, from->count);
	trace_init(&work->trace, work->entry, SHOT_TRACE_MAX);
	sim_strike(&work->sim, cue, &record->shot);
	if (sim_run(&work->sim, &limits, &work->trace) != SIM_AT_REST || work->trace.overflow)
		return false;
	note_potted(&work->trace, record);
	rules_judge(from->table, from->rules, &work->trace, record->target, outcome);
	record->points = outcome->points;
	record->foul = outcome->foul;
	record->hash = sim_hash(&work->sim, 0);
	return !outcome->respot_failed;
}

bool shot_is_as_meant(const struct record *record)
{
	for (int i = 0; i < record->potted_count; i++)
		if (record->potted[i].ball == record->target)
			return record->potted[i].pocket == record->pocket;
	return false;
}

bool plan_shot_replay(const struct table *table, const struct model *model, const struct plan_shot *shot,
		      int ball_count, struct trace *trace)
{
	const struct sim_limits limits = {.max_time = INFINITY, .max_events = SHOT_EVENTS_MAX};
	struct sim sim;
	struct record seen;
	int cue = cue_ball(shot->start, ball_count);
	if (cue < 0)
		return false;
	sim_init(&sim, table, model, shot->start, ball_count);
	sim_strike(&sim, cue, &shot->shot);
	if (sim_run(&sim, &limits, trace) != SIM_AT_REST)
		return false;
	note_potted(trace, &seen);
	bool same = seen.potted_count == shot->potted_count;
	for (int i = 0; same && i < seen.potted_count; i++)
		same = seen.potted[i].ball == shot->potted[i].ball && seen.potted[i].pocket == shot->potted[i].pocket;
	return same && sim_hash(&sim, 0) == shot->hash;
}
