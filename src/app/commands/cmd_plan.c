/* billiard plan: ranked proposals for a position. */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/commands/cmd.h"
#include "app/commands/plot.h"
#include "app/config/position.h"

enum { TRACE_MAX = 1024, PATH_SIZE = 512 };
static const double mm = 1000; /* in a metre */
static const double degree = 180 / M_PI;

struct options {
	const char *config, *model, *profile, *target, *plot, *position;
	int depth, rails, balls, speeds, plans, tolerances, workers; /* -1: as configured */
	double budget_ms;					     /* negative: as configured */
	double budget_nodes;
	bool in_hand, json;
};

struct run {
	struct config config;
	struct position position;
	struct planner_def def;
	struct plan_request request;
	struct planner *planner;
	struct plan_result result;
	double ms;
	struct trace_entry entry[TRACE_MAX];
};

static void help(void)
{
	printf("usage: billiard plan [-c CONF] [--depth N] [--rails N] [--balls N] [--target COLOUR|ID|any|rules] "
	       "[--speeds N]\n"
	       "                     [--workers N] [--budget-ms N] [--budget-nodes N] [--plans N] [--tolerances N] "
	       "[--in-hand]\n"
	       "                     [--model NAME] [--profile NAME] [--json] [--plot FILE.svg|.png] POSITION.txt\n\n"
	       "  -c, --config CONF  table, default $BILLIARD_CONF or the installed one\n"
	       "  --depth N          shots ahead, 1..4\n"
	       "  --rails N          cushions in one leg at most, 0..3\n"
	       "  --balls N          object balls in a chain at most, 1..3 (1: direct)\n"
	       "  --target WHAT      a colour (RED, YELLOW, ...), any, rules, or the ID of one ball; default any\n"
	       "  --speeds N         start speeds tried\n"
	       "  --workers N        threads, 1..16\n"
	       "  --budget-ms N      time for the search (0: none)\n"
	       "  --budget-nodes N   nodes for the search (0: none); the same result every time\n"
	       "  --plans N          wanted, 1..1024\n"
	       "  --tolerances N     of so many plans tolerance and success are found\n"
	       "  --in-hand          the cue ball may be placed in the D\n"
	       "  --model NAME       %s\n"
	       "  --profile NAME     a player of the configuration\n"
	       "  --json             one JSON object per plan, then one of figures\n"
	       "  --plot FILE        draws each shot: FILE-RANK-SHOT\n"
	       "POSITION.txt holds \"ID, TYPE, x, y\" lines in mm (- is standard input).\n",
	       model_names());
}

/* ---- command line ---------------------------------------------------------------------------------------------------
 */

enum {
	OPT_DEPTH = 256,
	OPT_RAILS,
	OPT_BALLS,
	OPT_TARGET,
	OPT_SPEEDS,
	OPT_WORKERS,
	OPT_BUDGET_MS,
	OPT_BUDGET_NODES,
	OPT_PLANS,
	OPT_TOLERANCES,
	OPT_IN_HAND,
	OPT_MODEL,
	OPT_PROFILE,
	OPT_JSON,
	OPT_PLOT
};

static const struct option option_table[] = {
	{"config", required_argument, NULL, 'c'},
	{"depth", required_argument, NULL, OPT_DEPTH},
	{"rails", required_argument, NULL, OPT_RAILS},
	{"balls", required_argument, NULL, OPT_BALLS},
	{"target", required_argument, NULL, OPT_TARGET},
	{"speeds", required_argument, NULL, OPT_SPEEDS},
	{"workers", required_argument, NULL, OPT_WORKERS},
	{"budget-ms", required_argument, NULL, OPT_BUDGET_MS},
	{"budget-nodes", required_argument, NULL, OPT_BUDGET_NODES},
	{"plans", required_argument, NULL, OPT_PLANS},
	{"tolerances", required_argument, NULL, OPT_TOLERANCES},
	{"in-hand", no_argument, NULL, OPT_IN_HAND},
	{"model", required_argument, NULL, OPT_MODEL},
	{"profile", required_argument, NULL, OPT_PROFILE},
	{"json", no_argument, NULL, OPT_JSON},
	{"plot", required_argument, NULL, OPT_PLOT},
	{"help", no_argument, NULL, 'h'},
	{NULL, 0, NULL, 0},
};

