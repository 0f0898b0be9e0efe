/* billiard match: how much a setting of the planner is worth: visits and frames by the rules, with a player's errors. */
#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/commands/cmd.h"
#include "app/commands/match.h"
#include "app/process/clock.h"

enum { SIDES = 2, THREADS_MAX = 16, GAMES_MAX = 100000, WORD_SIZE = 32 };
static const double degree = M_PI / 180;

struct match_line {
	const char *config, *start, *side[SIDES];
	int visits, frames, workers;
	double error_angle, error_speed, error_tip, budget_ms, budget_nodes, seed;
	bool json;
};

/* What one side is made of, from "KEY=VALUE,...". */
struct side_def {
	struct planner_def def;
	struct plan_request request;
};

struct tournament {
	const struct match_line *line;
	struct config config;
	struct side_def side[SIDES];
	int sides, games;
	struct match_setting setting;
	struct match_count (*count)[SIDES]; /* one of each game */
	struct match_frame *frame;
	atomic_int next, done;
	atomic_bool failed;
};

static const char *start_names(void)
{
	return "mid, break";
}

/* A table is read by its columns. */
/* clang-format off */
#define ROW(member_) .offset = offsetof(struct match_line, member_)
static const struct option_row rows[] = {
	CMD_CONFIG_ROW(struct match_line),
	{.name = "visits",
	 .type = OPTION_WHOLE,
	 ROW(visits),
	 .value = "N",
	 .low = 1,
	 .high = GAMES_MAX,
	 .help = "visits of side a, each from a position of its own"},
	{.name = "frames",
	 .type = OPTION_WHOLE,
	 ROW(frames),
	 .value = "N",
	 .low = 1,
	 .high = GAMES_MAX,
	 .help = "frames of side a against side b, breaks in turn"},
	{.name = "error-angle",
	 .type = OPTION_NUMBER,
	 ROW(error_angle),
	 .value = "DEG",
	 .low = 0,
	 .high = 10,
	 .help = "1 sigma of the player's direction"},
	{.name = "error-speed",
	 .type = OPTION_NUMBER,
	 ROW(error_speed),
	 .value = "SHARE",
	 .low = 0,
	 .high = 1,
	 .help = "1 sigma of his speed"},
	{.name = "error-tip",
	 .type = OPTION_NUMBER,
	 ROW(error_tip),
	 .value = "SHARE",
	 .low = 0,
	 .high = 0.5,
	 .help = "1 sigma of his tip's place, of the radius"},
	{.name = "seed",
	 .type = OPTION_NUMBER,
	 ROW(seed),
	 .value = "N",
	 .low = 0,
	 .high = 1e15,
	 .help = "of positions and errors"},
	{.name = "start",
	 .type = OPTION_CHOICE,
	 ROW(start),
	 .value = "WHERE",
	 .names = start_names,
	 .help = "positions in the middle of a frame, or the opening"},
	{.name = "budget-ms",
	 .type = OPTION_NUMBER,
	 ROW(budget_ms),
	 .value = "N",
	 .low = 0,
	 .high = 600000,
	 .help = "time for a proposal"},
	{.name = "budget-nodes",
	 .type = OPTION_NUMBER,
	 ROW(budget_nodes),
	 .value = "N",
	 .low = 0,
	 .high = 1e12,
	 .help = "work for a proposal; the same result every time"},
	{.name = "a", .type = OPTION_TEXT, ROW(side[0]), .value = "KEY=VALUE,...", .help = "side a"},
	{.name = "b", .type = OPTION_TEXT, ROW(side[1]), .value = "KEY=VALUE,...", .help = "side b"},
	{.name = "workers",
	 .type = OPTION_WHOLE,
	 ROW(workers),
	 .value = "N",
	 .low = 1,
	 .high = THREADS_MAX,
	 .help = "games at a time"},
	{.name = "json", .type = OPTION_FLAG, ROW(json), .help = "one JSON object"},
	{.name = NULL},
};
/* clang-format on */

