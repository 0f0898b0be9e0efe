/* The game of snooker as it is kept beside the table: score, turn, ball on, ball in hand, balls that wait for their spot. Fed at each rest with
 * what lies there and what was seen of the shot (game_watch.h); src/search/rules judges. Pure, and plain data: a copy is a way back. */
#ifndef BILLIARD_APP_GAME_H
#define BILLIARD_APP_GAME_H

#include <stddef.h>

#include "app/control/game_watch.h"
#include "search/rules.h"

enum { GAME_TEXT_SIZE = 96, GAME_WISHES = 6 };

/* A ball that a hand has to put on its spot. */
struct game_wish {
	enum ball_colour colour;
	vec2 place; /* m */
};

struct game {
	bool begun;
	struct rules_state state; /* that the player whose turn it is is faced with */
	int turn;		  /* 0 or 1 */
	int score[2];
	int break_points;   /* of the present visit */
	int frame, shots;   /* frames begun; shots of this one */
	bool over;	    /* this frame */
	int points, foul;   /* of the last shot */
	struct layout rest; /* the last one */
	struct game_wish wish[GAME_WISHES];
	int wish_count;
};

/* A frame from this position on: turn and score at 0. */
void game_begin(struct game *game, const struct layout *rest);
/* A rest that can be believed. True when a shot was judged or a frame began: what was before is worth keeping for undo. */
bool game_rest(struct game *game, const struct table *table, const struct layout *rest, const struct game_watch *watch);

/* One correction in words: "score 12 0", "turn 2", "on red", "on colour", "on clearance", "hand on", "hand off", "foul 4", "again" (the
 * offender plays again), "frame" (a new one). False and the reason when it is none; then nothing has changed. */
bool game_correct(struct game *game, const char *words, char *err, size_t err_size);

/* What has to be done at the table before anybody plays, for people: "PUT BLUE HERE", "FRAME OVER 54 : 23"; empty: nothing. */
void game_demand(const struct game *game, char out[GAME_TEXT_SIZE]);
/* Where the game stands: "A 12 : 4 B, A plays, a colour is on, break 8". */
void game_words(const struct game *game, char out[GAME_TEXT_SIZE]);

/* The game as text that game_read() takes again; false when it does not fit, or is none. */
bool game_write(const struct game *game, char *out, size_t size);
bool game_read(struct game *game, const char *text);

#endif
