/* Keeps the game: what it is, what it was, and what is seen of the running shot. Pure. */
#ifndef BILLIARD_APP_KEEPER_H
#define BILLIARD_APP_KEEPER_H

#include "app/control/game.h"
#include "lcmtypes/billiard_game_t.h"

enum { KEEPER_UNDO_MAX = 16 };

/* Begins as {0}. */
struct keeper {
	struct game game;
	struct game_watch watch;
	struct game undo[KEEPER_UNDO_MAX]; /* former games, the newest last */
	int undo_count;
	bool watching; /* watch has a rest to start from */
};

/* A frame, cue ball found. time: s. */
void keeper_frame(struct keeper *k, const struct table *table, const struct layout *layout, double time, bool occluded);
/* A rest that can be believed. nudge: m a ball must lie elsewhere to be moved. True when the game changed. */
bool keeper_rest(struct keeper *k, const struct table *table, const struct layout *rest, double nudge, double time);
/* The cue ball was played and went away at a pocket. */
bool keeper_cue_fell(const struct keeper *k, const struct table *table);
/* game_correct(), and "undo". False and the reason when it is neither, or there is nothing to undo. */
bool keeper_correct(struct keeper *k, const char *words, char *err, size_t err_size);
/* A game from before (game_read()). */
void keeper_restore(struct keeper *k, const struct game *game);
void keeper_report(const struct keeper *k, billiard_game_t *out);

#endif
