#include "app/control/keeper.h"

#include <stdio.h>
#include <string.h>

#include "app/process/text.h"

static void remember(struct keeper *k, const struct game *game)
{
	if (k->undo_count == KEEPER_UNDO_MAX)
		memmove(k->undo, k->undo + 1, (size_t)--k->undo_count * sizeof k->undo[0]);
	k->undo[k->undo_count++] = *game;
}

void keeper_frame(struct keeper *k, const struct table *table, const struct layout *layout, double time, bool occluded)
{
	if (k->watching)
		game_watch_frame(&k->watch, table, layout, time, occluded);
}

bool keeper_rest(struct keeper *k, const struct table *table, const struct layout *rest, double nudge, double time)
{
	bool same = k->game.begun && k->watching && !k->watch.played && !layout_differs(&k->game.rest, rest, nudge);
	if (same)
		return false;
	struct game before = k->game;
	/* Nobody watched what came before this rest: it is taken as it is. */
	static const struct game_watch none = {.first = -1};
	bool judged = game_rest(&k->game, table, rest, k->watching ? &k->watch : &none);
	if (judged && before.begun)
		remember(k, &before);
	game_watch_begin(&k->watch, rest, time);
	k->watching = true;
	return true;
}

bool keeper_cue_fell(const struct keeper *k, const struct table *table)
{
	return k->watching && k->watch.played && game_watch_fell(&k->watch, table, COLOUR_WHITE);
}

static bool undo(struct keeper *k, char *err, size_t err_size)
{
	if (k->undo_count == 0) {
		snprintf(err, err_size, "game: nothing to undo");
		return false;
	}
	/* The balls lie as they lie: only what was counted goes back. */
	struct layout rest = k->game.rest;
	k->game = k->undo[--k->undo_count];
	k->game.rest = rest;
	k->game.wish_count = 0;
	return true;
}

bool keeper_correct(struct keeper *k, const char *words, char *err, size_t err_size)
{
	if (strcmp(words, "undo") == 0)
		return undo(k, err, err_size);
	struct game before = k->game;
	if (!game_correct(&k->game, words, err, err_size))
		return false;
	remember(k, &before);
	return true;
}

void keeper_restore(struct keeper *k, const struct game *game)
{
	k->game = *game;
	k->watching = false;
}

void keeper_report(const struct keeper *k, billiard_game_t *out)
{
	const struct game *g = &k->game;
	char words[GAME_TEXT_SIZE], demand[GAME_TEXT_SIZE];
	game_words(g, words);
	game_demand(g, demand);
	*out = (billiard_game_t){
		.utime = out->utime,
		.frame = g->frame,
		.shots = g->shots,
		.turn = (int8_t)g->turn,
		.score = {g->score[0], g->score[1]},
		.break_points = g->break_points,
		.on = (int8_t)g->state.on,
		.in_hand = g->state.in_hand,
		.free_ball = g->state.free_ball,
		.over = g->over,
		.last_points = g->points,
		.last_foul = g->foul,
		.wish_count = g->wish_count,
	};
	for (int i = 0; i < g->wish_count; i++) {
		out->wish_colour[i] = (int8_t)g->wish[i].colour;
		out->wish_x[i] = g->wish[i].place.x;
		out->wish_y[i] = g->wish[i].place.y;
	}
	text_set(out->words, sizeof out->words, words);
	text_set(out->demand, sizeof out->demand, demand);
}
