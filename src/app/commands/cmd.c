#include "app/commands/cmd.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

int cmd_number(const char *option, const char *text, double low, double high, double *out)
{
	char *end;
	double value = strtod(text, &end);
	bool decimal = text[0] && text[strspn(text, "+-.0123456789eE")] == 0 && *end == 0;
	if (!decimal || !(value >= low && value <= high))
		return cmd_bad_input("%s: found \"%s\", allowed a number %g to %g", option, text, low, high);
	*out = value;
	return CMD_OK;
}

int cmd_whole(const char *option, const char *text, int low, int high, int *out)
{
	char *end;
	errno = 0;
	long value = strtol(text, &end, 10);
	if (end == text || *end || errno || value < low || value > high)
		return cmd_bad_input("%s: found \"%s\", allowed a whole number %d to %d", option, text, low, high);
	*out = (int)value;
	return CMD_OK;
}

int cmd_json_line(json_t *object)
{
	int bad = !object || json_dumpf(object, stdout, JSON_COMPACT | JSON_REAL_PRECISION(10)) < 0 ||
		  putchar('\n') == EOF;
	json_decref(object);
	return bad ? CMD_FAILED : CMD_OK;
}
