#include "app/config/colour_file.h"

#include <errno.h>
#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/save.h"
#include "app/config/text_file.h"

enum { FILE_SIZE_MAX = 1 << 20 };
static const char *const feature_name[COLOUR_FEATURES] = {"ln b/cloth", "ln g/cloth", "ln r/cloth",
							  "ln b/g",	"ln r/g",     "grey"};

/* What the reader knows of the file, for errors. */
struct reader {
	const char *path, *text;
	char *err;
	size_t err_size;
};

/* Line of the first place where a key is written. jansson keeps no lines, and every key of this file is unique but for
 * those inside of a class, which are searched behind the class' own name. */
static int line_of(const char *text, const char *class, const char *key)
{
	char quoted[40];
	const char *at = text;
	if (class) {
		snprintf(quoted, sizeof quoted, "\"%.30s\"", class);
		at = strstr(at, quoted);
	}
	snprintf(quoted, sizeof quoted, "\"%.30s\"", key);
	const char *found = at ? strstr(at, quoted) : NULL;
	found = found ? found : at ? at : text;
	int line = 1;
	for (const char *p = text; p < found; p++)
		line += *p == '\n';
	return line;
}

__attribute__((format(printf, 4, 5))) static int complain(const struct reader *r, const char *class, const char *key,
							  const char *format, ...)
{
	char reason[160];
	va_list args;
	va_start(args, format);
	vsnprintf(reason, sizeof reason, format, args);
	va_end(args);
	snprintf(r->err, r->err_size, "%s:%d: %s%s%s: %s", r->path, line_of(r->text, class, key), class ? class : "",
		 class ? "." : "", key, reason);
	return -EINVAL;
}

static int read_numbers(const struct reader *r, const char *class, const char *key, const json_t *list, double *out)
{
	if (!json_is_array(list) || json_array_size(list) != COLOUR_FEATURES)
		return complain(r, class, key, "an array of %d numbers is wanted", COLOUR_FEATURES);
	for (size_t i = 0; i < COLOUR_FEATURES; i++) {
		const json_t *v = json_array_get(list, i);
		if (!json_is_number(v))
			return complain(r, class, key, "element %zu is not a number", i);
		out[i] = json_number_value(v);
	}
	return 0;
}

static int read_number(const struct reader *r, const char *class, const char *key, const json_t *object, double *out)
{
	const json_t *v = json_object_get(object, key);
	if (!json_is_number(v))
		return complain(r, class, key, "a number is wanted");
	*out = json_number_value(v);
	return 0;
}

static int read_class(const struct reader *r, const char *name, const json_t *object, struct colour_class *out)
{
	const json_t *samples = json_object_get(object, "samples"), *rows = json_object_get(object, "covariance");
	if (!json_is_integer(samples) || json_integer_value(samples) < 1 || json_integer_value(samples) > 1000000000)
		return complain(r, name, "samples", "a whole number 1..1000000000 is wanted");
	out->samples = (int)json_integer_value(samples);
	int rc = read_number(r, name, "scale", object, &out->scale);
	if (rc == 0)
		rc = read_number(r, name, "scale_spread", object, &out->scale_spread);
	if (rc == 0)
		rc = read_numbers(r, name, "mean", json_object_get(object, "mean"), out->mean);
	if (rc < 0)
		return rc;
	if (!json_is_array(rows) || json_array_size(rows) != COLOUR_FEATURES)
		return complain(r, name, "covariance", "an array of %d rows is wanted", COLOUR_FEATURES);
	for (size_t i = 0; i < COLOUR_FEATURES; i++) {
		rc = read_numbers(r, name, "covariance", json_array_get(rows, i), out->covariance[i]);
		if (rc < 0)
			return rc;
	}
	return 0;
}

static int read_model(const struct reader *r, const json_t *root, struct colour_model *out)
{
	const json_t *object;
	json_t *classes = json_object_get(root, "classes");
	const char *name;
	enum ball_colour colour;
	if (!json_is_object(root))
		return complain(r, NULL, "file", "a JSON object is wanted");
	int rc = read_number(r, NULL, "unknown_distance", root, &out->unknown_distance);
	if (rc < 0)
		return rc;
	if (!json_is_object(classes))
		return complain(r, NULL, "classes", "an object with a member per colour is wanted");
	json_object_foreach(classes, name, object)
	{
		if (!ball_colour_from_name(name, &colour) || colour == COLOUR_UNKNOWN)
			return complain(r, NULL, name, "is no colour");
		rc = read_class(r, name, object, &out->class[colour]);
		if (rc < 0)
			return rc;
	}
	return 0;
}

int colour_file_read(const char *path, struct colour_model *out, char *err, size_t err_size)
{
	char *text;
	size_t size;
	json_error_t error;
	struct colour_model model = {0};
	int rc = text_file_read(path, FILE_SIZE_MAX, &text, &size, err, err_size);
	if (rc < 0)
		return rc;
	struct reader r = {path, text, err, err_size};
	json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
	if (root) {
		char reason[160];
		rc = read_model(&r, root, &model);
		if (rc == 0 && colour_model_check(&model, reason, sizeof reason) < 0) {
			rc = -EINVAL;
			snprintf(err, err_size, "%s: %s", path, reason);
		}
	} else {
		rc = -EINVAL;
		snprintf(err, err_size, "%s:%d: %s", path, error.line, error.text);
	}
	json_decref(root);
	free(text);
	if (rc == 0)
		*out = model;
	return rc;
}

static json_t *numbers(const double *v)
{
	json_t *list = json_array();
	for (int i = 0; i < COLOUR_FEATURES; i++)
		json_array_append_new(list, json_real(v[i]));
	return list;
}

static json_t *class_object(const struct colour_class *class)
{
	json_t *object = json_object(), *rows = json_array();
	for (int i = 0; i < COLOUR_FEATURES; i++)
		json_array_append_new(rows, numbers(class->covariance[i]));
	json_object_set_new(object, "samples", json_integer(class->samples));
	json_object_set_new(object, "scale", json_real(class->scale));
	json_object_set_new(object, "scale_spread", json_real(class->scale_spread));
	json_object_set_new(object, "mean", numbers(class->mean));
	json_object_set_new(object, "covariance", rows);
	return object;
}

int colour_file_write(const char *path, const struct colour_model *model, char *err, size_t err_size)
{
	json_t *root = json_object(), *names = json_array(), *classes = json_object();
	for (int i = 0; i < COLOUR_FEATURES; i++)
		json_array_append_new(names, json_string(feature_name[i]));
	for (int k = 0; k < COLOUR_CLASSES; k++)
		if (model->class[k].samples > 0)
			json_object_set_new(classes, ball_colour_name((enum ball_colour)k),
					    class_object(&model->class[k]));
	json_object_set_new(root, "features", names);
	json_object_set_new(root, "unknown_distance", json_real(model->unknown_distance));
	json_object_set_new(root, "classes", classes);
	/* 17 digits: a file read back gives the same bits, and a symmetric matrix stays symmetric. */
	char *text = json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
	json_decref(root);
	if (!text) {
		snprintf(err, err_size, "%s: %s", path, strerror(ENOMEM));
		return -ENOMEM;
	}
	int rc = save_file(path, text, strlen(text), err, err_size);
	free(text);
	return rc;
}
