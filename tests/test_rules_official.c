/* The official rules of snooker (WPBSA), case by case. Each names the section of the rules that it is about: of Section 3,
 * The Game, by its title. */
#include "harness.h"
#include "scenes.h"

#include <string.h>

#include "search/respot.h"
#include "search/rules.h"

enum { ENTRY_MAX = 24 };

struct game {
	struct table table;
	struct ball ball[BALL_MAX];
	int count;
	struct trace trace;
	struct trace_entry entry[ENTRY_MAX];
};

static void begin(struct game *game)
{
	game->table = scene_snooker_table();
	game->count = 0;
	trace_init(&game->trace, game->entry, ENTRY_MAX);
	game->trace.table = &game->table;
}

static int add(struct game *game, enum ball_colour colour, vec2 pos)
{
	game->ball[game->count] = ball_at(colour, pos);
	return game->count++;
}

static void event(struct game *game, enum event_kind kind, int ball, int other, double time)
{
	struct trace_entry *entry = &game->entry[game->trace.count++];
	*entry = (struct trace_entry){.event = {time, kind, (int16_t)ball, (int16_t)other}};
	entry->after[0] = game->ball[ball];
	if (kind == EVENT_POCKET)
		entry->after[0].phase = BALL_POTTED;
	if (kind == EVENT_BALL_BALL)
		entry->after[1] = game->ball[other];
}

/* ---- one shot each ---- */

enum { W, R, S, YE, GR, BN, BU, PI, BK, NONE = -1 }; /* the white, two reds, the colours */
enum { USUAL, LAST_RED, NO_RED, FROM_BLUE, PINK_BLACK, ONLY_BLACK };
enum { MANY = 3 };

/* Written as a table: what lay there, what was on, what the cue ball met and what fell, and what the rules make of it. */
struct shot_case {
	const char *section, *name;
	int layout;
	enum rules_on on;
	int named;	   /* NONE: nothing was named */
	int first, second; /* met; second at the same instant as first */
	int potted[MANY];
	int points, foul;
	enum rules_on next;
	bool free_ball;
	int touching; /* ball that the cue ball lies at */
	bool into_it; /* and is played into */
};

#define NOTHING                                                                                                        \
	{                                                                                                              \
		NONE, NONE, NONE                                                                                       \
	}
#define ONE(a)                                                                                                         \
	{                                                                                                              \
		a, NONE, NONE                                                                                          \
	}
#define TWO(a, b)                                                                                                      \
	{                                                                                                              \
		a, b, NONE                                                                                             \
	}
