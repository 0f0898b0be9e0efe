#include "app/process/message_table.h"

#include <math.h>

#include "lcmtypes/billiard_animation_t.h"
#include "lcmtypes/billiard_command_t.h"
#include "lcmtypes/billiard_draw_list_t.h"
#include "lcmtypes/billiard_game_t.h"
#include "lcmtypes/billiard_image_t.h"
#include "lcmtypes/billiard_lease_t.h"
#include "lcmtypes/billiard_plan_request_t.h"
#include "lcmtypes/billiard_plan_t.h"
#include "lcmtypes/billiard_stability_t.h"
#include "lcmtypes/billiard_status_t.h"
#include "lcmtypes/billiard_table_state_t.h"
#include "lcmtypes/billiard_vision_doubt_t.h"
#include "physics/event.h"
#include "physics/table.h"

/* ---- how a line is written: type, member, what counts it, lowest, highest --------------------------------------------- */

/* clang-format off */
#define OF(type, member) (((type *)0)->member)
#define LENGTH(x) ((int)(sizeof(x) / sizeof((x)[0])))
#define TABLE(members) {members, LENGTH(members)}
#define KIND(x) _Generic((x), int8_t: MEMBER_INT8, int16_t: MEMBER_INT16, int32_t: MEMBER_INT32, int64_t: MEMBER_INT64, \
	double: MEMBER_DOUBLE, default: MEMBER_MESSAGE)
