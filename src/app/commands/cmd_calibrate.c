/* billiard calibrate colours: learns the colour parameters from photographs. */
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/cmd.h"
#include "app/config/colour_file.h"
#include "app/config/save.h"
#include "vision/image_io_cv.h"

enum { RACK_REDS = 15, OPENING_BALLS = 22 };
static const double SPOT_REACH = 0.035; /* m from its spot that a colour may lie in the opening position */
static const double LABEL_REACH = 8;	/* px at 1280 from its label that a ball may be found */

struct calibrate_line {
	const char *config, *labels, *out, *without;
};

/* Balls of known colour, gathered over all photographs. */
struct samples {
	struct colour_sample *sample;
	int count, capacity;
};

struct learner {
	struct config config;
	struct vision *vision;
	struct image_buffer buffer;
	struct vision_result result;
	struct samples samples;
	json_t *labels;
};

static const char *operand_names(void)
{
	return "colours";
}

/* A table is read by its columns. */
/* clang-format off */
#define AT(member) offsetof(struct calibrate_line, member)
static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct calibrate_line),
	{.name = "labels",
	 .type = OPTION_FILE,
	 .offset = AT(labels),
	 .value = "LABELS.json",
	 .help = "what is in each image, see below"},
	{.name = "without",
	 .type = OPTION_TEXT,
	 .offset = AT(without),
	 .value = "NAME",
	 .help = "leaves out images whose path contains NAME (to judge what was learned)"},
	{.name = "output",
	 .letter = 'o',
	 .type = OPTION_FILE,
	 .offset = AT(out),
	 .value = "OUT.json",
	 .help = "default: the colour file of the configuration"},
	{.name = NULL},
};
/* clang-format on */

const struct options calibrate_options = {
	.name = "calibrate",
	.summary = "colour parameters from photographs",
	.operands = "colours IMAGE...",
	.operand_min = 2,
	.operand_max = INT_MAX,
	.wants = "wants \"colours\" and images",
	.operand_names = operand_names,
	.row = rows,
	.notes = "LABELS.json is a list of {\"image\": \"a.png\", \"classes\": [{\"type\": \"RED\", \"px\": 1, \"py\": "
		 "2}, ...]};\n"
		 "an image is found by the end of its path. Without it every photograph must show the opening "
		 "position:\n"
		 "colours on their spots, fifteen reds, the white ball anywhere. A file that is replaced stays as "
		 "OUT.json~.",
};

static int remember(struct samples *s, const struct colour_sample *sample)
{
	if (s->count == s->capacity) {
		int capacity = s->capacity > 0 ? 2 * s->capacity : 256;
		struct colour_sample *grown = realloc(s->sample, sizeof *grown * (size_t)capacity);
		if (!grown)
			return -ENOMEM;
		s->sample = grown;
		s->capacity = capacity;
	}
	s->sample[s->count++] = *sample;
	return 0;
}

/* ---- which ball has which colour
 * ------------------------------------------------------------------------------------- */

/* The label file's entry whose image is the end of path. */
static const json_t *entry_of(const json_t *labels, const char *path)
{
	size_t i;
	const json_t *entry;
	json_array_foreach((json_t *)labels, i, entry)
	{
		const char *image = json_string_value(json_object_get(entry, "image"));
		size_t n = image ? strlen(image) : 0, m = strlen(path);
		if (n > 0 && n <= m && strcmp(path + m - n, image) == 0 && (n == m || path[m - n - 1] == '/'))
			return entry;
	}
	return NULL;
}

static void colours_from_labels(const json_t *classes, const struct vision_result *result, enum ball_colour *out)
{
	double reach = LABEL_REACH * result->camera.in.width / 1280;
	size_t i;
	const json_t *label;
	json_array_foreach((json_t *)classes, i, label)
	{
		const char *type = json_string_value(json_object_get(label, "type"));
		enum ball_colour colour;
		vec2 px = {json_number_value(json_object_get(label, "px")),
			   json_number_value(json_object_get(label, "py"))};
		int best = -1;
		for (int b = 0; b < result->ball_count; b++)
			if (vec2_dist(result->ball[b].px, px) <
			    (best < 0 ? reach : vec2_dist(result->ball[best].px, px)))
				best = b;
		if (best >= 0 && type && ball_colour_from_name(type, &colour))
			out[best] = colour;
	}
}

/* Six colours on their spots; of the rest, the ball furthest from the others is white. */
static bool colours_from_opening(const struct table *table, const struct vision_result *result, enum ball_colour *out)
{
	int found = 0, white = -1;
	double far = 0;
	if (result->ball_count != OPENING_BALLS)
		return false;
	for (int b = 0; b < result->ball_count; b++)
		out[b] = COLOUR_RED;
	for (int k = COLOUR_YELLOW; k <= COLOUR_BLACK; k++)
		for (int b = 0; b < result->ball_count; b++)
			if (out[b] == COLOUR_RED && vec2_dist(result->ball[b].pos, table->spot[k]) < SPOT_REACH) {
				out[b] = (enum ball_colour)k;
				found++;
				break;
			}
	for (int b = 0; b < result->ball_count; b++) {
		double near = INFINITY;
		for (int o = 0; o < result->ball_count && out[b] == COLOUR_RED; o++)
			if (o != b && out[o] == COLOUR_RED)
				near = fmin(near, vec2_dist(result->ball[b].pos, result->ball[o].pos));
		if (out[b] == COLOUR_RED && near > far) {
			far = near;
			white = b;
		}
	}
	if (found != 6 || white < 0)
		return false;
	out[white] = COLOUR_WHITE;
	return true;
}

