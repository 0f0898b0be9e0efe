/* One ball between bus messages and physics. Pure. */
#ifndef BILLIARD_APP_BALL_MESSAGE_H
#define BILLIARD_APP_BALL_MESSAGE_H

#include "lcmtypes/billiard_ball_t.h"
#include "physics/ball.h"

/* Ball of a message; its numbers are not checked. */
void ball_to_message(billiard_ball_t *out, const struct ball *ball, const char *name, int track);
/* False when a number is not finite or out of range. */
bool ball_from_message(struct ball *out, const billiard_ball_t *ball);

#endif
