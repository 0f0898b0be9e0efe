#include "harness.h"

#include <math.h>
#include <string.h>

#include "app/light/draw.h"
#include "app/planner/plan_check.h"
#include "app/process/message_table.h"
#include "app/light/draw_field.h"
#include "app/light/draw_path.h"
#include "physics/event.h"
#include "scenes.h"

static billiard_plan_t plan;
static billiard_draw_list_t list;

/* ---- a plan by hand ---- */

/* As from the bus: first the table of the type, then the border of the message. */
static bool passes(const billiard_draw_list_t *message)
{
	char reason[128];
	return message_check(&message_draw_list, message, reason, sizeof reason) && draw_check(message);
}

static void put_ball(int ball, int colour, vec2 pos)
{
	billiard_plan_shot_t *shot = &plan.entries[0].shots[0];
	plan.colours[ball] = (int8_t)colour;
	shot->start_x[ball] = pos.x;
	shot->start_y[ball] = pos.y;
	shot->start_on[ball] = 1;
	plan.ball_count = ball >= plan.ball_count ? ball + 1 : plan.ball_count;
}

static void put_keyframe(int ball, int event, double begin, double end, vec2 pos, vec2 vel, vec2 acc)
{
	billiard_plan_shot_t *shot = &plan.entries[0].shots[0];
	plan.keyframes[plan.keyframe_count++] = (billiard_keyframe_t){.begin = begin,
								      .end = end,
								      .ball = (int16_t)ball,
								      .event = (int8_t)event,
								      .phase = BALL_ROLLING,
								      .x = pos.x,
								      .y = pos.y,
								      .vx = vel.x,
								      .vy = vel.y,
								      .ax = acc.x,
								      .ay = acc.y};
	shot->keyframe_count++;
}

/* Cue ball along y = 0 to a red at x = 0.3, the red on to x = 0.8, the cue ball off on a curve. */
static struct table begin_plan(void)
{
	struct table table = scene_thesis_table();
	double r = table.ball_radius;
	memset(&plan, 0, sizeof(plan));
	plan.request_id = 7;
	plan.entry_count = 1;
	plan.entries[0].shot_count = 2;
	billiard_plan_shot_t *shot = &plan.entries[0].shots[0];
	*shot = (billiard_plan_shot_t){.speed = 1.234, .target = 1, .pocket = 5};
	put_ball(0, COLOUR_WHITE, (vec2){-0.5, 0});
	put_ball(1, COLOUR_RED, (vec2){0.3, 0});
	put_ball(2, COLOUR_BLUE, (vec2){-0.1, 0.06});
	put_keyframe(0, EVENT_STRIKE, 0, 0.8, (vec2){-0.5, 0}, (vec2){1 - 2.5 * r, 0}, (vec2){0, 0});
	vec2 contact = {-0.5 + 0.8 * (1 - 2.5 * r), 0};
	put_keyframe(0, EVENT_BALL_BALL, 0.8, 1.6, contact, (vec2){0.1, 0.4}, (vec2){0, -0.9});
	put_keyframe(1, EVENT_BALL_BALL, 0.8, 1.8, (vec2){0.3, 0}, (vec2){0.9, 0.3}, (vec2){-0.4, -0.1});
	return table;
}

/* ---- judges ---- */

static double segment_distance(vec2 a, vec2 b, vec2 p)
{
	vec2 d = vec2_sub(b, a);
	double n = vec2_norm2(d), k = n > 0 ? fmax(0, fmin(1, vec2_dot(vec2_sub(p, a), d) / n)) : 0;
	return vec2_dist(p, vec2_madd(a, k, d));
}

static vec2 item_point(const billiard_draw_item_t *item, int i)
{
	return (vec2){list.xs[item->point_first + i], list.ys[item->point_first + i]};
}

