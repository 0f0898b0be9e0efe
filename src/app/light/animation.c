#include "app/light/animation.h"

#include "app/planner/plan_message.h"

bool animation_take(struct animation *animation, const billiard_animation_t *message, double now, bool *changed)
{
	*changed = false;
	if (!plan_message_animation_check(message))
		return false;
	if (message->utime == animation->message.utime && plan_message_same_motion(message, &animation->message))
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
	return plan_message_animation_time(&animation->message, now - animation->begin);
}
