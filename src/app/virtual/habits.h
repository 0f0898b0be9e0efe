/* The player as a person at the table: he looks, leans over, strikes and walks away; now and then he plays another shot, a second one at once, touches a
 * ball, wipes the cloth, leaves an arm lying. A state machine that knows no bus and no clock; same seed and inputs, same person. He never waits for
 * ever: without a proposal he plays something after a while. */
#ifndef BILLIARD_APP_HABITS_H
#define BILLIARD_APP_HABITS_H

#include "app/config/config.h"
#include "app/virtual/table_arm.h"
#include "physics/sim.h"

enum habits_state {
	HABITS_LOOK,  /* at the table, nothing over it */
	HABITS_AIM,   /* cue and arm behind the cue ball, feathering at the end */
	HABITS_LEAVE, /* they go back */
	HABITS_BUSY   /* a hand over the bed: wipes, touches, lies there, puts down balls */
};

/* What he sees. Balls at rest. */
struct habits_view {
	const struct ball *ball;
	int count;
	bool at_rest;
	int64_t proposal;    /* drawn on the table, 0 none */
	struct shot shot;    /* of it */
	const vec2 *placing; /* where a hand puts down a ball, NULL: nowhere */
};

/* What he does now. */
struct habits_act {
	bool strike;
	struct shot shot;
	int touched; /* ball that he moves, -1 none */
	vec2 to;     /* m, to where */
};

struct habits {
	const struct table *table; /* borrowed */
	struct config_virtual def;
	enum habits_state state;
	double since;	  /* s, of the state */
	double rest;	  /* s, when the table came to rest; NAN: it moves */
	double busy;	  /* s that he is busy */
	int64_t seen;	  /* the proposal looked at */
	double seen_at;	  /* s */
	uint64_t turn;	  /* shots and rests so far: what his whims depend on */
	struct shot shot; /* aimed with */
	vec2 cue;	  /* m, cue ball aimed at */
	bool again;	  /* a second shot at once, when this one rests */
	bool whim_done;	  /* of this rest */
	bool touching;	  /* busy with a ball that will be moved */
	bool wiping;
	int64_t played; /* the last proposal that was played: it is none any more */
};

void habits_init(struct habits *habits, const struct table *table, const struct config_virtual *def);
/* now: s, never backwards. */
struct habits_act habits_tick(struct habits *habits, const struct habits_view *view, double now);
/* What of him is over the table. */
struct table_arm habits_arm(const struct habits *habits, const struct habits_view *view, double now);

#endif
