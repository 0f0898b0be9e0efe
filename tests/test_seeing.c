/* What is believed of a resting table is what lies there, whatever went before: rendered streams by name, and recorded
 * rests in which an earlier vision was wrong. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/event_log.h"
#include "app/virtual/judge_match.h"
#include "physics/sim.h"
#include "vision_rig.h"

static const double mm = 1e-3, dt = 1 / 30.0;
static int frame;

static void setup(void)
{
	rig_setup();
	frame = 0;
}

static void place(int i, enum ball_colour colour, double x, double y)
{
	rig->ball[i] = ball_at(colour, (vec2){x, y});
	rig->count = i + 1 > rig->count ? i + 1 : rig->count;
}

static void six_balls(void)
{
	place(0, COLOUR_WHITE, -0.6, 0.2);
	place(1, COLOUR_RED, -0.2, -0.2);
	place(2, COLOUR_BLACK, 0.3, 0.15);
	place(3, COLOUR_PINK, 0.6, -0.1);
	place(4, COLOUR_RED, 0.1, -0.35);
	place(5, COLOUR_BROWN, -0.55, 0.3);
}

static void roll(int frames)
{
	for (int i = 0; i < frames; i++, frame++)
		rig_track(frame, frame * dt);
}

/* Empty when all that is seen is there and the other way round, with its colour. */
static const char *wrong(void)
{
	static char text[128];
	text[0] = '\0';
	for (int i = 0; i < rig->count; i++) {
		vec2 p = rig->ball[i].pos;
		const struct vision_ball *b = rig_found_at(p, 2 * mm);
		if (!b)
			snprintf(text, sizeof(text), "%s at %.0f, %.0f is not seen",
				 ball_colour_name(rig->ball[i].colour), p.x / mm, p.y / mm);
		else if (b->colour != rig->ball[i].colour)
			snprintf(text, sizeof(text), "%s at %.0f, %.0f is %s", ball_colour_name(rig->ball[i].colour),
				 p.x / mm, p.y / mm, ball_colour_name(b->colour));
	}
	if (!text[0] && rig->result.ball_count != rig->count)
		snprintf(text, sizeof(text), "%d balls for %d", rig->result.ball_count, rig->count);
	return text;
}

static void check_right(const char *when)
{
	ck_assert_msg(!wrong()[0], "%s, frame %d: %s", when, frame, wrong());
	ck_assert_msg(rig->result.doubt == 0, "%s, frame %d: doubt %d", when, frame, rig->result.doubt);
}

/* What is believed without a doubt is right, at any time. */
static void roll_believed(int frames, const char *when)
{
	for (int i = 0; i < frames; i++) {
		roll(1);
		ck_assert_msg(rig->result.doubt != 0 || !wrong()[0], "%s, frame %d: believed, but %s", when, frame,
			      wrong());
	}
}

START_TEST(test_ball_carried_300_mm)
{
	six_balls();
	roll(12);
	check_right("before");
	vec2 to = {rig->ball[4].pos.x + 0.3, rig->ball[4].pos.y};
	struct ball carried = rig->ball[4], last = rig->ball[5];
	rig->ball[4] = last;
	rig->count = 5;
	roll_believed(10, "in the hand");
	check_right("in the hand");
	rig->ball[5] = ball_at(carried.colour, to);
	rig->count = 6;
	roll_believed(6, "put down");
	check_right("put down");
	/* At once, as if frames were missing. */
	rig->ball[5].pos.x -= 0.3;
	roll(6);
	check_right("back");
}
END_TEST

static void cover(int x0, int y0, int x1, int y1)
{
	static const uint8_t SKIN[3] = {110, 140, 205};
	for (int y = y0; y < y1; y++)
		for (int x = x0; x < x1; x++)
			memcpy(rig->image.image.data + y * rig->image.image.stride + 3 * x, SKIN, 3);
}

/* Two frames a second are enough to wait with. */
START_TEST(test_arm_for_a_minute)
{
	six_balls();
	roll(12);
	check_right("before");
	double time = frame * dt;
	const struct vision_ball *b = rig_found_at(rig->ball[2].pos, 2 * mm);
	vec2 px = b->px;
	int id = b->track;
	for (int i = 0; i < 120; i++, time += 0.5) {
		rig_paint(frame++);
		cover((int)px.x - 45, 90, (int)px.x + 45, (int)px.y + 50);
		rig_look(time);
		ck_assert(rig->result.occluded || i == 0);
		ck_assert_msg(!wrong()[0], "after %.0f s: %s", 0.5 * i, wrong());
		ck_assert(rig->result.doubt != 0 || i == 0);
	}
	frame = (int)(time / dt) + 1;
	roll(18);
	check_right("arm gone");
	ck_assert(!rig->result.occluded);
	ck_assert_int_eq(rig_found_at(rig->ball[2].pos, 2 * mm)->track, id);
}
END_TEST