#define ONE(type, member, ...) \
	{#member, KIND(OF(type, member)), offsetof(type, member), sizeof OF(type, member), 1, NULL, __VA_ARGS__, NULL}
#define MANY(type, member, counted, ...) \
	{#member, KIND(OF(type, member)[0]), offsetof(type, member), sizeof OF(type, member)[0], \
	 LENGTH(OF(type, member)), counted, __VA_ARGS__, NULL}
#define PARTS(type, member, counted, table) \
	{#member, MEMBER_MESSAGE, offsetof(type, member), sizeof OF(type, member)[0], \
	 LENGTH(OF(type, member)), counted, 0, 0, &(table)}
/* clang-format on */
#define COUNT(type, member, of, low) ONE(type, member, low, LENGTH(OF(type, of)))

/* ---- what no table and no clock exceeds ------------------------------------------------------------------------------ */

#define PLACE	     -MESSAGE_PLACE_MAX, MESSAGE_PLACE_MAX /* m */
#define SPEED	     -100.0, 100.0			   /* m/s, m/s^2 */
#define TIME	     0.0, 3600.0			   /* s */
#define UTIME	     0.0, 9007199254740992.0		   /* us: until the year 2255 */
#define LIGHT	     -100.0, 100.0			   /* m: places of lines, which may end off the table */
#define LENGTHS	     0.0, 100.0				   /* m */
#define SHARE	     -1.0, 1.0
#define ANY	     -INFINITY, INFINITY
#define FROM(lowest) lowest, INFINITY
#define BALL_INDEX   -1.0, BALL_MAX - 1
#define POCKET_INDEX -1.0, POCKET_MAX - 1
#define COLOUR	     0.0, COLOUR_COUNT - 1
#define PHASE	     0.0, BALL_POTTED

/* ---- balls, what is seen ---------------------------------------------------------------------------------------------- */

static const struct message_member ball[] = {
	ONE(billiard_ball_t, track, FROM(0.0)),
	ONE(billiard_ball_t, colour, COLOUR),
	ONE(billiard_ball_t, phase, PHASE),
	ONE(billiard_ball_t, x, PLACE),
	ONE(billiard_ball_t, y, PLACE),
	/* Differences of two frames: a false ball may seem to fly. */
	ONE(billiard_ball_t, vx, ANY),
	ONE(billiard_ball_t, vy, ANY),
	ONE(billiard_ball_t, confidence, ANY),
};
const struct message_table message_ball = TABLE(ball);

static const struct message_member table_state[] = {
	ONE(billiard_table_state_t, utime, UTIME),
	ONE(billiard_table_state_t, calibration, 0.0, 2.0),
	COUNT(billiard_table_state_t, ball_count, balls, 0.0),
	PARTS(billiard_table_state_t, balls, "ball_count", message_ball),
};
const struct message_table message_table_state = TABLE(table_state);

static const struct message_member vision_doubt[] = {
	ONE(billiard_vision_doubt_t, utime, UTIME),
	ONE(billiard_vision_doubt_t, doubt, 0.0, 31.0),
	COUNT(billiard_vision_doubt_t, ball_count, ball_doubt, 0.0),
	MANY(billiard_vision_doubt_t, ball_doubt, "ball_count", 0.0, 31.0),
	MANY(billiard_vision_doubt_t, place, "ball_count", 0.0, 1.0),
	MANY(billiard_vision_doubt_t, certainty, "ball_count", 0.0, 1.0),
};
const struct message_table message_vision_doubt = TABLE(vision_doubt);

static const struct message_member stability_condition[] = {
	ONE(billiard_stability_condition_t, value, ANY),
	ONE(billiard_stability_condition_t, limit, ANY),
	ONE(billiard_stability_condition_t, held, FROM(0.0)),
	ONE(billiard_stability_condition_t, needed, FROM(0.0)),
};
static const struct message_table stability_conditions = TABLE(stability_condition);

static const struct message_member stability[] = {
	ONE(billiard_stability_t, utime, UTIME),
	ONE(billiard_stability_t, verdict, 0.0, 3.0),
	PARTS(billiard_stability_t, conditions, NULL, stability_conditions),
};
const struct message_table message_stability = TABLE(stability);

static const struct message_member game[] = {
	ONE(billiard_game_t, utime, UTIME),
	ONE(billiard_game_t, turn, 0.0, 1.0),
	ONE(billiard_game_t, on, 0.0, 3.0),
	COUNT(billiard_game_t, wish_count, wish_colour, 0.0),
	MANY(billiard_game_t, wish_colour, "wish_count", COLOUR),
	MANY(billiard_game_t, wish_x, "wish_count", PLACE),
	MANY(billiard_game_t, wish_y, "wish_count", PLACE),
};
const struct message_table message_game = TABLE(game);

static const struct message_member image[] = {
	ONE(billiard_image_t, utime, UTIME),
	ONE(billiard_image_t, size, FROM(1.0)), /* image_size_fits() of the bus knows the end */
};
const struct message_table message_image = TABLE(image);

/* ---- planning --------------------------------------------------------------------------------------------------------- */

/* What the search bounds itself (depth, rails, ...) is not bounded twice: plan_request_check(). */
static const struct message_member plan_request[] = {
	ONE(billiard_plan_request_t, id, FROM(1.0)),
	COUNT(billiard_plan_request_t, ball_count, balls, 1.0),
	PARTS(billiard_plan_request_t, balls, "ball_count", message_ball),
	ONE(billiard_plan_request_t, target_kind, 0.0, 3.0),
	ONE(billiard_plan_request_t, target_colour, COLOUR),
	ONE(billiard_plan_request_t, on, 0.0, 3.0),
	ONE(billiard_plan_request_t, budget_nodes, FROM(0.0)),
	ONE(billiard_plan_request_t, budget_s, TIME),
};
const struct message_table message_plan_request = TABLE(plan_request);

static const struct message_member keyframe[] = {
	ONE(billiard_keyframe_t, begin, TIME),
	ONE(billiard_keyframe_t, end, TIME),
	ONE(billiard_keyframe_t, ball, 0.0, BALL_MAX - 1),
	ONE(billiard_keyframe_t, phase, PHASE),
	ONE(billiard_keyframe_t, event, 0.0, EVENT_KIND_COUNT - 1),
	ONE(billiard_keyframe_t, x, PLACE),
	ONE(billiard_keyframe_t, y, PLACE),
	ONE(billiard_keyframe_t, vx, SPEED),
	ONE(billiard_keyframe_t, vy, SPEED),
	ONE(billiard_keyframe_t, ax, SPEED),
	ONE(billiard_keyframe_t, ay, SPEED),
};
static const struct message_table keyframes = TABLE(keyframe);

static const struct message_member plan_shot[] = {
	ONE(billiard_plan_shot_t, angle, -100.0, 100.0), /* rad */
	ONE(billiard_plan_shot_t, speed, SPEED),
	ONE(billiard_plan_shot_t, side, SHARE),
	ONE(billiard_plan_shot_t, follow, SHARE),
	ONE(billiard_plan_shot_t, elevation, -2.0, 2.0), /* rad */
	ONE(billiard_plan_shot_t, target, BALL_INDEX),
	ONE(billiard_plan_shot_t, pocket, POCKET_INDEX),
	COUNT(billiard_plan_shot_t, chain_count, chain, 0.0),
	MANY(billiard_plan_shot_t, chain, "chain_count", 0.0, BALL_MAX - 1),
	COUNT(billiard_plan_shot_t, potted_count, potted_ball, 0.0),
	MANY(billiard_plan_shot_t, potted_ball, "potted_count", 0.0, BALL_MAX - 1),
	MANY(billiard_plan_shot_t, potted_pocket, "potted_count", 0.0, POCKET_MAX - 1),
	ONE(billiard_plan_shot_t, cost, ANY),
	ONE(billiard_plan_shot_t, tolerance_angle, ANY),
	ONE(billiard_plan_shot_t, tolerance_speed, ANY),
	ONE(billiard_plan_shot_t, success, SHARE),
	MANY(billiard_plan_shot_t, start_x, NULL, PLACE),
	MANY(billiard_plan_shot_t, start_y, NULL, PLACE),
	ONE(billiard_plan_shot_t, keyframe_first, 0.0, LENGTH(OF(billiard_plan_t, keyframes))),
	ONE(billiard_plan_shot_t, keyframe_count, 0.0, LENGTH(OF(billiard_plan_t, keyframes))),
};
static const struct message_table plan_shots = TABLE(plan_shot);

static const struct message_member plan_entry[] = {
	ONE(billiard_plan_entry_t, cost, ANY),
	COUNT(billiard_plan_entry_t, shot_count, shots, 1.0),
	PARTS(billiard_plan_entry_t, shots, "shot_count", plan_shots),
};
static const struct message_table plan_entries = TABLE(plan_entry);

static const struct message_member plan[] = {
	ONE(billiard_plan_t, request_id, FROM(0.0)), /* 0: the answer to a request that could not be read */
	ONE(billiard_plan_t, status, 0.0, 3.0),
	COUNT(billiard_plan_t, ball_count, colours, 0.0),
	MANY(billiard_plan_t, colours, "ball_count", COLOUR),
	COUNT(billiard_plan_t, entry_count, entries, 0.0),
	PARTS(billiard_plan_t, entries, "entry_count", plan_entries),
	COUNT(billiard_plan_t, keyframe_count, keyframes, 0.0),
	PARTS(billiard_plan_t, keyframes, "keyframe_count", keyframes),
	ONE(billiard_plan_t, seconds, ANY),
};
const struct message_table message_plan = TABLE(plan);

/* ---- light ------------------------------------------------------------------------------------------------------------ */

static const struct message_member draw_item[] = {
	ONE(billiard_draw_item_t, kind, 0.0, 5.0),
	ONE(billiard_draw_item_t, width, LENGTHS),
	ONE(billiard_draw_item_t, radius, LENGTHS),
	ONE(billiard_draw_item_t, dash, LENGTHS),
	ONE(billiard_draw_item_t, gap, LENGTHS),
	ONE(billiard_draw_item_t, point_first, 0.0, LENGTH(OF(billiard_draw_list_t, xs))),
	ONE(billiard_draw_item_t, point_count, 1.0, LENGTH(OF(billiard_draw_list_t, xs))),
};
static const struct message_table draw_items = TABLE(draw_item);

static const struct message_member draw_list[] = {
	COUNT(billiard_draw_list_t, item_count, items, 0.0),
	PARTS(billiard_draw_list_t, items, "item_count", draw_items),
	COUNT(billiard_draw_list_t, point_count, xs, 0.0),
	MANY(billiard_draw_list_t, xs, "point_count", LIGHT),
	MANY(billiard_draw_list_t, ys, "point_count", LIGHT),
};
const struct message_table message_draw_list = TABLE(draw_list);

static const struct message_member lease[] = {
	ONE(billiard_lease_t, utime, UTIME),
	ONE(billiard_lease_t, seconds, TIME),
};
const struct message_table message_lease = TABLE(lease);

static const struct message_member animation[] = {
	ONE(billiard_animation_t, position, TIME),
	ONE(billiard_animation_t, rate, 0.0, 100.0),
	ONE(billiard_animation_t, pause, TIME),
	ONE(billiard_animation_t, ball_radius, 0.0, 1.0), /* m */
	COUNT(billiard_animation_t, ball_count, colours, 0.0),
	MANY(billiard_animation_t, colours, "ball_count", COLOUR),
	COUNT(billiard_animation_t, keyframe_count, keyframes, 0.0),
	PARTS(billiard_animation_t, keyframes, "keyframe_count", keyframes),
};
const struct message_table message_animation = TABLE(animation);

/* ---- the rest --------------------------------------------------------------------------------------------------------- */

static const struct message_member command[] = {ONE(billiard_command_t, utime, UTIME)};
const struct message_table message_command = TABLE(command);

static const struct message_member metric[] = {ONE(billiard_metric_t, value, ANY)};
static const struct message_table metrics = TABLE(metric);

static const struct message_member status[] = {
	ONE(billiard_status_t, utime, UTIME),
	COUNT(billiard_status_t, metric_count, metrics, 0.0),
	PARTS(billiard_status_t, metrics, "metric_count", metrics),
};
const struct message_table message_status = TABLE(status);
