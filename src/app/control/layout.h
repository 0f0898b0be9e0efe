/* Where the balls of one frame lie, and whether that can be: pure geometry, no time. */
#ifndef BILLIARD_APP_LAYOUT_H
#define BILLIARD_APP_LAYOUT_H

#include <stdbool.h>

#include "physics/ball.h"
#include "physics/table.h"

/* Balls of one frame as tracked: table frame, m. */
struct layout {
	int count;
	struct ball ball[BALL_MAX]; /* at rest, colours set */
	int track[BALL_MAX];	    /* identity over frames */
	int cue;		    /* index of the cue ball, -1 none */
};

/* True when a ball lies elsewhere (by more than distance, m), came, went or has another colour. */
bool layout_differs(const struct layout *a, const struct layout *b, double distance);

/* The same ball in another layout: by its identity; without one (single frames) the nearest of its colour. -1: not there. */
int layout_find(const struct layout *layout, const struct ball *ball, int track);

/* White and the six colours are there once each: a ball that is the second of its colour, -1 none. */
int layout_second_of_colour(const struct layout *layout);

/* How far a camera's errors may reach, and what a ball cannot lie in. */
struct layout_limits {
	double shift;	/* m, a ball may be moved by that much */
	double overlap; /* m, two balls may overlap by that much */
	bool jaws; /* the model knows the pockets' jaw cushions and sharp tips (POCKET_MODEL_JAWS): without them a ball may roll into
			   one, and lie there */
};

/* Takes a camera's errors out of a layout, so that physics can start from it: balls that overlap are moved apart, balls over a nose or a
 * jaw of the table back in front of it. A ball in the mouth of a pocket stays where it hangs. False when the errors would be larger than
 * the limits, or a ball is where none can be: then *culprit is the first ball concerned and layout is undefined: what was seen is no
 * position. */
bool layout_settle(struct layout *layout, const struct table *table, const struct layout_limits *limits, int *culprit);

#endif
