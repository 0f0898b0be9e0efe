/* One table per command: its options with name, type, range, help and the member they fill. What reads the command line,
 * --help, completion and man pages all go by it. */
#ifndef BILLIARD_APP_OPTIONS_H
#define BILLIARD_APP_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum option_type {
	OPTION_FLAG,   /* bool: true when given */
	OPTION_TEXT,   /* const char *, borrowed from argv */
	OPTION_FILE,   /* the same: a path */
	OPTION_CHOICE, /* the same: one of row.names() */
	OPTION_NUMBER, /* double, within low..high */
	OPTION_WHOLE   /* int, within low..high */
};

/* One option. The end of a table has no name. */
struct option_row {
	const char *name; /* without the dashes */
	char letter;	  /* short form, 0 none */
	enum option_type type;
	size_t offset;	   /* bytes of the member from the start of the struct that is filled */
	const char *value; /* what --help calls the value; NULL for a flag */
	const char *help;  /* one line; numbers get their range by themselves */
	double low, high;
	const char *(*names)(
		void); /* with ", " between; CHOICE: what is allowed; TEXT: what can be completed; else NULL */
};

struct options {
	const char *name;     /* "plan" */
	const char *summary;  /* one line */
	const char *operands; /* "POSITION.txt", "IMAGE...", "" */
	int operand_min, operand_max;
	const char *wants;		    /* why a wrong number of them is refused: "wants one position" */
	bool in_order;			    /* options end at the first operand: what follows may begin with a dash */
	const char *(*operand_names)(void); /* for the first operand, to be completed; NULL: files */
	const struct option_row *row;
	const char *notes; /* under the options; "" none */
};

enum { OPTIONS_ROWS_MAX = 31 };
enum options_outcome {
	OPTIONS_READ,
	OPTIONS_ANSWERED /* --help; exit 0 */,
	OPTIONS_REFUSED /* after one line on stderr */
};

/* Reads argv into the members; argv[0] names the command in messages. Those not given keep what they have. Permutes argv
 * so that operands come last, *first is the index of the first of them. Every table has -h, --help by itself. */
enum options_outcome options_read(const struct options *options, int argc, char **argv, void *out, int *first);

/* A finite decimal number within low..high and nothing else; false: *out is untouched. */
bool option_number(const char *text, double low, double high, double *out);
/* The same for whole numbers. */
bool option_whole(const char *text, int low, int high, int *out);

/* True when text is one of names, which have ", " between them. */
bool option_is_name(const char *names, const char *text);

void options_help(const struct options *options, FILE *out);
/* A man page (section 1) of `billiard NAME`. */
void options_man(const struct options *options, const char *version, FILE *out);
/* Words that may follow, one a line, for a shell. option NULL: the options (and names of the first operand); else the
 * values of that option ("--model"), nothing when it takes a file or a text of the user's. */
void options_complete(const struct options *options, const char *option, FILE *out);

#endif
