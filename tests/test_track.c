/* Balls over time: the tracker alone on made-up finds, then the whole of vision on rendered streams. */
#include "vision/track.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vision_rig.h"

static const double mm = 1e-3, dt = 1 / 30.0;

/* ---- the tracker alone
 * ----------------------------------------------------------------------------------------------- */

static struct table table;
static struct detector detector; /* no scan: nothing is ever covered */
static struct tracker tracker;

static void alone_setup(void)
{
	table = scene_table();
	memset(&detector, 0, sizeof(detector));
	detector.table = &table;
	detector.scan.factor = 1;
	tracker_init(&tracker, &detector);
}

/* look: the features are that far from another ball's. */
static void find(vec2 pos, double look)
{
	struct sighting *c = &detector.candidate[detector.count++];
	*c = (struct sighting){.tag = -1, .cover = 1, .confidence = 1};
	c->fit.pos = pos;
	c->fit.support = 1;
	c->fit.outline.radius_px = 15.5;
	for (int i = 0; i < COLOUR_FEATURES; i++)
		c->look.v[i] = look;
}

static void step(double time)
{
	tracker_look(&tracker, time, false);
	detector.count = 0;
}

static const struct track *track_at(vec2 pos)
{
	for (int i = 0; i < TRACK_MAX; i++)
		if (tracker.track[i].id != 0 && vec2_dist(tracker.track[i].steady.pos, pos) < 5 * mm)
			return &tracker.track[i];
	return NULL;
}

static int id_at(vec2 pos)
{
	const struct track *k = track_at(pos);
	return k && k->confirmed ? k->id : 0;
}

/* Two of one colour pass each other, as near as balls can, in whatever order they are found. */
START_TEST(test_crossing_keeps_identities)
{
	struct random r = random_begin("track_crossing");
	for (int round = 0; round < 300; round++) {
		alone_setup();
		vec2 along = vec2_from_angle(random_in(&r, -M_PI, M_PI)), meet = {0, 0};
		double va = random_in(&r, 0.3, 2), vb = random_in(&r, 0.3, 2), apart = random_in(&r, 0.053, 0.08);
		double between = random_in(&r, 0, 1); /* frames before they meet */
		int id[2] = {0};
		for (int i = -8; i <= 8; i++) {
			vec2 a = vec2_madd(meet, va * (i + between) * dt, along);
			vec2 b = vec2_madd(vec2_madd(meet, -vb * (i + between) * dt, along), apart, vec2_perp(along));
			vec2 place[2] = {a, b};
			int first = (int)(random_u64(&r) & 1);
			for (int k = 0; k < 2; k++)
				find(place[first ^ k], 0);
			step((i + 8) * dt);
			for (int k = 0; k < 2; k++) {
				ck_assert_msg(id_at(place[k]) > 0, "round %d, frame %d: lost", round, i);
				if (i == -8)
					id[k] = id_at(place[k]);
				ck_assert_msg(id_at(place[k]) == id[k], "round %d, frame %d: changed", round, i);
			}
		}
		ck_assert_int_ne(id[0], id[1]);
	}
}
END_TEST

/* Another colour in the same place is another ball. */
START_TEST(test_look_tells_balls_apart)
{
	for (int i = 0; i < 6; i++) {
		find((vec2){0, 0}, 0);
		step(i * dt);
	}
	int id = id_at((vec2){0, 0});
	for (int i = 6; i < 14; i++) {
		find((vec2){0.03, 0}, 3);
		step(i * dt);
	}
	ck_assert_int_ne(id_at((vec2){0.03, 0}), id);
	ck_assert_int_gt(id_at((vec2){0.03, 0}), 0);
	ck_assert_ptr_null(track_at((vec2){0, 0}));
}
END_TEST

START_TEST(test_lost_ball_is_kept_four_frames)
{
	vec2 p = {0.3, 0.1};
	int frame = 0;
	for (; frame < 5; frame++) {
		find(p, 0);
		step(frame * dt);
	}
	int id = id_at(p);
	for (int gone = 1; gone <= 4; gone++, frame++) {
		step(frame * dt);
		ck_assert_int_eq(id_at(p), id);
		ck_assert_int_eq(track_at(p)->misses, gone);
	}
	find(p, 0);
	step(frame++ * dt);
	ck_assert_int_eq(id_at(p), id);
	ck_assert_int_eq(track_at(p)->misses, 0);
	for (int gone = 1; gone <= 5; gone++)
		step(frame++ * dt);
	ck_assert_ptr_null(track_at(p));
	/* Whoever comes later is somebody else. */
	for (int i = 0; i < 4; i++) {
		find(p, 0);
		step(frame++ * dt);
	}
	ck_assert_int_gt(id_at(p), id);
}
END_TEST

