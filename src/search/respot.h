/* Places for a ball that comes back when all spots are taken. */
#ifndef BILLIARD_SEARCH_RESPOT_H
#define BILLIARD_SEARCH_RESPOT_H

#include "physics/table.h"

/* A ball at pos (m) would touch no other ball on the table and no cushion. */
bool respot_is_free(const struct table *table, const struct ball *ball, int count, vec2 pos);

/* The free place on the line from the spot towards the black cushion (+x) that is nearest to the spot: exact, in
 * contact with the ball that is in the way but for RESPOT_GAP. False when there is none before the cushion. */
bool respot_towards_top(const struct table *table, const struct ball *ball, int count, vec2 spot, vec2 *pos);

/* The same towards the bottom (baulk) cushion (-x). */
bool respot_towards_bottom(const struct table *table, const struct ball *ball, int count, vec2 spot, vec2 *pos);

/* Thesis figure 4.44: breadth first over a grid of one diameter around the spot; towards the black cushion, to either
 * side, then away from it. False when the whole bed is taken. */
bool respot_breadth_first(const struct table *table, const struct ball *ball, int count, vec2 spot, vec2 *pos);

#endif
