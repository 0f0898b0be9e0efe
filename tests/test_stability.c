#include "app/control/stability.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness.h"
#include "scenes.h"

enum { STILL_FRAMES = 15, FRAME_RATE = 30 };
static const double STILL = 0.0005; /* m */
static struct stability s;
static double rate, clock_now; /* 1/s, s */

static const struct stability_limits limits = {
	.still_distance = 0.0005,
	.cue_distance = 0.03,
	.still_time = 0.5,
	.cue_time = 0.2,
	.lost_time = 0.5,
	.new_time = 0.5,
	.clear_time = 0.1,
	.moving_time = 0.05,
	.blind_time = 0.2,
};

static void setup(void)
{
	stability_init(&s, &limits);
	rate = FRAME_RATE;
	clock_now = 7;
}

/* The next frame, 1 / rate later. */
static enum stability_verdict look(struct layout *layout, bool occluded)
{
	clock_now += 1 / rate;
	return stability_frame(&s, layout, &(struct stability_view){clock_now, occluded, -1, false});
}

/* A few balls far apart, tracked. */
static struct layout few_balls(void)
{
	static const vec2 place[] = {{-0.5, 0}, {0.1, 0.2}, {0.4, -0.3}, {0.7, 0.1}, {-0.2, -0.2}};
	struct layout layout = {.cue = -1};
	for (int i = 0; i < (int)(sizeof place / sizeof place[0]); i++) {
		layout.ball[i] = ball_at(i == 0 ? COLOUR_WHITE : i == 4 ? COLOUR_BLUE : COLOUR_RED, place[i]);
		layout.track[i] = i + 1;
		layout.count++;
	}
	return layout;
}

static enum stability_verdict show(const struct layout *layout, int frames)
{
	enum stability_verdict verdict = STABILITY_UNSURE;
	for (int i = 0; i < frames; i++) {
		struct layout seen = *layout;
		verdict = look(&seen, false);
	}
	return verdict;
}

START_TEST(rest_takes_as_many_frames_as_configured)
{
	struct layout layout = few_balls();
	/* The first frame is where the quiet begins. */
	ck_assert_int_eq(show(&layout, STILL_FRAMES), STABILITY_UNSURE);
	ck_assert_int_eq(show(&layout, 1), STABILITY_STABLE);
	ck_assert_int_eq(show(&layout, 100), STABILITY_STABLE);
}
END_TEST

START_TEST(noise_below_the_limit_rests)
{
	struct random random = random_begin("stability noise");
	struct layout layout = few_balls();
	int stable = 0;
	for (int frame = 0; frame < 2000; frame++) {
		struct layout seen = layout;
		for (int i = 0; i < seen.count; i++) {
			seen.ball[i].pos.x += random_in(&random, -STILL / 3, STILL / 3);
			seen.ball[i].pos.y += random_in(&random, -STILL / 3, STILL / 3);
		}
		enum stability_verdict verdict = look(&seen, false);
		ck_assert_int_ne(verdict, STABILITY_MOVING);
		stable += verdict == STABILITY_STABLE;
	}
	ck_assert_int_eq(stable, 2000 - STILL_FRAMES);
}
END_TEST

/* One false look is no movement, at any frame rate; a ball that stays away is. */
START_TEST(single_jumps_are_no_motion_but_end_the_quiet)
{
	static const double rates[] = {15, 30, 60, 120};
	for (int i = 0; i < 4; i++) {
		setup();
		rate = rates[i];
		struct layout layout = few_balls(), jumped = few_balls();
		int still = (int)(limits.still_time * rate + 0.5);
		jumped.ball[2].pos.x += 0.004;
		ck_assert_int_eq(show(&layout, still + 1), STABILITY_STABLE);
		ck_assert_int_eq(show(&jumped, 1), STABILITY_UNSURE);
		ck_assert_int_eq(show(&layout, 1), STABILITY_UNSURE);
		ck_assert_int_eq(show(&layout, still - 2), STABILITY_UNSURE);
		ck_assert_int_eq(show(&layout, 2), STABILITY_STABLE);
		/* Away for good: moved within 0.12 s, at rest there after the time for it. */
		bool moved = false;
		for (int k = 0; k < (int)(0.12 * rate) + 1; k++)
			moved = moved || show(&jumped, 1) == STABILITY_MOVING;
		ck_assert(moved);
		ck_assert_int_eq(show(&jumped, still + 1), STABILITY_STABLE);
	}
}
END_TEST

