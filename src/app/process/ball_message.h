/* One ball between bus messages and physics. Pure. */
#ifndef BILLIARD_APP_BALL_MESSAGE_H
#define BILLIARD_APP_BALL_MESSAGE_H

#include "lcmtypes/billiard_ball_t.h"
#include "physics/ball.h"

/* name: cut to fit; track: identity over frames, 0 none. */
void ball_to_message(billiard_ball_t *out, const struct ball *ball, const char *name, int track);
/* The ball of a message that passed message_check(). */
struct ball ball_from_message(const billiard_ball_t *message);

#endif
