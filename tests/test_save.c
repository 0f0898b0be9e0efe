#include "app/config/save.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/config/colour_file.h"
#include "app/config/text_file.h"
#include "app/light/picture.h"
#include "harness.h"

static char folder[64], path[96], err[256];

static void setup(void)
{
	strcpy(folder, "/tmp/billiard-save-XXXXXX");
	ck_assert_ptr_nonnull(mkdtemp(folder));
	snprintf(path, sizeof path, "%s/file", folder);
	err[0] = '\0';
}

static int entries(bool and_remove)
{
	int count = 0;
	DIR *dir = opendir(folder);
	for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
		if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
			continue;
		count++;
		if (and_remove)
			unlinkat(dirfd(dir), entry->d_name, 0);
	}
	closedir(dir);
	return count;
}

static void teardown(void)
{
	entries(true);
	rmdir(folder);
}

static void holds(const char *file, const char *wanted)
{
	char *text;
	size_t size;
	ck_assert_msg(text_file_read(file, 1 << 20, &text, &size, err, sizeof err) == 0, "%s", err);
	ck_assert_str_eq(text, wanted);
	free(text);
}

static int save(const char *text)
{
	return save_file(path, text, strlen(text), err, sizeof err);
}

START_TEST(new_and_old_files)
{
	ck_assert_int_eq(save("one"), 0);
	holds(path, "one");
	ck_assert_int_eq(chmod(path, 0640), 0);
	ck_assert_int_eq(save("another"), 0);
	holds(path, "another");
	struct stat info;
	ck_assert_int_eq(stat(path, &info), 0);
	ck_assert_int_eq(info.st_mode & 07777, 0640);
	ck_assert_int_eq(save(""), 0);
	holds(path, "");
	ck_assert_int_eq(entries(false), 1);
}
END_TEST

START_TEST(a_new_file_obeys_the_umask)
{
	struct stat info;
	umask(027);
	ck_assert_int_eq(save("x"), 0);
	ck_assert_int_eq(stat(path, &info), 0);
	ck_assert_int_eq(info.st_mode & 07777, 0640);
}
END_TEST

/* The link stays one, what it points to is replaced. */
START_TEST(a_link_is_followed)
{
	char link[96];
	struct stat info;
	snprintf(link, sizeof link, "%s/link", folder);
	ck_assert_int_eq(save("old"), 0);
	ck_assert_int_eq(symlink("file", link), 0);
	ck_assert_int_eq(save_file(link, "new", 3, err, sizeof err), 0);
	ck_assert_int_eq(lstat(link, &info), 0);
	ck_assert(S_ISLNK(info.st_mode));
	holds(path, "new");
}
END_TEST

START_TEST(a_device_is_written_directly)
{
	ck_assert_int_eq(save_file("/dev/null", "x", 1, err, sizeof err), 0);
	ck_assert_int_eq(save_file("/dev/full", "x", 1, err, sizeof err), -ENOSPC);
	ck_assert_str_eq(err, "/dev/full: No space left on device");
	struct stat info;
	ck_assert_int_eq(stat("/dev/full", &info), 0);
	ck_assert(S_ISCHR(info.st_mode));
}
END_TEST

START_TEST(places_that_are_none)
{
	ck_assert_int_eq(save_file("/nonexistent/a", "x", 1, err, sizeof err), -ENOENT);
	ck_assert_str_eq(err, "/nonexistent/a: No such file or directory");
	ck_assert_int_eq(save_file(folder, "x", 1, err, sizeof err), -EISDIR);
	char name[5000];
	memset(name, 'a', sizeof name);
	name[sizeof name - 1] = '\0';
	ck_assert_int_eq(save_file(name, "x", 1, err, sizeof err), -ENAMETOOLONG);
	ck_assert_int_eq(entries(false), 0);
}
END_TEST

/* A disk with so much room: writing more fails half way, as a full one does. */
static void leave_room(rlim_t bytes)
{
	signal(SIGXFSZ, SIG_IGN);
	ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &(struct rlimit){bytes, bytes}), 0);
}

