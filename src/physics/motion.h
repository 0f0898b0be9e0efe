/* Motion of one ball on the cloth, in every phase: closed forms on a level bed, pieces of them on an uneven one (bed.h),
 * where a "phase" below is a piece. Pure functions.
 * Sliding: slip u = v + r (e_z x w) keeps its direction; dv/dt = -mu_s g u/|u|; the path is a parabola. Rolling:
 * straight, dv/dt = -mu_r g v/|v|. Vertical spin decays by 5 mu_sp g / (2 r^2) in every phase. (Thesis 8.1-8.10;
 * pooltool meta.doc) */
#ifndef BILLIARD_PHYSICS_MOTION_H
#define BILLIARD_PHYSICS_MOTION_H

#include "physics/event.h"
#include "physics/table.h"

/* Slip velocity of the contact point with the cloth, m/s. */
vec2 motion_slip(const struct ball *ball, double radius);

/* Acceleration of the centre in the present phase, m/s^2. */
vec2 motion_acceleration(const struct ball *ball, const struct table *table);

/* Time until the present phase ends by itself (s, INFINITY at rest or potted), and the event that ends it. */
double motion_phase_end(const struct ball *ball, const struct table *table, enum event_kind *kind);

/* The ball dt >= 0 later, within the same phase (dt is at most motion_phase_end). */
struct ball motion_advance(const struct ball *ball, const struct table *table, double dt);

/* The same with the acceleration already known: what the engine calls. */
struct ball motion_advance_by(const struct ball *ball, const struct table *table, vec2 acceleration, double dt);

/* Applies the end of a phase to a ball advanced to it: what the new phase demands holds exactly, not up to rounding. */
void motion_transition(struct ball *ball, const struct table *table, enum event_kind kind);

/* Makes the ball roll at its present velocity, without vertical spin. */
void motion_roll(struct ball *ball, const struct table *table);

/* Sets phase from velocity and spin: a ball whose slip is below rounding rolls, one without speed spins or rests. */
void motion_classify(struct ball *ball, const struct table *table);

#endif
