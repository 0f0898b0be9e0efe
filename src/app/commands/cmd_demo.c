/* billiard demo: starts the whole loop, watches the bus like any other listener, prints a line and keeps two pictures per proposal. Nothing is
 * steered from here but the pictures: proposals come from the services, shots from the virtual table. */
#include <errno.h>
#include <fcntl.h>
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/planner/plan_check.h"
#include "app/process/bus.h"
#include "app/commands/cmd.h"
#include "app/light/draw.h"
#include "app/planner/plan_message.h"
#include "app/config/position.h"
#include "app/process/process.h"
#include "app/process/supervisor.h"
#include "vision/capture_cv.h"
#include "vision/image_io_cv.h"

static const double PICTURE_DELAY = 0.4; /* s from a drawn proposal until its light is in the camera's picture */
static const double LAST_STATUS = 1.5;	 /* s after the last photograph: figures are told once a second */
static const double GIVE_UP = 30;	 /* s without a new proposal */
static const double RADIAN_DEG = 57.29577951308232;
enum { TICK_US = 50000, TEXT_SIZE = 256 };

struct demo_options {
	const char *config, *out, *input, *position;
	int shots;
};

struct demo {
	struct process process;
	struct config config;
	struct demo_options options;
	struct supervisor supervisor;
	struct byte_buffer camera; /* newest CAMERA picture, JPEG */
	billiard_table_state_t seen, truth;
	billiard_plan_t plan;
	bool has_truth;
	int64_t rest_utime; /* us, when the balls were last seen to come to rest */
	int64_t shown_id;   /* proposal on the table */
	double shown_at;    /* s, when it was first drawn; 0: its pictures are kept */
	int64_t shown_utime;
	int proposals, played, failed;
	int bad; /* photographs that could not be read */
	bool shot_runs;
	billiard_table_state_t before; /* truth when the shot began */
	char fell[TEXT_SIZE];	       /* balls that fell in the running shot */
	char picture[TEXT_SIZE];       /* photograph shown, from billiard-vision's status */
	double last_progress;	       /* s */
	double source_ended;	       /* s, 0 not yet */
	int status;
};

