/* Is the table at rest? (thesis 4.9.1 to 4.9.6). Pure: time comes with the frames. */
#ifndef BILLIARD_APP_STABILITY_H
#define BILLIARD_APP_STABILITY_H

#include <stdbool.h>

#include "physics/ball.h"

enum { STABILITY_HISTORY = 64 };

/* Balls of one frame as tracked: table frame, m. */
struct layout {
	int count;
	struct ball ball[BALL_MAX]; /* at rest, colours set */
	int track[BALL_MAX];	    /* identity over frames */
	int cue;		    /* index of the cue ball, -1 none */
};

enum stability_verdict {
	STABILITY_LOST,	  /* no calibration or no cue ball, for some frames in a row */
	STABILITY_MOVING, /* a ball moves */
	STABILITY_UNSURE, /* balls came or went, a hand is in the way, too few frames yet */
	STABILITY_STABLE
};

struct stability {
	double still_distance; /* m */
	int still_frames;
	vec2 last_cue; /* m, for telling the cue ball from other white spots */
	bool has_cue;
	struct layout anchor; /* where the balls were when the present quiet began */
	int quiet;	      /* frames since */
	int lost;	      /* frames in a row without calibration or cue ball */
	int moving;	      /* frames in a row with movement */
};

/* still_distance m > 0; still_frames 1..STABILITY_HISTORY. */
void stability_init(struct stability *s, double still_distance, int still_frames);

/* The next frame. NULL: the table could not be seen. occluded: a hand or arm is over the bed. Of several white balls the one nearest to the last
 * cue ball becomes layout->cue. */
enum stability_verdict stability_frame(struct stability *s, struct layout *layout, bool occluded);

/* True when a ball lies elsewhere (by more than distance, m), came, went or has another colour. */
bool layout_differs(const struct layout *a, const struct layout *b, double distance);

/* Moves balls that overlap by a camera's error apart, and those over a cushion back onto the bed, so that physics can start from them.
 * False when that takes more than max_shift (m) for a ball. */
bool layout_settle(struct layout *layout, double length, double width, double radius, double max_shift);

#endif
