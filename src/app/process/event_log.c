#include "app/process/event_log.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* An event: sync word, number, time, length of channel, length of data (big endian), channel, data. */
enum { HEADER_SIZE = 4 + 8 + 8 + 4 + 4 };
static const uint32_t SYNC = 0xeda1da01;

struct event_log {
	FILE *file;
	char *path;
	long long at; /* byte where the next event begins */
	char channel[EVENT_CHANNEL_MAX + 1];
	uint8_t *data; /* owned, capacity bytes */
	size_t capacity;
};

static uint64_t read_big(const uint8_t *bytes, int count)
{
	uint64_t value = 0;
	for (int i = 0; i < count; i++)
		value = value << 8 | bytes[i];
	return value;
}

static void write_big(uint8_t *bytes, int count, uint64_t value)
{
	for (int i = count; i-- > 0; value >>= 8)
		bytes[i] = (uint8_t)value;
}

int event_log_open(struct event_log **out, const char *path, char *err, size_t err_size)
{
	*out = NULL;
	struct event_log *log = calloc(1, sizeof *log);
	if (log)
		log->path = strdup(path);
	if (!log || !log->path) {
		event_log_close(log);
		snprintf(err, err_size, "%s: out of memory", path);
		return -ENOMEM;
	}
	log->file = fopen(path, "rb");
	if (!log->file) {
		int r = -errno;
		snprintf(err, err_size, "%s: %s", path, strerror(-r));
		event_log_close(log);
		return r;
	}
	*out = log;
	return 0;
}

void event_log_close(struct event_log *log)
{
	if (!log)
		return;
	if (log->file)
		fclose(log->file);
	free(log->path);
	free(log->data);
	free(log);
}

static int refuse(const struct event_log *log, const char *reason, char *err, size_t err_size)
{
	snprintf(err, err_size, "%s: byte %lld: %s", log->path, log->at, reason);
	return -EINVAL;
}

static int take_room(struct event_log *log, size_t size, char *err, size_t err_size)
{
	if (size <= log->capacity)
		return 0;
	uint8_t *bigger = realloc(log->data, size);
	if (!bigger) {
		snprintf(err, err_size, "%s: out of memory", log->path);
		return -ENOMEM;
	}
	log->data = bigger;
	log->capacity = size;
	return 0;
}

/* The name of a channel: printable, as everything that is said about it goes to people. */
static bool name_ok(const char *name, size_t length)
{
	for (size_t i = 0; i < length; i++)
		if (name[i] <= ' ' || name[i] > '~')
			return false;
	return true;
}

int event_log_next(struct event_log *log, struct log_event *event, char *err, size_t err_size)
{
	uint8_t header[HEADER_SIZE];
	size_t got = fread(header, 1, sizeof header, log->file);
	if (got == 0 && feof(log->file))
		return 0;
	if (got >= 4 && read_big(header, 4) != SYNC)
		return refuse(log, "no event of an LCM log", err, err_size);
	if (got < sizeof header)
		return refuse(log, "an event cut short", err, err_size);
	uint64_t channel = read_big(header + 20, 4), size = read_big(header + 24, 4);
	if (channel == 0 || channel > EVENT_CHANNEL_MAX || size > EVENT_DATA_MAX)
		return refuse(log, "an event with impossible lengths", err, err_size);
	int r = take_room(log, size, err, err_size);
	if (r < 0)
		return r;
	if (fread(log->channel, 1, channel, log->file) != channel || fread(log->data, 1, size, log->file) != size)
		return refuse(log, "an event cut short", err, err_size);
	if (!name_ok(log->channel, channel))
		return refuse(log, "an event with an impossible channel", err, err_size);
	log->channel[channel] = '\0';
	log->at += (long long)(sizeof header + channel + size);
	*event = (struct log_event){(int64_t)read_big(header + 12, 8), log->channel, log->data, size};
	return 1;
}

bool log_event_decode(const struct log_event *event, const struct bus_type *type, void *message)
{
	char reason[128];
	if (type->check && !type->check(event->data, event->size))
		return false;
	int used = type->decode(event->data, 0, (int)event->size, message);
	if (used < 0)
		return false;
	if ((size_t)used == event->size && message_check(type->table, message, reason, sizeof reason))
		return true;
	type->cleanup(message);
	return false;
}

int event_log_write(FILE *file, int64_t number, const struct log_event *event)
{
	uint8_t header[HEADER_SIZE];
	size_t channel = strlen(event->channel);
	write_big(header, 4, SYNC);
	write_big(header + 4, 8, (uint64_t)number);
	write_big(header + 12, 8, (uint64_t)event->utime);
	write_big(header + 20, 4, channel);
	write_big(header + 24, 4, event->size);
	bool ok = fwrite(header, 1, sizeof header, file) == sizeof header &&
		  fwrite(event->channel, 1, channel, file) == channel &&
		  fwrite(event->data, 1, event->size, file) == event->size;
	return ok ? 0 : -EIO;
}
