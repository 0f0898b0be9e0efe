/* One stretch of a ball's motion, as plans and animations carry it. Pure. */
#ifndef BILLIARD_APP_KEYFRAME_H
#define BILLIARD_APP_KEYFRAME_H

#include <stdbool.h>

#include "lcmtypes/billiard_keyframe_t.h"
#include "physics/vec2.h"

/* Place of the ball s seconds after the keyframe began, m. */
vec2 keyframe_at(const billiard_keyframe_t *key, double s);
/* True when a keyframe whose numbers passed message_check() names one of ball_count balls, does not end before it begins, and never leaves
 * MESSAGE_PLACE_MAX: what it draws then needs no more care. */
bool keyframe_check(const billiard_keyframe_t *key, int ball_count);

#endif
