#include "physics/event.h"

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
		"ball_pocket", "sliding_rolling", "rolling_spinning", "rolling_stationary",  "spinning_stationary",
		"next_piece"};
	return (unsigned)kind < EVENT_KIND_COUNT ? names[kind] : "none";
}