static int take_number(struct options *options, int c)
{
	switch (c) {
	case OPT_DEPTH:
		return cmd_whole("--depth", optarg, 1, PLAN_SHOTS_MAX, &options->depth);
	case OPT_RAILS:
		return cmd_whole("--rails", optarg, 0, PLAN_RAILS_MAX, &options->rails);
	case OPT_BALLS:
		return cmd_whole("--balls", optarg, 1, PLAN_CHAIN_MAX - 1, &options->balls);
	case OPT_SPEEDS:
		return cmd_whole("--speeds", optarg, 1, 32, &options->speeds);
	case OPT_WORKERS:
		return cmd_whole("--workers", optarg, 1, PLAN_WORKERS_MAX, &options->workers);
	case OPT_PLANS:
		return cmd_whole("--plans", optarg, 1, PLAN_MAX, &options->plans);
	case OPT_TOLERANCES:
		return cmd_whole("--tolerances", optarg, 0, PLAN_MAX, &options->tolerances);
	case OPT_BUDGET_MS:
		return cmd_number("--budget-ms", optarg, 0, 600000, &options->budget_ms);
	case OPT_BUDGET_NODES:
		return cmd_number("--budget-nodes", optarg, 0, 1e12, &options->budget_nodes);
	default:
		return CMD_BAD_INPUT;
	}
}

static int take_option(struct options *options, int c)
{
	switch (c) {
	case 'c':
		options->config = optarg;
		return CMD_OK;
	case OPT_TARGET:
		options->target = optarg;
		return CMD_OK;
	case OPT_MODEL:
		options->model = optarg;
		return CMD_OK;
	case OPT_PROFILE:
		options->profile = optarg;
		return CMD_OK;
	case OPT_IN_HAND:
		options->in_hand = true;
		return CMD_OK;
	case OPT_JSON:
		options->json = true;
		return CMD_OK;
	case OPT_PLOT:
		options->plot = optarg;
		return plot_format_known(optarg)
			       ? CMD_OK
			       : cmd_bad_input("--plot: \"%s\" ends neither in .svg nor in .png", optarg);
	default:
		return take_number(options, c);
	}
}

/* CMD_OK; CMD_BAD_INPUT; -1 when --help has answered. */
static int parse(struct options *options, int argc, char **argv)
{
	int c;
	while ((c = getopt_long(argc, argv, "c:h", option_table, NULL)) != -1) {
		if (c == 'h') {
			help();
			return -1;
		}
		int status = take_option(options, c);
		if (status != CMD_OK)
			return status;
	}
	if (optind != argc - 1)
		return cmd_usage(argv[0], "wants one position");
	options->position = argv[optind];
	return CMD_OK;
}

/* ---- from options to a request --------------------------------------------------------------------------------------
 */

