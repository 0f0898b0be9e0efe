/* billiard simulate: the events of one shot, with the state of every ball after each. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/cmd.h"
#include "app/commands/plot.h"
#include "app/config/position.h"
#include "app/config/shot_file.h"
#include "physics/sim.h"

static const double mm = 1000; /* in a metre */
enum { EVENT_LIMIT = 10000 };

struct simulate_line {
	const char *config, *model, *plot, *position, *shot_file;
	double speed, angle;		/* mm/s, degrees; NaN: not given */
	double side, follow, elevation; /* shares, degrees */
	bool json;
};

struct run {
	struct config config;
	struct model model;
	struct position position;
	struct sim sim;
	struct shot shot;
	int cue; /* -1: nothing is struck */
};

/* ---- command line ------------------------------------------------------------------------------------------------ */

/* A table is read by its columns. */
/* clang-format off */
#define AT(member) offsetof(struct simulate_line, member)
#define NUMBER(key, unit, min, max, member, text)                                                                      \
	{                                                                                                              \
		.name = key, .type = OPTION_NUMBER, .offset = AT(member), .value = unit, .help = text, .low = min,     \
		.high = max                                                                                            \
	}

static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct simulate_line),
	{.name = "model",
	 .type = OPTION_CHOICE,
	 .offset = AT(model),
	 .value = "NAME",
	 .names = model_names,
	 .help = "physics instead of the configuration's"},
	NUMBER("speed", "MM_S", 0.001, 20000, speed,
	       "of the cue ball after the strike; default: the position's V line"),
	NUMBER("angle", "DEG", -360, 360, angle, "counter-clockwise from the way to the black cushion"),
	NUMBER("side", "R", -1, 1, side, "where the tip meets the ball, share of its radius, + left"),
	NUMBER("follow", "R", -1, 1, follow, "the same, + above the middle"),
	NUMBER("elevation", "DEG", 0, 89, elevation, "of the cue"),
	{.name = "json", .type = OPTION_FLAG, .offset = AT(json), .help = "one JSON object per event"},
	{.name = "plot",
	 .type = OPTION_FILE,
	 .offset = AT(plot),
	 .value = "FILE",
	 .help = "draws the paths as .svg or .png"},
	{.name = "shot",
	 .type = OPTION_FILE,
	 .offset = AT(shot_file),
	 .value = "SHOT.json",
	 .help = "a shot of another simulator; its events as JSON in its frame and SI units"},
	{.name = NULL},
};
/* clang-format on */

const struct options simulate_options = {
	.name = "simulate",
	.summary = "what a shot does, event by event",
	.operands = "POSITION.txt | --shot SHOT.json",
	.operand_max = 1,
	.wants = "wants one position, or one --shot",
	.row = rows,
	.notes = "POSITION.txt holds \"ID, TYPE, x, y\" lines in mm (- is standard input).",
};

/* What the table cannot say: which options go together. */
static int check(const struct simulate_line *options, const char *name)
{
	if (!options->shot_file == !options->position)
		return cmd_usage(name, "wants one position, or one --shot");
	if (isnan(options->speed) != isnan(options->angle))
		return cmd_usage(name, "--speed and --angle belong together");
	if (hypot(options->side, options->follow) >= 1)
		return cmd_usage(name, "--side and --follow miss the ball");
	if (options->plot && !plot_format_known(options->plot))
		return cmd_bad_input("--plot: \"%s\" ends neither in .svg nor in .png", options->plot);
	return CMD_OK;
}

/* ---- from options to a simulation -------------------------------------------------------------------------------- */

static int set_shot(struct run *run, const struct simulate_line *options)
{
	const struct position *position = &run->position;
	run->cue = position_cue(position);
	bool has_speed = !isnan(options->speed);
	if (!has_speed && !position->has_velocity)
		return cmd_bad_input("%s: neither a V line nor --speed and --angle", options->position);
	if (run->cue < 0)
		return cmd_bad_input("%s: no cue ball to strike", options->position);
	run->shot = (struct shot){
		.side = options->side, .follow = options->follow, .elevation = options->elevation * M_PI / 180};
	if (has_speed) {
		run->shot.angle = options->angle * M_PI / 180;
		run->shot.speed = options->speed / mm;
	} else {
		run->shot.angle = atan2(position->velocity.y, position->velocity.x);
		run->shot.speed = vec2_norm(position->velocity);
		if (!(run->shot.speed > 0))
			run->cue = -1;
	}
	return CMD_OK;
}

static int prepare(struct run *run, const struct simulate_line *options)
{
	char err[CMD_ERROR_SIZE];
	int status = cmd_config(&run->config, options->config);
	if (status != CMD_OK)
		return status;
	run->model = run->config.model;
	if (options->model)
		model_from_name(options->model, &run->model); /* the table of options knows the names */
	if (position_read(&run->position, &run->config.table, options->position, err, sizeof err) < 0)
		return cmd_bad_input("%s", err);
	return set_shot(run, options);
}

static void begin(struct run *run)
{
	sim_init(&run->sim, &run->config.table, &run->model, run->position.ball, run->position.count);
	if (run->cue >= 0)
		sim_strike(&run->sim, run->cue, &run->shot);
}

/* ---- output ------------------------------------------------------------------------------------------------------ */