#define PLAIN .touching = NONE
/* A table is read by its columns. */
/* clang-format off */
static const struct shot_case shot_case[] = {
	/* Mode of Play: reds */
	{"Mode of Play", "a red", USUAL, ON_RED, NONE, R, NONE, ONE(R), 1, 0, ON_COLOUR, PLAIN},
	{"Mode of Play", "two reds in one stroke", USUAL, ON_RED, NONE, R, NONE, TWO(R, S), 2, 0, ON_COLOUR, PLAIN},
	{"Mode of Play", "another red than the one struck", USUAL, ON_RED, NONE, R, NONE, ONE(S), 1, 0, ON_COLOUR, PLAIN},
	{"Mode of Play", "a red struck, nothing falls", USUAL, ON_RED, NONE, R, NONE, NOTHING, 0, 0, ON_RED, PLAIN},
	{"Mode of Play", "red after a colour", USUAL, ON_COLOUR, BK, BK, NONE, ONE(BK), 7, 0, ON_RED, PLAIN},
	{"Mode of Play", "the last red, then a colour", LAST_RED, ON_RED, NONE, R, NONE, ONE(R), 1, 0, ON_COLOUR, PLAIN},
	/* Mode of Play: colours after a red */
	{"Mode of Play", "yellow named", USUAL, ON_COLOUR, YE, YE, NONE, ONE(YE), 2, 0, ON_RED, PLAIN},
	{"Mode of Play", "green named", USUAL, ON_COLOUR, GR, GR, NONE, ONE(GR), 3, 0, ON_RED, PLAIN},
	{"Mode of Play", "brown named", USUAL, ON_COLOUR, BN, BN, NONE, ONE(BN), 4, 0, ON_RED, PLAIN},
	{"Mode of Play", "blue named", USUAL, ON_COLOUR, BU, BU, NONE, ONE(BU), 5, 0, ON_RED, PLAIN},
	{"Mode of Play", "pink named", USUAL, ON_COLOUR, PI, PI, NONE, ONE(PI), 6, 0, ON_RED, PLAIN},
	{"Mode of Play", "a colour struck, nothing falls", USUAL, ON_COLOUR, BU, BU, NONE, NOTHING, 0, 0, ON_RED, PLAIN},
	{"Mode of Play", "the colour after the last red", NO_RED, ON_COLOUR, BK, BK, NONE, ONE(BK), 7, 0, ON_CLEARANCE, PLAIN},
	{"Mode of Play", "no colour after the last red", NO_RED, ON_COLOUR, BK, BK, NONE, NOTHING, 0, 0, ON_CLEARANCE, PLAIN},
	/* Mode of Play: the colours in ascending order */
	{"Mode of Play", "yellow in its turn", NO_RED, ON_CLEARANCE, NONE, YE, NONE, ONE(YE), 2, 0, ON_CLEARANCE, PLAIN},
	{"Mode of Play", "blue in its turn", FROM_BLUE, ON_CLEARANCE, NONE, BU, NONE, ONE(BU), 5, 0, ON_CLEARANCE, PLAIN},
	{"Mode of Play", "pink in its turn", PINK_BLACK, ON_CLEARANCE, NONE, PI, NONE, ONE(PI), 6, 0, ON_CLEARANCE, PLAIN},
	/* Penalties: the first ball struck */
	{"Penalties", "nothing struck, red on", USUAL, ON_RED, NONE, NONE, NONE, NOTHING, 0, 4, ON_RED, PLAIN},
	{"Penalties", "yellow first, red on", USUAL, ON_RED, NONE, YE, NONE, NOTHING, 0, 4, ON_RED, PLAIN},
	{"Penalties", "brown first, red on", USUAL, ON_RED, NONE, BN, NONE, NOTHING, 0, 4, ON_RED, PLAIN},
	{"Penalties", "blue first, red on", USUAL, ON_RED, NONE, BU, NONE, NOTHING, 0, 5, ON_RED, PLAIN},
	{"Penalties", "black first, red on", USUAL, ON_RED, NONE, BK, NONE, NOTHING, 0, 7, ON_RED, PLAIN},
	{"Penalties", "nothing struck, yellow named", USUAL, ON_COLOUR, YE, NONE, NONE, NOTHING, 0, 4, ON_RED, PLAIN},
	{"Penalties", "nothing struck, pink named", USUAL, ON_COLOUR, PI, NONE, NONE, NOTHING, 0, 6, ON_RED, PLAIN},
	{"Penalties", "a red first, blue named", USUAL, ON_COLOUR, BU, R, NONE, NOTHING, 0, 5, ON_RED, PLAIN},
	{"Penalties", "black first, blue named", USUAL, ON_COLOUR, BU, BK, NONE, NOTHING, 0, 7, ON_RED, PLAIN},
	{"Penalties", "yellow first, black named", USUAL, ON_COLOUR, BK, YE, NONE, NOTHING, 0, 7, ON_RED, PLAIN},
	{"Penalties", "blue first, yellow on", NO_RED, ON_CLEARANCE, NONE, BU, NONE, NOTHING, 0, 5, ON_CLEARANCE, PLAIN},
	{"Penalties", "nothing struck, pink on", PINK_BLACK, ON_CLEARANCE, NONE, NONE, NONE, NOTHING, 0, 6, ON_CLEARANCE, PLAIN},
	{"Penalties", "black first, pink on", PINK_BLACK, ON_CLEARANCE, NONE, BK, NONE, NOTHING, 0, 7, ON_CLEARANCE, PLAIN},
	/* Penalties: what falls */
	{"Penalties", "red and blue fall", USUAL, ON_RED, NONE, R, NONE, TWO(R, BU), 0, 5, ON_RED, PLAIN},
	{"Penalties", "yellow falls from a red", USUAL, ON_RED, NONE, R, NONE, ONE(YE), 0, 4, ON_RED, PLAIN},
	{"Penalties", "blue first, black falls", USUAL, ON_RED, NONE, BU, NONE, ONE(BK), 0, 7, ON_RED, PLAIN},
	{"Penalties", "named colour and a red", USUAL, ON_COLOUR, PI, PI, NONE, TWO(PI, R), 0, 6, ON_RED, PLAIN},
	{"Penalties", "another colour falls", USUAL, ON_COLOUR, BK, BK, NONE, ONE(BU), 0, 7, ON_RED, PLAIN},
	{"Penalties", "yellow and green in the clearance", NO_RED, ON_CLEARANCE, NONE, YE, NONE, TWO(YE, GR), 0, 4, ON_CLEARANCE, PLAIN},
	{"Penalties", "in-off, red on", USUAL, ON_RED, NONE, R, NONE, ONE(W), 0, 4, ON_RED, PLAIN},
	{"Penalties", "red and in-off", USUAL, ON_RED, NONE, R, NONE, TWO(R, W), 0, 4, ON_RED, PLAIN},
	{"Penalties", "black named and in-off", USUAL, ON_COLOUR, BK, BK, NONE, TWO(BK, W), 0, 7, ON_RED, PLAIN},
	{"Penalties", "in-off from yellow first, red on", USUAL, ON_RED, NONE, YE, NONE, ONE(W), 0, 4, ON_RED, PLAIN},
	/* Penalties: seven */
	{"Penalties", "none named, red first", USUAL, ON_COLOUR, NONE, R, NONE, NOTHING, 0, 7, ON_RED, PLAIN},
	{"Penalties", "none named, nothing struck", USUAL, ON_COLOUR, NONE, NONE, NONE, NOTHING, 0, 7, ON_RED, PLAIN},
	{"Penalties", "none named, green and in-off", USUAL, ON_COLOUR, NONE, GR, NONE, TWO(GR, W), 0, 7, ON_RED, PLAIN},
	{"Penalties", "none named, but plain which", USUAL, ON_COLOUR, NONE, GR, NONE, ONE(GR), 3, 0, ON_RED, PLAIN},
	/* Hitting Two Balls Simultaneously */
	{"Hitting Two Balls", "two reds at once", USUAL, ON_RED, NONE, R, S, NOTHING, 0, 0, ON_RED, PLAIN},
	{"Hitting Two Balls", "red and black at once", USUAL, ON_RED, NONE, R, BK, NOTHING, 0, 7, ON_RED, PLAIN},
	{"Hitting Two Balls", "black and red at once", USUAL, ON_RED, NONE, BK, R, NOTHING, 0, 7, ON_RED, PLAIN},
	{"Hitting Two Balls", "red and green at once, red falls", USUAL, ON_RED, NONE, R, GR, ONE(R), 0, 4, ON_RED, PLAIN},
	{"Hitting Two Balls", "named blue and a red at once", USUAL, ON_COLOUR, BU, BU, R, ONE(BU), 0, 5, ON_RED, PLAIN},
	{"Hitting Two Balls", "yellow and pink in the clearance", NO_RED, ON_CLEARANCE, NONE, YE, PI, NOTHING, 0, 6, ON_CLEARANCE, PLAIN},
	/* Touching Ball */
	{"Touching Ball", "away from a red, nothing struck", USUAL, ON_RED, NONE, NONE, NONE, NOTHING, 0, 0, ON_RED, .touching = R},
	{"Touching Ball", "away from a red into the black", USUAL, ON_RED, NONE, BK, NONE, NOTHING, 0, 0, ON_RED, .touching = R},
	{"Touching Ball", "away from a red, another falls", USUAL, ON_RED, NONE, S, NONE, ONE(S), 1, 0, ON_COLOUR, .touching = R},
	{"Touching Ball", "away from a red, black falls", USUAL, ON_RED, NONE, BK, NONE, ONE(BK), 0, 7, ON_RED, .touching = R},
	{"Touching Ball", "away from a red, in-off", USUAL, ON_RED, NONE, NONE, NONE, ONE(W), 0, 4, ON_RED, .touching = R},
	{"Touching Ball", "into the red: a push", USUAL, ON_RED, NONE, R, NONE, NOTHING, 0, 4, ON_RED, .touching = R, .into_it = true},
	{"Touching Ball", "into the red, which falls: a push", USUAL, ON_RED, NONE, R, NONE, ONE(R), 0, 4, ON_RED, .touching = R, .into_it = true},
	{"Touching Ball", "away from the black, red on, nothing struck", USUAL, ON_RED, NONE, NONE, NONE, NOTHING, 0, 4, ON_RED, .touching = BK},
	{"Touching Ball", "away from the black to a red", USUAL, ON_RED, NONE, R, NONE, ONE(R), 1, 0, ON_COLOUR, .touching = BK},
	{"Touching Ball", "into the black, red on", USUAL, ON_RED, NONE, BK, NONE, NOTHING, 0, 7, ON_RED, .touching = BK, .into_it = true},
	{"Touching Ball", "away from the named blue", USUAL, ON_COLOUR, BU, NONE, NONE, NOTHING, 0, 0, ON_RED, .touching = BU},
	{"Touching Ball", "at the blue, black named, nothing struck", USUAL, ON_COLOUR, BK, NONE, NONE, NOTHING, 0, 7, ON_RED, .touching = BU},
	{"Touching Ball", "away from yellow in its turn", NO_RED, ON_CLEARANCE, NONE, BK, NONE, NOTHING, 0, 0, ON_CLEARANCE, .touching = YE},
	/* Free Ball (Snookered After a Foul) */
	{"Free Ball", "green for a red", USUAL, ON_RED, GR, GR, NONE, ONE(GR), 1, 0, ON_COLOUR, true, PLAIN},
	{"Free Ball", "green for a red, struck only", USUAL, ON_RED, GR, GR, NONE, NOTHING, 0, 0, ON_RED, true, PLAIN},
	{"Free Ball", "green named, a red falls from it", USUAL, ON_RED, GR, GR, NONE, ONE(R), 1, 0, ON_COLOUR, true, PLAIN},
	{"Free Ball", "green named, it and a red fall", USUAL, ON_RED, GR, GR, NONE, TWO(GR, R), 2, 0, ON_COLOUR, true, PLAIN},
	{"Free Ball", "green named, black first", USUAL, ON_RED, GR, BK, NONE, NOTHING, 0, 7, ON_RED, true, PLAIN},
	{"Free Ball", "green named, a red first", USUAL, ON_RED, GR, R, NONE, NOTHING, 0, 4, ON_RED, true, PLAIN},
	{"Free Ball", "green named, black falls", USUAL, ON_RED, GR, GR, NONE, ONE(BK), 0, 7, ON_RED, true, PLAIN},
	{"Free Ball", "green and a red at once", USUAL, ON_RED, GR, GR, R, NOTHING, 0, 0, ON_RED, true, PLAIN},
	{"Free Ball", "a red played all the same", USUAL, ON_RED, R, R, NONE, ONE(R), 1, 0, ON_COLOUR, true, PLAIN},
	{"Free Ball", "pink for yellow", NO_RED, ON_CLEARANCE, PI, PI, NONE, ONE(PI), 2, 0, ON_CLEARANCE, true, PLAIN},
	{"Free Ball", "pink for yellow, yellow falls", NO_RED, ON_CLEARANCE, PI, PI, NONE, ONE(YE), 2, 0, ON_CLEARANCE, true, PLAIN},
	{"Free Ball", "pink for yellow, both fall", NO_RED, ON_CLEARANCE, PI, PI, NONE, TWO(PI, YE), 2, 0, ON_CLEARANCE, true, PLAIN},
	{"Free Ball", "black for pink", PINK_BLACK, ON_CLEARANCE, BK, BK, NONE, ONE(BK), 6, 0, ON_CLEARANCE, true, PLAIN},
	/* End of Frame */
	{"End of Frame", "the last black", ONLY_BLACK, ON_CLEARANCE, NONE, BK, NONE, ONE(BK), 7, 0, ON_CLEARANCE, PLAIN},
	{"End of Frame", "the last black missed by all", ONLY_BLACK, ON_CLEARANCE, NONE, NONE, NONE, NOTHING, 0, 7, ON_CLEARANCE, PLAIN},
	{"End of Frame", "the last black and in-off", ONLY_BLACK, ON_CLEARANCE, NONE, BK, NONE, TWO(BK, W), 0, 7, ON_CLEARANCE, PLAIN},
	{"End of Frame", "the last black struck", ONLY_BLACK, ON_CLEARANCE, NONE, BK, NONE, NOTHING, 0, 0, ON_CLEARANCE, PLAIN},
};
/* clang-format on */

