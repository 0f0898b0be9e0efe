/* Balls over time: identities, velocities, positions that rest when the ball does. */
#ifndef BILLIARD_VISION_TRACK_H
#define BILLIARD_VISION_TRACK_H

#include "vision/detector.h"
#include "vision/stabilise.h"

enum { TRACK_MAX = 40 };

struct track {
	int id;		      /* >= 1; 0: unused */
	int age;	      /* frames since it was first seen */
	int misses;	      /* frames in a row without it */
	double seen_time;     /* s */
	bool confirmed;	      /* seen often enough to be reported */
	struct sighting seen; /* its last fit */
	struct stabiliser steady;
	struct colour_feature look; /* averaged */
	int looks;
};

struct tracker {
	struct detector *detector; /* borrowed */
	int next_id;
	unsigned frame;
	double time; /* s, of the last frame */
	struct track track[TRACK_MAX];
	int fitted; /* balls fitted in the last frame, for statistics */
};

void tracker_init(struct tracker *t, struct detector *detector);
/* Takes over what the detector found in a frame searched as a whole: known balls keep their identity. */
void tracker_restart(struct tracker *t, double time);
/* The next frame; scan_changes() and scan_update() have been called for it. Fits what changed, what moves, and a few
 * others in turn. */
void tracker_step(struct tracker *t, const struct image *frame, const struct camera *camera, double time);
void tracker_forget(struct tracker *t);

#endif
