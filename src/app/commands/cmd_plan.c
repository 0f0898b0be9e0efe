/* billiard plan: ranked proposals for a position. */
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

struct plan_line {
	const char *config, *model, *profile, *ranking, *target, *on, *plot, *position;
	int depth, rails, balls, speeds, plans, tolerances, workers; /* -1: as configured */
	double budget_ms;					     /* negative: as configured */
	double budget_nodes;
	double error_angle, error_speed, error_tip,
		error_elevation; /* degrees, shares, degrees; negative: the profile's */
	bool in_hand, free_ball, json;
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

/* ---- command line ------------------------------------------------------------------------------------------------ */

static const char *target_names(void)
{
	return "any, rules, RED, YELLOW, GREEN, BROWN, BLUE, PINK, BLACK";
}

static const char *on_names(void)
{
	return "any, red, colour, clearance";
}

static const char *ranking_names(void)
{
	return "thesis, success, value";
}

/* A table is read by its columns. */
/* clang-format off */
#define AT(member) offsetof(struct plan_line, member)
#define WHOLE(key, min, max, member, text)                                                                             \
	{                                                                                                              \
		.name = key, .type = OPTION_WHOLE, .offset = AT(member), .value = "N", .help = text, .low = min,       \
		.high = max                                                                                            \
	}
#define NUMBER(key, min, max, member, text)                                                                            \
	{                                                                                                              \
		.name = key, .type = OPTION_NUMBER, .offset = AT(member), .value = "N", .help = text, .low = min,      \
		.high = max                                                                                            \
	}
#define FLAG(key, member, text)                                                                                        \
	{                                                                                                              \
		.name = key, .type = OPTION_FLAG, .offset = AT(member), .help = text                                   \
	}

static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct plan_line),
	WHOLE("depth", 1, PLAN_SHOTS_MAX, depth, "shots ahead"),
	WHOLE("rails", 0, PLAN_RAILS_MAX, rails, "cushions in one leg at most"),
	WHOLE("balls", 1, PLAN_CHAIN_MAX - 1, balls, "object balls in a chain at most (1: direct)"),
	{.name = "target",
	 .type = OPTION_TEXT,
	 .offset = AT(target),
	 .value = "WHAT",
	 .names = target_names,
	 .help = "a colour (RED, YELLOW, ...), any, rules, or the ID of one ball; default any"},
	{.name = "on",
	 .type = OPTION_CHOICE,
	 .offset = AT(on),
	 .value = "WHAT",
	 .names = on_names,
	 .help = "what is on by the rules, instead of what the position says; --target rules"},
	FLAG("free-ball", free_ball, "after a foul, snookered: any ball counts as the ball on; --target rules"),
	WHOLE("speeds", 1, 32, speeds, "start speeds tried"),
	WHOLE("workers", 1, PLAN_WORKERS_MAX, workers, "threads"),
	NUMBER("budget-ms", 0, 600000, budget_ms, "time for the search (0: none)"),
	NUMBER("budget-nodes", 0, 1e12, budget_nodes, "nodes for the search (0: none), the same result every time"),
	WHOLE("plans", 1, PLAN_MAX, plans, "how many are wanted"),
	WHOLE("tolerances", 0, PLAN_MAX, tolerances, "of so many plans tolerance and success are found"),
	FLAG("in-hand", in_hand, "the cue ball may be placed in the D"),
	{.name = "model",
	 .type = OPTION_CHOICE,
	 .offset = AT(model),
	 .value = "NAME",
	 .names = model_names,
	 .help = "physics instead of the configuration's"},
	{.name = "profile",
	 .type = OPTION_TEXT,
	 .offset = AT(profile),
	 .value = "NAME",
	 .help = "a player of the configuration"},
	{.name = "ranking",
	 .type = OPTION_CHOICE,
	 .offset = AT(ranking),
	 .value = "NAME",
	 .names = ranking_names,
	 .help = "what comes first, instead of the profile's"},
	NUMBER("error-angle", 0, 20, error_angle, "degrees, 1 sigma of the player's direction, instead of the profile's"),
	NUMBER("error-speed", 0, 1, error_speed, "share, 1 sigma of the speed"),
	NUMBER("error-tip", 0, 1, error_tip, "share of the radius, 1 sigma of the tip's place"),
	NUMBER("error-elevation", 0, 20, error_elevation, "degrees, 1 sigma of the elevation"),
	FLAG("json", json, "one JSON object per plan, then one of figures"),
	{.name = "plot",
	 .type = OPTION_FILE,
	 .offset = AT(plot),
	 .value = "FILE",
	 .help = "draws each shot as .svg or .png: FILE-RANK-SHOT"},
	{.name = NULL},
};
/* clang-format on */

const struct options plan_options = {
	.name = "plan",
	.summary = "the best shots from a position",
	.operands = "POSITION.txt",
	.operand_min = 1,
	.operand_max = 1,
	.wants = "wants one position",
	.row = rows,
	.notes = "POSITION.txt holds \"ID, TYPE, x, y\" lines in mm, or what detect --json prints (- is standard "
		 "input).",
};

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

