#include "search/why.h"

#include <stdio.h>

/* Chance (0..1) from which a next pot is position, and below which the opponent has none. */
static const double POSITION_CHANCE = 0.6, NO_POT_CHANCE = 0.25;
/* Pots of less chance than this are not looked at. */
static const double LEAST_CHANCE = 0.05;

static double best_chance(const struct pot *pot, int pots)
{
	double best = 0;
	for (int i = 0; i < pots; i++)
		best = fmax(best, pot[i].chance);
	return best;
}

static bool is_empty(const struct rules_outcome *outcome, int count)
{
	for (int i = 0; i < count; i++)
		if (rules_ball_on(&outcome->next, outcome->ball, count, i))
			return false;
	return true;
}

static struct setting end_of(const struct setting *from, const struct rules_outcome *outcome,
			     const struct rules_state *rules)
{
	return (struct setting){from->table, from->model, outcome->ball, from->count, rules};
}

static void why_pot(struct plan_shot *shot, const struct rules_outcome *outcome, const struct setting *from,
		    const struct estimator *estimator)
{
	struct pot pot[POTS_MAX];
	shot->why = WHY_POT;
	if (is_empty(outcome, from->count)) {
		shot->why = WHY_LAST;
		return;
	}
	if (outcome->next.in_hand)
		return;
	const struct setting end = end_of(from, outcome, &outcome->next);
	int pots = estimate_pots(estimator, &end, POSITION_CHANCE, pot);
	if (pots == 0)
		return;
	shot->why = WHY_POSITION;
	shot->why_ball = pot[0].ball;
}

static void why_safety(struct plan_shot *shot, const struct rules_outcome *outcome, const struct setting *from,
		       const struct estimator *estimator)
{
	struct pot pot[POTS_MAX];
	struct rules_state theirs = rules_opponent(from->table, outcome, from->count);
	const struct setting end = end_of(from, outcome, &theirs);
	shot->why = WHY_LEAST;
	if (rules_is_snookered(from->table, from->rules, from->ball, from->count))
		shot->why = WHY_ESCAPE;
	else if (rules_is_snookered(from->table, &theirs, outcome->ball, from->count))
		shot->why = WHY_SNOOKER;
	else if (!theirs.in_hand && best_chance(pot, estimate_pots(estimator, &end, LEAST_CHANCE, pot)) < NO_POT_CHANCE)
		shot->why = WHY_NO_POT;
}

void why_find(struct plan_shot *shot, const struct record *record, const struct setting *from,
	      const struct estimator *estimator, struct workspace *work)
{
	struct record again = *record;
	struct rules_outcome outcome;
	shot->why = WHY_UNKNOWN;
	shot->why_ball = -1;
	if (!shot_play(work, from, &again, &outcome))
		return;
	if (outcome.foul > 0)
		shot->why = WHY_FOUL;
	else if (outcome.points > 0)
		why_pot(shot, &outcome, from, estimator);
	else
		why_safety(shot, &outcome, from, estimator);
}

static const char *lower_name(enum ball_colour colour)
{
	static const char *const names[] = {
		[COLOUR_WHITE] = "cue ball",  [COLOUR_RED] = "a red",	    [COLOUR_YELLOW] = "the yellow",
		[COLOUR_GREEN] = "the green", [COLOUR_BROWN] = "the brown", [COLOUR_BLUE] = "the blue",
		[COLOUR_PINK] = "the pink",   [COLOUR_BLACK] = "the black", [COLOUR_UNKNOWN] = "the next ball"};
	return names[colour];
}

const char *plan_why_text(const struct plan_shot *shot, char *text, size_t size)
{
	static const char *const sentences[] = {
		[WHY_UNKNOWN] = "",
		[WHY_POT] = "best pot",
		[WHY_POSITION] = "pot with position for",
		[WHY_LAST] = "pot of the last ball",
		[WHY_NO_POT] = "safety: leaves no pot",
		[WHY_SNOOKER] = "safety: leaves a snooker",
		[WHY_LEAST] = "safety: leaves the least",
		[WHY_ESCAPE] = "escape from a snooker",
		[WHY_FOUL] = "no legal shot found",
	};
	bool named = shot->why == WHY_POSITION && shot->why_ball >= 0;
	snprintf(text, size, "%s%s%s", sentences[shot->why], named ? " " : "",
		 named ? lower_name(shot->start[shot->why_ball].colour) : "");
	return text;
}
