/* The controller fed with messages as they come from the bus; nothing else is real. 30 frames a second. */
#ifndef BILLIARD_TESTS_CONTROLLER_RIG_H
#define BILLIARD_TESTS_CONTROLLER_RIG_H

#include "app/control/controller.h"

enum { FRAME_US = 33333, MANY = 60 };

extern struct controller_rig {
	struct config config;
	struct controller c;
	billiard_table_state_t state; /* of the frame to come */
	double now;		      /* s */
	int64_t draws, cancels;
	int64_t requests, sent, last_id; /* requests: each once; sent: repeated ones, too */
} ctl;

/* A white, two reds and a black at rest, nothing seen yet. */
void ctl_setup(void);
void ctl_place(int i, enum ball_colour colour, double x, double y);
/* As from the bus: what its table does not allow reaches no controller. */
bool ctl_see(const billiard_table_state_t *message);
bool ctl_take(const billiard_plan_t *message);
bool ctl_command(const char *name, const char *argument);
/* Whether what is to be sent may be. */
bool ctl_draws_well(void);
bool ctl_moves_well(void);
/* What the process around it would send. */
struct controller_output ctl_flush(void);
/* The next frame, or so many. */
bool ctl_frame(void);
void ctl_frames(int count);
/* Balls roll for some frames and stop elsewhere. */
void ctl_shot(void);
/* An answer to the last request; borrowed until the next call. */
billiard_plan_t *ctl_answer(int8_t status, double angle);
/* To a table with a proposal on it. */
void ctl_proposed(void);

#endif
