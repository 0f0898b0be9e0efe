#include "app/process/text.h"
#include "app/process/bus.h"

#include <arpa/inet.h>
#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus_fixture.h"
#include "harness.h"

/* LCM 1.3.1 itself leaks the name of a channel that is no regular expression. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
	return "leak:lcm_subscribe";
}

/* memq:// is LCM within one process: what is published waits for the same bus, in order and without loss. */
static struct bus *bus;
static int64_t handled, last_seq;
static bool welcome = true;

static void setup(void)
{
	char err[300];
	ck_assert_msg(bus_open(&bus, "memq://", err, sizeof err) == 0, "%s", err);
	handled = 0;
	last_seq = -1;
	welcome = true;
}

static void teardown(void)
{
	bus_close(bus);
}

static bool on_state(void *context, const void *message)
{
	ck_assert_ptr_eq(context, &handled);
	last_seq = ((const billiard_table_state_t *)message)->seq;
	handled++;
	return welcome;
}

static bool on_image(void *context, const void *message)
{
	(void)context;
	const billiard_image_t *image = message;
	for (int i = 0; i < image->size; i++)
		ck_assert_uint_eq(image->data[i], (uint8_t)(i * 7));
	last_seq = image->seq;
	handled++;
	return true;
}

static void publish_state(struct bus *to, int64_t seq)
{
	billiard_table_state_t state = {.utime = 1, .seq = seq, .ball_count = 3};
	ck_assert_int_eq(bus_publish(to, "STATE", &bus_table_state, &state), 0);
}

static void publish_raw(const void *bytes, int size)
{
	struct raw_message raw = {bytes, size};
	ck_assert_int_eq(bus_publish(bus, "STATE", &bus_raw, &raw), 0);
}

static void subscribe(enum bus_delivery delivery)
{
	ck_assert_int_eq(
		bus_subscribe(bus, &(struct bus_subscription){"STATE", &bus_table_state, delivery, on_state, &handled}),
		0);
}

/* ---- types ------------------------------------------------------------------------------------------------------- */

static const struct bus_type *const types[] = {&bus_table_state, &bus_plan_request, &bus_plan,	 &bus_draw_list,
					       &bus_animation,	 &bus_command,	    &bus_status, &bus_vision_doubt,
					       &bus_stability,	 &bus_lease,	    &bus_game};
enum { TYPE_COUNT = sizeof types / sizeof types[0] };

/* The hash that begins every message of a type. */
static int empty_message(const struct bus_type *type, uint8_t **bytes)
{
	void *message = calloc(1, type->size);
	ck_assert_ptr_nonnull(message);
	int size = type->encoded_size(message);
	*bytes = malloc((size_t)size);
	ck_assert_int_eq(type->encode(*bytes, 0, size, message), size);
	free(message);
	return size;
}

/* Any bits in the fields of a message come back as they were. */
START_TEST(every_type_keeps_every_bit)
{
	struct random random = random_begin("bus bits");
	for (int t = 0; t < TYPE_COUNT; t++) {
		const struct bus_type *type = types[t];
		uint8_t *bytes, *again;
		int size = empty_message(type, &bytes);
		void *message = calloc(1, type->size);
		again = malloc((size_t)size);
		for (int i = 8; i < size; i++)
			bytes[i] = (uint8_t)random_u64(&random);
		ck_assert_int_eq(type->decode(bytes, 0, size, message), size);
		ck_assert_int_eq(type->encode(again, 0, size, message), size);
		ck_assert_msg(memcmp(bytes, again, (size_t)size) == 0, "%s", type->name);
		type->cleanup(message);
		free(message);
		free(bytes);
		free(again);
	}
}
END_TEST

START_TEST(types_tell_each_other_apart)
{
	for (int a = 0; a < TYPE_COUNT; a++) {
		uint8_t *bytes;
		int size = empty_message(types[a], &bytes);
		for (int b = 0; b < TYPE_COUNT; b++) {
			void *message = calloc(1, types[b]->size);
			if (a != b)
				ck_assert_msg(types[b]->decode(bytes, 0, size, message) < 0, "%s as %s", types[a]->name,
					      types[b]->name);
			free(message);
		}
		free(bytes);
	}
}
END_TEST