const struct options match_options = {
	.name = "match",
	.summary = "plays visits or frames with a player's errors: what a setting is worth",
	.operands = "",
	.wants = "takes no file",
	.row = rows,
	.notes = "KEY of a side: profile, ranking (thesis, success, value), model, depth, rails, balls, speeds, "
		 "budget-ms,\n"
		 "budget-nodes. A side without profile believes in the error that is played with.",
};

static double monotonic(void *context)
{
	(void)context;
	return clock_seconds();
}

/* ---- sides ----------------------------------------------------------------------------------------------------------- */

static int bad_value(const char *key, const char *value, const char *allowed)
{
	return cmd_bad_input("billiard match: %s: found \"%s\", allowed %s", key, value, allowed);
}

static int set_whole(const char *key, const char *value, int low, int high, int *out)
{
	char allowed[WORD_SIZE];
	snprintf(allowed, sizeof allowed, "%d to %d", low, high);
	return option_whole(value, low, high, out) ? CMD_OK : bad_value(key, value, allowed);
}

static int set_key(struct side_def *side, const struct config *config, const char *key, const char *value)
{
	struct plan_request *request = &side->request;
	double number;
	if (strcmp(key, "profile") == 0) {
		const struct cost_profile *profile = config_profile(config, value);
		if (!profile)
			return bad_value(key, value, "a name from profiles");
		enum plan_ranking ranking = side->def.profile.ranking;
		side->def.profile = *profile;
		side->def.profile.ranking = ranking;
		request->has_error = false;
		return CMD_OK;
	}
	if (strcmp(key, "ranking") == 0)
		return plan_ranking_from_name(value, &side->def.profile.ranking)
			       ? CMD_OK
			       : bad_value(key, value, "thesis, success or value");
	if (strcmp(key, "model") == 0)
		return model_from_name(value, &side->def.model) ? CMD_OK : bad_value(key, value, "the name of a model");
	if (strcmp(key, "depth") == 0)
		return set_whole(key, value, 1, PLAN_SHOTS_MAX, &request->depth);
	if (strcmp(key, "rails") == 0)
		return set_whole(key, value, 0, PLAN_RAILS_MAX, &request->rails);
	if (strcmp(key, "balls") == 0)
		return set_whole(key, value, 1, PLAN_CHAIN_MAX - 1, &request->balls);
	if (strcmp(key, "speeds") == 0)
		return set_whole(key, value, 1, 32, &request->speeds);
	if (strcmp(key, "budget-ms") == 0 && option_number(value, 0, 600000, &number)) {
		request->budget.seconds = number / 1000;
		return CMD_OK;
	}
	if (strcmp(key, "budget-nodes") == 0 && option_number(value, 0, 1e12, &number)) {
		request->budget.nodes = (uint64_t)number;
		return CMD_OK;
	}
	return cmd_bad_input("billiard match: no side has \"%s=%s\" (see billiard match --help)", key, value);
}

/* text: "KEY=VALUE,...", read from a copy. */
static int set_keys(struct side_def *side, const struct config *config, const char *text)
{
	char copy[CMD_ERROR_SIZE];
	char *rest = copy, *pair;
	if (strlen(text) >= sizeof copy)
		return cmd_bad_input("billiard match: a side of %zu characters, allowed up to %zu", strlen(text),
				     sizeof copy - 1);
	snprintf(copy, sizeof copy, "%s", text);
	while ((pair = strsep(&rest, ","))) {
		char *value = strchr(pair, '=');
		if (!value)
			return bad_value("side", pair, "KEY=VALUE");
		*value++ = 0;
		int status = set_key(side, config, pair, value);
		if (status != CMD_OK)
			return status;
	}
	return CMD_OK;
}

static int set_side(struct tournament *t, int index)
{
	const struct match_line *line = t->line;
	struct side_def *side = &t->side[index];
	side->def = planner_def_default();
	side->def.table = &t->config.table;
	side->def.model = t->setting.model;
	side->def.profile = t->config.profile;
	side->def.now = monotonic;
	side->request = plan_request_default();
	side->request.depth = t->config.planner.depth;
	side->request.rails = t->config.planner.rails;
	side->request.balls = t->config.planner.balls;
	side->request.speeds = t->config.planner.speeds;
	side->request.plans = 64;
	side->request.tolerances = 1;
	side->request.budget.seconds = line->budget_ms / 1000;
	side->request.budget.nodes = (uint64_t)line->budget_nodes;
	side->request.has_error = true;
	side->request.error = t->setting.error;
	return line->side[index] ? set_keys(side, &t->config, line->side[index]) : CMD_OK;
}

