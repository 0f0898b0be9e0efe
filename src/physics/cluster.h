/* Balls that lie so close that their contacts overlap in time. A contact of phenolic balls lasts some 300 us and presses
 * them together by tenths of a millimetre: in a rack with gaps of that size the second contact begins while the first
 * is under way, and the balls move as one, not one after the other. Here the contacts of such a cluster are integrated
 * through time: Hertz's force k d^(3/2) with the damping of Tsuji, Tanaka and Ishida (1992), Powder Technology 71, whose
 * restitution is the same at all speeds (Antypov and Elliott 2011, EPL 94, in closed form), and Coulomb friction. */
#ifndef BILLIARD_PHYSICS_CLUSTER_H
#define BILLIARD_PHYSICS_CLUSTER_H

#include "physics/collide.h"

/* Resolves the first contacts of a group together with all that begin before they have ended, until no balls touch: as
 * everywhere, velocities and spins change at once and places stay. The group becomes the contacts that took place, in
 * the order in which they began, and their balls, advanced to now. False, and nothing is changed, when the model knows no
 * lasting contacts or only two balls take part: the law of a single contact says the same in closed form. */
bool cluster_collide(struct sim *sim, struct group *group);

#endif
