/* billiard status: what each process says of itself on the bus. billiard control: a COMMAND to them. */
#include <errno.h>
#include <getopt.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <systemd/sd-event.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/process/bus.h"
#include "app/commands/cmd.h"
#include "app/config/config.h"
#include "app/process/process.h"

enum { PROCESS_MAX = 32 };

struct listener {
	billiard_status_t status[PROCESS_MAX];
	int count;
};

/* The newest of each process, by name and pid. */
static bool on_status(void *context, const void *message)
{
	struct listener *l = context;
	const billiard_status_t *s = message;
	if (s->metric_count < 0 || s->metric_count > (int)(sizeof s->metrics / sizeof s->metrics[0]))
		return false;
	int i = 0;
	while (i < l->count &&
	       !(l->status[i].pid == s->pid && memcmp(l->status[i].process, s->process, sizeof s->process) == 0))
		i++;
	if (i == PROCESS_MAX)
		return false;
	l->count += i == l->count;
	l->status[i] = *s;
	return true;
}

struct texts {
	char process[24], state[24], error[128];
};

static double up_seconds(const billiard_status_t *s)
{
	return 1e-6 * ((double)s->utime - (double)s->started_utime);
}

/* JSON has no bytes, and a cut text may end within a character. */
static void text(char *out, size_t size, const uint8_t *bytes, size_t byte_count)
{
	text_get(out, size, bytes, byte_count);
	for (; *out; out++)
		if ((unsigned char)*out > 126)
			*out = '?';
}

static struct texts texts_of(const billiard_status_t *s)
{
	struct texts t;
	text(t.process, sizeof t.process, s->process, sizeof s->process);
	text(t.state, sizeof t.state, s->state, sizeof s->state);
	text(t.error, sizeof t.error, s->error, sizeof s->error);
	return t;
}

static void print_json(const billiard_status_t *s)
{
	struct texts t = texts_of(s);
	json_t *metrics = json_object();
	for (int i = 0; i < s->metric_count; i++) {
		char name[24], unit[12];
		text(name, sizeof name, s->metrics[i].name, sizeof s->metrics[i].name);
		text(unit, sizeof unit, s->metrics[i].unit, sizeof s->metrics[i].unit);
		json_object_set_new(metrics, name, json_pack("{s:f,s:s}", "value", s->metrics[i].value, "unit", unit));
	}
	json_t *object = json_pack("{s:s,s:i,s:s,s:s,s:f,s:I,s:I,s:o}", "process", t.process, "pid", (int)s->pid,
				   "state", t.state, "error", t.error, "up_s", up_seconds(s), "received",
				   (json_int_t)s->received, "ignored", (json_int_t)s->ignored, "metrics", metrics);
	if (!object)
		return;
	json_dumpf(object, stdout, JSON_COMPACT);
	putchar('\n');
	json_decref(object);
}