/* ---- bad messages ------------------------------------------------------------------------------------------------ */

START_TEST(truncated_messages_are_counted_and_ignored)
{
	uint8_t *bytes;
	int size = empty_message(&bus_table_state, &bytes);
	subscribe(BUS_EACH);
	int64_t sent = 0;
	for (int n = 0; n < size; n += n < 40 ? 1 : 37, sent++)
		publish_raw(bytes, n);
	ck_assert_int_eq(bus_drain(bus), 0);
	ck_assert_int_eq(bus_ignored(bus), sent);
	ck_assert(handled == 0 && bus_received(bus) == 0);
	ck_assert_ptr_nonnull(strstr(bus_last_ignored(bus), "STATE"));
	publish_raw(bytes, size);
	bus_drain(bus);
	ck_assert(handled == 1 && bus_received(bus) == 1 && bus_ignored(bus) == sent);
	free(bytes);
}
END_TEST

START_TEST(foreign_and_too_long_messages_are_counted_and_ignored)
{
	struct random random = random_begin("bus foreign");
	uint8_t *bytes, junk[5000], *longer;
	int64_t sent = 0;
	subscribe(BUS_EACH);
	for (int t = 1; t < TYPE_COUNT; t++, sent++) {
		int size = empty_message(types[t], &bytes);
		publish_raw(bytes, size);
		free(bytes);
	}
	for (int i = 0; i < 200; i++, sent++) {
		for (size_t k = 0; k < sizeof junk; k++)
			junk[k] = (uint8_t)random_u64(&random);
		publish_raw(junk, (int)(random_u64(&random) % sizeof junk));
	}
	int size = empty_message(&bus_table_state, &bytes);
	longer = calloc(1, (size_t)size + 9);
	memcpy(longer, bytes, (size_t)size);
	publish_raw(longer, size + 9);
	ck_assert_int_eq(bus_drain(bus), 0);
	ck_assert_int_eq(bus_ignored(bus), sent + 1);
	ck_assert_int_eq(handled, 0);
	ck_assert_ptr_nonnull(strstr(bus_last_ignored(bus), "too long"));
	free(longer);
	free(bytes);
}
END_TEST

START_TEST(messages_that_the_handler_refuses_are_counted)
{
	subscribe(BUS_EACH);
	welcome = false;
	publish_state(bus, 1);
	publish_state(bus, 2);
	bus_drain(bus);
	ck_assert(handled == 2 && bus_received(bus) == 2 && bus_ignored(bus) == 2);
	ck_assert_ptr_nonnull(strstr(bus_last_ignored(bus), "STATE: contradictory or outdated"));
}
END_TEST

/* image_t is the only type that says itself how long it is. */
START_TEST(images_that_lie_about_their_size_are_ignored)
{
	enum { PIXELS = 100, HEAD = 36 };
	uint8_t data[PIXELS], bytes[HEAD + PIXELS + 8];
	for (int i = 0; i < PIXELS; i++)
		data[i] = (uint8_t)(i * 7);
	billiard_image_t image = {1, 5, 10, 10, PIXELS, data};
	ck_assert_int_eq(bus_image.encoded_size(&image), HEAD + PIXELS);
	bus_image.encode(bytes, 0, sizeof bytes, &image);
	ck_assert_int_eq(bus_subscribe(bus, &(struct bus_subscription){"STATE", &bus_image, BUS_EACH, on_image, NULL}),
			 0);
	static const uint32_t lies[] = {0, 1, PIXELS - 1, PIXELS + 1, 0x7fffffff, 0x80000000, 0xffffffff, 8 << 20};
	int64_t sent = 0;
	for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++, sent++) {
		uint8_t lie[sizeof bytes];
		memcpy(lie, bytes, sizeof lie);
		uint32_t n = htonl(lies[i]);
		memcpy(lie + HEAD - 4, &n, 4);
		publish_raw(lie, HEAD + PIXELS);
	}
	for (int n = 0; n < HEAD + PIXELS; n += 5, sent++)
		publish_raw(bytes, n);
	bus_drain(bus);
	ck_assert(bus_ignored(bus) == sent && handled == 0);
	publish_raw(bytes, HEAD + PIXELS);
	bus_drain(bus);
	ck_assert(handled == 1 && last_seq == 5);
}
END_TEST