static bool is_there(int layout, int ball)
{
	static const int from[] = {
		[USUAL] = R, [LAST_RED] = R, [NO_RED] = YE, [FROM_BLUE] = BU, [PINK_BLACK] = PI, [ONLY_BLACK] = BK};
	return ball == W || (ball >= from[layout] && !(layout == LAST_RED && ball == S));
}

/* All balls have their index; those that are not there have been potted. */
static void lay(struct game *g, const struct shot_case *c)
{
	static const vec2 at[] = {{-0.7, 0.3}, {0.3, 0.4}, {0.5, -0.3}};
	begin(g);
	add(g, COLOUR_WHITE, at[W]);
	add(g, COLOUR_RED, at[R]);
	add(g, COLOUR_RED, at[S]);
	for (int colour = COLOUR_YELLOW; colour <= COLOUR_BLACK; colour++)
		add(g, (enum ball_colour)colour, g->table.spot[colour]);
	for (int i = 0; i < g->count; i++)
		if (!is_there(c->layout, i))
			g->ball[i].phase = BALL_POTTED;
	if (c->touching >= 0)
		g->ball[W].pos = vec2_add(g->ball[c->touching].pos, (vec2){-2 * g->table.ball_radius, 0});
}

/* later: s between the two balls that are met. */
static struct rules_outcome play_with(struct game *g, const struct shot_case *c, double later)
{
	struct rules_state state = {.on = c->on, .free_ball = c->free_ball};
	struct rules_outcome out;
	lay(g, c);
	for (int i = 0; i < g->count; i++)
		g->trace.start[i] = g->ball[i];
	g->trace.ball_count = g->count;
	if (!c->into_it) {
		g->ball[W].pos = (vec2){-1.2, -0.5}; /* it has been elsewhere */
		event(g, EVENT_CUSHION, W, 0, 0.1);
	}
	if (c->first >= 0)
		event(g, EVENT_BALL_BALL, W, c->first, 0.3);
	if (c->second >= 0)
		event(g, EVENT_BALL_BALL, c->second, W, 0.3 + later);
	for (int i = 0; i < MANY && c->potted[i] >= 0; i++)
		event(g, EVENT_POCKET, c->potted[i], 0, 1 + i);
	rules_judge(&g->table, &state, &g->trace, c->named, &out);
	return out;
}