/* ---- games ----------------------------------------------------------------------------------------------------------- */

static bool create_sides(const struct tournament *t, struct match_side side[SIDES])
{
	bool done = true;
	for (int i = 0; i < t->sides; i++) {
		side[i] = (struct match_side){.request = t->side[i].request};
		done &= planner_create(&side[i].planner, &t->side[i].def) == 0;
	}
	return done;
}

static void *play_games(void *context)
{
	struct tournament *t = context;
	struct match_side side[SIDES] = {{.planner = NULL}, {.planner = NULL}};
	if (!create_sides(t, side))
		atomic_store(&t->failed, true);
	int game;
	while (!atomic_load(&t->failed) && (game = atomic_fetch_add(&t->next, 1)) < t->games) {
		if (t->sides == 1)
			match_visit(&t->setting, &side[0], game, &t->count[game][0]);
		else
			match_frame_play(&t->setting, side, game, t->count[game], &t->frame[game]);
		int done = atomic_fetch_add(&t->done, 1) + 1;
		if (isatty(STDERR_FILENO))
			fprintf(stderr, "\r%d of %d", done, t->games);
	}
	for (int i = 0; i < t->sides; i++)
		planner_destroy(side[i].planner);
	return NULL;
}

static int play_all(struct tournament *t)
{
	pthread_t thread[THREADS_MAX];
	int started = 0;
	while (started < t->line->workers && pthread_create(&thread[started], NULL, play_games, t) == 0)
		started++;
	for (int i = 0; i < started; i++)
		pthread_join(thread[i], NULL);
	if (isatty(STDERR_FILENO))
		fprintf(stderr, "\n");
	if (started > 0 && !atomic_load(&t->failed))
		return CMD_OK;
	fprintf(stderr, "billiard match: no planner: %s\n", strerror(ENOMEM));
	return CMD_FAILED;
}

/* ---- what came of it ------------------------------------------------------------------------------------------------- */

static double share(double part, double whole)
{
	return whole > 0 ? part / whole : 0;
}

static json_t *deciles_json(const struct match_count *c)
{
	json_t *list = json_array();
	for (int i = 0; i < MATCH_DECILES; i++)
		if (c->decile_count[i] > 0)
			json_array_append_new(list, json_pack("[f,f,i]", c->decile_predicted[i] / c->decile_count[i],
							      (double)c->decile_made[i] / c->decile_count[i],
							      c->decile_count[i]));
	return list;
}

/* Only rankings by value promise points. */
static json_t *number_or_null(double x)
{
	return isfinite(x) ? json_real(x) : json_null();
}

static int tell_visits(const struct tournament *t)
{
	struct match_count sum = {.visits = 0};
	for (int i = 0; i < t->games; i++)
		match_add(&sum, &t->count[i][0]);
	double mean = share(sum.points, sum.visits);
	double se = sqrt(fmax(0, share(sum.points2, sum.visits) - mean * mean) / sum.visits);
	if (!t->line->json) {
		printf("%d visits: %.1f +- %.1f points a visit", sum.visits, mean, se);
		if (isfinite(sum.expected))
			printf(" (%.1f promised)", share(sum.expected, sum.visits));
		putchar('\n');
		printf("%d shots, %d pots proposed, %d made (%.3f; %.3f predicted; Brier score %.4f), %d fouls, %d "
		       "safeties, %.1f ms a proposal\n",
		       sum.shots, sum.pots_proposed, sum.pots_made, share(sum.pots_made, sum.pots_proposed),
		       share(sum.predicted, sum.pots_proposed), share(sum.brier, sum.pots_proposed), sum.fouls,
		       sum.safeties, 1000 * share(sum.seconds, sum.shots));
		return CMD_OK;
	}
	return cmd_json_line(json_pack(
		"{s:i,s:f,s:f,s:o,s:i,s:i,s:f,s:f,s:f,s:i,s:i,s:f,s:o}", "visits", sum.visits, "points_per_visit", mean,
		"se", se, "expected", number_or_null(share(sum.expected, sum.visits)), "pots_proposed",
		sum.pots_proposed, "pots_made", sum.pots_made, "predicted", share(sum.predicted, sum.pots_proposed),
		"brier", share(sum.brier, sum.pots_proposed), "fouls_per_shot", share(sum.fouls, sum.shots), "safeties",
		sum.safeties, "no_answer", sum.no_answer, "ms_per_proposal", 1000 * share(sum.seconds, sum.shots),
		"deciles", deciles_json(&sum)));
}

