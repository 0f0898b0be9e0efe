/* The aim of a shot, refined against the simulation. */
#ifndef BILLIARD_SEARCH_REFINE_H
#define BILLIARD_SEARCH_REFINE_H

#include "search/slot.h"

/* Turns the aim of record->shot, slot's node played, until the meant ball goes where it should; up to some 30
 * simulations. True when it then falls. */
bool shot_refine(const struct task *task, struct slot *slot, struct workspace *work, struct record *record,
		 struct rules_outcome *outcome);

#endif
