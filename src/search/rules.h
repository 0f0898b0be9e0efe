/* The rules of snooker as far as a proposal needs them: by the official rules (WPBSA), or, where a state says so, as the
 * thesis' program takes them (4.6.6.1). Pure functions. */
#ifndef BILLIARD_SEARCH_RULES_H
#define BILLIARD_SEARCH_RULES_H

#include "physics/table.h"
#include "physics/trace.h"

/* What may be struck first and potted. */
enum rules_on {
	ON_ANY, /* practice: every object ball (infinity mode of the thesis) */
	ON_RED,
	ON_COLOUR,   /* any of the six colours: after a red */
	ON_CLEARANCE /* no red left: the lowest colour on the table */
};

/* State of the game between two shots. */
struct rules_state {
	enum rules_on on;
	bool in_hand;	/* cue ball may be placed in the D */
	bool free_ball; /* after a foul, snookered: any ball may be taken for the ball on, and counts as that */
	bool any_first; /* not by the rules, but what the thesis' program does: it does not matter which ball is struck
			   first, and colours come back by rules_respot_thesis(). ON_ANY is judged so, too */
};

struct rules_outcome {
	int points; /* for the striker, 0 when foul */
	int foul;   /* penalty, 0 when legal */
	bool cue_potted;
	bool ends;		    /* the frame is over, unless the scores are level: then rules_respot_black() */
	struct rules_state next;    /* state for the same striker's next shot */
	struct ball ball[BALL_MAX]; /* position after respots; potted reds stay POTTED */
	bool respot_failed;	    /* no place was found (thesis: an error) */
};

/* True when a ball of that colour is on in that state, given the balls on the table. */
bool rules_ball_on(const struct rules_state *state, const struct ball *ball, int count, int index);

/* State from a position alone: reds on the table -> ON_RED, none -> ON_CLEARANCE. */
struct rules_state rules_state_from_position(const struct ball *ball, int count);

/* What the opponent, who plays next, is faced with when the striker's visit ends with that outcome: a free ball if he is
 * snookered after a foul. */
struct rules_state rules_opponent(const struct table *table, const struct rules_outcome *out, int count);

/* No ball on can be struck at both of its edges in a straight line past the balls not on. In hand: from no place of a
 * grid over the D. */
bool rules_is_snookered(const struct table *table, const struct rules_state *state, const struct ball *ball, int count);

/* The black on its spot and the cue ball in hand: what decides a frame whose scores are level at its end. */
struct rules_state rules_respot_black(const struct table *table, struct ball *ball, int count);

/* The object ball that ball cue touches first, -1 when it touches none. */
int rules_first_contact(const struct trace *trace, int cue);

/* Judges a finished simulation from its trace (first contact, potted balls), respots colours, gives the next state.
 * nominated: index of the ball aimed at (after a red, or a free ball); -1: none was named, then it is the one struck
 * first. */
void rules_judge(const struct table *table, const struct rules_state *state, const struct trace *trace, int nominated,
		 struct rules_outcome *out);

/* Where a potted colour comes back (Spotting Colours): its own spot, else the highest free spot, else as near as
 * possible to its own spot towards the top cushion, else towards the bottom cushion, else beside it (which the rules
 * need not say). False when there is no place. */
bool rules_respot(const struct table *table, const struct ball *ball, int count, enum ball_colour colour, vec2 *pos);

/* The same in the thesis' program: own spot, next higher free spot, next lower, towards the top cushion, else the
 * breadth-first places of thesis figure 4.44. */
bool rules_respot_thesis(const struct table *table, const struct ball *ball, int count, enum ball_colour colour,
			 vec2 *pos);

#endif
