/* Each program over a real bus: its happy path, wrong use, bad messages, SIGTERM, SIGKILL. */
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/config.h"
#include "app/draw.h"
#include "app/plan_message.h"
#include "app/process.h"
#include "bus_fixture.h"
#include "harness.h"
#include "vision/image_io_cv.h"

enum { PROGRAM_COUNT = 5, STATUS_MAX = 12, TEXT_SIZE = 2000 };
static const char *const programs[PROGRAM_COUNT] = {"billiard-planner", "billiard-projector", "billiard-infinity", "billiard-vision",
						    "billiard-table"};
static struct config config;	/* too large for the stack */
static char conf[128];		/* a configuration for quick tests */
static struct bus *bus;

/* ---- what was heard ------------------------------------------------------------------------------------------------- */

static struct {
	billiard_status_t status[STATUS_MAX];	/* the newest of each process */
	int status_count;
	billiard_plan_request_t request;
	billiard_plan_t plan;
	billiard_draw_list_t draw;
	billiard_table_state_t state;
	int64_t requests, plans, draws, states;
} heard;

static bool on_status(void *context, const void *message)
{
	(void)context;
	const billiard_status_t *s = message;
	int i = 0;
	while (i < heard.status_count && heard.status[i].pid != s->pid)
		i++;
	ck_assert_int_lt(i, STATUS_MAX);
	heard.status_count += i == heard.status_count;
	heard.status[i] = *s;
	return true;
}

#define HEAR(name, type)                                                                                                    \
	static bool on_##name(void *context, const void *message)                                                          \
	{                                                                                                                  \
		(void)context;                                                                                             \
		heard.name = *(const type *)message;                                                                       \
		heard.name##s++;                                                                                           \
		return true;                                                                                               \
	}
HEAR(request, billiard_plan_request_t)
HEAR(plan, billiard_plan_t)
HEAR(draw, billiard_draw_list_t)
HEAR(state, billiard_table_state_t)

static void listen_to_all(struct bus *b)
{
	ck_assert_int_eq(bus_subscribe(b, "STATUS", &bus_status, BUS_EACH, on_status, NULL), 0);
	ck_assert_int_eq(bus_subscribe(b, "PLAN_REQUEST", &bus_plan_request, BUS_EACH, on_request, NULL), 0);
	ck_assert_int_eq(bus_subscribe(b, "PLAN", &bus_plan, BUS_EACH, on_plan, NULL), 0);
	ck_assert_int_eq(bus_subscribe(b, "DRAW", &bus_draw_list, BUS_EACH, on_draw, NULL), 0);
	ck_assert_int_eq(bus_subscribe(b, "TABLE_STATE", &bus_table_state, BUS_EACH, on_state, NULL), 0);
}

/* The shipped table, but played fast, with all services on the virtual camera. */
static void write_conf(void)
{
	char command[1600], cwd[512];
	ck_assert_ptr_nonnull(getcwd(cwd, sizeof cwd));
	snprintf(conf, sizeof conf, "%s", fixture_file("table.conf"));
	snprintf(command, sizeof command,
		 "sed -e 's#\"colours.json\"#\"%s/config/colours.json\"#' -e 's/v4l2:.dev.video0/lcm:CAMERA/' -e 's/think_time = [0-9.]*/think_time = 300/' "
		 "-e 's/time_scale = [0-9.]*/time_scale = 8/' -e 's/still_frames = [0-9]*/still_frames = 5/' -e 's/error_angle = [0-9.]*/error_angle = 0/' "
		 "-e 's/name = \"billiard-table\"; arguments = \"\"; enabled = false/name = \"billiard-table\"; arguments = \"\"; enabled = true/' "
		 "-e 's/plan_timeout = [0-9.]*/plan_timeout = 1000/' -e 's/budget = 2000/budget = 300/' config/thesis-table.conf >%s",
		 cwd, conf);
	ck_assert_int_eq(system(command), 0);
}

static void setup(void)
{
	char err[640];
	memset(&heard, 0, sizeof heard);
	write_conf();
	ck_assert_msg(config_load(&config, conf, err, sizeof err) == 0, "%s", err);
	bus = fixture_bus();
	listen_to_all(bus);
}

static void teardown(void)
{
	bus_close(bus);
	fixture_cleanup();
}

static const billiard_status_t *status_of(pid_t pid)
{
	for (int i = 0; i < heard.status_count; i++)
		if (heard.status[i].pid == pid)
			return &heard.status[i];
	return NULL;
}

