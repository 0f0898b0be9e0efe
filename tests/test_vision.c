/* The whole of vision on pictures with known truth: the virtual camera's. */
#include "vision/vision.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vision_rig.h"

static const double mm = 1e-3;

static void rack(void)
{
	double d = 2 * rig->config.table.ball_radius + 0.1 * mm;
	rig->count = 0;
	for (int row = 0; row < 5; row++)
		for (int i = 0; i <= row; i++)
			rig->ball[rig->count++] =
				ball_at(COLOUR_RED, (vec2){0.4 + row * d * 0.8660255, (i - row / 2.0) * d});
	rig->ball[rig->count++] = ball_at(COLOUR_WHITE, (vec2){-0.6, 0.1});
}

static void detect(uint64_t frame)
{
	char err[256];
	table_camera_render(rig->camera, rig->ball, rig->count, frame, &rig->image.image);
	ck_assert_msg(vision_detect(rig->vision, &rig->image.image, &rig->result, err, sizeof(err)) == 0, "%s", err);
}

/* Every ball found once with its colour, nothing else. Returns the largest error, m. */
static double check_found(void)
{
	double worst = 0;
	ck_assert_msg(rig->result.calibration == CALIBRATION_FRESH, "%s", rig->result.reason);
	ck_assert_int_eq(rig->result.ball_count, rig->count);
	for (int i = 0; i < rig->count; i++) {
		int best = 0;
		for (int k = 1; k < rig->result.ball_count; k++)
			if (vec2_dist(rig->result.ball[k].pos, rig->ball[i].pos) <
			    vec2_dist(rig->result.ball[best].pos, rig->ball[i].pos))
				best = k;
		ck_assert_int_eq(rig->result.ball[best].colour, rig->ball[i].colour);
		worst = fmax(worst, vec2_dist(rig->result.ball[best].pos, rig->ball[i].pos));
	}
	return worst;
}

START_TEST(test_scattered_balls)
{
	struct random r = random_begin("vision_scattered");
	for (int i = 0; i < 6; i++) {
		rig_scatter(&r, 22);
		detect((uint64_t)i);
		ck_assert_double_lt(check_found(), 1.2 * mm);
		ck_assert(!rig->result.occluded);
	}
}
END_TEST

/* Half of the rim before a pocket's dark. */
START_TEST(test_balls_at_corner_pockets)
{
	for (int i = 0; i < 4; i++) {
		rig->ball[0] = ball_at(COLOUR_BLACK, (vec2){i & 1 ? 0.887 : -0.887, i & 2 ? 0.402 : -0.402});
		rig->ball[1] = ball_at(COLOUR_GREEN, (vec2){i & 1 ? -0.887 : 0.887, i & 2 ? 0.402 : -0.402});
		rig->ball[2] = ball_at(COLOUR_RED, (vec2){0, 0});
		rig->count = 3;
		detect((uint64_t)i);
		ck_assert_double_lt(check_found(), 1.2 * mm);
	}
}
END_TEST

START_TEST(test_rack)
{
	rack();
	detect(1);
	ck_assert_double_lt(check_found(), 1.5 * mm);
	/* Solid balls: no two overlap. */
	for (int i = 0; i < rig->result.ball_count; i++)
		for (int k = 0; k < i; k++)
			ck_assert_double_gt(vec2_dist(rig->result.ball[i].pos, rig->result.ball[k].pos),
					    2 * rig->config.table.ball_radius - 0.1 * mm);
}
END_TEST

START_TEST(test_same_frame_same_bits)
{
	struct random r = random_begin("vision_repeat");
	struct vision_result first;
	rig_scatter(&r, 15);
	detect(3);
	first = rig->result;
	detect(3);
	for (int i = 0; i < first.ball_count; i++)
		ck_assert(first.ball[i].pos.x == rig->result.ball[i].pos.x &&
			  first.ball[i].pos.y == rig->result.ball[i].pos.y);
}
END_TEST

START_TEST(test_empty_table_has_no_balls)
{
	rig->count = 0;
	detect(1);
	ck_assert_int_eq(rig->result.ball_count, 0);
	ck_assert_int_eq(rig->result.calibration, CALIBRATION_FRESH);
}
END_TEST

static void fill(int width, int height, int grey)
{
	ck_assert_int_eq(image_buffer_reserve(&rig->image, width, height), 0);
	memset(rig->image.image.data, grey, (size_t)rig->image.image.stride * (size_t)height);
}

