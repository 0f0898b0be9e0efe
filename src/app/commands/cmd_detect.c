/* billiard detect: balls in photographs. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "app/commands/cmd.h"
#include "app/config/colour_file.h"
#include "app/commands/overlay.h"
#include "vision/image_io_cv.h"
#include "vision/stages.h"

static const double mm = 1000; /* in a metre */

struct detect_line {
	const char *config, *overlay, *dump;
	bool json;
};

struct detection {
	struct config config;
	struct colour_model colours;
	struct vision *vision;
	struct image_buffer buffer;
	struct vision_result result;
};

/* A table is read by its columns. */
/* clang-format off */
#define AT(member) offsetof(struct detect_line, member)
static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct detect_line),
	{.name = "json", .type = OPTION_FLAG, .offset = AT(json), .help = "one JSON object per image"},
	{.name = "overlay",
	 .type = OPTION_FILE,
	 .offset = AT(overlay),
	 .value = "OUT.png",
	 .help = "the photograph with what was found in it (one image only)"},
	{.name = "dump",
	 .type = OPTION_FILE,
	 .offset = AT(dump),
	 .value = "DIR",
	 .help = "one picture per stage, DIR/01-markers.png and on (one image only)"},
	{.name = NULL},
};
/* clang-format on */

const struct options detect_options = {
	.name = "detect",
	.summary = "balls in photographs",
	.operands = "IMAGE...",
	.operand_min = 1,
	.operand_max = INT_MAX,
	.wants = "wants images",
	.row = rows,
	.notes = "Images that cannot be read are named on stderr and give status 2; the others are done all the same.",
};

