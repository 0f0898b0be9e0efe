/* The LCM bus: typed subscriptions that survive bad messages, publishing through one buffer that only grows. One thread, but publishing may be
 * called from any. */
#ifndef BILLIARD_APP_BUS_H
#define BILLIARD_APP_BUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lcmtypes/billiard_animation_t.h"
#include "lcmtypes/billiard_command_t.h"
#include "lcmtypes/billiard_draw_list_t.h"
#include "lcmtypes/billiard_image_t.h"
#include "lcmtypes/billiard_plan_request_t.h"
#include "lcmtypes/billiard_plan_t.h"
#include "lcmtypes/billiard_status_t.h"
#include "lcmtypes/billiard_table_state_t.h"

enum { BUS_SUBSCRIPTION_MAX = 8, BUS_IMAGE_MAX = 8 << 20 };

/* How one message type is coded. check (may be NULL) sees the raw bytes before anything is decoded. */
struct bus_type {
	const char *name;
	size_t size;
	int (*decode)(const void *bytes, int offset, int max, void *message);
	int (*encoded_size)(const void *message);
	int (*encode)(void *bytes, int offset, int max, const void *message);
	int (*cleanup)(void *message);
	bool (*check)(const void *bytes, size_t size);
};
extern const struct bus_type bus_image, bus_table_state, bus_plan_request, bus_plan, bus_draw_list, bus_animation,
	bus_command, bus_status;

/* message is borrowed until the handler returns. False: not acceptable (outdated, out of range); it is counted as ignored. */
typedef bool bus_handler(void *context, const void *message);

enum bus_delivery {
	BUS_EACH,  /* every message, in order */
	BUS_LATEST /* of those that wait, only the newest: for messages that are dear to handle. A newest that the handler refuses costs the others */
};

struct bus; /* opaque */

/* Opens url. 0, or a negative errno with the reason in err: when the multicast route is missing, it says which and the command
 * that adds it. *out is NULL on failure. Caller closes. Block signals that the loop handles before: LCM starts a thread. */
int bus_open(struct bus **out, const char *url, char *err, size_t err_size);
void bus_close(struct bus *bus); /* NULL is fine */

/* Address to use: LCM_DEFAULT_URL when it is set, else configured. */
const char *bus_url(const char *configured);

/* channel: a name, or a regular expression of LCM. 0, -ENOSPC, or -ENOMEM (also: no valid expression). */
int bus_subscribe(struct bus *bus, const char *channel, const struct bus_type *type, enum bus_delivery delivery,
		  bus_handler *handler, void *context);
/* 0 or -EIO. A lost message is not an error. */
int bus_publish(struct bus *bus, const char *channel, const struct bus_type *type, const void *message);

/* False for a time (us since 1970) that no clock shows: before 1970 or after 2255. */
bool bus_utime_ok(int64_t utime);

/* For the event loop: readable when messages wait. */
int bus_descriptor(struct bus *bus);
/* Handles what waits, at most 1000 messages. 0, or -EIO when the bus is gone (the end of a replayed log). */
int bus_drain(struct bus *bus);
/* True when messages come from a recorded log (file://), which has an end. */
bool bus_is_file(const struct bus *bus);

/* Messages taken and messages ignored so far. */
int64_t bus_received(const struct bus *bus);
int64_t bus_ignored(const struct bus *bus);
/* Reason of the last one ignored: "PLAN: malformed, 12 bytes". Never NULL. */
const char *bus_last_ignored(const struct bus *bus);

/* True when a command names no target, or this program. */
bool bus_is_for(const billiard_command_t *command, const char *program);

#endif
