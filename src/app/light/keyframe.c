#include "app/light/keyframe.h"

#include <math.h>

#include "app/process/message_table.h"

vec2 keyframe_at(const billiard_keyframe_t *key, double s)
{
	return (vec2){key->x + key->vx * s + key->ax * s * s / 2, key->y + key->vy * s + key->ay * s * s / 2};
}

/* Farthest from 0 of p + v s + a s^2 / 2 for s in 0..span: at an end, or where it turns. */
static double farthest(double p, double v, double a, double span)
{
	double turn = a != 0 ? fmin(fmax(-v / a, 0), span) : 0;
	double at_turn = p + v * turn + a * turn * turn / 2, at_end = p + v * span + a * span * span / 2;
	return fmax(fabs(p), fmax(fabs(at_turn), fabs(at_end)));
}

bool keyframe_check(const billiard_keyframe_t *key, int ball_count)
{
	double span = key->end - key->begin;
	return key->ball < ball_count && span >= 0 && farthest(key->x, key->vx, key->ax, span) <= MESSAGE_PLACE_MAX &&
	       farthest(key->y, key->vy, key->ay, span) <= MESSAGE_PLACE_MAX;
}