static bool same_file(const char *a, const char *b)
{
	struct stat one, other;
	return stat(a, &one) == 0 && stat(b, &other) == 0 && one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

/* The overlay is a PNG, and not drawn over the photograph. */
static int check_overlay(const char *overlay, const char *image)
{
	size_t n = strlen(overlay);
	if (n < 5 || strcmp(overlay + n - 4, ".png") != 0)
		return cmd_bad_input("--overlay: \"%s\" does not end in .png", overlay);
	if (same_file(overlay, image))
		return cmd_bad_input("--overlay: %s is the photograph itself", overlay);
	return CMD_OK;
}

/* What the table cannot say: pictures are of one image. */
static int check(const struct detect_line *options, int argc, char **argv, int first)
{
	bool one = first == argc - 1;
	if (options->overlay && !one)
		return cmd_usage(argv[0], "--overlay takes one image");
	if (options->dump && !one)
		return cmd_usage(argv[0], "--dump takes one image");
	return options->overlay ? check_overlay(options->overlay, argv[first]) : CMD_OK;
}

static int prepare(struct detection *detection, const struct detect_line *options)
{
	char err[CMD_ERROR_SIZE] = "";
	int status = cmd_config(&detection->config, options->config);
	if (status != CMD_OK)
		return status;
	if (colour_file_read(detection->config.colours, &detection->colours, err, sizeof err) < 0)
		return cmd_bad_input("%s", err);
	struct vision_def def = config_vision_def(&detection->config, &detection->colours);
	if (vision_create(&detection->vision, &def, err, sizeof err) < 0)
		return cmd_bad_input("%s: %s", detection->config.path, err[0] ? err : "out of memory");
	return CMD_OK;
}

/* ---- output ------------------------------------------------------------------------------------------------------ */

static int print_json(const char *image, const struct vision_result *result, double ms)
{
	json_t *balls = json_array();
	for (int i = 0; i < result->ball_count; i++) {
		const struct vision_ball *b = &result->ball[i];
		json_array_append_new(balls,
				      json_pack("{s:s, s:f, s:f, s:f, s:f, s:f}", "type", ball_colour_name(b->colour),
						"x", b->pos.x * mm, "y", b->pos.y * mm, "px", b->px.x, "py", b->px.y,
						"confidence", b->confidence));
	}
	bool calibrated = result->calibration != CALIBRATION_NONE;
	json_t *line = json_object();
	json_object_set_new(line, "image", cmd_json_text(image));
	json_object_set_new(line, "calibrated", json_boolean(calibrated));
	if (calibrated)
		json_object_set_new(line, "residual_px", json_real(result->residual_px));
	else
		json_object_set_new(line, "reason", json_string(result->reason));
	json_object_set_new(line, "occluded", json_boolean(result->occluded));
	json_object_set_new(line, "ms", json_real(ms));
	json_object_set_new(line, "balls", balls);
	return cmd_json_line(line);
}

static int print_table(const char *image, const struct vision_result *result, double ms)
{
	if (result->calibration == CALIBRATION_NONE)
		printf("%s: not calibrated: %s\n", image, result->reason);
	else
		printf("%s: %d balls, %.1f ms, %d markers, residual %.2f px = %.2f mm%s\n", image, result->ball_count,
		       ms, result->markers_seen, result->residual_px, result->residual * mm,
		       result->occluded ? ", something covers the table" : "");
	for (int i = 0; i < result->ball_count; i++) {
		const struct vision_ball *b = &result->ball[i];
		printf("  %-8s %8.1f %8.1f mm  %7.1f %7.1f px  confidence %.2f\n", ball_colour_name(b->colour),
		       b->pos.x * mm, b->pos.y * mm, b->px.x, b->px.y, b->confidence);
	}
	return ferror(stdout) ? CMD_FAILED : CMD_OK;
}

/* ---- pictures of the stages -------------------------------------------------------------------------------------- */

struct dump {
	const char *folder;
	int count;
	char err[CMD_ERROR_SIZE]; /* of the first that could not be written */
};

static void dump_stage(void *user, const char *name, const struct image *image)
{
	struct dump *dump = user;
	char path[CMD_ERROR_SIZE - 32];
	if (dump->err[0] != '\0')
		return;
	int length = snprintf(path, sizeof path, "%s/%02d-%s.png", dump->folder, ++dump->count, name);
	if (length < 0 || (size_t)length >= sizeof path)
		snprintf(dump->err, sizeof dump->err, "--dump: a name too long");
	else if (!image)
		snprintf(dump->err, sizeof dump->err, "%s: out of memory", path);
	else
		image_write_png(image, path, dump->err, sizeof dump->err);
}

/* Detects once more, so that the time of the first is not that of drawing. */
static int write_stages(struct detection *detection, const char *folder)
{
	char err[CMD_ERROR_SIZE] = "";
	struct dump dump = {.folder = folder};
	struct stage_watch watch = {dump_stage, &dump};
	if (mkdir(folder, 0777) < 0 && errno != EEXIST)
		return cmd_bad_input("%s: %s", folder, strerror(errno));
	vision_watch(detection->vision, &watch);
	int rc = vision_detect(detection->vision, &detection->buffer.image, &detection->result, err, sizeof err);
	vision_watch(detection->vision, NULL);
	if (rc < 0 || dump.err[0] != '\0')
		return cmd_bad_input("%s", rc < 0 ? err : dump.err);
	return CMD_OK;
}

/* ---- one image --------------------------------------------------------------------------------------------------- */

static double now_ms(void)
{
	struct timespec t;
	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static int write_overlay(const struct detection *detection, const char *path)
{
	char err[CMD_ERROR_SIZE];
	struct vision_refusal refused[OVERLAY_REFUSED_MAX];
	int count = vision_refusals(detection->vision, refused, OVERLAY_REFUSED_MAX);
	struct overlay overlay = {.frame = &detection->buffer.image,
				  .table = &detection->config.table,
				  .result = &detection->result,
				  .refused = refused,
				  .refused_count = count < OVERLAY_REFUSED_MAX ? count : OVERLAY_REFUSED_MAX};
	int code = overlay_write(&overlay, path, err, sizeof err);
	return code < 0 ? cmd_not_written(code, err) : CMD_OK;
}

static int detect(struct detection *detection, const struct detect_line *options, const char *path)
{
	char err[CMD_ERROR_SIZE] = "";
	if (image_read(path, &detection->buffer, err, sizeof err) < 0)
		return cmd_bad_input("%s", err);
	double begin = now_ms();
	int code = vision_detect(detection->vision, &detection->buffer.image, &detection->result, err, sizeof err);
	double ms = now_ms() - begin;
	if (code < 0)
		return cmd_bad_input("%s: %s", path, err);
	if (options->dump && write_stages(detection, options->dump) != CMD_OK)
		return CMD_BAD_INPUT;
	int status = options->overlay ? write_overlay(detection, options->overlay) : CMD_OK;
	if (status != CMD_OK)
		return status;
	return options->json ? print_json(path, &detection->result, ms) : print_table(path, &detection->result, ms);
}

int cmd_detect(int argc, char **argv)
{
	struct detect_line options = {0};
	int first, status = cmd_options(&detect_options, argc, argv, &options, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	status = check(&options, argc, argv, first);
	if (status != CMD_OK)
		return status;
	struct detection *detection = calloc(1, sizeof *detection);
	if (!detection)
		return cmd_bad_input("%s: out of memory", argv[0]);
	status = prepare(detection, &options);
	if (status == CMD_OK) {
		for (int i = first; i < argc; i++) {
			int one = detect(detection, &options, argv[i]);
			status = one > status ? one : status;
		}
	}
	vision_destroy(detection->vision);
	image_buffer_finish(&detection->buffer);
	free(detection);
	return status;
}
