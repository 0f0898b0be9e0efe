/* billiard run: all services of a configuration, without systemd. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "app/commands/cmd.h"
#include "app/config/config.h"
#include "app/process/bus.h"
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

/* Two sets of services on one bus would answer each other. The name is gone with the process, and is that of a network
 * namespace, as the bus is. CMD_OK, or CMD_FAILED after one line on stderr. */
static int claim_bus(const char *url)
{
	struct sockaddr_un name = {.sun_family = AF_UNIX};
	/* sun_path begins with a zero: a name without a file */
	snprintf(name.sun_path + 1, sizeof name.sun_path - 1, "billiard-run %s", url);
	int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
	if (fd >= 0 && bind(fd, (struct sockaddr *)&name, sizeof name) == 0)
		return CMD_OK; /* held until the process ends */
	fprintf(stderr, "billiard run: %s: %s\n", url,
		errno == EADDRINUSE ? "another billiard run is on this bus" : strerror(errno));
	return CMD_FAILED;
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

struct run_line {
	const char *config, *bus;
};

/* A table is read by its columns. */
/* clang-format off */
static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct run_line),
	CMD_BUS_ROW(struct run_line),
	{.name = NULL},
};
/* clang-format on */

const struct options run_options = {
	.name = "run",
	.summary = "starts all services of a configuration",
	.operands = "",
	.row = rows,
	.notes = "Ctrl-C stops them.",
};

int cmd_run(int argc, char **argv)
{
	struct run_line options = {.config = config_default_path()};
	int first, status = cmd_options(&run_options, argc, argv, &options, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	struct config config;
	status = cmd_config(&config, options.config);
	if (status == CMD_OK)
		status = claim_bus(options.bus ? options.bus : bus_url(config.bus));
	return status == CMD_OK ? run(&config, options.config, options.bus) : status;
}