static struct rules_outcome play(struct game *g, const struct shot_case *c)
{
	return play_with(g, c, 0);
}

/* Reds stay off; colours come back but for the one whose turn it was and that was potted without a foul. */
static void check_colours(const struct shot_case *c, const struct rules_outcome *out)
{
	for (int i = YE; i <= BK; i++) {
		if (!is_there(c->layout, i)) {
			ck_assert_msg(out->ball[i].phase == BALL_POTTED, "%s: %s: ball %d was off and came back",
				      c->section, c->name, i);
			continue;
		}
		bool fell = false, lowest = true;
		for (int k = 0; k < MANY; k++)
			fell |= c->potted[k] == i;
		for (int k = YE; k < i; k++)
			lowest &= !is_there(c->layout, k);
		bool off = fell && c->on == ON_CLEARANCE && lowest && c->foul == 0;
		ck_assert_msg((out->ball[i].phase == BALL_POTTED) == off, "%s: %s: ball %d %s", c->section, c->name, i,
			      off ? "came back" : "is not back");
	}
}

/* Two balls are struck at once or one after the other: then only the first counts. */
START_TEST(a_ball_met_later_does_not_count)
{
	struct game g;
	int seen = 0;
	for (size_t i = 0; i < sizeof shot_case / sizeof shot_case[0]; i++) {
		struct shot_case c = shot_case[i];
		if (c.second < 0)
			continue;
		seen++;
		struct rules_outcome later = play_with(&g, &c, 1e-3);
		c.second = NONE;
		struct rules_outcome alone = play(&g, &c);
		ck_assert_msg(later.foul == alone.foul && later.points == alone.points &&
				      later.next.on == alone.next.on,
			      "%s: %s", c.section, c.name);
	}
	ck_assert_int_gt(seen, 0);
}
END_TEST

