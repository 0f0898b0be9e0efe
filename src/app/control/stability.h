/* Is the table at rest? Six conditions (thesis 4.9.1 to 4.9.6), each a pure predicate of one frame against the frame where the present quiet
 * began, each with a limit and with the time for which it must have held without a break. Seconds and metres, not frames: the same at any
 * frame rate. Time comes with the frames. */
#ifndef BILLIARD_APP_STABILITY_H
#define BILLIARD_APP_STABILITY_H

#include "app/control/layout.h"

enum stability_condition {
	STABILITY_CUE,	    /* 4.9.1: the cue ball is tracked: one white ball, or the one that is where it was */
	STABILITY_STILL,    /* 4.9.2 M: nothing moves */
	STABILITY_KEPT,	    /* 4.9.3 O: no ball is lost */
	STABILITY_NONE_NEW, /* 4.9.4 N: no ball is new */
	STABILITY_CLEAR,    /* 4.9.5: what is detected is what is tracked: nothing is hidden or doubted */
	STABILITY_ALL,	    /* 4.9.6 P: all of it */
	STABILITY_CONDITIONS
};

/* The configuration's: distances m, times s; all > 0. */
struct stability_limits {
	double still_distance; /* a ball may move and still rest */
	double cue_distance;   /* of two white balls the cue ball is the one within this of where it was */
	double still_time;     /* nothing has moved */
	double cue_time;       /* the cue ball is tracked */
	double lost_time;      /* no ball was lost */
	double new_time;       /* no ball was new */
	double clear_time;     /* nothing was hidden or in doubt */
	double moving_time;    /* a ball away from its place for this long moves; for less it was a false look */
	double blind_time;     /* without calibration or a white ball until the table counts as lost */
};

enum stability_verdict {
	STABILITY_LOST,	  /* no calibration or no cue ball, for blind_time */
	STABILITY_MOVING, /* a ball moves */
	STABILITY_UNSURE, /* a condition fails, or has not held long enough yet */
	STABILITY_STABLE
};

/* One frame. */
struct stability_view {
	double time; /* s, of the frame; its differences count, and none counts for more than a third of what is waited for */
	bool occluded; /* a hand or arm is over the bed */
	int doubted;   /* index of a ball that is hidden or in doubt, -1: none */
	bool looking;  /* the whole frame has not been judged yet */
};

/* What became of one condition at the last frame. */
struct stability_result {
	bool holds; /* the predicate, for this frame */
	double value; /* what was held against limit: m for CUE and STILL, balls for KEPT and NONE_NEW, balls or 1 for CLEAR */
	double limit;
	double held;   /* s for which it has held without a break */
	double needed; /* s */
	int ball;      /* the ball it fails for, index into the frame's layout (KEPT: into stability.anchor); -1 none */
};

struct stability {
	struct stability_limits limits;
	vec2 last_cue; /* m, for telling the cue ball from other white balls */
	int cue_track; /* its identity, 0 none */
	bool has_cue, begun;
	struct layout anchor;		/* where the balls were when the present quiet began */
	double time;			/* s, of the last frame */
	double away;			/* s for which a ball has been away from its place; -1: none is */
	double blind;			/* s without calibration or white ball; -1: seen */
	enum stability_verdict verdict; /* of the last frame */
	struct stability_result result[STABILITY_CONDITIONS];
};

void stability_init(struct stability *s, const struct stability_limits *limits);

/* The next frame. layout NULL: the table could not be seen. Of several white balls one becomes layout->cue. */
enum stability_verdict stability_frame(struct stability *s, struct layout *layout, const struct stability_view *view);

/* The first condition that fails, else the one that has to hold longest yet; STABILITY_CONDITIONS when the table is stable. */
enum stability_condition stability_obstacle(const struct stability *s);

const char *stability_verdict_name(enum stability_verdict verdict);
/* "cue", "still", ... */
const char *stability_condition_name(enum stability_condition condition);

/* ---- the predicates, for themselves ----------------------------------------------------------------------------------- */

/* The cue ball of a layout: the one white ball, or of several the one with the track of the last cue ball, or within distance of its place.
 * -1: none, or nobody can tell which. */
int stability_find_cue(const struct stability *s, const struct layout *layout);
/* Largest way of a ball from one layout to the other, m, and which ball of to it is (-1: none moved). */
double stability_largest_move(const struct layout *from, const struct layout *to, int *ball);
/* Balls of a that b does not have; *ball: the first of them, -1. KEPT with the anchor as a, NONE_NEW with it as b. */
int stability_missing(const struct layout *a, const struct layout *b, int *ball);

#endif
