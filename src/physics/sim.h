/* Event-driven simulation of one shot: closed-form motion between events, no time steps.
 * A struct sim lives in the caller's memory, belongs to one thread, allocates nothing, reads no clock. */
#ifndef BILLIARD_PHYSICS_SIM_H
#define BILLIARD_PHYSICS_SIM_H

#include <stdint.h>

#include "physics/event.h"
#include "physics/model.h"
#include "physics/table.h"
#include "physics/trace.h"

/* m/s; no strike is faster. */
#define SHOT_SPEED_MAX 20.0
/* rad; a cue upright leaves no direction. */
#define SHOT_ELEVATION_MAX 1.5707

/* A cue strike. Defaults to a level centre hit when only angle and speed are set. */
struct shot {
	double angle;	  /* rad, direction of the cue, counter-clockwise from +x */
	double speed;	  /* m/s of the ball after the strike, 0 < speed <= 20 */
	double side;	  /* contact point, share of the radius, + = left of the line of aim: spin z < 0 */
	double follow;	  /* contact point, share of the radius, + = above the middle */
	double elevation; /* rad, cue raised by, 0 <= elevation < pi/2 */
};

/* True for a shot in the ranges above, the tip on the ball (side^2 + follow^2 < 1): what every border asks before it
 * lets a shot in. */
bool shot_is_playable(const struct shot *shot);

/* rad: a ball struck `side` left of its middle starts this much to the right of the cue's direction (Alciatore TP A.31;
 * 0 while material.cue_end_mass is). So a ball that shall go at angle a wants the cue at a + shot_squirt(): the exact
 * inverse, at every speed and height. */
double shot_squirt(const struct table *table, double side);

enum sim_end { SIM_AT_REST, SIM_TIME_LIMIT, SIM_EVENT_LIMIT };

struct sim_limits {
	double max_time; /* s; INFINITY for none */
	int max_events;	 /* > 0 */
};

#include "physics/sim_state.h"

/* Balls are copied. Precondition: table_finish() done, table_check_balls() accepts the balls (asserted: all finite,
 * count in 1..BALL_MAX; the rest is the border's to check, a search calls this too often). The table is borrowed until
 * the last use of sim. Balls may already move. */
void sim_init(struct sim *sim, const struct table *table, const struct model *model, const struct ball *ball,
	      int count);

/* Strikes a ball now. Asserts shot_is_playable() and a ball that is on the table: both are the border's to check. */
void sim_strike(struct sim *sim, int ball, const struct shot *shot);

/* Goes to the next event and resolves it. False: all balls are at rest or potted. */
bool sim_step(struct sim *sim, struct event *event);

/* Runs to the end. trace may be NULL; else it is begun anew and filled. */
enum sim_end sim_run(struct sim *sim, const struct sim_limits *limits, struct trace *trace);

/* State of one ball at sim->time (the engine keeps balls at the time of their own last event). */
struct ball sim_ball(const struct sim *sim, int ball);

/* Field by field, no padding: equal input gives the equal hash on every platform and optimisation level. */
uint64_t sim_hash(const struct sim *sim, uint64_t seed);

/* Mechanical energy in J of all balls on the table: translation and rotation; in thesis motion translation only, as its
 * energy balance has it (8.14 to 8.19). */
double sim_energy(const struct sim *sim);

#endif
