/* What can be seen of a planner while it works. */
#ifndef BILLIARD_SEARCH_FIGURES_H
#define BILLIARD_SEARCH_FIGURES_H

#include "search/planner.h"

/* Keeps the figures up to date: before the first batch, after each, after the last. */
void show_begin(struct planner *planner);
void show_step(struct planner *planner);
void show_end(struct planner *planner);

#endif
