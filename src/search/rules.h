/* The rules of snooker as far as a proposal needs them (thesis 4.6.6.1). Pure functions. */
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
	bool any_first; /* it does not matter which ball is struck first: not by the rules, but what the thesis' program
			   does */
};

struct rules_outcome {
	int points; /* for the striker, 0 when foul */
	int foul;   /* penalty, 0 when legal */
	bool cue_potted;
	struct rules_state next;    /* state for the same striker's next shot */
	struct ball ball[BALL_MAX]; /* position after respots; potted reds stay POTTED */
	bool respot_failed;	    /* no place was found (thesis: an error) */
};

/* True when a ball of that colour is on in that state, given the balls on the table. */
bool rules_ball_on(const struct rules_state *state, const struct ball *ball, int count, int index);

/* State from a position alone: reds on the table -> ON_RED, none -> ON_CLEARANCE. */
struct rules_state rules_state_from_position(const struct ball *ball, int count);

/* The object ball that ball cue touches first, -1 when it touches none. */
int rules_first_contact(const struct trace *trace, int cue);

/* Judges a finished simulation from its trace (first contact, potted balls), respots colours, gives the next state.
 * nominated: index of the ball aimed at (for ON_COLOUR), -1 unknown. */
void rules_judge(const struct table *table, const struct rules_state *state, const struct trace *trace, int nominated,
		 struct rules_outcome *out);

/* Where a potted colour comes back: own spot, next higher free spot, else as near as possible to its own spot towards
 * the black cushion, else the breadth-first places of thesis figure 4.44. False when there is no place. */
bool rules_respot(const struct table *table, const struct ball *ball, int count, enum ball_colour colour, vec2 *pos);

#endif