START_TEST(images_larger_than_the_limit_are_refused_unread)
{
	size_t size = 36 + (size_t)BUS_IMAGE_MAX + 1;
	uint8_t *bytes = calloc(1, size);
	uint32_t n = htonl(BUS_IMAGE_MAX + 1);
	memcpy(bytes + 32, &n, 4);
	ck_assert(!bus_image.check(bytes, size));
	n = htonl(BUS_IMAGE_MAX);
	memcpy(bytes + 32, &n, 4);
	ck_assert(bus_image.check(bytes, size - 1));
	free(bytes);
}
END_TEST

/* ---- delivery ---------------------------------------------------------------------------------------------------- */

START_TEST(each_comes_in_order)
{
	subscribe(BUS_EACH);
	for (int64_t i = 0; i < 500; i++)
		publish_state(bus, i);
	bus_drain(bus);
	ck_assert(handled == 500 && last_seq == 499);
}
END_TEST

START_TEST(latest_is_the_newest_and_only_it)
{
	subscribe(BUS_LATEST);
	for (int64_t i = 0; i < 500; i++)
		publish_state(bus, i);
	bus_drain(bus);
	ck_assert(handled == 1 && last_seq == 499 && bus_received(bus) == 500);
	bus_drain(bus);
	ck_assert_int_eq(handled, 1);
}
END_TEST

START_TEST(a_bad_message_behind_a_good_one_does_not_cost_it)
{
	uint8_t *bytes;
	int size = empty_message(&bus_table_state, &bytes);
	subscribe(BUS_LATEST);
	publish_state(bus, 42);
	publish_raw(bytes, size - 1);
	publish_raw("x", 1);
	bus_drain(bus);
	ck_assert(handled == 1 && last_seq == 42 && bus_ignored(bus) == 2);
	free(bytes);
}
END_TEST

START_TEST(closing_with_messages_waiting_frees_them)
{
	uint8_t data[3] = {0, 7, 14};
	billiard_image_t image = {1, 5, 1, 1, 3, data};
	ck_assert_int_eq(
		bus_subscribe(bus, &(struct bus_subscription){"STATE", &bus_image, BUS_LATEST, on_image, NULL}), 0);
	for (int i = 0; i < 10; i++)
		bus_publish(bus, "STATE", &bus_image, &image);
	bus_drain(bus);
	for (int i = 0; i < 10; i++)
		bus_publish(bus, "STATE", &bus_image, &image);
	ck_assert_int_eq(handled, 1);
}
END_TEST

/* A type that counts what it holds: each message decoded is freed once, also one that a newer replaces before it was delivered. */
static int held;

static int counting_decode(const void *bytes, int offset, int max, void *message)
{
	int r = bus_table_state.decode(bytes, offset, max, message);
	held += r >= 0;
	return r;
}

static int counting_cleanup(void *message)
{
	held--;
	return bus_table_state.cleanup(message);
}

START_TEST(every_message_decoded_is_freed_once)
{
	struct bus_type counting = bus_table_state;
	uint8_t *bytes;
	int size = empty_message(&bus_table_state, &bytes);
	uint8_t *longer = calloc(1, (size_t)size + 1);
	memcpy(longer, bytes, (size_t)size);
	counting.decode = counting_decode;
	counting.cleanup = counting_cleanup;
	held = 0;
	struct bus_subscription s = {"STATE", &counting, BUS_LATEST, on_state, &handled};
	ck_assert_int_eq(bus_subscribe(bus, &s), 0);
	for (int64_t i = 0; i < 10; i++)
		publish_state(bus, i);
	publish_raw(longer, size + 1);
	bus_drain(bus);
	ck_assert(handled == 1 && held == 0);
	welcome = false;
	publish_state(bus, 11);
	bus_drain(bus);
	ck_assert(handled == 2 && held == 0);
	billiard_table_state_t wrong = {.ball_count = 23};
	bus_publish(bus, "STATE", &bus_table_state, &wrong);
	bus_drain(bus);
	ck_assert(handled == 2 && held == 0);
	free(longer);
	free(bytes);
}
END_TEST

