/* What happens next: for each ball its own next event, for each pair its contact time (thesis 8.14: computed once, kept
 * until one of the balls is touched). Fixed size, part of struct sim. */
#ifndef BILLIARD_PHYSICS_QUEUE_H
#define BILLIARD_PHYSICS_QUEUE_H

#include "physics/event.h"

enum { PAIR_MAX = BALL_MAX * (BALL_MAX - 1) / 2 };

struct queue {
	int count;		    /* balls */
	struct event own[BALL_MAX]; /* time INFINITY: none */
	double pair[PAIR_MAX];	    /* s; row of the higher ball, INFINITY: none */
	double row_time[BALL_MAX];  /* s; earliest of a row */
	int16_t row_low[BALL_MAX];  /* its lower ball; -1: none */
};

/* No events for count balls. */
void queue_init(struct queue *queue, int count);
/* Replaces a ball's own next event. */
void queue_set_own(struct queue *queue, int ball, const struct event *event);
/* Replaces a pair's contact time; low < high. */
void queue_set_pair(struct queue *queue, int low, int high, double time);
double queue_pair(const struct queue *queue, int low, int high);
/* The first event in the strict order of event_compare(); false when there is none. */
bool queue_first(const struct queue *queue, struct event *event);

#endif
