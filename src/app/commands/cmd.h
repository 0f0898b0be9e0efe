/* The commands of `billiard`, and what they share. Each gets argv[0] = "billiard NAME" and its own options, and returns
 * the exit status: 0, 1 (it was tried and failed), 2 after one line on stderr (bad input). */
#ifndef BILLIARD_APP_CMD_H
#define BILLIARD_APP_CMD_H

#include <jansson.h>

#include "app/config/config.h"

enum { CMD_OK = 0, CMD_FAILED = 1, CMD_BAD_INPUT = 2, CMD_ERROR_SIZE = 640 };

int cmd_detect(int argc, char **argv);
int cmd_plan(int argc, char **argv);
int cmd_simulate(int argc, char **argv);
int cmd_calibrate(int argc, char **argv);
int cmd_run(int argc, char **argv);
int cmd_status(int argc, char **argv);
int cmd_control(int argc, char **argv);
int cmd_demo(int argc, char **argv);
int cmd_judge(int argc, char **argv);

/* One line on stderr. Returns CMD_BAD_INPUT. */
int cmd_bad_input(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* One line on stderr that ends in "(see NAME --help)". Returns CMD_BAD_INPUT. */
int cmd_usage(const char *name, const char *reason);

/* A file could not be written: one line on stderr, reason as save_file() gives it. CMD_BAD_INPUT when the place is none
 * (no such folder, no permission), CMD_FAILED when it was tried (a full disk). */
int cmd_not_written(int code, const char *reason);

/* Reads a configuration; path NULL: config_default_path(). CMD_OK, or CMD_BAD_INPUT after one line on stderr. */
int cmd_config(struct config *config, const char *path);

/* A finite decimal number within [low, high] and nothing else. CMD_OK, or CMD_BAD_INPUT after one line on stderr that
 * names the option; *out is untouched then. */
int cmd_number(const char *option, const char *text, double low, double high, double *out);
/* The same for whole numbers. */
int cmd_whole(const char *option, const char *text, int low, int high, int *out);

/* One line of NDJSON on stdout (compact, 10 significant digits); takes the reference. CMD_OK, or CMD_FAILED when it
 * cannot be written or object is NULL. */
int cmd_json_line(json_t *object);

#endif
