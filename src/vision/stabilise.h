/* A measured position that neither trembles at rest nor lags in motion. */
#ifndef BILLIARD_VISION_STABILISE_H
#define BILLIARD_VISION_STABILISE_H

#include <stdbool.h>

#include "physics/vec2.h"

enum { STABILISE_HISTORY = 4, THESIS_HISTORY = 30 };

struct stabiliser {
	vec2 pos, vel; /* m, m/s: what to use */
	bool moving;
	vec2 mean; /* of the rest */
	int mean_count;
	int away;		     /* frames in a row off the mean */
	vec2 raw[STABILISE_HISTORY]; /* newest first */
	double time[STABILISE_HISTORY];
	int raw_count;
};

/* Begins at a first position (m) at a time (s). */
struct stabiliser stabilise_begin(vec2 raw, double time);
/* The next measured position. noise: m, what a resting ball trembles by, > 0; positions nearer to the mean than three
 * times that are rest. */
void stabilise_add(struct stabiliser *s, vec2 raw, double time, double noise);

/* The thesis' way (4.4): moving average of up to N frames, blended with the present position by 4.1 and 4.2. For
 * comparison. */
struct thesis_stabiliser {
	vec2 raw[THESIS_HISTORY];
	int count, next;
};
/* Returns P_new. max_distance: D of 4.1, m, > 0; least: L, frames before the average is used. A raw position further
 * than D from the last one begins the history anew. */
vec2 thesis_stabilise(struct thesis_stabiliser *s, vec2 raw, double max_distance, int least);

#endif