/* A ball carried by a slope or a sleeve: 2 mm/s is never rest, and it is told as movement at 15, 30, 60 and 120 frames a second. */
START_TEST(a_drift_of_2_mm_s_is_movement)
{
	static const double rates[] = {15, 30, 60, 120};
	for (int i = 0; i < 4; i++) {
		setup();
		rate = rates[i];
		struct layout layout = few_balls();
		int moved = 0, begin = (int)rate;
		show(&layout, begin);
		for (int k = 1; k < 5 * (int)rate; k++) {
			struct layout seen = layout;
			seen.ball[1].pos.y += 0.002 * k / rate;
			enum stability_verdict verdict = look(&seen, false);
			moved += verdict == STABILITY_MOVING;
			if (k > rate / 2)
				ck_assert_msg(verdict != STABILITY_STABLE, "%g 1/s, frame %d", rate, k);
		}
		ck_assert_msg(moved >= 10, "%g 1/s: %d", rate, moved);
	}
}
END_TEST

/* Slower than that limit over that time it rests between, but each half millimetre is movement. */
START_TEST(a_slow_creep_is_movement_each_half_millimetre)
{
	struct layout layout = few_balls();
	int moved = 0;
	show(&layout, 30);
	for (int k = 1; k < 30 * FRAME_RATE; k++) {
		struct layout seen = layout;
		seen.ball[1].pos.y += 0.0002 * k / FRAME_RATE;
		moved += look(&seen, false) == STABILITY_MOVING;
	}
	ck_assert_msg(moved >= 9 && moved <= 12, "%d", moved);
}
END_TEST

/* The same scene at other frame rates: rest is told at the same time, to a frame and what is waited for. */
START_TEST(rest_takes_the_same_time_at_all_frame_rates)
{
	static const double rates[] = {15, 30, 60, 120};
	for (int i = 0; i < 4; i++) {
		setup();
		rate = rates[i];
		struct layout layout = few_balls();
		double begin = clock_now + 1 / rate;
		while (look(&layout, false) != STABILITY_STABLE)
			ck_assert_double_lt(clock_now, begin + 2);
		ck_assert_double_le(fabs(clock_now - begin - limits.still_time), 1 / rate);
	}
}
END_TEST

/* 300 ms without frames are no evidence of rest. */
START_TEST(a_gap_in_the_frames_is_no_rest)
{
	struct layout layout = few_balls();
	show(&layout, 2);
	clock_now += 3;
	ck_assert_int_eq(show(&layout, 1), STABILITY_UNSURE);
	ck_assert_int_eq(show(&layout, 1), STABILITY_UNSURE);
	ck_assert_int_eq(show(&layout, STILL_FRAMES), STABILITY_STABLE);
}
END_TEST

/* ---- the conditions, each for itself ---------------------------------------------------------------------------------- */

static void fails(enum stability_condition condition)
{
	for (enum stability_condition i = 0; i < STABILITY_ALL; i++)
		ck_assert_msg(s.result[i].holds == (i != condition), "%s", stability_condition_name(i));
	ck_assert_int_eq(stability_obstacle(&s), condition);
	ck_assert(!s.result[STABILITY_ALL].holds);
}

