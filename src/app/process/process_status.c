#include "app/process/process.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "app/process/clock.h"
#include "app/process/text.h"

void process_publish(struct process *process)
{
	if (process->describe)
		process->describe(process->context, process);
	/* Here and not for each message: a flood of bad ones must not flood the journal. */
	if (bus_ignored(process->bus) > process->ignored_logged) {
		process->ignored_logged = bus_ignored(process->bus);
		process_error(process, "ignored %s", bus_last_ignored(process->bus));
	}
	process->status.utime = clock_utime();
	process->status.received = bus_received(process->bus);
	process->status.ignored = bus_ignored(process->bus);
	bus_publish(process->bus, "STATUS", &bus_status, &process->status);
}

void process_state(struct process *process, const char *format, ...)
{
	uint8_t before[sizeof process->status.state];
	char text[sizeof before];
	va_list args;
	va_start(args, format);
	vsnprintf(text, sizeof text, format, args);
	va_end(args);
	memcpy(before, process->status.state, sizeof before);
	text_set(process->status.state, sizeof process->status.state, text);
	if (memcmp(before, process->status.state, sizeof before) != 0) {
		void (*describe)(void *, struct process *) = process->describe;
		process->describe = NULL; /* it may call process_state() itself */
		process_publish(process);
		process->describe = describe;
	}
}

void process_error(struct process *process, const char *format, ...)
{
	uint8_t before[sizeof process->status.error];
	char text[sizeof before];
	va_list args;
	va_start(args, format);
	vsnprintf(text, sizeof text, format, args);
	va_end(args);
	memcpy(before, process->status.error, sizeof before);
	text_set(process->status.error, sizeof process->status.error, text);
	process->status.error_utime = clock_utime();
	if (memcmp(before, process->status.error, sizeof before) != 0)
		fprintf(stderr, "%s: %s\n", process->name, text);
}

void process_metric(struct process *process, const char *name, const char *unit, double value)
{
	billiard_status_t *s = &process->status;
	int i = 0;
	while (i < s->metric_count && strncmp((const char *)s->metrics[i].name, name, sizeof s->metrics[i].name) != 0)
		i++;
	if (i == (int)(sizeof s->metrics / sizeof s->metrics[0]))
		return;
	if (i == s->metric_count) {
		text_set(s->metrics[i].name, sizeof s->metrics[i].name, name);
		text_set(s->metrics[i].unit, sizeof s->metrics[i].unit, unit);
		s->metric_count++;
	}
	s->metrics[i].value = isfinite(value) ? value : 0; /* the border lets nothing else pass */
}
