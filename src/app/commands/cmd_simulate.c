/* billiard simulate: the events of one shot, with the state of every ball after each. */
#include <errno.h>
#include <getopt.h>
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

struct options {
	const char *config, *model, *plot, *position, *shot_file;
	double speed, angle, side, follow, elevation; /* mm/s, degrees, shares, degrees */
	bool has_speed, has_angle, json;
};

struct run {
	struct config config;
	struct model model;
	struct position position;
	struct sim sim;
	struct shot shot;
	int cue; /* -1: nothing is struck */
};

static void help(void)
{
	printf("usage: billiard simulate [-c CONF] [--model NAME] POSITION.txt [--speed MM_S --angle DEG]\n"
	       "                         [--side R] [--follow R] [--elevation DEG] [--json] [--plot FILE.svg|.png]\n"
	       "       billiard simulate --shot SHOT.json\n\n"
	       "  -c, --config CONF  table, default $BILLIARD_CONF or the installed one\n"
	       "  --model NAME       %s\n"
	       "  --speed MM_S       of the cue ball after the strike; default: the V line of the position\n"
	       "  --angle DEG        counter-clockwise from the way to the black cushion\n"
	       "  --side R           where the tip meets the ball, share of its radius, + left\n"
	       "  --follow R         the same, + above the middle\n"
	       "  --elevation DEG    of the cue\n"
	       "  --json             one JSON object per event\n"
	       "  --plot FILE        draws the paths\n"
	       "  --shot SHOT.json   a shot of another simulator; events are printed as JSON in its frame and SI "
	       "units\n"
	       "POSITION.txt holds \"ID, TYPE, x, y\" lines in mm (- is standard input).\n",
	       model_names());
}

/* ---- command line ------------------------------------------------------------------------------------------------ */

enum { OPT_MODEL = 256, OPT_SPEED, OPT_ANGLE, OPT_SIDE, OPT_FOLLOW, OPT_ELEVATION, OPT_PLOT, OPT_JSON, OPT_SHOT };

static int take_option(struct options *options, int c)
{
	switch (c) {
	case 'c':
		options->config = optarg;
		return CMD_OK;
	case OPT_MODEL:
		options->model = optarg;
		return CMD_OK;
	case OPT_SPEED:
		options->has_speed = true;
		return cmd_number("--speed", optarg, 0.001, 20000, &options->speed);
	case OPT_ANGLE:
		options->has_angle = true;
		return cmd_number("--angle", optarg, -360, 360, &options->angle);
	case OPT_SIDE:
		return cmd_number("--side", optarg, -1, 1, &options->side);
	case OPT_FOLLOW:
		return cmd_number("--follow", optarg, -1, 1, &options->follow);
	case OPT_ELEVATION:
		return cmd_number("--elevation", optarg, 0, 89, &options->elevation);
	case OPT_PLOT:
		options->plot = optarg;
		return plot_format_known(optarg)
			       ? CMD_OK
			       : cmd_bad_input("--plot: \"%s\" ends neither in .svg nor in .png", optarg);
	case OPT_SHOT:
		options->shot_file = optarg;
		return CMD_OK;
	case OPT_JSON:
		options->json = true;
		return CMD_OK;
	default:
		return CMD_BAD_INPUT;
	}
}

/* CMD_OK; CMD_BAD_INPUT; -1 when --help has answered. */
static int parse(struct options *options, int argc, char **argv)
{
	static const struct option table[] = {
		{"config", required_argument, NULL, 'c'},
		{"model", required_argument, NULL, OPT_MODEL},
		{"speed", required_argument, NULL, OPT_SPEED},
		{"angle", required_argument, NULL, OPT_ANGLE},
		{"side", required_argument, NULL, OPT_SIDE},
		{"follow", required_argument, NULL, OPT_FOLLOW},
		{"elevation", required_argument, NULL, OPT_ELEVATION},
		{"plot", required_argument, NULL, OPT_PLOT},
		{"json", no_argument, NULL, OPT_JSON},
		{"shot", required_argument, NULL, OPT_SHOT},
		{"help", no_argument, NULL, 'h'},
		{NULL, 0, NULL, 0},
	};
	int c;
	while ((c = getopt_long(argc, argv, "c:h", table, NULL)) != -1) {
		if (c == 'h') {
			help();
			return -1;
		}
		int status = take_option(options, c);
		if (status != CMD_OK)
			return status;
	}
	if (options->shot_file && optind == argc)
		return CMD_OK;
	if (options->shot_file || optind != argc - 1)
		return cmd_usage(argv[0], "wants one position, or one --shot");
	options->position = argv[optind];
	if (options->has_speed != options->has_angle)
		return cmd_usage(argv[0], "--speed and --angle belong together");
	if (options->side * options->side + options->follow * options->follow >= 1)
		return cmd_usage(argv[0], "--side and --follow miss the ball");
	return CMD_OK;
}

/* ---- from options to a simulation -------------------------------------------------------------------------------- */

static int set_shot(struct run *run, const struct options *options)
{
	const struct position *position = &run->position;
	run->cue = position_cue(position);
	if (!options->has_speed && !position->has_velocity)
		return cmd_bad_input("%s: neither a V line nor --speed and --angle", options->position);
	if (run->cue < 0)
		return cmd_bad_input("%s: no cue ball to strike", options->position);
	run->shot = (struct shot){
		.side = options->side, .follow = options->follow, .elevation = options->elevation * M_PI / 180};
	if (options->has_speed) {
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

static int prepare(struct run *run, const struct options *options)
{
	char err[CMD_ERROR_SIZE];
	int status = cmd_config(&run->config, options->config);
	if (status != CMD_OK)
		return status;
	run->model = run->config.model;
	if (options->model && !model_from_name(options->model, &run->model))
		return cmd_bad_input("--model: found \"%s\", allowed %s", options->model, model_names());
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
	struct options options = {0};
	int status = parse(&options, argc, argv);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
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