/* ---- learning
 * -------------------------------------------------------------------------------------------------------- */

static int label_balls(const struct learner *l, const char *path, enum ball_colour *colour)
{
	const json_t *entry = l->labels ? entry_of(l->labels, path) : NULL;
	for (int b = 0; b < l->result.ball_count; b++)
		colour[b] = COLOUR_UNKNOWN;
	if (entry) {
		colours_from_labels(json_object_get(entry, "classes"), &l->result, colour);
		return CMD_OK;
	}
	if (l->labels) {
		printf("%s: no label, left out\n", path);
		return CMD_OK;
	}
	if (!colours_from_opening(&l->config.table, &l->result, colour))
		return cmd_bad_input("%s: not the opening position (%d balls found); give --labels", path,
				     l->result.ball_count);
	return CMD_OK;
}

static int learn_image(struct learner *l, const char *path)
{
	char err[CMD_ERROR_SIZE] = "";
	struct colour_sample sample[VISION_BALL_MAX];
	enum ball_colour colour[VISION_BALL_MAX];
	if (image_read(path, &l->buffer, err, sizeof err) < 0)
		return cmd_bad_input("%s", err);
	if (vision_detect(l->vision, &l->buffer.image, &l->result, err, sizeof err) < 0)
		return cmd_bad_input("%s: %s", path, err);
	if (l->result.calibration == CALIBRATION_NONE)
		return cmd_bad_input("%s: not calibrated: %s", path, l->result.reason);
	int status = label_balls(l, path, colour);
	if (status != CMD_OK)
		return status;
	vision_samples(l->vision, sample);
	for (int b = 0; b < l->result.ball_count; b++) {
		sample[b].colour = colour[b];
		if (colour[b] != COLOUR_UNKNOWN && remember(&l->samples, &sample[b]) < 0)
			return cmd_bad_input("out of memory");
	}
	return CMD_OK;
}

static int prepare(struct learner *l, const struct calibrate_line *options)
{
	char err[CMD_ERROR_SIZE] = "";
	json_error_t error;
	int status = cmd_config(&l->config, options->config);
	if (status != CMD_OK)
		return status;
	if (options->labels) {
		l->labels = json_load_file(options->labels, 0, &error);
		if (!l->labels)
			return cmd_bad_input("%s:%d: %s", options->labels, error.line, error.text);
		if (!json_is_array(l->labels))
			return cmd_bad_input("%s:1: a JSON list is wanted", options->labels);
	}
	struct vision_def def = config_vision_def(&l->config, NULL);
	if (vision_create(&l->vision, &def, err, sizeof err) < 0)
		return cmd_bad_input("%s: %s", l->config.path, err);
	return CMD_OK;
}

static int finish(const struct learner *l, const char *path)
{
	char err[CMD_ERROR_SIZE] = "";
	struct colour_model model;
	if (l->samples.count == 0)
		return cmd_bad_input("no ball of known colour in these images");
	if (colour_learn(l->samples.sample, l->samples.count, &model, err, sizeof err) < 0)
		return cmd_bad_input("%s", err);
	int code = save_backup(path, err, sizeof err);
	if (code == 0)
		code = colour_file_write(path, &model, err, sizeof err);
	if (code < 0)
		return cmd_not_written(code, err);
	printf("%s: learned from %d balls:", path, l->samples.count);
	for (int k = 0; k < COLOUR_CLASSES; k++)
		printf(" %s %d", ball_colour_name((enum ball_colour)k), model.class[k].samples);
	puts("");
	return CMD_OK;
}

int cmd_calibrate(int argc, char **argv)
{
	struct calibrate_line options = {0};
	int first, status = cmd_options(&calibrate_options, argc, argv, &options, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	if (!option_is_name(operand_names(), argv[first]))
		return cmd_usage(argv[0], calibrate_options.wants);
	struct learner *l = calloc(1, sizeof *l);
	if (!l)
		return cmd_bad_input("out of memory");
	status = prepare(l, &options);
	for (int i = first + 1; i < argc && status == CMD_OK; i++)
		if (!options.without || !strstr(argv[i], options.without))
			status = learn_image(l, argv[i]);
	if (status == CMD_OK)
		status = finish(l, options.out ? options.out : l->config.colours);
	vision_destroy(l->vision);
	image_buffer_finish(&l->buffer);
	json_decref(l->labels);
	free(l->samples.sample);
	free(l);
	return status;
}
