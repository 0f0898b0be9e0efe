/* The commands of `billiard`, and what they share. Each gets argv[0] = "billiard NAME" and its own options, and returns
 * the exit status: 0, 1 (it was tried and failed), 2 after one line on stderr (bad input). */
#ifndef BILLIARD_APP_CMD_H
#define BILLIARD_APP_CMD_H

#include <jansson.h>

#include "app/config/config.h"
#include "app/process/options.h"

enum { CMD_OK = 0, CMD_FAILED = 1, CMD_BAD_INPUT = 2, CMD_ERROR_SIZE = 640 };

extern const struct options detect_options, plan_options, simulate_options, calibrate_options, run_options,
	status_options, control_options, demo_options, judge_options, match_options, fsm_options;
int cmd_detect(int argc, char **argv);
int cmd_plan(int argc, char **argv);
int cmd_simulate(int argc, char **argv);
int cmd_calibrate(int argc, char **argv);
int cmd_run(int argc, char **argv);
int cmd_status(int argc, char **argv);
int cmd_control(int argc, char **argv);
int cmd_demo(int argc, char **argv);
int cmd_judge(int argc, char **argv);
int cmd_match(int argc, char **argv);
int cmd_fsm(int argc, char **argv);

/* The row of -c, --config into the member of that type. */
#define CMD_CONFIG_ROW(line)                                                                                           \
	{                                                                                                              \
		.name = "config", .letter = 'c', .type = OPTION_FILE, .offset = offsetof(line, config),                \
		.value = "CONF", .help = "table, default $BILLIARD_CONF or the installed one"                          \
	}

/* The same for --bus. */
#define CMD_BUS_ROW(line)                                                                                              \
	{                                                                                                              \
		.name = "bus", .type = OPTION_TEXT, .offset = offsetof(line, bus), .value = "URL",                     \
		.help = "LCM URL instead of $LCM_DEFAULT_URL or the configuration's"                                   \
	}

/* One line on stderr. Returns CMD_BAD_INPUT. */
int cmd_bad_input(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* One line on stderr that ends in "(see NAME --help)". Returns CMD_BAD_INPUT. */
int cmd_usage(const char *name, const char *reason);

/* A file could not be written: one line on stderr, reason as save_file() gives it. CMD_BAD_INPUT when the place is none
 * (no such folder, no permission), CMD_FAILED when it was tried (a full disk). */
int cmd_not_written(int code, const char *reason);

/* options_read() with an exit status: CMD_OK; CMD_BAD_INPUT; -1 when --help has answered. */
int cmd_options(const struct options *options, int argc, char **argv, void *out, int *first);

/* Reads a configuration; path NULL: config_default_path(). CMD_OK, or CMD_BAD_INPUT after one line on stderr. */
int cmd_config(struct config *config, const char *path);

struct bus;
/* Opens url, or what $LCM_DEFAULT_URL and the configuration say when it is NULL. CMD_OK, or CMD_BAD_INPUT after one line
 * on stderr. Caller closes. */
int cmd_bus(struct bus **out, const char *url, const struct config *config);

/* A JSON string of a text that comes from outside: bytes that are no UTF-8 become '?'. */
json_t *cmd_json_text(const char *text);

/* One line of NDJSON on stdout (compact, 10 significant digits); takes the reference. CMD_OK, or CMD_FAILED when it
 * cannot be written or object is NULL. */
int cmd_json_line(json_t *object);

#endif
