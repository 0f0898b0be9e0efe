#include "app/config/position.h"

#include <ctype.h>
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/text_file.h"

enum { POSITION_SIZE_MAX = 1 << 16, FIELD_COUNT = 4, FIELD_SIZE = 48 };
static const double mm = 1000; /* in a metre */
static const double speed_max_mm_s = 20000, place_max_mm = 1e5;

struct reader {
	const struct table *table;
	const char *name; /* for messages */
	int line;
	int line_of[BALL_MAX]; /* where each ball stood */
	struct position position;
	char *err;
	size_t err_size;
};

__attribute__((format(printf, 3, 4))) static int fail(struct reader *reader, int line, const char *format, ...)
{
	char reason[160];
	va_list args;
	va_start(args, format);
	vsnprintf(reason, sizeof reason, format, args);
	va_end(args);
	if (line > 0)
		snprintf(reader->err, reader->err_size, "%s:%d: %s", reader->name, line, reason);
	else
		snprintf(reader->err, reader->err_size, "%s: %s", reader->name, reason);
	return -EINVAL;
}

/* ---- one line ---------------------------------------------------------------------------------------------------- */

struct fields {
	char text[FIELD_COUNT][FIELD_SIZE];
	int count;
};

static bool is_blank(char c)
{
	return c == ' ' || c == '\t' || c == '\r';
}

/* One field without the blanks around it; false when it is too long or holds what no text holds. */
static bool copy_field(char *out, const char *begin, const char *end)
{
	while (begin < end && is_blank(*begin))
		begin++;
	while (end > begin && is_blank(end[-1]))
		end--;
	size_t n = (size_t)(end - begin);
	if (n >= FIELD_SIZE)
		return false;
	for (size_t i = 0; i < n; i++) {
		if (begin[i] <= ' ' || begin[i] > '~')
			return false;
		out[i] = begin[i];
	}
	out[n] = 0;
	return true;
}

/* Why a field is none, for those who come from another format. */
static int refuse_field(struct reader *reader, const char *begin, const char *end, int number)
{
	if (memchr(begin, ';', (size_t)(end - begin)))
		return fail(reader, reader->line, "found ';', fields are parted by commas");
	for (const char *c = begin; c < end; c++)
		if ((unsigned char)*c > '~')
			return fail(reader, reader->line, "field %d holds a character that is not ASCII", number);
	return fail(reader, reader->line, "field %d is no word or number", number);
}

/* Splits at commas, up to a '#'. A line without anything has no fields. */
static int split(struct reader *reader, const char *line, const char *end, struct fields *out)
{
	const char *comment = memchr(line, '#', (size_t)(end - line));
	if (comment)
		end = comment;
	out->count = 0;
	while (line < end && is_blank(*line))
		line++;
	if (line == end)
		return 0;
	for (;;) {
		const char *comma = memchr(line, ',', (size_t)(end - line));
		const char *stop = comma ? comma : end;
		if (out->count == FIELD_COUNT)
			return fail(reader, reader->line, "more than %d fields", FIELD_COUNT);
		if (!copy_field(out->text[out->count], line, stop))
			return refuse_field(reader, line, stop, out->count + 1);
		out->count++;
		if (!comma)
			return 0;
		line = comma + 1;
	}
}

/* A decimal number within +-limit (so neither infinite nor NaN, nor hexadecimal). */
static bool parse_number(const char *text, double limit, double *out)
{
	if (text[strspn(text, "+-.0123456789eE")])
		return false;
	char *end;
	double value = strtod(text, &end);
	if (end == text || *end || !(fabs(value) <= limit))
		return false;
	*out = value;
	return true;
}

struct bound {
	double limit;
	const char *unit;
};

/* Two texts, x and y, within +- the bound. */
static int parse_point(struct reader *reader, const char text[2][FIELD_SIZE], const struct bound *bound, vec2 *out)
{
	vec2 value;
	double *const number[2] = {&value.x, &value.y};
	for (int i = 0; i < 2; i++)
		if (!parse_number(text[i], bound->limit, number[i]))
			return fail(reader, reader->line, "\"%s\" is not a number within +-%g %s", text[i],
				    bound->limit, bound->unit);
	*out = (vec2){value.x / mm, value.y / mm};
	return 0;
}