static double or_profile(double option, double unit, double profile)
{
	return option >= 0 ? option / unit : profile;
}

static void set_error(struct run *run, const struct plan_line *options)
{
	struct player_error *error = &run->request.error;
	*error = run->def.profile.error;
	error->angle = or_profile(options->error_angle, degree, error->angle);
	error->speed = or_profile(options->error_speed, 1, error->speed);
	error->tip = or_profile(options->error_tip, 1, error->tip);
	error->elevation = or_profile(options->error_elevation, degree, error->elevation);
	run->request.has_error = options->error_angle >= 0 || options->error_speed >= 0 || options->error_tip >= 0 ||
				 options->error_elevation >= 0;
}

static const char *const on_words[] = {
	[ON_ANY] = "any", [ON_RED] = "red", [ON_COLOUR] = "colour", [ON_CLEARANCE] = "clearance"};

/* What is on, where the position alone does not tell. */
static int set_on(struct run *run, const struct plan_line *options)
{
	struct rules_state *state = &run->request.state;
	if (!options->on && !options->free_ball)
		return CMD_OK;
	if (options->target && strcmp(options->target, "rules") != 0)
		return cmd_bad_input("billiard plan: --on and --free-ball are for --target rules");
	run->request.target = TARGET_RULES;
	state->free_ball = options->free_ball;
	for (int on = ON_ANY; options->on && on <= ON_CLEARANCE; on++)
		if (strcmp(options->on, on_words[on]) == 0)
			state->on = (enum rules_on)on;
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

static int set_request(struct run *run, const struct plan_line *options)
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
	set_error(run, options);
	int status = set_target(run, options->target);
	if (status == CMD_OK)
		status = set_on(run, options);
	if (status == CMD_OK && plan_request_check(&run->config.table, request, err, sizeof err) < 0)
		return cmd_bad_input("%s: %s", options->position, err);
	return status;
}

static int bad_profile(const struct config *config, const char *found)
{
	char names[CONFIG_PROFILE_MAX * 18] = "";
	for (int i = 0; i < config->profile_count; i++) {
		strcat(names, i ? ", " : "");
		strcat(names, config->profiles[i].name);
	}
	return cmd_bad_input("--profile: found \"%s\", allowed %s", found, names);
}

static int set_def(struct run *run, const struct plan_line *options)
{
	struct planner_def *def = &run->def;
	*def = planner_def_default();
	def->table = &run->config.table;
	def->model = run->config.model;
	def->profile = run->config.profile;
	def->workers = or_configured(options->workers, 1);
	def->memory = run->config.planner.memory;
	def->now = monotonic;
	if (options->model)
		model_from_name(options->model, &def->model); /* the table of options knows the names */
	if (options->profile) {
		const struct cost_profile *profile = config_profile(&run->config, options->profile);
		if (!profile)
			return bad_profile(&run->config, options->profile);
		def->profile = *profile;
	}
	if (options->ranking)
		plan_ranking_from_name(options->ranking, &def->profile.ranking);
	return CMD_OK;
}

static int prepare(struct run *run, const struct plan_line *options)
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

/* What rankings by value know of a shot; where the tip goes. */
static void add_value_json(const struct run *run, json_t *out, const struct plan_shot *shot)
{
	char why[PATH_SIZE];
	json_object_set_new(out, "side", json_real(shot->shot.side));
	json_object_set_new(out, "follow", json_real(shot->shot.follow));
	json_object_set_new(out, "elevation_deg", json_real(shot->shot.elevation * degree));
	if (isnan(shot->value))
		return;
	json_object_set_new(out, "value", json_real(shot->value));
	json_object_set_new(out, "why", json_string(plan_why_text(shot, why, sizeof why)));
	if (shot->why_ball >= 0)
		json_object_set_new(out, "next", json_string(ball_name(run, shot->why_ball)));
	if (!isnan(shot->leave_radius))
		json_object_set_new(out, "leave",
				    json_pack("{s:f,s:f,s:f}", "x", shot->leave.x * mm, "y", shot->leave.y * mm,
					      "radius", shot->leave_radius * mm));
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
	add_value_json(run, out, shot);
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
	if (shot->shot.side != 0 || shot->shot.follow != 0)
		printf("  tip %+.2f side %+.2f up", shot->shot.side, shot->shot.follow);
	if (!isnan(shot->value))
		printf("  %+.1f points: %s", shot->value, plan_why_text(shot, via, sizeof via));
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

static int search(struct run *run, const struct plan_line *options)
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
	struct plan_line options = {.depth = -1,
				    .rails = -1,
				    .balls = -1,
				    .speeds = -1,
				    .plans = -1,
				    .tolerances = -1,
				    .workers = -1,
				    .budget_ms = -1,
				    .error_angle = -1,
				    .error_speed = -1,
				    .error_tip = -1,
				    .error_elevation = -1};
	int first, status = cmd_options(&plan_options, argc, argv, &options, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	options.position = argv[first];
	if (options.plot && !plot_format_known(options.plot))
		return cmd_bad_input("--plot: \"%s\" ends neither in .svg nor in .png", options.plot);
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
