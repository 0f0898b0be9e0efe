#include "app/process/options.h"

#include <assert.h>
#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

/* ---- values ------------------------------------------------------------------------------------------------------ */

bool option_number(const char *text, double low, double high, double *out)
{
	char *end;
	double value = strtod(text, &end);
	bool decimal = text[0] && text[strspn(text, "+-.0123456789eE")] == '\0' && *end == '\0';
	if (!decimal || !(value >= low && value <= high))
		return false;
	*out = value;
	return true;
}

bool option_whole(const char *text, int low, int high, int *out)
{
	char *end;
	errno = 0;
	long value = strtol(text, &end, 10);
	bool digits = text[0] && text[strspn(text, "+-0123456789")] == '\0' && *end == '\0';
	if (!digits || errno || value < low || value > high)
		return false;
	*out = (int)value;
	return true;
}

bool option_is_name(const char *names, const char *text)
{
	size_t n = strlen(text);
	for (const char *name = names; name; name = strchr(name, ' ')) {
		name += *name == ' ';
		if (n > 0 && strcspn(name, ",") == n && memcmp(name, text, n) == 0)
			return true;
	}
	return false;
}

enum { ALLOWED_SIZE = 256 };
/* "a number 0 to 1", "a whole number 1 to 4", "thesis, simple, real". */
static void allowed(const struct option_row *row, char out[ALLOWED_SIZE])
{
	if (row->type == OPTION_CHOICE)
		snprintf(out, ALLOWED_SIZE, "%s", row->names());
	else
		snprintf(out, ALLOWED_SIZE, "a%s number %.9g to %.9g", row->type == OPTION_WHOLE ? " whole" : "",
			 row->low, row->high);
}

/* False: the text is no value of that option. */
static bool take(const struct option_row *row, const char *text, void *out)
{
	void *member = (char *)out + row->offset;
	switch (row->type) {
	case OPTION_FLAG:
		*(bool *)member = true;
		return true;
	case OPTION_NUMBER:
		return option_number(text, row->low, row->high, member);
	case OPTION_WHOLE:
		return option_whole(text, (int)row->low, (int)row->high, member);
	case OPTION_CHOICE:
		if (!option_is_name(row->names(), text))
			return false;
		break;
	case OPTION_TEXT:
	case OPTION_FILE:
		break;
	}
	*(const char **)member = text;
	return true;
}

/* ---- the command line -------------------------------------------------------------------------------------------- */

enum { FIRST_CODE = 256 };

/* getopt's own tables: the code of row i is FIRST_CODE + i. */
struct getopt_tables {
	struct option option[OPTIONS_ROWS_MAX + 2];
	char letters[2 * OPTIONS_ROWS_MAX + 4];
};

static void fill(struct getopt_tables *t, const struct options *options)
{
	size_t n = 0, i = 0;
	if (options->in_order)
		t->letters[n++] = '+';
	t->letters[n++] = 'h';
	for (const struct option_row *row = options->row; row->name; row++, i++) {
		assert(i < OPTIONS_ROWS_MAX);
		int argument = row->type == OPTION_FLAG ? no_argument : required_argument;
		t->option[i] = (struct option){row->name, argument, NULL, FIRST_CODE + (int)i};
		if (row->letter)
			t->letters[n++] = row->letter;
		if (row->letter && argument)
			t->letters[n++] = ':';
	}
	t->letters[n] = '\0';
	t->option[i++] = (struct option){"help", no_argument, NULL, 'h'};
	t->option[i] = (struct option){NULL, 0, NULL, 0};
}

static const struct option_row *row_of(const struct options *options, int code)
{
	if (code >= FIRST_CODE)
		return &options->row[code - FIRST_CODE];
	const struct option_row *row = options->row;
	while (row->letter != code)
		row++;
	return row;
}

static enum options_outcome refuse(const struct option_row *row, const char *found)
{
	char text[ALLOWED_SIZE];
	allowed(row, text);
	fprintf(stderr, "--%s: found \"%.100s\", allowed %s\n", row->name, found, text);
	return OPTIONS_REFUSED;
}

enum options_outcome options_read(const struct options *options, int argc, char **argv, void *out, int *first)
{
	struct getopt_tables tables;
	fill(&tables, options);
	optind = 0; /* glibc: begin anew */
	int code;
	while ((code = getopt_long(argc, argv, tables.letters, tables.option, NULL)) != -1) {
		if (code == '?')
			return OPTIONS_REFUSED;
		if (code == 'h') {
			options_help(options, stdout);
			return OPTIONS_ANSWERED;
		}
		const struct option_row *row = row_of(options, code);
		if (!take(row, optarg, out))
			return refuse(row, optarg);
	}
	*first = optind;
	int operands = argc - optind;
	if (operands >= options->operand_min && operands <= options->operand_max)
		return OPTIONS_READ;
	if (options->operand_max == 0)
		fprintf(stderr, "%s: unexpected argument \"%.100s\" (see %s --help)\n", argv[0], argv[optind], argv[0]);
	else
		fprintf(stderr, "%s: %s (see %s --help)\n", argv[0], options->wants, argv[0]);
	return OPTIONS_REFUSED;
}

