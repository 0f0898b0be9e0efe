/* One shot of another simulator (pooltool) as JSON: {"table", "params", "models", "cue", "balls", "post_strike"}, SI
 * units. Its frame has x along the table's width, y along its length and the origin in a corner; it is turned into the
 * table frame when read and back when printed. */
#ifndef BILLIARD_APP_SHOT_FILE_H
#define BILLIARD_APP_SHOT_FILE_H

#include <stdio.h>

#include "physics/sim.h"

enum { SHOT_ID_SIZE = 32 };

struct shot_file {
	struct table table; /* finished */
	struct model model;
	struct ball ball[BALL_MAX]; /* table frame, just after the strike */
	int ball_count;
	char ball_id[BALL_MAX][SHOT_ID_SIZE];
	char cushion_id[CUSHION_MAX][SHOT_ID_SIZE];
	char jaw_id[JAW_MAX][SHOT_ID_SIZE];
	char pocket_id[POCKET_MAX][SHOT_ID_SIZE];
};

/* From text (name: for messages). 0, or -EINVAL with "name: reason" in err; *out is untouched on failure. */
int shot_file_parse(struct shot_file *out, const char *name, const char *text, size_t size, char *err, size_t err_size);
/* The same from a file ("-" is standard input). 0 or a negative errno. */
int shot_file_read(struct shot_file *out, const char *path, char *err, size_t err_size);

/* Simulates and prints one JSON object per event: {"t", "event", "ids", "post": {ID: {"s", "r", "v", "w"}}}, in the
 * file's frame; s: 0 at rest, 1 spinning, 2 sliding, 3 rolling, 4 potted. 0; -ENOMEM; -EIO when out does not take it;
 * -ETIME after max_events. */
int shot_file_run(const struct shot_file *file, int max_events, FILE *out);

#endif
