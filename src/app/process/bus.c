#include "app/process/bus.h"

#include <arpa/inet.h>
#include <errno.h>
#include <lcm/lcm.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>
#include "app/process/message_table.h"
#include "app/process/text.h"

enum { DRAIN_MAX = 1000 }; /* messages handled at a time */

struct subscription {
	struct bus *bus;
	struct bus_subscription def;
	/* Owned, type->size bytes each; spare: decoded into, so that a bad message spoils no good one. */
	void *message, *spare;
	bool pending; /* BUS_LATEST: message waits for the end of the drain */
	size_t bytes; /* of message, encoded */
	char channel[64];
};

struct bus {
	lcm_t *lcm;
	struct subscription subscription[BUS_SUBSCRIPTION_MAX];
	int subscription_count;
	pthread_mutex_t lock; /* of buffer */
	uint8_t *buffer;      /* owned, for encoding */
	size_t buffer_size;
	bool is_file;
	int64_t received, ignored;
	char last_ignored[192];
	bus_ignored_handler *on_ignored; /* may be NULL */
	void *on_ignored_context;
};

/* ---- types ---------------------------------------------------------------------------------------------------------- */

/* The generated functions take typed pointers: these wrappers make them callable through struct bus_type. */
#define TYPE_WRAPPERS(x)                                                                                               \
	static int x##_decode_any(const void *bytes, int offset, int max, void *message)                               \
	{                                                                                                              \
		return billiard_##x##_decode(bytes, offset, max, message);                                             \
	}                                                                                                              \
	static int x##_size_any(const void *message)                                                                   \
	{                                                                                                              \
		return billiard_##x##_encoded_size(message);                                                           \
	}                                                                                                              \
	static int x##_encode_any(void *bytes, int offset, int max, const void *message)                               \
	{                                                                                                              \
		return billiard_##x##_encode(bytes, offset, max, message);                                             \
	}                                                                                                              \
	static int x##_cleanup_any(void *message)                                                                      \
	{                                                                                                              \
		return billiard_##x##_decode_cleanup(message);                                                         \
	}
#define TYPE(x, checker, table)                                                                                        \
	{                                                                                                              \
#x, sizeof(billiard_##x), x##_decode_any, x##_size_any, x##_encode_any, x##_cleanup_any, checker,      \
			table                                                                                          \
	}

TYPE_WRAPPERS(image_t)
TYPE_WRAPPERS(table_state_t)
TYPE_WRAPPERS(plan_request_t)
TYPE_WRAPPERS(plan_t)
TYPE_WRAPPERS(draw_list_t)
TYPE_WRAPPERS(animation_t)
TYPE_WRAPPERS(command_t)
TYPE_WRAPPERS(status_t)
TYPE_WRAPPERS(vision_doubt_t)
TYPE_WRAPPERS(stability_t)
TYPE_WRAPPERS(lease_t)
TYPE_WRAPPERS(game_t)

/* image_t is the one type whose decoder would allocate what the wire says. */
static bool image_size_fits(const void *bytes, size_t size)
{
	enum { FIXED = 8 + 8 + 8 + 4 + 4 + 4, SIZE_AT = FIXED - 4 };
	const uint8_t *b = bytes;
	if (size < FIXED)
		return false;
	uint32_t n = (uint32_t)b[SIZE_AT] << 24 | (uint32_t)b[SIZE_AT + 1] << 16 | (uint32_t)b[SIZE_AT + 2] << 8 |
		     b[SIZE_AT + 3];
	return n > 0 && n <= BUS_IMAGE_MAX && size == FIXED + (size_t)n;
}

const struct bus_type bus_image = TYPE(image_t, image_size_fits, &message_image);
const struct bus_type bus_table_state = TYPE(table_state_t, NULL, &message_table_state);
const struct bus_type bus_plan_request = TYPE(plan_request_t, NULL, &message_plan_request);
const struct bus_type bus_plan = TYPE(plan_t, NULL, &message_plan);
const struct bus_type bus_draw_list = TYPE(draw_list_t, NULL, &message_draw_list);
const struct bus_type bus_animation = TYPE(animation_t, NULL, &message_animation);
const struct bus_type bus_command = TYPE(command_t, NULL, &message_command);
const struct bus_type bus_status = TYPE(status_t, NULL, &message_status);
const struct bus_type bus_stability = TYPE(stability_t, NULL, &message_stability);
const struct bus_type bus_lease = TYPE(lease_t, NULL, &message_lease);
const struct bus_type bus_game = TYPE(game_t, NULL, &message_game);
const struct bus_type bus_vision_doubt = TYPE(vision_doubt_t, NULL, &message_vision_doubt);

