#include "app/process/ball_message.h"
#include "app/planner/plan_check.h"
#include "app/planner/request_message.h"
#include "app/light/animation.h"
#include "app/planner/plan_message.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/bus.h"
#include "app/process/message_table.h"
#include "app/config/config.h"
#include "app/light/draw.h"
#include "harness.h"
#include "scenes.h"

enum { ERR_SIZE = 96 };
static struct config config; /* too large for the stack */
static struct trace_entry scratch[PLAN_TRACE_MAX];
static billiard_plan_request_t request;
static billiard_plan_t plan;
static struct planner *planner;
static struct plan_result result;

/* A full, valid request: nothing at its default. */
static void make_request(void)
{
	request = (billiard_plan_request_t){
		.utime = 1,
		.id = 77,
		.ball_count = 5,
		.target_kind = TARGET_COLOUR,
		.target_colour = COLOUR_RED,
		.target_ball = 2,
		.on = ON_COLOUR,
		.in_hand = 1,
		.depth = 2,
		.rails = 1,
		.max_balls = 2,
		.speeds = 2,
		.plans = 7,
		.budget_nodes = 3000,
		.budget_s = 0.5,
	};
	static const struct {
		enum ball_colour colour;
		vec2 at;
		const char *name;
	} ball[] = {
		{COLOUR_WHITE, {-0.3, 0}, "WHITE0"}, {COLOUR_RED, {0.35, 0.2}, "RED1"},
		{COLOUR_RED, {0.6, -0.3}, "RED2"},   {COLOUR_BLACK, {0.8938, 0}, "BLACK0"},
		{COLOUR_BLUE, {0, 0.1}, "BLUE0"},
	};
	for (int i = 0; i < 5; i++) {
		struct ball b = ball_at(ball[i].colour, ball[i].at);
		ball_to_message(&request.balls[i], &b, ball[i].name, i + 10);
	}
}

/* As from the bus: first the table of the type, then the border of the message. */
static bool plan_passes(const billiard_plan_t *message)
{
	char reason[128];
	return message_check(&message_plan, message, reason, sizeof reason) && plan_check(message, &config.table);
}

static bool animation_passes(const billiard_animation_t *message)
{
	char reason[128];
	return message_check(&message_animation, message, reason, sizeof reason) && animation_check(message);
}

static bool list_passes(const billiard_draw_list_t *message)
{
	char reason[128];
	return message_check(&message_draw_list, message, reason, sizeof reason) && draw_check(message);
}

static bool ball_passes(const billiard_ball_t *message)
{
	char reason[128];
	return message_check(&message_ball, message, reason, sizeof reason);
}

static void load(void)
{
	char err[640];
	ck_assert_msg(config_load(&config, "config/thesis.conf", err, sizeof err) == 0, "%s", err);
	make_request();
}

/* Real plans for the request. */
static void search(void)
{
	char err[ERR_SIZE];
	struct plan_request r;
	struct planner_def def = planner_def_default();
	load();
	def.table = &config.table;
	def.model = config.model;
	def.profile = config.profile;
	request.target_kind = TARGET_ANY;
	request.budget_s = 0;
	ck_assert_int_eq(planner_create(&planner, &def), 0);
	ck_assert_msg(plan_request_from_message(&r, &request, &config.table, err, sizeof err) == 0, "%s", err);
	ck_assert_int_eq(planner_run(planner, &r, NULL, NULL, &result, err, sizeof err), 0);
	ck_assert_int_gt(result.plan_count, 1);
	plan_message_begin(&plan, &request);
	plan_message_fill(&plan, &result, &config.table, &config.model, scratch);
}

static void done(void)
{
	planner_destroy(planner);
	planner = NULL;
}

/* ---- balls, requests --------------------------------------------------------------------------------------------- */