static void add_text(char *out, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void add_text(char *out, size_t size, const char *format, ...)
{
	size_t n = strlen(out);
	va_list args;
	va_start(args, format);
	vsnprintf(out + n, size - n, format, args);
	va_end(args);
}

/* ---- what is said --------------------------------------------------------------------------------------------------- */

static const char *pocket_name(const struct demo *d, int pocket)
{
	return pocket >= 0 && pocket < d->config.table.pocket_count ? d->config.table.pocket[pocket].name : "?";
}

/* The name of a planned ball: that of the ball which really lies there, on the virtual table; else the plan's own. */
static void ball_name(const struct demo *d, int ball, char *out, size_t size)
{
	const billiard_plan_shot_t *s = &d->plan.entries[0].shots[0];
	vec2 at = {s->start_x[ball], s->start_y[ball]};
	text_get(out, size, d->plan.names[ball], sizeof d->plan.names[0]);
	for (int i = 0; d->has_truth && i < d->truth.ball_count; i++) {
		const billiard_ball_t *b = &d->truth.balls[i];
		if (vec2_dist(at, (vec2){b->x, b->y}) < d->config.table.ball_radius)
			text_get(out, size, b->name, sizeof b->name);
	}
}

static void describe_proposal(const struct demo *d, char *out, size_t size)
{
	const billiard_plan_shot_t *s = &d->plan.entries[0].shots[0];
	char name[24] = "contact only";
	out[0] = '\0';
	if (s->target >= 0)
		ball_name(d, s->target, name, sizeof name);
	add_text(out, size, "%s%s%s at %.1f deg, %.2f m/s, to fall:", name, s->pocket >= 0 ? " -> " : "",
		 s->pocket >= 0 ? pocket_name(d, s->pocket) : "", s->angle * RADIAN_DEG, s->speed);
	for (int i = 0; i < s->potted_count; i++) {
		ball_name(d, s->potted_ball[i], name, sizeof name);
		add_text(out, size, " %s", name);
	}
	if (s->potted_count == 0)
		add_text(out, size, " nothing");
}

/* How far the worst ball is seen from where it really lies, m; INFINITY when one is missed or invented. */
static double worst_error(const struct demo *d)
{
	double worst = d->seen.ball_count == d->truth.ball_count ? 0 : INFINITY;
	for (int i = 0; i < d->truth.ball_count; i++) {
		const billiard_ball_t *t = &d->truth.balls[i];
		double nearest = INFINITY;
		for (int k = 0; k < d->seen.ball_count; k++) {
			const billiard_ball_t *s = &d->seen.balls[k];
			if (s->colour == t->colour)
				nearest = fmin(nearest, vec2_dist((vec2){s->x, s->y}, (vec2){t->x, t->y}));
		}
		worst = fmax(worst, nearest);
	}
	return worst;
}

static void print_proposal(struct demo *d)
{
	char text[TEXT_SIZE];
	int cue = -1;
	for (int i = 0; i < d->seen.ball_count; i++)
		if (d->seen.balls[i].colour == COLOUR_WHITE)
			cue = i;
	printf("%s %d: ", d->options.input ? "photo" : "shot", d->proposals);
	if (d->options.input && d->picture[0])
		printf("%s: ", d->picture);
	printf("%d balls seen", d->seen.ball_count);
	if (cue >= 0)
		printf(", cue ball at (%.0f, %.0f) mm", 1e3 * d->seen.balls[cue].x, 1e3 * d->seen.balls[cue].y);
	if (d->has_truth && isfinite(worst_error(d)))
		printf(", all within %.2f mm of the truth", 1e3 * worst_error(d));
	else if (d->has_truth)
		printf(", %d are there", d->truth.ball_count);
	describe_proposal(d, text, sizeof text);
	printf("; proposed %s; %.0f ms from rest to proposal", text, 1e-3 * (double)(d->shown_utime - d->rest_utime));
	if (d->options.input)
		putchar('\n');
	fflush(stdout);
}

/* ---- pictures ------------------------------------------------------------------------------------------------------- */

static void keep_camera_picture(struct demo *d)
{
	char path[TEXT_SIZE], err[TEXT_SIZE];
	struct image_buffer image = {0};
	snprintf(path, sizeof path, "%s/shot-%d-camera.png", d->options.out, d->proposals);
	if (!d->camera.size || image_decode(d->camera.data, d->camera.size, &image, err, sizeof err) < 0 ||
	    image_write_png(&image.image, path, err, sizeof err) < 0) {
		fprintf(stderr, "billiard demo: %s: %s\n", path, d->camera.size ? err : "no camera picture came");
		d->failed++;
	}
	image_buffer_finish(&image);
}

static void ask_projector_picture(struct demo *d)
{
	billiard_command_t command = {.utime = clock_utime()};
	char path[TEXT_SIZE], *folder = realpath(d->options.out, NULL);
	snprintf(path, sizeof path, "%.200s/shot-%d-projector.png", folder ? folder : ".", d->proposals);
	free(folder);
	text_set(command.name, sizeof command.name, "snapshot");
	text_set(command.target, sizeof command.target, "billiard-projector");
	text_set(command.argument, sizeof command.argument, path);
	bus_publish(d->process.bus, "COMMAND", &bus_command, &command);
}

/* ---- messages ------------------------------------------------------------------------------------------------------- */

static bool on_camera(void *context, const void *message)
{
	struct demo *d = context;
	const billiard_image_t *image = message;
	size_t size = (size_t)image->size;
	if (size > d->camera.capacity) {
		uint8_t *bigger = realloc(d->camera.data, size);
		if (!bigger)
			return true;
		d->camera.data = bigger;
		d->camera.capacity = size;
	}
	memcpy(d->camera.data, image->data, size);
	d->camera.size = size;
	return true;
}

static bool on_seen(void *context, const void *message)
{
	struct demo *d = context;
	const billiard_table_state_t *state = message;
	if (state->ball_count < 0 || state->ball_count > BALL_MAX)
		return false;
	/* Photographs have no truth: they rest from their first frame on. */
	if (d->options.input && d->seen.calibration == 0 && state->calibration != 0)
		d->rest_utime = state->utime;
	d->seen = *state;
	return true;
}

static bool on_plan(void *context, const void *message)
{
	struct demo *d = context;
	const billiard_plan_t *plan = message;
	if (!plan_check(plan, &d->config.table))
		return false;
	if (plan->status == PLAN_MESSAGE_OK)
		d->plan = *plan;
	return true;
}

static bool on_draw(void *context, const void *message)
{
	struct demo *d = context;
	const billiard_draw_list_t *list = message;
	if (list->plan_id == 0 || list->plan_id == d->shown_id || list->plan_id != d->plan.request_id)
		return true;
	d->shown_id = list->plan_id;
	d->shown_utime = list->utime;
	d->shown_at = d->last_progress = clock_seconds();
	d->proposals++;
	return true;
}

/* A figure of that name, 0 when there is none. */
static double metric(const billiard_status_t *status, const char *name)
{
	for (int i = 0; i < status->metric_count && i < (int)(sizeof status->metrics / sizeof status->metrics[0]);
	     i++) {
		char text[sizeof status->metrics[i].name];
		text_get(text, sizeof text, status->metrics[i].name, sizeof status->metrics[i].name);
		if (strcmp(text, name) == 0)
			return status->metrics[i].value;
	}
	return 0;
}

static bool on_status(void *context, const void *message)
{
	struct demo *d = context;
	const billiard_status_t *s = message;
	char name[sizeof s->process], state[sizeof s->state];
	text_get(name, sizeof name, s->process, sizeof s->process);
	if (strcmp(name, "billiard-vision") != 0)
		return true;
	d->bad = (int)metric(s, "bad");
	if (metric(s, "ended") > 0 && d->source_ended <= 0)
		d->source_ended = clock_seconds();
	/* for people only: which photograph is shown goes into the line that is printed, and decides nothing */
	text_get(state, sizeof state, s->state, sizeof s->state);
	if (strncmp(state, "photo ", 6) == 0)
		snprintf(d->picture, sizeof d->picture, "%s", state + 6);
	return true;
}

static int find_ball(const billiard_table_state_t *state, int track)
{
	for (int i = 0; i < state->ball_count; i++)
		if (state->balls[i].track == track)
			return i;
	return -1;
}

/* Balls that were there when the shot began and are there no more. */
static void note_fallen(struct demo *d, const billiard_table_state_t *now)
{
	d->fell[0] = '\0';
	for (int i = 0; i < d->before.ball_count; i++) {
		char name[24];
		if (find_ball(now, d->before.balls[i].track) >= 0)
			continue;
		text_get(name, sizeof name, d->before.balls[i].name, sizeof d->before.balls[i].name);
		add_text(d->fell, sizeof d->fell, " %s", name);
	}
}

static void end_shot(struct demo *d)
{
	d->shot_runs = false;
	d->played++;
	printf("; fell:%s\n", d->fell[0] ? d->fell : " nothing");
	fflush(stdout);
	d->last_progress = clock_seconds();
	if (d->played >= d->options.shots)
		supervisor_stop(&d->supervisor, d->status);
}

/* The virtual table's own word: when a shot begins, what falls, when the balls rest. */
static bool on_truth(void *context, const void *message)
{
	struct demo *d = context;
	const billiard_table_state_t *truth = message;
	if (truth->ball_count < 0 || truth->ball_count > BALL_MAX)
		return false;
	bool was_moving = d->has_truth && d->truth.moving;
	if (!d->has_truth || (was_moving && !truth->moving))
		d->rest_utime = truth->utime;
	if (truth->moving && !was_moving) {
		d->before = d->has_truth ? d->truth : *truth;
		d->shot_runs = true;
	}
	if (truth->moving)
		note_fallen(d, truth);
	d->truth = *truth;
	d->has_truth = true;
	if (d->shot_runs && !truth->moving)
		end_shot(d);
	return true;
}

/* ---- time ----------------------------------------------------------------------------------------------------------- */

static int on_tick(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	struct demo *d = context;
	double now = clock_seconds();
	if (d->shown_at > 0 && now - d->shown_at > PICTURE_DELAY) {
		d->shown_at = 0;
		keep_camera_picture(d);
		ask_projector_picture(d);
		print_proposal(d);
	}
	bool all_shown = d->source_ended > 0 && now - d->source_ended > LAST_STATUS && d->shown_at == 0;
	if (all_shown)
		supervisor_stop(&d->supervisor, d->status);
	if (now - d->last_progress > GIVE_UP && !d->supervisor.stopping) {
		fprintf(stderr, "billiard demo: no new proposal for %.0f s\n", GIVE_UP);
		supervisor_stop(&d->supervisor, 1);
		d->status = 1;
	}
	return 0;
}

/* ---- set-up --------------------------------------------------------------------------------------------------------- */

/* An option with a value that may hold blanks or quotes. The caller frees with g_free(). */
static char *option_text(const char *format, const char *value)
{
	char *quoted = g_shell_quote(value), *text = g_strdup_printf(format, quoted);
	g_free(quoted);
	return text;
}

static int start_services(struct demo *d, char *err, size_t err_size)
{
	char *position = d->options.position ? option_text("--position %s", d->options.position) : NULL;
	char *photographs = d->options.input ? option_text("--hold 4 --source dir:%s", d->options.input) : NULL;
	const struct {
		const char *name, *arguments;
		bool wanted;
	} services[] = {
		{"billiard-planner", "", true},
		{"billiard-projector", "", true},
		{"billiard-infinity", "", true},
		{"billiard-vision", photographs ? photographs : "--source lcm:CAMERA", true},
		{"billiard-table", position ? position : "", !d->options.input},
	};
	int r = 0;
	for (size_t i = 0; i < sizeof services / sizeof services[0] && r == 0; i++)
		if (services[i].wanted)
			r = supervisor_start(&d->supervisor, services[i].name, services[i].arguments, err, err_size);
	g_free(position);
	g_free(photographs);
	return r;
}

static int subscribe_all(struct demo *d)
{
	struct bus *bus = d->process.bus;
	int r = bus_subscribe(bus, &(struct bus_subscription){"CAMERA", &bus_image, BUS_LATEST, on_camera, d});
	r = r < 0 ? r
		  : bus_subscribe(bus,
				  &(struct bus_subscription){"TABLE_STATE", &bus_table_state, BUS_EACH, on_seen, d});
	r = r < 0 ? r : bus_subscribe(bus, &(struct bus_subscription){"PLAN", &bus_plan, BUS_EACH, on_plan, d});
	r = r < 0 ? r : bus_subscribe(bus, &(struct bus_subscription){"DRAW", &bus_draw_list, BUS_EACH, on_draw, d});
	r = r < 0 ? r : bus_subscribe(bus, &(struct bus_subscription){"STATUS", &bus_status, BUS_EACH, on_status, d});
	return r < 0 ? r
		     : bus_subscribe(bus, &(struct bus_subscription){"TRUTH", &bus_table_state, BUS_EACH, on_truth, d});
}

static int run(struct demo *d)
{
	char err[512] = "";
	struct process_options options = {.config = d->options.config};
	supervisor_block();
	int r = process_init(&d->process, "billiard-demo", &options, &d->config);
	if (r < 0)
		return 2;
	d->last_progress = clock_seconds();
	supervisor_init(&d->supervisor, d->process.event, d->options.config, NULL);
	if ((r = subscribe_all(d)) < 0 || (r = process_every(&d->process, TICK_US, on_tick, d)) < 0 ||
	    (r = start_services(d, err, sizeof err)) < 0) {
		fprintf(stderr, "billiard demo: %s\n", err[0] ? err : strerror(-r));
		return 1;
	}
	int status = process_run(&d->process);
	int wanted = d->options.input ? 1 : d->options.shots;
	int got = d->options.input ? d->proposals : d->played;
	printf("%d proposals%s, %d pictures failed", d->proposals,
	       d->options.input		       ? ""
	       : d->played == d->options.shots ? ", all played"
					       : "",
	       d->failed);
	if (d->bad)
		printf(", %d photographs could not be read", d->bad);
	putchar('\n');
	if (status == 0 && d->bad)
		status = 2;
	return status ? status : got < wanted || d->failed;
}

/* A table is read by its columns. */
/* clang-format off */
#define AT(member) offsetof(struct demo_options, member)
static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct demo_options),
	{.name = "out",
	 .type = OPTION_FILE,
	 .offset = AT(out),
	 .value = "DIR",
	 .help = "where the pictures go, default build/demo"},
	{.name = "shots",
	 .type = OPTION_WHOLE,
	 .offset = AT(shots),
	 .value = "N",
	 .help = "that are played, default 5",
	 .low = 1,
	 .high = 1000},
	{.name = "position", .type = OPTION_FILE, .offset = AT(position), .value = "FILE", .help = "to begin with"},
	{.name = "input",
	 .type = OPTION_FILE,
	 .offset = AT(input),
	 .value = "FOLDER",
	 .help = "shows photographs instead of the virtual table"},
	{.name = NULL},
};
/* clang-format on */

