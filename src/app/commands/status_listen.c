#include "app/commands/status_listen.h"

#include <string.h>
#include <systemd/sd-event.h>

#include "app/process/text.h"

static bool same_process(const billiard_status_t *a, const billiard_status_t *b)
{
	return a->pid == b->pid && memcmp(a->process, b->process, sizeof a->process) == 0;
}

bool status_take(struct status_heard *heard, const billiard_status_t *message)
{
	if (message->metric_count < 0 ||
	    message->metric_count > (int)(sizeof message->metrics / sizeof message->metrics[0]))
		return false;
	int i = 0;
	while (i < heard->count && !same_process(&heard->status[i], message))
		i++;
	if (i == STATUS_PROCESS_MAX)
		return false;
	heard->count += i == heard->count;
	heard->status[i] = *message;
	return true;
}

bool status_knows(const struct status_heard *heard, const char *name)
{
	char process[sizeof heard->status[0].process + 1];
	for (int i = 0; i < heard->count; i++) {
		text_get(process, sizeof process, heard->status[i].process, sizeof heard->status[i].process);
		if (strcmp(process, name) == 0)
			return true;
	}
	return false;
}

static bool on_status(void *context, const void *message)
{
	return status_take(context, message);
}

static int on_readable(sd_event_source *source, int fd, uint32_t events, void *context)
{
	(void)fd, (void)events;
	return bus_drain(context) < 0 ? sd_event_exit(sd_event_source_get_event(source), 1) : 0;
}

static int on_time(sd_event_source *source, uint64_t usec, void *context)
{
	(void)usec, (void)context;
	return sd_event_exit(sd_event_source_get_event(source), 0);
}

int status_listen(struct status_heard *heard, struct bus *bus, double seconds)
{
	sd_event *event;
	int r = bus_subscribe(bus, &(struct bus_subscription){"STATUS", &bus_status, BUS_EACH, on_status, heard});
	if (r < 0 || (r = sd_event_new(&event)) < 0)
		return r;
	uint64_t end_us = (uint64_t)(1e6 * seconds);
	if ((r = sd_event_add_io(event, NULL, bus_descriptor(bus), EPOLLIN, on_readable, bus)) >= 0 &&
	    (r = sd_event_add_time_relative(event, NULL, CLOCK_MONOTONIC, end_us, 0, on_time, NULL)) >= 0)
		r = sd_event_loop(event);
	sd_event_unref(event);
	return r < 0 ? r : 0;
}
