/* What could be seen of a shot while the balls moved: whether the cue ball was played, what it met first, which of the balls that exist once
 * fell although they may be back by the next rest. Pure: time comes with the frames. */
#ifndef BILLIARD_APP_GAME_WATCH_H
#define BILLIARD_APP_GAME_WATCH_H

#include "app/control/layout.h"

/* A ball of which there is one. */
struct game_single {
	vec2 pos;      /* m, where it was seen last */
	double speed;  /* m/s, there */
	double time;   /* s, then */
	bool seen;     /* at all */
	bool was_away; /* in the last frame */
	/* It came back where it lies since: from a pocket, or after long, or faster than a ball goes. */
	bool jumped;
	/* It came back where it was before, after a while. */
	bool returned;
	vec2 back; /* m, where it came back */
};

struct game_watch {
	struct layout rest; /* the balls before the shot */
	bool played;	    /* the cue ball has left its place */
	double farthest;    /* m, of the cue ball from its place while nothing was over the table */
	int first;	    /* object ball met first, index into rest; -1: none was seen to move */
	bool first_sure;    /* no other moved in the same frame */
	bool moved
		[BALL_MAX]; /* of rest: was seen on its way; one that fell without was gone before it could be seen, nobody knows when */
	struct game_single single[COLOUR_COUNT]; /* by colour; reds are not followed */
};

/* A rest: the next shot starts from here. time: s. */
void game_watch_begin(struct game_watch *watch, const struct layout *rest, double time);
/* A frame. occluded: something is over the table; what is not seen then is not away. */
void game_watch_frame(struct game_watch *watch, const struct table *table, const struct layout *layout, double time,
		      bool occluded);
/* The ball of that colour (not red) fell and was put back before the rest. */
bool game_watch_fell_and_back(const struct game_watch *watch, enum ball_colour colour);
/* A ball of that colour (not red) is away, and was last seen where it may have fallen. */
bool game_watch_fell(const struct game_watch *watch, const struct table *table, enum ball_colour colour);

#endif
