#include "app/config/config_reader.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { NAME_SIZE = 128, VALUE_SIZE = 80 };

static const struct {
	const char *name;
	double per_si; /* file units in one SI unit: dividing by it keeps 1881 mm the double nearest to 1.881 */
} unit_table[UNIT_COUNT] = {
	[UNIT_NONE] = {"", 1},
	[UNIT_MM] = {" mm", 1000},
	[UNIT_MM_S] = {" mm/s", 1000},
	[UNIT_MM_S2] = {" mm/s^2", 1000},
	[UNIT_DEGREE] = {" degrees", 180 / M_PI},
	[UNIT_MS] = {" ms", 1000},
	[UNIT_SECOND] = {" s", 1},
	[UNIT_HERTZ] = {" 1/s", 1},
	[UNIT_KG] = {" kg", 1},
	[UNIT_PX] = {" px", 1},
	[UNIT_GREY] = {" grey levels", 1},
	[UNIT_S_M] = {" s/m", 1},
	[UNIT_GPA] = {" GPa", 1e-9},
	[UNIT_MM_M] = {" mm/m", 1000},
	[UNIT_MM_M2] = {" mm/m^2", 1000},
};

/* ---- messages ---------------------------------------------------------------------------------------------------- */

/* "table.cushions[3].from". */
static void setting_name(const config_setting_t *setting, char *out, size_t size)
{
	const config_setting_t *parent = config_setting_parent(setting);
	out[0] = 0;
	if (!parent)
		return;
	setting_name(parent, out, size);
	size_t n = strlen(out);
	if (config_setting_name(setting))
		snprintf(out + n, size - n, "%s%s", n ? "." : "", config_setting_name(setting));
	else
		snprintf(out + n, size - n, "[%d]", config_setting_index(setting));
}

static void setting_value(const config_setting_t *setting, char *out, size_t size)
{
	switch (config_setting_type(setting)) {
	case CONFIG_TYPE_INT:
	case CONFIG_TYPE_INT64:
		snprintf(out, size, "%lld", config_setting_get_int64(setting));
		break;
	case CONFIG_TYPE_FLOAT: {
		double value = config_setting_get_float(setting);
		snprintf(out, size, value == floor(value) && fabs(value) < 1e15 ? "%.1f" : "%.9g", value);
		break;
	}
	case CONFIG_TYPE_BOOL:
		snprintf(out, size, "%s", config_setting_get_bool(setting) ? "true" : "false");
		break;
	case CONFIG_TYPE_STRING:
		snprintf(out, size, "\"%.60s\"", config_setting_get_string(setting));
		break;
	case CONFIG_TYPE_GROUP:
		snprintf(out, size, "a group");
		break;
	default:
		snprintf(out, size, "a list of %d", config_setting_length(setting));
	}
}

void config_reader_allowed(const struct config_key *key, char *out, size_t size)
{
	const char *unit = unit_table[key->unit].name;
	switch (key->type) {
	case CONFIG_NUMBER:
		snprintf(out, size, "a number %.9g to %.9g%s", key->min, key->max, unit);
		break;
	case CONFIG_WHOLE:
	case CONFIG_COUNT64:
		snprintf(out, size, "a whole number %.0f to %.0f%s", key->min, key->max, unit);
		break;
	case CONFIG_FLAG:
		snprintf(out, size, "true or false");
		break;
	case CONFIG_TEXT:
		snprintf(out, size, "a text of %.0f to %.0f characters", key->min, key->max);
		break;
	case CONFIG_CHOICE: {
		size_t n = 0;
		for (int i = 0; key->choices[i] && n < size; i++)
			n += (size_t)snprintf(out + n, size - n, "%s\"%s\"", i ? " or " : "", key->choices[i]);
		break;
	}
	case CONFIG_NUMBERS:
		snprintf(out, size, "%zu numbers %.9g to %.9g%s", key->size, key->min, key->max, unit);
		break;
	case CONFIG_SECTION:
		snprintf(out, size, "a group { }");
		break;
	case CONFIG_LIST:
		snprintf(out, size, "a list ( ) of %.0f to %.0f groups", key->min, key->max);
	}
}

static int complain(struct config_reader *reader, const config_setting_t *at, const char *name, const char *found,
		    const char *allowed)
{
	const char *file = config_setting_source_file(at) ? config_setting_source_file(at) : reader->path;
	unsigned line = config_setting_source_line(at); /* 0 for the whole file */
	snprintf(reader->err, reader->err_size, "%s:%u: %s: found %s, allowed %s", file, line ? line : 1, name, found,
		 allowed);
	return -EINVAL;
}

