#include "app/control/stability.h"

#include <math.h>

enum {
	LOST_FRAMES = 5,   /* frames without a cue ball before it counts: single misses happen (thesis 4.9.3) */
	MOVING_FRAMES = 2, /* frames in a row that must show movement */
	SETTLE_ROUNDS = 200
};

static const double NEAREST_MAX = 0.025; /* m, less than half the distance of touching balls */

void stability_init(struct stability *s, double still_distance, int still_frames)
{
	*s = (struct stability){.still_distance = still_distance, .still_frames = still_frames, .anchor.cue = -1};
}

/* Thesis 4.9.1: one white ball is the cue ball; of several, the nearest to where it was. */
static int find_cue(const struct stability *s, const struct layout *layout)
{
	int cue = -1;
	double best = INFINITY;
	for (int i = 0; i < layout->count; i++) {
		if (layout->ball[i].colour != COLOUR_WHITE)
			continue;
		double d = s->has_cue ? vec2_dist(layout->ball[i].pos, s->last_cue) : 0;
		if (d < best) {
			best = d;
			cue = i;
		}
	}
	return cue;
}

/* The same ball in another layout: by its identity; without one (single frames) the nearest of its colour. */
static int find_same(const struct layout *layout, const struct ball *ball, int track)
{
	int nearest = -1;
	double best = NEAREST_MAX;
	for (int i = 0; i < layout->count; i++) {
		double d = vec2_dist(layout->ball[i].pos, ball->pos);
		if (track > 0 && layout->track[i] == track)
			return i;
		if (track <= 0 && layout->ball[i].colour == ball->colour && d < best) {
			best = d;
			nearest = i;
		}
	}
	return nearest;
}

/* Largest way of a ball between two layouts; *same: no ball came or went. */
static double largest_move(const struct layout *from, const struct layout *to, bool *same)
{
	double move = 0;
	*same = from->count == to->count;
	for (int i = 0; i < to->count; i++) {
		int j = find_same(from, &to->ball[i], to->track[i]);
		if (j < 0)
			*same = false;
		else
			move = fmax(move, vec2_dist(from->ball[j].pos, to->ball[i].pos));
	}
	return move;
}

static enum stability_verdict lost(struct stability *s)
{
	s->quiet = 0;
	return ++s->lost >= LOST_FRAMES ? STABILITY_LOST : STABILITY_UNSURE;
}

enum stability_verdict stability_frame(struct stability *s, struct layout *layout, bool occluded)
{
	if (!layout)
		return lost(s);
	layout->cue = find_cue(s, layout);
	if (layout->cue < 0 && !occluded)
		return lost(s);
	if (layout->cue >= 0) {
		s->last_cue = layout->ball[layout->cue].pos;
		s->has_cue = true;
		s->lost = 0;
	}
	bool same;
	double move = largest_move(&s->anchor, layout, &same);
	if (move > s->still_distance) {
		s->anchor = *layout;
		s->quiet = 0;
		return ++s->moving >= MOVING_FRAMES ? STABILITY_MOVING : STABILITY_UNSURE;
	}
	s->moving = 0;
	if (!same || occluded) {
		s->anchor = *layout;
		s->quiet = 0;
		return STABILITY_UNSURE;
	}
	return ++s->quiet >= s->still_frames && layout->cue >= 0 ? STABILITY_STABLE : STABILITY_UNSURE;
}

bool layout_differs(const struct layout *a, const struct layout *b, double distance)
{
	if (a->count != b->count)
		return true;
	/* Identities may have been given anew: match by place and colour. */
	bool used[BALL_MAX] = {false};
	for (int i = 0; i < a->count; i++) {
		int match = -1;
		for (int j = 0; j < b->count && match < 0; j++)
			if (!used[j] && a->ball[i].colour == b->ball[j].colour &&
			    vec2_dist(a->ball[i].pos, b->ball[j].pos) <= distance)
				match = j;
		if (match < 0)
			return true;
		used[match] = true;
	}
	return false;
}

static double clamp(double x, double limit)
{
	return fmin(fmax(x, -limit), limit);
}

/* One round of pushing overlapping pairs apart by equal shares; the largest overlap met. */
static double push_apart(struct layout *layout, double distance)
{
	double worst = 0;
	for (int i = 0; i < layout->count; i++) {
		for (int j = i + 1; j < layout->count; j++) {
			vec2 d = vec2_sub(layout->ball[j].pos, layout->ball[i].pos);
			double gap = vec2_norm(d), overlap = distance - gap;
			if (overlap <= 0)
				continue;
			worst = fmax(worst, overlap);
			vec2 u = gap > 0 ? vec2_scale(d, 1 / gap) : (vec2){1, 0};
			layout->ball[i].pos = vec2_madd(layout->ball[i].pos, -overlap / 2, u);
			layout->ball[j].pos = vec2_madd(layout->ball[j].pos, overlap / 2, u);
		}
	}
	return worst;
}

/* Moves balls over a cushion back; the farthest way. */
static double keep_on_bed(struct layout *layout, double x_max, double y_max)
{
	double worst = 0;
	for (int i = 0; i < layout->count; i++) {
		vec2 p = layout->ball[i].pos, q = {clamp(p.x, x_max), clamp(p.y, y_max)};
		worst = fmax(worst, vec2_dist(p, q));
		layout->ball[i].pos = q;
	}
	return worst;
}

bool layout_settle(struct layout *layout, double length, double width, double radius, double max_shift)
{
	static const double RESIDUAL = 1e-9; /* m of overlap that is left */
	struct layout before = *layout;
	double worst = INFINITY;
	for (int round = 0; round < SETTLE_ROUNDS && worst > RESIDUAL; round++) {
		/* A hair more than touching, so that the rounds end. */
		worst = push_apart(layout, 2 * radius + RESIDUAL);
		worst = fmax(worst, keep_on_bed(layout, length / 2 - radius, width / 2 - radius));
	}
	for (int i = 0; i < layout->count; i++)
		if (vec2_dist(before.ball[i].pos, layout->ball[i].pos) > max_shift)
			return false;
	return worst <= RESIDUAL;
}
