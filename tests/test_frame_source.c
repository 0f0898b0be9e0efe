#include "app/process/clock.h"
#include "app/process/frame_source.h"

#include <dirent.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/process/process.h"
#include "harness.h"

enum { WIDTH = 64, HEIGHT = 48 };
static char folder[64], source_text[80];
static struct frame_source *source;
static struct frame_source_frame frame;

static const char *in_folder(const char *name)
{
	static char path[128];
	snprintf(path, sizeof path, "%s/%s", folder, name);
	return path;
}

static void write_picture(const char *name, uint8_t grey)
{
	uint8_t pixels[WIDTH * HEIGHT * 3];
	char err[300];
	memset(pixels, grey, sizeof pixels);
	struct image image = {pixels, WIDTH, HEIGHT, 3 * WIDTH};
	ck_assert_int_eq(image_write_png(&image, in_folder(name), err, sizeof err), 0);
}

static void write_text(const char *name, const char *text)
{
	FILE *f = fopen(in_folder(name), "w");
	ck_assert_ptr_nonnull(f);
	fputs(text, f);
	fclose(f);
}

static void setup(void)
{
	strcpy(folder, "/tmp/billiard-frames-XXXXXX");
	ck_assert_ptr_nonnull(mkdtemp(folder));
	snprintf(source_text, sizeof source_text, "dir:%s", folder);
	memset(&frame, 0, sizeof frame);
	source = NULL;
}

static void teardown(void)
{
	char command[96];
	frame_source_destroy(source);
	image_buffer_finish(&frame.image);
	snprintf(command, sizeof command, "rm -rf %s", folder);
	ck_assert_int_eq(system(command), 0);
}

static struct frame_source_def def(double fps, double hold)
{
	return (struct frame_source_def){source_text, WIDTH, HEIGHT, fps, hold};
}

static void create(double fps, double hold)
{
	char err[300] = "";
	struct frame_source_def d = def(fps, hold);
	ck_assert_msg(frame_source_create(&source, &d, err, sizeof err) == 0, "%s", err);
}

/* False: the source has ended. */
static bool next(void)
{
	struct frame_source_figures f;
	struct pollfd fd = {frame_source_descriptor(source), POLLIN, 0};
	for (;;) {
		if (frame_source_take(source, &frame))
			return true;
		frame_source_figures(source, &f);
		if (f.ended)
			return frame_source_take(source, &frame);
		ck_assert_msg(poll(&fd, 1, 10000) == 1, "nothing comes");
	}
}

START_TEST(every_picture_of_a_folder_comes_in_order)
{
	write_picture("10.png", 30);
	write_picture("2.png", 20);
	write_picture("1.png", 10);
	create(200, 0);
	for (int i = 1; i <= 3; i++) {
		ck_assert(next());
		ck_assert_int_eq(frame.seq, i);
		ck_assert(frame.image.image.width == WIDTH && frame.image.image.height == HEIGHT);
		ck_assert_int_eq(frame.image.image.data[5], 10 * i);
		ck_assert_int_gt(frame.utime, 0);
	}
	ck_assert(!next());
	struct frame_source_figures f;
	frame_source_figures(source, &f);
	ck_assert(f.frames == 3 && f.dropped == 0 && f.bad == 0 && f.ended && !f.error[0]);
}
END_TEST

START_TEST(a_picture_is_held_and_time_goes_on)
{
	write_picture("1.png", 10);
	write_picture("2.png", 20);
	create(100, 0.05);
	int64_t last = 0;
	for (int i = 0; i < 10; i++) {
		ck_assert(next());
		ck_assert_int_eq(frame.image.image.data[0], i < 5 ? 10 : 20);
		ck_assert_int_gt(frame.utime, last);
		last = frame.utime;
	}
	ck_assert(!next());
}
END_TEST

/* A slow taker loses nothing of a folder. */
START_TEST(files_wait_for_the_taker)
{
	for (int i = 0; i < 8; i++) {
		char name[16];
		snprintf(name, sizeof name, "%d.png", i);
		write_picture(name, (uint8_t)(i + 1));
	}
	create(1000, 0);
	for (int i = 0; i < 8; i++) {
		poll(NULL, 0, 5);
		ck_assert(next());
		ck_assert_int_eq(frame.image.image.data[0], i + 1);
	}
	ck_assert(!next());
}
END_TEST

START_TEST(a_photograph_that_is_none_is_said_and_the_next_comes)
{
	write_picture("1.png", 10);
	write_text("2.png", "this is no photograph");
	write_picture("3.png", 30);
	create(200, 0);
	ck_assert(next() && next());
	ck_assert_int_eq(frame.image.image.data[0], 30);
	ck_assert(!next());
	struct frame_source_figures f;
	frame_source_figures(source, &f);
	ck_assert(f.frames == 2 && f.bad == 1 && strstr(f.error, "2.png"));
}
END_TEST

START_TEST(sources_that_are_none_are_errors_at_once)
{
	static const char *const bad[] = {"dir:/nowhere", "file:/nowhere.avi", "telepathy:", "", "dir:"};
	struct frame_source_def d = def(10, 0);
	char err[300] = "";
	ck_assert_int_lt(frame_source_create(&source, &d, err, sizeof err), 0); /* empty folder */
	ck_assert(!source && strstr(err, folder));
	for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
		d.source = bad[i];
		err[0] = '\0';
		ck_assert_msg(frame_source_create(&source, &d, err, sizeof err) < 0, "%s", bad[i]);
		ck_assert(!source && err[0]);
	}
	write_text("video.avi", "RIFF, but then no video");
	char path[160];
	snprintf(path, sizeof path, "file:%s", in_folder("video.avi"));
	d.source = path;
	ck_assert_int_lt(frame_source_create(&source, &d, err, sizeof err), 0);
	ck_assert_ptr_nonnull(strstr(err, "video.avi"));
}
END_TEST