int config_reader_fail(struct config_reader *reader, const config_setting_t *setting, const char *found,
		       const char *allowed)
{
	char name[NAME_SIZE], value[VALUE_SIZE];
	setting_name(setting, name, sizeof name);
	setting_value(setting, value, sizeof value);
	return complain(reader, setting, name, found ? found : value, allowed);
}

static int fail(struct config_reader *reader, const config_setting_t *setting, const struct config_key *key)
{
	char allowed[CONFIG_ALLOWED_SIZE];
	config_reader_allowed(key, allowed, sizeof allowed);
	return config_reader_fail(reader, setting, NULL, allowed);
}

/* A key that is not there, or one that nobody knows: named below its group. */
static int fail_member(struct config_reader *reader, const config_setting_t *group, const char *member,
		       const char *found, const char *allowed)
{
	char name[2 * NAME_SIZE];
	setting_name(group, name, NAME_SIZE);
	size_t n = strlen(name);
	snprintf(name + n, sizeof name - n, "%s%s", n ? "." : "", member);
	return complain(reader, group, name, found, allowed);
}

/* ---- values ------------------------------------------------------------------------------------------------------ */

/* Written so that a value that is no number fails. */
static bool in_range(const struct config_key *key, double value)
{
	return value >= key->min && value <= key->max;
}

static int read_number(struct config_reader *reader, const config_setting_t *setting, const struct config_key *key,
		       double *out)
{
	if (!config_setting_is_number(setting) || !in_range(key, config_setting_get_float(setting)))
		return fail(reader, setting, key);
	*out = config_setting_get_float(setting) / unit_table[key->unit].per_si;
	return 0;
}

static int read_whole(struct config_reader *reader, const config_setting_t *setting, const struct config_key *key,
		      void *out)
{
	int type = config_setting_type(setting);
	if (type != CONFIG_TYPE_INT && type != CONFIG_TYPE_INT64)
		return fail(reader, setting, key);
	long long value = config_setting_get_int64(setting);
	if (!in_range(key, (double)value))
		return fail(reader, setting, key);
	if (key->type == CONFIG_WHOLE)
		*(int *)out = (int)value;
	else
		*(uint64_t *)out = (uint64_t)value;
	return 0;
}

static int read_flag(struct config_reader *reader, const config_setting_t *setting, const struct config_key *key,
		     bool *out)
{
	if (config_setting_type(setting) != CONFIG_TYPE_BOOL)
		return fail(reader, setting, key);
	*out = config_setting_get_bool(setting) != 0;
	return 0;
}

static int read_text(struct config_reader *reader, const config_setting_t *setting, const struct config_key *key,
		     char *out)
{
	assert(key->max < (double)key->size);
	if (config_setting_type(setting) != CONFIG_TYPE_STRING)
		return fail(reader, setting, key);
	const char *text = config_setting_get_string(setting);
	size_t length = strlen(text);
	if (!in_range(key, (double)length))
		return fail(reader, setting, key);
	memcpy(out, text, length + 1);
	return 0;
}

static int read_choice(struct config_reader *reader, const config_setting_t *setting, const struct config_key *key,
		       int *out)
{
	const char *text = config_setting_get_string(setting);
	for (int i = 0; text && key->choices[i]; i++)
		if (strcmp(text, key->choices[i]) == 0) {
			*out = i;
			return 0;
		}
	return fail(reader, setting, key);
}

static int read_numbers(struct config_reader *reader, const config_setting_t *setting, const struct config_key *key,
			double *out)
{
	int type = config_setting_type(setting);
	if ((type != CONFIG_TYPE_LIST && type != CONFIG_TYPE_ARRAY) ||
	    (size_t)config_setting_length(setting) != key->size)
		return fail(reader, setting, key);
	for (size_t i = 0; i < key->size; i++) {
		const config_setting_t *item = config_setting_get_elem((config_setting_t *)setting, (unsigned)i);
		int code = read_number(reader, item, key, &out[i]);
		if (code < 0)
			return code;
	}
	return 0;
}

static int read_list(struct config_reader *reader, const config_setting_t *setting, const struct config_key *key,
		     char *base)
{
	if (config_setting_type(setting) != CONFIG_TYPE_LIST || !in_range(key, config_setting_length(setting)))
		return fail(reader, setting, key);
	int count = config_setting_length(setting);
	struct config_reader whole = *reader;
	whole.partial = false; /* a list replaces the default one: its elements lean on nothing */
	for (int i = 0; i < count; i++) {
		const config_setting_t *item = config_setting_get_elem((config_setting_t *)setting, (unsigned)i);
		if (config_setting_type(item) != CONFIG_TYPE_GROUP)
			return config_reader_fail(reader, item, NULL, "a group { }");
		int code = config_reader_group(&whole, item, key->keys, base + key->offset + (size_t)i * key->size);
		if (code < 0)
			return code;
	}
	*(int *)(void *)(base + key->count_offset) = count;
	return 0;
}