START_TEST(shots_by_the_rules)
{
	const struct shot_case *c = &shot_case[_i];
	struct game g;
	struct rules_outcome out = play(&g, c);
	ck_assert_msg(out.points == c->points, "%s: %s: %d points", c->section, c->name, out.points);
	ck_assert_msg(out.foul == c->foul, "%s: %s: foul %d", c->section, c->name, out.foul);
	ck_assert_msg(out.next.on == c->next, "%s: %s: next %d", c->section, c->name, (int)out.next.on);
	bool ends = c->layout == ONLY_BLACK && (c->points > 0 || c->foul > 0);
	ck_assert_msg(out.ends == ends, "%s: %s: ends %d", c->section, c->name, out.ends);
	bool in_off = c->potted[0] == W || c->potted[1] == W || c->potted[2] == W;
	ck_assert_msg(out.cue_potted == in_off && out.next.in_hand == in_off, "%s: %s: in hand %d", c->section, c->name,
		      out.next.in_hand);
	ck_assert(!out.next.free_ball);
	check_colours(c, &out);
}
END_TEST

/* ---- Spotting Colours ---- */

/* The letters of occupied spots (Y G N B P K), the colour that comes back, the spot that it gets; 0: near its own. */
static const struct spot_case {
	const char *taken;
	enum ball_colour colour, spot;
} spot_case[] = {
	{"", COLOUR_YELLOW, COLOUR_YELLOW},	{"", COLOUR_BLACK, COLOUR_BLACK},
	{"B", COLOUR_BLUE, COLOUR_BLACK},	{"BK", COLOUR_BLUE, COLOUR_PINK},
	{"BPK", COLOUR_BLUE, COLOUR_BROWN},	{"Y", COLOUR_YELLOW, COLOUR_BLACK},
	{"YKPB", COLOUR_YELLOW, COLOUR_BROWN},	{"K", COLOUR_BLACK, COLOUR_PINK},
	{"KPBNG", COLOUR_BLACK, COLOUR_YELLOW}, {"YGNBPK", COLOUR_BLUE, COLOUR_UNKNOWN},
};