START_TEST(balls_keep_every_field)
{
	struct ball ball = ball_at(COLOUR_PINK, (vec2){0.25, -0.125}), back;
	ball.vel = (vec2){1.5, -2.5};
	ball.phase = BALL_ROLLING;
	billiard_ball_t message;
	ball_to_message(&message, &ball, "PINK0", 42);
	ck_assert_str_eq((const char *)message.name, "PINK0");
	ck_assert_int_eq(message.track, 42);
	ck_assert(ball_passes(&message));
	back = ball_from_message(&message);
	ck_assert(back.colour == ball.colour && back.phase == ball.phase && back.pos.x == ball.pos.x &&
		  back.pos.y == ball.pos.y && back.vel.x == ball.vel.x && back.vel.y == ball.vel.y);
	ball_to_message(&message, &ball, "A NAME THAT IS TOO LONG", 1);
	ck_assert_str_eq((const char *)message.name, "A NAME THAT IS ");
}
END_TEST

START_TEST(bad_balls_are_refused)
{
	struct ball ball = ball_at(COLOUR_PINK, (vec2){0, 0});
	billiard_ball_t good, bad;
	ball_to_message(&good, &ball, "X", 1);
	static const double wrong[] = {NAN, INFINITY, -INFINITY, 101, 1e300};
	for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
		bad = good;
		bad.x = wrong[i];
		ck_assert(!ball_passes(&bad));
		bad = good;
		bad.y = -wrong[i];
		ck_assert(!ball_passes(&bad));
		bad = good;
		bad.vx = wrong[i];
		ck_assert(isfinite(wrong[i]) || !ball_passes(&bad));
	}
	for (int v = -128; v < 128; v++) {
		bad = good;
		bad.colour = (int8_t)v;
		ck_assert_int_eq(ball_passes(&bad), v >= 0 && v < COLOUR_COUNT);
		bad = good;
		bad.phase = (int8_t)v;
		ck_assert_int_eq(ball_passes(&bad), v >= 0 && v <= BALL_POTTED);
	}
}
END_TEST

START_TEST(requests_keep_every_field)
{
	struct plan_request out;
	char err[ERR_SIZE] = "";
	ck_assert_msg(plan_request_from_message(&out, &request, &config.table, err, sizeof err) == 0, "%s", err);
	ck_assert(out.ball_count == 5 && out.target == TARGET_COLOUR && out.target_colour == COLOUR_RED &&
		  out.target_ball == 2);
	ck_assert(out.state.on == ON_COLOUR && out.state.in_hand && out.depth == 2 && out.rails == 1 &&
		  out.balls == 2 && out.speeds == 2);
	ck_assert(out.plans == 7 && out.budget.nodes == 3000 && out.budget.seconds == 0.5);
	for (int i = 0; i < 5; i++) {
		ck_assert_int_eq(out.ball[i].colour, request.balls[i].colour);
		ck_assert(out.ball[i].pos.x == request.balls[i].x && out.ball[i].pos.y == request.balls[i].y);
		ck_assert(out.ball[i].phase == BALL_REST && out.ball[i].vel.x == 0 && out.ball[i].vel.y == 0);
	}
}
END_TEST

static void refused(const billiard_plan_request_t *bad, const char *what)
{
	struct plan_request out, before;
	char err[ERR_SIZE] = "";
	memset(&out, 0x5a, sizeof out);
	memcpy(&before, &out, sizeof out);
	if (message_check(&message_plan_request, bad, err, sizeof err))
		ck_assert_msg(plan_request_from_message(&out, bad, &config.table, err, sizeof err) == -EINVAL,
			      "%s was accepted", what);
	ck_assert_msg(err[0] != '\0', "%s: no reason", what);
	ck_assert_msg(memcmp(&out, &before, sizeof out) == 0, "%s: output touched", what);
}

START_TEST(malformed_requests_are_refused_with_a_reason)
{
	billiard_plan_request_t bad;
	static const int32_t counts[] = {-1, 0, 1, 23, 1000, INT32_MAX, INT32_MIN};
	for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
		bad = request;
		bad.ball_count = counts[i];
		refused(&bad, "ball_count");
	}
