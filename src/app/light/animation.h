/* The animation that is on the table, as its receivers keep it: messages come again each second and must not start it anew. */
#ifndef BILLIARD_APP_ANIMATION_H
#define BILLIARD_APP_ANIMATION_H

#include <stdbool.h>

#include "lcmtypes/billiard_animation_t.h"

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