static int tell_frames(const struct tournament *t)
{
	struct match_count sum[SIDES] = {{.visits = 0}, {.visits = 0}};
	int won[SIDES] = {0, 0}, drawn = 0;
	double points[SIDES] = {0, 0};
	for (int i = 0; i < t->games; i++) {
		const struct match_frame *frame = &t->frame[i];
		for (int s = 0; s < SIDES; s++) {
			match_add(&sum[s], &t->count[i][s]);
			points[s] += frame->points[s];
		}
		if (frame->winner >= 0)
			won[frame->winner]++;
		else
			drawn++;
	}
	if (!t->line->json) {
		printf("%d frames: a %d, b %d, drawn %d; points a frame: a %.1f, b %.1f\n", t->games, won[0], won[1],
		       drawn, points[0] / t->games, points[1] / t->games);
		return CMD_OK;
	}
	return cmd_json_line(json_pack("{s:i,s:i,s:i,s:i,s:f,s:f,s:f,s:f}", "frames", t->games, "won_a", won[0],
				       "won_b", won[1], "drawn", drawn, "points_a", points[0] / t->games, "points_b",
				       points[1] / t->games, "ms_per_proposal_a",
				       1000 * share(sum[0].seconds, sum[0].shots), "ms_per_proposal_b",
				       1000 * share(sum[1].seconds, sum[1].shots)));
}

/* ---- the whole ------------------------------------------------------------------------------------------------------- */

static int prepare(struct tournament *t)
{
	const struct match_line *line = t->line;
	if ((line->visits > 0) == (line->frames > 0))
		return cmd_usage("billiard match", "wants either --visits or --frames");
	if (line->frames > 0 && !line->side[1])
		return cmd_usage("billiard match", "frames want a side --b");
	int status = cmd_config(&t->config, line->config);
	if (status != CMD_OK)
		return status;
	t->sides = line->frames > 0 ? 2 : 1;
	t->games = line->frames > 0 ? line->frames : line->visits;
	t->setting = (struct match_setting){
		.table = &t->config.table,
		.error = {.angle = line->error_angle * degree, .speed = line->error_speed, .tip = line->error_tip},
		.seed = (uint64_t)line->seed,
		.from_break = strcmp(line->start, "break") == 0,
		.now = monotonic,
	};
	if (!model_from_name("real", &t->setting.model))
		return CMD_FAILED;
	for (int i = 0; i < t->sides && status == CMD_OK; i++)
		status = set_side(t, i);
	return status;
}

int cmd_match(int argc, char **argv)
{
	struct match_line line = {
		.config = config_default_path(),
		.start = NULL,
		.workers = 1,
		.error_angle = 0.1,
		.error_speed = 0.03,
		.seed = 1,
	};
	int first, status = cmd_options(&match_options, argc, argv, &line, &first);
	if (status != CMD_OK)
		return status < 0 ? CMD_OK : status;
	if (!line.start)
		line.start = line.frames > 0 ? "break" : "mid";
	struct tournament *t = calloc(1, sizeof *t);
	if (!t)
		return CMD_FAILED;
	t->line = &line;
	status = prepare(t);
	if (status == CMD_OK) {
		t->count = calloc((size_t)t->games, sizeof *t->count);
		t->frame = calloc((size_t)t->games, sizeof *t->frame);
		status = t->count && t->frame ? play_all(t) : CMD_FAILED;
	}
	if (status == CMD_OK)
		status = t->sides == 1 ? tell_visits(t) : tell_frames(t);
	free(t->count);
	free(t->frame);
	free(t);
	return status;
}
