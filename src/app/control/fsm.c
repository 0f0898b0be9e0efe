#include "app/control/fsm.h"

#include <assert.h>
#include <math.h>
#include <string.h>

struct cell {
	bool written;
	enum fsm_state next;
	unsigned actions;
};

/* A table is read by its columns. */
/* clang-format off */
#define STAY {false, 0, 0}
#define TO(state, actions) {true, FSM_##state, (actions)}
#define CLEAR	 FSM_DO_CLEAR
#define REQUEST	 FSM_DO_REQUEST
#define CANCEL	 FSM_DO_CANCEL
#define SHOW	 FSM_DO_SHOW
#define NOTE	 FSM_DO_NOTE
#define NEXT	 FSM_DO_NEXT
#define PREVIOUS FSM_DO_PREVIOUS
#define REPEAT	 FSM_DO_REPEAT
#define REDRAW	 FSM_DO_REDRAW
#define FORGET	 FSM_DO_FORGET

/* Every cell is written; STAY: stay, do nothing. */
static const struct cell table[FSM_EVENT_COUNT][FSM_STATE_COUNT] = {
/*		   BLIND                          WATCHING                       PLANNING                               SHOWING                             SHOT                           PAUSED */
[FSM_LOST]     = { TO(BLIND, NOTE),               TO(BLIND, NOTE),               TO(BLIND, CANCEL | NOTE),              TO(BLIND, CLEAR | NOTE),            TO(BLIND, NOTE),               STAY },
[FSM_SILENT]   = { TO(BLIND, NOTE),               TO(BLIND, NOTE),               TO(BLIND, CANCEL | NOTE),              TO(BLIND, CLEAR | NOTE),            TO(BLIND, NOTE),               STAY },
[FSM_MOVING]   = { TO(WATCHING, CLEAR),           TO(WATCHING, CLEAR),           TO(WATCHING, CANCEL | CLEAR),          TO(SHOT, CLEAR),                    TO(SHOT, CLEAR),               STAY },
[FSM_DOUBT]    = { TO(WATCHING, NOTE),            TO(WATCHING, NOTE),            STAY,                                  STAY,                               TO(WATCHING, NOTE),            STAY },
[FSM_WISH]     = { TO(WATCHING, NOTE),            TO(WATCHING, NOTE),            TO(WATCHING, CANCEL | NOTE),           TO(WATCHING, CLEAR | NOTE),         TO(WATCHING, NOTE),            STAY },
[FSM_STABLE]   = { TO(PLANNING, CLEAR | REQUEST), TO(PLANNING, CLEAR | REQUEST), TO(PLANNING, CANCEL | CLEAR | REQUEST),TO(PLANNING, CLEAR | REQUEST),      TO(PLANNING, CLEAR | REQUEST), STAY },
[FSM_SAME]     = { TO(SHOWING, SHOW),             TO(SHOWING, SHOW),             STAY,                                  STAY,                               TO(SHOWING, SHOW),             STAY },
[FSM_READY]    = { STAY,                          STAY,                          TO(SHOWING, SHOW),                     TO(SHOWING, SHOW),                  STAY,                          STAY },
[FSM_NONE]     = { STAY,                          STAY,                          TO(SHOWING, NOTE),                     STAY,                               STAY,                          STAY },
[FSM_LATE]     = { STAY,                          STAY,                          TO(PLANNING, NOTE),                    STAY,                               STAY,                          STAY },
[FSM_TIMEOUT]  = { STAY,                          STAY,                          TO(PLANNING, REPEAT),                  STAY,                               TO(WATCHING, CLEAR),           STAY },
[FSM_ANEW]     = { TO(BLIND, FORGET),             TO(WATCHING, FORGET),          TO(PLANNING, CANCEL | REQUEST),        TO(PLANNING, CLEAR | REQUEST),      TO(SHOT, FORGET),              TO(PAUSED, FORGET) },
[FSM_PAUSE]    = { TO(PAUSED, CLEAR | FORGET),    TO(PAUSED, CLEAR | FORGET),    TO(PAUSED, CANCEL | CLEAR | FORGET),   TO(PAUSED, CLEAR | FORGET),         TO(PAUSED, CLEAR | FORGET),    STAY },
[FSM_RESUME]   = { STAY,                          STAY,                          STAY,                                  STAY,                               STAY,                          TO(BLIND, CLEAR) },
[FSM_TOGGLE]   = { TO(PAUSED, CLEAR | FORGET),    TO(PAUSED, CLEAR | FORGET),    TO(PAUSED, CANCEL | CLEAR | FORGET),   TO(PAUSED, CLEAR | FORGET),         TO(PAUSED, CLEAR | FORGET),    TO(BLIND, CLEAR) },
[FSM_NEXT]     = { STAY,                          STAY,                          STAY,                                  TO(SHOWING, NEXT | SHOW),           STAY,                          STAY },
[FSM_PREVIOUS] = { STAY,                          STAY,                          STAY,                                  TO(SHOWING, PREVIOUS | SHOW),       STAY,                          STAY },
[FSM_REDRAW]   = { TO(BLIND, REDRAW),             TO(WATCHING, REDRAW),          TO(PLANNING, REDRAW),                  TO(SHOWING, REDRAW),                TO(SHOT, REDRAW),              TO(PAUSED, REDRAW) },
};
/* clang-format on */

