#include "app/control/game.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double SAME_PLACE = 0.005; /* m; nearer, and nobody moved the ball */
static const double TOUCHED = 0.03; /* m; a cue ball that goes no farther and meets nothing was touched, not played */

static int count_colour(const struct layout *layout, enum ball_colour colour)
{
	int n = 0;
	for (int i = 0; i < layout->count; i++)
		n += layout->ball[i].colour == colour;
	return n;
}

/* ---- frames ------------------------------------------------------------------------------------------------------------- */

void game_begin(struct game *game, const struct layout *rest)
{
	int frame = game->frame + 1;
	*game = (struct game){.begun = true,
			      .state = rules_state_from_position(rest->ball, rest->count),
			      .frame = frame,
			      .rest = *rest};
}

/* Somebody set the balls up: more reds than there were, and every colour. */
static bool is_new_frame(const struct game *game, const struct layout *rest)
{
	for (enum ball_colour colour = COLOUR_YELLOW; colour <= COLOUR_BLACK; colour++)
		if (count_colour(rest, colour) == 0)
			return false;
	int reds = count_colour(rest, COLOUR_RED), before = count_colour(&game->rest, COLOUR_RED);
	return (game->over && reds > 0) || (reds > before && (reds == 15 || reds > before + 1));
}

/* ---- one shot ----------------------------------------------------------------------------------------------------------- */

/* What became of the balls of the rest before: index into the rest after, -1: fell. */
struct fate {
	int after[BALL_MAX];
	bool fell[BALL_MAX]; /* also when it is back already */
};

/* Reds by identity first, then the nearest: those that nothing is left for fell. */
static void match_reds(const struct layout *before, const struct layout *after, struct fate *fate)
{
	bool used[BALL_MAX] = {false};
	for (int i = 0; i < before->count; i++) {
		if (before->ball[i].colour != COLOUR_RED)
			continue;
		int j = layout_find(after, &before->ball[i], before->track[i]);
		if (j < 0 || used[j] || after->ball[j].colour != COLOUR_RED)
			continue;
		used[j] = true;
		fate->after[i] = j;
	}
	for (int j = 0; j < after->count; j++) {
		int nearest = -1;
		for (int i = 0; i < before->count && after->ball[j].colour == COLOUR_RED && !used[j]; i++)
			if (before->ball[i].colour == COLOUR_RED && fate->after[i] < 0 &&
			    (nearest < 0 || vec2_dist(before->ball[i].pos, after->ball[j].pos) <
						    vec2_dist(before->ball[nearest].pos, after->ball[j].pos)))
				nearest = i;
		if (nearest < 0)
			continue;
		fate->after[nearest] = j;
		used[j] = true;
	}
}

static void find_fates(const struct layout *before, const struct layout *after, const struct game_watch *watch,
		       struct fate *fate)
{
	for (int i = 0; i < before->count; i++)
		fate->after[i] = -1;
	match_reds(before, after, fate);
	for (int i = 0; i < before->count; i++) {
		enum ball_colour colour = before->ball[i].colour;
		for (int j = 0; j < after->count && colour != COLOUR_RED; j++)
			if (after->ball[j].colour == colour)
				fate->after[i] = j;
		fate->fell[i] = fate->after[i] < 0 || (colour != COLOUR_RED && game_watch_fell_and_back(watch, colour));
	}
}

static struct ball end_of(const struct layout *before, const struct layout *after, const struct fate *fate, int i)
{
	struct ball ball = before->ball[i];
	if (!fate->fell[i])
		return ball_at(ball.colour, after->ball[fate->after[i]].pos);
	ball.phase = BALL_POTTED;
	return ball;
}

/* What the cue ball met first. Where that was not seen clearly, the player has the benefit of the doubt. */
static int first_contact(const struct game *game, const struct game_watch *watch, const struct fate *fate)
{
	const struct layout *rest = &game->rest;
	bool own = watch->first >= 0 && watch->first < rest->count;
	if (own && rules_ball_on(&game->state, rest->ball, rest->count, watch->first))
		return watch->first;
	for (int i = 0; i < rest->count; i++) {
		bool on = i != rest->cue && fate->fell[i] && rules_ball_on(&game->state, rest->ball, rest->count, i);
		if (on && (!own || !watch->first_sure || !watch->moved[i]))
			return i;
	}
	return own ? watch->first : -1;
}

