#include "app/control/stability.h"

#include <math.h>
#include <stddef.h>

/* A frame counts for at most this share of the time that is waited for: a gap in the frames is no evidence of rest. */
static const double CREDIT = 1.0 / 3;
static const double TIME_SLACK = 1e-3; /* s, frames come a little early and late */

void stability_init(struct stability *s, const struct stability_limits *limits)
{
	*s = (struct stability){
		.limits = *limits, .anchor.cue = -1, .away = -1, .blind = -1, .verdict = STABILITY_UNSURE};
	const double needed[STABILITY_CONDITIONS] = {
		[STABILITY_CUE] = limits->cue_time,	[STABILITY_STILL] = limits->still_time,
		[STABILITY_KEPT] = limits->lost_time,	[STABILITY_NONE_NEW] = limits->new_time,
		[STABILITY_CLEAR] = limits->clear_time,
	};
	for (int i = 0; i < STABILITY_CONDITIONS; i++)
		s->result[i] = (struct stability_result){.needed = needed[i], .ball = -1};
}

/* ---- the predicates ---------------------------------------------------------------------------------------------------- */

int stability_find_cue(const struct stability *s, const struct layout *layout)
{
	int whites = 0, only = -1, nearest = -1;
	double best = s->limits.cue_distance;
	for (int i = 0; i < layout->count; i++) {
		if (layout->ball[i].colour != COLOUR_WHITE)
			continue;
		double d = s->has_cue ? vec2_dist(layout->ball[i].pos, s->last_cue) : INFINITY;
		if (s->cue_track > 0 && layout->track[i] == s->cue_track)
			return i;
		whites++;
		only = i;
		if (d <= best) {
			best = d;
			nearest = i;
		}
	}
	return whites == 1 ? only : nearest;
}

double stability_largest_move(const struct layout *from, const struct layout *to, int *ball)
{
	double move = 0;
	*ball = -1;
	for (int i = 0; i < to->count; i++) {
		int j = layout_find(from, &to->ball[i], to->track[i]);
		double d = j < 0 ? 0 : vec2_dist(from->ball[j].pos, to->ball[i].pos);
		if (d <= move)
			continue;
		move = d;
		*ball = i;
	}
	return move;
}

int stability_missing(const struct layout *a, const struct layout *b, int *ball)
{
	int missing = 0;
	*ball = -1;
	for (int i = 0; i < a->count; i++) {
		if (layout_find(b, &a->ball[i], a->track[i]) >= 0)
			continue;
		if (missing++ == 0)
			*ball = i;
	}
	return missing;
}

static int count_whites(const struct layout *layout)
{
	int whites = 0;
	for (int i = 0; i < layout->count; i++)
		whites += layout->ball[i].colour == COLOUR_WHITE;
	return whites;
}

/* ---- their verdicts ----------------------------------------------------------------------------------------------------- */

static void judge(struct stability_result *r, bool holds, double value, int ball)
{
	r->holds = holds;
	r->value = value;
	r->ball = holds ? -1 : ball;
}

static void judge_all(struct stability *s, const struct layout *layout, const struct stability_view *view)
{
	struct stability_result *r = s->result;
	int ball;
	bool tracked = layout->cue >= 0;
	vec2 last = s->has_cue || !tracked ? s->last_cue : layout->ball[layout->cue].pos;
	judge(&r[STABILITY_CUE], tracked, tracked ? vec2_dist(layout->ball[layout->cue].pos, last) : 0, -1);
	r[STABILITY_CUE].limit = s->limits.cue_distance;
	double move = stability_largest_move(&s->anchor, layout, &ball);
	judge(&r[STABILITY_STILL], move <= s->limits.still_distance, move, ball);
	r[STABILITY_STILL].limit = s->limits.still_distance;
	int lost = stability_missing(&s->anchor, layout, &ball);
	judge(&r[STABILITY_KEPT], lost == 0, lost, ball);
	int new = stability_missing(layout, &s->anchor, &ball);
	judge(&r[STABILITY_NONE_NEW], new == 0, new, ball);
	bool clear = !view->occluded && !view->looking && view->doubted < 0;
	judge(&r[STABILITY_CLEAR], clear, clear ? 0 : 1, view->doubted);
}