static int parse_velocity(struct reader *reader, const struct fields *fields)
{
	if (reader->position.has_velocity)
		return fail(reader, reader->line, "a second V line");
	int code = parse_point(reader, fields->text + 1, &(struct bound){speed_max_mm_s, "mm/s"},
			       &reader->position.velocity);
	if (code == 0 && vec2_norm(reader->position.velocity) * mm > speed_max_mm_s)
		return fail(reader, reader->line, "faster than %g mm/s", speed_max_mm_s);
	reader->position.has_velocity = code == 0;
	return code;
}

static int refuse_type(struct reader *reader, const char *type)
{
	char upper[FIELD_SIZE];
	size_t n = 0;
	for (; type[n] && n + 1 < sizeof upper; n++)
		upper[n] = (char)toupper((unsigned char)type[n]);
	upper[n] = '\0';
	if (ball_colour_from_name(upper, &(enum ball_colour){COLOUR_UNKNOWN}))
		return fail(reader, reader->line, "unknown type \"%s\": in capitals, \"%s\"", type, upper);
	return fail(reader, reader->line, "unknown type \"%.40s\"", type);
}

static int add_ball(struct reader *reader, const char *id, const char *type, vec2 pos)
{
	struct position *position = &reader->position;
	enum ball_colour colour;
	if (!ball_colour_from_name(type, &colour))
		return refuse_type(reader, type);
	if (colour == COLOUR_WHITE && position_cue(position) >= 0)
		return fail(reader, reader->line, "a second cue ball, %s", id);
	if (position->count == BALL_MAX)
		return fail(reader, reader->line, "more than %d balls", BALL_MAX);
	int i = position->count++;
	position->ball[i] = ball_at(colour, pos);
	memcpy(position->name[i], id, strlen(id) + 1);
	reader->line_of[i] = reader->line;
	return 0;
}

static int parse_ball(struct reader *reader, const struct fields *fields)
{
	const char *id = fields->text[0];
	if (!id[0] || strlen(id) >= BALL_NAME_SIZE)
		return fail(reader, reader->line, "an ID has 1 to %d characters", BALL_NAME_SIZE - 1);
	if (position_find(&reader->position, id) >= 0)
		return fail(reader, reader->line, "%s is there twice", id);
	vec2 pos;
	int code = parse_point(reader, fields->text + 2, &(struct bound){place_max_mm, "mm"}, &pos);
	return code < 0 ? code : add_ball(reader, id, fields->text[1], pos);
}

static int parse_line(struct reader *reader, const char *line, const char *end)
{
	struct fields fields;
	int code = split(reader, line, end, &fields);
	if (code < 0 || fields.count == 0)
		return code;
	if (strcmp(fields.text[0], "V") == 0 && fields.count == 3)
		return parse_velocity(reader, &fields);
	if (fields.count != FIELD_COUNT && memchr(line, ';', (size_t)(end - line)))
		return fail(reader, reader->line, "found ';', fields are parted by commas");
	if (fields.count != FIELD_COUNT)
		return fail(reader, reader->line, "found %d fields, wanted ID, TYPE, x, y or V, vx, vy", fields.count);
	return parse_ball(reader, &fields);
}

/* ---- what `billiard detect --json` prints ------------------------------------------------------------------------- */

/* RED3: the third of its colour. */
static int add_seen(struct reader *reader, const json_t *item, size_t number, int seen[COLOUR_COUNT])
{
	const char *type = json_string_value(json_object_get(item, "type"));
	const json_t *x = json_object_get(item, "x"), *y = json_object_get(item, "y");
	if (!type || !json_is_number(x) || !json_is_number(y))
		return fail(reader, reader->line, "balls[%zu]: type, x and y are wanted", number);
	vec2 pos = {json_number_value(x), json_number_value(y)};
	if (!(fabs(pos.x) <= place_max_mm && fabs(pos.y) <= place_max_mm))
		return fail(reader, reader->line, "balls[%zu]: not within +-%g mm", number, place_max_mm);
	enum ball_colour colour;
	char id[BALL_NAME_SIZE] = "";
	if (ball_colour_from_name(type, &colour))
		snprintf(id, sizeof id, "%s%d", ball_colour_name(colour), ++seen[colour]);
	return add_ball(reader, id, type, vec2_scale(pos, 1 / mm));
}

