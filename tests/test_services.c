/* Each program over a real bus: its happy path, wrong use, bad messages, SIGTERM, SIGKILL. */
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/process/ball_message.h"
#include "app/planner/plan_check.h"
#include "app/light/draw.h"
#include "app/planner/plan_message.h"
#include "app/process/process.h"
#include "harness.h"
#include "service_fixture.h"
#include "vision/image_io_cv.h"

static pid_t awaited;
static int64_t threshold;

static double metric_of(pid_t pid, const char *name)
{
	const billiard_status_t *s = service_status(pid);
	for (int i = 0; s && i < s->metric_count; i++)
		if (strcmp((const char *)s->metrics[i].name, name) == 0)
			return s->metrics[i].value;
	return NAN;
}

/* ---- all alike --------------------------------------------------------------------------------------------------- */

START_TEST(wrong_use_gives_one_line_and_status_2)
{
	const char *program = programs[_i];
	char path[160];
	service_refused(program, (const char *[]){"-c", "/nowhere.conf", NULL}, "/nowhere.conf");
	service_refused(program, (const char *[]){"-c", conf, "extra", NULL}, "extra");
	service_refused(program, (const char *[]){"--nonsense", NULL}, "nonsense");
	service_refused(program, (const char *[]){"-c", conf, "--bus", "udpm://999.1.1.1:7667", NULL}, "999.1.1.1");
	snprintf(path, sizeof path, "%s", fixture_file("bad.conf"));
	char command[400];
	snprintf(command, sizeof command, "sed 's/still_time = 250/still_time = \"many\"/' %s >%s", conf, path);
	ck_assert_int_eq(system(command), 0);
	service_refused(program, (const char *[]){"-c", path, NULL}, "still_time");
}
END_TEST

/* What each program listens to. */
static const char *const inputs[PROGRAM_COUNT][4] = {{"PLAN_REQUEST", "COMMAND"},
						     {"DRAW", "ANIMATION", "COMMAND"},
						     {"TABLE_STATE", "PLAN", "COMMAND"},
						     {"CAMERA"},
						     {"DRAW", "PLAN", "ANIMATION"}};

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
	return strcmp((const char *)service_status(awaited)->state, "stopped") == 0;
}

static bool has_ignored(void)
{
	const billiard_status_t *s = service_status(awaited);
	return s && s->ignored == threshold;
}

START_TEST(malformed_messages_are_counted_and_sigterm_ends_in_a_second)
{
	struct random random = random_begin("services malformed");
	const char *const *channel = inputs[_i];
	pid_t pid = awaited = service_start(programs[_i]);
	for (threshold = 0; *channel; channel++, threshold += 21)
		publish_junk(*channel, &random);
	ck_assert(fixture_wait(bus, has_ignored, 5));
	ck_assert_ptr_nonnull(strstr((const char *)service_status(pid)->error, channel[-1]));
	kill(pid, SIGTERM);
	ck_assert_int_eq(fixture_end(pid, 1), 0);
	ck_assert(fixture_wait(bus, has_stopped, 1));
	ck_assert_int_eq(service_status(pid)->ignored, threshold);
}
END_TEST

static atomic_bool flooding;

/* Bad and foreign messages as fast as they go. */
static void *flood(void *context)
{
	billiard_table_state_t foreign = {.utime = 1};
	struct raw_message junk = {"junk", 4};
	while (atomic_load(&flooding)) {
		bus_publish(context, "COMMAND", &bus_table_state, &foreign);
		bus_publish(context, "COMMAND", &bus_raw, &junk);
	}
	return NULL;
}

static bool has_ignored_many(void)
{
	const billiard_status_t *s = service_status(awaited);
	return s && s->ignored > 5000 && s->utime > threshold;
}

START_TEST(a_flood_keeps_nobody_from_timers_and_signals)
{
	pthread_t thread;
	struct bus *other = fixture_bus();
	pid_t pid = awaited = service_start("billiard-infinity");
	atomic_store(&flooding, true);
	ck_assert_int_eq(pthread_create(&thread, NULL, flood, other), 0);
	/* STATUS and DRAW go on meanwhile. */
	threshold = clock_utime() + 1500000;
	ck_assert(fixture_wait(bus, has_ignored_many, 20));
	ck_assert_int_ge(heard.draws, 2);
	kill(pid, SIGTERM);
	ck_assert_int_eq(fixture_end(pid, 1), 0);
	atomic_store(&flooding, false);
	pthread_join(thread, NULL);
	bus_close(other);
}
END_TEST

/* ---- planner ----------------------------------------------------------------------------------------------------- */

static bool final_plan(void)
{
	return heard.plan.is_final && heard.plan.request_id == threshold;
}