/* Distance of the nearest light of an item (rings and lines by their middle) from p. */
static double item_distance(const billiard_draw_item_t *item, vec2 p)
{
	if (item->kind == DRAW_RING)
		return fabs(vec2_dist(item_point(item, 0), p) - item->radius);
	double least = INFINITY;
	for (int i = 1; i < item->point_count; i++)
		least = fmin(least, segment_distance(item_point(item, i - 1), item_point(item, i), p));
	return least;
}

static double list_distance(vec2 p)
{
	double least = INFINITY;
	for (int i = 0; i < list.item_count; i++)
		if (list.items[i].kind != DRAW_TEXT)
			least = fmin(least, item_distance(&list.items[i], p) - list.items[i].width / 2);
	return least;
}

static int count_items(int kind, bool dashed)
{
	int n = 0;
	for (int i = 0; i < list.item_count; i++)
		n += list.items[i].kind == kind && (list.items[i].dash > 0) == dashed;
	return n;
}

static const billiard_draw_item_t *find_text(const char *part)
{
	for (int i = 0; i < list.item_count; i++)
		if (list.items[i].kind == DRAW_TEXT && strstr((const char *)list.items[i].text, part))
			return &list.items[i];
	return NULL;
}

/* ---- items and lists ---- */

START_TEST(items_keep_what_they_are_given)
{
	draw_clear(&list);
	vec2 line[3] = {{0, 1}, {2, 3}, {4, 5}};
	ck_assert(draw_polyline(&list, line, 3, 0.01, 0xff8040c0));
	ck_assert(draw_dashed(&list, line, 2, 0.02, 0xffffffff));
	ck_assert(draw_ring(&list, (vec2){1, 1}, 0.05, 0.005, 0xffffffff));
	ck_assert(draw_ring(&list, (vec2){1, 1}, 0.05, 0.01, 0xffffffff));
	ck_assert(draw_text(&list, (vec2){1, 1}, 0.05, 0xffffffff, "1.2 m/s"));
	ck_assert_int_eq(list.item_count, 5);
	ck_assert_int_eq(list.point_count, 8);
	ck_assert_uint_eq((uint32_t)list.items[0].rgba, 0xff8040c0);
	ck_assert(list.items[1].dash > 0 && list.items[1].gap > 0 && list.items[0].dash == 0);
	ck_assert_double_eq(list.xs[list.items[1].point_first + 1], 2);
	ck_assert_str_eq((const char *)list.items[4].text, "1.2 m/s");
	ck_assert(passes(&list));
}
END_TEST

START_TEST(full_list_takes_nothing)
{
	draw_clear(&list);
	static vec2 many[DRAW_POINT_MAX];
	ck_assert(draw_polyline(&list, many, DRAW_POINT_MAX - 1, 0.01, 1));
	ck_assert(!draw_polyline(&list, many, 2, 0.01, 1));
	ck_assert_int_eq(list.item_count, 1);
	ck_assert(draw_ring(&list, (vec2){0, 0}, 1, 0.01, 1));
	ck_assert(!draw_ring(&list, (vec2){0, 0}, 1, 0.01, 1));
	draw_clear(&list);
	for (int i = 0; i < DRAW_ITEM_MAX; i++)
		ck_assert(draw_ring(&list, (vec2){0, 0}, 1, 0.01, 1));
	ck_assert(!draw_ring(&list, (vec2){0, 0}, 1, 0.01, 1));
	ck_assert(passes(&list));
}
END_TEST

START_TEST(long_text_is_cut)
{
	char text[200];
	memset(text, 'x', sizeof(text));
	text[199] = 0;
	draw_clear(&list);
	ck_assert(draw_text(&list, (vec2){0, 0}, 0.05, 1, text));
	ck_assert_uint_eq(strlen((const char *)list.items[0].text), 63);
	ck_assert(passes(&list));
}
END_TEST

static void good_list(void)
{
	draw_clear(&list);
	draw_polyline(&list, (vec2[]){{0, 1}, {2, 3}}, 2, 0.01, 1);
	draw_text(&list, (vec2){0, 0}, 0.05, 1, "a");
	ck_assert(passes(&list));
}