static void dim(double gain)
{
	for (ptrdiff_t i = 0; i < rig->image.image.height * rig->image.image.stride; i++)
		rig->image.image.data[i] = (uint8_t)fmin(255, gain * rig->image.image.data[i] + 0.5);
}

static void roll_lit(int frames, double gain)
{
	for (int i = 0; i < frames; i++, frame++) {
		rig_paint(frame);
		dim(gain);
		rig_look(frame * dt);
	}
}

START_TEST(test_lights_off_and_on)
{
	six_balls();
	roll(12);
	int id = rig_found_at(rig->ball[0].pos, 2 * mm)->track;
	for (int i = 0; i < 60; i++) {
		roll_lit(1, 0);
		ck_assert(rig->result.ball_count == 0 || rig->result.doubt != 0);
	}
	roll(30);
	check_right("lights on");
	ck_assert_int_eq(rig_found_at(rig->ball[0].pos, 2 * mm)->track, id);
	ck_assert(!rig->result.occluded);
}
END_TEST

/* As it is after a lamp was switched: right within a second, and nothing stays hidden. */
START_TEST(test_other_light)
{
	static const double gain[] = {0.5, 1, 1.6, 1, 0.35, 1.3};
	six_balls();
	roll(12);
	for (int i = 0; i < 6; i++) {
		roll_lit(30, gain[i]);
		ck_assert_msg(!wrong()[0], "light %g: %s", gain[i], wrong());
		ck_assert_msg(!rig->result.occluded, "light %g", gain[i]);
	}
}
END_TEST

START_TEST(test_blinking_ball)
{
	six_balls();
	roll(12);
	for (int i = 0; i < 60; i++) {
		rig->count = i % 3 == 0 ? 5 : 6;
		bool there = rig->count == 6;
		roll(1);
		rig->count = 6;
		ck_assert_msg(!wrong()[0], "frame %d: %s", frame, wrong());
		ck_assert(there || rig->result.doubt != 0);
	}
	roll(8);
	check_right("steady again");
}
END_TEST

/* One of three is the cue ball: nobody is sure which. */
START_TEST(test_two_false_whites)
{
	six_balls();
	roll(12);
	place(6, COLOUR_WHITE, 0.5, 0.3);
	place(7, COLOUR_WHITE, -0.1, 0.1);
	roll(30);
	int whites = 0;
	for (int i = 0; i < rig->result.ball_count; i++)
		whites += rig->result.ball[i].colour == COLOUR_WHITE;
	ck_assert_int_eq(rig->result.ball_count, 8);
	ck_assert_int_eq(whites, 1);
	ck_assert(rig->result.doubt & DOUBT_COLOUR);
	rig->count = 6;
	roll(12);
	check_right("gone");
}
END_TEST

/* The frame says which is which, within three frames. */
START_TEST(test_exchange_of_two_balls)
{
	static const int pair[][2] = {{0, 3}, {1, 2}, {5, 1}, {3, 5}};
	six_balls();
	roll(60);
	for (int k = 0; k < 4; k++) {
		struct ball *a = &rig->ball[pair[k][0]], *b = &rig->ball[pair[k][1]];
		vec2 pos = a->pos;
		a->pos = b->pos;
		b->pos = pos;
		roll(3);
		ck_assert_msg(!wrong()[0], "exchange %d: %s", k, wrong());
		roll(12);
		check_right("afterwards");
	}
}
END_TEST

START_TEST(test_ball_of_another_colour_in_the_same_place)
{
	six_balls();
	roll(60);
	rig->ball[4].colour = COLOUR_BLUE;
	roll(5);
	ck_assert_msg(!wrong()[0], "%s", wrong());
	rig->ball[1].colour = COLOUR_YELLOW;
	roll(5);
	ck_assert_msg(!wrong()[0], "%s", wrong());
}
END_TEST

/* The white falls, is away, and lies in the D; nobody else was ever white. */
START_TEST(test_in_off)
{
	six_balls();
	rig->ball[0].pos = (vec2){0.6, 0.3};
	roll(12);
	check_right("before");
	struct ball white = rig->ball[0];
	for (int i = 0; i < 12; i++) {
		rig->ball[0].pos = vec2_madd(white.pos, i / 12.0, vec2_sub((vec2){0.915, 0.445}, white.pos));
		roll(1);
	}
	rig->ball[0] = rig->ball[5];
	rig->count = 5;
	for (int i = 0; i < 40; i++) {
		roll_believed(1, "without a white");
		for (int k = 0; k < rig->result.ball_count && i > 5; k++)
			ck_assert_int_ne(rig->result.ball[k].colour, COLOUR_WHITE);
	}
	ck_assert_int_eq(rig->result.doubt, DOUBT_NO_CUE);
	place(5, COLOUR_WHITE, -0.7, 0);
	roll(6);
	check_right("in the D");
}
END_TEST

