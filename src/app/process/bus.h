/* The LCM bus: typed subscriptions that survive bad messages, publishing through one buffer that only grows. One thread, but publishing may be
 * called from any. */
#ifndef BILLIARD_APP_BUS_H
#define BILLIARD_APP_BUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "app/process/message_check.h"
#include "lcmtypes/billiard_animation_t.h"
#include "lcmtypes/billiard_command_t.h"
#include "lcmtypes/billiard_draw_list_t.h"
#include "lcmtypes/billiard_game_t.h"
#include "lcmtypes/billiard_image_t.h"
#include "lcmtypes/billiard_lease_t.h"
#include "lcmtypes/billiard_plan_request_t.h"
#include "lcmtypes/billiard_plan_t.h"
#include "lcmtypes/billiard_stability_t.h"
#include "lcmtypes/billiard_status_t.h"
#include "lcmtypes/billiard_table_state_t.h"
#include "lcmtypes/billiard_vision_doubt_t.h"

enum { BUS_SUBSCRIPTION_MAX = 8, BUS_IMAGE_MAX = 8 << 20 };

/* How one message type is coded. check (may be NULL) sees the raw bytes before anything is decoded; what does not pass the table is not
 * delivered. */
struct bus_type {
	const char *name;
	size_t size;
	int (*decode)(const void *bytes, int offset, int max, void *message);
	int (*encoded_size)(const void *message);
	int (*encode)(void *bytes, int offset, int max, const void *message);
	int (*cleanup)(void *message);
	bool (*check)(const void *bytes, size_t size);
	const struct message_table *table;
};
extern const struct bus_type bus_image, bus_table_state, bus_plan_request, bus_plan, bus_draw_list, bus_animation,
	bus_command, bus_status, bus_vision_doubt, bus_stability, bus_lease, bus_game;

/* message has passed its type's table; borrowed until the handler returns. False: not acceptable (outdated, contradictory); it is counted
 * as ignored. */
typedef bool bus_handler(void *context, const void *message);

enum bus_delivery {
	BUS_EACH,  /* every message, in order */
	BUS_LATEST /* of those that wait, only the newest: for messages that are dear to handle. A newest that the handler refuses costs the others */
};

struct bus_subscription {
	const char *channel; /* a name, or a regular expression of LCM */
	const struct bus_type *type;
	enum bus_delivery delivery;
	bus_handler *handler;
	void *context; /* of the handler */
};

/* Why a message was ignored. */
enum bus_fault {
	BUS_MALFORMED, /* no message of this type: foreign, cut, too long */
	BUS_RANGE,     /* a number that the type's table does not allow */
	BUS_REFUSED    /* the handler's verdict */
};
struct bus_ignored {
	const char *channel;
	enum bus_fault fault;
	const char *reason;  /* for people, without the channel */
	const void *message; /* as decoded; NULL for BUS_MALFORMED */
};
/* All borrowed until it returns. */
typedef void bus_ignored_handler(void *context, const struct bus_ignored *ignored);

struct bus; /* opaque */

/* Opens url. 0, or a negative errno with the reason in err: when the multicast route is missing, it says which and the command
 * that adds it. *out is NULL on failure. Caller closes. Block signals that the loop handles before: LCM starts a thread. */
int bus_open(struct bus **out, const char *url, char *err, size_t err_size);
void bus_close(struct bus *bus); /* NULL is fine */

/* Address to use: LCM_DEFAULT_URL when it is set, else configured. */
const char *bus_url(const char *configured);

/* The subscription is copied. 0, -ENOSPC, or -ENOMEM (also: no valid expression). */
int bus_subscribe(struct bus *bus, const struct bus_subscription *subscription);
/* Tells handler of each message that is ignored, when that happens. NULL: nobody. */
void bus_on_ignored(struct bus *bus, bus_ignored_handler *handler, void *context);
/* 0 or -EIO. A lost message is not an error. */
int bus_publish(struct bus *bus, const char *channel, const struct bus_type *type, const void *message);

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
