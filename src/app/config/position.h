/* Position text of thesis 4.8: one ball a line "ID, TYPE, x, y" in mm, '#' comments, an optional "V, vx, vy" line in
 * mm/s for the cue ball; or one line of `billiard detect --json`, whose balls are named RED1, RED2, ... */
#ifndef BILLIARD_APP_POSITION_H
#define BILLIARD_APP_POSITION_H

#include <stddef.h>

#include "physics/table.h"

enum { BALL_NAME_SIZE = 16 };

struct position {
	struct ball ball[BALL_MAX]; /* m */
	char name[BALL_MAX][BALL_NAME_SIZE];
	int count;
	bool has_velocity;
	vec2 velocity; /* m/s, of the cue ball */
};

/* From text (name: for messages). 0, or -EINVAL with "name:line: reason" in err; *out is untouched on failure.
 * Refuses two cue balls, equal IDs, unknown types, no ball or more than BALL_MAX, numbers that are none, balls that
 * overlap or lie off the table, a velocity without a cue ball. */
int position_parse(struct position *out, const struct table *table, const char *name, const char *text, size_t size,
		   char *err, size_t err_size);
/* The same from a file ("-" is standard input). */
int position_read(struct position *out, const struct table *table, const char *path, char *err, size_t err_size);
/* Index of the ball of that ID, -1 none. */
int position_find(const struct position *position, const char *name);
/* Index of the cue ball, -1 none. */
int position_cue(const struct position *position);

#endif