/* ---- what was ignored -------------------------------------------------------------------------------------------- */

static struct {
	int count;
	enum bus_fault fault;
	char channel[64], reason[128];
	int64_t seq; /* of the message, -1: none */
} ignored;

static void on_ignored(void *context, const struct bus_ignored *what)
{
	ck_assert_ptr_eq(context, &ignored);
	ignored.count++;
	ignored.fault = what->fault;
	snprintf(ignored.channel, sizeof ignored.channel, "%s", what->channel);
	snprintf(ignored.reason, sizeof ignored.reason, "%s", what->reason);
	ignored.seq = what->message ? ((const billiard_table_state_t *)what->message)->seq : -1;
}

START_TEST(what_is_ignored_is_told_with_its_fault)
{
	memset(&ignored, 0, sizeof ignored);
	subscribe(BUS_EACH);
	bus_on_ignored(bus, on_ignored, &ignored);
	publish_raw("x", 1);
	bus_drain(bus);
	ck_assert(ignored.count == 1 && ignored.fault == BUS_MALFORMED && ignored.seq == -1);
	ck_assert_str_eq(ignored.channel, "STATE");
	ck_assert_str_eq(ignored.reason, "foreign or malformed, 1 bytes");
	billiard_table_state_t wrong = {.seq = 5, .ball_count = 23};
	bus_publish(bus, "STATE", &bus_table_state, &wrong);
	bus_drain(bus);
	ck_assert(ignored.count == 2 && ignored.fault == BUS_RANGE && ignored.seq == 5);
	ck_assert_str_eq(ignored.reason, "ball_count: found 23, allowed 0..22");
	ck_assert_str_eq(bus_last_ignored(bus), "STATE: ball_count: found 23, allowed 0..22");
	ck_assert(handled == 0 && bus_received(bus) == 0);
	welcome = false;
	publish_state(bus, 6);
	bus_drain(bus);
	ck_assert(ignored.count == 3 && ignored.fault == BUS_REFUSED && ignored.seq == 6);
	ck_assert(bus_ignored(bus) == 3 && bus_received(bus) == 1);
}
END_TEST

/* A flood is handled in pieces, so that timers and signals get their turn; nothing of it is lost. */
START_TEST(a_flood_is_handled_in_pieces)
{
	subscribe(BUS_EACH);
	for (int64_t i = 0; i < 2500; i++)
		publish_state(bus, i);
	struct pollfd fd = {bus_descriptor(bus), POLLIN, 0};
	int pieces = 0;
	while (poll(&fd, 1, 0) == 1) {
		int64_t before = handled;
		bus_drain(bus);
		ck_assert_int_le(handled - before, 1000);
		pieces++;
	}
	ck_assert(handled == 2500 && pieces >= 3);
}
END_TEST

START_TEST(subscriptions_have_an_end)
{
	for (int i = 0; i < BUS_SUBSCRIPTION_MAX; i++)
		subscribe(BUS_EACH);
	ck_assert_int_eq(
		bus_subscribe(bus, &(struct bus_subscription){"STATE", &bus_table_state, BUS_EACH, on_state, &handled}),
		-ENOSPC);
	publish_state(bus, 1);
	bus_drain(bus);
	ck_assert_int_eq(handled, BUS_SUBSCRIPTION_MAX);
}
END_TEST