static void ask(int64_t id, int balls)
{
	static const struct {
		enum ball_colour colour;
		vec2 at;
	} ball[] = {{COLOUR_WHITE, {-0.3, 0}}, {COLOUR_RED, {0.35, 0.2}}, {COLOUR_BLUE, {0, 0.1}}};
	billiard_plan_request_t request = {
		.id = id, .ball_count = balls, .depth = 1, .max_balls = 1, .speeds = 1, .plans = 3};
	for (int i = 0; i < 3; i++) {
		struct ball b = ball_at(ball[i].colour, ball[i].at);
		ball_to_message(&request.balls[i], &b, "", i + 1);
	}
	bus_publish(bus, "PLAN_REQUEST", &bus_plan_request, &request);
	threshold = id;
	ck_assert(fixture_wait(bus, final_plan, 10));
	ck_assert(plan_check(&heard.plan, &config.table));
}

START_TEST(the_planner_answers_or_refuses)
{
	pid_t pid = service_start("billiard-planner");
	ask(5, 3);
	ck_assert_int_eq(heard.plan.status, PLAN_MESSAGE_OK);
	ask(6, 77);
	ck_assert_int_eq(heard.plan.status, PLAN_MESSAGE_REFUSED);
	ck_assert_ptr_nonnull(strstr((const char *)heard.plan.reason, "ball_count"));
	kill(pid, SIGKILL);
	ck_assert_int_eq(fixture_end(pid, 1), 128 + SIGKILL);
	service_start("billiard-planner");
	ask(5, 3);
	ck_assert_int_eq(heard.plan.status, PLAN_MESSAGE_OK);
}
END_TEST

/* ---- infinity ---------------------------------------------------------------------------------------------------- */

static double next_frame;
static void play_vision(void)
{
	static int64_t frames;
	if (clock_seconds() < next_frame)
		return;
	next_frame = clock_seconds() + 0.03;
	frames++;
	billiard_table_state_t state = {.utime = clock_utime(), .seq = frames, .calibration = 1, .ball_count = 3};
	static const struct {
		enum ball_colour colour;
		vec2 at;
	} ball[] = {{COLOUR_WHITE, {-0.3, 0}}, {COLOUR_RED, {0.35, 0.2}}, {COLOUR_BLUE, {0, 0.1}}};
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
	return strcmp((const char *)service_status(awaited)->state, "SHOWING") == 0;
}

static bool drawn(void)
{
	return heard.draws > 0;
}

START_TEST(infinity_asks_for_a_resting_table_and_draws_the_answer)
{
	pid_t pid = service_start("billiard-infinity");
	ck_assert(fixture_wait(bus, requested, 5));
	threshold = heard.request.id;
	ck_assert_int_gt(threshold, 0);
	service_start("billiard-planner"); /* it started late: the request is repeated */
	ck_assert(fixture_wait(bus, shown, 10));
	ck_assert(draw_check(&heard.draw) && heard.draw.item_count > 0);
	awaited = pid;
	ck_assert(fixture_wait(bus, is_showing, 2));
}
END_TEST

/* Whoever comes late sees the whole picture soon. */
START_TEST(a_late_listener_gets_a_complete_picture_within_two_seconds)
{
	service_start("billiard-infinity");
	for (int i = 0; i < 2; i++) {
		bus_close(bus);
		bus = fixture_bus();
		heard.draws = 0;
		service_listen(bus);
		ck_assert(fixture_wait(bus, drawn, 2));
		ck_assert(draw_check(&heard.draw));
	}
}
END_TEST

/* ---- projector --------------------------------------------------------------------------------------------------- */

static struct image_buffer picture;
static char picture_path[160];
static bool picture_is_there(void)
{
	char err[300];
	return image_read(picture_path, &picture, err, sizeof err) == 0;
}

static void snapshot(const char *name)
{
	billiard_command_t command = {.utime = clock_utime()};
	snprintf(picture_path, sizeof picture_path, "%s", fixture_file(name));
	text_set(command.name, sizeof command.name, "snapshot");
	text_set(command.argument, sizeof command.argument, picture_path);
	bus_publish(bus, "COMMAND", &bus_command, &command);
}

static bool has_error(void)
{
	const billiard_status_t *s = service_status(awaited);
	return s && strstr((const char *)s->error, "snapshot");
}

static bool drew(void)
{
	return metric_of(awaited, "items") == 1;
}

static bool lapsed(void)
{
	const billiard_status_t *s = service_status(awaited);
	return s && strcmp((const char *)s->state, "lease over") == 0;
}

static bool recovered(void)
{
	return !lapsed();
}

static bool infinity_drew(void)
{
	return heard.draws > 0;
}

/* infinity is killed with a picture on the table: the projector blanks it within a second, and says why. A new one brings the light back. */
START_TEST(the_projector_blanks_what_nobody_vouches_for)
{
	pid_t projector = service_start("billiard-projector");
	pid_t infinity = service_start("billiard-infinity");
	ck_assert(fixture_wait(bus, infinity_drew, 3));
	/* Alive: never. */
	awaited = projector;
	ck_assert(!fixture_wait(bus, lapsed, 2));
	kill(infinity, SIGKILL);
	double begin = clock_seconds();
	ck_assert_int_eq(fixture_end(infinity, 2), 128 + SIGKILL);
	ck_assert(fixture_wait(bus, lapsed, 4));
	ck_assert_double_lt(clock_seconds() - begin, 3); /* STATUS comes once a second */
	service_start("billiard-infinity");
	ck_assert(fixture_wait(bus, recovered, 4));
}
END_TEST

