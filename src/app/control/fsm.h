/* The controller of infinity mode (thesis 4.9) as one table of states and events: all that it decides. Pure: no bus, no clock; the caller
 * performs the actions that a step returns. */
#ifndef BILLIARD_APP_FSM_H
#define BILLIARD_APP_FSM_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum fsm_state {
	FSM_BLIND,    /* not calibrated, or no cue ball */
	FSM_WATCHING, /* sees the table, waits for rest */
	FSM_PLANNING, /* asked for a plan */
	FSM_SHOWING,  /* a proposal (or the note that there is none) is on the table */
	FSM_SHOT,     /* balls move */
	FSM_PAUSED,
	FSM_STATE_COUNT
};

enum fsm_event {
	FSM_LOST,   /* nothing can be known about the balls */
	FSM_SILENT, /* no frames come */
	FSM_MOVING,
	FSM_DOUBT,   /* nothing moves, and yet for some time it was not known how the balls lie */
	FSM_WISH,    /* at rest, but a hand has something to do before anybody plays: a ball on its spot, a new frame */
	FSM_STABLE,  /* at rest, in a layout that no proposal was made for */
	FSM_SAME,    /* at rest, in the layout of the present request or proposal */
	FSM_READY,   /* a plan for the present request is to be shown */
	FSM_NONE,    /* the planner found none, or refused */
	FSM_LATE,    /* no answer yet, which has to be said */
	FSM_TIMEOUT, /* nothing happened for the time of fsm_timeout() */
	FSM_ANEW,    /* the balls lie as they lay, but something else is asked for: another mode, a corrected game */
	FSM_PAUSE,
	FSM_RESUME,
	FSM_TOGGLE, /* pause or resume, whichever it is not */
	FSM_NEXT,   /* show the next proposal */
	FSM_PREVIOUS,
	FSM_REDRAW, /* what is drawn is to look otherwise */
	FSM_EVENT_COUNT
};

enum fsm_action {
	FSM_DO_CLEAR = 1 << 0,	 /* take the proposal off the table */
	FSM_DO_REQUEST = 1 << 1, /* send a new request for the layout seen */
	FSM_DO_CANCEL = 1 << 2,	 /* tell the planner that the request is void */
	FSM_DO_SHOW = 1 << 3,	 /* draw the present proposal, or why there is none */
	FSM_DO_NOTE = 1 << 4,	 /* draw why there is no proposal */
	FSM_DO_NEXT = 1 << 5,	 /* go to the next proposal, before SHOW */
	FSM_DO_PREVIOUS = 1 << 6,
	FSM_DO_REPEAT = 1 << 7, /* send the same request again */
	FSM_DO_REDRAW = 1 << 8, /* draw what is on the table anew */
	FSM_DO_FORGET = 1 << 9	/* the proposal known is not to come back, even for the same layout */
};

struct fsm {
	enum fsm_state state;
	double since; /* s, when the state was entered or its timer restarted; any epoch */
};

/* s after which FSM_TIMEOUT is due. */
struct fsm_limits {
	double repeat; /* without an answer, in PLANNING */
	double shot;   /* a shot that nobody saw come to rest */
};

/* One step at time now (s, the epoch of since). Returns the set of actions, to be done in the order of the enum. */
unsigned fsm_step(struct fsm *fsm, enum fsm_event event, double now);
/* s until FSM_TIMEOUT is due, INFINITY never. */
double fsm_timeout(const struct fsm *fsm, const struct fsm_limits *limits, double now);

/* False for "stay, do nothing". */
bool fsm_written(enum fsm_state state, enum fsm_event event);
const char *fsm_state_name(enum fsm_state state);
const char *fsm_event_name(enum fsm_event event);
/* The table, a line for each cell that does not stay: "STATE EVENT NEXT / actions". */
void fsm_write_lines(FILE *out);
/* The table as a drawing for Graphviz's dot. */
void fsm_write_dot(FILE *out);

#endif