/* What was seen, in the words of the simulation: that is what the rules judge. */
static void tell_rules(const struct game *game, const struct layout *after, const struct game_watch *watch,
		       struct trace *trace)
{
	const struct layout *before = &game->rest;
	struct fate fate;
	find_fates(before, after, watch, &fate);
	int first = first_contact(game, watch, &fate), cue = before->cue;
	memcpy(trace->start, before->ball, sizeof trace->start);
	trace->ball_count = before->count;
	if (first >= 0) {
		int low = first < cue ? first : cue, high = first < cue ? cue : first;
		trace->entry[trace->count++] = (struct trace_entry){
			.event = {0, EVENT_BALL_BALL, (int16_t)low, (int16_t)high},
			.after = {end_of(before, after, &fate, low), end_of(before, after, &fate, high)}};
	}
	for (int i = 0; i < before->count; i++) {
		struct trace_entry *entry = &trace->entry[trace->count++];
		*entry = (struct trace_entry){.event = {1, EVENT_ROLLING_REST, (int16_t)i, 0}};
		entry->event.kind = fate.fell[i] ? EVENT_POCKET : EVENT_ROLLING_REST;
		entry->after[0] = end_of(before, after, &fate, i);
	}
}

/* Balls that the rules put back and that do not lie there yet. */
static void find_wishes(struct game *game, const struct rules_outcome *out, const struct layout *after)
{
	game->wish_count = 0;
	for (int i = 0; i < game->rest.count; i++) {
		const struct ball *ball = &out->ball[i];
		bool back = ball->phase != BALL_POTTED && ball->colour >= COLOUR_YELLOW && ball->colour <= COLOUR_BLACK;
		if (back && count_colour(after, ball->colour) == 0 && game->wish_count < GAME_WISHES)
			game->wish[game->wish_count++] = (struct game_wish){ball->colour, ball->pos};
	}
}

static void score(struct game *game, const struct table *table, const struct rules_outcome *out, int count)
{
	game->points = out->points;
	game->foul = out->foul;
	if (out->foul == 0 && out->points > 0) {
		game->score[game->turn] += out->points;
		game->break_points += out->points;
		game->state = out->next;
		return;
	}
	game->turn = 1 - game->turn;
	game->score[game->turn] += out->foul;
	game->break_points = 0;
	game->state = rules_opponent(table, out, count);
}

/* Level at the end: the black comes back and decides. */
static void end_frame(struct game *game, const struct table *table)
{
	game->over = game->score[0] != game->score[1];
	if (game->over)
		return;
	game->state = (struct rules_state){.on = ON_CLEARANCE, .in_hand = true};
	game->wish_count = 1;
	game->wish[0] = (struct game_wish){COLOUR_BLACK, table->spot[COLOUR_BLACK]};
}

static void judge_shot(struct game *game, const struct table *table, const struct layout *after,
		       const struct game_watch *watch)
{
	struct trace_entry entry[BALL_MAX + 1];
	struct trace trace;
	struct rules_outcome out;
	trace_init(&trace, entry, BALL_MAX + 1);
	trace.table = table;
	tell_rules(game, after, watch, &trace);
	rules_judge(table, &game->state, &trace, -1, &out);
	score(game, table, &out, trace.ball_count);
	find_wishes(game, &out, after);
	if (out.ends)
		end_frame(game, table);
	game->shots++;
	game->rest = *after;
}

/* ---- rests -------------------------------------------------------------------------------------------------------------- */

/* An object ball lies elsewhere or is gone. */
static bool object_moved(const struct layout *before, const struct layout *after)
{
	for (int i = 0; i < before->count; i++) {
		int j = layout_find(after, &before->ball[i], 0);
		if (i != before->cue && (j < 0 || vec2_dist(after->ball[j].pos, before->ball[i].pos) > SAME_PLACE))
			return true;
	}
	return false;
}

