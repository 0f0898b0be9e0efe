/* Reads libconfig settings into a struct as a table of keys says, checking type, range, missing and unknown keys. */
#ifndef BILLIARD_APP_CONFIG_READER_H
#define BILLIARD_APP_CONFIG_READER_H

#include <libconfig.h>
#include <stdbool.h>
#include <stddef.h>

enum config_type {
	CONFIG_NUMBER,	/* double */
	CONFIG_WHOLE,	/* int */
	CONFIG_COUNT64, /* uint64_t */
	CONFIG_FLAG,	/* bool */
	CONFIG_TEXT,	/* char[size] */
	CONFIG_CHOICE,	/* int: the place of the text among choices */
	CONFIG_NUMBERS, /* size doubles in a row (a vec2 is two) */
	CONFIG_SECTION, /* group of keys, offsets from the same base */
	CONFIG_LIST	/* list of groups, each into an element of size bytes */
};

/* Unit of a number in the file; inside it is SI. */
enum config_unit {
	UNIT_NONE,
	UNIT_MM,
	UNIT_MM_S,
	UNIT_MM_S2,
	UNIT_DEGREE,
	UNIT_MS,
	UNIT_SECOND,
	UNIT_HERTZ,
	UNIT_KG,
	UNIT_PX,
	UNIT_GREY,
	UNIT_S_M,
	UNIT_GPA,
	UNIT_MM_M,
	UNIT_MM_M2,
	UNIT_COUNT
};

/* One key. The end of a table has no name. */
struct config_key {
	const char *name;
	enum config_type type;
	enum config_unit unit;
	size_t offset;		       /* bytes from the base */
	double min, max;	       /* in the file's unit; of a text or list: its length */
	size_t size;		       /* TEXT: bytes; NUMBERS: how many; LIST: bytes of an element */
	size_t count_offset;	       /* LIST: an int for the number of elements */
	const struct config_key *keys; /* SECTION, LIST */
	bool optional;		       /* NUMBER, NUMBERS: may be missing, then `fallback` counts */
	double fallback;	       /* in the file's unit */
	const char *const *choices;    /* CHOICE: texts, NULL at the end */
};

struct config_reader {
	const char *path; /* of the file, for messages */
	char *err;	  /* borrowed */
	size_t err_size;
	bool partial; /* a key that is missing leaves base as it is; in elements of lists all are needed but for optional ones */
};

enum { CONFIG_ALLOWED_SIZE = 80 };
/* What a key may hold, for people: "a number 0.001 to 0.1". */
void config_reader_allowed(const struct config_key *key, char *out, size_t size);

/* All keys of the table from the group into base. 0, or -EINVAL with "file:line: key: found ..., allowed ..." in err;
 * what was read before stays in base. */
int config_reader_group(struct config_reader *reader, const config_setting_t *group, const struct config_key *keys,
			void *base);

/* Writes such a message for a setting whose value fails a check of the caller's; found NULL: the value itself.
 * Returns -EINVAL. */
int config_reader_fail(struct config_reader *reader, const config_setting_t *setting, const char *found,
		       const char *allowed);

#endif