START_TEST(spots)
{
	const struct spot_case *c = &spot_case[_i];
	static const char letters[] = "YGNBPK";
	struct game g;
	vec2 pos;
	begin(&g);
	for (const char *letter = c->taken; *letter; letter++)
		add(&g, COLOUR_RED, g.table.spot[COLOUR_YELLOW + (int)(strchr(letters, *letter) - letters)]);
	ck_assert(rules_respot(&g.table, g.ball, g.count, c->colour, &pos));
	vec2 want = c->spot != COLOUR_UNKNOWN ? g.table.spot[c->spot]
					      : vec2_add(g.table.spot[c->colour], (vec2){2 * g.table.ball_radius, 0});
	ck_assert_msg(vec2_dist(pos, want) < 2e-9, "%s taken: %s at %g, %g", c->taken, ball_colour_name(c->colour),
		      pos.x, pos.y);
}
END_TEST

/* No spot is free and no place above: below the spot, on the line. */
START_TEST(black_below_its_spot)
{
	struct game g;
	vec2 pos;
	begin(&g);
	for (int c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++)
		add(&g, COLOUR_RED, g.table.spot[c]);
	double step = 2 * g.table.ball_radius + 1e-6;
	for (double x = g.table.spot[COLOUR_BLACK].x + step; x < g.table.length / 2; x += step)
		add(&g, COLOUR_RED, (vec2){x, 0});
	ck_assert_int_le(g.count, BALL_MAX);
	ck_assert(rules_respot(&g.table, g.ball, g.count, COLOUR_BLACK, &pos));
	ck_assert_double_eq(pos.y, 0);
	ck_assert_double_eq_tol(pos.x, g.table.spot[COLOUR_BLACK].x - 2 * g.table.ball_radius, 2e-9);
}
END_TEST