/* ---- opening -------------------------------------------------------------------------------------------------------- */

const char *bus_url(const char *configured)
{
	const char *url = getenv("LCM_DEFAULT_URL");
	return url && *url ? url : configured;
}

/* Whether a udpm address can be reached; err gets the cure when not. */
static int check_route(const char *url, char *err, size_t err_size)
{
	char group[64] = "239.255.76.67";
	int port = 7667;
	if (strncmp(url, "udpm://", 7) != 0)
		return 0;
	sscanf(url + 7, "%63[0-9.]:%d", group, &port);
	struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
	if (inet_pton(AF_INET, group, &to.sin_addr) != 1) {
		snprintf(err, err_size, "bus: %s: \"%s\" is not an IPv4 address", url, group);
		return -EINVAL;
	}
	int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
	if (fd < 0) {
		int r = -errno;
		snprintf(err, err_size, "bus: no socket: %s", strerror(-r));
		return r;
	}
	int r = connect(fd, (struct sockaddr *)&to, sizeof to) < 0 ? -errno : 0;
	close(fd);
	if (r < 0)
		snprintf(err, err_size,
			 "bus: %s (%s): no route for %s; add it with: ip route replace %s/32 dev lo src 127.0.0.1", url,
			 strerror(-r), group, group);
	return r;
}

/* LCM itself would say it on stderr. */
static int check_scheme(const char *url, char *err, size_t err_size)
{
	static const char *const known[] = {"udpm://", "file://", "memq://", "tcpq://"};
	for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
		if (strncmp(url, known[i], strlen(known[i])) == 0)
			return 0;
	snprintf(err, err_size, "bus: \"%s\" is no address, wanted udpm://GROUP:PORT or file://LOG", url);
	return -EINVAL;
}

int bus_open(struct bus **out, const char *url, char *err, size_t err_size)
{
	*out = NULL;
	int r = check_scheme(url, err, err_size);
	r = r < 0 ? r : check_route(url, err, err_size);
	if (r < 0)
		return r;
	struct bus *bus = calloc(1, sizeof *bus);
	if (!bus) {
		snprintf(err, err_size, "bus: out of memory");
		return -ENOMEM;
	}
	pthread_mutex_init(&bus->lock, NULL);
	bus->lcm = lcm_create(url);
	if (!bus->lcm) {
		snprintf(err, err_size, "bus: cannot open \"%s\"", url);
		bus_close(bus);
		return -EIO;
	}
	bus->is_file = strncmp(url, "file:", 5) == 0;
	*out = bus;
	return 0;
}

void bus_close(struct bus *bus)
{
	if (!bus)
		return;
	if (bus->lcm)
		lcm_destroy(bus->lcm);
	for (int i = 0; i < bus->subscription_count; i++) {
		struct subscription *s = &bus->subscription[i];
		if (s->pending)
			s->def.type->cleanup(s->message);
		free(s->message);
		free(s->spare);
	}
	pthread_mutex_destroy(&bus->lock);
	free(bus->buffer);
	free(bus);
}

/* ---- receiving ------------------------------------------------------------------------------------------------------ */

static void ignore(struct bus *bus, const struct bus_ignored *ignored)
{
	bus->ignored++;
	snprintf(bus->last_ignored, sizeof bus->last_ignored, "%.40s: %s", ignored->channel, ignored->reason);
	if (bus->on_ignored)
		bus->on_ignored(bus->on_ignored_context, ignored);
}

static void ignore_malformed(struct bus *bus, const char *channel, const char *why, size_t size)
{
	char reason[64];
	snprintf(reason, sizeof reason, "%s, %zu bytes", why, size);
	ignore(bus, &(struct bus_ignored){channel, BUS_MALFORMED, reason, NULL});
}

static void deliver(struct subscription *s)
{
	char reason[64];
	s->pending = false;
	if (!s->def.handler(s->def.context, s->message)) {
		snprintf(reason, sizeof reason, "contradictory or outdated, %zu bytes", s->bytes);
		ignore(s->bus, &(struct bus_ignored){s->channel, BUS_REFUSED, reason, s->message});
	}
	s->def.type->cleanup(s->message);
}

