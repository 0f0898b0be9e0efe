/* What can happen between and to balls. */
#ifndef BILLIARD_PHYSICS_EVENT_H
#define BILLIARD_PHYSICS_EVENT_H

#include <stdint.h>

#include "physics/ball.h"

/* In the order in which events of one instant are handled. */
enum event_kind {
	EVENT_NONE,
	EVENT_STRIKE,	 /* ball: the struck ball */
	EVENT_BALL_BALL, /* ball < other, both ball indices */
	EVENT_CUSHION,	 /* other: index into table.cushion */
	EVENT_JAW,	 /* other: index into table.jaw */
	EVENT_POCKET,	 /* other: index into table.pocket */
	EVENT_SLIDING_ROLLING,
	EVENT_ROLLING_SPINNING,
	EVENT_ROLLING_REST,
	EVENT_SPINNING_REST,
	EVENT_PIECE, /* the next piece of a path on an uneven bed: nothing but the form of the path changes */
	EVENT_KIND_COUNT
};

struct event {
	double time; /* s since the start of the simulation */
	enum event_kind kind;
	int16_t ball;  /* index, -1 none */
	int16_t other; /* index by kind, -1 none */
};

/* Strict total order: time, kind, ball, other. Negative, zero, positive. */
int event_compare(const struct event *a, const struct event *b);

/* "strike", "ball_ball", "ball_linear_cushion", "ball_circular_cushion", "ball_pocket", "sliding_rolling",
 * "rolling_spinning", "rolling_stationary", "spinning_stationary", "next_piece". */
const char *event_kind_name(enum event_kind kind);

#endif