START_TEST(each_condition_fails_for_itself)
{
	struct layout layout = few_balls(), seen;
	show(&layout, 20);
	ck_assert_int_eq(stability_obstacle(&s), STABILITY_CONDITIONS);
	/* Two white balls far from where the cue ball was, and none has its track: nobody can tell. */
	seen = layout;
	seen.ball[1].colour = seen.ball[0].colour;
	seen.ball[0].pos.x += 0.2;
	seen.track[0] = 77;
	s.anchor = seen;
	look(&seen, false);
	fails(STABILITY_CUE);
	ck_assert_int_eq(s.verdict, STABILITY_UNSURE);
	setup();
	show(&layout, 20);
	seen = layout;
	seen.ball[3].pos.x += 0.001;
	look(&seen, false);
	fails(STABILITY_STILL);
	ck_assert_int_eq(s.result[STABILITY_STILL].ball, 3);
	ck_assert_double_eq_tol(s.result[STABILITY_STILL].value, 0.001, 1e-9);
	setup();
	show(&layout, 20);
	seen = layout;
	seen.count--;
	look(&seen, false);
	fails(STABILITY_KEPT);
	look(&layout, false);
	fails(STABILITY_NONE_NEW);
	setup();
	show(&layout, 20);
	seen = layout;
	clock_now += 1 / rate;
	stability_frame(&s, &seen, &(struct stability_view){clock_now, false, 2, false});
	fails(STABILITY_CLEAR);
	ck_assert_int_eq(s.result[STABILITY_CLEAR].ball, 2);
	clock_now += 1 / rate;
	stability_frame(&s, &seen, &(struct stability_view){clock_now, false, -1, true});
	fails(STABILITY_CLEAR);
}
END_TEST

/* Each condition waits for its own time. */
START_TEST(each_condition_has_a_time_of_its_own)
{
	for (enum stability_condition i = 0; i < STABILITY_ALL; i++) {
		setup();
		s.result[i].needed = 2;
		struct layout layout = few_balls();
		ck_assert_int_eq(show(&layout, 2 * FRAME_RATE - 1), STABILITY_UNSURE);
		ck_assert_int_eq(stability_obstacle(&s), i);
		ck_assert_int_eq(show(&layout, 3), STABILITY_STABLE);
	}
}
END_TEST

/* At any speed worth the name a rolling ball never counts as resting, and a fast one counts as moving. */
START_TEST(a_rolling_ball_is_seen)
{
	for (double speed = 0.0012; speed < 5; speed *= 1.3) {
		setup();
		struct layout layout = few_balls();
		show(&layout, STILL_FRAMES + 1);
		bool moved = false;
		/* The quiet from before ends as soon as the ball has gone farther than a resting one may. */
		int blind = (int)ceil(STILL / (speed / FRAME_RATE)) + 1;
		for (int frame = 1; frame < 200; frame++) {
			struct layout seen = layout;
			seen.ball[3].pos.x -= speed * frame / FRAME_RATE;
			enum stability_verdict verdict = look(&seen, false);
			if (frame > blind)
				ck_assert_msg(verdict != STABILITY_STABLE, "%g m/s, frame %d", speed, frame);
			moved = moved || verdict == STABILITY_MOVING;
		}
		if (speed > 2 * STILL * FRAME_RATE)
			ck_assert_msg(moved, "%g m/s", speed);
	}
}
END_TEST

START_TEST(a_real_stop_becomes_rest_in_time)
{
	/* Rolling at 1 m/s, slowed by 0.14 m/s^2: the end of a real shot. */
	struct layout layout = few_balls();
	double v = 1, a = 0.14, stop = v / a;
	int frames = (int)(stop * FRAME_RATE) + 2 * STILL_FRAMES, first = -1;
	for (int frame = 0; frame < frames; frame++) {
		double t = fmin((double)frame / FRAME_RATE, stop);
		struct layout seen = layout;
		seen.ball[0].pos.x = -0.8 + (v * t - a * t * t / 2) * 0.2;
		if (look(&seen, false) == STABILITY_STABLE && first < 0)
			first = frame;
	}
	/* Not while more than the permitted distance is left, not later than the frames asked for. */
	double t = (double)(first - STILL_FRAMES) / FRAME_RATE, left = 0.2 * (v * stop / 2 - (v * t - a * t * t / 2));
	ck_assert_int_ge(first, 0);
	ck_assert_double_le(left, STILL);
	ck_assert_int_le(first, (int)ceil(stop * FRAME_RATE) + STILL_FRAMES + 1);
}
END_TEST

START_TEST(lost_only_after_some_time)
{
	struct layout layout = few_balls(), none = few_balls();
	none.ball[0].colour = COLOUR_RED;
	ck_assert_int_eq(show(&layout, STILL_FRAMES + 1), STABILITY_STABLE);
	ck_assert_int_eq(show(&none, 5), STABILITY_UNSURE);
	ck_assert_int_eq(show(&layout, 1), STABILITY_UNSURE);
	for (int i = 0; i < 6; i++)
		ck_assert_int_eq(look(NULL, false), STABILITY_UNSURE);
	ck_assert_int_eq(look(NULL, false), STABILITY_LOST);
	ck_assert_int_eq(show(&none, 1), STABILITY_LOST);
	ck_assert_int_eq(show(&layout, STILL_FRAMES - 1), STABILITY_UNSURE);
	ck_assert_int_eq(show(&layout, 1), STABILITY_STABLE);
}
END_TEST

