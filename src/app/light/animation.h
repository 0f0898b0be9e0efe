/* Animations: how a message moves the balls in time, and the one that is on the table as its receivers keep it (messages come again each
 * second and must not start it anew). Pure. */
#ifndef BILLIARD_APP_ANIMATION_H
#define BILLIARD_APP_ANIMATION_H

#include <stdbool.h>

#include "lcmtypes/billiard_animation_t.h"

/* True when the keyframes of an animation that the bus let through agree with its balls: to be called on every animation from the wire. */
bool animation_check(const billiard_animation_t *message);
/* True when both move the same balls in the same way. */
bool animation_same_motion(const billiard_animation_t *a, const billiard_animation_t *b);
/* s from the strike until all balls rest. */
double animation_length(const billiard_animation_t *message);
/* s since the strike at which it stands, elapsed s after it was at its position: it runs to the end, pauses, begins again. */
double animation_position(const billiard_animation_t *message, double elapsed);

/* Begins as {0}: nothing is animated. */
struct animation {
	billiard_animation_t message;
	double begin; /* s, when it was at message.position */
};

/* Takes a message from the wire at time now (s, any epoch). False when it is out of range; then nothing has changed. *changed: it is another
 * animation, or goes on from another place. */
bool animation_take(struct animation *animation, const billiard_animation_t *message, double now, bool *changed);

/* True when something is to be drawn; and when that changes by itself. */
bool animation_is_shown(const struct animation *animation);
bool animation_runs(const struct animation *animation);

/* s since the strike that is shown at time now. */
double animation_time(const struct animation *animation, double now);

#endif
