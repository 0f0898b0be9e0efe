#include "physics/ball.h"

#include <string.h>

static const char *const colour_names[COLOUR_COUNT] = {"WHITE", "RED",	"YELLOW", "GREEN",  "BROWN",
						       "BLUE",	"PINK", "BLACK",  "UNKNOWN"};

const char *ball_colour_name(enum ball_colour colour)
{
	return (unsigned)colour < COLOUR_COUNT ? colour_names[colour] : "UNKNOWN";
}

bool ball_colour_from_name(const char *name, enum ball_colour *colour)
{
	for (int i = 0; i < COLOUR_COUNT; i++) {
		if (strcmp(name, colour_names[i]) == 0) {
			*colour = (enum ball_colour)i;
			return true;
		}
	}
	return false;
}

const char *ball_phase_name(enum ball_phase phase)
{
	static const char *const names[] = {"REST", "SPINNING", "ROLLING", "SLIDING", "POTTED"};
	return (unsigned)phase <= BALL_POTTED ? names[phase] : "UNKNOWN";
}

struct ball ball_at(enum ball_colour colour, vec2 pos)
{
	return (struct ball){.pos = pos, .phase = BALL_REST, .colour = colour};
}

bool ball_is_finite(const struct ball *ball)
{
	return vec2_is_finite(ball->pos) && vec2_is_finite(ball->vel) && isfinite(ball->spin[0]) &&
	       isfinite(ball->spin[1]) && isfinite(ball->spin[2]);
}
