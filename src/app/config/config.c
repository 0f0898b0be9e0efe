#include "app/config/config.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/config/config_table.h"
#include "app/config/text_file.h"

enum { CONFIG_SIZE_MAX = 1 << 20 };

/* ---- what needs more than one key -------------------------------------------------------------------------------- */

static const config_setting_t *setting_at(const config_t *settings, const char *path)
{
	const config_setting_t *setting = config_lookup(settings, path);
	return setting ? setting : config_root_setting(settings);
}

/* What is set up on a spot must lie on the bed. The balls there are those of the rules, so the names are theirs. */
static int finish_spots(struct config_reader *reader, const config_t *settings, const struct table *table)
{
	static const char *const name[] = {"yellow", "green", "brown", "blue", "pink", "black"};
	for (int i = 0; i < (int)(sizeof name / sizeof *name); i++) {
		vec2 spot = table->spot[COLOUR_YELLOW + i];
		if (fabs(spot.x) <= table->length / 2 && fabs(spot.y) <= table->width / 2)
			continue;
		char path[40];
		snprintf(path, sizeof path, "table.spots.%s", name[i]);
		return config_reader_fail(reader, setting_at(settings, path), "a place off the bed",
					  "one within half of length and width");
	}
	return 0;
}

static int finish_table(struct config_reader *reader, const config_t *settings, struct config_file *file)
{
	struct table *table = &file->config.table;
	table->ball_radius /= 2; /* the file holds the diameter */
	for (int i = 0; i < table->cushion_count; i++)
		table->cushion[i].nose_height = file->nose_height;
	for (int i = 0; i < table->jaw_count; i++)
		table->jaw[i].nose_height = file->nose_height;
	struct material *material = &table->material;
	material->topspin_factor = material->topspin_variant == 1 ? file->topspin_speed : file->topspin_share;

	char reason[160];
	if (table_finish(table, reason, sizeof reason) < 0)
		return config_reader_fail(reader, setting_at(settings, "table"), reason, "a table that fits together");
	return finish_spots(reader, settings, table);
}

static int finish_model(struct config_reader *reader, const config_t *settings, struct config *config)
{
	if (model_from_name(config->model_name, &config->model))
		return 0;
	return config_reader_fail(reader, setting_at(settings, "model"), NULL, model_names());
}

static int finish_profile(struct config_reader *reader, const config_t *settings, struct config_file *file)
{
	const struct cost_profile *profile = config_profile(&file->config, file->profile);
	if (!profile)
		return config_reader_fail(reader, setting_at(settings, "profile"), NULL, "a name from profiles");
	file->config.profile = *profile;
	return 0;
}

static int finish_scheme(struct config_reader *reader, const config_t *settings, struct config_file *file)
{
	if (scheme_from_name(file->scheme, &file->config.planner.scheme))
		return 0;
	return config_reader_fail(reader, setting_at(settings, "planner.scheme"), NULL, "batch, windows, queue, steal");
}

/* Frames in a row were counted before times were: at the 30 a second of a camera. */
static void finish_stillness(struct config_file *file)
{
	if (file->still_frames > 0)
		file->config.infinity.still_time = file->still_frames / 30;
}

static int finish_markers(struct config_reader *reader, const config_t *settings, const struct marker_layout *markers)
{
	for (int i = 0; i < markers->count; i++) {
		bool twice = false;
		for (int j = 0; j < i; j++)
			twice |= markers->marker[i].id == markers->marker[j].id;
		if (!twice && markers->marker[i].id < markers->dictionary_count)
			continue;
		char path[40];
		snprintf(path, sizeof path, "markers.list.[%d].id", i);
		return config_reader_fail(reader, setting_at(settings, path), NULL,
					  "each id once and below dictionary_count");
	}
	return 0;
}

static int finish_projector(struct config_reader *reader, const config_t *settings, const double *h)
{
	double det = h[0] * (h[4] * h[8] - h[5] * h[7]) - h[1] * (h[3] * h[8] - h[5] * h[6]) +
		     h[2] * (h[3] * h[7] - h[4] * h[6]);
	if (fabs(det) > 1e-9)
		return 0;
	return config_reader_fail(reader, setting_at(settings, "projector.homography"), "a singular matrix",
				  "one that can be inverted");
}

