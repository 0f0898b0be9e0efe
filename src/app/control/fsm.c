#include "app/control/fsm.h"

#include <assert.h>
#include <math.h>

/* A shot that nobody saw come to rest: after this long the table is simply watched again. */
static const double SHOT_TIMEOUT = 60; /* s */

struct cell {
	bool written;
	enum fsm_state next;
	unsigned actions;
};

#define GO(state, actions)                                                                                             \
	{                                                                                                              \
		true, FSM_##state, (actions)                                                                           \
	}
#define CLEAR	FSM_DO_CLEAR
#define REQUEST FSM_DO_REQUEST
#define CANCEL	FSM_DO_CANCEL
#define SHOW	FSM_DO_SHOW
#define NOTE	FSM_DO_NOTE

/* Cells that are not written: stay, do nothing. */
static const struct cell table[FSM_STATE_COUNT][FSM_EVENT_COUNT] =
	{
		[FSM_BLIND] =
			{
				[FSM_MOVING] = GO(WATCHING, CLEAR),
				[FSM_STABLE] = GO(PLANNING, CLEAR | REQUEST),
				[FSM_PAUSE] = GO(PAUSED, CLEAR),
			},
		[FSM_WATCHING] =
			{
				[FSM_LOST] = GO(BLIND, NOTE),
				[FSM_STABLE] = GO(PLANNING, REQUEST),
				[FSM_PAUSE] = GO(PAUSED, CLEAR),
			},
		[FSM_PLANNING] =
			{
				[FSM_LOST] = GO(BLIND, CANCEL | NOTE),
				[FSM_MOVING] = GO(WATCHING, CANCEL),
				[FSM_STABLE] = GO(PLANNING, CANCEL | REQUEST),
				[FSM_READY] = GO(SHOWING, SHOW),
				[FSM_NONE] = GO(SHOWING, NOTE),
				[FSM_TIMEOUT] = GO(PLANNING, FSM_DO_REPEAT),
				[FSM_PAUSE] = GO(PAUSED, CANCEL | CLEAR),
			},
		[FSM_SHOWING] =
			{
				[FSM_LOST] = GO(BLIND, CLEAR | NOTE),
				[FSM_MOVING] = GO(SHOT, CLEAR),
				[FSM_STABLE] = GO(PLANNING, CLEAR | REQUEST),
				[FSM_READY] = GO(SHOWING, SHOW),
				[FSM_PAUSE] = GO(PAUSED, CLEAR),
				[FSM_NEXT] = GO(SHOWING, FSM_DO_NEXT | SHOW),
				[FSM_PREVIOUS] = GO(SHOWING, FSM_DO_PREVIOUS | SHOW),
			},
		[FSM_SHOT] =
			{
				[FSM_LOST] = GO(BLIND, NOTE),
				[FSM_STABLE] = GO(PLANNING, REQUEST),
				[FSM_TIMEOUT] = GO(WATCHING, 0),
				[FSM_PAUSE] = GO(PAUSED, 0),
			},
		[FSM_PAUSED] =
			{
				[FSM_RESUME] = GO(BLIND, 0),
			},
};

unsigned fsm_step(struct fsm *fsm, enum fsm_event event, double now)
{
	assert(fsm->state < FSM_STATE_COUNT && event < FSM_EVENT_COUNT);
	const struct cell *cell = &table[fsm->state][event];
	if (!cell->written)
		return 0;
	fsm->state = cell->next;
	fsm->since = now;
	return cell->actions;
}

double fsm_timeout(const struct fsm *fsm, double plan_timeout, double now)
{
	double limit = fsm->state == FSM_PLANNING ? plan_timeout : fsm->state == FSM_SHOT ? SHOT_TIMEOUT : INFINITY;
	return fmax(0, fsm->since + limit - now);
}

bool fsm_written(enum fsm_state state, enum fsm_event event)
{
	return table[state][event].written;
}

const char *fsm_state_name(enum fsm_state state)
{
	static const char *const name[FSM_STATE_COUNT] = {"BLIND", "WATCHING", "PLANNING", "SHOWING", "SHOT", "PAUSED"};
	return name[state];
}

const char *fsm_event_name(enum fsm_event event)
{
	static const char *const name[FSM_EVENT_COUNT] = {"LOST",    "MOVING", "STABLE", "READY", "NONE",
							  "TIMEOUT", "PAUSE",  "RESUME", "NEXT",  "PREVIOUS"};
	return name[event];
}
