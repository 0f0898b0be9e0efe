/* Contact laws by model: what one contact does to the balls. Pure functions; they set velocity, spin and phase. */
#ifndef BILLIARD_PHYSICS_CONTACT_H
#define BILLIARD_PHYSICS_CONTACT_H

#include "physics/model.h"
#include "physics/table.h"

/* Two touching balls that approach. */
void contact_balls(const struct table *table, const struct model *model, struct ball *a, struct ball *b);

/* A ball that approaches a cushion at nose->normal. */
void contact_cushion(const struct table *table, const struct model *model, const struct nose *nose, struct ball *ball);

/* Restitution of the model's frictionless part at an approach speed (m/s, at least 0), and the share of speed that a contact leaves: what a simultaneous
 * contact of more than two balls is solved with. */
double contact_restitution(const struct table *table, const struct model *model, double speed);
double contact_speed_left(const struct table *table, const struct model *model);

/* Phase after a contact; phase is that before it and matters only in thesis motion: a rolling ball rolls on, any other
 * slides without spin, for the time that its new speed gives. (The text of 4.6.4.9 keeps the time from the strike; the
 * thesis' program does not: only so do its cue balls come to rest where its second shots begin.) */
void contact_set_phase(const struct table *table, const struct model *model, enum ball_phase phase, struct ball *ball);

#endif