static void print_line(const billiard_status_t *s)
{
	struct texts t = texts_of(s);
	printf("%-20s %7d  %-16s up %6.0f s  in %lld, ignored %lld", t.process, s->pid, t.state, up_seconds(s),
	       (long long)s->received, (long long)s->ignored);
	for (int i = 0; i < s->metric_count; i++) {
		char name[24], unit[12];
		text(name, sizeof name, s->metrics[i].name, sizeof s->metrics[i].name);
		text(unit, sizeof unit, s->metrics[i].unit, sizeof s->metrics[i].unit);
		printf(", %s %.4g%s%s", name, s->metrics[i].value, strcmp(unit, "1") ? " " : "",
		       strcmp(unit, "1") ? unit : "");
	}
	putchar('\n');
	if (t.error[0])
		printf("%-20s last error: %s\n", "", t.error);
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

/* Listens for a while. */
static int listen_for(struct bus *bus, double seconds)
{
	sd_event *event;
	int r = sd_event_new(&event);
	if (r < 0)
		return r;
	if ((r = sd_event_add_io(event, NULL, bus_descriptor(bus), EPOLLIN, on_readable, bus)) >= 0 &&
	    (r = sd_event_add_time_relative(event, NULL, CLOCK_MONOTONIC, (uint64_t)(1e6 * seconds), 0, on_time,
					    NULL)) >= 0)
		r = sd_event_loop(event);
	sd_event_unref(event);
	return r;
}

/* A service of the configuration that said nothing. */
static int print_missing(const struct config *config, const struct listener *l, bool json)
{
	int missing = 0;
	for (int i = 0; i < config->service_count; i++) {
		const struct config_service *service = &config->service[i];
		bool heard = !service->enabled;
		for (int k = 0; k < l->count && !heard; k++)
			heard = strncmp((const char *)l->status[k].process, service->name,
					sizeof l->status[k].process) == 0;
		if (heard)
			continue;
		missing++;
		if (json)
			printf("{\"process\":\"%s\",\"state\":\"silent\"}\n", service->name);
		else
			printf("%-20s %7s  %-16s\n", service->name, "-", "silent");
	}
	return missing;
}

struct options {
	const char *config, *bus;
	bool json;
	double seconds;
};

/* 0 go on, 1 help given, 2 bad use. */
static int parse(struct options *o, const char *usage, int argc, char **argv)
{
	static const struct option table[] = {
		{"config", required_argument, NULL, 'c'}, {"bus", required_argument, NULL, 'b'},
		{"json", no_argument, NULL, 'j'},	  {"seconds", required_argument, NULL, 's'},
		{"help", no_argument, NULL, 'h'},	  {NULL, 0, NULL, 0}};
	*o = (struct options){config_default_path(), NULL, false, 1.5};
	int c;
	while ((c = getopt_long(argc, argv, "+c:h", table, NULL)) != -1) {
		if (c == 'c')
			o->config = optarg;
		else if (c == 'b')
			o->bus = optarg;
		else if (c == 'j')
			o->json = true;
		else if (c == 's' && !((o->seconds = strtod(optarg, NULL)) > 0 && o->seconds <= 3600)) {
			fprintf(stderr, "%s: --seconds: found \"%s\", allowed 0..3600\n", argv[0], optarg);
			return 2;
		} else if (c == 'h') {
			puts(usage);
			return 1;
		} else if (c == '?')
			return 2;
	}
	return 0;
}

/* Reads the configuration and opens the bus. 0 or the exit status after a message. */
static int open_bus(const struct options *o, const char *command, struct config *config, struct bus **bus)
{
	char err[512];
	if (config_load(config, o->config, err, sizeof err) < 0) {
		fprintf(stderr, "billiard %s: %s\n", command, err);
		return 2;
	}
	if (bus_open(bus, o->bus ? o->bus : bus_url(config->bus), err, sizeof err) < 0) {
		fprintf(stderr, "billiard %s: %s\n", command, err);
		return 2;
	}
	return 0;
}

int cmd_status(int argc, char **argv)
{
	struct options o;
	struct config config;
	struct bus *bus;
	int status = parse(&o,
			   "usage: billiard status [-c CONF] [--bus URL] [--json] [--seconds S]\nState, figures and "
			   "last error of each process; "
			   "exit status 1 when one is silent.",
			   argc, argv);
	if (status)
		return status == 1 ? 0 : 2;
	if ((status = open_bus(&o, "status", &config, &bus)))
		return status;
	struct listener *listener = calloc(1, sizeof *listener);
	if (listener &&
	    bus_subscribe(bus, &(struct bus_subscription){"STATUS", &bus_status, BUS_EACH, on_status, listener}) == 0 &&
	    listen_for(bus, o.seconds) >= 0) {
		for (int i = 0; i < listener->count; i++)
			(o.json ? print_json : print_line)(&listener->status[i]);
		status = print_missing(&config, listener, o.json) ? 1 : 0;
	} else {
		fprintf(stderr, "billiard status: cannot listen\n");
		status = 1;
	}
	bus_close(bus);
	free(listener);
	return status;
}

/* What can be said to the services, and what goes with it. */
enum argument { ARGUMENT_NONE, ARGUMENT_SECONDS, ARGUMENT_ID, ARGUMENT_FILE };
static const struct control {
	const char *name;
	enum argument argument;
} controls[] = {
	{"pause", ARGUMENT_NONE},
	{"resume", ARGUMENT_NONE},
	{"infinity", ARGUMENT_NONE},
	{"next", ARGUMENT_NONE},
	{"previous", ARGUMENT_NONE},
	{"halo", ARGUMENT_NONE},
	{"paths", ARGUMENT_NONE},
	{"table", ARGUMENT_NONE},
	{"info", ARGUMENT_NONE},
	{"animation", ARGUMENT_NONE},
	{"animation-stop", ARGUMENT_NONE},
	{"animation-restart", ARGUMENT_NONE},
	{"animation-seek", ARGUMENT_SECONDS},
	{"snapshot", ARGUMENT_FILE},
	{"cancel", ARGUMENT_ID},
};

static bool argument_fits(enum argument kind, const char *text)
{
	char *rest;
	if (kind == ARGUMENT_NONE || !text)
		return kind == ARGUMENT_NONE && !text;
	if (kind == ARGUMENT_SECONDS)
		return isfinite(strtod(text, &rest)) && rest != text && !*rest;
	if (kind == ARGUMENT_ID)
		return strtoll(text, &rest, 10) > 0 && !*rest;
	return *text != '\0';
}

/* The words of the command line as a command. 0, or 2 after a message. */
static int read_control(int count, char **word, billiard_command_t *command)
{
	static const char *const wanted[] = {"no argument", "seconds", "the id of a request", "a file"};
	if (count < 1 || count > 2 || strlen(word[count - 1]) >= sizeof command->argument)
		return cmd_bad_input("billiard control: a name (and at most one argument) is wanted; see --help");
	const char *argument = count == 2 ? word[1] : NULL;
	for (size_t i = 0; i < sizeof controls / sizeof controls[0]; i++) {
		if (strcmp(word[0], controls[i].name) != 0)
			continue;
		if (!argument_fits(controls[i].argument, argument))
			return cmd_bad_input("billiard control: %s: found \"%s\", wanted %s", word[0],
					     argument ? argument : "nothing", wanted[controls[i].argument]);
		text_set(command->name, sizeof command->name, word[0]);
		text_set(command->argument, sizeof command->argument, argument ? argument : "");
		return 0;
	}
	return cmd_bad_input("billiard control: no command has the name \"%s\"; see --help", word[0]);
}

int cmd_control(int argc, char **argv)
{
	struct options o;
	struct config config;
	struct bus *bus;
	int status = parse(&o,
			   "usage: billiard control [-c CONF] [--bus URL] NAME [ARGUMENT]\npause, resume, infinity, "
			   "next, previous, halo, paths, "
			   "table, info, animation, animation-stop,\nanimation-seek SECONDS, animation-restart, "
			   "snapshot FILE.png, "
			   "cancel ID",
			   argc, argv);
	if (status)
		return status == 1 ? 0 : 2;
	billiard_command_t command = {.utime = clock_utime()};
	if ((status = read_control(argc - optind, argv + optind, &command)))
		return status;
	if ((status = open_bus(&o, "control", &config, &bus)))
		return status;
	status = bus_publish(bus, "COMMAND", &bus_command, &command) < 0;
	bus_close(bus);
	return status;
}
