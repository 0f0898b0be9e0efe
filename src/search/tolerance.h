/* How far a shot may be off before the pot fails. */
#ifndef BILLIARD_SEARCH_TOLERANCE_H
#define BILLIARD_SEARCH_TOLERANCE_H

#include "search/state.h"

/* Tolerance and success of one record played from state; left unknown when the search is over before they are. */
void tolerance_find(const struct task *task, const struct state *state, struct record *record, struct workspace *work);

#endif