/* ---- help -------------------------------------------------------------------------------------------------------- */

enum { LABEL_SIZE = 64, HELP_SIZE = 640 };

static const struct option_row help_row = {.name = "help", .letter = 'h', .help = "says this"};

/* "-c, --config CONF". */
static void label(const struct option_row *row, char out[LABEL_SIZE])
{
	char letter[8] = "";
	if (row->letter)
		snprintf(letter, sizeof letter, "-%c, ", row->letter);
	snprintf(out, LABEL_SIZE, "%s--%s%s%s", letter, row->name, row->value ? " " : "", row->value ? row->value : "");
}

/* The help text, with the range of a number or the names of a choice. */
static void describe(const struct option_row *row, char out[HELP_SIZE])
{
	if (row->type == OPTION_CHOICE)
		snprintf(out, HELP_SIZE, "%s: %s", row->help, row->names());
	else if (row->type == OPTION_NUMBER || row->type == OPTION_WHOLE)
		snprintf(out, HELP_SIZE, "%s, %.9g to %.9g", row->help, row->low, row->high);
	else
		snprintf(out, HELP_SIZE, "%s", row->help);
}

static void help_line(const struct option_row *row, FILE *out)
{
	char name[LABEL_SIZE], text[HELP_SIZE];
	label(row, name);
	describe(row, text);
	fprintf(out, "  %-22s %s\n", name, text);
}

void options_help(const struct options *options, FILE *out)
{
	fprintf(out, "usage: billiard %s [OPTION...]%s%s\n%s\n\n", options->name, options->operands[0] ? " " : "",
		options->operands, options->summary);
	for (const struct option_row *row = options->row; row->name; row++)
		help_line(row, out);
	help_line(&help_row, out);
	if (options->notes[0])
		fprintf(out, "\n%s\n", options->notes);
}

/* ---- man pages --------------------------------------------------------------------------------------------------- */

/* Text for troff: a dash is a minus, a line does not begin with a dot or a quote. */
static void man_text(const char *text, FILE *out)
{
	bool begin = true;
	for (; *text; text++) {
		if (begin && (*text == '.' || *text == '\''))
			fputs("\\&", out);
		if (*text == '-' || *text == '\\')
			fputc('\\', out);
		fputc(*text, out);
		if (*text == '\\')
			fputc('e', out);
		begin = *text == '\n';
	}
}

static void man_row(const struct option_row *row, FILE *out)
{
	char name[LABEL_SIZE], text[HELP_SIZE];
	label(row, name);
	describe(row, text);
	fputs(".TP\n.B ", out);
	man_text(name, out);
	fputc('\n', out);
	man_text(text, out);
	fputc('\n', out);
}

void options_man(const struct options *options, const char *version, FILE *out)
{
	fprintf(out, ".TH BILLIARD\\-%s 1 \"\" \"billiard %s\"\n.SH NAME\nbilliard\\-%s \\- ", options->name, version,
		options->name);
	man_text(options->summary, out);
	fprintf(out, "\n.SH SYNOPSIS\n.B billiard %s\n[OPTION...] ", options->name);
	man_text(options->operands, out);
	fputs("\n.SH OPTIONS\n", out);
	for (const struct option_row *row = options->row; row->name; row++)
		man_row(row, out);
	man_row(&help_row, out);
	if (options->notes[0]) {
		fputs(".SH NOTES\n.nf\n", out);
		man_text(options->notes, out);
		fputs("\n.fi\n", out);
	}
	fputs(".SH EXIT STATUS\n0; 1 when something was tried and failed; 2 for bad input, after one line on standard "
	      "error.\n"
	      ".SH SEE ALSO\n.BR billiard (1)\n",
	      out);
}

/* ---- completion -------------------------------------------------------------------------------------------------- */

/* "a, b" as lines. */
static void print_names(const char *names, FILE *out)
{
	for (const char *c = names; *c; c++)
		if (*c != ' ')
			fputc(*c == ',' ? '\n' : *c, out);
	fputc('\n', out);
}

void options_complete(const struct options *options, const char *option, FILE *out)
{
	for (const struct option_row *row = options->row; row->name; row++) {
		if (!option)
			fprintf(out, "--%s\n", row->name);
		else if (row->names && strncmp(option, "--", 2) == 0 && strcmp(option + 2, row->name) == 0)
			print_names(row->names(), out);
	}
	if (option)
		return;
	fputs("--help\n", out);
	if (options->operand_names)
		print_names(options->operand_names(), out);
}
