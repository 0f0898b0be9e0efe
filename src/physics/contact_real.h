/* Contact laws of the realistic models: what one contact does to velocity and spin. Pure functions: they change vel and
 * spin only, the caller sets the phase. Turned or mirrored input gives turned or mirrored output, up to rounding
 * (Mathavan's law up to the error of its integration). Constants are those of table->material; formulas, sources and
 * ranges are in docs/physics.md. */
#ifndef BILLIARD_PHYSICS_CONTACT_REAL_H
#define BILLIARD_PHYSICS_CONTACT_REAL_H

#include "physics/table.h"

/* Equal balls with restitution e_ball and Coulomb friction mu = a + b exp(-c u), u the slip speed at the contact in m/s
 * (Alciatore TP A.5, A.6, A.14): throw and transfer of spin. Friction acts until the slip has ended, at most. Vertical
 * velocity, which the cloth and gravity take up at once, is dropped. Precondition: the balls approach (asserted). */
void contact_ball_frictional(const struct table *table, struct ball *a, struct ball *b);

/* The friction of the same law alone, for contacts that are solved together: impulse per mass (m/s, across the line of
 * centres and upward) where friction is a share of this normal impulse (m/s; e times the approach in the law of a single
 * contact), at most what ends the share of the slip; and what such an impulse does to the balls. Normal velocities
 * stay. */
vec2 contact_ball_friction(const struct table *table, const struct ball *a, const struct ball *b, double impulse,
			   double share);
void contact_ball_rub(const struct table *table, vec2 impulse, struct ball *a, struct ball *b);

/* Compliant impact on a cushion (Stronge 2000, ch. 5): normal and tangential springs with frequency ratio stronge_omega
 * in (1, 2), restitution nose->e > 1 / stronge_omega, Coulomb friction nose->mu; outside of these ranges the spring
 * is taken as stiff. The contact lies on the line from the ball's
 * centre to a nose one radius away at nose->height (m above the bed, 0 to 2 r): its angle above the horizontal has the
 * tangent nose->height / r - 1. The bed's reaction is left out, vertical velocity dropped. Precondition: the ball
 * approaches. */
void contact_cushion_stronge(const struct table *table, const struct nose *nose, struct ball *ball);

/* Impact on a cushion nose at nose->height (m, 0 to 2 r; 0.1 r to 1.9 r count), pressing the ball on the cloth
 * (Mathavan, Jackson, Parkin 2010): normal impulse integrated with friction at nose (nose->mu) and cloth (mu_slide),
 * restitution nose->e of the work done at the nose. Sticking at either contact is part of the law and handled as a
 * mode of its own. The integration leaves an error below 1e-4 of the speed before (surface speed of the spin included).
 * With friction so high that the ball is wedged between nose and cloth it just stops at the cushion. Precondition: the
 * ball approaches. */
void contact_cushion_mathavan(const struct table *table, const struct nose *nose, struct ball *ball);

#endif
