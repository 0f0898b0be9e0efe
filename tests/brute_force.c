#include "brute_force.h"

#include <string.h>

#include "search/geometry.h"

enum { TRACE_MAX = 1024 };

/* First event of a ball from entry at on that is not a change of its own motion. -1 when there is none. */
static int next_contact(const struct trace *trace, int ball, int at)
{
	for (int i = at; i < trace->count; i++) {
		const struct event *event = &trace->entry[i].event;
		bool other_too = event->kind == EVENT_BALL_BALL && event->other == ball;
		if ((event->ball == ball && event->kind >= EVENT_BALL_BALL && event->kind <= EVENT_POCKET) || other_too)
			return i;
	}
	return -1;
}

/* The ball that falls as the first thing that happens to it, through at most one ball between; -1 none. */
static int clean_pot(const struct trace *trace, int cue, int *pocket)
{
	int ball = cue, at = 0;
	for (int links = 0; links < 3; links++) {
		at = next_contact(trace, ball, at);
		if (at < 0)
			return -1;
		const struct event *event = &trace->entry[at].event;
		if (event->kind == EVENT_POCKET && ball != cue) {
			*pocket = event->other;
			return ball;
		}
		if (event->kind != EVENT_BALL_BALL)
			return -1;
		ball = event->ball == ball ? event->other : event->ball;
		if (next_contact(trace, ball, 0) != at)
			return -1; /* something has moved it before */
		at++;
	}
	return -1;
}

static bool is_potted(const struct trace *trace, int ball)
{
	for (int i = 0; i < trace->count; i++)
		if (trace->entry[i].event.kind == EVENT_POCKET && trace->entry[i].event.ball == ball)
			return true;
	return false;
}

void brute_force(const struct table *table, const struct model *model, const struct ball *ball, int count,
		 const struct brute_fan *fan, double clearance, struct brute_result *result)
{
	static struct trace_entry entry[TRACE_MAX];
	static struct sim sim;
	const struct sim_limits limits = {.max_time = INFINITY, .max_events = TRACE_MAX - 1};
	memset(result, 0, sizeof *result);
	for (int i = 0; i < fan->angles * fan->speed_count; i++) {
		struct shot shot = {.angle = 2 * M_PI * (i / fan->speed_count) / fan->angles,
				    .speed = fan->speed[i % fan->speed_count]};
		struct trace trace;
		int pocket = -1;
		trace_init(&trace, entry, TRACE_MAX);
		sim_init(&sim, table, model, ball, count);
		sim_strike(&sim, 0, &shot);
		result->sims++;
		if (sim_run(&sim, &limits, &trace) != SIM_AT_REST)
			continue;
		int potted = clean_pot(&trace, 0, &pocket);
		if (potted < 0 || is_potted(&trace, 0) || (result->pots[potted] >> pocket & 1))
			continue;
		const struct obstacles others = {ball, count, ~(1u | 1u << potted)};
		if (!segment_is_free(&others, ball[potted].pos, table->pocket[pocket].centre,
				     2 * table->ball_radius + clearance))
			continue;
		result->pots[potted] |= (uint8_t)(1u << pocket);
		result->angle[potted][pocket] = shot.angle;
		result->speed[potted][pocket] = shot.speed;
	}
}

struct cost_profile brute_profile(void)
{
	struct cost_profile profile = cost_profile_thesis();
	profile.max_cut = 89.9 * M_PI / 180;
	profile.clearance = profile.cue_clearance = profile.cue_room = 0;
	profile.aims = 9;
	profile.speed_step = 0.5;
	profile.program_speed = false;
	return profile;
}