/* The timer of a state runs from when it was entered or last acted for the planner; a note or another look leave it alone. */
static bool restarts(const struct fsm *fsm, const struct cell *cell, enum fsm_event event)
{
	return cell->next != fsm->state || event == FSM_TIMEOUT || event == FSM_MOVING ||
	       (cell->actions & (FSM_DO_REQUEST | FSM_DO_REPEAT));
}

unsigned fsm_step(struct fsm *fsm, enum fsm_event event, double now)
{
	assert(fsm->state < FSM_STATE_COUNT && event < FSM_EVENT_COUNT);
	const struct cell *cell = &table[event][fsm->state];
	if (!cell->written)
		return 0;
	if (restarts(fsm, cell, event))
		fsm->since = now;
	fsm->state = cell->next;
	return cell->actions;
}

double fsm_timeout(const struct fsm *fsm, const struct fsm_limits *limits, double now)
{
	double limit = fsm->state == FSM_PLANNING ? limits->repeat : fsm->state == FSM_SHOT ? limits->shot : INFINITY;
	return fmax(0, fsm->since + limit - now);
}

bool fsm_written(enum fsm_state state, enum fsm_event event)
{
	return table[event][state].written;
}

/* ---- names and the drawing ---------------------------------------------------------------------------------------------- */

const char *fsm_state_name(enum fsm_state state)
{
	static const char *const name[FSM_STATE_COUNT] = {"BLIND", "WATCHING", "PLANNING", "SHOWING", "SHOT", "PAUSED"};
	return name[state];
}

const char *fsm_event_name(enum fsm_event event)
{
	static const char *const name[FSM_EVENT_COUNT] = {"LOST",  "SILENT", "MOVING", "DOUBT", "WISH",	    "STABLE",
							  "SAME",  "READY",  "NONE",   "LATE",	"TIMEOUT",  "ANEW",
							  "PAUSE", "RESUME", "TOGGLE", "NEXT",	"PREVIOUS", "REDRAW"};
	return name[event];
}

/* "clear, request"; in the order in which they are done. */
static void write_actions(FILE *out, unsigned actions)
{
	static const char *const name[] = {"clear", "request",	"cancel", "show",   "note",
					   "next",  "previous", "repeat", "redraw", "forget"};
	const char *before = " / ";
	for (unsigned i = 0; i < sizeof name / sizeof name[0]; i++) {
		if (!(actions >> i & 1))
			continue;
		fprintf(out, "%s%s", before, name[i]);
		before = ", ";
	}
}

/* One arrow for all events that lead from one state to another. */
static void write_arrow(FILE *out, enum fsm_state from, enum fsm_state to)
{
	bool any = false;
	for (enum fsm_event e = 0; e < FSM_EVENT_COUNT; e++) {
		const struct cell *cell = &table[e][from];
		if (!cell->written || cell->next != to)
			continue;
		fprintf(out, any ? "\\n" : "\t%s -> %s [label=\"", fsm_state_name(from), fsm_state_name(to));
		fprintf(out, "%s", fsm_event_name(e));
		write_actions(out, cell->actions);
		any = true;
	}
	if (any)
		fprintf(out, "\"];\n");
}

void fsm_write_lines(FILE *out)
{
	for (enum fsm_state s = 0; s < FSM_STATE_COUNT; s++)
		for (enum fsm_event e = 0; e < FSM_EVENT_COUNT; e++) {
			const struct cell *cell = &table[e][s];
			if (!cell->written)
				continue;
			fprintf(out, "%s %s %s", fsm_state_name(s), fsm_event_name(e), fsm_state_name(cell->next));
			write_actions(out, cell->actions);
			fprintf(out, "\n");
		}
}

void fsm_write_dot(FILE *out)
{
	fprintf(out, "digraph fsm {\n\tnode [shape=box, style=rounded];\n\tbegin [shape=point];\n\tbegin -> %s;\n",
		fsm_state_name(FSM_BLIND));
	for (enum fsm_state from = 0; from < FSM_STATE_COUNT; from++)
		for (enum fsm_state to = 0; to < FSM_STATE_COUNT; to++)
			write_arrow(out, from, to);
	fprintf(out, "}\n");
}
