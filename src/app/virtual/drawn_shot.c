#include "app/virtual/drawn_shot.h"

#include <math.h>

#include "physics/ball.h"

void drawn_shot_plan(struct drawn_shot *drawn, const billiard_plan_t *plan)
{
	if (plan->entry_count > 0 && plan->entries[0].shot_count > 0)
		drawn->plan[drawn->count++ % DRAWN_PLANS] = *plan;
}

/* Velocity of the cue ball right after the strike, as the animation has it. */
static bool struck(const billiard_animation_t *animation, int64_t id, vec2 *vel)
{
	if (!animation || animation->plan_id != id)
		return false;
	for (int i = 0; i < animation->keyframe_count; i++) {
		const billiard_keyframe_t *k = &animation->keyframes[i];
		if (k->ball < 0 || k->ball >= animation->ball_count || animation->colours[k->ball] != COLOUR_WHITE)
			continue;
		*vel = (vec2){k->vx, k->vy};
		return k->begin == 0 && vec2_norm(*vel) > 0;
	}
	return false;
}

/* How far a shot is from that motion: rad and share of the speed, added. */
static double distance(const billiard_plan_shot_t *shot, vec2 vel)
{
	double turn = remainder(shot->angle - atan2(vel.y, vel.x), 2 * acos(-1));
	return fabs(turn) + fabs(shot->speed / vec2_norm(vel) - 1);
}

static struct shot shot_of(const billiard_plan_shot_t *s)
{
	return (struct shot){s->angle, s->speed, s->side, s->follow, s->elevation};
}

bool drawn_shot_find(const struct drawn_shot *drawn, int64_t id, const billiard_animation_t *animation,
		     struct shot *out)
{
	int64_t first = drawn->count > DRAWN_PLANS ? drawn->count - DRAWN_PLANS : 0;
	double best = INFINITY;
	bool found = false;
	vec2 vel;
	bool moved = struck(animation, id, &vel);
	for (int64_t i = drawn->count; i-- > first;) {
		const billiard_plan_t *plan = &drawn->plan[i % DRAWN_PLANS];
		for (int e = 0; plan->request_id == id && e < (moved ? plan->entry_count : 1); e++) {
			const billiard_plan_shot_t *s = &plan->entries[e].shots[0];
			double d = moved ? distance(s, vel) : 0;
			if (plan->entries[e].shot_count < 1 || !(d < best))
				continue;
			best = d;
			found = true;
			*out = shot_of(s);
		}
	}
	return found;
}
