/* billiard COMMAND: the command line for people and scripts. */
#include <getopt.h>
#include <stdio.h>
#include <string.h>

#include "app/commands/cmd.h"
#include "app/process/version.h"

static const struct command {
	const char *name, *summary;
	int (*run)(int argc, char **argv);
} command_table[] = {
	{"detect", "balls in photographs", cmd_detect},
	{"calibrate", "colour parameters from photographs", cmd_calibrate},
	{"simulate", "what a shot does, event by event", cmd_simulate},
	{"plan", "the best shots from a position", cmd_plan},
	{"run", "starts all services of a configuration", cmd_run},
	{"status", "how the running services are", cmd_status},
	{"control", "tells the running services something", cmd_control},
	{"judge", "what was believed, asked for and drawn, against the truth", cmd_judge},
	{"demo", "the whole loop on the virtual table or on photographs", cmd_demo},
};
enum { COMMAND_COUNT = sizeof command_table / sizeof *command_table };

static void help(void)
{
	puts("usage: billiard COMMAND [OPTION...]\n\ncommands:");
	for (int i = 0; i < COMMAND_COUNT; i++)
		printf("  %-10s %s\n", command_table[i].name, command_table[i].summary);
	puts("\n`billiard COMMAND --help` says more. Exit status: 0, 1 failed, 2 bad input.");
}

static int run(const struct command *command, int argc, char **argv)
{
	char name[48];
	snprintf(name, sizeof name, "billiard %s", command->name);
	argv[0] = name;
	optind = 0; /* glibc: begin anew, with that command's own options */
	int status = command->run(argc, argv);
	if (fflush(stdout) == EOF && status == CMD_OK) {
		fprintf(stderr, "%s: cannot write the output\n", name);
		return CMD_FAILED;
	}
	return status;
}

int main(int argc, char **argv)
{
	static const struct option options[] = {
		{"help", no_argument, NULL, 'h'},
		{"version", no_argument, NULL, 'v'},
		{NULL, 0, NULL, 0},
	};
	int c;
	while ((c = getopt_long(argc, argv, "+h", options, NULL)) != -1) {
		if (c == 'h') {
			help();
			return CMD_OK;
		}
		if (c != 'v')
			return CMD_BAD_INPUT;
		puts("billiard " BILLIARD_VERSION);
		return CMD_OK;
	}
	if (optind == argc)
		return cmd_usage("billiard", "no command");
	for (int i = 0; i < COMMAND_COUNT; i++)
		if (strcmp(argv[optind], command_table[i].name) == 0)
			return run(&command_table[i], argc - optind, argv + optind);
	return cmd_bad_input("billiard: unknown command \"%.40s\" (see billiard --help)", argv[optind]);
}