START_TEST(check_refuses_what_would_hurt)
{
	good_list(), list.item_count = -1, ck_assert(!passes(&list));
	good_list(), list.item_count = DRAW_ITEM_MAX + 1, ck_assert(!passes(&list));
	good_list(), list.point_count = -1, ck_assert(!passes(&list));
	good_list(), list.point_count = DRAW_POINT_MAX + 1, ck_assert(!passes(&list));
	good_list(), list.xs[0] = NAN, ck_assert(!passes(&list));
	good_list(), list.ys[1] = 1e9, ck_assert(!passes(&list));
	good_list(), list.items[0].kind = 6, ck_assert(!passes(&list));
	good_list(), list.items[0].kind = -1, ck_assert(!passes(&list));
	for (int8_t kind = 0; kind < 6; kind++) {
		good_list();
		list.items[0].kind = kind;
		ck_assert_int_eq(passes(&list), kind == DRAW_POLYLINE); /* two points: no ring, no text */
		good_list();
		list.items[1].kind = kind; /* the kinds between are no more */
		ck_assert_int_eq(passes(&list), kind == DRAW_POLYLINE || kind == DRAW_RING || kind == DRAW_TEXT);
	}
	good_list(), list.items[0].point_count = 0, ck_assert(!passes(&list));
	good_list(), list.items[0].point_count = INT32_MAX, ck_assert(!passes(&list));
	good_list(), list.items[0].point_first = INT32_MAX, ck_assert(!passes(&list));
	good_list(), list.items[0].point_first = -1, ck_assert(!passes(&list));
	good_list(), list.items[0].width = -1, ck_assert(!passes(&list));
	good_list(), list.items[0].dash = NAN, ck_assert(!passes(&list));
	good_list(), list.items[1].point_first = 0, list.items[1].point_count = 2, ck_assert(!passes(&list));
	good_list(), memset(list.items[1].text, 'a', 64), ck_assert(!passes(&list));
}
END_TEST

/* ---- proposal ---- */

START_TEST(proposal_shows_its_parts)
{
	struct table table = begin_plan();
	struct draw_options options = draw_options_default();
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &options);
	ck_assert(passes(&list));
	ck_assert_int_eq(list.plan_id, 7);
	ck_assert_int_ge(count_items(DRAW_POLYLINE, false), 2); /* cue ball to contact, red to its end */
	ck_assert_int_ge(count_items(DRAW_POLYLINE, true), 1);	/* cue ball after it */
	ck_assert_ptr_nonnull(find_text("1.2 m/s  0\u00b0  1/2"));
	ck_assert_ptr_nonnull(find_text(table.pocket[5].name));
	bool pocket = false; /* something around it, on the bed */
	for (int i = 0; i < list.item_count; i++) {
		vec2 p = item_point(&list.items[i], 0);
		pocket |= list.items[i].kind == DRAW_POLYLINE &&
			  fabs(vec2_dist(p, table.pocket[5].centre) - 0.08) < 1e-6 && fabs(p.x) < table.length / 2 &&
			  fabs(p.y) < table.width / 2;
	}
	ck_assert(pocket);
}
END_TEST

START_TEST(options_switch_parts_off)
{
	struct table table = begin_plan();
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &(struct draw_options){0});
	ck_assert_int_eq(count_items(DRAW_POLYLINE, true), 0);
	int bare = list.item_count;
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &(struct draw_options){.halo = true});
	ck_assert_int_gt(list.item_count, bare);
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &(struct draw_options){.table = true});
	ck_assert_int_eq(list.item_count, bare + table.cushion_count + table.pocket_count);
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &(struct draw_options){.info = true});
	ck_assert_int_eq(list.item_count, bare + 3);
}
END_TEST