/* What jumps about, as finds on an arm do, is never reported. */
START_TEST(test_jumping_finds_are_no_ball)
{
	struct random r = random_begin("track_jumping");
	find((vec2){-0.5, 0}, 0);
	step(0);
	for (int i = 1; i < 200; i++) {
		find((vec2){-0.5, 0}, 0);
		find((vec2){0.3 + 0.02 * (i % 2) + random_in(&r, 0, 0.005), random_in(&r, -0.3, 0.3)}, 0);
		step(i * dt);
		for (int k = 0; k < TRACK_MAX; k++)
			ck_assert(!tracker.track[k].confirmed || tracker.track[k].id == 1);
	}
	/* What stays is, from its third frame on. */
	for (int i = 200; i < 203; i++) {
		find((vec2){-0.5, 0}, 0);
		find((vec2){0.8, -0.4}, 0);
		step(i * dt);
		ck_assert_int_eq(id_at((vec2){0.8, -0.4}) > 0, i >= 202);
	}
}
END_TEST

/* However large balls are in the picture: what trembles by the usual part of a pixel rests, what goes on by more than
 * three times that does not. */
START_TEST(test_rest_is_measured_in_pixels)
{
	struct random r = random_begin("track_rest");
	static const double radius_px[] = {7.75, 15.5, 31};
	for (int i = 0; i < 3; i++) {
		double metres_per_px = table.ball_radius / radius_px[i];
		alone_setup();
		for (int k = 0; k < 300; k++) {
			double off = 0.08 * metres_per_px;
			find((vec2){0.1 + off * scene_gauss(&r), 0.1 + off * scene_gauss(&r)}, 0);
			detector.candidate[0].fit.outline.radius_px = radius_px[i];
			step(k * dt);
			ck_assert_msg(!track_at((vec2){0.1, 0.1})->steady.moving, "radius %g px, frame %d",
				      radius_px[i], k);
		}
		for (int k = 0; k < 3; k++) {
			find((vec2){0.1 + 0.5 * metres_per_px, 0.1}, 0);
			detector.candidate[0].fit.outline.radius_px = radius_px[i];
			step((300 + k) * dt);
		}
		ck_assert_double_gt(track_at((vec2){0.1, 0.1})->steady.pos.x, 0.1 + 0.4 * metres_per_px);
	}
}
END_TEST

START_TEST(test_more_than_there_is_room_for)
{
	for (int i = 0; i < 4; i++) {
		for (int k = 0; k < DETECT_MAX; k++)
			find((vec2){-0.9 + 0.12 * (k % 16), -0.3 + 0.2 * (k / 16)}, 0);
		step(i * dt);
	}
	int used = 0;
	for (int i = 0; i < TRACK_MAX; i++) {
		used += tracker.track[i].id != 0;
		for (int k = 0; k < i; k++)
			ck_assert_int_ne(tracker.track[i].id, tracker.track[k].id);
	}
	ck_assert_int_eq(used, TRACK_MAX);
	tracker_forget(&tracker);
	for (int i = 0; i < TRACK_MAX; i++)
		ck_assert_int_eq(tracker.track[i].id, 0);
}
END_TEST

/* ---- streams
 * --------------------------------------------------------------------------------------------------------- */

static int frame;

static void stream_setup(void)
{
	rig_setup();
	frame = 0;
}

static void place(int i, enum ball_colour colour, double x, double y)
{
	rig->ball[i] = ball_at(colour, (vec2){x, y});
	rig->count = i + 1;
}

static void four_balls(void)
{
	place(0, COLOUR_WHITE, -0.6, 0.2);
	place(1, COLOUR_RED, -0.2, -0.2);
	place(2, COLOUR_BLACK, 0.3, 0.15);
	place(3, COLOUR_RED, 0.6, -0.1);
}

static void roll(int frames)
{
	for (int i = 0; i < frames; i++, frame++)
		rig_track(frame, frame * dt);
}

/* Identity of each ball, all of which must be found where they are. */
static void identities(int id[4])
{
	ck_assert_int_eq(rig->result.ball_count, rig->count);
	for (int i = 0; i < rig->count; i++) {
		const struct vision_ball *b = rig_found_at(rig->ball[i].pos, 2 * mm);
		ck_assert_msg(b != NULL, "frame %d: ball %d is lost", frame, i);
		id[i] = b->track;
	}
}

static void check_identities(const int id[4])
{
	int now[4];
	identities(now);
	for (int i = 0; i < rig->count; i++)
		ck_assert_msg(now[i] == id[i], "frame %d: ball %d was %d, is %d", frame, i, id[i], now[i]);
}

