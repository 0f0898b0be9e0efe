/* Balls over time: identities, velocities, positions that rest when the ball does. */
#ifndef BILLIARD_VISION_TRACK_H
#define BILLIARD_VISION_TRACK_H

#include "vision/detector.h"
#include "vision/stabilise.h"

enum { TRACK_MAX = 40 };

/* Confidence of a place from which on it is believed: no ball that was right has been seen with less. */
static const double TRACK_SURE = 0.55;

struct track {
	int id;		      /* >= 1; 0: unused */
	int age;	      /* frames since it was first seen */
	int misses;	      /* frames in a row without it */
	int looked;	      /* whole looks in a row that found it */
	int absent;	      /* whole looks in a row that found its place empty */
	double seen_time;     /* s */
	bool confirmed;	      /* seen often enough to be reported */
	bool disputed;	      /* the last whole look would have it elsewhere, but was not sure */
	struct sighting seen; /* its last fit */
	struct stabiliser steady;
	struct colour_feature look; /* averaged since it was last seen to be another's */
	int looks;
};

struct tracker {
	struct detector *detector; /* borrowed */
	int next_id;
	unsigned frame;
	double time;	  /* s, of the last frame */
	double look_time; /* s, of the last whole look */
	bool judged;	  /* a whole look has found everything as it is reported, and nothing has moved since */
	bool occluded;	  /* the caller's: something large was over the table in the last frame */
	int hurry;	  /* whole looks in a row that changed something */
	struct track track[TRACK_MAX];
	int fitted; /* balls fitted in the last frame, for statistics */
};

void tracker_init(struct tracker *t, struct detector *detector);
/* The next frame, of which the detector has found everything without memory of former ones (detector_frame,
 * detector_look). resting: nothing moves, so that the frame has the last word: it says where a ball lies, what it looks
 * like, and after a second look which balls there are. Otherwise known balls keep their identity where they can. */
void tracker_look(struct tracker *t, double time, bool resting);
/* A resting table wants a whole look: after it came to rest, when the last one changed something, when a ball is in
 * doubt, and from time to time. worried: something else is. */
bool tracker_wants_look(const struct tracker *t, double time, bool worried);
/* The next frame; scan_changes() and scan_update() have been called for it. Fits what changed, what moves, and a few
 * others in turn. */
void tracker_step(struct tracker *t, const struct image *frame, const struct camera *camera, double time);
/* A ball that is reported moves. */
bool tracker_moves(const struct tracker *t);
void tracker_forget(struct tracker *t);

#endif
