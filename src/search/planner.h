/* The inside of a planner: what the files of the search share. */
#ifndef BILLIARD_SEARCH_PLANNER_H
#define BILLIARD_SEARCH_PLANNER_H

#include <stdatomic.h>

#include "search/frontier.h"
#include "search/pool.h"
#include "search/shot.h"

enum {
	BATCH = 32,	 /* nodes worked on at a time: never depends on the number of workers, so that results do not */
	FIRST_BATCH = 8, /* the same in the first slice, where the first answer is looked for */
	RANKED_MAX = 64, /* plans whose success is found when a profile ranks by it */
	SPEEDS_MAX = 32, /* start speeds of one candidate */
	CHILDREN_MAX = 2048, /* of one expansion */
	STATES_MAX = 2048,
	AIMS_MAX = 10, /* aims at a pocket: up to 9 points of it, and along a cushion */
	ROOTS_MAX = POCKET_MAX * AIMS_MAX,
	SAFETY_STEP = 4,	      /* after so many batches without a proposal a simple contact is proposed */
	FIRST_SLICE = 8,	      /* batches that the caller works on alone, without waking anybody */
	SAFETY_LIST = PLAN_SHOTS_MAX, /* place of the contact shot among the lists of solutions */
	NO_STATE = -1
};

/* A position of the joint tree: the start or where a planned shot ends. */
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

/* What the simulation made of a complete node at one start speed. */
struct played {
	struct record record;
	struct rules_outcome outcome;
};

/* One node of a batch and what came out of it; each is written by one worker. */
struct slot {
	struct node node;
	struct node child[CHILDREN_MAX];
	int child_count;
	struct played played[SPEEDS_MAX];
	int played_count;
	uint64_t expansions, sims, tried, landed, refined;
	bool overflow;
};

/* A sequence of shots: all but the last are found by going up from state. */
struct solution {
	double cost;
	uint64_t key; /* decides among equal costs: the same whatever was found first */
	int32_t state;
	struct record last;
};

struct solutions {
	struct solution item[PLAN_MAX];
	uint16_t order[PLAN_MAX]; /* indices of items, best first */
	int count, limit;
};

/* What planner_figures() shows of batches. Written by the thread that runs the search. */
struct shown {
	_Atomic uint64_t nodes, sims;
	_Atomic uint32_t open;
	atomic_int busy, depth;
	uint64_t nodes_before, sims_before;
};

struct crew;

struct planner {
	struct planner_def def;
	struct mirrors mirrors;
	struct pool *pool;
	struct workspace *work;	     /* one a worker */
	struct slot *slot;	     /* BATCH */
	uint8_t claim[BATCH];	     /* slots in the order in which workers take them */
	struct state *state;	     /* STATES_MAX */
	struct solutions *solutions; /* by number of shots, and at SAFETY_LIST the contact shot */
	struct plan *plan;	     /* PLAN_MAX, what results point to */
	struct frontier frontier;
	struct crew *crew; /* NULL for SCHEME_BATCH */
	struct shown shown;
	_Atomic uint64_t cancelled; /* runs up to this number are */

	/* of the running search */
	const struct plan_request *request;
	int ball_count, cue, state_count, batch_count;
	uint64_t nodes, sims, tried, landed, refined;
	double deadline;
	bool overflow, cut; /* something was dropped; ended before its time */
};

/* The best so far, with at most limit plans filled in; 0: all. */
void planner_export(struct planner *planner, int limit, struct plan_result *result);

/* Keeps the figures up to date: before the first batch, after each, after the last. */
void show_begin(struct planner *planner);
void show_step(struct planner *planner);
void show_end(struct planner *planner);

/* Sets up the first positions and their roots. */
void search_begin(struct planner *planner);
/* Works on the best open nodes once. False when there is nothing left to do. *improved: a better best plan. */
bool search_step(struct planner *planner, bool *improved);
bool search_is_cancelled(const struct planner *planner);
/* True when cancelled or out of time. */
bool search_is_over(const struct planner *planner);

/* Simulates a complete node at all its start speeds. */
void slot_play(const struct planner *planner, struct slot *slot, struct workspace *work);

/* Turns the aim of record->shot until the meant ball goes where it should; up to some 30 simulations. True when it then
 * falls. */
bool shot_refine(const struct planner *planner, struct slot *slot, struct workspace *work, struct record *record,
		 struct rules_outcome *outcome);

/* Works on slot->node: expands or plays it. */
void slot_work(const struct planner *planner, struct slot *slot, struct workspace *work);
/* True when the node may be left out: an aim beside a pocket's middle, for a ball that falls there anyway. */
bool node_is_spare(const struct planner *planner, const struct node *node);
/* Makes a state ready to be searched and fills root with its first nodes. Returns how many. */
int state_roots(const struct planner *planner, int index, struct node root[ROOTS_MAX]);
/* Nothing on the table is left to play for. */
bool outcome_is_cleared(const struct rules_outcome *outcome, int count);
/* The position that a shot from parent leads to; without its scene. */
void state_set(struct state *state, const struct planner *planner, const struct solution *shot,
	       const struct rules_outcome *outcome);

/* The sequence that ends with record, played from a state. */
struct solution solution_make(const struct planner *planner, uint32_t state, const struct record *record);
/* Sorted insertion; false when it is not among the limit best. */
bool solutions_add(struct solutions *solutions, const struct solution *solution);
/* The rank-th best. */
struct solution *solutions_at(struct solutions *solutions, int rank);
/* The list of the longest sequences that there are; NULL when there is none. */
struct solutions *best_solutions(struct planner *planner);

/* Tolerance and success of one record played from state. */
void tolerance_find(const struct planner *planner, const struct state *state, struct record *record,
		    struct workspace *work);

/* Finds tolerance and success of as many of the best plans as the request or the profile asks for, and ranks by success
 * if the profile does. */
void rank_solutions(struct planner *planner);

/* With nothing to pot (yet): the simplest legal contact becomes the one solution. thorough: beside the middle of balls,
 * over cushions, at last a fan of directions and the cheapest foul. False when there is none. */
bool safety_find(struct planner *planner, bool thorough);

#endif