static bool is_in_d(const struct table *table, vec2 pos)
{
	return pos.x < table->baulk_d_centre.x + TOUCHED &&
	       vec2_dist(pos, table->baulk_d_centre) < table->baulk_d_radius + TOUCHED;
}

/* The cue ball was played, not put somewhere by a hand: a ball in hand may be put anywhere in the D. */
static bool was_played(const struct game *game, const struct table *table, const struct layout *rest,
		       const struct game_watch *watch)
{
	if (!watch->played || game->wish_count > 0 || game->rest.cue < 0 || rest->cue < 0)
		return false;
	bool went = vec2_dist(game->rest.ball[game->rest.cue].pos, rest->ball[rest->cue].pos) > TOUCHED;
	bool placed = game->state.in_hand && is_in_d(table, rest->ball[rest->cue].pos) &&
		      watch->farthest < 2 * table->baulk_d_radius + TOUCHED;
	return object_moved(&game->rest, rest) || watch->first >= 0 || watch->single[COLOUR_WHITE].jumped ||
	       (went && !placed);
}

static void grant_wishes(struct game *game, const struct layout *rest)
{
	int left = 0;
	for (int i = 0; i < game->wish_count; i++)
		if (count_colour(rest, game->wish[i].colour) == 0)
			game->wish[left++] = game->wish[i];
	game->wish_count = left;
}

bool game_rest(struct game *game, const struct table *table, const struct layout *rest, const struct game_watch *watch)
{
	if (!game->begun || is_new_frame(game, rest)) {
		game_begin(game, rest);
		return true;
	}
	if (!game->over && was_played(game, table, rest, watch)) {
		judge_shot(game, table, rest, watch);
		return true;
	}
	/* Hands: what they put down or take away is how the balls lie. */
	grant_wishes(game, rest);
	game->rest = *rest;
	if (count_colour(rest, COLOUR_RED) == 0 && game->state.on == ON_RED)
		game->state.on = ON_CLEARANCE;
	return false;
}

/* ---- corrections --------------------------------------------------------------------------------------------------------- */

static bool correct_on(struct game *game, const char *what)
{
	static const struct {
		const char *name;
		enum rules_on on;
	} names[] = {{"red", ON_RED}, {"colour", ON_COLOUR}, {"clearance", ON_CLEARANCE}};
	for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
		if (strcmp(what, names[i].name) == 0) {
			game->state.on = names[i].on;
			return true;
		}
	return false;
}

static void penalise(struct game *game, int foul)
{
	game->turn = 1 - game->turn;
	game->score[game->turn] += foul;
	game->foul = foul;
	game->points = game->break_points = 0;
	game->state.on = rules_state_from_position(game->rest.ball, game->rest.count).on;
}

bool game_correct(struct game *game, const char *words, char *err, size_t err_size)
{
	char what[16];
	int a, b, end = 0;
	if (sscanf(words, "score %d %d%n", &a, &b, &end) == 2 && !words[end] && a >= 0 && b >= 0 && a < 1000 &&
	    b < 1000) {
		game->score[0] = a;
		game->score[1] = b;
	} else if (sscanf(words, "turn %d%n", &a, &end) == 1 && !words[end] && (a == 1 || a == 2)) {
		game->turn = a - 1;
	} else if (sscanf(words, "foul %d%n", &a, &end) == 1 && !words[end] && a >= 4 && a <= 7) {
		penalise(game, a);
	} else if (sscanf(words, "on %15s%n", what, &end) == 1 && !words[end] && correct_on(game, what)) {
		game->over = false;
	} else if (strcmp(words, "hand on") == 0 || strcmp(words, "hand off") == 0) {
		game->state.in_hand = words[6] == 'n';
	} else if (strcmp(words, "again") == 0) {
		game->turn = 1 - game->turn;
		game->state.free_ball = false;
	} else if (strcmp(words, "frame") == 0) {
		struct layout rest = game->rest;
		game_begin(game, &rest);
	} else {
		snprintf(err, err_size,
			 "game: found \"%.40s\", wanted score A B, turn 1|2, on red|colour|clearance, hand on|off, "
			 "foul 4..7, again, frame, undo",
			 words);
		return false;
	}
	game->wish_count = 0;
	return true;
}