/* A relative path in the file is meant from the file's own folder. */
static int finish_colours(struct config_reader *reader, const config_t *settings, struct config *config)
{
	const char *slash = strrchr(reader->path, '/');
	if (config->colours[0] == '/' || !slash)
		return 0;
	char joined[CONFIG_PATH_MAX];
	int n = snprintf(joined, sizeof joined, "%.*s%s", (int)(slash + 1 - reader->path), reader->path,
			 config->colours);
	if (n < 0 || n >= CONFIG_PATH_MAX)
		return config_reader_fail(reader, setting_at(settings, "vision.colours"), "too long a path",
					  "at most 255 characters with its folder");
	memcpy(config->colours, joined, (size_t)n + 1);
	return 0;
}

static int finish(struct config_reader *reader, const config_t *settings, struct config_file *file)
{
	struct config *config = &file->config;
	config->planner.memory = (size_t)file->memory_mib << 20;
	finish_stillness(file);
	int code = finish_table(reader, settings, file);
	if (code == 0)
		code = finish_model(reader, settings, config);
	if (code == 0)
		code = finish_profile(reader, settings, file);
	if (code == 0)
		code = finish_scheme(reader, settings, file);
	if (code == 0)
		code = finish_markers(reader, settings, &config->markers);
	if (code == 0)
		code = finish_projector(reader, settings, config->projector.homography);
	return code == 0 ? finish_colours(reader, settings, config) : code;
}

/* ---- the file ---------------------------------------------------------------------------------------------------- */

/* Where messages go, and which file they name. */
static int parse(config_t *settings, const char *text, const struct config_reader *reader)
{
	config_set_options(settings, CONFIG_OPTION_AUTOCONVERT);
	if (config_read_string(settings, text) == CONFIG_TRUE)
		return 0;
	const char *file = config_error_file(settings) ? config_error_file(settings) : reader->path;
	snprintf(reader->err, reader->err_size, "%s:%d: %s", file, config_error_line(settings),
		 config_error_text(settings));
	return -EINVAL;
}

static int read_defaults(struct config_file *file, char *err, size_t err_size)
{
	struct config_reader reader = {.path = "the defaults", .err = err, .err_size = err_size};
	config_t settings;
	config_init(&settings);
	int code = parse(&settings, config_default_text, &reader);
	if (code == 0)
		code = config_reader_group(&reader, config_root_setting(&settings), config_keys, file);
	config_destroy(&settings);
	return code;
}

/* The defaults with what the text says instead, checked as a whole. */
static int read_file(struct config_file *file, const char *path, const char *text, char *err, size_t err_size)
{
	int code = read_defaults(file, err, err_size);
	if (code < 0)
		return code;
	struct config_reader reader = {.path = path, .err = err, .err_size = err_size, .partial = true};
	config_t settings;
	config_init(&settings);
	code = parse(&settings, text, &reader);
	if (code == 0)
		code = config_reader_group(&reader, config_root_setting(&settings), config_keys, file);
	if (code == 0)
		code = finish(&reader, &settings, file);
	config_destroy(&settings);
	return code;
}

static int read_settings(struct config *config, const char *path, const char *text, char *err, size_t err_size)
{
	struct config_file *file = calloc(1, sizeof *file);
	if (!file) {
		snprintf(err, err_size, "%s: out of memory", path);
		return -ENOMEM;
	}
	int code = read_file(file, path, text, err, err_size);
	if (code == 0) {
		snprintf(file->config.path, sizeof file->config.path, "%s", path);
		*config = file->config;
	}
	free(file);
	return code;
}

int config_load(struct config *config, const char *path, char *err, size_t err_size)
{
	if (strlen(path) >= CONFIG_PATH_MAX) {
		snprintf(err, err_size, "%.40s...: longer than %d characters", path, CONFIG_PATH_MAX - 1);
		return -ENAMETOOLONG;
	}
	char *text;
	size_t size;
	int code = text_file_read(path, CONFIG_SIZE_MAX, &text, &size, err, err_size);
	if (code < 0)
		return code;
	code = read_settings(config, path, text, err, err_size);
	free(text);
	return code;
}

const struct cost_profile *config_profile(const struct config *config, const char *name)
{
	for (int i = 0; i < config->profile_count; i++)
		if (strcmp(config->profiles[i].name, name) == 0)
			return &config->profiles[i];
	return NULL;
}

const char *config_default_path(void)
{
	static const char *const place[] = {"config/thesis-table.conf", BILLIARD_CONFIG_DIR "/thesis-table.conf",
					    "/etc/billiard/thesis-table.conf"};
	const char *chosen = getenv("BILLIARD_CONF");
	for (size_t i = 0; !chosen && i < sizeof place / sizeof *place; i++)
		if (access(place[i], R_OK) == 0)
			chosen = place[i];
	return chosen ? chosen : place[0];
}