START_TEST(an_arm_over_the_bed_is_neither_rest_nor_loss)
{
	struct layout layout = few_balls();
	show(&layout, STILL_FRAMES + 1);
	for (int i = 0; i < 50; i++) {
		struct layout seen = layout;
		if (i % 7 == 3) {
			seen.ball[0] = seen.ball[--seen.count]; /* it covers the cue ball at times */
			seen.track[0] = seen.track[seen.count];
		}
		ck_assert_int_eq(look(&seen, true), STABILITY_UNSURE);
	}
	ck_assert_int_eq(show(&layout, STILL_FRAMES - 1), STABILITY_UNSURE);
	ck_assert_int_eq(show(&layout, 2), STABILITY_STABLE);
}
END_TEST

START_TEST(balls_that_come_and_go_end_the_quiet)
{
	struct layout layout = few_balls(), fewer = few_balls();
	fewer.count--;
	show(&layout, STILL_FRAMES + 1);
	ck_assert_int_eq(show(&fewer, 1), STABILITY_UNSURE);
	ck_assert_int_eq(show(&fewer, STILL_FRAMES), STABILITY_STABLE);
	ck_assert_int_eq(show(&layout, 1), STABILITY_UNSURE);
	ck_assert_int_eq(show(&layout, STILL_FRAMES), STABILITY_STABLE);
}
END_TEST

START_TEST(the_order_of_balls_does_not_matter)
{
	struct random random = random_begin("stability order");
	struct layout layout = few_balls();
	enum stability_verdict verdict = STABILITY_UNSURE;
	for (int frame = 0; frame <= STILL_FRAMES; frame++) {
		for (int i = layout.count - 1; i > 0; i--) {
			int j = (int)(random_u64(&random) % (unsigned)(i + 1)), track = layout.track[i];
			struct ball ball = layout.ball[i];
			layout.ball[i] = layout.ball[j], layout.track[i] = layout.track[j];
			layout.ball[j] = ball, layout.track[j] = track;
		}
		verdict = look(&layout, false);
		ck_assert_int_eq(layout.track[layout.cue], 1);
	}
	ck_assert_int_eq(verdict, STABILITY_STABLE);
}
END_TEST

START_TEST(of_two_white_balls_the_one_that_was_it_stays_it)
{
	struct layout layout = few_balls(), seen;
	show(&layout, 3);
	layout.ball[1].colour = COLOUR_WHITE;
	seen = layout;
	look(&seen, false);
	ck_assert_int_eq(seen.cue, 0);
	/* In the other order, too, and when it moves on a little. */
	seen = layout;
	seen.ball[0] = layout.ball[1], seen.ball[1] = layout.ball[0];
	seen.track[0] = layout.track[1], seen.track[1] = layout.track[0];
	seen.ball[1].pos.x += 0.01;
	look(&seen, false);
	ck_assert_int_eq(seen.cue, 1);
}
END_TEST

START_TEST(an_empty_table_is_lost)
{
	struct layout none = {.cue = -1};
	ck_assert_int_eq(show(&none, 10), STABILITY_LOST);
}
END_TEST

/* An arm over the white does not make the table a lost one, however long it stays; without the arm it is. */
START_TEST(a_white_under_an_arm_is_not_lost)
{
	struct layout layout = few_balls();
	show(&layout, STILL_FRAMES);
	layout.ball[0].colour = COLOUR_RED;
	for (int i = 0; i < 3 * FRAME_RATE; i++) {
		struct layout seen = layout;
		ck_assert_int_ne(look(&seen, true), STABILITY_LOST);
	}
	ck_assert_int_eq(show(&layout, FRAME_RATE), STABILITY_LOST);
}
END_TEST