START_TEST(no_light_touches_a_ball)
{
	struct random random = random_begin("no_light_touches_a_ball");
	struct draw_options options = {.halo = true, .other_paths = true, .info = true};
	for (int round = 0; round < 100; round++) {
		struct table table = begin_plan();
		for (int i = 3; i < BALL_MAX; i++)
			put_ball(i, COLOUR_RED, (vec2){random_in(&random, -0.9, 0.9), random_in(&random, -0.44, 0.44)});
		draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &options);
		ck_assert(passes(&list));
		for (int i = 0; i < BALL_MAX; i++) {
			vec2 ball = {plan.entries[0].shots[0].start_x[i], plan.entries[0].shots[0].start_y[i]};
			ck_assert_double_ge(list_distance(ball), 1.9 * table.ball_radius);
		}
	}
}
END_TEST

/* A stroke beside the ball's middle is told, one through it is not. */
START_TEST(the_tip_is_told)
{
	static const struct {
		double side, follow;
		const char *text;
	} tips[] = {{0, 0, "m/s  0\u00b0"},	   {0, 0.4, "0\u00b0  high 40%"},      {0, -0.2, "0\u00b0  low 20%"},
		    {0.3, 0, "0\u00b0  left 30%"}, {-0.3, 0.4, "high 40%  right 30%"}, {0.02, -0.02, "m/s  0\u00b0"}};
	for (size_t i = 0; i < sizeof tips / sizeof *tips; i++) {
		struct table table = begin_plan();
		struct draw_options options = draw_options_default();
		plan.entries[0].shots[0].side = tips[i].side;
		plan.entries[0].shots[0].follow = tips[i].follow;
		draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &options);
		const billiard_draw_item_t *found = find_text("m/s");
		ck_assert_ptr_nonnull(found);
		ck_assert_msg(strstr((const char *)found->text, tips[i].text) != NULL, "\"%s\" does not tell \"%s\"",
			      (const char *)found->text, tips[i].text);
		bool middle = fabs(tips[i].side) < 0.05 && fabs(tips[i].follow) < 0.05;
		ck_assert_int_eq(strchr((const char *)found->text, '%') == NULL, middle);
	}
}
END_TEST

START_TEST(text_lies_free)
{
	struct random random = random_begin("text_lies_free");
	int found = 0;
	for (int round = 0; round < 100; round++) {
		struct table table = begin_plan();
		for (int i = 3; i < BALL_MAX; i++)
			put_ball(i, COLOUR_RED, (vec2){random_in(&random, -0.9, 0.9), random_in(&random, -0.44, 0.44)});
		struct draw_options options = draw_options_default();
		draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &options);
		const billiard_draw_item_t *text = find_text("m/s");
		if (!text)
			continue;
		found++;
		double width = draw_text_width((const char *)text->text, text->radius);
		for (int k = 0; k <= 20; k++) {
			vec2 p = vec2_add(item_point(text, 0), (vec2){k * width / 20, 0.35 * text->radius});
			ck_assert(fabs(p.x) < table.length / 2 && fabs(p.y) < table.width / 2);
			ck_assert_double_gt(list_distance(p), 0.3 * text->radius);
			for (int i = 0; i < BALL_MAX; i++) {
				vec2 ball = {plan.entries[0].shots[0].start_x[i], plan.entries[0].shots[0].start_y[i]};
				ck_assert_double_gt(vec2_dist(p, ball), 2 * table.ball_radius);
			}
		}
	}
	ck_assert_int_ge(found, 95);
}
END_TEST

START_TEST(opening_position_has_text_and_rings)
{
	struct table table = scene_thesis_table();
	struct ball ball[SCENE_RACK_COUNT];
	scene_rack(&table, ball);
	struct draw_options options = draw_options_default();
	draw_idle(&list, &table, &(struct draw_resting){ball, SCENE_RACK_COUNT, "no proposal"}, &options);
	ck_assert(passes(&list));
	ck_assert_ptr_nonnull(find_text("no proposal"));
	ck_assert_int_ge(count_items(DRAW_RING, false), 3);
	for (int i = 0; i < SCENE_RACK_COUNT; i++)
		ck_assert_double_ge(list_distance(ball[i].pos), 1.9 * table.ball_radius);
	draw_idle(&list, &table, &(struct draw_resting){ball, SCENE_RACK_COUNT, ""}, &options);
	ck_assert_ptr_null(find_text(""));
}
END_TEST