#define REFUSED(field, value) (bad = request, bad.field = (value), refused(&bad, #field " = " #value))
	REFUSED(id, 0);
	REFUSED(id, INT64_MIN);
	REFUSED(target_kind, -1);
	REFUSED(target_kind, 4);
	REFUSED(target_colour, 9);
	REFUSED(on, -1);
	REFUSED(on, 4);
	REFUSED(depth, 0);
	REFUSED(depth, 5);
	REFUSED(depth, INT32_MAX);
	REFUSED(rails, -1);
	REFUSED(rails, 4);
	REFUSED(max_balls, 0);
	REFUSED(max_balls, 4);
	REFUSED(speeds, 0);
	REFUSED(speeds, INT32_MAX);
	REFUSED(plans, 0);
	REFUSED(plans, INT32_MAX);
	REFUSED(budget_nodes, -1);
	REFUSED(budget_s, -1);
	REFUSED(budget_s, NAN);
	REFUSED(budget_s, INFINITY);
	REFUSED(balls[1].x, NAN);
	REFUSED(balls[1].x, 2);
	REFUSED(balls[1].colour, COLOUR_WHITE);
	REFUSED(balls[0].colour, COLOUR_RED);
	REFUSED(balls[1].phase, 9);
	bad = request;
	bad.target_kind = TARGET_BALL;
	for (int32_t target = -1; target <= 5; target += 6) {
		bad.target_ball = target;
		refused(&bad, "target_ball");
	}
	bad = request;
	bad.balls[2].x = bad.balls[1].x + 0.03;
	bad.balls[2].y = bad.balls[1].y;
	refused(&bad, "overlapping balls");
}
END_TEST

/* ---- plans ------------------------------------------------------------------------------------------------------- */

START_TEST(answers_name_their_request)
{
	ck_assert_int_eq(plan.request_id, request.id);
	ck_assert_int_eq(plan.ball_count, request.ball_count);
	for (int i = 0; i < plan.ball_count; i++) {
		ck_assert_int_eq(plan.colours[i], request.balls[i].colour);
		ck_assert_int_eq(memcmp(plan.names[i], request.balls[i].name, sizeof plan.names[i]), 0);
	}
	ck_assert(plan_passes(&plan));
}
END_TEST

START_TEST(a_request_with_an_absurd_count_gets_an_answer_in_range)
{
	static const int32_t counts[] = {-5, 23, INT32_MAX, INT32_MIN};
	for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
		request.ball_count = counts[i];
		plan_message_begin(&plan, &request);
		plan.status = PLAN_MESSAGE_REFUSED;
		ck_assert(plan_passes(&plan));
	}
}
END_TEST

static void same_shot(const billiard_plan_shot_t *m, const struct plan_shot *s)
{
	ck_assert(m->angle == s->shot.angle && m->speed == s->shot.speed && m->side == s->shot.side &&
		  m->follow == s->shot.follow);
	ck_assert(m->elevation == s->shot.elevation && m->target == s->target && m->pocket == s->pocket);
	ck_assert(m->chain_count == s->chain_count && m->rails == s->rails && m->potted_count == s->potted_count);
	ck_assert(m->points == s->points && m->foul == s->foul && m->cost == s->cost && (uint64_t)m->hash == s->hash);
	ck_assert(m->tolerance_angle == s->tolerance_angle && m->tolerance_speed == s->tolerance_speed);
	ck_assert(isnan(s->success) ? m->success < 0 : m->success == s->success);
	for (int i = 0; i < 4; i++)
		ck_assert_int_eq(m->chain[i], i < s->chain_count ? s->chain[i] : -1);
	for (int i = 0; i < s->potted_count; i++)
		ck_assert(m->potted_ball[i] == s->potted[i].ball && m->potted_pocket[i] == s->potted[i].pocket);
	for (int i = 0; i < plan.ball_count; i++)
		ck_assert(m->start_x[i] == s->start[i].pos.x && m->start_y[i] == s->start[i].pos.y &&
			  m->start_on[i] == (s->start[i].phase != BALL_POTTED));
}