/* Two reds and two colours roll through one another's ways. */
START_TEST(test_rendered_crossing)
{
	int id[4];
	place(0, COLOUR_RED, -0.3, 0.1);
	place(1, COLOUR_RED, 0.3, 0.16);
	place(2, COLOUR_BLUE, -0.28, -0.15);
	place(3, COLOUR_PINK, 0.0, -0.4);
	roll(6);
	identities(id);
	for (int i = 0; i < 18; i++) {
		rig->ball[0].pos.x += 1.0 * dt;
		rig->ball[1].pos.x -= 0.8 * dt;
		rig->ball[2].pos.x += 0.9 * dt;
		rig->ball[3].pos.y += 1.1 * dt;
		roll(1);
		check_identities(id);
	}
}
END_TEST

static void cover(int x0, int y0, int x1, int y1, const uint8_t bgr[3])
{
	for (int y = y0; y < y1; y++)
		for (int x = x0; x < x1; x++)
			memcpy(rig->image.image.data + y * rig->image.image.stride + 3 * x, bgr, 3);
}

static void blacken_marker(const struct camera *camera, int i)
{
	static const uint8_t BLACK[3] = {0, 0, 0};
	const struct marker_layout *layout = &rig->config.markers;
	vec2 px;
	ck_assert(camera_project(camera, layout->marker[i].centre, layout->height, &px));
	int x = (int)px.x, y = (int)px.y, w = rig->image.image.width, h = rig->image.image.height;
	cover(x > 35 ? x - 35 : 0, y > 35 ? y - 35 : 0, x + 35 < w ? x + 35 : w, y + 35 < h ? y + 35 : h, BLACK);
}

/* An arm from the table's edge lies over one ball for two seconds. */
START_TEST(test_hand_covers_a_ball)
{
	static const uint8_t SKIN[3] = {110, 140, 205};
	int id[4];
	four_balls();
	roll(8);
	identities(id);
	ck_assert(!rig->result.occluded);
	vec2 px = rig_found_at(rig->ball[2].pos, 2 * mm)->px;
	for (int i = 0; i < 60; i++, frame++) {
		rig_paint(frame);
		cover((int)px.x - 45, 90, (int)px.x + 45, (int)px.y + 50, SKIN);
		rig_look(frame * dt);
		if (i > 0)
			ck_assert_msg(rig->result.occluded, "frame %d: the arm is not noticed", frame);
		check_identities(id);
	}
	roll(8);
	check_identities(id);
	ck_assert(!rig->result.occluded);
}
END_TEST

START_TEST(test_rendered_ball_is_lost)
{
	int id[4], now[4];
	four_balls();
	roll(8);
	identities(id);
	rig->count = 3;
	/* For a few frames it may only have been missed: less sure then. */
	roll(2);
	ck_assert_int_eq(rig->result.ball_count, 4);
	ck_assert_double_lt(rig_found_at(rig->ball[3].pos, 2 * mm)->confidence, 0.6);
	roll(5);
	check_identities(id);
	/* Put back elsewhere after that it is a new one. */
	place(3, COLOUR_RED, 0.1, -0.35);
	roll(8);
	identities(now);
	for (int i = 0; i < 3; i++)
		ck_assert_int_eq(now[i], id[i]);
	ck_assert_int_gt(now[3], id[3]);
}
END_TEST

/* The camera is pushed by 12 mm and turned a little: within a second all is where it was. */
START_TEST(test_camera_is_bumped)
{
	int id[4];
	char err[256];
	four_balls();
	roll(40);
	identities(id);
	table_camera_destroy(rig->camera);
	rig->config.virtual_table.camera_x += 12 * mm;
	rig->config.virtual_table.camera_y -= 8 * mm;
	rig->config.virtual_table.camera_tilt_x += 0.004;
	ck_assert_msg(table_camera_create(&rig->camera, &rig->config, err, sizeof(err)) == 0, "%s", err);
	bool noticed = false;
	for (int i = 0; i < 32 && !noticed; i++) {
		roll(1);
		noticed = rig_found_at(rig->ball[0].pos, 1.2 * mm) != NULL;
	}
	ck_assert(noticed);
	ck_assert_int_eq(rig->result.calibration, CALIBRATION_FRESH);
	ck_assert_double_lt(rig->result.residual_px, 1);
	roll(6);
	check_identities(id);
}
END_TEST