/* ---- paths ---- */

START_TEST(path_follows_the_parabola)
{
	struct random random = random_begin("path_follows_the_parabola");
	struct draw_path path;
	for (int round = 0; round < 300; round++) {
		begin_plan();
		plan.keyframe_count = plan.entries[0].shots[0].keyframe_count = 0;
		vec2 vel = vec2_scale(vec2_from_angle(random_in(&random, 0, 7)), random_in(&random, 0, 3));
		vec2 acc = vec2_scale(vec2_from_angle(random_in(&random, 0, 7)), random_in(&random, 0, 2));
		put_keyframe(0, EVENT_STRIKE, 0, 1.5, (vec2){0, 0}, vel, acc);
		draw_path_of(&path, &plan, &plan.entries[0].shots[0], 0);
		for (int k = 0; k <= 200; k++) {
			double t = 1.5 * k / 200, least = INFINITY;
			vec2 p = vec2_madd(vec2_scale(vel, t), t * t / 2, acc);
			for (int i = 1; i < path.count; i++)
				least = fmin(least, segment_distance(path.point[i - 1], path.point[i], p));
			if (path.count > 1)
				ck_assert_double_le(least, 0.002); /* flatness and twice the spacing */
		}
	}
}
END_TEST

START_TEST(path_of_a_ball_that_comes_back)
{
	struct draw_path path;
	begin_plan();
	plan.keyframe_count = plan.entries[0].shots[0].keyframe_count = 0;
	put_keyframe(0, EVENT_STRIKE, 0, 2, (vec2){0, 0}, (vec2){0.2, 0}, (vec2){-0.2, 0}); /* turns at x = 0.1 */
	draw_path_of(&path, &plan, &plan.entries[0].shots[0], 0);
	double far = 0;
	for (int i = 0; i < path.count; i++)
		far = fmax(far, path.point[i].x);
	ck_assert_double_eq_tol(far, 0.1, 1e-12);
}
END_TEST

static bool ring_at(vec2 centre, double radius)
{
	for (int i = 0; i < list.item_count; i++)
		if (list.items[i].kind == DRAW_RING && vec2_dist(item_point(&list.items[i], 0), centre) < 1e-6 &&
		    fabs(list.items[i].radius - radius) < 1e-9)
			return true;
	return false;
}

/* A ring says where a ball comes to rest; one that falls rests nowhere. */
START_TEST(balls_that_fall_have_no_place_of_rest)
{
	struct table table = begin_plan();
	struct draw_options options = draw_options_default();
	const vec2 rest = {1.0, 0.25};
	billiard_plan_shot_t *shot = &plan.entries[0].shots[0];
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &options);
	ck_assert(ring_at(rest, table.ball_radius));
	shot->potted_count = 2;
	shot->potted_ball[0] = 2;
	shot->potted_ball[1] = 1;
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &options);
	ck_assert(!ring_at(rest, table.ball_radius));
	shot->potted_count = 1; /* the other ball only */
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &options);
	ck_assert(ring_at(rest, table.ball_radius));
}
END_TEST

static bool plan_passes(const struct table *table)
{
	char reason[128];
	return message_check(&message_plan, &plan, reason, sizeof reason) && plan_check(&plan, table);
}

