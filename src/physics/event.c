#include "physics/event.h"

static bool takes_part(const struct event *event, int ball)
{
	return event->ball == ball || (event->kind == EVENT_BALL_BALL && event->other == ball);
}

enum node_kind event_node(const struct event *event, int ball, enum ball_phase phase_after)
{
	if (phase_after == BALL_POTTED)
		return NODE_OUT_OF_SYSTEM;
	if (takes_part(event, ball)) {
		switch (event->kind) {
		case EVENT_STRIKE:
			return NODE_ENERGY_INPUT;
		case EVENT_BALL_BALL:
		case EVENT_CUSHION:
		case EVENT_JAW:
			return NODE_ENERGY_TRANSFER;
		default:
			break;
		}
	}
	return phase_after == BALL_REST ? NODE_NO_ENERGY : NODE_CUTTING;
}

int event_compare(const struct event *a, const struct event *b)
{
	if (a->time != b->time)
		return a->time < b->time ? -1 : 1;
	if (a->kind != b->kind)
		return a->kind < b->kind ? -1 : 1;
	if (a->ball != b->ball)
		return a->ball < b->ball ? -1 : 1;
	return (a->other > b->other) - (a->other < b->other);
}

const char *event_kind_name(enum event_kind kind)
{
	static const char *const names[EVENT_KIND_COUNT] = {
		"none",	       "strike",	  "ball_ball",	      "ball_linear_cushion", "ball_circular_cushion",
		"ball_pocket", "sliding_rolling", "rolling_spinning", "rolling_stationary",  "spinning_stationary"};
	return (unsigned)kind < EVENT_KIND_COUNT ? names[kind] : "none";
}
