/* A ball: what it is and how it moves. SI units, table frame (origin at the bed's centre, +x to the black cushion, +y
 * to its left, z up). */
#ifndef BILLIARD_PHYSICS_BALL_H
#define BILLIARD_PHYSICS_BALL_H

#include "physics/vec2.h"

enum { BALL_MAX = 22 };

/* The numbers of the object balls are their values in points. */
enum ball_colour {
	COLOUR_WHITE = 0,
	COLOUR_RED = 1,
	COLOUR_YELLOW = 2,
	COLOUR_GREEN = 3,
	COLOUR_BROWN = 4,
	COLOUR_BLUE = 5,
	COLOUR_PINK = 6,
	COLOUR_BLACK = 7,
	COLOUR_UNKNOWN = 8,
	COLOUR_COUNT = 9
};

/* REST: no motion at all. SPINNING: on the spot about the vertical axis. ROLLING: the contact point does not slip (it
 * may turn about the vertical axis besides). SLIDING: the contact point slips. POTTED: out of the system. */
enum ball_phase { BALL_REST, BALL_SPINNING, BALL_ROLLING, BALL_SLIDING, BALL_POTTED };

struct ball {
	vec2 pos;	/* m, centre, seen from above; height is always one radius */
	vec2 vel;	/* m/s */
	double spin[3]; /* rad/s about x, y, z */
	enum ball_phase phase;
	enum ball_colour colour;
};

/* "WHITE", "RED", ... "UNKNOWN"; never NULL. */
const char *ball_colour_name(enum ball_colour colour);
/* Colour of an upper-case name; false when there is none of that name. */
bool ball_colour_from_name(const char *name, enum ball_colour *colour);
/* "REST", "SPINNING", "ROLLING", "SLIDING", "POTTED"; never NULL. */
const char *ball_phase_name(enum ball_phase phase);
/* A ball of that colour at rest. */
struct ball ball_at(enum ball_colour colour, vec2 pos);
/* True when every number is finite. */
bool ball_is_finite(const struct ball *ball);

#endif