/* The drawing takes checked plans: what it could not draw is stopped before. */
START_TEST(plans_that_cannot_be_drawn_are_stopped_at_the_border)
{
	struct table table = begin_plan();
	ck_assert(plan_passes(&table));
#define STOPPED(member, value)                                                                                         \
	(begin_plan(), plan.member = (value), ck_assert_msg(!plan_passes(&table), #member " = " #value))
	STOPPED(keyframes[0].vx, NAN);
	STOPPED(keyframes[1].ball, 99);
	STOPPED(keyframes[2].end, INFINITY);
	STOPPED(keyframes[0].vx, 99); /* far off the table when it ends */
	STOPPED(keyframes[0].ax, -99);
	STOPPED(entries[0].shots[0].target, 77);
	STOPPED(entries[0].shots[0].pocket, 99);
	STOPPED(entries[0].shots[0].start_x[2], NAN);
	STOPPED(entries[0].shots[0].start_x[2], 11);
	STOPPED(entries[0].shots[0].keyframe_first, INT32_MAX);
	STOPPED(entries[0].shots[0].keyframe_first, -5);
	STOPPED(entries[0].shots[0].angle, NAN);
	STOPPED(entries[0].shots[0].speed, NAN);
	STOPPED(ball_count, 1000);
}
END_TEST

/* Numbers of any length in the texts: cut, never beyond their end. */
START_TEST(the_longest_numbers_stay_within_their_text)
{
	static const double angles[] = {100, -100, 1e60, -1e60, 1e300, -1e300};
	struct table table = begin_plan();
	struct draw_options options = draw_options_default();
	plan.entries[0].shot_count = 3;
	for (size_t i = 0; i < sizeof angles / sizeof angles[0]; i++) {
		plan.entries[0].shots[0].angle = angles[i];
		plan.entries[0].shots[0].speed = i % 2 ? 99.9 : 1e300;
		draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &options);
		ck_assert(passes(&list));
	}
}
END_TEST

START_TEST(without_keyframes_there_is_an_aim)
{
	struct table table = begin_plan();
	plan.entries[0].shots[0].keyframe_count = 0;
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &(struct draw_options){0});
	ck_assert_int_ge(count_items(DRAW_POLYLINE, false), 2);
}
END_TEST

START_TEST(a_break_fits)
{
	struct table table = begin_plan();
	plan.keyframe_count = plan.entries[0].shots[0].keyframe_count = 0;
	for (int i = 3; i < BALL_MAX; i++)
		put_ball(i, COLOUR_RED, (vec2){-0.6 + 0.06 * i, 0.3});
	for (int i = 0; i < 768; i++)
		put_keyframe(i % BALL_MAX, EVENT_BALL_BALL, i * 0.01, i * 0.01 + 1, (vec2){0.001 * i, 0.1},
			     (vec2){0.1, 1}, (vec2){2, -1});
	struct draw_options options = draw_options_default();
	draw_proposal(&list, &table, &(struct draw_subject){&plan, 0, 0}, &options);
	ck_assert(passes(&list));
	ck_assert_int_gt(list.item_count, 20);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("draw");
	TCase *lists = tcase_create("lists"), *proposal = tcase_create("proposal"), *paths = tcase_create("paths");
	tcase_add_test(lists, items_keep_what_they_are_given);
	tcase_add_test(lists, full_list_takes_nothing);
	tcase_add_test(lists, long_text_is_cut);
	tcase_add_test(lists, check_refuses_what_would_hurt);
	tcase_add_test(proposal, proposal_shows_its_parts);
	tcase_add_test(proposal, options_switch_parts_off);
	tcase_add_test(proposal, no_light_touches_a_ball);
	tcase_add_test(proposal, the_tip_is_told);
	tcase_add_test(proposal, text_lies_free);
	tcase_add_test(proposal, opening_position_has_text_and_rings);
	tcase_add_test(proposal, balls_that_fall_have_no_place_of_rest);
	tcase_add_test(proposal, plans_that_cannot_be_drawn_are_stopped_at_the_border);
	tcase_add_test(proposal, the_longest_numbers_stay_within_their_text);
	tcase_add_test(proposal, without_keyframes_there_is_an_aim);
	tcase_add_test(proposal, a_break_fits);
	tcase_add_test(paths, path_follows_the_parabola);
	tcase_add_test(paths, path_of_a_ball_that_comes_back);
	suite_add_tcase(suite, lists);
	suite_add_tcase(suite, proposal);
	suite_add_tcase(suite, paths);
	return suite;
}