START_TEST(plans_keep_every_field)
{
	ck_assert_int_eq(plan.status, PLAN_MESSAGE_OK);
	ck_assert_int_eq(plan.found, result.plan_count);
	ck_assert_int_eq(plan.entry_count,
			 result.plan_count < PLAN_MESSAGE_ENTRIES ? result.plan_count : PLAN_MESSAGE_ENTRIES);
	ck_assert(plan.nodes == (int64_t)result.nodes && plan.sims == (int64_t)result.sims);
	for (int i = 0; i < plan.entry_count; i++) {
		ck_assert(plan.entries[i].cost == result.plan[i].cost);
		ck_assert_int_eq(plan.entries[i].shot_count, result.plan[i].shot_count);
		for (int k = 0; k < plan.entries[i].shot_count; k++)
			same_shot(&plan.entries[i].shots[k], &result.plan[i].shot[k]);
	}
}
END_TEST

static const billiard_keyframe_t *keyframe_at(const billiard_plan_shot_t *shot, int ball, double t)
{
	const billiard_keyframe_t *found = NULL;
	for (int i = 0; i < shot->keyframe_count; i++) {
		const billiard_keyframe_t *k = &plan.keyframes[shot->keyframe_first + i];
		if (k->ball == ball && k->begin <= t)
			found = k;
	}
	return found;
}

/* The message alone says where each ball is at any time, as exactly as the simulation itself. */
static void same_motion(const billiard_plan_shot_t *m, const struct plan_shot *s, struct random *random)
{
	struct trace trace;
	trace_init(&trace, scratch, PLAN_TRACE_MAX);
	ck_assert(plan_shot_replay(&config.table, &config.model, s, plan.ball_count, &trace));
	for (int n = 0; n < 300; n++) {
		double t = random_in(random, 0, trace_end(&trace));
		for (int i = 0; i < plan.ball_count; i++) {
			if (s->start[i].phase == BALL_POTTED) {
				ck_assert_ptr_null(keyframe_at(m, i, t));
				continue;
			}
			struct ball at = trace_at(&trace, i, t);
			const billiard_keyframe_t *k = keyframe_at(m, i, t);
			ck_assert_ptr_nonnull(k);
			ck_assert_double_le(k->begin, t);
			ck_assert_double_ge(k->end, t);
			ck_assert_int_eq(k->phase, at.phase);
			double dt = t - k->begin;
			if (at.phase == BALL_POTTED)
				continue;
			ck_assert_double_eq_tol(k->x + k->vx * dt + k->ax * dt * dt / 2, at.pos.x, 1e-9);
			ck_assert_double_eq_tol(k->y + k->vy * dt + k->ay * dt * dt / 2, at.pos.y, 1e-9);
		}
	}
}

START_TEST(keyframes_reproduce_the_simulation)
{
	struct random random = random_begin("plan_message keyframes");
	int shots = 0;
	for (int i = 0; i < plan.entry_count; i++) {
		for (int k = 0; k < plan.entries[i].shot_count; k++) {
			const billiard_plan_shot_t *shot = &plan.entries[i].shots[k];
			if (shot->keyframe_count == 0)
				continue;
			same_motion(shot, &result.plan[i].shot[k], &random);
			shots++;
		}
	}
	ck_assert_int_gt(shots, 2);
}
END_TEST

START_TEST(keyframes_of_a_ball_follow_each_other)
{
	const billiard_plan_shot_t *shot = &plan.entries[0].shots[0];
	ck_assert_int_gt(shot->keyframe_count, 0);
	for (int ball = 0; ball < plan.ball_count; ball++) {
		double end = 0;
		int last = -1;
		for (int i = 0; i < shot->keyframe_count; i++) {
			const billiard_keyframe_t *k = &plan.keyframes[shot->keyframe_first + i];
			if (k->ball != ball)
				continue;
			ck_assert(k->begin == end && k->end >= k->begin);
			ck_assert_int_eq(k->event == EVENT_STRIKE, last < 0);
			end = k->end;
			last = i;
		}
		ck_assert_int_ge(last, 0);
	}
}
END_TEST

