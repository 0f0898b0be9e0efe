#include "app/process/process.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include "app/process/clock.h"
#include "app/process/text.h"

enum { STATUS_PERIOD_US = 1000000 };

static int on_bus(sd_event_source *source, int fd, uint32_t events, void *context)
{
	(void)source, (void)fd, (void)events;
	struct process *process = context;
	int r = bus_drain(process->bus);
	if (r < 0) {
		/* The end of a replayed log is no failure; a bus that is gone is one, and a supervisor starts the process again. */
		bool replayed = bus_is_file(process->bus);
		if (!replayed)
			process_error(process, "the bus is gone");
		process_publish(process);
		return sd_event_exit(process->event, replayed ? 0 : 1);
	}
	return 0;
}

static int on_status_timer(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	process_publish(context);
	return 0;
}

struct repeated {
	uint64_t period_us;
	sd_event_time_handler_t handler;
	void *context;
};

static int on_repeated(sd_event_source *source, uint64_t usec, void *context)
{
	struct repeated *timer = context;
	uint64_t now;
	sd_event_now(sd_event_source_get_event(source), CLOCK_MONOTONIC, &now);
	/* After a stop (SIGSTOP, suspend) it goes on from now instead of catching up. */
	uint64_t next = usec + timer->period_us > now ? usec + timer->period_us : now + timer->period_us;
	sd_event_source_set_time(source, next);
	sd_event_source_set_enabled(source, SD_EVENT_ON);
	return timer->handler(source, usec, timer->context);
}

int process_every(struct process *process, uint64_t period_us, sd_event_time_handler_t handler, void *context)
{
	struct repeated *timer = malloc(sizeof *timer);
	if (!timer)
		return -ENOMEM;
	*timer = (struct repeated){period_us, handler, context};
	uint64_t now;
	sd_event_now(process->event, CLOCK_MONOTONIC, &now);
	sd_event_source *source;
	int r = sd_event_add_time(process->event, &source, CLOCK_MONOTONIC, now + period_us, period_us / 20 + 1,
				  on_repeated, timer);
	if (r < 0) {
		free(timer);
		return r;
	}
	sd_event_source_set_destroy_callback(source, free);
	sd_event_source_set_floating(source, 1);
	sd_event_source_unref(source);
	return 0;
}

static int watch_signals(struct process *process)
{
	sigset_t set;
	sigemptyset(&set);
	sigaddset(&set, SIGTERM);
	sigaddset(&set, SIGINT);
	sigprocmask(SIG_BLOCK, &set, NULL); /* before lcm_create: its thread inherits the mask */
	signal(SIGPIPE, SIG_IGN);
	int r = sd_event_add_signal(process->event, NULL, SIGTERM, NULL, NULL);
	return r < 0 ? r : sd_event_add_signal(process->event, NULL, SIGINT, NULL, NULL);
}

int process_init(struct process *process, const char *name, const struct process_options *options,
		 struct config *config)
{
	*process = (struct process){.name = name};
	char err[PROCESS_ERROR_SIZE];
	int r = config_load(config, options->config, err, sizeof err);
	if (r < 0) {
		fprintf(stderr, "%s: %s\n", name, err);
		return r;
	}
	if ((r = sd_event_new(&process->event)) < 0 || (r = watch_signals(process)) < 0) {
		fprintf(stderr, "%s: event loop: %s\n", name, strerror(-r));
		return r;
	}
	r = bus_open(&process->bus, options->bus ? options->bus : bus_url(config->bus), err, sizeof err);
	if (r < 0) {
		fprintf(stderr, "%s: %s\n", name, err);
		return r;
	}
	text_set(process->status.process, sizeof process->status.process, name);
	text_set(process->status.state, sizeof process->status.state, "starting");
	process->status.pid = (int32_t)getpid();
	process->status.started_utime = clock_utime();
	if ((r = sd_event_add_io(process->event, NULL, bus_descriptor(process->bus), EPOLLIN, on_bus, process)) < 0 ||
	    (r = process_every(process, STATUS_PERIOD_US, on_status_timer, process)) < 0) {
		fprintf(stderr, "%s: event loop: %s\n", name, strerror(-r));
		return r;
	}
	sd_event_set_watchdog(process->event, 1);
	return 0;
}

int process_run(struct process *process)
{
	sd_notify(0, "READY=1");
	if (process->status.state[0] == 's' && memcmp(process->status.state, "starting", 9) == 0)
		process_state(process, "running");
	int r = sd_event_loop(process->event);
	sd_notify(0, "STOPPING=1");
	process_state(process, "stopped");
	if (r < 0)
		fprintf(stderr, "%s: event loop: %s\n", process->name, strerror(-r));
	return r < 0 ? 1 : r;
}

void process_finish(struct process *process)
{
	sd_event_unref(process->event);
	bus_close(process->bus);
	*process = (struct process){0};
}
