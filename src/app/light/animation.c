#include "app/light/animation.h"

#include <math.h>
#include <string.h>

#include "app/light/keyframe.h"

bool animation_same_motion(const billiard_animation_t *a, const billiard_animation_t *b)
{
	return a->plan_id == b->plan_id && a->keyframe_count == b->keyframe_count &&
	       memcmp(a->keyframes, b->keyframes, (size_t)a->keyframe_count * sizeof a->keyframes[0]) == 0;
}

double animation_length(const billiard_animation_t *animation)
{
	double end = 0;
	for (int i = 0; i < animation->keyframe_count; i++)
		end = fmax(end, animation->keyframes[i].end);
	return end;
}

double animation_position(const billiard_animation_t *animation, double elapsed)
{
	if (!animation->run)
		return animation->position;
	double length = animation_length(animation), period = length + animation->pause;
	return period > 0 ? fmin(fmod(animation->position + animation->rate * elapsed, period), length) : 0;
}

bool animation_check(const billiard_animation_t *animation)
{
	for (int i = 0; i < animation->keyframe_count; i++)
		if (!keyframe_check(&animation->keyframes[i], animation->ball_count))
			return false;
	return true;
}

bool animation_take(struct animation *animation, const billiard_animation_t *message, double now, bool *changed)
{
	*changed = false;
	if (!animation_check(message))
		return false;
	if (message->utime == animation->message.utime && animation_same_motion(message, &animation->message))
		return true;
	animation->message = *message;
	animation->begin = now;
	*changed = true;
	return true;
}

bool animation_is_shown(const struct animation *animation)
{
	return animation->message.keyframe_count > 0;
}

bool animation_runs(const struct animation *animation)
{
	return animation_is_shown(animation) && animation->message.run;
}

double animation_time(const struct animation *animation, double now)
{
	return animation_position(&animation->message, now - animation->begin);
}