static double monotonic(void *context)
{
	(void)context;
	struct timespec t;
	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int set_target(struct run *run, const char *text)
{
	struct plan_request *request = &run->request;
	if (!text || strcmp(text, "any") == 0) {
		request->target = TARGET_ANY;
	} else if (strcmp(text, "rules") == 0) {
		request->target = TARGET_RULES;
	} else if (ball_colour_from_name(text, &request->target_colour)) {
		request->target = TARGET_COLOUR;
	} else {
		request->target = TARGET_BALL;
		request->target_ball = position_find(&run->position, text);
		if (request->target_ball < 0)
			return cmd_bad_input("--target: found \"%s\", allowed a colour, any, rules or the ID of a ball "
					     "in the position",
					     text);
	}
	return CMD_OK;
}

static int or_configured(int option, int configured)
{
	return option >= 0 ? option : configured;
}

/* With the ball in hand it need not lie anywhere: a white ball that is off the table is added. */
static void add_white_in_hand(struct position *position)
{
	if (position_cue(position) >= 0 || position->count == BALL_MAX)
		return;
	int i = position->count++;
	position->ball[i] = ball_at(COLOUR_WHITE, (vec2){0, 0});
	position->ball[i].phase = BALL_POTTED;
	for (int n = 0; n == 0 || position_find(position, position->name[i]) != i; n++)
		snprintf(position->name[i], BALL_NAME_SIZE, "WHITE%d", n);
}

static int set_request(struct run *run, const struct options *options)
{
	char err[CMD_ERROR_SIZE];
	const struct config_planner *planner = &run->config.planner;
	struct plan_request *request = &run->request;
	*request = plan_request_default();
	if (options->in_hand)
		add_white_in_hand(&run->position);
	memcpy(request->ball, run->position.ball, sizeof request->ball);
	request->ball_count = run->position.count;
	request->state = rules_state_from_position(request->ball, request->ball_count);
	request->state.in_hand = options->in_hand;
	request->depth = or_configured(options->depth, planner->depth);
	request->rails = or_configured(options->rails, planner->rails);
	request->balls = or_configured(options->balls, planner->balls);
	request->speeds = or_configured(options->speeds, planner->speeds);
	request->plans = or_configured(options->plans, PLAN_MAX);
	request->tolerances = or_configured(options->tolerances, options->json ? 0 : 1);
	request->budget.nodes = (uint64_t)options->budget_nodes;
	request->budget.seconds = options->budget_ms >= 0 ? options->budget_ms / 1000 : planner->budget;
	if (options->budget_nodes > 0 && options->budget_ms < 0)
		request->budget.seconds = 0;
	int status = set_target(run, options->target);
	if (status == CMD_OK && plan_request_check(&run->config.table, request, err, sizeof err) < 0)
		return cmd_bad_input("%s: %s", options->position, err);
	return status;
}

static int set_def(struct run *run, const struct options *options)
{
	struct planner_def *def = &run->def;
	*def = planner_def_default();
	def->table = &run->config.table;
	def->model = run->config.model;
	def->profile = run->config.profile;
	def->workers = or_configured(options->workers, 1);
	def->memory = run->config.planner.memory;
	def->now = monotonic;
	if (options->model && !model_from_name(options->model, &def->model))
		return cmd_bad_input("--model: found \"%s\", allowed %s", options->model, model_names());
	if (options->profile) {
		const struct cost_profile *profile = config_profile(&run->config, options->profile);
		if (!profile)
			return cmd_bad_input("--profile: found \"%s\", allowed a name from profiles", options->profile);
		def->profile = *profile;
	}
	return CMD_OK;
}

static int prepare(struct run *run, const struct options *options)
{
	char err[CMD_ERROR_SIZE];
	int status = cmd_config(&run->config, options->config);
	if (status != CMD_OK)
		return status;
	if (position_read(&run->position, &run->config.table, options->position, err, sizeof err) < 0)
		return cmd_bad_input("%s", err);
	status = set_def(run, options);
	if (status == CMD_OK)
		status = set_request(run, options);
	if (status != CMD_OK)
		return status;
	int rc = planner_create(&run->planner, &run->def);
	return rc < 0 ? cmd_bad_input("billiard plan: no planner: %s", strerror(-rc)) : CMD_OK;
}

/* ---- output ---------------------------------------------------------------------------------------------------------
 */

static const char *pocket_name(const struct run *run, int pocket)
{
	return pocket >= 0 ? run->config.table.pocket[pocket].name : "";
}

static const char *ball_name(const struct run *run, int ball)
{
	return ball >= 0 ? run->position.name[ball] : "";
}

static json_t *shot_json(const struct run *run, const struct plan_shot *shot)
{
	json_t *via = json_array(), *potted = json_array();
	for (int i = 0; i < shot->chain_count; i++)
		json_array_append_new(via, json_string(ball_name(run, shot->chain[i])));
	for (int i = 0; i < shot->potted_count; i++)
		json_array_append_new(potted, json_pack("[s,s]", ball_name(run, shot->potted[i].ball),
							pocket_name(run, shot->potted[i].pocket)));
	json_t *out = json_object();
	json_object_set_new(out, "target", shot->target >= 0 ? json_string(ball_name(run, shot->target)) : json_null());
	json_object_set_new(out, "pocket",
			    shot->pocket >= 0 ? json_string(pocket_name(run, shot->pocket)) : json_null());
	json_object_set_new(out, "via", via);
	json_object_set_new(out, "rails", json_integer(shot->rails));
	json_object_set_new(out, "angle_deg", json_real(shot->shot.angle * degree));
	json_object_set_new(out, "speed_mm_s", json_real(shot->shot.speed * mm));
	json_object_set_new(out, "potted", potted);
	json_object_set_new(out, "cost", json_real(shot->cost));
	json_object_set_new(out, "points", json_integer(shot->points));
	json_object_set_new(out, "foul", json_integer(shot->foul));
	if (!isnan(shot->success)) {
		json_object_set_new(out, "tolerance_deg", json_real(shot->tolerance_angle * degree));
		json_object_set_new(out, "tolerance_speed", json_real(shot->tolerance_speed));
		json_object_set_new(out, "success", json_real(shot->success));
	}
	vec2 cue = shot->start[shot->chain[0]].pos;
	json_object_set_new(out, "cue", json_pack("[f,f]", cue.x * mm, cue.y * mm));
	return out;
}

static int print_json(const struct run *run)
{
	int status = CMD_OK;
	for (int i = 0; i < run->result.plan_count && status == CMD_OK; i++) {
		const struct plan *plan = &run->result.plan[i];
		json_t *shots = json_array();
		for (int s = 0; s < plan->shot_count; s++)
			json_array_append_new(shots, shot_json(run, &plan->shot[s]));
		status = cmd_json_line(json_pack("{s:i, s:f, s:o}", "rank", i + 1, "cost", plan->cost, "shots", shots));
	}
	if (status != CMD_OK)
		return status;
	return cmd_json_line(json_pack("{s:i, s:I, s:I, s:I, s:I, s:I, s:f, s:b}", "plans", run->result.plan_count,
				       "nodes", (json_int_t)run->result.nodes, "sims", (json_int_t)run->result.sims,
				       "tried", (json_int_t)run->result.tried, "landed", (json_int_t)run->result.landed,
				       "refined", (json_int_t)run->result.refined, "ms", run->ms, "exhausted",
				       run->result.exhausted));
}

static void print_shot(const struct run *run, const struct plan_shot *shot)
{
	char via[PATH_SIZE] = "", potted[PATH_SIZE] = "";
	size_t v = 0, p = 0;
	for (int i = 0; i < shot->chain_count && v < sizeof via; i++)
		v += (size_t)snprintf(via + v, sizeof via - v, "%s%s", i ? " > " : "", ball_name(run, shot->chain[i]));
	for (int i = 0; i < shot->potted_count && p < sizeof potted; i++)
		p += (size_t)snprintf(potted + p, sizeof potted - p, "%s%s %s", i ? ", " : "",
				      ball_name(run, shot->potted[i].ball), pocket_name(run, shot->potted[i].pocket));
	printf("%8.2f %8.0f %5d  %-28s %s", shot->shot.angle * degree, shot->shot.speed * mm, shot->rails, via,
	       shot->target < 0 ? "contact only" : potted);
	if (!isnan(shot->success))
		printf("  (+-%.2f deg, +-%.0f %%, success %.0f %%)", shot->tolerance_angle * degree,
		       shot->tolerance_speed * 100, shot->success * 100);
	putchar('\n');
}

static int print_table(const struct run *run)
{
	printf("%4s %9s %8s %8s %5s  %-28s %s\n", "rank", "cost", "angle/°", "v/(mm/s)", "rails", "balls", "potted");
	for (int i = 0; i < run->result.plan_count; i++) {
		const struct plan *plan = &run->result.plan[i];
		printf("%4d %9.5f ", i + 1, plan->cost);
		for (int s = 0; s < plan->shot_count; s++) {
			if (s > 0)
				printf("%15s", "");
			print_shot(run, &plan->shot[s]);
		}
	}
	const struct plan_result *result = &run->result;
	printf("%d plans, %llu nodes, %llu simulations (%llu shots tried, %llu land", result->plan_count,
	       (unsigned long long)result->nodes, (unsigned long long)result->sims, (unsigned long long)result->tried,
	       (unsigned long long)result->landed);
	if (result->refined > 0)
		printf(", %llu with the aim refined", (unsigned long long)result->refined);
	printf("), %.2f ms, %s\n", run->ms, result->exhausted ? "exhausted" : "not exhausted");
	return ferror(stdout) ? CMD_FAILED : CMD_OK;
}

/* FILE-RANK-SHOT.svg for every shot of every plan. */
static int plot_plans(struct run *run, const char *file)
{
	char path[PATH_SIZE], err[CMD_ERROR_SIZE];
	const char *dot = strrchr(file, '.');
	for (int i = 0; i < run->result.plan_count; i++)
		for (int s = 0; s < run->result.plan[i].shot_count; s++) {
			struct trace trace;
			trace_init(&trace, run->entry, TRACE_MAX);
			plan_shot_replay(&run->config.table, &run->def.model, &run->result.plan[i].shot[s],
					 run->position.count, &trace);
			snprintf(path, sizeof path, "%.*s-%d-%d%s", (int)(dot - file), file, i + 1, s + 1, dot);
			int code = plot_trace(&run->config.table, &trace, path, err, sizeof err);
			if (code < 0)
				return cmd_not_written(code, err);
		}
	return CMD_OK;
}

static int search(struct run *run, const struct options *options)
{
	char err[CMD_ERROR_SIZE];
	double begin = monotonic(NULL);
	if (planner_run(run->planner, &run->request, NULL, NULL, &run->result, err, sizeof err) < 0)
		return cmd_bad_input("%s: %s", options->position, err);
	run->ms = (monotonic(NULL) - begin) * 1000;
	/* Pictures first: what is printed then is the answer of a command that worked. */
	int status = options->plot ? plot_plans(run, options->plot) : CMD_OK;
	if (status != CMD_OK)
		return status;
	return options->json ? print_json(run) : print_table(run);
}

int cmd_plan(int argc, char **argv)
{
	struct options options = {.depth = -1,
				  .rails = -1,
				  .balls = -1,
				  .speeds = -1,
				  .plans = -1,
				  .tolerances = -1,
				  .workers = -1,
				  .budget_ms = -1};
	int status = parse(&options, argc, argv);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	struct run *run = calloc(1, sizeof *run);
	if (!run)
		return cmd_bad_input("%s: out of memory", argv[0]);
	status = prepare(run, &options);
	if (status == CMD_OK)
		status = search(run, &options);
	planner_destroy(run->planner);
	free(run);
	return status;
}
