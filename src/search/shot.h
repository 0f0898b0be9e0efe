/* One shot played in the simulation and judged. */
#ifndef BILLIARD_SEARCH_SHOT_H
#define BILLIARD_SEARCH_SHOT_H

#include "search/candidate.h"

enum { SHOT_TRACE_MAX = 1024, SHOT_EVENTS_MAX = 1000 };

/* What one worker needs to simulate; large, in memory taken beforehand. */
struct workspace {
	struct sim sim;
	struct trace trace;
	struct trace_entry entry[SHOT_TRACE_MAX];
};

/* A shot and what came of it: struct plan_shot without the start position. */
struct record {
	struct shot shot;
	double search_cost, cost, tolerance_angle, tolerance_speed, success;
	uint64_t hash;
	int16_t target, pocket;
	int16_t chain[PLAN_CHAIN_MAX]; /* cue ball first */
	int chain_count, rails, potted_count, points, foul;
	struct {
		int16_t ball, pocket;
	} potted[PLAN_POTTED_MAX];
};

/* What a shot is played from. All borrowed; one white ball is on the table. */
struct setting {
	const struct table *table;
	const struct model *model;
	const struct ball *ball;
	int count;
	const struct rules_state *rules;
};

/* Simulates and judges record->shot, record->target being the named ball: fills potted, points, foul, hash. False when
 * the simulation does not end within its events; outcome is unchanged then. */
bool shot_play(struct workspace *work, const struct setting *from, struct record *record,
	       struct rules_outcome *outcome);

/* The meant ball falls into the meant pocket. */
bool shot_is_as_meant(const struct record *record);

#endif