static double metric_of(pid_t pid, const char *name)
{
	const billiard_status_t *s = status_of(pid);
	for (int i = 0; s && i < s->metric_count; i++)
		if (strcmp((const char *)s->metrics[i].name, name) == 0)
			return s->metrics[i].value;
	return NAN;
}

static pid_t awaited;
static int64_t threshold;
static bool is_there(void)
{
	const billiard_status_t *s = status_of(awaited);
	return s && s->state[0] && strcmp((const char *)s->state, "starting") != 0;
}

static pid_t start(const char *program)
{
	awaited = fixture_start(program, (const char *[]){"-c", conf, NULL});
	char said[TEXT_SIZE];
	bool there = fixture_wait(bus, is_there, 10);
	fixture_said(awaited, 2, said, sizeof said);
	ck_assert_msg(there, "%s: %s", program, said);
	return awaited;
}

/* Ends with that status, having said one line that contains text. */
static void refused(const char *program, const char *const *arguments, const char *text)
{
	char said[TEXT_SIZE];
	pid_t pid = fixture_start(program, arguments);
	int status = fixture_end(pid, 10);
	fixture_said(pid, 2, said, sizeof said);
	size_t length = strlen(said);
	ck_assert_msg(status == 2 && length > 1 && strchr(said, '\n') == said + length - 1 && strstr(said, text),
		      "%s: status %d, wanted one line with \"%s\": %s", program, status, text, said);
	fixture_said(pid, 1, said, sizeof said);
	ck_assert_str_eq(said, "");
}

/* ---- all alike ------------------------------------------------------------------------------------------------------ */

START_TEST(wrong_use_gives_one_line_and_status_2)
{
	const char *program = programs[_i];
	char path[160];
	refused(program, (const char *[]){"-c", "/nowhere.conf", NULL}, "/nowhere.conf");
	refused(program, (const char *[]){"-c", conf, "extra", NULL}, "extra");
	refused(program, (const char *[]){"--nonsense", NULL}, "nonsense");
	refused(program, (const char *[]){"-c", conf, "--bus", "udpm://999.1.1.1:7667", NULL}, "999.1.1.1");
	snprintf(path, sizeof path, "%s", fixture_file("bad.conf"));
	char command[400];
	snprintf(command, sizeof command, "sed 's/still_frames = 5/still_frames = \"many\"/' %s >%s", conf, path);
	ck_assert_int_eq(system(command), 0);
	refused(program, (const char *[]){"-c", path, NULL}, "still_frames");
}
END_TEST

/* What each program listens to. */
static const char *const inputs[PROGRAM_COUNT][4] = {
	{"PLAN_REQUEST", "COMMAND"}, {"DRAW", "ANIMATION", "COMMAND"}, {"TABLE_STATE", "PLAN", "COMMAND"}, {"CAMERA"}, {"DRAW", "PLAN", "ANIMATION"}};

/* Random, truncated, empty, and one of another program's kind: 21 in all. */
static void publish_junk(const char *channel, struct random *random)
{
	uint8_t junk[3000];
	billiard_status_t foreign = {.utime = 1};
	for (int i = 0; i < 20; i++) {
		for (size_t k = 0; k < sizeof junk; k++)
			junk[k] = (uint8_t)random_u64(random);
		struct raw_message raw = {junk, i < 10 ? (int)(random_u64(random) % sizeof junk) : i};
		ck_assert_int_eq(bus_publish(bus, channel, &bus_raw, &raw), 0);
	}
	bus_publish(bus, channel, &bus_status, &foreign);
}

static bool has_stopped(void)
{
	return strcmp((const char *)status_of(awaited)->state, "stopped") == 0;
}

static bool has_ignored(void)
{
	const billiard_status_t *s = status_of(awaited);
	return s && s->ignored == threshold;
}

START_TEST(malformed_messages_are_counted_and_sigterm_ends_in_a_second)
{
	struct random random = random_begin("services malformed");
	const char *const *channel = inputs[_i];
	pid_t pid = start(programs[_i]);
	for (threshold = 0; *channel; channel++, threshold += 21)
		publish_junk(*channel, &random);
	ck_assert(fixture_wait(bus, has_ignored, 5));
	ck_assert_ptr_nonnull(strstr((const char *)status_of(pid)->error, channel[-1]));
	kill(pid, SIGTERM);
	ck_assert_int_eq(fixture_end(pid, 1), 0);
	ck_assert(fixture_wait(bus, has_stopped, 1));
	ck_assert_int_eq(status_of(pid)->ignored, threshold);
}
END_TEST