START_TEST(test_time_goes_backwards)
{
	int id[4], now[4];
	four_balls();
	roll(10);
	identities(id);
	rig_track(frame, 0.1);
	identities(now);
	for (int i = 0; i < 4; i++) {
		const struct vision_ball *b = rig_found_at(rig->ball[i].pos, 2 * mm);
		ck_assert_int_eq(b->age, 1);
		ck_assert(b->vel.x == 0 && b->vel.y == 0);
		ck_assert_int_gt(now[i], id[0]);
	}
	ck_assert_int_eq(rig->result.calibration, CALIBRATION_FRESH);
	ck_assert(rig->result.pose_age == 0);
	/* The same time twice is no step back, and no division by nothing. */
	rig_track(frame, 0.1);
	check_identities(now);
	for (int i = 0; i < 4; i++)
		ck_assert(isfinite(rig->result.ball[i].vel.x) && isfinite(rig->result.ball[i].vel.y));
}
END_TEST

/* Any one marker covered, from the first frame on or later. */
START_TEST(test_three_markers)
{
	int id[4];
	four_balls();
	rig_track(0, 0);
	struct camera camera = rig->result.camera;
	for (int hidden = 0; hidden < rig->config.markers.count; hidden++) {
		vision_reset(rig->vision);
		for (frame = 0; frame < 4; frame++) {
			rig_paint(frame);
			blacken_marker(&camera, hidden);
			rig_look(frame * dt);
		}
		ck_assert_int_eq(rig->result.calibration, CALIBRATION_FRESH);
		ck_assert_int_eq(rig->result.markers_seen, 3);
		identities(id);
	}
	vision_reset(rig->vision);
	frame = 0;
	roll(5);
	ck_assert_int_eq(rig->result.markers_seen, 4);
	identities(id);
	for (int i = 0; i < 40; i++, frame++) {
		rig_paint(frame);
		blacken_marker(&camera, 2);
		rig_look(frame * dt);
		ck_assert_int_eq(rig->result.calibration, CALIBRATION_FRESH);
		check_identities(id);
	}
	ck_assert_int_eq(rig->result.markers_seen, 3);
}
END_TEST

static void look_without_markers(const struct camera *camera, double time)
{
	rig_paint(frame++);
	for (int i = 0; i < rig->config.markers.count; i++)
		if (i != 1)
			blacken_marker(camera, i);
	rig_look(time);
}

START_TEST(test_kept_pose_grows_old_and_is_given_up)
{
	int id[4];
	double keep = config_vision_def(&rig->config, &rig->colours).pose_keep;
	four_balls();
	roll(5);
	identities(id);
	struct camera camera = rig->result.camera;
	/* The last search that found them was the first frame's, at 0. */
	for (double t = 1.5; t < keep; t += 1.7) {
		look_without_markers(&camera, t);
		ck_assert_int_eq(rig->result.calibration, CALIBRATION_KEPT);
		ck_assert_int_eq(rig->result.markers_seen, 1);
		ck_assert_double_eq_tol(rig->result.pose_age, t, 1e-9);
		check_identities(id);
	}
	look_without_markers(&camera, keep + 1);
	ck_assert_int_eq(rig->result.calibration, CALIBRATION_NONE);
	ck_assert_int_eq(rig->result.ball_count, 0);
	ck_assert(strstr(rig->result.reason, "no markers") != NULL);
	look_without_markers(&camera, keep + 2);
	ck_assert_int_eq(rig->result.calibration, CALIBRATION_NONE);
	ck_assert(strstr(rig->result.reason, "1 of 4 markers") != NULL);
	/* And they come back: the balls are who they were. */
	rig_track(frame++, keep + 3);
	ck_assert_int_eq(rig->result.calibration, CALIBRATION_FRESH);
	ck_assert(rig->result.pose_age == 0);
	check_identities(id);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("track");
	TCase *tc = tcase_create("alone");
	tcase_add_checked_fixture(tc, alone_setup, NULL);
	tcase_add_test(tc, test_crossing_keeps_identities);
	tcase_add_test(tc, test_look_tells_balls_apart);
	tcase_add_test(tc, test_lost_ball_is_kept_four_frames);
	tcase_add_test(tc, test_jumping_finds_are_no_ball);
	tcase_add_test(tc, test_rest_is_measured_in_pixels);
	tcase_add_test(tc, test_more_than_there_is_room_for);
	suite_add_tcase(suite, tc);
	tc = tcase_create("streams");
	tcase_add_checked_fixture(tc, stream_setup, rig_teardown);
	tcase_add_test(tc, test_rendered_crossing);
	tcase_add_test(tc, test_hand_covers_a_ball);
	tcase_add_test(tc, test_rendered_ball_is_lost);
	tcase_add_test(tc, test_camera_is_bumped);
	tcase_add_test(tc, test_time_goes_backwards);
	tcase_add_test(tc, test_three_markers);
	tcase_add_test(tc, test_kept_pose_grows_old_and_is_given_up);
	tcase_set_timeout(tc, 120);
	suite_add_tcase(suite, tc);
	return suite;
}
