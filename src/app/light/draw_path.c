#include "app/light/draw_path.h"

#include "app/light/keyframe.h"
#include "physics/event.h"

/* Farthest a line may lie from the parabola that it stands for, m. */
static const double FLATNESS = 0.001;
/* Points closer than this to the last one are left out, m. */
static const double SPACING = 0.0005;
enum { DEPTH_MAX = 6 };

static void add(struct draw_path *path, vec2 point)
{
	if (path->count < DRAW_PATH_MAX &&
	    (path->count == 0 || vec2_dist(path->point[path->count - 1], point) > SPACING))
		path->point[path->count++] = point;
}

/* Halves the time until the chord lies close enough: over dt it lies |a across the chord| dt^2 / 8 from the parabola at
 * most. */
static void add_arc(struct draw_path *path, const billiard_keyframe_t *key, double from, double to, int depth)
{
	vec2 end = keyframe_at(key, to), chord = vec2_unit(vec2_sub(end, keyframe_at(key, from)));
	double across = fabs(vec2_cross(chord, (vec2){key->ax, key->ay}));
	if (across * (to - from) * (to - from) / 8 <= FLATNESS || depth == DEPTH_MAX) {
		add(path, end);
		return;
	}
	add_arc(path, key, from, (from + to) / 2, depth + 1);
	add_arc(path, key, (from + to) / 2, to, depth + 1);
}

static void add_keyframe(struct draw_path *path, const billiard_keyframe_t *key)
{
	double span = key->end - key->begin;
	/* where a ball with backspin turns, a chord from end to end would leave out the way there */
	vec2 vel = {key->vx, key->vy}, acc = {key->ax, key->ay};
	double turn = vec2_norm2(acc) > 0 ? -vec2_dot(vel, acc) / vec2_norm2(acc) : 0;
	if (turn > 0 && turn < span) {
		add_arc(path, key, 0, turn, 0);
		add_arc(path, key, turn, span, 0);
	} else {
		add_arc(path, key, 0, span, 0);
	}
}

void draw_path_of(struct draw_path *path, const billiard_plan_t *plan, const billiard_plan_shot_t *shot, int ball)
{
	path->count = 0;
	path->contact = -1;
	for (int i = 0; i < shot->keyframe_count; i++) {
		const billiard_keyframe_t *key = &plan->keyframes[shot->keyframe_first + i];
		if (key->ball != ball)
			continue;
		add(path, keyframe_at(key, 0));
		if (key->event == EVENT_BALL_BALL && path->contact < 0)
			path->contact = path->count - 1;
		add_keyframe(path, key);
	}
}