START_TEST(a_channel_that_is_no_expression_is_an_error)
{
	ck_assert_int_lt(
		bus_subscribe(bus, &(struct bus_subscription){"[", &bus_table_state, BUS_EACH, on_state, &handled}), 0);
	subscribe(BUS_EACH);
	publish_state(bus, 1);
	bus_drain(bus);
	ck_assert_int_eq(handled, 1);
}
END_TEST

static void *publisher(void *context)
{
	for (int64_t i = 0; i < 200; i++)
		publish_state(context, i);
	return NULL;
}

START_TEST(any_thread_may_publish)
{
	pthread_t thread[4];
	subscribe(BUS_EACH);
	for (int i = 0; i < 4; i++)
		ck_assert_int_eq(pthread_create(&thread[i], NULL, publisher, bus), 0);
	for (int i = 0; i < 4; i++)
		pthread_join(thread[i], NULL);
	bus_drain(bus);
	ck_assert(handled == 800 && bus_ignored(bus) == 0);
}
END_TEST

/* ---- texts ------------------------------------------------------------------------------------------------------- */

START_TEST(texts_are_cut_and_cleaned)
{
	uint8_t bytes[8];
	char text[32];
	memset(bytes, 'x', sizeof bytes);
	text_set(bytes, sizeof bytes, "ab");
	ck_assert_int_eq(memcmp(bytes, "ab\0\0\0\0\0", 8), 0);
	text_set(bytes, sizeof bytes, "abcdefghijk");
	ck_assert_int_eq(memcmp(bytes, "abcdefg", 8), 0);
	memcpy(bytes, "a\nb\x7f\x1b[31m", 8); /* no end, and what a terminal would obey */
	text_get(text, sizeof text, bytes, sizeof bytes);
	ck_assert_str_eq(text, "a?b??[31");
	text_get(text, 4, bytes, sizeof bytes);
	ck_assert_str_eq(text, "a?b");
	text_get(text, 1, bytes, sizeof bytes);
	ck_assert_str_eq(text, "");
}
END_TEST

START_TEST(the_environment_overrides_the_address)
{
	setenv("LCM_DEFAULT_URL", "memq://x", 1);
	ck_assert_str_eq(bus_url("udpm://"), "memq://x");
	setenv("LCM_DEFAULT_URL", "", 1);
	ck_assert_str_eq(bus_url("udpm://"), "udpm://");
	unsetenv("LCM_DEFAULT_URL");
	ck_assert_str_eq(bus_url("udpm://"), "udpm://");
}
END_TEST

/* ---- the real bus ------------------------------------------------------------------------------------------------ */

static struct bus *other;

static void setup_real(void)
{
	setup();
	teardown();
	bus = fixture_bus();
	other = fixture_bus();
}

static void teardown_real(void)
{
	bus_close(other);
	teardown();
}

static bool came(void)
{
	return last_seq == 77;
}

START_TEST(messages_go_from_one_to_the_other)
{
	subscribe(BUS_EACH);
	for (int64_t i = 1; i <= 77; i++)
		publish_state(other, i);
	ck_assert(fixture_wait(bus, came, 5));
	ck_assert_int_eq(handled, 77);
}
END_TEST

/* Whatever arrives at the port: not LCM at all, broken heads and fragments. */
START_TEST(foreign_datagrams_are_survived)
{
	struct random random = random_begin("bus datagrams");
	struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons(7667)};
	unsigned port;
	if (sscanf(bus_url(FIXTURE_URL), "udpm://239.255.76.67:%u", &port) == 1)
		to.sin_port = htons((uint16_t)port);
	inet_pton(AF_INET, "239.255.76.67", &to.sin_addr);
	int fd = socket(AF_INET, SOCK_DGRAM, 0);
	uint8_t packet[1400];
	subscribe(BUS_EACH);
	for (int i = 0; i < 3000; i++) {
		for (size_t k = 0; k < sizeof packet; k++)
			packet[k] = (uint8_t)random_u64(&random);
		/* Most begin like LCM's short or long messages; long ones carry sizes, offsets and fragment numbers. */
		if (i % 4)
			memcpy(packet, i % 4 == 1 ? "LC02" : "LC03", 4);
		if (i % 4 == 3)
			memcpy(packet + 8, "\0\0\x10\0\0\0\0\0\0\0\0\x02", 12);
		size_t size = random_u64(&random) % sizeof packet;
		sendto(fd, packet, size, 0, (struct sockaddr *)&to, sizeof to);
		if (i % 100 == 0)
			bus_drain(bus);
	}
	close(fd);
	publish_state(other, 77);
	ck_assert(fixture_wait(bus, came, 5));
	ck_assert_int_eq(handled, 1);
}
END_TEST

