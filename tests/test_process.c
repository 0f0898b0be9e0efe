#include "app/process/clock.h"
#include "app/process/process.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "harness.h"

/* All on memq://: what a process publishes it hears itself. */
static struct config config; /* too large for the stack */
static struct process process;
static char said[2000];
static int64_t statuses;
static billiard_status_t status;
static const struct process_options OPTIONS = {.config = "config/thesis-table.conf", .bus = "memq://"};

/* stderr while a call runs, in said. */
static int saved_stderr = -1;
static void listen_to_stderr(void)
{
	char path[] = "/tmp/billiard-stderr-XXXXXX";
	int fd = mkstemp(path);
	ck_assert_int_ge(fd, 0);
	unlink(path);
	fflush(stderr);
	saved_stderr = dup(STDERR_FILENO);
	dup2(fd, STDERR_FILENO);
	close(fd);
}

static void stop_listening(void)
{
	fflush(stderr);
	lseek(STDERR_FILENO, 0, SEEK_SET);
	ssize_t n = read(STDERR_FILENO, said, sizeof said - 1);
	said[n > 0 ? n : 0] = '\0';
	dup2(saved_stderr, STDERR_FILENO);
	close(saved_stderr);
}

static int parse(struct process_options *out, const char *name, char **argv)
{
	int argc = 0;
	while (argv[argc])
		argc++;
	optind = 0;
	listen_to_stderr();
	int r = process_parse(out, name, argc, argv);
	stop_listening();
	return r;
}

#define ARGV(...) ((char *[]){"program", __VA_ARGS__, NULL})

START_TEST(options_are_read)
{
	struct process_options o;
	ck_assert_int_eq(parse(&o, "billiard-planner", ARGV("-c", "x.conf", "--bus", "memq://")), 0);
	ck_assert_str_eq(o.config, "x.conf");
	ck_assert_str_eq(o.bus, "memq://");
	ck_assert_int_eq(parse(&o, "billiard-planner", (char *[]){"program", NULL}), 0);
	ck_assert_str_eq(o.config, config_default_path());
	ck_assert_ptr_null(o.bus);
	ck_assert_int_eq(parse(&o, "billiard-vision", ARGV("--source", "dir:x", "--hold", "0.5")), 0);
	ck_assert_str_eq(o.source, "dir:x");
	ck_assert_double_eq(o.hold, 0.5);
	ck_assert_str_eq(said, "");
}
END_TEST

static void bad_use(const char *name, char **argv)
{
	struct process_options o;
	ck_assert_int_eq(parse(&o, name, argv), -EINVAL);
	ck_assert_msg(strchr(said, '\n') == said + strlen(said) - 1 && said[0], "wanted one line: %s", said);
}

START_TEST(bad_options_give_one_line)
{
	bad_use("billiard-planner", ARGV("--nonsense"));
	bad_use("billiard-planner", ARGV("-c"));
	bad_use("billiard-planner", ARGV("extra"));
	bad_use("billiard-planner", ARGV("--source", "dir:x")); /* vision's */
	static char *const holds[] = {"0", "-1", "x", "1x", "nan", "inf", "4000", ""};
	for (size_t i = 0; i < sizeof holds / sizeof holds[0]; i++)
		bad_use("billiard-vision", ARGV("--hold", holds[i]));
}
END_TEST

/* ---- status ------------------------------------------------------------------------------------------------------ */

static bool on_status(void *context, const void *message)
{
	(void)context;
	status = *(const billiard_status_t *)message;
	statuses++;
	return true;
}

static void setup(void)
{
	statuses = 0;
	ck_assert_int_eq(process_init(&process, "billiard-test", &OPTIONS, &config), 0);
	ck_assert_int_eq(bus_subscribe(process.bus,
				       &(struct bus_subscription){"STATUS", &bus_status, BUS_EACH, on_status, NULL}),
			 0);
}

static void teardown(void)
{
	process_finish(&process);
}

START_TEST(states_are_said_when_they_change)
{
	process_state(&process, "waiting %d", 7);
	process_state(&process, "waiting %d", 7);
	bus_drain(process.bus);
	ck_assert_int_eq(statuses, 1);
	ck_assert_str_eq((const char *)status.state, "waiting 7");
	ck_assert_str_eq((const char *)status.process, "billiard-test");
	ck_assert_int_eq(status.pid, getpid());
	ck_assert(status.utime >= status.started_utime && status.started_utime > 0);
	process_state(&process, "a state whose name is too long for its field");
	bus_drain(process.bus);
	ck_assert_int_eq(statuses, 2);
	ck_assert_str_eq((const char *)status.state, "a state whose name is t");
}
END_TEST

START_TEST(errors_are_kept_and_logged_once)
{
	listen_to_stderr();
	for (int i = 0; i < 5; i++)
		process_error(&process, "the camera is away");
	process_error(&process, "%s", "the camera burns");
	stop_listening();
	ck_assert_str_eq(said, "billiard-test: the camera is away\nbilliard-test: the camera burns\n");
	ck_assert_str_eq((const char *)process.status.error, "the camera burns");
	ck_assert_int_gt(process.status.error_utime, 0);
}
END_TEST

START_TEST(metrics_are_named_once_and_never_too_many)
{
	char name[24];
	for (int round = 0; round < 2; round++)
		for (int i = 0; i < 30; i++) {
			snprintf(name, sizeof name, "metric%d", i);
			process_metric(&process, name, "1/s", i + 100 * round);
		}
	ck_assert_int_eq(process.status.metric_count, 16);
	for (int i = 0; i < 16; i++) {
		snprintf(name, sizeof name, "metric%d", i);
		ck_assert_str_eq((const char *)process.status.metrics[i].name, name);
		ck_assert_double_eq(process.status.metrics[i].value, i + 100);
	}
}
END_TEST