/* Centres that the jaws hold: before the pocket's circle, within the mouth. */
static vec2 jaw(int pocket, double depth, double aside)
{
	const struct pocket *p = &rig->config.table.pocket[pocket];
	bool corner = fabs(p->centre.x) > 0.5;
	vec2 in = corner ? vec2_unit((vec2){p->centre.x > 0 ? -1 : 1, p->centre.y > 0 ? -1 : 1})
			 : (vec2){0, p->centre.y > 0 ? -1 : 1};
	return vec2_madd(vec2_madd(p->centre, p->radius + depth, in), aside, vec2_perp(in));
}

START_TEST(test_balls_in_jaws)
{
	static const enum ball_colour colour[] = {COLOUR_BLUE, COLOUR_RED,   COLOUR_BLACK,
						  COLOUR_PINK, COLOUR_GREEN, COLOUR_YELLOW};
	for (int k = 0; k < 12; k++) {
		int pocket = k % rig->config.table.pocket_count;
		double depth = (k % 4) * 4 * mm;
		vision_reset(rig->vision);
		six_balls();
		rig->count = 6;
		rig->ball[0].pos = (vec2){-0.3, 0.05};
		rig->ball[1] = ball_at(colour[k % 6], jaw(pocket, depth, 0));
		for (int i = 2; i < 6; i++)
			rig->ball[i].colour = COLOUR_RED;
		roll(15);
		ck_assert_msg(!wrong()[0], "%d, %.0f mm before pocket %d: %s", k, depth / mm, pocket, wrong());
		/* It falls: gone, for good. */
		rig->ball[1] = rig->ball[5];
		rig->count = 5;
		roll(12);
		check_right("fallen");
	}
}
END_TEST

/* Gaps of 100 to 300 ms in every twentieth frame, while a ball rolls and rests. */
START_TEST(test_gaps)
{
	struct random r = random_begin("seeing_gaps");
	for (int round = 0; round < 6; round++) {
		vision_reset(rig->vision);
		six_balls();
		double time = 0, angle = random_in(&r, -0.3, 0.3), speed = 1.2;
		for (int i = 0; i < 90; i++) {
			double step = random_in(&r, 0, 1) < 0.05 ? random_in(&r, 0.1, 0.3) : dt;
			for (double t = 0; i > 12 && t < step && speed > 0; t += 0.005) {
				rig->ball[0].pos = vec2_madd(rig->ball[0].pos, 0.005 * speed, vec2_from_angle(angle));
				speed = fmax(0, speed - 0.005 * 0.7);
			}
			time += step;
			rig_track(frame++, time);
		}
		ck_assert_msg(rig->result.doubt == 0 && !wrong()[0], "round %d: %s", round, wrong());
	}
}
END_TEST

/* Too slow for an eye, and yet nobody is left behind. */
START_TEST(test_drift_of_2_mm_a_second)
{
	six_balls();
	roll(60);
	for (int i = 0; i < 150; i++) {
		rig->ball[1].pos.x += 0.002 * dt;
		roll(1);
		ck_assert_msg(rig_found_at(rig->ball[1].pos, 1.2 * mm) != NULL, "after %.1f mm", 2 * i * dt);
	}
}
END_TEST

/* One shot of the cue ball by physics, some frames missing; a second of rest behind it. Returns the frames at rest in
 * which nothing was doubted but perhaps a cue ball that fell. */
static int play_shot(struct random *r, double *time)
{
	static struct sim sim; /* too large for the stack */
	static struct trace_entry entry[4000];
	struct trace trace;
	struct model model;
	struct ball start[BALL_MAX];
	int believed = 0;
	ck_assert(model_from_name("real", &model));
	memcpy(start, rig->ball, sizeof(start));
	sim_init(&sim, &rig->config.table, &model, start, rig->count);
	sim_strike(&sim, 0, &(struct shot){.angle = random_in(r, -M_PI, M_PI), .speed = random_in(r, 0.5, 3)});
	trace_init(&trace, entry, 4000);
	sim_run(&sim, &(struct sim_limits){60, 3999}, &trace);
	double end = trace_end(&trace);
	for (double t = 0, since = *time; t < end + 1; frame++) {
		t += random_in(r, 0, 1) < 0.05 ? random_in(r, 0.1, 0.3) : dt;
		rig->count = 0;
		for (int i = 0; i < sim.ball_count; i++) {
			struct ball ball = trace_at(&trace, i, fmin(t, end));
			if (ball.phase != BALL_POTTED)
				rig->ball[rig->count++] = ball_at(ball.colour, ball.pos);
		}
		rig_track(frame, *time = since + t);
		bool sure = t > end + 0.1 && (rig->result.doubt & ~DOUBT_NO_CUE) == 0;
		ck_assert_msg(!sure || !wrong()[0], "%.2f s after the rest: believed, but %s", t - end, wrong());
		believed += sure;
	}
	ck_assert_msg(!wrong()[0], "a second after the rest: %s", wrong());
	return believed;
}

