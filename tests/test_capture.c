#include "vision/capture_cv.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness.h"

static char folder[64];

static void shell(const char *format)
{
	char command[256];
	snprintf(command, sizeof(command), format, folder);
	ck_assert_int_eq(system(command), 0);
}

static void setup(void)
{
	snprintf(folder, sizeof(folder), "/tmp/billiard-capture-%ld", (long)getpid());
	ck_assert_int_eq(mkdir(folder, 0700), 0);
}

static void teardown(void)
{
	shell("rm -rf %s");
}

static struct capture *open_source(const char *format, int *rc, char err[256])
{
	char source[128];
	struct capture *capture = NULL;
	snprintf(source, sizeof(source), format, folder);
	struct capture_def def = {.source = source};
	*rc = capture_open(&capture, &def, err, 256);
	return capture;
}

static void put(const char *name, int grey)
{
	char file[128], err[256];
	uint8_t data[8 * 6 * 3];
	memset(data, grey, sizeof(data));
	snprintf(file, sizeof(file), "%s/%s", folder, name);
	ck_assert_int_eq(image_write_png(&(struct image){data, 8, 6, 24}, file, err, sizeof(err)), 0);
}

START_TEST(test_folder_in_natural_order)
{
	static const char *const name[] = {"10.png", "9.png", "2.png", "1.png", "a2.png", "a10.png"};
	static const int order[] = {1, 2, 9, 10, 102, 110};
	int rc;
	char err[256];
	put(name[0], 10), put(name[1], 9), put(name[2], 2), put(name[3], 1), put(name[4], 102), put(name[5], 110);
	shell("touch %s/notes.txt");
	struct capture *capture = open_source("dir:%s", &rc, err);
	ck_assert_int_eq(rc, 0);
	struct image_buffer image = {0};
	struct capture_frame frame;
	for (int i = 0; i < 6; i++) {
		ck_assert_int_eq(capture_next(capture, &image, &frame, err, sizeof(err)), 1);
		ck_assert_int_eq(image.image.data[0], order[i]);
		ck_assert_int_eq(frame.index, i);
		ck_assert_double_eq_tol(frame.time, i / 30.0, 1e-12);
	}
	ck_assert_int_eq(capture_next(capture, &image, &frame, err, sizeof(err)), 0);
	capture_close(capture);
	image_buffer_finish(&image);
}
END_TEST

START_TEST(test_a_bad_image_in_between_is_named_and_passed)
{
	int rc;
	char err[256];
	put("1.png", 1), put("3.png", 3);
	shell("echo nonsense > %s/2.png");
	struct capture *capture = open_source("dir:%s", &rc, err);
	struct image_buffer image = {0};
	struct capture_frame frame;
	ck_assert_int_eq(capture_next(capture, &image, &frame, err, sizeof(err)), 1);
	ck_assert_int_lt(capture_next(capture, &image, &frame, err, sizeof(err)), 0);
	ck_assert_ptr_nonnull(strstr(err, "2.png"));
	ck_assert_int_eq(capture_next(capture, &image, &frame, err, sizeof(err)), 1);
	ck_assert_int_eq(image.image.data[0], 3);
	capture_close(capture);
	image_buffer_finish(&image);
}
END_TEST

START_TEST(test_sources_that_are_none)
{
	static const char *const source[] = {
		"dir:%s", "dir:%s/nowhere", "file:%s/nowhere.mp4", "file:%s", "v4l2:%s/video9", "tape:%s", ""};
	static const char *const reason[] = {"no PNG",	"No such",	  "No such",	   "folder",
					     "No such", "unknown source", "unknown source"};
	int rc;
	char err[256];
	for (int i = 0; i < 7; i++) {
		ck_assert_ptr_null(open_source(source[i], &rc, err));
		ck_assert_int_lt(rc, 0);
		ck_assert_msg(strstr(err, reason[i]) != NULL, "%s: %s", source[i], err);
	}
	shell("echo nonsense > %s/a.mp4");
	ck_assert_ptr_null(open_source("file:%s/a.mp4", &rc, err));
	ck_assert_int_eq(rc, -EBADMSG);
	capture_close(NULL);
}
END_TEST

START_TEST(test_truncated_video_says_so)
{
	const char *data = test_data_folder("truncated_video");
	char command[512], err[256];
	int rc;
	if (!data)
		return;
	snprintf(command, sizeof(command),
		 "f=%s/videos/null_grad_stoss_1_0003_0009.mp4; head -c $(($(stat -c %%s $f) / 2)) $f > %s/half.mp4",
		 data, folder);
	ck_assert_int_eq(system(command), 0);
	struct capture *capture = open_source("file:%s/half.mp4", &rc, err);
	struct image_buffer image = {0};
	struct capture_frame frame;
	int frames = 0;
	/* Refused at once or after the frames that are there, but not passed over in silence. */
	while (capture && (rc = capture_next(capture, &image, &frame, err, sizeof(err))) == 1)
		frames++;
	ck_assert_int_lt(rc, 0);
	ck_assert_ptr_nonnull(strstr(err, "half.mp4"));
	ck_assert_int_lt(frames, 160);
	capture_close(capture);
	image_buffer_finish(&image);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("capture");
	TCase *tc = tcase_create("capture");
	tcase_add_checked_fixture(tc, setup, teardown);
	tcase_add_test(tc, test_folder_in_natural_order);
	tcase_add_test(tc, test_a_bad_image_in_between_is_named_and_passed);
	tcase_add_test(tc, test_sources_that_are_none);
	tcase_add_test(tc, test_truncated_video_says_so);
	tcase_set_timeout(tc, 60);
	suite_add_tcase(suite, tc);
	return suite;
}
