/* billiard judge: what was believed, asked for and drawn, against what was there. */
#include <limits.h>

#include "app/commands/cmd.h"
#include "app/commands/cmd_judge.h"

enum { KEEP = 5, KEEP_MAX = 60, SECONDS_MAX = 7 * 24 * 3600 }; /* s */

/* A table is read by its columns. */
/* clang-format off */
#define AT(member) offsetof(struct judge_options, member)
static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct judge_options),
	CMD_BUS_ROW(struct judge_options),
	{.name = "live", .type = OPTION_FLAG, .offset = AT(live), .help = "the bus until Ctrl-C instead of logs"},
	{.name = "seconds",
	 .type = OPTION_NUMBER,
	 .offset = AT(seconds),
	 .value = "S",
	 .help = "ends --live after so long",
	 .low = 0.1,
	 .high = SECONDS_MAX},
	{.name = "shots",
	 .type = OPTION_NUMBER,
	 .offset = AT(shots),
	 .value = "N",
	 .help = "ends --live after so many shots",
	 .low = 1,
	 .high = 1e6},
	{.name = "replay",
	 .type = OPTION_FLAG,
	 .offset = AT(replay),
	 .help = "plays the CAMERA messages of each log to a fresh billiard-vision and judges what it sees at the end"},
	{.name = "out",
	 .type = OPTION_FILE,
	 .offset = AT(out),
	 .value = "DIR",
	 .help = "where wrong rests leave replays"},
	{.name = "keep",
	 .type = OPTION_NUMBER,
	 .offset = AT(keep),
	 .value = "S",
	 .help = "how long those are, default 5",
	 .low = 0.1,
	 .high = KEEP_MAX},
	{.name = "json", .type = OPTION_FLAG, .offset = AT(json), .help = "one JSON object per log"},
	{.name = NULL},
};
/* clang-format on */

const struct options judge_options = {
	.name = "judge",
	.summary = "what was believed, asked for and drawn, against the truth",
	.operands = "LOG... | --live",
	.operand_max = INT_MAX,
	.wants = "no log",
	.row = rows,
	.notes = "Compares TABLE_STATE, PLAN_REQUEST, PLAN and DRAW with TRUTH over whole runs.",
};

/* What the table cannot say: which options go together. */
static int check(const struct judge_options *o, const char *name, int logs)
{
	if (o->live && (o->replay || logs > 0))
		return cmd_usage(name, "--live takes no log");
	return o->live || logs > 0 ? CMD_OK : cmd_usage(name, judge_options.wants);
}

int cmd_judge(int argc, char **argv)
{
	struct judge_options options = {.keep = KEEP};
	struct config config;
	int first, status = cmd_options(&judge_options, argc, argv, &options, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	status = check(&options, argv[0], argc - first);
	if (status != CMD_OK)
		return status;
	status = cmd_config(&config, options.config);
	if (status != CMD_OK)
		return status;
	if (options.replay)
		return cmd_judge_replay(&config, &options, argc - first, argv + first);
	if (options.live)
		return cmd_judge_live(&config, &options);
	return cmd_judge_logs(&config, &options, argc - first, argv + first);
}
