/* Compares a position that is believed with the one that is there. Pure. */
#ifndef BILLIARD_APP_JUDGE_MATCH_H
#define BILLIARD_APP_JUDGE_MATCH_H

#include "lcmtypes/billiard_ball_t.h"
#include "physics/ball.h"

/* A position without its history. */
struct judge_position {
	int count;
	struct {
		vec2 at; /* m */
		enum ball_colour colour;
		int track;
	} ball[BALL_MAX];
};

/* Takes those balls of a checked message that are not potted. */
void judge_position_from(struct judge_position *out, const billiard_ball_t *ball, int count);

/* Each believed ball is given to at most one real one, the nearest pairs first, never farther than reach. */
struct judge_match {
	int real_of[BALL_MAX];	   /* by believed ball: its real one, -1 none */
	int believed_of[BALL_MAX]; /* by real ball */
	int missing;		   /* real balls that nobody believes in */
	int extra;		   /* believed balls that are not there */
	int doubles;		   /* those of extra that lie at a real ball, of whatever colour: it is seen twice */
	int colour_wrong;	   /* pairs of different colours */
	double max_error;	   /* m, of the pairs, 0 when there is none */
};

/* reach: m; both positions may hold 0 to BALL_MAX balls. */
void judge_match(const struct judge_position *real, const struct judge_position *believed, double reach,
		 struct judge_match *out);

#endif