static int read_key(struct config_reader *reader, const config_setting_t *setting, const struct config_key *key,
		    char *base)
{
	void *out = base + key->offset;
	switch (key->type) {
	case CONFIG_NUMBER:
		return read_number(reader, setting, key, out);
	case CONFIG_WHOLE:
	case CONFIG_COUNT64:
		return read_whole(reader, setting, key, out);
	case CONFIG_FLAG:
		return read_flag(reader, setting, key, out);
	case CONFIG_TEXT:
		return read_text(reader, setting, key, out);
	case CONFIG_CHOICE:
		return read_choice(reader, setting, key, out);
	case CONFIG_NUMBERS:
		return read_numbers(reader, setting, key, out);
	case CONFIG_SECTION:
		if (config_setting_type(setting) != CONFIG_TYPE_GROUP)
			return fail(reader, setting, key);
		return config_reader_group(reader, setting, key->keys, base);
	case CONFIG_LIST:
		return read_list(reader, setting, key, base);
	}
	return 0;
}

/* ---- groups ------------------------------------------------------------------------------------------------------ */

static const struct config_key *find_key(const struct config_key *keys, const char *name)
{
	while (keys->name && strcmp(keys->name, name) != 0)
		keys++;
	return keys->name ? keys : NULL;
}

/* Letters to insert, delete or change: Levenshtein's distance, row by row. */
static int distance(const char *a, const char *b)
{
	enum { LONGEST = 32 };
	int row[LONGEST + 1], n = (int)strlen(b);
	if (n > LONGEST)
		return n;
	for (int j = 0; j <= n; j++)
		row[j] = j;
	for (; *a; a++) {
		int corner = row[0]++;
		for (int j = 1; j <= n; j++) {
			int change = corner + (*a != b[j - 1]);
			int add = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
			corner = row[j];
			row[j] = change < add ? change : add;
		}
	}
	return row[n];
}

static const char *nearest(const struct config_key *keys, const char *name)
{
	const struct config_key *best = keys;
	for (const struct config_key *key = keys; key->name; key++)
		if (distance(name, key->name) < distance(name, best->name))
			best = key;
	return best->name;
}

static int refuse_unknown(struct config_reader *reader, const config_setting_t *group, const struct config_key *keys)
{
	for (int i = 0; i < config_setting_length(group); i++) {
		const config_setting_t *member = config_setting_get_elem((config_setting_t *)group, (unsigned)i);
		if (find_key(keys, config_setting_name(member)))
			continue;
		char allowed[512];
		size_t n = (size_t)snprintf(allowed, sizeof allowed, "one of");
		for (const struct config_key *key = keys; key->name && n < sizeof allowed; key++)
			n += (size_t)snprintf(allowed + n, sizeof allowed - n, " %s", key->name);
		char found[64];
		snprintf(found, sizeof found, "an unknown key (nearest is %s)",
			 nearest(keys, config_setting_name(member)));
		return config_reader_fail(reader, member, found, allowed);
	}
	return 0;
}

/* A key that came later has a value that changes nothing: older files stay valid. */
static void fall_back(const struct config_key *key, char *base)
{
	double *out = (double *)(void *)(base + key->offset);
	size_t count = key->type == CONFIG_NUMBERS ? key->size : 1;
	for (size_t i = 0; i < count; i++)
		out[i] = key->fallback / unit_table[key->unit].per_si;
}

int config_reader_group(struct config_reader *reader, const config_setting_t *group, const struct config_key *keys,
			void *base)
{
	int code = refuse_unknown(reader, group, keys);
	for (const struct config_key *key = keys; code == 0 && key->name; key++) {
		const config_setting_t *setting = config_setting_get_member((config_setting_t *)group, key->name);
		if (!setting && reader->partial)
			continue;
		if (!setting && key->optional) {
			fall_back(key, base);
			continue;
		}
		if (!setting) {
			char allowed[CONFIG_ALLOWED_SIZE];
			config_reader_allowed(key, allowed, sizeof allowed);
			return fail_member(reader, group, key->name, "nothing", allowed);
		}
		code = read_key(reader, setting, key, base);
	}
	return code;
}