START_TEST(layouts_differ_by_place_colour_and_number)
{
	struct layout a = few_balls(), b = few_balls();
	ck_assert(!layout_differs(&a, &b, 0.003));
	/* Other identities and another order: the same layout. */
	for (int i = 0; i < b.count; i++) {
		b.ball[i] = a.ball[b.count - 1 - i];
		b.track[i] = 100 + i;
	}
	ck_assert(!layout_differs(&a, &b, 0.003) && !layout_differs(&b, &a, 0.003));
	b.ball[1].pos.x += 0.0029;
	ck_assert(!layout_differs(&a, &b, 0.003));
	b.ball[1].pos.x += 0.0002;
	ck_assert(layout_differs(&a, &b, 0.003));
	b = a;
	b.ball[1].colour = COLOUR_PINK;
	ck_assert(layout_differs(&a, &b, 0.003));
	b = a;
	b.count--;
	ck_assert(layout_differs(&a, &b, 0.003) && layout_differs(&b, &a, 0.003));
}
END_TEST

/* Without identities a ball is the nearest of its colour, and none when that is far. */
START_TEST(untracked_balls_are_found_by_place_and_colour)
{
	struct layout layout = few_balls();
	memset(layout.track, 0, sizeof layout.track);
	for (int i = 0; i < layout.count; i++) {
		struct ball ball = layout.ball[i];
		ball.pos.x += 0.02;
		ck_assert_int_eq(layout_find(&layout, &ball, 0), i);
		ball.pos.x += 0.02;
		ck_assert_int_eq(layout_find(&layout, &ball, 0), -1);
		ball.pos = layout.ball[i].pos;
		ball.colour = COLOUR_PINK;
		ck_assert_int_eq(layout_find(&layout, &ball, 0), -1);
	}
}
END_TEST

/* A ball counts once: two reds that lie near one are not both that one. */
START_TEST(each_ball_has_one_of_its_own)
{
	struct layout a = few_balls(), b = a;
	a.ball[2].pos = vec2_add(a.ball[1].pos, (vec2){0.06, 0});
	ck_assert(layout_differs(&a, &b, 0.1));
	ck_assert(layout_differs(&b, &a, 0.1));
}
END_TEST

/* ---- settling ---------------------------------------------------------------------------------------------------- */

static bool jaws = true; /* of the model */
static bool settle(struct layout *layout, const struct table *table, double shift)
{
	int culprit;
	return layout_settle(layout, table, &(struct layout_limits){shift, 0.005, jaws}, &culprit);
}

/* Distance of a point from a segment, m. */
static double distance_to(vec2 p, const struct cushion *c)
{
	double along = fmin(fmax(vec2_dot(vec2_sub(p, c->a), c->along), 0), c->span);
	return vec2_dist(p, vec2_madd(c->a, along, c->along));
}

/* Nothing overlaps: no ball, no nose, no jaw, no pocket; and physics would take it. */
static void check_settled(const struct layout *layout, const struct table *table, const char *what)
{
	double r = table->ball_radius;
	int first, second;
	char err[96];
	for (int i = 0; i < layout->count; i++) {
		vec2 p = layout->ball[i].pos;
		for (int k = 0; k < table->cushion_count; k++)
			ck_assert_msg(distance_to(p, &table->cushion[k]) >= r - 1e-8 ||
					      (!jaws && !table->cushion[k].main_rail),
				      "%s: ball %d, cushion %d", what, i, k);
		for (int k = 0; k < table->jaw_count; k++)
			ck_assert_msg(vec2_dist(p, table->jaw[k].centre) >= r + table->jaw[k].radius - 1e-8 ||
					      (!jaws && table->jaw[k].radius == 0),
				      "%s: ball %d, jaw %d", what, i, k);
		for (int j = 0; j < i; j++) {
			double overlap = 2 * r - vec2_dist(p, layout->ball[j].pos);
			ck_assert_msg(overlap <= 1e-9, "%s: balls %d and %d overlap by %g m", what, i, j, overlap);
		}
	}
	ck_assert_msg(table_check_balls(table, layout->ball, layout->count, &first, &second, err, sizeof err) == 0,
		      "%s: %s", what, err);
}