START_TEST(test_frames_that_show_nothing)
{
	static const int grey[] = {0, 128, 255};
	char err[256];
	for (int i = 0; i < 3; i++) {
		fill(1280, 720, grey[i]);
		ck_assert_int_eq(vision_detect(rig->vision, &rig->image.image, &rig->result, err, sizeof(err)), 0);
		ck_assert_int_eq(rig->result.calibration, CALIBRATION_NONE);
		ck_assert_int_eq(rig->result.ball_count, 0);
		ck_assert(strstr(rig->result.reason, "markers") != NULL);
		ck_assert_int_eq(vision_track(rig->vision, &rig->image.image, i, &rig->result, err, sizeof(err)), 0);
		ck_assert_int_eq(rig->result.ball_count, 0);
	}
}
END_TEST

/* Markers are seen, balls cannot be: not calibrated, with the reason; and a reason only then. */
START_TEST(test_a_reason_means_not_calibrated)
{
	static const int grey[] = {5, 255};
	char err[256];
	rig->count = 0;
	for (int i = 0; i < 3; i++) {
		rig_paint(0);
		/* The bed between the markers' rails. */
		for (int y = 100; y < 620 && i < 2; y++)
			memset(rig->image.image.data + y * rig->image.image.stride, grey[i], 3 * 1280);
		for (int stream = 0; stream < 2; stream++) {
			int r = stream ? vision_track(rig->vision, &rig->image.image, i, &rig->result, err, sizeof(err))
				       : vision_detect(rig->vision, &rig->image.image, &rig->result, err, sizeof(err));
			ck_assert_int_eq(r, 0);
			ck_assert_int_ge(rig->result.markers_seen, 3);
			ck_assert_int_eq(rig->result.ball_count, 0);
			ck_assert_int_eq(rig->result.calibration == CALIBRATION_NONE, i < 2);
			ck_assert_int_eq(rig->result.reason[0] != '\0', i < 2);
		}
	}
}
END_TEST

START_TEST(test_wrong_sizes_are_refused)
{
	static const int size[][2] = {{1, 1}, {640, 480}, {1280, 1024}, {720, 1280}, {8000, 720}};
	char err[256];
	for (int i = 0; i < 5; i++) {
		fill(size[i][0], size[i][1], 100);
		ck_assert_int_lt(vision_detect(rig->vision, &rig->image.image, &rig->result, err, sizeof(err)), 0);
		ck_assert(strstr(err, "px") != NULL);
	}
	/* Same shape, other sizes: scaled. */
	fill(3840, 2160, 100);
	ck_assert_int_eq(vision_detect(rig->vision, &rig->image.image, &rig->result, err, sizeof(err)), 0);
	fill(320, 180, 100);
	ck_assert_int_eq(vision_detect(rig->vision, &rig->image.image, &rig->result, err, sizeof(err)), 0);
}
END_TEST

START_TEST(test_bad_definitions_are_refused)
{
	char err[256];
	struct vision *vision;
	struct vision_def def = config_vision_def(&rig->config, &rig->colours), bad = def;
	bad.markers.count = 2;
	ck_assert_int_lt(vision_create(&vision, &bad, err, sizeof(err)), 0);
	ck_assert_ptr_null(vision);
	bad = def;
	bad.intrinsics.fx = -1;
	ck_assert_int_lt(vision_create(&vision, &bad, err, sizeof(err)), 0);
	bad = def;
	bad.table = NULL;
	ck_assert_int_lt(vision_create(&vision, &bad, err, sizeof(err)), 0);
	bad = def;
	bad.markers.dictionary_bits = 0;
	ck_assert_int_lt(vision_create(&vision, &bad, err, sizeof(err)), 0);
	vision_destroy(NULL);
}
END_TEST

/* ---- streams
 * --------------------------------------------------------------------------------------------------------- */