/* ---- planner -------------------------------------------------------------------------------------------------------- */

static bool final_plan(void)
{
	return heard.plan.is_final && heard.plan.request_id == threshold;
}

static void ask(int64_t id, int balls)
{
	static const struct { enum ball_colour colour; vec2 at; } ball[] = {
		{COLOUR_WHITE, {-0.3, 0}}, {COLOUR_RED, {0.35, 0.2}}, {COLOUR_BLUE, {0, 0.1}}};
	billiard_plan_request_t request = {.id = id, .ball_count = balls, .depth = 1, .max_balls = 1, .speeds = 1, .plans = 3};
	for (int i = 0; i < 3; i++) {
		struct ball b = ball_at(ball[i].colour, ball[i].at);
		ball_to_message(&request.balls[i], &b, "", i + 1);
	}
	bus_publish(bus, "PLAN_REQUEST", &bus_plan_request, &request);
	threshold = id;
	ck_assert(fixture_wait(bus, final_plan, 10));
	ck_assert(plan_message_check(&heard.plan, &config.table));
}

START_TEST(the_planner_answers_or_refuses)
{
	pid_t pid = start("billiard-planner");
	ask(5, 3);
	ck_assert_int_eq(heard.plan.status, PLAN_MESSAGE_OK);
	ask(6, 77);
	ck_assert_int_eq(heard.plan.status, PLAN_MESSAGE_REFUSED);
	ck_assert_ptr_nonnull(strstr((const char *)heard.plan.reason, "ball_count"));
	kill(pid, SIGKILL);
	ck_assert_int_eq(fixture_end(pid, 1), 128 + SIGKILL);
	start("billiard-planner");
	ask(5, 3);
	ck_assert_int_eq(heard.plan.status, PLAN_MESSAGE_OK);
}
END_TEST

/* ---- infinity ------------------------------------------------------------------------------------------------------- */

static double next_frame;
static void play_vision(void)
{
	static int64_t seq;
	if (process_seconds(NULL) < next_frame)
		return;
	next_frame = process_seconds(NULL) + 0.03;
	billiard_table_state_t state = {.utime = process_utime(), .seq = ++seq, .calibration = 1, .ball_count = 3};
	static const struct { enum ball_colour colour; vec2 at; } ball[] = {
		{COLOUR_WHITE, {-0.3, 0}}, {COLOUR_RED, {0.35, 0.2}}, {COLOUR_BLUE, {0, 0.1}}};
	for (int i = 0; i < 3; i++) {
		struct ball b = ball_at(ball[i].colour, ball[i].at);
		ball_to_message(&state.balls[i], &b, "", i + 1);
	}
	bus_publish(bus, "TABLE_STATE", &bus_table_state, &state);
}

static bool requested(void)
{
	play_vision();
	return heard.requests > 0;
}

static bool shown(void)
{
	play_vision();
	return heard.draw.plan_id == threshold;
}

static bool is_showing(void)
{
	play_vision();
	return strcmp((const char *)status_of(awaited)->state, "SHOWING") == 0;
}

static bool drawn(void)
{
	return heard.draws > 0;
}

START_TEST(infinity_asks_for_a_resting_table_and_draws_the_answer)
{
	pid_t pid = start("billiard-infinity");
	ck_assert(fixture_wait(bus, requested, 5));
	threshold = heard.request.id;
	ck_assert_int_gt(threshold, 0);
	start("billiard-planner");	/* it started late: the request is repeated */
	ck_assert(fixture_wait(bus, shown, 10));
	ck_assert(draw_check(&heard.draw) && heard.draw.item_count > 0);
	awaited = pid;
	ck_assert(fixture_wait(bus, is_showing, 2));
}
END_TEST

/* Whoever comes late sees the whole picture soon. */
START_TEST(a_late_listener_gets_a_complete_picture_within_two_seconds)
{
	start("billiard-infinity");
	for (int i = 0; i < 2; i++) {
		bus_close(bus);
		bus = fixture_bus();
		heard.draws = 0;
		listen_to_all(bus);
		ck_assert(fixture_wait(bus, drawn, 2));
		ck_assert(draw_check(&heard.draw));
	}
}
END_TEST

/* ---- projector ------------------------------------------------------------------------------------------------------ */

