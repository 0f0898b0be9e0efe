#include "app/process/process_options.h"

#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/config.h"
#include "app/process/version.h"

/* The options of one program: those it alone has, then those that all have. */
struct option_set {
	const char *program, *usage;
	struct option options[8];
};
enum { OPT_BUS = 256, OPT_SOURCE, OPT_HOLD, OPT_POSITION };
#define COMMON_OPTIONS                                                                                                 \
	{"config", required_argument, NULL, 'c'}, {"bus", required_argument, NULL, OPT_BUS},                           \
		{"help", no_argument, NULL, 'h'}, {"version", no_argument, NULL, 'v'},                                 \
	{                                                                                                              \
		NULL, 0, NULL, 0                                                                                       \
	}

static const struct option_set option_sets[] = {
	{"billiard-vision",
	 " [--source v4l2:/dev/videoN|dir:FOLDER|file:VIDEO|lcm:CHANNEL] [--hold SECONDS]",
	 {{"source", required_argument, NULL, OPT_SOURCE},
	  {"hold", required_argument, NULL, OPT_HOLD},
	  COMMON_OPTIONS}},
	{"billiard-table", " [--position FILE]", {{"position", required_argument, NULL, OPT_POSITION}, COMMON_OPTIONS}},
	{"", "", {COMMON_OPTIONS}},
};

static const struct option_set *options_of(const char *program)
{
	const struct option_set *set = option_sets;
	while (set->program[0] && strcmp(set->program, program) != 0)
		set++;
	return set;
}

static int parse_hold(const char *text, double *out)
{
	char *rest;
	double value = strtod(text, &rest);
	if (rest == text || *rest || !(value > 0 && value <= 3600)) {
		fprintf(stderr, "billiard-vision: --hold: found \"%s\", allowed seconds in 0..3600\n", text);
		return -EINVAL;
	}
	*out = value;
	return 0;
}

int process_parse(struct process_options *out, const char *name, int argc, char **argv)
{
	const struct option_set *set = options_of(name);
	*out = (struct process_options){.config = config_default_path(), .hold = 4};
	int c;
	while ((c = getopt_long(argc, argv, "c:h", set->options, NULL)) != -1) {
		switch (c) {
		case 'c':
			out->config = optarg;
			break;
		case OPT_BUS:
			out->bus = optarg;
			break;
		case OPT_SOURCE:
			out->source = optarg;
			break;
		case OPT_POSITION:
			out->position = optarg;
			break;
		case OPT_HOLD:
			if (parse_hold(optarg, &out->hold) < 0)
				return -EINVAL;
			break;
		case 'h':
			printf("usage: %s [-c CONF] [--bus URL]%s\n", name, set->usage);
			return 1;
		case 'v':
			printf("%s %s\n", name, BILLIARD_VERSION);
			return 1;
		default:
			return -EINVAL;
		}
	}
	if (optind < argc) {
		fprintf(stderr, "%s: unexpected argument \"%s\"\n", name, argv[optind]);
		return -EINVAL;
	}
	return 0;
}