/* The time since the last frame is added where a condition holds. */
static void hold(struct stability *s, double elapsed)
{
	bool all = true;
	double least = INFINITY;
	for (int i = 0; i < STABILITY_ALL; i++) {
		struct stability_result *r = &s->result[i];
		r->held = r->holds ? r->held + fmin(elapsed, CREDIT * r->needed) : 0;
		all = all && r->holds && r->held >= r->needed - TIME_SLACK;
		least = fmin(least, r->held);
	}
	s->result[STABILITY_ALL].holds = all;
	s->result[STABILITY_ALL].held = least;
	s->result[STABILITY_ALL].value = all;
	s->result[STABILITY_ALL].limit = 1;
}

/* The quiet begins anew from this layout. */
static void begin_anew(struct stability *s, const struct layout *layout)
{
	s->anchor = *layout;
	s->result[STABILITY_STILL].held = 0;
	s->away = -1;
}

/* Time that goes on from the frame in which something began: *since -1 before that. */
static double count_time(double *since, double elapsed)
{
	return *since = *since < 0 ? 0 : *since + elapsed;
}

static enum stability_verdict lost(struct stability *s, double elapsed)
{
	for (int i = 0; i < STABILITY_CONDITIONS; i++) {
		s->result[i].holds = false;
		s->result[i].held = 0;
	}
	return count_time(&s->blind, elapsed) >= s->limits.blind_time - TIME_SLACK ? STABILITY_LOST : STABILITY_UNSURE;
}

static void keep_cue(struct stability *s, const struct layout *layout)
{
	if (layout->cue < 0)
		return;
	s->last_cue = layout->ball[layout->cue].pos;
	s->cue_track = layout->track[layout->cue];
	s->has_cue = true;
}

static enum stability_verdict seen(struct stability *s, const struct layout *layout, const struct stability_view *view,
				   double elapsed)
{
	if (!s->begun)
		begin_anew(s, layout);
	s->begun = true;
	s->blind = -1;
	judge_all(s, layout, view);
	hold(s, elapsed);
	keep_cue(s, layout);
	if (!s->result[STABILITY_STILL].holds) {
		if (count_time(&s->away, elapsed) < s->limits.moving_time - TIME_SLACK)
			return STABILITY_UNSURE;
		/* While it goes on, the next ball away from its new place moves at once. */
		begin_anew(s, layout);
		s->away = s->limits.moving_time;
		return STABILITY_MOVING;
	}
	if (!s->result[STABILITY_KEPT].holds || !s->result[STABILITY_NONE_NEW].holds || view->occluded)
		begin_anew(s, layout);
	if (s->result[STABILITY_STILL].held >= CREDIT * s->limits.still_time)
		s->away = -1;
	return s->result[STABILITY_ALL].holds ? STABILITY_STABLE : STABILITY_UNSURE;
}

enum stability_verdict stability_frame(struct stability *s, struct layout *layout, const struct stability_view *view)
{
	double elapsed = s->begun || s->blind >= 0 ? fmax(0, view->time - s->time) : 0;
	s->time = view->time;
	if (layout)
		layout->cue = stability_find_cue(s, layout);
	/* Two white balls of which nobody can tell which it is are no lost table: the condition says so. */
	bool blind = !layout || (count_whites(layout) == 0 && !view->occluded);
	s->verdict = blind ? lost(s, elapsed) : seen(s, layout, view, elapsed);
	return s->verdict;
}

enum stability_condition stability_obstacle(const struct stability *s)
{
	for (int i = 0; i < STABILITY_ALL; i++)
		if (!s->result[i].holds)
			return (enum stability_condition)i;
	/* Rest comes last: whatever else happens begins it anew. */
	static const enum stability_condition order[] = {STABILITY_CUE, STABILITY_KEPT, STABILITY_NONE_NEW,
							 STABILITY_CLEAR, STABILITY_STILL};
	enum stability_condition worst = STABILITY_CONDITIONS;
	double longest = TIME_SLACK;
	for (size_t i = 0; i < sizeof order / sizeof order[0]; i++) {
		double left = s->result[order[i]].needed - s->result[order[i]].held;
		if (left <= longest)
			continue;
		longest = left;
		worst = order[i];
	}
	return worst;
}

const char *stability_verdict_name(enum stability_verdict verdict)
{
	static const char *const name[] = {"lost", "moving", "unsure", "stable"};
	return name[verdict];
}

const char *stability_condition_name(enum stability_condition condition)
{
	static const char *const name[STABILITY_CONDITIONS] = {"cue", "still", "kept", "none new", "clear", "all"};
	return name[condition];
}
