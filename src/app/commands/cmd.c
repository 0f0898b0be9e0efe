#include "app/commands/cmd.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/bus.h"
#include "app/process/text.h"

int cmd_bad_input(const char *format, ...)
{
	va_list args;
	va_start(args, format);
	vfprintf(stderr, format, args);
	va_end(args);
	fputc('\n', stderr);
	return CMD_BAD_INPUT;
}

int cmd_usage(const char *name, const char *reason)
{
	return cmd_bad_input("%s: %s (see %s --help)", name, reason, name);
}

int cmd_options(const struct options *options, int argc, char **argv, void *out, int *first)
{
	enum options_outcome outcome = options_read(options, argc, argv, out, first);
	return outcome == OPTIONS_READ ? CMD_OK : outcome == OPTIONS_ANSWERED ? -1 : CMD_BAD_INPUT;
}

int cmd_not_written(int code, const char *reason)
{
	cmd_bad_input("%s", reason);
	bool place = code == -ENOENT || code == -ENOTDIR || code == -EISDIR || code == -EACCES || code == -EROFS ||
		     code == -ENAMETOOLONG || code == -EPERM;
	return place ? CMD_BAD_INPUT : CMD_FAILED;
}

int cmd_config(struct config *config, const char *path)
{
	char err[CMD_ERROR_SIZE];
	if (config_load(config, path ? path : config_default_path(), err, sizeof err) < 0)
		return cmd_bad_input("%s", err);
	return CMD_OK;
}

int cmd_bus(struct bus **out, const char *url, const struct config *config)
{
	char err[CMD_ERROR_SIZE];
	if (bus_open(out, url ? url : bus_url(config->bus), err, sizeof err) < 0)
		return cmd_bad_input("%s", err);
	return CMD_OK;
}

json_t *cmd_json_text(const char *text)
{
	char clean[CMD_ERROR_SIZE];
	json_t *string = json_string(text);
	if (string)
		return string;
	text_get(clean, sizeof clean, (const uint8_t *)text, strlen(text));
	return json_string(clean);
}

int cmd_json_line(json_t *object)
{
	int bad = !object || json_dumpf(object, stdout, JSON_COMPACT | JSON_REAL_PRECISION(10)) < 0 ||
		  putchar('\n') == EOF;
	json_decref(object);
	return bad ? CMD_FAILED : CMD_OK;
}
