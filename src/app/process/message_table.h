/* The tables of message_check(): what is allowed in each message type. Limits are what no table and no clock exceeds, so that what comes
 * after needs no care for overflow. */
#ifndef BILLIARD_APP_MESSAGE_TABLE_H
#define BILLIARD_APP_MESSAGE_TABLE_H

#include "app/process/message_check.h"

extern const struct message_table message_image, message_ball, message_table_state, message_plan_request, message_plan,
	message_draw_list, message_animation, message_command, message_status, message_vision_doubt, message_stability,
	message_lease, message_game;

/* m from the table's centre, along each axis, of everything that lies or moves on it. */
#define MESSAGE_PLACE_MAX 10.0

#endif