/* Into s->spare. False when it is no message of the type, or one that its table does not allow: then it has been ignored. */
static bool decode(struct subscription *s, const char *channel, const void *bytes, size_t size)
{
	const struct bus_type *type = s->def.type;
	char reason[128];
	if (type->check && !type->check(bytes, size)) {
		ignore_malformed(s->bus, channel, "malformed", size);
		return false;
	}
	int used = type->decode(bytes, 0, (int)size, s->spare);
	if (used < 0) {
		ignore_malformed(s->bus, channel, "foreign or malformed", size);
		return false;
	}
	bool whole = (size_t)used == size;
	if (!whole)
		ignore_malformed(s->bus, channel, "too long", size);
	else if (message_check(type->table, s->spare, reason, sizeof reason))
		return true;
	else
		ignore(s->bus, &(struct bus_ignored){channel, BUS_RANGE, reason, s->spare});
	type->cleanup(s->spare);
	return false;
}

static void on_message(const lcm_recv_buf_t *rbuf, const char *channel, void *user)
{
	struct subscription *s = user;
	if (!decode(s, channel, rbuf->data, rbuf->data_size))
		return;
	s->bus->received++;
	if (s->pending)
		s->def.type->cleanup(s->message);
	void *message = s->spare;
	s->spare = s->message;
	s->message = message;
	s->pending = true;
	s->bytes = rbuf->data_size;
	if (s->def.delivery == BUS_EACH)
		deliver(s);
}

int bus_subscribe(struct bus *bus, const struct bus_subscription *subscription)
{
	if (bus->subscription_count == BUS_SUBSCRIPTION_MAX)
		return -ENOSPC;
	size_t size = subscription->type->size;
	struct subscription *s = &bus->subscription[bus->subscription_count];
	*s = (struct subscription){
		.bus = bus, .def = *subscription, .message = calloc(1, size), .spare = calloc(1, size)};
	snprintf(s->channel, sizeof s->channel, "%s", subscription->channel);
	s->def.channel = s->channel;
	lcm_subscription_t *l = s->message && s->spare ? lcm_subscribe(bus->lcm, s->channel, on_message, s) : NULL;
	if (!l) {
		free(s->message);
		free(s->spare);
		return -ENOMEM;
	}
	/* A full queue drops the newest message: never let it fill. */
	lcm_subscription_set_queue_capacity(l, 0);
	bus->subscription_count++;
	return 0;
}

void bus_on_ignored(struct bus *bus, bus_ignored_handler *handler, void *context)
{
	bus->on_ignored = handler;
	bus->on_ignored_context = context;
}

static void deliver_latest(struct bus *bus)
{
	for (int i = 0; i < bus->subscription_count; i++)
		if (bus->subscription[i].pending)
			deliver(&bus->subscription[i]);
}

int bus_drain(struct bus *bus)
{
	int r = 1;
	/* Not without end: a flood must not keep the loop from its timers and signals. The descriptor stays readable. */
	for (int i = 0; i < DRAIN_MAX && r > 0; i++)
		r = lcm_handle_timeout(bus->lcm, 0);
	deliver_latest(bus);
	return r < 0 ? -EIO : 0;
}

/* ---- sending -------------------------------------------------------------------------------------------------------- */

int bus_publish(struct bus *bus, const char *channel, const struct bus_type *type, const void *message)
{
	int r = -EIO;
	size_t size = (size_t)type->encoded_size(message);
	pthread_mutex_lock(&bus->lock);
	if (size > bus->buffer_size) {
		uint8_t *bigger = realloc(bus->buffer, size);
		if (!bigger)
			goto out;
		bus->buffer = bigger;
		bus->buffer_size = size;
	}
	int used = type->encode(bus->buffer, 0, (int)size, message);
	if (used >= 0 && lcm_publish(bus->lcm, channel, bus->buffer, (unsigned)used) == 0)
		r = 0;
out:
	pthread_mutex_unlock(&bus->lock);
	return r;
}

int bus_descriptor(struct bus *bus)
{
	return lcm_get_fileno(bus->lcm);
}

bool bus_is_file(const struct bus *bus)
{
	return bus->is_file;
}

int64_t bus_received(const struct bus *bus)
{
	return bus->received;
}

int64_t bus_ignored(const struct bus *bus)
{
	return bus->ignored;
}

const char *bus_last_ignored(const struct bus *bus)
{
	return bus->last_ignored;
}

bool bus_is_for(const billiard_command_t *command, const char *program)
{
	char target[sizeof command->target];
	text_get(target, sizeof target, command->target, sizeof command->target);
	return !target[0] || strcmp(target, program) == 0;
}
