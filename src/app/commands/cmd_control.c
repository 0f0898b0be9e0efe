/* billiard control: a COMMAND to the services. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/cmd.h"
#include "app/process/bus.h"
#include "app/process/clock.h"
#include "app/process/text.h"

/* What can be said to the services, and what goes with it. */
enum argument { ARGUMENT_NONE, ARGUMENT_SECONDS, ARGUMENT_ID, ARGUMENT_FILE, ARGUMENT_FAULT, ARGUMENT_GAME };
static const char *const wanted[] = {
	"no argument",
	"seconds",
	"the id of a request",
	"a file",
	"a fault and its seconds in one word",
	"a correction in one word (quotes): \"undo\", \"score 12 0\", \"turn 2\", \"on red\", ..."};

/* A table is read by its columns. */
/* clang-format off */
#define CONTROLS(ROW)                                                                                                  \
	ROW("pause", ARGUMENT_NONE)                                                                                    \
	ROW("resume", ARGUMENT_NONE)                                                                                   \
	ROW("infinity", ARGUMENT_NONE) ROW("next", ARGUMENT_NONE) ROW("previous", ARGUMENT_NONE)                       \
		ROW("halo", ARGUMENT_NONE) ROW("paths", ARGUMENT_NONE) ROW("table", ARGUMENT_NONE)                     \
			ROW("info", ARGUMENT_NONE) ROW("animation", ARGUMENT_NONE)                                     \
				ROW("animation-stop", ARGUMENT_NONE) ROW("animation-restart", ARGUMENT_NONE)           \
					ROW("animation-seek", ARGUMENT_SECONDS) ROW("snapshot", ARGUMENT_FILE)         \
						ROW("cancel", ARGUMENT_ID) ROW("fault", ARGUMENT_FAULT)     \
							ROW("game", ARGUMENT_GAME)
/* clang-format on */

#define AS_CONTROL(name, argument) {name, argument},
#define AS_NAME(name, argument)	   ", " name
static const struct control {
	const char *name;
	enum argument argument;
} controls[] = {CONTROLS(AS_CONTROL)};

static const char *control_names(void)
{
	static const char list[] = CONTROLS(AS_NAME);
	return &list[2]; /* without the first comma */
}

struct control_line {
	const char *config, *bus;
};

static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct control_line),
	CMD_BUS_ROW(struct control_line),
	{.name = NULL},
};

const struct options control_options = {
	.name = "control",
	.summary = "tells the running services something",
	.operands = "NAME [ARGUMENT]",
	.operand_min = 1,
	.operand_max = 2,
	.wants = "a name (and at most one argument) is wanted",
	.in_order = true,
	.operand_names = control_names,
	.row = rows,
	.notes = "pause, resume, infinity, next, previous, halo, paths, table, info, animation, animation-stop,\n"
		 "animation-seek SECONDS, animation-restart, snapshot FILE.png, cancel ID, fault \"NAME SECONDS\",\n"
		 "game \"undo\", game \"score A B\", game \"turn 1|2\", game \"on red|colour|clearance\",\n"
		 "game \"hand on|off\", game \"foul 4..7\", game \"again\", game \"frame\"",
};

static bool is_id(const char *text)
{
	errno = 0;
	return text[0] && text[strspn(text, "0123456789")] == '\0' && strtoll(text, NULL, 10) > 0 && errno == 0;
}

static bool argument_fits(enum argument kind, const char *text)
{
	double seconds;
	switch (kind) {
	case ARGUMENT_NONE:
		return !text;
	case ARGUMENT_SECONDS:
		return text && option_number(text, -1e6, 1e6, &seconds);
	case ARGUMENT_ID:
		return text && is_id(text);
	case ARGUMENT_FILE:
	case ARGUMENT_FAULT:
	case ARGUMENT_GAME:
		return text && *text;
	}
	return false;
}

/* The words of the command line as a command; argument NULL: none. */
static int read_control(const char *name, const char *argument, billiard_command_t *command)
{
	if (argument && strlen(argument) >= sizeof command->argument)
		return cmd_bad_input("billiard control: %s: an argument of more than %zu bytes", name,
				     sizeof command->argument - 1);
	for (size_t i = 0; i < sizeof controls / sizeof controls[0]; i++) {
		if (strcmp(name, controls[i].name) != 0)
			continue;
		if (!argument_fits(controls[i].argument, argument))
			return cmd_bad_input("billiard control: %s: found \"%s\", wanted %s", name,
					     argument ? argument : "nothing", wanted[controls[i].argument]);
		text_set(command->name, sizeof command->name, name);
		text_set(command->argument, sizeof command->argument, argument ? argument : "");
		return CMD_OK;
	}
	return cmd_bad_input("billiard control: no command has the name \"%.40s\"; see --help", name);
}

int cmd_control(int argc, char **argv)
{
	struct control_line line = {0};
	struct config config;
	struct bus *bus;
	int first, status = cmd_options(&control_options, argc, argv, &line, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	billiard_command_t command = {.utime = clock_utime()};
	if ((status = read_control(argv[first], argv[first + 1], &command)) != CMD_OK ||
	    (status = cmd_config(&config, line.config)) != CMD_OK ||
	    (status = cmd_bus(&bus, line.bus, &config)) != CMD_OK)
		return status;
	status = bus_publish(bus, "COMMAND", &bus_command, &command) < 0 ? CMD_FAILED : CMD_OK;
	bus_close(bus);
	return status;
}