START_TEST(a_camera_that_is_away_is_tried_again)
{
	struct frame_source_def d = {"v4l2:/dev/video99", WIDTH, HEIGHT, 30, 0};
	struct frame_source_figures f = {0};
	char err[300];
	ck_assert_int_eq(frame_source_create(&source, &d, err, sizeof err), 0);
	double end = clock_seconds() + 10;
	while (f.bad < 2 && clock_seconds() < end) {
		struct pollfd fd = {frame_source_descriptor(source), POLLIN, 0};
		poll(&fd, 1, 500);
		ck_assert(!frame_source_take(source, &frame));
		frame_source_figures(source, &f);
	}
	ck_assert_int_ge(f.bad, 2);
	ck_assert(!f.ended && strstr(f.error, "video99"));
}
END_TEST

START_TEST(it_can_be_destroyed_at_any_moment)
{
	write_picture("1.png", 10);
	write_picture("2.png", 20);
	for (int i = 0; i < 30; i++) {
		create(i % 2 ? 1 : 500, i % 3);
		for (int k = 0; k < i % 4; k++)
			if (i % 2 == 0)
				next();
		frame_source_destroy(source);
		source = NULL;
	}
	frame_source_destroy(NULL);
}
END_TEST

/* ---- the slot ---------------------------------------------------------------------------------------------------- */

/* A camera never waits for the loop: what is taken is the newest, and what was replaced is counted. */
START_TEST(a_live_frame_replaces_one_that_waits)
{
	struct frame_slot slot;
	struct frame_source_frame mine = {0};
	frame_slot_init(&slot);
	for (int i = 0; i < 5; i++) {
		snprintf(mine.name, sizeof mine.name, "%d", i);
		ck_assert(frame_slot_offer(&slot, &mine, true));
	}
	ck_assert(slot.frames == 5 && slot.dropped == 4);
	ck_assert(frame_slot_take(&slot, &mine));
	ck_assert_str_eq(mine.name, "4");
	ck_assert_int_eq(mine.seq, 5);
	ck_assert(!frame_slot_take(&slot, &mine));
	image_buffer_finish(&mine.image);
	frame_slot_finish(&slot);
}
END_TEST

static void *offer_two(void *context)
{
	struct frame_source_frame mine = {0};
	bool first = frame_slot_offer(context, &mine, false), second = frame_slot_offer(context, &mine, false);
	image_buffer_finish(&mine.image);
	return first && second ? context : NULL;
}

START_TEST(other_frames_wait_until_they_are_taken)
{
	struct frame_slot slot;
	struct frame_source_frame mine = {0};
	pthread_t thread;
	void *both;
	frame_slot_init(&slot);
	ck_assert_int_eq(pthread_create(&thread, NULL, offer_two, &slot), 0);
	for (int64_t seq = 1; seq <= 2; seq++) {
		while (!frame_slot_take(&slot, &mine))
			usleep(1000);
		ck_assert_int_eq(mine.seq, seq);
	}
	pthread_join(thread, &both);
	ck_assert(both != NULL && slot.dropped == 0);
	image_buffer_finish(&mine.image);
	frame_slot_finish(&slot);
}
END_TEST

START_TEST(a_stop_ends_every_wait)
{
	struct frame_slot slot;
	pthread_t thread;
	void *both;
	frame_slot_init(&slot);
	double begin = clock_seconds();
	ck_assert(frame_slot_wait(&slot, 0.02));
	ck_assert_double_ge(clock_seconds() - begin, 0.02);
	ck_assert_int_eq(pthread_create(&thread, NULL, offer_two, &slot), 0);
	frame_slot_stop(&slot);
	pthread_join(thread, &both);
	ck_assert_ptr_null(both);
	ck_assert(!frame_slot_wait(&slot, 1e6));
	frame_slot_finish(&slot);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("frame_source");
	TCase *sources = tcase_create("sources");
	tcase_set_timeout(sources, 30);
	tcase_add_checked_fixture(sources, setup, teardown);
	tcase_add_test(sources, every_picture_of_a_folder_comes_in_order);
	tcase_add_test(sources, a_picture_is_held_and_time_goes_on);
	tcase_add_test(sources, files_wait_for_the_taker);
	tcase_add_test(sources, a_photograph_that_is_none_is_said_and_the_next_comes);
	tcase_add_test(sources, sources_that_are_none_are_errors_at_once);
	tcase_add_test(sources, a_camera_that_is_away_is_tried_again);
	tcase_add_test(sources, it_can_be_destroyed_at_any_moment);
	suite_add_tcase(suite, sources);
	TCase *slot = tcase_create("slot");
	tcase_add_test(slot, a_live_frame_replaces_one_that_waits);
	tcase_add_test(slot, other_frames_wait_until_they_are_taken);
	tcase_add_test(slot, a_stop_ends_every_wait);
	suite_add_tcase(suite, slot);
	return suite;
}