START_TEST(a_missing_route_is_named_with_its_cure)
{
	struct bus *lost;
	char err[300] = "";
	if (unshare(CLONE_NEWNET) < 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) < 0) {
		printf("bus: missing route SKIPPED, no network namespace: %s\n", strerror(errno));
		return;
	}
	int r = bus_open(&lost, FIXTURE_URL, err, sizeof err);
	ck_assert_msg(r == -ENETUNREACH, "%d %s", r, err);
	ck_assert_ptr_null(lost);
	ck_assert_ptr_nonnull(strstr(err, "239.255.76.67"));
	ck_assert_ptr_nonnull(strstr(err, "ip route replace 239.255.76.67/32 dev lo src 127.0.0.1"));
}
END_TEST

START_TEST(addresses_that_are_none_are_errors)
{
	static const char *const bad[] = {"nonsense", "nonsense://", "udpm://999.1.1.1:7667", "file:///nowhere/at/all"};
	for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
		struct bus *lost;
		char err[300] = "";
		ck_assert_msg(bus_open(&lost, bad[i], err, sizeof err) < 0, "%s", bad[i]);
		ck_assert(!lost && err[0]);
	}
	bus_close(NULL);
}
END_TEST

Suite *test_suite(void)
{
	fixture_begin();
	Suite *suite = suite_create("bus");
	TCase *memory = tcase_create("memory");
	tcase_add_checked_fixture(memory, setup, teardown);
	tcase_add_test(memory, every_type_keeps_every_bit);
	tcase_add_test(memory, types_tell_each_other_apart);
	tcase_add_test(memory, truncated_messages_are_counted_and_ignored);
	tcase_add_test(memory, foreign_and_too_long_messages_are_counted_and_ignored);
	tcase_add_test(memory, messages_that_the_handler_refuses_are_counted);
	tcase_add_test(memory, images_that_lie_about_their_size_are_ignored);
	tcase_add_test(memory, images_larger_than_the_limit_are_refused_unread);
	tcase_add_test(memory, each_comes_in_order);
	tcase_add_test(memory, latest_is_the_newest_and_only_it);
	tcase_add_test(memory, a_bad_message_behind_a_good_one_does_not_cost_it);
	tcase_add_test(memory, closing_with_messages_waiting_frees_them);
	tcase_add_test(memory, every_message_decoded_is_freed_once);
	tcase_add_test(memory, what_is_ignored_is_told_with_its_fault);
	tcase_add_test(memory, a_flood_is_handled_in_pieces);
	tcase_add_test(memory, subscriptions_have_an_end);
	tcase_add_test(memory, a_channel_that_is_no_expression_is_an_error);
	tcase_add_test(memory, any_thread_may_publish);
	suite_add_tcase(suite, memory);
	TCase *texts = tcase_create("texts");
	tcase_add_test(texts, texts_are_cut_and_cleaned);
	tcase_add_test(texts, the_environment_overrides_the_address);
	tcase_add_test(texts, a_missing_route_is_named_with_its_cure);
	tcase_add_test(texts, addresses_that_are_none_are_errors);
	suite_add_tcase(suite, texts);
	TCase *real = tcase_create("real");
	tcase_set_timeout(real, 30);
	tcase_add_checked_fixture(real, setup_real, teardown_real);
	tcase_add_test(real, messages_go_from_one_to_the_other);
	tcase_add_test(real, foreign_datagrams_are_survived);
	suite_add_tcase(suite, real);
	return suite;
}