static json_t *state_json(const struct run *run, int i)
{
	struct ball b = sim_ball(&run->sim, i);
	return json_pack("{s:s, s:f, s:f, s:f, s:f, s:[f,f,f], s:s}", "id", run->position.name[i], "x", b.pos.x * mm,
			 "y", b.pos.y * mm, "vx", b.vel.x * mm, "vy", b.vel.y * mm, "w", b.spin[0], b.spin[1],
			 b.spin[2], "phase", ball_phase_name(b.phase));
}

static int print_json(const struct run *run, const struct event *event)
{
	json_t *balls = json_array(), *state = json_array();
	json_array_append_new(balls, json_string(run->position.name[event->ball]));
	if (event->kind == EVENT_BALL_BALL)
		json_array_append_new(balls, json_string(run->position.name[event->other]));
	for (int i = 0; i < run->position.count; i++)
		json_array_append_new(state, state_json(run, i));
	json_t *line =
		json_pack("{s:f, s:s, s:o}", "t", event->time, "event", event_kind_name(event->kind), "balls", balls);
	if (event->kind == EVENT_CUSHION || event->kind == EVENT_JAW)
		json_object_set_new(line, "cushion", json_integer(event->other));
	if (event->kind == EVENT_POCKET)
		json_object_set_new(line, "pocket", json_string(run->config.table.pocket[event->other].name));
	json_object_set_new(line, "state", state);
	return cmd_json_line(line);
}

static void print_ball(const struct run *run, int i, const char *partner)
{
	struct ball b = sim_ball(&run->sim, i);
	printf("%-16s %9.2f %9.2f %9.1f %8.2f  %-8s %s\n", run->position.name[i], b.pos.x * mm, b.pos.y * mm,
	       vec2_norm(b.vel) * mm, atan2(b.vel.y, b.vel.x) * 180 / M_PI, ball_phase_name(b.phase), partner);
}

static int print_row(const struct run *run, const struct event *event)
{
	bool pair = event->kind == EVENT_BALL_BALL;
	const char *where = "";
	if (event->kind == EVENT_POCKET)
		where = run->config.table.pocket[event->other].name;
	printf("%9.4f  %-23s ", event->time, event_kind_name(event->kind));
	print_ball(run, event->ball, where);
	if (pair) {
		printf("%34s", "");
		print_ball(run, event->other, "");
	}
	return ferror(stdout) ? CMD_FAILED : CMD_OK;
}

static int print_event(const struct run *run, const struct event *event, bool json)
{
	return json ? print_json(run, event) : print_row(run, event);
}

static int print_events(struct run *run, bool json)
{
	if (!json)
		printf("%9s  %-23s %-16s %9s %9s %9s %8s  %s\n", "t/s", "event", "ball", "x/mm", "y/mm", "v/(mm/s)",
		       "angle/°", "phase");
	begin(run);
	int status = CMD_OK;
	struct event event;
	for (int n = 0; status == CMD_OK && sim_step(&run->sim, &event); n++) {
		if (n == EVENT_LIMIT) {
			fprintf(stderr, "billiard simulate: stopped after %d events\n", EVENT_LIMIT);
			return CMD_FAILED;
		}
		status = print_event(run, &event, json);
	}
	return status;
}

/* The same simulation once more, this time into a trace. */
static int plot(struct run *run, const char *path)
{
	struct trace_entry *entry = calloc(EVENT_LIMIT, sizeof *entry);
	if (!entry)
		return cmd_bad_input("billiard simulate: out of memory");
	struct trace trace;
	trace_init(&trace, entry, EVENT_LIMIT);
	begin(run);
	sim_run(&run->sim, &(struct sim_limits){.max_time = INFINITY, .max_events = EVENT_LIMIT}, &trace);
	char err[CMD_ERROR_SIZE];
	int code = plot_trace(&run->config.table, &trace, path, err, sizeof err);
	free(entry);
	return code < 0 ? cmd_not_written(code, err) : CMD_OK;
}

static int simulate_shot_file(const char *path)
{
	char err[CMD_ERROR_SIZE];
	struct shot_file *file = malloc(sizeof *file);
	if (!file)
		return cmd_bad_input("billiard simulate: out of memory");
	int status = CMD_OK;
	if (shot_file_read(file, path, err, sizeof err) < 0) {
		status = cmd_bad_input("%s", err);
	} else {
		int r = shot_file_run(file, EVENT_LIMIT, stdout);
		if (r < 0)
			fprintf(stderr, "billiard simulate: %s\n",
				r == -ETIME ? "stopped, too many events" : strerror(-r));
		status = r < 0 ? CMD_FAILED : CMD_OK;
	}
	free(file);
	return status;
}

int cmd_simulate(int argc, char **argv)
{
	struct simulate_line options = {.speed = NAN, .angle = NAN};
	int first, status = cmd_options(&simulate_options, argc, argv, &options, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	options.position = argv[first];
	status = check(&options, argv[0]);
	if (status != CMD_OK)
		return status;
	if (options.shot_file)
		return simulate_shot_file(options.shot_file);
	struct run *run = calloc(1, sizeof *run);
	if (!run)
		return cmd_bad_input("%s: out of memory", argv[0]);
	status = prepare(run, &options);
	if (status == CMD_OK && options.plot)
		status = plot(run, options.plot);
	if (status == CMD_OK)
		status = print_events(run, options.json);
	free(run);
	return status;
}