static struct image_buffer picture;
static char picture_path[160];
static bool picture_is_there(void)
{
	char err[300];
	return image_read(picture_path, &picture, err, sizeof err) == 0;
}

static void snapshot(const char *name)
{
	billiard_command_t command = {.utime = process_utime()};
	snprintf(picture_path, sizeof picture_path, "%s", fixture_file(name));
	bus_set_text(command.name, sizeof command.name, "snapshot");
	bus_set_text(command.argument, sizeof command.argument, picture_path);
	bus_publish(bus, "COMMAND", &bus_command, &command);
}

static bool has_error(void)
{
	const billiard_status_t *s = status_of(awaited);
	return s && strstr((const char *)s->error, "snapshot");
}

static bool drew(void)
{
	return metric_of(awaited, "items") == 1;
}

START_TEST(the_projector_draws_what_it_is_told)
{
	pid_t pid = start("billiard-projector");
	billiard_draw_list_t list;
	memset(&list, 0, sizeof list);
	draw_clear(&list);
	draw_disc(&list, (vec2){0.2, 0.1}, 0.05, 0xff8000ff);
	bus_publish(bus, "DRAW", &bus_draw_list, &list);
	list.item_count = 9999;		/* is ignored */
	bus_publish(bus, "DRAW", &bus_draw_list, &list);
	ck_assert(fixture_wait(bus, drew, 5));
	snapshot("picture.png");
	ck_assert(fixture_wait(bus, picture_is_there, 5));
	ck_assert_int_eq(picture.image.width, config.projector.width);
	/* Where the homography puts it: 900 px a metre, y up. */
	const uint8_t *p = picture.image.data + (540 - 90) * picture.image.stride + 3 * (960 + 180);
	ck_assert(p[0] == 0 && p[1] == 0x80 && p[2] == 0xff);
	const uint8_t *q = picture.image.data + 100 * picture.image.stride + 300;
	ck_assert(q[0] == 0 && q[1] == 0 && q[2] == 0);
	snapshot("no/such/folder.png");
	awaited = pid;
	ck_assert(fixture_wait(bus, has_error, 5));
	image_buffer_finish(&picture);
}
END_TEST

/* ---- vision --------------------------------------------------------------------------------------------------------- */

static bool saw_nothing(void)
{
	return heard.states > 0 && heard.state.calibration == 0 && strstr((const char *)heard.state.reason, "marker");
}

static void publish_camera(const void *jpeg, size_t size)
{
	billiard_image_t image = {process_utime(), 1, 1280, 720, (int32_t)size, (uint8_t *)jpeg};
	bus_publish(bus, "CAMERA", &bus_image, &image);
}

START_TEST(vision_refuses_sources_that_are_none)
{
	char empty[200];
	snprintf(empty, sizeof empty, "dir:%s", fixture_file(""));
	refused("billiard-vision", (const char *[]){"-c", conf, "--source", empty, NULL}, "the folder holds no");
	refused("billiard-vision", (const char *[]){"-c", conf, "--source", "dir:/nowhere", NULL}, "/nowhere");
	refused("billiard-vision", (const char *[]){"-c", conf, "--source", "file:/nowhere.avi", NULL}, "/nowhere.avi");
	refused("billiard-vision", (const char *[]){"-c", conf, "--source", "lcm:", NULL}, "lcm:");
	refused("billiard-vision", (const char *[]){"-c", conf, "--source", "lcm:[", NULL}, "lcm:[");
	refused("billiard-vision", (const char *[]){"-c", conf, "--source", "telepathy:1", NULL}, "telepathy");
	refused("billiard-vision", (const char *[]){"-c", conf, "--hold", "-1", NULL}, "--hold");
}
END_TEST

START_TEST(vision_says_why_it_is_not_calibrated)
{
	struct image_buffer grey = {0};
	struct byte_buffer jpeg = {0};
	char err[300];
	pid_t pid = start("billiard-vision");
	publish_camera("this is no JPEG at all", 22);
	ck_assert_int_eq(image_buffer_reserve(&grey, 1280, 720), 0);
	memset(grey.image.data, 90, (size_t)(grey.image.stride * 720));
	ck_assert_int_eq(image_encode_jpeg(&grey.image, 90, &jpeg, err, sizeof err), 0);
	publish_camera(jpeg.data, jpeg.size);
	ck_assert(fixture_wait(bus, saw_nothing, 10));
	ck_assert_int_eq(heard.state.ball_count, 0);
	awaited = pid;
	threshold = 1;
	ck_assert(fixture_wait(bus, has_ignored, 5));
	ck_assert_str_eq((const char *)status_of(pid)->state, "not calibrated");
	image_buffer_finish(&grey);
	byte_buffer_finish(&jpeg);
}
END_TEST

