#include "app/light/animation.h"

#include <math.h>
#include <string.h>

#include "physics/ball.h"
#include "physics/event.h"

/* What no table exceeds: m, m/s or m/s^2, s. Drawing then needs no care for overflow. */
static const double PLACE_MAX = 100, SPEED_MAX = 1000, TIME_MAX = 3600;

static bool in(long value, long low, long high)
{
	return value >= low && value <= high;
}

static bool within(double value, double limit)
{
	return fabs(value) <= limit; /* false for NaN */
}

static bool keyframe_ok(const billiard_keyframe_t *k, int ball_count)
{
	return in(k->ball, 0, ball_count - 1) && in(k->phase, 0, BALL_POTTED) &&
	       in(k->event, 0, EVENT_KIND_COUNT - 1) && k->begin >= 0 && k->begin <= k->end && k->end <= TIME_MAX &&
	       within(k->x, PLACE_MAX) && within(k->y, PLACE_MAX) && within(k->vx, SPEED_MAX) &&
	       within(k->vy, SPEED_MAX) && within(k->ax, SPEED_MAX) && within(k->ay, SPEED_MAX);
}

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

bool animation_check(const billiard_animation_t *a)
{
	bool ok = in(a->keyframe_count, 0, ANIMATION_KEYFRAMES) && in(a->ball_count, 0, BALL_MAX) && a->rate >= 0 &&
		  a->rate <= 100 && a->pause >= 0 && a->pause <= TIME_MAX && a->position >= 0 &&
		  a->position <= TIME_MAX && a->ball_radius >= 0 && a->ball_radius < 1;
	for (int i = 0; ok && i < a->ball_count; i++)
		ok = in(a->colours[i], 0, COLOUR_COUNT - 1);
	for (int i = 0; ok && i < a->keyframe_count; i++)
		ok = keyframe_ok(&a->keyframes[i], a->ball_count);
	return ok;
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
