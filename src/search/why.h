/* Why a shot is proposed, in the player's words. */
#ifndef BILLIARD_SEARCH_WHY_H
#define BILLIARD_SEARCH_WHY_H

#include "search/estimate.h"
#include "search/shot.h"

/* Fills shot->why and why_ball from one more simulation of the record from where it is played. */
void why_find(struct plan_shot *shot, const struct record *record, const struct setting *from,
	      const struct estimator *estimator, struct workspace *work);

#endif