/* ---- the loop ------------------------------------------------------------------------------------------------------- */

static bool proposal_newer(void)
{
	return heard.draw.plan_id > threshold;
}

static bool sees_balls(void)
{
	return heard.state.calibration != 0 && heard.state.ball_count >= 15;
}

/* Killing any one and starting it again brings proposals back; nobody else is touched. */
START_TEST(the_loop_survives_the_death_of_each)
{
	pid_t pid[PROGRAM_COUNT];
	for (int i = 0; i < PROGRAM_COUNT; i++)
		pid[i] = start(programs[i]);
	ck_assert_msg(fixture_wait(bus, sees_balls, 15), "%d balls, %s", heard.state.ball_count, heard.state.reason);
	for (int i = 0; i < PROGRAM_COUNT; i++) {
		/* A request made after the restart. */
		kill(pid[i], SIGKILL);
		ck_assert_int_eq(fixture_end(pid[i], 2), 128 + SIGKILL);
		pid[i] = start(programs[i]);
		threshold = process_utime();
		ck_assert_msg(fixture_wait(bus, proposal_newer, 30), "no proposal after the restart of %s; infinity is %s, %d balls",
			      programs[i], status_of(pid[2])->state, heard.state.ball_count);
		for (int k = 0; k < PROGRAM_COUNT; k++)
			ck_assert_msg(kill(pid[k], 0) == 0, "%s died with %s", programs[k], programs[i]);
	}
	for (int i = 0; i < PROGRAM_COUNT; i++)
		kill(pid[i], SIGTERM);
	for (int i = 0; i < PROGRAM_COUNT; i++) {
		char said[TEXT_SIZE];
		int status = fixture_end(pid[i], 2);
		fixture_said(pid[i], 2, said, sizeof said);
		ck_assert_msg(status == 0, "%s: status %d: %s", programs[i], status, said);
	}
}
END_TEST

/* ---- billiard run, status, control ---------------------------------------------------------------------------------- */

static pid_t pid_of(const char *program)
{
	for (int i = heard.status_count - 1; i >= 0; i--)
		if (strcmp((const char *)heard.status[i].process, program) == 0 && strcmp((const char *)heard.status[i].state, "stopped") != 0)
			return heard.status[i].pid;
	return 0;
}

static bool all_run(void)
{
	for (int i = 0; i < PROGRAM_COUNT; i++)
		if (!pid_of(programs[i]))
			return false;
	return true;
}

static bool started_again(void)
{
	return pid_of("billiard-planner") != (pid_t)threshold;
}

static bool is_paused(void)
{
	const billiard_status_t *s = status_of(pid_of("billiard-infinity"));
	return s && strcmp((const char *)s->state, "PAUSED") == 0;
}

/* Runs a command to its end; its status, and what it said on stdout. */
static int call(const char *const *arguments, char *said)
{
	pid_t pid = fixture_start("billiard", arguments);
	int status = fixture_end(pid, 20);
	fixture_said(pid, 1, said, TEXT_SIZE);
	return status;
}

START_TEST(run_starts_all_restarts_one_and_stops_all)
{
	char said[TEXT_SIZE];
	pid_t run = fixture_start("billiard", (const char *[]){"run", "-c", conf, NULL});
	ck_assert(fixture_wait(bus, all_run, 15));
	ck_assert_int_eq(call((const char *[]){"status", "-c", conf, "--json", NULL}, said), 0);
	for (int i = 0; i < PROGRAM_COUNT; i++)
		ck_assert_msg(strstr(said, programs[i]) != NULL, "no %s in %s", programs[i], said);
	ck_assert_ptr_null(strstr(said, "silent"));
	threshold = pid_of("billiard-planner");
	kill((pid_t)threshold, SIGKILL);
	ck_assert(fixture_wait(bus, started_again, 5));
	ck_assert_int_eq(call((const char *[]){"control", "-c", conf, "pause", NULL}, said), 0);
	ck_assert(fixture_wait(bus, is_paused, 3));
	kill(run, SIGINT);
	ck_assert_int_eq(fixture_end(run, 4), 0);
	for (int i = 0; i < heard.status_count; i++)
		ck_assert_msg(kill(heard.status[i].pid, 0) < 0, "%s stays", heard.status[i].process);
}
END_TEST

