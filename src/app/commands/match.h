/* The judge of play: visits and whole frames played by planners on the simulated table, with a player's errors and by
 * the rules. Knows no bus, file or clock of its own. Same seed, same result, unless a budget in seconds cuts searches
 * short. */
#ifndef BILLIARD_APP_COMMANDS_MATCH_H
#define BILLIARD_APP_COMMANDS_MATCH_H

#include "search/plan.h"

enum { MATCH_DECILES = 10 };

/* Who plays: a planner, and what it is asked for. */
struct match_side {
	struct planner *planner;     /* borrowed; used by one thread at a time */
	struct plan_request request; /* depth, rails, budget, ...; balls and state are filled in */
};

struct match_setting {
	const struct table *table;
	struct model model;	   /* what really happens */
	struct player_error error; /* how the player really errs */
	uint64_t seed;
	bool from_break;	      /* false: a random position in the middle of a frame */
	double (*now)(void *context); /* s, for the time that proposals take; NULL: not measured */
	void *now_context;
};

/* What was counted, over visits or frames; sums, so that parts can be added. */
struct match_count {
	int visits, shots, pots_proposed, pots_made, fouls, safeties, no_answer;
	double points, points2;	   /* of visits: sum, and sum of squares */
	double predicted, seconds; /* sums over pots; over shots */
	double brier;		   /* sum of squared errors of the predicted chance */
	double expected;	   /* points: sum over visits of what the first proposal promised */
	double decile_predicted[MATCH_DECILES];
	int decile_made[MATCH_DECILES], decile_count[MATCH_DECILES];
};
void match_add(struct match_count *sum, const struct match_count *part);

/* A visit: follows the first proposal until a shot scores nothing. index names the position. */
void match_visit(const struct match_setting *setting, struct match_side *side, int index, struct match_count *count);

struct match_frame {
	int points[2]; /* of side 0 and 1 */
	int winner;    /* 0, 1; -1 drawn or not ended */
	int shots;
};
/* A frame of two sides. index names the position; side index % 2 breaks. count: one per side. */
void match_frame_play(const struct match_setting *setting, struct match_side side[2], int index,
		      struct match_count count[2], struct match_frame *frame);

/* The start of visit or frame index: the cue ball first. Returns how many balls. */
int match_position(const struct match_setting *setting, int index, struct ball ball[BALL_MAX]);

#endif
