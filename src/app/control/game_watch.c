#include "app/control/game_watch.h"

#include <math.h>

static const double PLAYED = 0.005;   /* m the cue ball must have moved */
static const double MET = 0.003;      /* m an object ball must have moved */
static const double JUMP = 0.1;	      /* m between two places that are no way of a ball that was away */
static const double LONG_AWAY = 1;    /* s */
static const double STILL = 0.1;      /* m/s */
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

static void follow_single(struct game_single *s, const struct table *table, vec2 pos, double time, bool is_cue)
{
	double dt = time - s->time;
	if (s->seen && s->was_away && vec2_dist(pos, s->pos) > JUMP &&
	    (near_pocket(table, s, is_cue) || dt > LONG_AWAY))
		s->fell = true;
	if (s->seen && dt > 0 && !s->was_away)
		s->speed = vec2_dist(pos, s->pos) / dt;
	s->pos = pos;
	s->time = time;
	s->seen = true;
	s->was_away = false;
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
		if (j < 0 || vec2_dist(layout->ball[j].pos, watch->rest.ball[i].pos) < MET)
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
			(watch->single[COLOUR_WHITE].was_away && watch->first >= 0) || watch->single[COLOUR_WHITE].fell;
	if (layout->cue >= 0 && !occluded)
		watch->farthest = fmax(watch->farthest, vec2_dist(cue, start));
	if (watch->played && watch->first < 0)
		find_first(watch, layout, cue);
}

bool game_watch_fell(const struct game_watch *watch, const struct table *table, enum ball_colour colour)
{
	const struct game_single *s = &watch->single[colour];
	return s->seen && s->was_away && near_pocket(table, s, colour == COLOUR_WHITE);
}