static void add_noise(struct layout *layout, struct random *random, double size)
{
	for (int i = 0; i < layout->count; i++)
		layout->ball[i].pos = vec2_madd(layout->ball[i].pos, random_in(random, 0, size),
						vec2_from_angle(random_in(random, 0, 6.2832)));
}

START_TEST(what_does_not_overlap_stays)
{
	struct table table = scene_thesis_table();
	struct layout layout = few_balls(), before = few_balls();
	ck_assert(settle(&layout, &table, 0.006));
	for (int i = 0; i < layout.count; i++)
		ck_assert(layout.ball[i].pos.x == before.ball[i].pos.x && layout.ball[i].pos.y == before.ball[i].pos.y);
}
END_TEST

/* The hard case: fifteen touching reds as a camera sees them. */
START_TEST(a_rack_seen_by_a_camera_settles)
{
	struct table tables[] = {scene_thesis_table(), scene_snooker_table()};
	struct random random = random_begin("stability rack");
	for (int round = 0; round < 400; round++) {
		const struct table *table = &tables[round % 2];
		struct layout layout = {.count = SCENE_RACK_COUNT, .cue = 0}, before;
		scene_rack(table, layout.ball);
		add_noise(&layout, &random, round < 200 ? 0.0007 : 0.0015);
		before = layout;
		bool settled = settle(&layout, table, 0.006);
		ck_assert(settled);
		check_settled(&layout, table, "rack");
		double shift = 0;
		for (int i = 0; i < layout.count; i++)
			shift = fmax(shift, vec2_dist(layout.ball[i].pos, before.ball[i].pos));
		ck_assert_double_le(shift, 0.006);
	}
}
END_TEST

START_TEST(balls_in_corners_and_along_cushions_settle)
{
	struct table table = scene_box_table(1.881, 0.943);
	struct random random = random_begin("stability cushions");
	double x = table.length / 2 - table.ball_radius, y = table.width / 2 - table.ball_radius,
	       d = 2 * table.ball_radius;
	for (int round = 0; round < 500; round++) {
		struct layout layout = {.count = 6,
					.cue = 0,
					.ball = {
						ball_at(COLOUR_WHITE, (vec2){x, y}),
						ball_at(COLOUR_RED, (vec2){x - d, y}),
						ball_at(COLOUR_RED, (vec2){x, y - d}),
						ball_at(COLOUR_RED, (vec2){-x, 0}),
						ball_at(COLOUR_RED, (vec2){-x, d}),
						ball_at(COLOUR_RED, (vec2){-x + 0.87 * d, d / 2}),
					}};
		add_noise(&layout, &random, 0.002);
		ck_assert(settle(&layout, &table, 0.012));
		check_settled(&layout, &table, "corner");
	}
}
END_TEST

/* The easiest pots of all: balls that hang before a pocket stay where they hang. */
START_TEST(a_ball_in_the_jaws_stays)
{
	struct table tables[] = {scene_thesis_table(), scene_snooker_table()};
	/* As seen by the camera: the blue of a rest at which the rectangle of the noses put it 15.6 mm off. It lies in a sharp tip, where
	 * the thesis' model lets it roll. */
	jaws = false;
	struct layout layout = {
		.count = 2,
		.cue = 0,
		.ball = {ball_at(COLOUR_WHITE, (vec2){-0.6, -0.3}), ball_at(COLOUR_BLUE, (vec2){-0.9299, -0.3964})}};
	ck_assert(settle(&layout, &tables[0], 0.006));
	ck_assert_double_lt(vec2_dist(layout.ball[1].pos, (vec2){-0.9299, -0.3964}), 0.0005);
	ck_assert(table_check_balls(&tables[0], layout.ball, layout.count, &(int){0}, &(int){0}, NULL, 0) == 0);
	jaws = true;
	ck_assert(!settle(&layout, &tables[0], 0.006));
	struct random random = random_begin("stability jaws");
	for (int round = 0; round < 600; round++) {
		const struct table *table = &tables[round % 2];
		const struct pocket *pocket = &table->pocket[round / 2 % table->pocket_count];
		/* On the edge, in the middle of the mouth, as far as a ball comes without touching. */
		vec2 at = vec2_madd(pocket->centre, pocket->radius + random_in(&random, 0.0005, 0.02), pocket->normal);
		layout = (struct layout){.count = 1, .cue = 0, .ball = {ball_at(COLOUR_WHITE, at)}};
		struct layout free = layout;
		if (!settle(&free, table, 0.03) || vec2_dist(free.ball[0].pos, at) > 1e-6)
			continue; /* it touched a jaw: it would not lie there */
		add_noise(&layout, &random, 0.0005);
		ck_assert(settle(&layout, table, 0.006));
		check_settled(&layout, table, pocket->name);
		ck_assert_double_lt(vec2_dist(layout.ball[0].pos, at), 0.0011);
	}
}
END_TEST

