#include "app/process/process.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <stdio.h>
#include <string.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/process/version.h"

enum { STATUS_PERIOD_US = 1000000 };

/* ---- command line --------------------------------------------------------------------------------------------------- */

/* The options of one program: those it alone has, then those that all have. */
struct option_set {
	const char *program, *usage;
	struct option options[8];
};
enum { OPT_BUS = 256, OPT_SOURCE, OPT_HOLD, OPT_POSITION };
#define COMMON_OPTIONS                                                                                                 \
	{"config", required_argument, NULL, 'c'}, {"bus", required_argument, NULL, OPT_BUS},                           \
		{"help", no_argument, NULL, 'h'}, {"version", no_argument, NULL, 'v'},                                 \
	{                                                                                                              \
		NULL, 0, NULL, 0                                                                                       \
	}

static const struct option_set option_sets[] = {
	{"billiard-vision",
	 " [--source v4l2:/dev/videoN|dir:FOLDER|file:VIDEO|lcm:CHANNEL] [--hold SECONDS]",
	 {{"source", required_argument, NULL, OPT_SOURCE},
	  {"hold", required_argument, NULL, OPT_HOLD},
	  COMMON_OPTIONS}},
	{"billiard-table", " [--position FILE]", {{"position", required_argument, NULL, OPT_POSITION}, COMMON_OPTIONS}},
	{"", "", {COMMON_OPTIONS}},
};

static const struct option_set *options_of(const char *program)
{
	const struct option_set *set = option_sets;
	while (set->program[0] && strcmp(set->program, program) != 0)
		set++;
	return set;
}

static int parse_hold(const char *text, double *out)
{
	char *rest;
	double value = strtod(text, &rest);
	if (rest == text || *rest || !(value > 0 && value <= 3600)) {
		fprintf(stderr, "billiard-vision: --hold: found \"%s\", allowed seconds in 0..3600\n", text);
		return -EINVAL;
	}
	*out = value;
	return 0;
}

int process_parse(struct process_options *out, const char *name, int argc, char **argv)
{
	const struct option_set *set = options_of(name);
	*out = (struct process_options){.config = config_default_path(), .hold = 4};
	int c;
	while ((c = getopt_long(argc, argv, "c:h", set->options, NULL)) != -1) {
		switch (c) {
		case 'c':
			out->config = optarg;
			break;
		case OPT_BUS:
			out->bus = optarg;
			break;
		case OPT_SOURCE:
			out->source = optarg;
			break;
		case OPT_POSITION:
			out->position = optarg;
			break;
		case OPT_HOLD:
			if (parse_hold(optarg, &out->hold) < 0)
				return -EINVAL;
			break;
		case 'h':
			printf("usage: %s [-c CONF] [--bus URL]%s\n", name, set->usage);
			return 1;
		case 'v':
			printf("%s %s\n", name, BILLIARD_VERSION);
			return 1;
		default:
			return -EINVAL;
		}
	}
	if (optind < argc) {
		fprintf(stderr, "%s: unexpected argument \"%s\"\n", name, argv[optind]);
		return -EINVAL;
	}
	return 0;
}

/* ---- status --------------------------------------------------------------------------------------------------------- */

static void publish_status(struct process *process)
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
		publish_status(process);
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

/* ---- loop ----------------------------------------------------------------------------------------------------------- */

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
		publish_status(process);
		return sd_event_exit(process->event, replayed ? 0 : 1);
	}
	return 0;
}

static int on_status_timer(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	publish_status(context);
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
