/* What every billiard process has: an sd-event loop over the bus, signals, timers, the watchdog, sd_notify, and its STATUS message. */
#ifndef BILLIARD_APP_PROCESS_H
#define BILLIARD_APP_PROCESS_H

#include <systemd/sd-event.h>

#include "app/process/bus.h"
#include "app/config/config.h"
#include "app/process/process_options.h"

enum { PROCESS_ERROR_SIZE = 256 };

struct process {
	const char *name; /* borrowed */
	sd_event *event;  /* owned */
	struct bus *bus;  /* owned */
	billiard_status_t status;
	/* Called before each STATUS to fill state and metrics; may be NULL. */
	void (*describe)(void *context, struct process *process);
	void *context;
	int64_t ignored_logged;
};

/* Configuration and bus opened, signals blocked and watched. 0, or a negative errno after one line on stderr. finish() in every case. */
int process_init(struct process *process, const char *name, const struct process_options *options,
		 struct config *config);
/* READY=1, then runs until SIGTERM, SIGINT or sd_event_exit(). Exit status. */
int process_run(struct process *process);
void process_finish(struct process *process);

/* Calls handler every period_us from now on. 0 or a negative errno. */
int process_every(struct process *process, uint64_t period_us, sd_event_time_handler_t handler, void *context);

/* Sends STATUS now; the loop does so every second. */
void process_publish(struct process *process);
/* State shown in STATUS; published at once when it changed. */
void process_state(struct process *process, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Keeps the last error for STATUS and logs it to stderr, once for as long as the text stays the same. */
void process_error(struct process *process, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Sets a metric of that name, adding it when it is new. */
void process_metric(struct process *process, const char *name, const char *unit, double value);

#endif