/* One ball in two tracks, 13 mm apart, was pushed into two balls 52 mm apart. */
START_TEST(one_ball_seen_twice_is_no_position)
{
	struct table table = scene_thesis_table();
	struct layout layout = few_balls();
	int culprit;
	layout.ball[3].pos = vec2_add(layout.ball[1].pos, (vec2){0.013, 0});
	ck_assert(!layout_settle(&layout, &table, &(struct layout_limits){0.02, 0.005, true}, &culprit));
	ck_assert_int_eq(culprit, 1);
}
END_TEST

START_TEST(what_cannot_be_settled_is_said)
{
	struct table table = scene_thesis_table();
	struct layout layout = few_balls();
	layout.ball[1].pos = layout.ball[2].pos;
	ck_assert(!settle(&layout, &table, 0.006));
	layout = few_balls();
	layout.ball[1].pos.y = 0.6;
	ck_assert(!settle(&layout, &table, 0.006));
	/* More balls than a box has room for. */
	struct layout full = {.count = 22, .cue = 0};
	for (int i = 0; i < 22; i++)
		full.ball[i] = ball_at(COLOUR_RED, (vec2){0.001 * i, 0});
	struct table box = scene_box_table(0.6, 0.4);
	ck_assert(!settle(&full, &box, 10));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("stability");
	TCase *frames = tcase_create("frames");
	tcase_add_checked_fixture(frames, setup, NULL);
	tcase_add_test(frames, rest_takes_as_many_frames_as_configured);
	tcase_add_test(frames, noise_below_the_limit_rests);
	tcase_add_test(frames, single_jumps_are_no_motion_but_end_the_quiet);
	tcase_add_test(frames, a_drift_of_2_mm_s_is_movement);
	tcase_add_test(frames, a_slow_creep_is_movement_each_half_millimetre);
	tcase_add_test(frames, rest_takes_the_same_time_at_all_frame_rates);
	tcase_add_test(frames, a_gap_in_the_frames_is_no_rest);
	tcase_add_test(frames, each_condition_fails_for_itself);
	tcase_add_test(frames, each_condition_has_a_time_of_its_own);
	tcase_add_test(frames, a_rolling_ball_is_seen);
	tcase_add_test(frames, a_real_stop_becomes_rest_in_time);
	tcase_add_test(frames, lost_only_after_some_time);
	tcase_add_test(frames, an_arm_over_the_bed_is_neither_rest_nor_loss);
	tcase_add_test(frames, balls_that_come_and_go_end_the_quiet);
	tcase_add_test(frames, the_order_of_balls_does_not_matter);
	tcase_add_test(frames, of_two_white_balls_the_one_that_was_it_stays_it);
	tcase_add_test(frames, an_empty_table_is_lost);
	tcase_add_test(frames, a_white_under_an_arm_is_not_lost);
	suite_add_tcase(suite, frames);
	TCase *layouts = tcase_create("layouts");
	tcase_add_test(layouts, layouts_differ_by_place_colour_and_number);
	tcase_add_test(layouts, untracked_balls_are_found_by_place_and_colour);
	tcase_add_test(layouts, each_ball_has_one_of_its_own);
	tcase_add_test(layouts, what_does_not_overlap_stays);
	tcase_add_test(layouts, a_rack_seen_by_a_camera_settles);
	tcase_add_test(layouts, balls_in_corners_and_along_cushions_settle);
	tcase_add_test(layouts, a_ball_in_the_jaws_stays);
	tcase_add_test(layouts, one_ball_seen_twice_is_no_position);
	tcase_add_test(layouts, what_cannot_be_settled_is_said);
	suite_add_tcase(suite, layouts);
	return suite;
}
