#include "app/control/game_watch.h"

#include <math.h>

static const double PLAYED = 0.005;		/* m the cue ball must have moved */
static const double MET = 0.003;		/* m an object ball must have moved */
static const double JUMP = 0.1;			/* m between two places that are no way of a ball that was away */
static const double LONG_AWAY = 1;		/* s */
static const double AWAY = 0.15;		/* s; shorter, and it was a ball that was not seen for a moment */
static const double LIES = 0.01;		/* m around where it came back */
static const double FASTEST = 10, FLIGHT = 0.3; /* m/s, m: no ball goes farther between two frames */
static const double STILL = 0.1;		/* m/s */
static const double STRUCK = 0.2;     /* m that a cue ball at rest goes between two frames when it is struck */
static const double REACH_TIME = 0.2; /* s before a ball that moves to a pocket reaches it unseen */

static int find_colour(const struct layout *layout, enum ball_colour colour)
{
	for (int i = 0; i < layout->count; i++)
		if (layout->ball[i].colour == colour)
			return i;
	return -1;
}

void game_watch_begin(struct game_watch *watch, const struct layout *rest, double time)
{
	*watch = (struct game_watch){.rest = *rest, .first = -1};
	for (int i = 0; i < rest->count; i++) {
		enum ball_colour colour = rest->ball[i].colour;
		if (colour != COLOUR_RED)
			watch->single[colour] =
				(struct game_single){.pos = rest->ball[i].pos, .time = time, .seen = true};
	}
}

/* A ball last seen there, at that speed, may have fallen unseen. */
static bool near_pocket(const struct table *table, const struct game_single *s, bool is_cue)
{
	double reach = 3 * table->ball_radius + REACH_TIME * s->speed;
	if (is_cue && s->speed < STILL)
		reach += STRUCK;
	for (int i = 0; i < table->pocket_count; i++)
		if (vec2_dist(s->pos, table->pocket[i].centre) < table->pocket[i].radius + reach)
			return true;
	return false;
}

/* A ball that rolls is one that was lost from sight for a moment; what a hand put down lies still. */
static void follow_single(struct game_single *s, const struct table *table, vec2 pos, double time, bool is_cue)
{
	double dt = time - s->time, way = vec2_dist(pos, s->pos);
	bool flew = !s->was_away && way > FLIGHT && way > FASTEST * dt;
	if (s->seen && (flew || (s->was_away && way > JUMP && (near_pocket(table, s, is_cue) || dt > LONG_AWAY)))) {
		s->jumped = true;
		s->back = pos;
	} else if (s->seen && s->was_away && way <= JUMP && dt > AWAY && !s->jumped) {
		s->returned = true;
		s->back = pos;
	} else if ((s->jumped || s->returned) && vec2_dist(pos, s->back) > LIES) {
		s->jumped = s->returned = false;
	}
	if (s->seen && dt > 0 && !s->was_away)
		s->speed = way / dt;
	s->pos = pos;
	s->time = time;
	s->seen = true;
	s->was_away = false;
}

static void note_moved(struct game_watch *watch, const struct layout *layout)
{
	for (int i = 0; i < watch->rest.count; i++) {
		int j = layout_find(layout, &watch->rest.ball[i], watch->rest.track[i]);
		if (j >= 0 && vec2_dist(layout->ball[j].pos, watch->rest.ball[i].pos) >= MET)
			watch->moved[i] = true;
	}
}

static double distance_to_way(vec2 p, vec2 from, vec2 to)
{
	vec2 way = vec2_sub(to, from);
	double length = vec2_dot(way, way);
	double t = length > 0 ? fmin(fmax(vec2_dot(vec2_sub(p, from), way) / length, 0), 1) : 0;
	return vec2_dist(p, vec2_madd(from, t, way));
}

/* The object ball that moves first; of several in one frame, the one nearest to the cue ball's way. */
static void find_first(struct game_watch *watch, const struct layout *layout, vec2 cue)
{
	int candidates = 0;
	double best = INFINITY;
	vec2 from = watch->rest.ball[watch->rest.cue].pos;
	for (int i = 0; i < watch->rest.count; i++) {
		int j = i == watch->rest.cue ? -1 : layout_find(layout, &watch->rest.ball[i], watch->rest.track[i]);
		/* One that is gone was struck away so fast that it is not followed yet, or has fallen. */
		bool met = i != watch->rest.cue &&
			   (j < 0 || vec2_dist(layout->ball[j].pos, watch->rest.ball[i].pos) >= MET);
		if (!met)
			continue;
		double d = distance_to_way(watch->rest.ball[i].pos, from, cue);
		candidates++;
		if (d >= best)
			continue;
		best = d;
		watch->first = i;
	}
	watch->first_sure = candidates == 1;
}

void game_watch_frame(struct game_watch *watch, const struct table *table, const struct layout *layout, double time,
		      bool occluded)
{
	for (enum ball_colour colour = COLOUR_WHITE; colour < COLOUR_UNKNOWN; colour++) {
		int i = colour == COLOUR_RED ? -1 : colour == COLOUR_WHITE ? layout->cue : find_colour(layout, colour);
		if (i >= 0)
			follow_single(&watch->single[colour], table, layout->ball[i].pos, time, i == layout->cue);
		else if (!occluded)
			watch->single[colour].was_away = true;
	}
	if (watch->rest.cue < 0)
		return;
	vec2 start = watch->rest.ball[watch->rest.cue].pos, cue = watch->single[COLOUR_WHITE].pos;
	watch->played = watch->played || (layout->cue >= 0 && vec2_dist(cue, start) > PLAYED) ||
			(watch->single[COLOUR_WHITE].was_away && watch->first >= 0) ||
			watch->single[COLOUR_WHITE].jumped;
	if (layout->cue >= 0 && !occluded)
		watch->farthest = fmax(watch->farthest, vec2_dist(cue, start));
	if (watch->played)
		note_moved(watch, layout);
	if (watch->played && watch->first < 0 && !occluded)
		find_first(watch, layout, cue);
}

bool game_watch_fell(const struct game_watch *watch, const struct table *table, enum ball_colour colour)
{
	const struct game_single *s = &watch->single[colour];
	return s->seen && s->was_away && near_pocket(table, s, colour == COLOUR_WHITE);
}

bool game_watch_fell_and_back(const struct game_watch *watch, enum ball_colour colour)
{
	const struct game_single *s = &watch->single[colour];
	/* Back where it lay: it was on its spot, was struck and fell, or was not seen for a while. Only what was met has moved. */
	bool met = watch->first >= 0 && watch->rest.ball[watch->first].colour == colour;
	return s->jumped || (s->returned && met);
}