static bool all_gone(void)
{
	for (int i = 0; i < heard.status_count; i++)
		if (kill(heard.status[i].pid, 0) == 0)
			return false;
	return true;
}

START_TEST(no_service_outlives_a_killed_run)
{
	pid_t run = fixture_start("billiard", (const char *[]){"run", "-c", conf, NULL});
	ck_assert(fixture_wait(bus, all_run, 15));
	kill(run, SIGKILL);
	ck_assert_int_eq(fixture_end(run, 1), 128 + SIGKILL);
	ck_assert(fixture_wait(bus, all_gone, 5));
}
END_TEST

START_TEST(run_gives_up_when_no_service_can_start)
{
	char said[TEXT_SIZE];
	pid_t run = fixture_start("billiard", (const char *[]){"run", "-c", conf, "--bus", "udpm://999.1.1.1:7667", NULL});
	ck_assert_int_eq(fixture_end(run, 10), 2);
	fixture_said(run, 2, said, sizeof said);
	ck_assert_ptr_nonnull(strstr(said, "999.1.1.1"));
	ck_assert_ptr_nonnull(strstr(said, "not started again"));
}
END_TEST

START_TEST(status_says_who_is_silent)
{
	char said[TEXT_SIZE];
	start("billiard-planner");
	ck_assert_int_eq(call((const char *[]){"status", "-c", conf, NULL}, said), 1);
	ck_assert_ptr_nonnull(strstr(said, "billiard-planner"));
	const char *line = strstr(said, "billiard-vision");
	ck_assert(line && strstr(line, "silent"));
}
END_TEST

START_TEST(wrong_use_of_the_bus_commands)
{
	refused("billiard", (const char *[]){"run", "-c", "/nowhere.conf", NULL}, "/nowhere.conf");
	refused("billiard", (const char *[]){"run", "-c", conf, "extra", NULL}, "extra");
	refused("billiard", (const char *[]){"status", "-c", "/nowhere.conf", NULL}, "/nowhere.conf");
	refused("billiard", (const char *[]){"status", "-c", conf, "--seconds", "soon", NULL}, "--seconds");
	refused("billiard", (const char *[]){"status", "-c", conf, "--bus", "nonsense", NULL}, "nonsense");
	refused("billiard", (const char *[]){"control", "-c", conf, NULL}, "name");
	refused("billiard", (const char *[]){"control", "-c", conf, "a", "b", "c", NULL}, "name");
}
END_TEST

Suite *test_suite(void)
{
	fixture_begin();
	Suite *suite = suite_create("services");
	TCase *each = tcase_create("each");
	tcase_set_timeout(each, 60);
	tcase_add_checked_fixture(each, setup, teardown);
	tcase_add_loop_test(each, wrong_use_gives_one_line_and_status_2, 0, PROGRAM_COUNT);
	tcase_add_loop_test(each, malformed_messages_are_counted_and_sigterm_ends_in_a_second, 0, PROGRAM_COUNT);
	tcase_add_test(each, the_planner_answers_or_refuses);
	tcase_add_test(each, infinity_asks_for_a_resting_table_and_draws_the_answer);
	tcase_add_test(each, a_late_listener_gets_a_complete_picture_within_two_seconds);
	tcase_add_test(each, the_projector_draws_what_it_is_told);
	tcase_add_test(each, vision_refuses_sources_that_are_none);
	tcase_add_test(each, vision_says_why_it_is_not_calibrated);
	suite_add_tcase(suite, each);
	TCase *commands = tcase_create("commands");
	tcase_set_timeout(commands, 60);
	tcase_add_checked_fixture(commands, setup, teardown);
	tcase_add_test(commands, run_starts_all_restarts_one_and_stops_all);
	tcase_add_test(commands, no_service_outlives_a_killed_run);
	tcase_add_test(commands, run_gives_up_when_no_service_can_start);
	tcase_add_test(commands, status_says_who_is_silent);
	tcase_add_test(commands, wrong_use_of_the_bus_commands);
	suite_add_tcase(suite, commands);
	TCase *loop = tcase_create("loop");
	tcase_set_timeout(loop, 200);
	tcase_add_checked_fixture(loop, setup, teardown);
	tcase_add_test(loop, the_loop_survives_the_death_of_each);
	suite_add_tcase(suite, loop);
	return suite;
}
