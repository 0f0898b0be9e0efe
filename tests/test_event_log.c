#include "app/process/event_log.h"

#include <errno.h>
#include <lcm/lcm.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "harness.h"

static char path[64], err[300];

static void set_up(void)
{
	snprintf(path, sizeof path, "/tmp/billiard-log-XXXXXX");
	int fd = mkstemp(path);
	ck_assert_int_ge(fd, 0);
	close(fd);
}

static void tear_down(void)
{
	unlink(path);
}

static void write_bytes(const uint8_t *bytes, size_t size)
{
	FILE *file = fopen(path, "wb");
	ck_assert_ptr_nonnull(file);
	ck_assert_uint_eq(fwrite(bytes, 1, size, file), size);
	fclose(file);
}

/* Three events, the second without data. */
static size_t three_events(uint8_t *out, size_t size)
{
	FILE *file = fmemopen(out, size, "wb");
	const struct log_event event[3] = {{1, "TRUTH", (const uint8_t *)"abc", 3},
					   {2000000000000000, "A", (const uint8_t *)"", 0},
					   {3, "CAMERA", (const uint8_t *)"0123456789", 10}};
	for (int i = 0; i < 3; i++)
		ck_assert_int_eq(event_log_write(file, i, &event[i]), 0);
	long used = ftell(file);
	fclose(file);
	return (size_t)used;
}

/* Events read until the end or a refusal. */
static int read_all(int *code)
{
	struct event_log *log;
	struct log_event event;
	int count = 0;
	ck_assert_int_eq(event_log_open(&log, path, err, sizeof err), 0);
	while ((*code = event_log_next(log, &event, err, sizeof err)) > 0)
		count++;
	event_log_close(log);
	return count;
}

START_TEST(what_is_written_is_read)
{
	uint8_t bytes[400];
	struct event_log *log;
	struct log_event event;
	write_bytes(bytes, three_events(bytes, sizeof bytes));
	ck_assert_int_eq(event_log_open(&log, path, err, sizeof err), 0);
	ck_assert_int_eq(event_log_next(log, &event, err, sizeof err), 1);
	ck_assert_str_eq(event.channel, "TRUTH");
	ck_assert_uint_eq(event.size, 3);
	ck_assert_mem_eq(event.data, "abc", 3);
	ck_assert_int_eq(event_log_next(log, &event, err, sizeof err), 1);
	ck_assert_int_eq(event.utime, 2000000000000000);
	ck_assert_uint_eq(event.size, 0);
	ck_assert_int_eq(event_log_next(log, &event, err, sizeof err), 1);
	ck_assert_str_eq(event.channel, "CAMERA");
	ck_assert_int_eq(event_log_next(log, &event, err, sizeof err), 0);
	event_log_close(log);
}
END_TEST

START_TEST(lcm_reads_what_is_written)
{
	static const int data[3] = {3, 0, 10};
	uint8_t bytes[400];
	write_bytes(bytes, three_events(bytes, sizeof bytes));
	lcm_eventlog_t *log = lcm_eventlog_create(path, "r");
	ck_assert_ptr_nonnull(log);
	for (int i = 0; i < 3; i++) {
		lcm_eventlog_event_t *event = lcm_eventlog_read_next_event(log);
		ck_assert_ptr_nonnull(event);
		ck_assert_int_eq(event->eventnum, i);
		ck_assert_int_eq(event->datalen, data[i]);
		lcm_eventlog_free_event(event);
	}
	ck_assert_ptr_null(lcm_eventlog_read_next_event(log));
	lcm_eventlog_destroy(log);
}
END_TEST

START_TEST(every_cut_log_is_refused)
{
	uint8_t bytes[400];
	size_t size = three_events(bytes, sizeof bytes), whole[4] = {0, 28 + 5 + 3, 28 + 5 + 3 + 28 + 1, size};
	int at_border = 0;
	for (size_t n = 0; n <= size; n++) {
		int code;
		write_bytes(bytes, n);
		int count = read_all(&code);
		bool border = n == whole[0] || n == whole[1] || n == whole[2] || n == whole[3];
		at_border += border;
		ck_assert_int_eq(code, border ? 0 : -EINVAL);
		ck_assert_int_eq(count, (n >= whole[1]) + (n >= whole[2]) + (n >= whole[3]));
		ck_assert(border || strstr(err, path));
	}
	ck_assert_int_eq(at_border, 4);
}
END_TEST

START_TEST(a_damaged_log_is_read_or_refused_but_never_harmful)
{
	uint8_t bytes[400], damaged[400];
	size_t size = three_events(bytes, sizeof bytes);
	struct random r = random_begin("event_log");
	for (int i = 0; i < 500; i++) {
		int code;
		memcpy(damaged, bytes, size);
		for (int k = 0; k < 1 + i % 3; k++)
			damaged[random_u64(&r) % size] = (uint8_t)random_u64(&r);
		write_bytes(damaged, size);
		int count = read_all(&code);
		ck_assert(code == 0 || code == -EINVAL || code == -ENOMEM);
		ck_assert_int_le(count, 3);
	}
}
END_TEST

START_TEST(what_is_no_log_is_refused_by_name)
{
	int code;
	write_bytes((const uint8_t *)"WHITE0, WHITE, 0, 0\nRED1, RED, 300, 0\n", 38);
	ck_assert_int_eq(read_all(&code), 0);
	ck_assert_int_eq(code, -EINVAL);
	ck_assert_ptr_nonnull(strstr(err, path));
	struct event_log *log;
	ck_assert_int_eq(event_log_open(&log, "/nonexistent/a.lcmlog", err, sizeof err), -ENOENT);
	ck_assert_ptr_nonnull(strstr(err, "/nonexistent/a.lcmlog"));
	ck_assert_ptr_null(log);
	event_log_close(NULL);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("event_log");
	TCase *log = tcase_create("log");
	tcase_add_checked_fixture(log, set_up, tear_down);
	tcase_add_test(log, what_is_written_is_read);
	tcase_add_test(log, lcm_reads_what_is_written);
	tcase_add_test(log, every_cut_log_is_refused);
	tcase_add_test(log, a_damaged_log_is_read_or_refused_but_never_harmful);
	tcase_add_test(log, what_is_no_log_is_refused_by_name);
	suite_add_tcase(suite, log);
	return suite;
}