const struct options demo_options = {
	.name = "demo",
	.summary = "the whole loop on the virtual table or on photographs",
	.operands = "",
	.row = rows,
	.notes = "Leaves two pictures per proposal in DIR.",
};

/* The folder of the pictures. CMD_OK or CMD_BAD_INPUT. */
static int make_folder(const char *path)
{
	if (mkdir(path, 0777) < 0 && errno != EEXIST)
		return cmd_bad_input("billiard demo: %s: %s", path, strerror(errno));
	return CMD_OK;
}

/* An input without photographs is said at once, not by a service that does not start. */
static int check_input(const char *folder)
{
	char source[TEXT_SIZE + 32], err[TEXT_SIZE];
	struct capture *capture;
	struct capture_def def = {.source = source};
	snprintf(source, sizeof source, "dir:%s", folder);
	int r = capture_open(&capture, &def, err, sizeof err);
	if (r < 0)
		fprintf(stderr, "billiard demo: %s\n", err);
	else
		capture_close(capture);
	return r;
}

static int check_position(const struct demo_options *options)
{
	char err[512];
	struct config config;
	struct position position;
	int r = config_load(&config, options->config, err, sizeof err);
	if (r == 0)
		r = position_read(&position, &config.table, options->position, err, sizeof err);
	if (r < 0)
		fprintf(stderr, "billiard demo: %s\n", err);
	return r;
}

int cmd_demo(int argc, char **argv)
{
	struct demo_options options = {config_default_path(), "build/demo", NULL, NULL, 5};
	int first, r = cmd_options(&demo_options, argc, argv, &options, &first);
	if (r != CMD_OK)
		return r < 0 ? CMD_OK : r;
	if (make_folder(options.out) != CMD_OK)
		return CMD_BAD_INPUT;
	if ((options.input && check_input(options.input) < 0) || (options.position && check_position(&options) < 0))
		return 2;
	struct demo *d = calloc(1, sizeof *d);
	if (!d)
		return 1;
	d->options = options;
	int status = run(d);
	supervisor_finish(&d->supervisor);
	process_finish(&d->process);
	byte_buffer_finish(&d->camera);
	free(d);
	return status;
}
