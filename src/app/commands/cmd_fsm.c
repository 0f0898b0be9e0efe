/* billiard fsm: the controller's table of states and events. */
#include <stdio.h>

#include "app/commands/cmd.h"
#include "app/control/fsm.h"

struct fsm_line {
	bool dot;
};

static const struct option_row rows[] = {
	{.name = "dot",
	 .type = OPTION_FLAG,
	 .offset = offsetof(struct fsm_line, dot),
	 .help = "as a drawing for Graphviz's dot"},
	{.name = NULL},
};

const struct options fsm_options = {
	.name = "fsm",
	.summary = "prints the controller's states and what leads from one to another",
	.operands = "",
	.wants = "takes no words",
	.row = rows,
	.notes = "One line for each state and event that is not \"stay\": STATE EVENT NEXT / ACTIONS.",
};

int cmd_fsm(int argc, char **argv)
{
	struct fsm_line line = {false};
	int first, status = cmd_options(&fsm_options, argc, argv, &line, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	if (line.dot)
		fsm_write_dot(stdout);
	else
		fsm_write_lines(stdout);
	return CMD_OK;
}
