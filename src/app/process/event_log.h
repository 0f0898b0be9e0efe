/* LCM logs as lcm-logger writes them, event by event. A log comes from outside: what is no whole event is refused with
 * its place in the file. */
#ifndef BILLIARD_APP_EVENT_LOG_H
#define BILLIARD_APP_EVENT_LOG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "app/process/bus.h"

enum { EVENT_CHANNEL_MAX = 63, EVENT_DATA_MAX = 64 << 20 };

struct log_event {
	int64_t utime; /* us since 1970, when the message was received */
	const char *channel;
	const uint8_t *data;
	size_t size; /* bytes of data */
};

struct event_log; /* opaque */
/* Opens a log for reading. 0, or a negative errno with "path: reason". Caller closes. */
int event_log_open(struct event_log **out, const char *path, char *err, size_t err_size);
void event_log_close(struct event_log *log); /* NULL is fine */
/* 1 and an event, borrowed until the next call; 0 at the end; -EINVAL, -EIO or -ENOMEM with "path: reason". */
int event_log_next(struct event_log *log, struct log_event *event, char *err, size_t err_size);

/* The message in it, checked as the bus checks it. False: of another type or version, or a number out of range. On success
 * the caller calls type->cleanup(message). */
bool log_event_decode(const struct log_event *event, const struct bus_type *type, void *message);

/* Appends one event to a log that is being written. number: 0, 1, ... within it. 0 or -EIO. */
int event_log_write(FILE *file, int64_t number, const struct log_event *event);

#endif
