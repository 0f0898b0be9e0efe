/* The positions of the joint tree: the start, and where each planned shot ends. */
#ifndef BILLIARD_SEARCH_STATE_H
#define BILLIARD_SEARCH_STATE_H

#include <stdatomic.h>

#include "search/budget.h"
#include "search/candidate.h"
#include "search/shot.h"

enum {
	STATES_MAX = 2048,
	AIMS_MAX = 10, /* aims at a pocket: up to 9 points of it, and along a cushion */
	ROOTS_MAX = POCKET_MAX * AIMS_MAX,
	NO_STATE = -1
};

struct state {
	struct ball ball[BALL_MAX];
	struct rules_state rules;
	struct scene scene;		  /* borrows ball */
	struct record record;		  /* the shot that led here, unless it is a root */
	int32_t parent;			  /* NO_STATE for a root */
	int shots;			  /* played before */
	double cost;			  /* of those */
	uint64_t key;			  /* of the shots before, whichever worker found them; 0 for a root */
	_Atomic uint8_t landed[BALL_MAX]; /* bit per pocket that the ball was potted into as meant */
};

/* What a search is about. Does not change while it runs, but for the states, which only get more. All borrowed. */
struct task {
	const struct planner_def *def; /* table, model and player */
	const struct mirrors *mirrors;
	const struct plan_request *request;
	const struct budget *budget;
	struct state *state; /* STATES_MAX */
	int ball_count, cue;
};

/* Makes a state ready to be searched and fills root with its first nodes. Returns how many. */
int state_roots(const struct task *task, int index, struct node root[ROOTS_MAX]);

/* True when the node may be left out: an aim beside a pocket's middle, for a ball that falls there anyway. */
bool state_is_spare(const struct task *task, const struct node *node);

/* A shot played from a state, and judged as there. */
bool state_play(const struct task *task, const struct state *state, struct workspace *work, struct record *record,
		struct rules_outcome *outcome);

/* Nothing on the table is left to play for. */
bool state_is_cleared(const struct rules_outcome *outcome, int count);

#endif
