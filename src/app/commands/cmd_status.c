/* billiard status: what each process says of itself on the bus. */
#include <stdio.h>
#include <stdlib.h>

#include "app/commands/cmd.h"
#include "app/commands/status_listen.h"
#include "app/commands/status_print.h"

struct status_line {
	const char *config, *bus;
	double seconds;
	bool json;
};

/* A table is read by its columns. */
/* clang-format off */
#define AT(member) offsetof(struct status_line, member)
static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct status_line),
	CMD_BUS_ROW(struct status_line),
	{.name = "seconds",
	 .type = OPTION_NUMBER,
	 .offset = AT(seconds),
	 .value = "S",
	 .help = "listens so long, default 1.5",
	 .low = 0.001,
	 .high = 3600},
	{.name = "json", .type = OPTION_FLAG, .offset = AT(json), .help = "one JSON object per process"},
	{.name = NULL},
};
/* clang-format on */

const struct options status_options = {
	.name = "status",
	.summary = "how the running services are",
	.operands = "",
	.row = rows,
	.notes =
		"State, figures and last error of each process. Exit status 1 when one of the configuration is silent.",
};

static int print_silent(const char *name, bool json)
{
	if (json)
		return cmd_json_line(json_pack("{s:o,s:s}", "process", cmd_json_text(name), "state", "silent"));
	printf("%-20s %7s  %-16s\n", name, "-", "silent");
	return CMD_OK;
}

/* Services of the configuration that said nothing: CMD_FAILED when there is one. */
static int print_missing(const struct config *config, const struct status_heard *heard, bool json)
{
	int status = CMD_OK;
	for (int i = 0; i < config->service_count; i++) {
		const struct config_service *service = &config->service[i];
		if (!service->enabled || status_knows(heard, service->name))
			continue;
		print_silent(service->name, json);
		status = CMD_FAILED;
	}
	return status;
}

static int print_heard(const struct status_heard *heard, bool json)
{
	int status = CMD_OK;
	for (int i = 0; i < heard->count && status == CMD_OK; i++) {
		if (json)
			status = cmd_json_line(status_json(&heard->status[i]));
		else
			status_print_line(&heard->status[i], stdout);
	}
	return status;
}

static int listen_and_print(const struct status_line *line, const struct config *config, struct bus *bus)
{
	struct status_heard *heard = calloc(1, sizeof *heard);
	int status = CMD_FAILED;
	if (!heard || status_listen(heard, bus, line->seconds) < 0) {
		fprintf(stderr, "billiard status: cannot listen\n");
	} else {
		status = print_heard(heard, line->json);
		int missing = print_missing(config, heard, line->json);
		status = status != CMD_OK ? status : missing;
	}
	free(heard);
	return status;
}

int cmd_status(int argc, char **argv)
{
	struct status_line line = {.seconds = 1.5};
	struct config config;
	struct bus *bus;
	int first, status = cmd_options(&status_options, argc, argv, &line, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	if ((status = cmd_config(&config, line.config)) != CMD_OK ||
	    (status = cmd_bus(&bus, line.bus, &config)) != CMD_OK)
		return status;
	status = listen_and_print(&line, &config, bus);
	bus_close(bus);
	return status;
}