/* ---- loop -------------------------------------------------------------------------------------------------------- */

static int ticks;
static int on_tick(sd_event_source *source, uint64_t usec, void *context)
{
	(void)usec;
	ck_assert_ptr_eq(context, &ticks);
	return ++ticks == 20 ? sd_event_exit(sd_event_source_get_event(source), 3) : 0;
}

static void describe(void *context, struct process *p)
{
	ck_assert_ptr_eq(context, &ticks);
	process_state(p, "described"); /* must not go round in circles */
	process_metric(p, "ticks", "1", ticks);
}

START_TEST(timers_repeat_and_the_exit_status_is_handed_on)
{
	ck_assert_int_eq(process_every(&process, 5000, on_tick, &ticks), 0);
	double begin = clock_seconds();
	ck_assert_int_eq(process_run(&process), 3);
	ck_assert_int_eq(ticks, 20);
	ck_assert_double_gt(clock_seconds() - begin, 0.09);
}
END_TEST

/* As after SIGSTOP or a suspended machine. */
static int on_blocked_tick(sd_event_source *source, uint64_t usec, void *context)
{
	(void)usec;
	double *resumed = context;
	ticks++;
	if (ticks == 1) {
		usleep(400000);
		*resumed = clock_seconds();
	}
	return clock_seconds() - *resumed > 0.1 ? sd_event_exit(sd_event_source_get_event(source), 0) : 0;
}

START_TEST(a_timer_does_not_catch_up_after_a_stop)
{
	double resumed = 0;
	ticks = 0;
	ck_assert_int_eq(process_every(&process, 10000, on_blocked_tick, &resumed), 0);
	process_run(&process);
	/* The first, one that was due meanwhile, and one each 10 ms; with the 40 that were missed it would be more than 50. */
	double took = clock_seconds() - resumed;
	ck_assert_int_le(ticks, 3 + (int)(took / 0.01));
	ck_assert_int_le(ticks, 40);
}
END_TEST

START_TEST(numbers_that_are_none_do_not_silence_a_process)
{
	process_metric(&process, "ratio", "1", NAN);
	process_metric(&process, "rate", "1/s", INFINITY);
	process_state(&process, "odd");
	bus_drain(process.bus);
	ck_assert_int_eq(statuses, 1);
	ck_assert(status.metric_count == 2 && status.metrics[0].value == 0 && status.metrics[1].value == 0);
}
END_TEST

static int on_third_status(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec, (void)context;
	return statuses >= 4 ? kill(getpid(), SIGTERM) : 0;
}

START_TEST(status_comes_every_second_and_sigterm_ends_with_0)
{
	process.describe = describe;
	process.context = &ticks;
	process_every(&process, 20000, on_third_status, NULL);
	double begin = clock_seconds();
	ck_assert_int_eq(process_run(&process), 0);
	double took = clock_seconds() - begin;
	/* "running" and "described" at once, then one a second. */
	ck_assert(took > 0.9 && took < 5);
	bus_drain(process.bus);
	ck_assert_str_eq((const char *)status.state, "stopped");
	ck_assert_int_eq(status.metric_count, 1);
}
END_TEST

START_TEST(ignored_messages_are_counted_and_logged)
{
	billiard_command_t foreign = {.utime = 1};
	bus_publish(process.bus, "STATUS", &bus_command, &foreign);
	process_every(&process, 5000, on_tick, &ticks);
	listen_to_stderr();
	process_run(&process);
	stop_listening();
	ck_assert_ptr_nonnull(strstr(said, "ignored STATUS: foreign or malformed"));
	ck_assert_int_eq(bus_ignored(process.bus), 1);
}
END_TEST

START_TEST(failures_of_the_start_give_one_line)
{
	struct process other;
	struct process_options bad[] = {{.config = "/nowhere.conf"}, {.config = OPTIONS.config, .bus = "nonsense://"}};
	for (size_t i = 0; i < 2; i++) {
		listen_to_stderr();
		int r = process_init(&other, "billiard-test", &bad[i], &config);
		process_finish(&other);
		stop_listening();
		ck_assert_int_lt(r, 0);
		ck_assert_msg(strchr(said, '\n') == said + strlen(said) - 1 &&
				      strncmp(said, "billiard-test: ", 15) == 0,
			      "%s", said);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("process");
	TCase *options = tcase_create("options");
	tcase_add_test(options, options_are_read);
	tcase_add_test(options, bad_options_give_one_line);
	tcase_add_test(options, failures_of_the_start_give_one_line);
	suite_add_tcase(suite, options);
	TCase *running = tcase_create("running");
	tcase_set_timeout(running, 30);
	tcase_add_checked_fixture(running, setup, teardown);
	tcase_add_test(running, states_are_said_when_they_change);
	tcase_add_test(running, errors_are_kept_and_logged_once);
	tcase_add_test(running, metrics_are_named_once_and_never_too_many);
	tcase_add_test(running, numbers_that_are_none_do_not_silence_a_process);
	tcase_add_test(running, a_timer_does_not_catch_up_after_a_stop);
	tcase_add_test(running, timers_repeat_and_the_exit_status_is_handed_on);
	tcase_add_test(running, status_comes_every_second_and_sigterm_ends_with_0);
	tcase_add_test(running, ignored_messages_are_counted_and_logged);
	suite_add_tcase(suite, running);
	return suite;
}