/* With 22 balls five plans do not fit: the first ones do, the others come without, and all is in range. */
START_TEST(too_many_keyframes_leave_whole_shots_out)
{
	struct ball rack[SCENE_RACK_COUNT];
	struct plan_request r = plan_request_default();
	char err[ERR_SIZE];
	scene_rack(&config.table, rack);
	memcpy(r.ball, rack, sizeof rack);
	r.ball_count = SCENE_RACK_COUNT;
	r.plans = 5;
	r.speeds = 3;
	request.ball_count = SCENE_RACK_COUNT;
	for (int i = 0; i < SCENE_RACK_COUNT; i++)
		ball_to_message(&request.balls[i], &rack[i], "", i + 1);
	int rc = planner_run(planner, &r, NULL, NULL, &result, err, sizeof err);
	ck_assert_msg(rc == 0, "%s", err);
	plan_message_begin(&plan, &request);
	plan_message_fill(&plan, &result, &config.table, &config.model, scratch);
	ck_assert(result.plan_count == 0 || plan_passes(&plan));
	int used = 0;
	for (int i = 0; i < plan.entry_count; i++)
		for (int k = 0; k < plan.entries[i].shot_count; k++)
			used += plan.entries[i].shots[k].keyframe_count;
	ck_assert_int_eq(used, plan.keyframe_count);
	ck_assert_int_le(used, PLAN_MESSAGE_KEYFRAMES);
	printf("plan_message: %d plans of a full rack, %d keyframes carried\n", plan.entry_count, used);
}
END_TEST

START_TEST(malformed_plans_are_refused)
{
	billiard_plan_t *bad = malloc(sizeof *bad);
	ck_assert_ptr_nonnull(bad);
#define BAD(field, value) (*bad = plan, bad->field = (value), ck_assert_msg(!plan_passes(bad), #field " = " #value))
	BAD(request_id, 0);
	BAD(status, -1);
	BAD(status, 4);
	BAD(ball_count, -1);
	BAD(ball_count, 23);
	BAD(ball_count, INT32_MAX);
	BAD(ball_count, 1); /* targets and keyframes name others */
	BAD(colours[1], 9);
	BAD(colours[1], -1);
	BAD(entry_count, 0); /* "found", but none there */
	BAD(entry_count, -1);
	BAD(entry_count, 6);
	BAD(keyframe_count, -1);
	BAD(keyframe_count, 769);
	BAD(keyframe_count, 1); /* shots refer to more */
	BAD(entries[0].shot_count, 0);
	BAD(entries[0].shot_count, 4);
	BAD(entries[0].shot_count, -1);
	BAD(entries[0].cost, NAN);
	BAD(entries[0].shots[0].angle, NAN);
	BAD(entries[0].shots[0].speed, INFINITY);
	BAD(entries[0].shots[0].side, 1e9);
	BAD(entries[0].shots[0].cost, NAN);
	BAD(entries[0].shots[0].success, NAN);
	BAD(entries[0].shots[0].tolerance_angle, NAN);
	BAD(entries[0].shots[0].target, -2);
	BAD(entries[0].shots[0].target, 5);
	BAD(entries[0].shots[0].pocket, 6);
	BAD(entries[0].shots[0].pocket, -2);
	BAD(entries[0].shots[0].chain_count, 5);
	BAD(entries[0].shots[0].chain_count, -1);
	BAD(entries[0].shots[0].chain[0], 5);
	BAD(entries[0].shots[0].chain[0], -1);
	BAD(entries[0].shots[0].potted_count, 9);
	BAD(entries[0].shots[0].potted_count, -1);
	BAD(entries[0].shots[0].potted_ball[0], 5);
	BAD(entries[0].shots[0].potted_pocket[0], -1);
	BAD(entries[0].shots[0].start_x[2], NAN);
	BAD(entries[0].shots[0].start_y[2], 1e6);
	BAD(entries[0].shots[0].keyframe_first, -1);
	BAD(entries[0].shots[0].keyframe_first, INT32_MAX);
	/* One keyframe too many. */
	BAD(entries[0].shots[0].keyframe_first, plan.keyframe_count - plan.entries[0].shots[0].keyframe_count + 1);

	BAD(entries[0].shots[0].keyframe_count, -1);
	BAD(entries[0].shots[0].keyframe_count, INT32_MAX);
	BAD(keyframes[3].ball, -1);
	BAD(keyframes[3].ball, 5);
	BAD(keyframes[3].phase, 5);
	BAD(keyframes[3].event, 100);
	BAD(keyframes[3].begin, -1);
	BAD(keyframes[3].begin, 1e9);
	BAD(keyframes[3].end, INFINITY);
	BAD(keyframes[3].x, NAN);
	BAD(keyframes[3].y, 1e9);
	BAD(keyframes[3].vx, -INFINITY);
	BAD(keyframes[3].ay, NAN);
	free(bad);
}
END_TEST