/* Several colours come back: the most valuable first. */
START_TEST(the_most_valuable_first)
{
	struct shot_case c = {.layout = USUAL,
			      .on = ON_RED,
			      .named = NONE,
			      .first = R,
			      .second = NONE,
			      .touching = NONE,
			      .potted = {BU, PI, NONE}};
	struct game g;
	struct rules_outcome out;
	lay(&g, &c);
	g.ball[S].pos = g.table.spot[COLOUR_PINK]; /* pink and blue want spots, one is taken */
	for (int i = 0; i < g.count; i++)
		g.trace.start[i] = g.ball[i];
	g.trace.start[PI].pos = (vec2){0.2, -0.6};
	g.trace.ball_count = g.count;
	event(&g, EVENT_BALL_BALL, W, R, 0.3);
	event(&g, EVENT_POCKET, BU, 0, 1);
	event(&g, EVENT_POCKET, PI, 1, 1.1);
	rules_judge(&g.table, &(struct rules_state){.on = ON_RED}, &g.trace, NONE, &out);
	ck_assert_int_eq(out.foul, 6);
	/* pink: its spot is taken, so the highest free one, which is blue's; blue then gets brown's */
	ck_assert_double_eq(out.ball[PI].pos.x, g.table.spot[COLOUR_BLUE].x);
	ck_assert_int_eq(out.ball[BU].phase, BALL_REST);
	ck_assert(vec2_dist(out.ball[BU].pos, g.table.spot[COLOUR_BLUE]) > g.table.ball_radius);
}
END_TEST

/* Random crowds: a colour that comes back touches nothing, and its spot is the highest there is. */
START_TEST(places_are_free)
{
	struct random random = random_begin("places_are_free");
	for (int n = 0; n < 1000; n++) {
		struct game g;
		vec2 pos;
		begin(&g);
		int taken = (int)random_in(&random, 0, 64);
		for (int c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++)
			if (taken >> (c - COLOUR_YELLOW) & 1)
				add(&g, COLOUR_RED, g.table.spot[c]);
		while (g.count < BALL_MAX - 2)
			add(&g, COLOUR_RED, (vec2){random_in(&random, -1.6, 1.7), random_in(&random, -0.08, 0.08)});
		enum ball_colour colour = (enum ball_colour)(COLOUR_YELLOW + n % 6);
		ck_assert(rules_respot(&g.table, g.ball, g.count, colour, &pos));
		ck_assert(respot_is_free(&g.table, g.ball, g.count, pos));
		if (vec2_dist(pos, g.table.spot[colour]) == 0)
			continue;
		ck_assert(!respot_is_free(&g.table, g.ball, g.count, g.table.spot[colour]));
		for (int c = COLOUR_BLACK; c >= COLOUR_YELLOW && vec2_dist(pos, g.table.spot[c]) > 0; c--)
			ck_assert(!respot_is_free(&g.table, g.ball, g.count, g.table.spot[c]));
	}
}
END_TEST

