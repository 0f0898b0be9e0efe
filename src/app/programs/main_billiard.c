/* billiard COMMAND: the command line for people and scripts. */
#include <getopt.h>
#include <stdio.h>
#include <string.h>

#include "app/commands/cmd.h"
#include "app/process/version.h"

static int cmd_help(int argc, char **argv);
static const struct options help_options;

static const struct command {
	const struct options *options;
	int (*run)(int argc, char **argv);
} command_table[] = {
	{&detect_options, cmd_detect},	   {&calibrate_options, cmd_calibrate},
	{&simulate_options, cmd_simulate}, {&plan_options, cmd_plan},
	{&run_options, cmd_run},	   {&status_options, cmd_status},
	{&control_options, cmd_control},   {&demo_options, cmd_demo},
	{&judge_options, cmd_judge},	   {&match_options, cmd_match},
	{&fsm_options, cmd_fsm},	   {&help_options, cmd_help},
};
enum { COMMAND_COUNT = sizeof command_table / sizeof *command_table };

static const struct command *find(const char *name)
{
	for (int i = 0; i < COMMAND_COUNT; i++)
		if (strcmp(name, command_table[i].options->name) == 0)
			return &command_table[i];
	return NULL;
}

static void help(void)
{
	puts("usage: billiard COMMAND [OPTION...]\n\ncommands:");
	for (int i = 0; i < COMMAND_COUNT; i++)
		printf("  %-10s %s\n", command_table[i].options->name, command_table[i].options->summary);
	puts("\n`billiard COMMAND --help` says more. Exit status: 0, 1 failed, 2 bad input.");
}

static int unknown(const char *name)
{
	return cmd_bad_input("billiard: unknown command \"%.40s\" (see billiard --help)", name);
}

/* ---- help: the same tables for people, man and the shell --------------------------------------------------------- */

struct help_line {
	bool man, complete;
};

static const struct option_row help_rows[] = {
	{.name = "man", .type = OPTION_FLAG, .offset = offsetof(struct help_line, man), .help = "as a man page"},
	{.name = "complete",
	 .type = OPTION_FLAG,
	 .offset = offsetof(struct help_line, complete),
	 .help = "words that may follow, for a shell"},
	{.name = NULL},
};

static const struct options help_options = {
	.name = "help",
	.summary = "what a command takes",
	.operands = "[COMMAND [--OPTION]]",
	.operand_max = 2,
	.wants = "wants a command",
	.in_order = true,
	.row = help_rows,
	.notes = "",
};

static void man(void)
{
	printf(".TH BILLIARD 1 \"\" \"billiard " BILLIARD_VERSION
	       "\"\n.SH NAME\nbilliard \\- an assistant for a snooker "
	       "table\n.SH SYNOPSIS\n.B billiard\nCOMMAND [OPTION...]\n.SH COMMANDS\n");
	for (int i = 0; i < COMMAND_COUNT; i++) {
		const struct options *options = command_table[i].options;
		printf(".TP\n.BR billiard\\-%s (1)\n%s\n", options->name, options->summary);
	}
}

static void complete_commands(void)
{
	for (int i = 0; i < COMMAND_COUNT; i++)
		puts(command_table[i].options->name);
}

static int help_all(const struct help_line *line)
{
	if (line->man)
		man();
	else if (line->complete)
		complete_commands();
	else
		help();
	return CMD_OK;
}

static int cmd_help(int argc, char **argv)
{
	struct help_line line = {false, false};
	int first, status = cmd_options(&help_options, argc, argv, &line, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	if (!argv[first])
		return help_all(&line);
	const struct command *command = find(argv[first]);
	if (!command)
		return unknown(argv[first]);
	if (line.man)
		options_man(command->options, BILLIARD_VERSION, stdout);
	else if (line.complete)
		options_complete(command->options, argv[first + 1], stdout);
	else
		options_help(command->options, stdout);
	return CMD_OK;
}

/* ---- the command ------------------------------------------------------------------------------------------------- */

static int run(const struct command *command, int argc, char **argv)
{
	char name[48];
	snprintf(name, sizeof name, "billiard %s", command->options->name);
	argv[0] = name;
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
	const struct command *command = find(argv[optind]);
	return command ? run(command, argc - optind, argv + optind) : unknown(argv[optind]);
}