/* Billiard tables may have fewer pockets than a message can name. */
START_TEST(pockets_are_those_of_the_table)
{
	static struct table fewer;
	fewer = config.table;
	fewer.pocket_count = 3;
	plan.entry_count = 1;
	plan.entries[0].shot_count = 1;
	billiard_plan_shot_t *shot = &plan.entries[0].shots[0];
	shot->potted_count = 1;
	for (int16_t pocket = 0; pocket < 6; pocket++) {
		shot->pocket = pocket;
		shot->potted_pocket[0] = 0;
		ck_assert(plan_check(&plan, &config.table) && plan_check(&plan, &fewer) == (pocket < 3));
		shot->pocket = 0;
		shot->potted_pocket[0] = pocket;
		ck_assert(plan_check(&plan, &config.table) && plan_check(&plan, &fewer) == (pocket < 3));
	}
}
END_TEST

START_TEST(plans_survive_the_wire)
{
	int size = bus_plan.encoded_size(&plan);
	uint8_t *bytes = malloc((size_t)size), *again = malloc((size_t)size);
	billiard_plan_t *back = calloc(1, sizeof *back);
	ck_assert(bytes && again && back);
	ck_assert_int_eq(bus_plan.encode(bytes, 0, size, &plan), size);
	ck_assert_int_eq(bus_plan.decode(bytes, 0, size, back), size);
	ck_assert_int_eq(bus_plan.encode(again, 0, size, back), size);
	ck_assert_int_eq(memcmp(bytes, again, (size_t)size), 0);
	ck_assert(plan_passes(back));
	same_shot(&back->entries[0].shots[0], &result.plan[0].shot[0]);
	free(bytes);
	free(again);
	free(back);
}
END_TEST

/* Whatever passes the check can be drawn and animated. Bytes of a real plan are spoiled at random. */
START_TEST(spoiled_plans_are_refused_or_harmless)
{
	struct random random = random_begin("plan_message spoiled");
	struct draw_options options = {true, true, true, true};
	int size = bus_plan.encoded_size(&plan), accepted = 0;
	uint8_t *good = malloc((size_t)size), *bytes = malloc((size_t)size);
	billiard_plan_t *back = calloc(1, sizeof *back);
	billiard_draw_list_t *list = malloc(sizeof *list);
	billiard_animation_t *animation = malloc(sizeof *animation);
	ck_assert(good && bytes && back && list && animation);
	bus_plan.encode(good, 0, size, &plan);
	for (int round = 0; round < 4000; round++) {
		memcpy(bytes, good, (size_t)size);
		/* Most spoils go where the counts are and the first shots; the hash in front is left alone. */
		for (int n = 0; n < 1 + round % 3; n++)
			bytes[8 + random_u64(&random) % (round % 2 ? 900 : (unsigned)size - 8)] =
				(uint8_t)random_u64(&random);
		if (bus_plan.decode(bytes, 0, size, back) != size)
			continue;
		if (!plan_passes(back) || back->entry_count == 0)
			continue;
		accepted++;
		draw_proposal(list, &config.table, &(struct draw_subject){back, 0, 0}, &options);
		ck_assert(list_passes(list));
		plan_message_animation(animation, back, 0, 0);
		ck_assert(animation_passes(animation));
	}
	ck_assert_int_gt(accepted, 100);
	free(good);
	free(bytes);
	free(back);
	free(list);
	free(animation);
}
END_TEST

/* ---- animations -------------------------------------------------------------------------------------------------- */