/* ---- Snookered After a Foul ---- */

static const struct snooker_case {
	const char *name;
	vec2 white, black; /* the black is what may be in the way of the only red at (1, 0) */
	bool snookered;
} snooker_case[] = {
	{"nothing in the way", {-0.5, 0}, {0.5, 0.5}, false},
	{"full in the way", {-0.5, 0}, {0.25, 0}, true},
	{"one edge hidden", {-0.5, 0}, {0.25, 0.05}, true},
	{"just beside the edge", {-0.5, 0}, {0.25, 0.0801}, false},
	{"behind the red", {-0.5, 0}, {1.2, 0}, false},
	{"behind the white", {-0.5, 0}, {-0.7, 0}, false},
	{"right at the white", {-0.5, 0}, {-0.44, 0}, true},
};

START_TEST(snookers)
{
	const struct snooker_case *c = &snooker_case[_i];
	struct game g;
	begin(&g);
	add(&g, COLOUR_WHITE, c->white);
	add(&g, COLOUR_RED, (vec2){1, 0});
	add(&g, COLOUR_BLACK, c->black);
	struct rules_state state = {.on = ON_RED};
	ck_assert_msg(rules_is_snookered(&g.table, &state, g.ball, g.count) == c->snookered, "%s", c->name);
	/* another red does not hide a red */
	g.ball[2].colour = COLOUR_RED;
	ck_assert_msg(!rules_is_snookered(&g.table, &state, g.ball, g.count), "%s: by a red", c->name);
}
END_TEST

START_TEST(free_ball_only_after_a_foul)
{
	struct game g;
	struct rules_outcome out = {.foul = 4};
	begin(&g);
	out.ball[0] = ball_at(COLOUR_WHITE, (vec2){-0.5, 0});
	out.ball[1] = ball_at(COLOUR_RED, (vec2){1, 0});
	out.ball[2] = ball_at(COLOUR_BLACK, (vec2){0.25, 0});
	ck_assert(rules_opponent(&g.table, &out, 3).free_ball);
	out.foul = 0;
	ck_assert(!rules_opponent(&g.table, &out, 3).free_ball);
	/* in hand: from some place of the D the red is seen */
	out.foul = 4;
	out.cue_potted = true;
	out.ball[0].phase = BALL_POTTED;
	struct rules_state state = rules_opponent(&g.table, &out, 3);
	ck_assert(state.in_hand && !state.free_ball);
}
END_TEST

START_TEST(level_scores)
{
	struct game g;
	begin(&g);
	add(&g, COLOUR_WHITE, (vec2){0, 0});
	add(&g, COLOUR_BLACK, (vec2){0, 0});
	g.ball[0].phase = g.ball[1].phase = BALL_POTTED;
	struct rules_state state = rules_respot_black(&g.table, g.ball, g.count);
	ck_assert(state.on == ON_CLEARANCE && state.in_hand);
	ck_assert_int_eq(g.ball[1].phase, BALL_REST);
	ck_assert_double_eq(g.ball[1].pos.x, g.table.spot[COLOUR_BLACK].x);
	ck_assert(rules_ball_on(&state, g.ball, g.count, 1));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("rules_official");
	TCase *tc = tcase_create("rules");
	tcase_add_loop_test(tc, shots_by_the_rules, 0, sizeof shot_case / sizeof shot_case[0]);
	tcase_add_test(tc, a_ball_met_later_does_not_count);
	tcase_add_loop_test(tc, spots, 0, sizeof spot_case / sizeof spot_case[0]);
	tcase_add_test(tc, black_below_its_spot);
	tcase_add_test(tc, the_most_valuable_first);
	tcase_add_test(tc, places_are_free);
	tcase_add_loop_test(tc, snookers, 0, sizeof snooker_case / sizeof snooker_case[0]);
	tcase_add_test(tc, free_ball_only_after_a_foul);
	tcase_add_test(tc, level_scores);
	suite_add_tcase(suite, tc);
	return suite;
}