/* ---- words --------------------------------------------------------------------------------------------------------------- */

void game_demand(const struct game *game, char out[GAME_TEXT_SIZE])
{
	out[0] = '\0';
	if (game->over)
		snprintf(out, GAME_TEXT_SIZE, "FRAME OVER  %d : %d", game->score[0], game->score[1]);
	else if (game->wish_count > 0)
		snprintf(out, GAME_TEXT_SIZE, "PUT %s HERE", ball_colour_name(game->wish[0].colour));
}

void game_words(const struct game *game, char out[GAME_TEXT_SIZE])
{
	static const char *const on[] = {"any ball", "a red", "a colour", "the lowest colour"};
	snprintf(out, GAME_TEXT_SIZE, "A %d : %d B, %c plays, %s is on%s%s, break %d", game->score[0], game->score[1],
		 game->turn ? 'B' : 'A', on[game->state.on], game->state.in_hand ? ", ball in hand" : "",
		 game->state.free_ball ? ", free ball" : "", game->break_points);
}

/* ---- as text ------------------------------------------------------------------------------------------------------------- */

bool game_write(const struct game *game, char *out, size_t size)
{
	int n = snprintf(out, size, "game 1 %d %d %d %d %d %d %d %d %d %d %d\n", game->frame, game->shots, game->turn,
			 game->score[0], game->score[1], game->break_points, (int)game->state.on, game->state.in_hand,
			 game->state.free_ball, game->over, game->rest.count);
	for (int i = 0; i < game->rest.count && n > 0 && (size_t)n < size; i++)
		n += snprintf(out + n, size - (size_t)n, "%d %.6f %.6f\n", (int)game->rest.ball[i].colour,
			      game->rest.ball[i].pos.x, game->rest.ball[i].pos.y);
	return n > 0 && (size_t)n < size;
}

static bool read_ball(const char **text, struct layout *rest, int i)
{
	int colour, used = 0;
	double x, y;
	if (sscanf(*text, "%d %lf %lf\n%n", &colour, &x, &y, &used) != 3 || used == 0 || colour < 0 ||
	    colour >= COLOUR_UNKNOWN || !(fabs(x) < 10) || !(fabs(y) < 10))
		return false;
	rest->ball[i] = ball_at((enum ball_colour)colour, (vec2){x, y});
	if (colour == COLOUR_WHITE)
		rest->cue = i;
	*text += used;
	return true;
}

static bool numbers_fit(const struct game *g, int on)
{
	return g->frame >= 0 && g->shots >= 0 && (g->turn == 0 || g->turn == 1) && g->score[0] >= 0 &&
	       g->score[1] >= 0 && g->break_points >= 0 && on >= ON_RED && on <= ON_CLEARANCE && g->rest.count >= 0 &&
	       g->rest.count <= BALL_MAX;
}

bool game_read(struct game *game, const char *text)
{
	struct game g = {.begun = true, .rest = {.cue = -1}};
	int on, hand, free_ball, over, used = 0;
	if (sscanf(text, "game 1 %d %d %d %d %d %d %d %d %d %d %d\n%n", &g.frame, &g.shots, &g.turn, &g.score[0],
		   &g.score[1], &g.break_points, &on, &hand, &free_ball, &over, &g.rest.count, &used) != 11 ||
	    used == 0 || !numbers_fit(&g, on))
		return false;
	g.state = (struct rules_state){.on = (enum rules_on)on, .in_hand = hand != 0, .free_ball = free_ball != 0};
	g.over = over != 0;
	text += used;
	for (int i = 0; i < g.rest.count; i++)
		if (!read_ball(&text, &g.rest, i))
			return false;
	*game = g;
	return true;
}
