/* A person's arm and cue over the virtual table, table frame, m. */
#ifndef BILLIARD_APP_TABLE_ARM_H
#define BILLIARD_APP_TABLE_ARM_H

#include <stdbool.h>

#include "physics/vec2.h"

struct table_arm {
	bool cue, hand;	  /* which of them is there */
	vec2 tip, bridge; /* of the cue; the hand's middle */
	vec2 elbow;	  /* where the forearm comes from, outside the bed */
};

#endif