/* Whatever the room: the file is the old one or the new one, and nothing else is left behind. */
START_TEST(a_full_disk_leaves_the_old_file)
{
	char text[4001];
	memset(text, 'n', sizeof text - 1);
	text[sizeof text - 1] = '\0';
	ck_assert_int_eq(save("old"), 0);
	leave_room((rlim_t)(_i * 1000));
	ck_assert_int_eq(save(text), -EFBIG);
	ck_assert_msg(strncmp(err, path, strlen(path)) == 0, "%s", err);
	holds(path, "old");
	ck_assert_int_eq(entries(false), 1);
}
END_TEST

START_TEST(colours_survive_a_full_disk)
{
	struct colour_model model = {.unknown_distance = 9}, back;
	model.class[COLOUR_RED] = (struct colour_class){.samples = 10, .scale = 1, .scale_spread = 0.1};
	for (int i = 0; i < COLOUR_FEATURES; i++)
		model.class[COLOUR_RED].covariance[i][i] = 1;
	ck_assert_msg(colour_file_write(path, &model, err, sizeof err) == 0, "%s", err);
	leave_room(100);
	model.unknown_distance = 5;
	ck_assert_int_eq(colour_file_write(path, &model, err, sizeof err), -EFBIG);
	ck_assert_msg(colour_file_read(path, &back, err, sizeof err) == 0, "%s", err);
	ck_assert_double_eq(back.unknown_distance, 9);
}
END_TEST

static void paint(cairo_t *cairo, const void *context)
{
	(void)context;
	cairo_paint(cairo);
}

START_TEST(pictures_survive_a_full_disk)
{
	cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 640, 480);
	cairo_t *cairo = cairo_create(surface);
	struct picture svg = {100, 100, paint, NULL};
	ck_assert_int_eq(save("old"), 0);
	ck_assert_int_eq(picture_save_png(cairo, "/dev/full", err, sizeof err), -ENOSPC);
	ck_assert_int_eq(picture_save_svg(&svg, "/dev/full", err, sizeof err), -ENOSPC);
	leave_room(100);
	ck_assert_int_eq(picture_save_png(cairo, path, err, sizeof err), -EFBIG);
	ck_assert_int_eq(picture_save_svg(&svg, path, err, sizeof err), -EFBIG);
	holds(path, "old");
	cairo_destroy(cairo);
	cairo_surface_destroy(surface);
}
END_TEST

START_TEST(backups)
{
	char backup[100];
	snprintf(backup, sizeof backup, "%s~", path);
	ck_assert_int_eq(save_backup(path, err, sizeof err), 0); /* nothing to keep */
	ck_assert_int_eq(access(backup, F_OK), -1);
	for (int i = 1; i <= 3; i++) {
		char text[2] = {(char)('0' + i), '\0'}, before[2] = {(char)('0' + i - 1), '\0'};
		ck_assert_int_eq(save_backup(path, err, sizeof err), 0);
		ck_assert_int_eq(save(text), 0);
		holds(path, text);
		if (i > 1)
			holds(backup, before);
	}
	ck_assert_int_eq(entries(false), 2);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("save");
	TCase *tcase = tcase_create("files");
	tcase_add_checked_fixture(tcase, setup, teardown);
	tcase_add_test(tcase, new_and_old_files);
	tcase_add_test(tcase, a_new_file_obeys_the_umask);
	tcase_add_test(tcase, a_link_is_followed);
	tcase_add_test(tcase, a_device_is_written_directly);
	tcase_add_test(tcase, places_that_are_none);
	tcase_add_loop_test(tcase, a_full_disk_leaves_the_old_file, 0, 4);
	tcase_add_test(tcase, colours_survive_a_full_disk);
	tcase_add_test(tcase, pictures_survive_a_full_disk);
	tcase_add_test(tcase, backups);
	suite_add_tcase(suite, tcase);
	return suite;
}