START_TEST(an_animation_is_one_shot_of_the_plan)
{
	static billiard_animation_t a;
	const billiard_plan_shot_t *shot = &plan.entries[0].shots[0];
	plan_message_animation(&a, &plan, 0, 0);
	ck_assert(animation_passes(&a));
	ck_assert(a.plan_id == plan.request_id && a.run && a.rate == 1 && a.ball_count == plan.ball_count);
	ck_assert_int_eq(a.keyframe_count, shot->keyframe_count);
	ck_assert_int_eq(memcmp(a.keyframes, &plan.keyframes[shot->keyframe_first],
				(size_t)a.keyframe_count * sizeof a.keyframes[0]),
			 0);
	ck_assert(animation_same_motion(&a, &a));
}
END_TEST

START_TEST(an_animation_runs_pauses_and_begins_again)
{
	billiard_animation_t a = {.run = 1,
				  .rate = 2,
				  .pause = 1,
				  .ball_count = 1,
				  .keyframe_count = 2,
				  .keyframes = {{.end = 4}, {.end = 3}}};
	ck_assert_double_eq(animation_length(&a), 4);
	static const double at[][2] = {{0, 0}, {1, 2}, {2, 4}, {2.4, 4}, {2.5, 0}, {3, 1}, {5, 0}};
	for (size_t i = 0; i < sizeof at / sizeof at[0]; i++)
		ck_assert_double_eq_tol(animation_position(&a, at[i][0]), at[i][1], 1e-12);
	a.position = 3;
	ck_assert_double_eq_tol(animation_position(&a, 0.25), 3.5, 1e-12);
	a.run = 0;
	ck_assert_double_eq(animation_position(&a, 100), 3);
	a = (billiard_animation_t){.run = 1, .rate = 1};
	ck_assert_double_eq(animation_position(&a, 100), 0);
}
END_TEST

START_TEST(malformed_animations_are_refused)
{
	static billiard_animation_t good, bad;
	plan_message_animation(&good, &plan, 0, 0);
#define BAD_ANIMATION(field, value)                                                                                    \
	(bad = good, bad.field = (value), ck_assert_msg(!animation_passes(&bad), #field " = " #value))
	BAD_ANIMATION(keyframe_count, -1);
	BAD_ANIMATION(keyframe_count, 769);
	BAD_ANIMATION(ball_count, -1);
	BAD_ANIMATION(ball_count, 23);
	BAD_ANIMATION(ball_count, 1);
	BAD_ANIMATION(colours[0], 9);
	BAD_ANIMATION(rate, NAN);
	BAD_ANIMATION(rate, -1);
	BAD_ANIMATION(pause, INFINITY);
	BAD_ANIMATION(position, -1);
	BAD_ANIMATION(position, NAN);
	BAD_ANIMATION(ball_radius, 2);
	BAD_ANIMATION(keyframes[0].ball, 22);
	BAD_ANIMATION(keyframes[0].end, NAN);
	BAD_ANIMATION(keyframes[0].ax, 1e200);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("plan_message");
	TCase *in = tcase_create("requests");
	tcase_add_checked_fixture(in, load, NULL);
	tcase_add_test(in, balls_keep_every_field);
	tcase_add_test(in, bad_balls_are_refused);
	tcase_add_test(in, requests_keep_every_field);
	tcase_add_test(in, malformed_requests_are_refused_with_a_reason);
	tcase_add_test(in, a_request_with_an_absurd_count_gets_an_answer_in_range);
	suite_add_tcase(suite, in);
	TCase *out = tcase_create("plans");
	tcase_set_timeout(out, 60);
	tcase_add_checked_fixture(out, search, done);
	tcase_add_test(out, answers_name_their_request);
	tcase_add_test(out, plans_keep_every_field);
	tcase_add_test(out, keyframes_reproduce_the_simulation);
	tcase_add_test(out, keyframes_of_a_ball_follow_each_other);
	tcase_add_test(out, too_many_keyframes_leave_whole_shots_out);
	tcase_add_test(out, malformed_plans_are_refused);
	tcase_add_test(out, pockets_are_those_of_the_table);
	tcase_add_test(out, plans_survive_the_wire);
	tcase_add_test(out, spoiled_plans_are_refused_or_harmless);
	tcase_add_test(out, an_animation_is_one_shot_of_the_plan);
	tcase_add_test(out, an_animation_runs_pauses_and_begins_again);
	tcase_add_test(out, malformed_animations_are_refused);
	suite_add_tcase(suite, out);
	return suite;
}
