#include "app/commands/match.h"

#include <math.h>
#include <string.h>

#include "search/respot.h"

enum { TRACE_MAX = 2048, EVENTS_MAX = 2000, VISIT_SHOTS = 80, FRAME_SHOTS = 250, ERROR_SIZE = 200 };

/* Mid-game positions: 3 to 10 reds, 60 % of them around the pink, colours on their spots in 85 %. */
static const double NEAR_PINK = 0.6, ON_SPOT = 0.85;
static const int REDS_MIN = 3, REDS_SPAN = 8;

/* ---- chance ---------------------------------------------------------------------------------------------------------
 */

struct dice {
	uint64_t state;
};

static double uniform(struct dice *dice)
{
	uint64_t z = (dice->state += 0x9e3779b97f4a7c15u);
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double normal(struct dice *dice)
{
	return normal_quantile(fmin(fmax(uniform(dice), 1e-12), 1 - 1e-12));
}

static struct dice dice_for(uint64_t seed, int index)
{
	struct dice dice = {seed * 0xd1342543de82ef95u + (uint64_t)index * 0x2545f4914f6cdd1du};
	uniform(&dice);
	return dice;
}

/* ---- positions ------------------------------------------------------------------------------------------------------
 */

static vec2 anywhere(const struct table *table, struct dice *dice)
{
	double room = 2.1 * table->ball_radius;
	return (vec2){(uniform(dice) - 0.5) * (table->length - room), (uniform(dice) - 0.5) * (table->width - room)};
}

static vec2 around_pink(const struct table *table, struct dice *dice)
{
	vec2 at = {table->spot[COLOUR_PINK].x + 0.08 * table->length * normal(dice),
		   0.15 * table->width * normal(dice)};
	double x = table->length / 2 - 1.05 * table->ball_radius, y = table->width / 2 - 1.05 * table->ball_radius;
	return (vec2){fmax(-x, fmin(x, at.x)), fmax(-y, fmin(y, at.y))};
}

static void put(const struct table *table, struct dice *dice, bool near_pink, enum ball_colour colour,
		struct ball *ball, int *count)
{
	vec2 at = {0, 0};
	for (int i = 0; i < 1000; i++) {
		at = near_pink && i < 500 ? around_pink(table, dice) : anywhere(table, dice);
		if (respot_is_free(table, ball, *count, at))
			break;
	}
	ball[(*count)++] = ball_at(colour, at);
}

static int mid_game(const struct table *table, struct dice *dice, struct ball ball[BALL_MAX])
{
	int count = 1;
	ball[0] = ball_at(COLOUR_WHITE, (vec2){0, 0});
	ball[0].phase = BALL_POTTED;
	for (int c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++) {
		vec2 spot = table->spot[c];
		if (uniform(dice) < ON_SPOT && respot_is_free(table, ball, count, spot))
			ball[count++] = ball_at((enum ball_colour)c, spot);
		else
			put(table, dice, false, (enum ball_colour)c, ball, &count);
	}
	int reds = REDS_MIN + (int)(REDS_SPAN * uniform(dice));
	for (int i = 0; i < reds; i++)
		put(table, dice, uniform(dice) < NEAR_PINK, COLOUR_RED, ball, &count);
	int cue = count;
	put(table, dice, false, COLOUR_WHITE, ball, &cue);
	ball[0] = ball[count];
	return count;
}

/* The opening position, the rack just clear of touching. */
static int opening(const struct table *table, struct ball ball[BALL_MAX])
{
	int count = 0;
	double d = 2 * table->ball_radius + 1e-5;
	vec2 d_place = vec2_madd(table->baulk_d_centre, 0.5 * table->baulk_d_radius, (vec2){0, 1});
	ball[count++] = ball_at(COLOUR_WHITE, d_place);
	for (int c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++)
		ball[count++] = ball_at((enum ball_colour)c, table->spot[c]);
	vec2 apex = vec2_add(table->spot[COLOUR_PINK], (vec2){d + 5e-4, 0});
	for (int row = 0; row < 5; row++)
		for (int k = 0; k <= row; k++) {
			vec2 at = {apex.x + row * d * sqrt(0.75), (k - row / 2.0) * d};
			ball[count++] = ball_at(COLOUR_RED, at);
		}
	return count;
}

int match_position(const struct match_setting *setting, int index, struct ball ball[BALL_MAX])
{
	struct dice dice = dice_for(setting->seed, index);
	return setting->from_break ? opening(setting->table, ball) : mid_game(setting->table, &dice, ball);
}

/* ---- one shot -------------------------------------------------------------------------------------------------------
 */

/* A game under way. */
struct game {
	const struct match_setting *setting;
	struct dice dice;
	struct ball ball[BALL_MAX];
	int count;
	struct rules_state rules;
	struct trace_entry entry[TRACE_MAX];
};

enum shot_result { SHOT_SCORED, SHOT_MISSED, SHOT_FOUL, SHOT_NONE };

static void note_pot(const struct plan_shot *shot, bool made, struct match_count *count)
{
	double chance = fmin(1, fmax(0, shot->success));
	if (isnan(shot->success))
		chance = 1;
	int decile = (int)fmin(MATCH_DECILES - 1, chance * MATCH_DECILES);
	count->pots_proposed++;
	count->pots_made += made;
	count->predicted += chance;
	count->brier += (chance - made) * (chance - made);
	count->decile_predicted[decile] += chance;
	count->decile_made[decile] += made;
	count->decile_count[decile]++;
}

static bool falls_as_meant(const struct trace *trace, const struct plan_shot *shot)
{
	for (int i = 0; i < trace->count; i++) {
		const struct event *event = &trace->entry[i].event;
		if (event->kind == EVENT_POCKET && event->ball == shot->target)
			return event->other == shot->pocket;
	}
	return false;
}

/* Plays the proposal with an error. False when the simulation finds no end: then nothing has happened. */
static bool play(struct game *game, const struct plan_shot *shot, struct rules_outcome *outcome, bool *made)
{
	const struct sim_limits limits = {.max_time = INFINITY, .max_events = EVENTS_MAX};
	struct deviate deviate;
	struct sim sim;
	struct trace trace;
	for (int i = 0; i < ERROR_DIMENSIONS; i++)
		deviate.z[i] = normal(&game->dice);
	struct shot played = player_error_apply(&game->setting->error, &shot->shot, &deviate);
	memcpy(game->ball, shot->start, sizeof game->ball); /* the cue ball may have been placed */
	sim_init(&sim, game->setting->table, &game->setting->model, game->ball, game->count);
	trace_init(&trace, game->entry, TRACE_MAX);
	sim_strike(&sim, 0, &played);
	if (sim_run(&sim, &limits, &trace) != SIM_AT_REST || trace.overflow)
		return false;
	rules_judge(game->setting->table, &game->rules, &trace, shot->target, outcome);
	*made = outcome->foul == 0 && falls_as_meant(&trace, shot);
	return true;
}

static enum shot_result turn(struct game *game, struct match_side *side, struct match_count *count,
			     struct rules_outcome *outcome, double *promised)
{
	const struct match_setting *setting = game->setting;
	struct plan_result result;
	char err[ERROR_SIZE];
	struct plan_request *request = &side->request;
	memcpy(request->ball, game->ball, sizeof request->ball);
	request->ball_count = game->count;
	request->state = game->rules;
	request->target = TARGET_RULES;
	double begin = setting->now ? setting->now(setting->now_context) : 0;
	int rc = planner_run(side->planner, request, NULL, NULL, &result, err, sizeof err);
	count->seconds += setting->now ? setting->now(setting->now_context) - begin : 0;
	if (rc != 0 || result.plan_count == 0) {
		count->no_answer++;
		return SHOT_NONE;
	}
	const struct plan_shot *shot = &result.plan[0].shot[0];
	bool made = false;
	*promised = shot->value;
	count->shots++;
	if (!play(game, shot, outcome, &made))
		return SHOT_NONE;
	if (shot->target >= 0)
		note_pot(shot, made, count);
	else
		count->safeties++;
	count->fouls += outcome->foul > 0;
	memcpy(game->ball, outcome->ball, sizeof game->ball);
	return outcome->foul > 0 ? SHOT_FOUL : outcome->points > 0 ? SHOT_SCORED : SHOT_MISSED;
}

static bool is_over(const struct game *game)
{
	for (int i = 0; i < game->count; i++)
		if (rules_ball_on(&game->rules, game->ball, game->count, i))
			return false;
	return true;
}

static void begin_game(struct game *game, const struct match_setting *setting, int index)
{
	game->setting = setting;
	game->dice = dice_for(setting->seed ^ 0x5bd1e995u, index);
	game->count = match_position(setting, index, game->ball);
	game->rules = rules_state_from_position(game->ball, game->count);
	game->rules.in_hand = setting->from_break;
}

/* ---- visits and frames ----------------------------------------------------------------------------------------------
 */

void match_visit(const struct match_setting *setting, struct match_side *side, int index, struct match_count *count)
{
	struct game game;
	struct rules_outcome outcome;
	double points = 0, promised;
	begin_game(&game, setting, index);
	for (int i = 0; i < VISIT_SHOTS && !is_over(&game); i++) {
		enum shot_result result = turn(&game, side, count, &outcome, &promised);
		if (i == 0 && result != SHOT_NONE)
			count->expected += promised;
		if (result != SHOT_SCORED)
			break;
		points += outcome.points;
		game.rules = outcome.next;
	}
	count->visits++;
	count->points += points;
	count->points2 += points * points;
}

/* The frame is over, or, with level scores, the black comes back and the lot says who plays it. True when it is over. */
static bool is_decided(struct game *game, const struct match_frame *frame, int *player)
{
	if (frame->points[0] != frame->points[1])
		return true;
	game->rules = rules_respot_black(game->setting->table, game->ball, game->count);
	*player = uniform(&game->dice) < 0.5;
	return false;
}

void match_frame_play(const struct match_setting *setting, struct match_side side[2], int index,
		      struct match_count count[2], struct match_frame *frame)
{
	struct game game;
	struct rules_outcome outcome;
	double promised;
	int player = index % 2;
	*frame = (struct match_frame){.winner = -1};
	begin_game(&game, setting, index);
	for (int i = 0; i < FRAME_SHOTS; i++, frame->shots++) {
		enum shot_result result = turn(&game, &side[player], &count[player], &outcome, &promised);
		if (result == SHOT_NONE)
			break;
		frame->points[player] += outcome.points;
		frame->points[!player] += outcome.foul;
		game.rules = outcome.next;
		if (result != SHOT_SCORED) {
			game.rules = rules_opponent(setting->table, &outcome, game.count);
			count[player].visits++;
			player = !player;
		}
		if ((outcome.ends || is_over(&game)) && is_decided(&game, frame, &player))
			break;
	}
	if (frame->points[0] != frame->points[1])
		frame->winner = frame->points[1] > frame->points[0];
}

void match_add(struct match_count *sum, const struct match_count *part)
{
	sum->visits += part->visits;
	sum->shots += part->shots;
	sum->pots_proposed += part->pots_proposed;
	sum->pots_made += part->pots_made;
	sum->fouls += part->fouls;
	sum->safeties += part->safeties;
	sum->no_answer += part->no_answer;
	sum->points += part->points;
	sum->points2 += part->points2;
	sum->predicted += part->predicted;
	sum->seconds += part->seconds;
	sum->brier += part->brier;
	sum->expected += part->expected;
	for (int i = 0; i < MATCH_DECILES; i++) {
		sum->decile_predicted[i] += part->decile_predicted[i];
		sum->decile_made[i] += part->decile_made[i];
		sum->decile_count[i] += part->decile_count[i];
	}
}
