/* Pictures of the stages: all there, as large as the frame, showing what they say, and without effect on the result. */
#include "vision/stages.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/commands/cmd.h"
#include "vision_rig.h"

static const char *const NAME[] = {"markers", "cloth",	 "marks",   "votes",   "seeds",
				   "fits",    "round-1", "round-2", "round-3", "balls"};
enum { NAMES = sizeof NAME / sizeof *NAME };

struct album {
	int count;
	const char *name[2 * NAMES];
	uint8_t centre[2 * NAMES][3]; /* BGR of the pixel at the first ball's middle */
};

static void keep(void *user, const char *name, const struct image *image)
{
	struct album *album = user;
	vec2 px;
	ck_assert_int_lt(album->count, 2 * NAMES);
	ck_assert_ptr_nonnull(image);
	ck_assert_int_eq(image->width, rig->image.image.width);
	ck_assert_int_eq(image->height, rig->image.image.height);
	if (rig->count > 0 && rig->result.calibration != CALIBRATION_NONE) {
		ck_assert(camera_project(&rig->result.camera, rig->ball[0].pos, rig->config.table.ball_radius, &px));
		memcpy(album->centre[album->count], image->data + lround(px.y) * image->stride + 3 * lround(px.x), 3);
	}
	album->name[album->count++] = name;
}

static void detect(void)
{
	char err[256];
	ck_assert_msg(vision_detect(rig->vision, &rig->image.image, &rig->result, err, sizeof(err)) == 0, "%s", err);
}

START_TEST(test_every_stage_once_in_order)
{
	struct random r = random_begin("stages");
	struct album album = {0};
	struct stage_watch watch = {keep, &album};
	rig_scatter(&r, 22);
	rig_paint(1);
	detect();
	struct vision_result unwatched = rig->result;
	vision_watch(rig->vision, &watch);
	detect();
	ck_assert_int_eq(album.count, NAMES);
	for (int i = 0; i < NAMES; i++)
		ck_assert_str_eq(album.name[i], NAME[i]);
	/* The marks of a ball are white, and votes meet in its middle. */
	ck_assert_int_eq(album.centre[2][0], 255);
	ck_assert_int_gt(album.centre[3][0], 30);
	/* Looking changes nothing. */
	ck_assert_int_eq(unwatched.ball_count, rig->result.ball_count);
	for (int i = 0; i < unwatched.ball_count; i++)
		ck_assert(unwatched.ball[i].pos.x == rig->result.ball[i].pos.x &&
			  unwatched.ball[i].pos.y == rig->result.ball[i].pos.y);
	vision_watch(rig->vision, NULL);
	detect();
	ck_assert_int_eq(album.count, NAMES);
}
END_TEST

START_TEST(test_without_pose_only_the_markers)
{
	struct album album = {0};
	struct stage_watch watch = {keep, &album};
	rig_paint(1);
	memset(rig->image.image.data, 90, (size_t)rig->image.image.stride * (size_t)rig->image.image.height);
	vision_watch(rig->vision, &watch);
	detect();
	ck_assert_int_eq(album.count, 1);
	ck_assert_str_eq(album.name[0], "markers");
}
END_TEST

START_TEST(test_empty_table_and_small_frame)
{
	struct album album = {0};
	struct stage_watch watch = {keep, &album};
	rig_paint(1);
	vision_watch(rig->vision, &watch);
	detect();
	/* No rounds without balls. */
	ck_assert_int_eq(album.count, NAMES - 3);
	ck_assert_int_eq(image_buffer_reserve(&rig->image, 64, 36), 0);
	memset(rig->image.image.data, 90, (size_t)rig->image.image.stride * 36);
	detect();
	ck_assert_int_eq(album.count, NAMES - 2);
}
END_TEST

/* ---- the command
 * ----------------------------------------------------------------------------------------------------- */

static int quietly(int argc, char **argv)
{
	fflush(stdout);
	fflush(stderr);
	FILE *nowhere = fopen("/dev/null", "w");
	ck_assert_ptr_nonnull(nowhere);
	int out = dup(1), err = dup(2);
	dup2(fileno(nowhere), 1);
	dup2(fileno(nowhere), 2);
	int status = cmd_detect(argc, argv);
	fflush(stdout);
	dup2(out, 1);
	dup2(err, 2);
	close(out);
	close(err);
	fclose(nowhere);
	return status;
}

START_TEST(test_dump_writes_the_files)
{
	char folder[] = "/tmp/billiard-stages-XXXXXX", photo[64], to[64], path[96], err[256];
	struct random r = random_begin("stages_dump");
	struct image_buffer read = {0};
	ck_assert_ptr_nonnull(mkdtemp(folder));
	snprintf(photo, sizeof photo, "%s/photo.png", folder);
	snprintf(to, sizeof to, "%s/new", folder);
	rig_scatter(&r, 10);
	rig_paint(1);
	ck_assert_int_eq(image_write_png(&rig->image.image, photo, err, sizeof err), 0);
	char *argv[] = {"detect", "-c", "config/thesis-table.conf", "--dump", to, photo, NULL};
	ck_assert_int_eq(quietly(6, argv), CMD_OK);
	for (int i = 0; i < NAMES; i++) {
		snprintf(path, sizeof path, "%s/%02d-%s.png", to, i + 1, NAME[i]);
		ck_assert_msg(image_read(path, &read, err, sizeof err) == 0, "%s", err);
		ck_assert_int_eq(read.image.width, rig->config.camera.width);
		ck_assert_int_eq(read.image.height, rig->config.camera.height);
		unlink(path);
	}
	/* Nothing else was written. */
	ck_assert_int_eq(rmdir(to), 0);
	/* A folder that cannot be one. */
	argv[4] = photo;
	optind = 0;
	ck_assert_int_eq(quietly(6, argv), CMD_BAD_INPUT);
	unlink(photo);
	ck_assert_int_eq(rmdir(folder), 0);
	image_buffer_finish(&read);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("stages");
	TCase *tc = tcase_create("stages");
	tcase_add_checked_fixture(tc, rig_setup, rig_teardown);
	tcase_add_test(tc, test_every_stage_once_in_order);
	tcase_add_test(tc, test_without_pose_only_the_markers);
	tcase_add_test(tc, test_empty_table_and_small_frame);
	tcase_add_test(tc, test_dump_writes_the_files);
	tcase_set_timeout(tc, 120);
	suite_add_tcase(suite, tc);
	return suite;
}
