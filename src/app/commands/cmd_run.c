/* billiard run: all services of a configuration, without systemd. */
#include <getopt.h>
#include <signal.h>
#include <stdio.h>

#include "app/commands/cmd.h"
#include "app/config/config.h"
#include "app/process/supervisor.h"

static int on_signal(sd_event_source *source, const struct signalfd_siginfo *info, void *context)
{
	(void)source, (void)info;
	supervisor_stop(context, 0);
	return 0;
}

static int watch(struct supervisor *s, int number)
{
	sigset_t set;
	sigemptyset(&set);
	sigaddset(&set, number);
	sigprocmask(SIG_BLOCK, &set, NULL);
	return sd_event_add_signal(s->event, NULL, number, on_signal, s);
}

static int run(const struct config *config, const char *path, const char *bus)
{
	char err[512];
	struct supervisor supervisor;
	sd_event *event;
	if (sd_event_new(&event) < 0)
		return 1;
	supervisor_init(&supervisor, event, path, bus);
	int status = watch(&supervisor, SIGINT) < 0 || watch(&supervisor, SIGTERM) < 0;
	for (int i = 0; i < config->service_count && status == 0; i++) {
		const struct config_service *service = &config->service[i];
		if (!service->enabled)
			continue;
		if (supervisor_start(&supervisor, service->name, service->arguments, err, sizeof err) < 0) {
			fprintf(stderr, "billiard run: %s\n", err);
			status = 1;
		}
	}
	if (status == 0) {
		fprintf(stderr, "billiard run: %d services, Ctrl-C stops them\n", supervisor.count);
		int r = sd_event_loop(event);
		status = r < 0 ? 1 : r;
	}
	supervisor_finish(&supervisor);
	sd_event_unref(event);
	return status;
}

int cmd_run(int argc, char **argv)
{
	static const struct option table[] = {{"config", required_argument, NULL, 'c'},
					      {"bus", required_argument, NULL, 'b'},
					      {"help", no_argument, NULL, 'h'},
					      {NULL, 0, NULL, 0}};
	const char *path = config_default_path(), *bus = NULL;
	int c;
	while ((c = getopt_long(argc, argv, "c:h", table, NULL)) != -1) {
		if (c == 'h') {
			puts("usage: billiard run [-c CONF] [--bus URL]\nStarts the services of the configuration; "
			     "Ctrl-C stops them.");
			return 0;
		}
		if (c == '?')
			return 2;
		*(c == 'c' ? &path : &bus) = optarg;
	}
	if (optind < argc) {
		fprintf(stderr, "billiard run: unexpected argument \"%s\"\n", argv[optind]);
		return 2;
	}
	char err[512];
	struct config config;
	if (config_load(&config, path, err, sizeof err) < 0) {
		fprintf(stderr, "billiard run: %s\n", err);
		return 2;
	}
	return run(&config, path, bus);
}
