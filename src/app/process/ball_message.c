#include "app/process/ball_message.h"

#include <math.h>

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

bool ball_from_message(struct ball *out, const billiard_ball_t *ball)
{
	if (ball->colour < 0 || ball->colour >= COLOUR_COUNT || ball->phase < 0 || ball->phase > BALL_POTTED)
		return false;
	struct ball b = ball_at((enum ball_colour)ball->colour, (vec2){ball->x, ball->y});
	b.vel = (vec2){ball->vx, ball->vy};
	b.phase = (enum ball_phase)ball->phase;
	if (!ball_is_finite(&b) || fabs(b.pos.x) > 100 || fabs(b.pos.y) > 100)
		return false;
	*out = b;
	return true;
}