START_TEST(test_random_shots)
{
	struct random r = random_begin("seeing_shots");
	double time = 0;
	for (int shot = 0; shot < 4; shot++) {
		rig_scatter(&r, 18);
		ck_assert_int_gt(play_shot(&r, &time), 10);
	}
}
END_TEST

/* ---- recorded rests
 * -------------------------------------------------------------------------------------------------- */

struct log {
	const char *name;
	billiard_table_state_t truth;
	int64_t moved; /* us, last time the truth moved */
	int frames, believed;
	bool right; /* in the last frame at rest, without a doubt */
};

static bool is_right(const billiard_table_state_t *truth, const struct vision_result *r)
{
	struct judge_position real, believed = {.count = r->ball_count};
	struct judge_match match;
	judge_position_from(&real, truth->balls, truth->ball_count);
	for (int i = 0; i < r->ball_count && i < BALL_MAX; i++) {
		believed.ball[i].at = r->ball[i].pos;
		believed.ball[i].colour = r->ball[i].colour;
		believed.ball[i].track = r->ball[i].track;
	}
	judge_match(&real, &believed, 5 * mm, &match);
	return match.missing == 0 && match.extra == 0 && match.colour_wrong == 0;
}

static void see_recorded(struct log *log, const billiard_image_t *image)
{
	char err[256];
	ck_assert_msg(image_decode(image->data, (size_t)image->size, &rig->image, err, sizeof(err)) == 0, "%s", err);
	rig_look(1e-6 * (double)image->utime);
	log->frames++;
	/* Truth and frame of the same moment, at rest for a tenth of a second. */
	if (llabs(log->truth.utime - image->utime) > 1000 || image->utime - log->moved < 100000)
		return;
	log->right = rig->result.doubt == 0 && is_right(&log->truth, &rig->result);
	log->believed += rig->result.doubt == 0;
	ck_assert_msg(log->right || rig->result.doubt != 0, "%s: frame %d is believed and wrong", log->name,
		      log->frames);
}

static void take_event(struct log *log, const struct log_event *event)
{
	billiard_image_t image;
	if (strcmp(event->channel, "TRUTH") == 0 && log_event_decode(event, &bus_table_state, &log->truth) &&
	    log->truth.moving)
		log->moved = log->truth.utime;
	if (strcmp(event->channel, "CAMERA") == 0 && log_event_decode(event, &bus_image, &image)) {
		see_recorded(log, &image);
		bus_image.cleanup(&image);
	}
}

START_TEST(test_recorded_rests)
{
	static const char *const names[] = {"catch-1", "catch-2", "resting-ball-lost-45-frames"};
	const char *data = test_data_folder("seeing");
	for (int i = 0; i < 3 && data; i++) {
		struct log log = {.name = names[i]};
		struct log_event event;
		struct event_log *file;
		char path[512], err[640];
		int code;
		snprintf(path, sizeof(path), "%s/loop/%s.lcmlog", data, names[i]);
		vision_reset(rig->vision);
		ck_assert_msg(event_log_open(&file, path, err, sizeof(err)) == 0, "%s", err);
		while ((code = event_log_next(file, &event, err, sizeof(err))) > 0)
			take_event(&log, &event);
		ck_assert_msg(code == 0, "%s", err);
		event_log_close(file);
		ck_assert_msg(log.right, "%s: the last frame is doubted or wrong", names[i]);
		printf("%s: %d frames, %d believed\n", names[i], log.frames, log.believed);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("seeing");
	TCase *tc = tcase_create("streams");
	tcase_add_checked_fixture(tc, setup, rig_teardown);
	tcase_add_test(tc, test_ball_carried_300_mm);
	tcase_add_test(tc, test_arm_for_a_minute);
	tcase_add_test(tc, test_lights_off_and_on);
	tcase_add_test(tc, test_other_light);
	tcase_add_test(tc, test_blinking_ball);
	tcase_add_test(tc, test_two_false_whites);
	tcase_add_test(tc, test_exchange_of_two_balls);
	tcase_add_test(tc, test_ball_of_another_colour_in_the_same_place);
	tcase_add_test(tc, test_in_off);
	tcase_add_test(tc, test_balls_in_jaws);
	tcase_add_test(tc, test_gaps);
	tcase_add_test(tc, test_drift_of_2_mm_a_second);
	tcase_add_test(tc, test_random_shots);
	tcase_add_test(tc, test_recorded_rests);
	tcase_set_timeout(tc, 120);
	suite_add_tcase(suite, tc);
	return suite;
}
