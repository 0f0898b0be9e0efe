#include "app/process/ball_message.h"

#include "app/process/text.h"

void ball_to_message(billiard_ball_t *out, const struct ball *ball, const char *name, int track)
{
	*out = (billiard_ball_t){
		.track = track,
		.colour = (int8_t)ball->colour,
		.phase = (int8_t)ball->phase,
		.x = ball->pos.x,
		.y = ball->pos.y,
		.vx = ball->vel.x,
		.vy = ball->vel.y,
		.confidence = 1,
	};
	text_set(out->name, sizeof out->name, name);
}

struct ball ball_from_message(const billiard_ball_t *message)
{
	struct ball ball = ball_at((enum ball_colour)message->colour, (vec2){message->x, message->y});
	ball.vel = (vec2){message->vx, message->vy};
	ball.phase = (enum ball_phase)message->phase;
	return ball;
}
