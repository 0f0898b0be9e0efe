/* Resolving contacts inside a simulation: which contacts of one instant belong together, and what keeps their number
 * finite. */
#ifndef BILLIARD_PHYSICS_COLLIDE_H
#define BILLIARD_PHYSICS_COLLIDE_H

#include "physics/sim_state.h"

/* Contacts found together, and the balls that took part (bit i: ball i). */
struct group {
	struct event contact[GROUP_MAX];
	int count;
	uint32_t balls;
};

/* All contacts due at first->time that hang together with first by a shared ball; in the order of event_compare(). */
void collide_collect(const struct sim *sim, const struct event *first, struct group *group);

/* Changes the balls of the group, which must have been advanced to its time. Of contacts that share a ball the impulses
 * are solved at once, so that mirrored positions give mirrored results. Where contacts last (cluster.h) the group grows
 * by those that begin before they end. */
void collide_balls(struct sim *sim, struct group *group);

/* A ball at a cushion, tip or jaw. */
void collide_cushion(struct sim *sim, int ball, const struct nose *nose);

#endif