START_TEST(test_identity_velocity_and_rest)
{
	struct random r = random_begin("vision_track");
	double dt = 1 / 30.0;
	rig_scatter(&r, 6);
	rig->ball[0].pos = (vec2){-0.7, 0.0};
	for (int i = 1; i < 6; i++)
		rig->ball[i].pos = (vec2){-0.6 + 0.25 * i, i % 2 ? 0.25 : -0.25};
	int frame = 0;
	for (; frame < 8; frame++)
		rig_track(frame, frame * dt);
	ck_assert_int_eq(rig->result.ball_count, 6);
	ck_assert_ptr_nonnull(rig_found_at(rig->ball[0].pos, 1 * mm));
	int id = rig_found_at(rig->ball[0].pos, 1 * mm)->track;
	vec2 rest[6];
	for (int i = 1; i < 6; i++)
		rest[i] = rig_found_at(rig->ball[i].pos, 1 * mm)->pos;
	for (int k = 0; k < 12; k++, frame++) {
		rig->ball[0].pos.x += 0.9 * dt;
		rig_track(frame, frame * dt);
		const struct vision_ball *b = rig_found_at(rig->ball[0].pos, 2 * mm);
		ck_assert_msg(b != NULL, "frame %d: the rolling ball is lost", k);
		ck_assert_int_eq(b->track, id);
		if (k > 3) {
			ck_assert_double_eq_tol(b->vel.x, 0.9, 0.06);
			ck_assert_double_eq_tol(b->vel.y, 0, 0.06);
		}
		/* What rests does not move with it. */
		for (int i = 1; i < 6; i++) {
			ck_assert_ptr_nonnull(rig_found_at(rest[i], 0.15 * mm));
			ck_assert(rig_found_at(rest[i], 0.15 * mm)->vel.x == 0);
		}
	}
	for (int k = 0; k < 8; k++, frame++)
		rig_track(frame, frame * dt);
	const struct vision_ball *b = rig_found_at(rig->ball[0].pos, 1.2 * mm);
	ck_assert_ptr_nonnull(b);
	ck_assert_int_eq(b->track, id);
	ck_assert(b->vel.x == 0 && b->vel.y == 0);
}
END_TEST

START_TEST(test_balls_come_and_go)
{
	struct random r = random_begin("vision_come_and_go");
	rig_scatter(&r, 5);
	int frame = 0;
	for (; frame < 5; frame++)
		rig_track(frame, frame * 0.033);
	ck_assert_int_eq(rig->result.ball_count, 5);
	rig->count = 4;
	for (; frame < 12; frame++)
		rig_track(frame, frame * 0.033);
	ck_assert_int_eq(rig->result.ball_count, 4);
	rig->count = 5;
	for (; frame < 20; frame++)
		rig_track(frame, frame * 0.033);
	ck_assert_int_eq(rig->result.ball_count, 5);
	/* A time that goes back begins anew. */
	rig_track(frame, 0);
	ck_assert_int_eq(rig->result.ball_count, 5);
	ck_assert_int_eq(rig->result.ball[0].age, 1);
}
END_TEST

START_TEST(test_pose_is_kept_for_its_time)
{
	struct random r = random_begin("vision_pose_kept");
	char err[256];
	rig_scatter(&r, 4);
	rig_track(0, 0);
	table_camera_render(rig->camera, rig->ball, rig->count, 1, &rig->image.image);
	/* Markers covered: the rails turn black. */
	for (int y = 0; y < 720; y++)
		if (y < 62 || y > 655)
			memset(rig->image.image.data + y * rig->image.image.stride, 0, 3 * 1280);
	ck_assert_int_eq(vision_track(rig->vision, &rig->image.image, 5, &rig->result, err, sizeof(err)), 0);
	ck_assert_int_eq(rig->result.calibration, CALIBRATION_KEPT);
	ck_assert_double_eq_tol(rig->result.pose_age, 5, 1e-9);
	ck_assert_int_eq(rig->result.ball_count, 4);
	ck_assert_int_eq(vision_track(rig->vision, &rig->image.image, 200, &rig->result, err, sizeof(err)), 0);
	ck_assert_int_eq(rig->result.calibration, CALIBRATION_NONE);
	ck_assert_int_eq(rig->result.ball_count, 0);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("vision");
	TCase *tc = tcase_create("frames");
	tcase_add_checked_fixture(tc, rig_setup, rig_teardown);
	tcase_add_test(tc, test_scattered_balls);
	tcase_add_test(tc, test_balls_at_corner_pockets);
	tcase_add_test(tc, test_rack);
	tcase_add_test(tc, test_same_frame_same_bits);
	tcase_add_test(tc, test_empty_table_has_no_balls);
	tcase_add_test(tc, test_frames_that_show_nothing);
	tcase_add_test(tc, test_a_reason_means_not_calibrated);
	tcase_add_test(tc, test_wrong_sizes_are_refused);
	tcase_add_test(tc, test_bad_definitions_are_refused);
	tcase_set_timeout(tc, 120);
	suite_add_tcase(suite, tc);
	tc = tcase_create("streams");
	tcase_add_checked_fixture(tc, rig_setup, rig_teardown);
	tcase_add_test(tc, test_identity_velocity_and_rest);
	tcase_add_test(tc, test_balls_come_and_go);
	tcase_add_test(tc, test_pose_is_kept_for_its_time);
	tcase_set_timeout(tc, 120);
	suite_add_tcase(suite, tc);
	return suite;
}
