/* billiard judge: what was believed, asked for and drawn, against what was there. */
#include <getopt.h>
#include <stdio.h>

#include "app/commands/cmd.h"
#include "app/commands/cmd_judge.h"

static const double KEEP = 5, KEEP_MAX = 60;	 /* s */
static const double SECONDS_MAX = 7 * 24 * 3600; /* s */

static void help(void)
{
	puts("usage: billiard judge [-c CONF] [--json] [--out DIR] [--keep S] (LOG... | --live [--bus URL] [--seconds "
	     "S])\n"
	     "       billiard judge [-c CONF] [--json] --replay LOG...\n"
	     "Compares TABLE_STATE, PLAN_REQUEST, PLAN and DRAW with TRUTH over whole runs, from LCM logs or from the\n"
	     "bus until Ctrl-C; wrong rests leave replays of S seconds (5) in DIR. --replay plays the CAMERA messages "
	     "of\n"
	     "each log to a fresh billiard-vision and compares what it sees at the end with the last TRUTH.");
}

enum { OPTION_LIVE = 256, OPTION_REPLAY, OPTION_JSON, OPTION_OUT, OPTION_KEEP, OPTION_SECONDS, OPTION_BUS };

static int take(struct judge_options *o, int c)
{
	switch (c) {
	case 'c':
		o->config = optarg;
		return CMD_OK;
	case OPTION_LIVE:
		o->live = true;
		return CMD_OK;
	case OPTION_REPLAY:
		o->replay = true;
		return CMD_OK;
	case OPTION_JSON:
		o->json = true;
		return CMD_OK;
	case OPTION_OUT:
		o->out = optarg;
		return CMD_OK;
	case OPTION_BUS:
		o->bus = optarg;
		return CMD_OK;
	case OPTION_KEEP:
		return cmd_number("billiard judge: --keep", optarg, 0.1, KEEP_MAX, &o->keep);
	case OPTION_SECONDS:
		return cmd_number("billiard judge: --seconds", optarg, 0.1, SECONDS_MAX, &o->seconds);
	default:
		return CMD_BAD_INPUT;
	}
}

/* CMD_OK; CMD_BAD_INPUT after a message; -1 when help was given. */
static int parse(struct judge_options *o, int argc, char **argv)
{
	static const struct option table[] = {{"config", required_argument, NULL, 'c'},
					      {"live", no_argument, NULL, OPTION_LIVE},
					      {"replay", no_argument, NULL, OPTION_REPLAY},
					      {"json", no_argument, NULL, OPTION_JSON},
					      {"out", required_argument, NULL, OPTION_OUT},
					      {"keep", required_argument, NULL, OPTION_KEEP},
					      {"seconds", required_argument, NULL, OPTION_SECONDS},
					      {"bus", required_argument, NULL, OPTION_BUS},
					      {"help", no_argument, NULL, 'h'},
					      {NULL, 0, NULL, 0}};
	*o = (struct judge_options){.keep = KEEP};
	int c;
	while ((c = getopt_long(argc, argv, "c:h", table, NULL)) != -1) {
		if (c == 'h') {
			help();
			return -1;
		}
		int status = take(o, c);
		if (status != CMD_OK)
			return status;
	}
	int logs = argc - optind;
	if (o->live && (o->replay || logs > 0))
		return cmd_usage(argv[0], "--live takes no log");
	if (!o->live && logs == 0)
		return cmd_usage(argv[0], "no log");
	return CMD_OK;
}

int cmd_judge(int argc, char **argv)
{
	struct judge_options options;
	struct config config;
	int status = parse(&options, argc, argv);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	status = cmd_config(&config, options.config);
	if (status != CMD_OK)
		return status;
	if (options.replay)
		return cmd_judge_replay(&config, &options, argc - optind, argv + optind);
	if (options.live)
		return cmd_judge_live(&config, &options);
	return cmd_judge_logs(&config, &options, argc - optind, argv + optind);
}