START_TEST(the_projector_draws_what_it_is_told)
{
	awaited = service_start("billiard-projector");
	billiard_draw_list_t list;
	memset(&list, 0, sizeof list);
	draw_clear(&list);
	draw_ring(&list, (vec2){0.2, 0.1}, 0.025, 0.06, 0xff8000ff);
	bus_publish(bus, "DRAW", &bus_draw_list, &list);
	list.item_count = 9999; /* is ignored */
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
	ck_assert(fixture_wait(bus, has_error, 5));
	image_buffer_finish(&picture);
}
END_TEST

/* ---- vision ------------------------------------------------------------------------------------------------------ */

static bool saw_nothing(void)
{
	return heard.states > 0 && heard.state.calibration == 0 && strstr((const char *)heard.state.reason, "marker");
}

static void publish_camera(const void *jpeg, size_t size)
{
	billiard_image_t image = {clock_utime(), 1, 1280, 720, (int32_t)size, (uint8_t *)jpeg};
	bus_publish(bus, "CAMERA", &bus_image, &image);
}

START_TEST(vision_refuses_sources_that_are_none)
{
	char empty[200];
	snprintf(empty, sizeof empty, "dir:%s", fixture_file(""));
	service_refused("billiard-vision", (const char *[]){"-c", conf, "--source", empty, NULL},
			"the folder holds no");
	service_refused("billiard-vision", (const char *[]){"-c", conf, "--source", "dir:/nowhere", NULL}, "/nowhere");
	service_refused("billiard-vision", (const char *[]){"-c", conf, "--source", "file:/nowhere.avi", NULL},
			"/nowhere.avi");
	service_refused("billiard-vision", (const char *[]){"-c", conf, "--source", "lcm:", NULL}, "lcm:");
	service_refused("billiard-vision", (const char *[]){"-c", conf, "--source", "lcm:[", NULL}, "lcm:[");
	service_refused("billiard-vision", (const char *[]){"-c", conf, "--source", "telepathy:1", NULL}, "telepathy");
	service_refused("billiard-vision", (const char *[]){"-c", conf, "--hold", "-1", NULL}, "--hold");
}
END_TEST

static bool is_uncalibrated(void)
{
	return strcmp((const char *)service_status(awaited)->state, "not calibrated") == 0;
}

START_TEST(vision_says_why_it_is_not_calibrated)
{
	struct image_buffer grey = {0};
	struct byte_buffer jpeg = {0};
	char err[300];
	pid_t pid = service_start("billiard-vision");
	awaited = pid;
	threshold = 1;
	publish_camera("this is no JPEG at all", 22);
	ck_assert(fixture_wait(bus, has_ignored, 5));
	ck_assert_int_eq(image_buffer_reserve(&grey, 1280, 720), 0);
	memset(grey.image.data, 90, (size_t)(grey.image.stride * 720));
	ck_assert_int_eq(image_encode_jpeg(&grey.image, 90, &jpeg, err, sizeof err), 0);
	publish_camera(jpeg.data, jpeg.size);
	ck_assert(fixture_wait(bus, saw_nothing, 10));
	ck_assert_int_eq(heard.state.ball_count, 0);
	ck_assert(fixture_wait(bus, is_uncalibrated, 5));
	ck_assert_str_eq((const char *)service_status(pid)->state, "not calibrated");
	image_buffer_finish(&grey);
	byte_buffer_finish(&jpeg);
}
END_TEST

Suite *test_suite(void)
{
	fixture_begin();
	Suite *suite = suite_create("services");
	TCase *each = tcase_create("each");
	tcase_set_timeout(each, 60);
	tcase_add_checked_fixture(each, service_setup, service_teardown);
	tcase_add_loop_test(each, wrong_use_gives_one_line_and_status_2, 0, PROGRAM_COUNT);
	tcase_add_loop_test(each, malformed_messages_are_counted_and_sigterm_ends_in_a_second, 0, PROGRAM_COUNT);
	tcase_add_test(each, a_flood_keeps_nobody_from_timers_and_signals);
	tcase_add_test(each, the_planner_answers_or_refuses);
	tcase_add_test(each, infinity_asks_for_a_resting_table_and_draws_the_answer);
	tcase_add_test(each, a_late_listener_gets_a_complete_picture_within_two_seconds);
	tcase_add_test(each, the_projector_blanks_what_nobody_vouches_for);
	tcase_add_test(each, the_projector_draws_what_it_is_told);
	tcase_add_test(each, vision_refuses_sources_that_are_none);
	tcase_add_test(each, vision_says_why_it_is_not_calibrated);
	suite_add_tcase(suite, each);
	return suite;
}
