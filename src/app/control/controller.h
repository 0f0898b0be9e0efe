/* Infinity mode's memory around the state machine: what was seen, asked, answered, and what is shown. Knows no bus and no clock: messages and
 * time come in, messages to send come out through struct controller_output. */
#ifndef BILLIARD_APP_CONTROLLER_H
#define BILLIARD_APP_CONTROLLER_H

#include "app/config/config.h"
#include "app/light/draw.h"
#include "app/control/fsm.h"
#include "app/control/stability.h"
#include "lcmtypes/billiard_animation_t.h"
#include "lcmtypes/billiard_command_t.h"
#include "lcmtypes/billiard_plan_request_t.h"
#include "lcmtypes/billiard_plan_t.h"
#include "lcmtypes/billiard_table_state_t.h"
#include "lcmtypes/billiard_vision_doubt_t.h"
#include "search/rules.h"

/* What is to be sent after a call; the caller sends and clears the flags. */
struct controller_output {
	bool request, draw, animation, cancel;
	int64_t cancel_id;
};

struct controller {
	const struct config *config; /* borrowed */
	struct fsm fsm;
	struct stability stability;
	struct layout seen;  /* of the last frame that could be used */
	struct layout asked; /* what the present request was made for */
	bool has_asked;
	int64_t last_frame;	       /* us, to tell outdated frames */
	billiard_vision_doubt_t doubt; /* the newest; utime 0: vision tells none */
	char note[96];		       /* why there is no proposal */
	char drawn_note[96];	       /* what of it is on the table */
	struct rules_state rules;
	struct draw_options options;
	bool animate;
	billiard_plan_request_t request;
	billiard_plan_t plan; /* the newest answer to request */
	bool has_plan;
	bool was_cancelled; /* the planner ended the present request, though nobody here asked for that */
	int entry, shot;    /* shown */
	billiard_draw_list_t draw;
	billiard_animation_t animation;
	double animation_since; /* s, monotonic, when it was at its position */
	struct controller_output output;
	int64_t proposals;
};

void controller_init(struct controller *c, const struct config *config);
/* Messages that passed message_check(); plans are held against the table here (plan_check()). Each returns false when the message is outdated
 * or not acceptable; now: s, monotonic. */
/* What vision doubts of the state that comes next. */
void controller_doubt(struct controller *c, const billiard_vision_doubt_t *doubt);
bool controller_state(struct controller *c, const billiard_table_state_t *state, double now);
bool controller_plan(struct controller *c, const billiard_plan_t *plan, double now);
bool controller_command(struct controller *c, const billiard_command_t *command, double now);
/* To be called at least every 100 ms. */
void controller_tick(struct controller *c, double now);

#endif