static int parse_seen(struct reader *reader, const json_t *object)
{
	const json_t *balls = json_object_get(object, "balls"), *item;
	const char *reason = json_string_value(json_object_get(object, "reason"));
	int seen[COLOUR_COUNT] = {0}, code = 0;
	size_t i;
	if (json_is_false(json_object_get(object, "calibrated")))
		return fail(reader, reader->line, "not calibrated: %s", reason ? reason : "no reason");
	if (!json_is_array(balls))
		return fail(reader, reader->line, "a list \"balls\" is wanted");
	json_array_foreach((json_t *)balls, i, item)
	{
		if ((code = add_seen(reader, item, i, seen)) < 0)
			break;
	}
	return code;
}

/* One line of one image. */
static int parse_json(struct reader *reader, const char *text, size_t size)
{
	json_error_t error;
	json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
	reader->line = 1;
	int code = root ? parse_seen(reader, root) : fail(reader, error.line, "%s", error.text);
	json_decref(root);
	return code;
}

/* ---- the whole --------------------------------------------------------------------------------------------------- */

static int check(struct reader *reader)
{
	const struct position *position = &reader->position;
	char reason[160] = "";
	int first = -1, second = -1;
	if (position->count == 0)
		return fail(reader, 0, "no balls");
	if (position->has_velocity && position_cue(position) < 0)
		return fail(reader, 0, "a V line but no cue ball");
	if (table_check_balls(reader->table, position->ball, position->count, &first, &second, reason, sizeof reason) ==
	    0)
		return 0;
	int later = second > first ? second : first;
	if (second >= 0)
		return fail(reader, reader->line_of[later], "%s overlaps %s", position->name[later],
			    position->name[later == first ? second : first]);
	return fail(reader, reader->line_of[first], "%s: %s", position->name[first], reason);
}

static int parse_lines(struct reader *reader, const char *text, const char *end)
{
	while (text < end) {
		const char *newline = memchr(text, '\n', (size_t)(end - text));
		const char *stop = newline ? newline : end;
		reader->line++;
		int code = parse_line(reader, text, stop);
		if (code < 0)
			return code;
		text = newline ? newline + 1 : end;
	}
	return 0;
}

static bool is_json(const char *text, const char *end)
{
	while (text < end && (is_blank(*text) || *text == '\n'))
		text++;
	return text < end && *text == '{';
}

int position_parse(struct position *out, const struct table *table, const char *name, const char *text, size_t size,
		   char *err, size_t err_size)
{
	struct reader reader = {.table = table, .name = name, .err = err, .err_size = err_size};
	int code =
		is_json(text, text + size) ? parse_json(&reader, text, size) : parse_lines(&reader, text, text + size);
	if (code == 0)
		code = check(&reader);
	if (code == 0)
		*out = reader.position;
	return code;
}

int position_read(struct position *out, const struct table *table, const char *path, char *err, size_t err_size)
{
	char *text;
	size_t size;
	int code = text_file_read(path, POSITION_SIZE_MAX, &text, &size, err, err_size);
	if (code < 0)
		return code;
	code = position_parse(out, table, path, text, size, err, err_size);
	free(text);
	return code;
}

int position_find(const struct position *position, const char *name)
{
	for (int i = 0; i < position->count; i++)
		if (strcmp(position->name[i], name) == 0)
			return i;
	return -1;
}

int position_cue(const struct position *position)
{
	for (int i = 0; i < position->count; i++)
		if (position->ball[i].colour == COLOUR_WHITE)
			return i;
	return -1;
}
