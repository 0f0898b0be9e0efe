/* Infinity mode's memory around the state machine: what was seen, asked, answered, and what is shown. Knows no bus and no clock: messages and
 * time come in, messages to send come out through struct controller_output. */
#ifndef BILLIARD_APP_CONTROLLER_H
#define BILLIARD_APP_CONTROLLER_H

#include "app/config/config.h"
#include "app/light/draw.h"
#include "app/control/fsm.h"
#include "app/control/keeper.h"
#include "app/control/stability.h"
#include "lcmtypes/billiard_animation_t.h"
#include "lcmtypes/billiard_command_t.h"
#include "lcmtypes/billiard_plan_request_t.h"
#include "lcmtypes/billiard_plan_t.h"
#include "lcmtypes/billiard_stability_t.h"
#include "lcmtypes/billiard_table_state_t.h"
#include "lcmtypes/billiard_vision_doubt_t.h"
#include "search/rules.h"

/* What is to be sent after a call; the caller sends and clears the flags. */
struct controller_output {
	bool request, draw, animation, cancel, stability, game;
	int64_t cancel_id;
};

enum { CONTROLLER_NOTE_SIZE = 96 };

struct controller {
	const struct config *config; /* borrowed */
	struct fsm fsm;
	/* what is seen */
	struct stability stability;
	struct layout seen;	       /* of the last frame that could be used */
	struct layout settled;	       /* the same without the camera's errors */
	int64_t last_frame;	       /* us, to tell outdated frames */
	double last_arrival;	       /* s, monotonic, of it; negative: none yet */
	double unsure_since;	       /* s, monotonic; negative: it is known whether the table rests */
	billiard_vision_doubt_t doubt; /* the newest; utime 0: vision tells none */
	billiard_stability_t report;
	/* what is asked */
	struct layout asked; /* what the present request was made for */
	bool has_asked;
	double asked_at;      /* s, monotonic */
	struct keeper keeper; /* the game, by the rules */
	billiard_plan_request_t request;
	/* what came: the newest answer waits until it has settled */
	billiard_plan_t offered, plan;
	bool has_offer, has_plan, has_none;
	double offered_since; /* s, monotonic, first shot unchanged */
	int sequence;	      /* of the newest answer */
	bool was_cancelled;   /* the planner ended the present request, though nobody here asked for that */
	char none_reason[CONTROLLER_NOTE_SIZE];
	int64_t proposals;
	/* what is shown */
	struct draw_options options;
	bool animate;
	int entry, shot;
	char word[CONTROLLER_NOTE_SIZE];       /* why the table is not taken for still, of the last frame */
	char note[CONTROLLER_NOTE_SIZE];       /* why there is no proposal */
	char drawn_note[CONTROLLER_NOTE_SIZE]; /* what of it is on the table */
	billiard_draw_list_t draw;
	billiard_animation_t animation;
	double animation_since; /* s, monotonic, when it was at its position */
	struct controller_output output;
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
