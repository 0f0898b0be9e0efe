/* What happened in a simulation: enough to say where every ball is at any time. Caller's memory. */
#ifndef BILLIARD_PHYSICS_TRACE_H
#define BILLIARD_PHYSICS_TRACE_H

#include "physics/event.h"
#include "physics/table.h"

/* One event with the states just after it of the balls that took part (second unused unless BALL_BALL). */
struct trace_entry {
	struct event event;
	struct ball after[2];
};

struct trace {
	const struct table *table; /* borrowed; set by sim_run() */
	struct trace_entry *entry; /* borrowed from the caller, capacity entries */
	int capacity, count;
	bool overflow;		     /* more events happened than fit; the first capacity are kept */
	struct ball start[BALL_MAX]; /* states at time 0, after the strike */
	int ball_count;
};

/* An empty trace on the caller's entries. */
void trace_init(struct trace *trace, struct trace_entry *entry, int capacity);

/* State of a ball at time t >= 0 (s). Between events the closed form of its phase holds. */
struct ball trace_at(const struct trace *trace, int ball, double t);

/* Time of the last event, 0 if there is none. */
double trace_end(const struct trace *trace);

#endif
