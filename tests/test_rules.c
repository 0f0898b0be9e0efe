/* The rules: what is on, what it scores, what it costs, and where colours come back. */
#include "harness.h"
#include "scenes.h"

#include "search/respot.h"
#include "search/rules.h"

enum { ENTRY_MAX = 16 };

/* A trace written by hand: only events matter to the judge. */
struct game {
	struct table table;
	struct ball ball[BALL_MAX];
	int count;
	struct trace trace;
	struct trace_entry entry[ENTRY_MAX];
};

static void begin(struct game *game)
{
	game->table = scene_thesis_table();
	game->count = 0;
	trace_init(&game->trace, game->entry, ENTRY_MAX);
	game->trace.table = &game->table;
}

static int add(struct game *game, enum ball_colour colour, double x, double y)
{
	game->ball[game->count] = ball_at(colour, (vec2){x, y});
	return game->count++;
}

static void event(struct game *game, enum event_kind kind, int ball, int other)
{
	struct trace_entry *entry = &game->entry[game->trace.count];
	*entry = (struct trace_entry){.event = {0.1 * ++game->trace.count, kind, (int16_t)ball, (int16_t)other}};
	entry->after[0] = game->ball[ball];
	if (kind == EVENT_POCKET)
		entry->after[0].phase = BALL_POTTED;
	if (kind == EVENT_BALL_BALL)
		entry->after[1] = game->ball[other];
}

static struct rules_outcome judge(struct game *game, enum rules_on on, int nominated)
{
	struct rules_state state = {.on = on};
	struct rules_outcome out;
	for (int i = 0; i < game->count; i++)
		game->trace.start[i] = game->ball[i];
	game->trace.ball_count = game->count;
	rules_judge(&game->table, &state, &game->trace, nominated, &out);
	return out;
}

/* The cue ball, two reds, yellow, blue, black on their spots. */
enum { CUE, RED_A, RED_B, YELLOW, BLUE, BLACK };
static void usual(struct game *game)
{
	begin(game);
	add(game, COLOUR_WHITE, -0.7, 0);
	add(game, COLOUR_RED, 0.3, 0.1);
	add(game, COLOUR_RED, 0.4, -0.1);
	add(game, COLOUR_YELLOW, game->table.spot[COLOUR_YELLOW].x, game->table.spot[COLOUR_YELLOW].y);
	add(game, COLOUR_BLUE, 0, 0);
	add(game, COLOUR_BLACK, game->table.spot[COLOUR_BLACK].x, game->table.spot[COLOUR_BLACK].y);
}

START_TEST(balls_on)
{
	struct game g;
	usual(&g);
	static const bool want[4][6] = {
		[ON_ANY] = {false, true, true, true, true, true},
		[ON_RED] = {false, true, true, false, false, false},
		[ON_COLOUR] = {false, false, false, true, true, true},
		[ON_CLEARANCE] = {false, false, false, true, false, false},
	};
	for (int on = ON_ANY; on <= ON_CLEARANCE; on++)
		for (int i = 0; i < g.count; i++) {
			struct rules_state state = {.on = (enum rules_on)on};
			ck_assert_int_eq(rules_ball_on(&state, g.ball, g.count, i), want[on][i]);
		}
	struct rules_state state = {.on = ON_CLEARANCE};
	g.ball[YELLOW].phase = BALL_POTTED;
	ck_assert(!rules_ball_on(&state, g.ball, g.count, YELLOW));
	ck_assert(rules_ball_on(&state, g.ball, g.count, BLUE));
	ck_assert_int_eq(rules_state_from_position(g.ball, g.count).on, ON_RED);
	g.ball[RED_A].phase = g.ball[RED_B].phase = BALL_POTTED;
	ck_assert_int_eq(rules_state_from_position(g.ball, g.count).on, ON_CLEARANCE);
}
END_TEST

/* One shot each: what is struck first, what falls, what comes of it. */
static const struct shot_case {
	const char *name;
	enum rules_on on;
	int nominated, first, potted[3]; /* -1 none */
	int points, foul;
	enum rules_on next;
} shot_case[] = {
	{"red", ON_RED, -1, RED_A, {RED_A, -1, -1}, 1, 0, ON_COLOUR},
	{"two reds", ON_RED, -1, RED_A, {RED_A, RED_B, -1}, 2, 0, ON_COLOUR},
	{"red touched, none falls", ON_RED, -1, RED_A, {-1, -1, -1}, 0, 0, ON_RED},
	{"red over red", ON_RED, RED_B, RED_A, {RED_B, -1, -1}, 1, 0, ON_COLOUR},
	{"yellow first on reds", ON_RED, -1, YELLOW, {-1, -1, -1}, 0, 4, ON_RED},
	{"black first on reds", ON_RED, -1, BLACK, {-1, -1, -1}, 0, 7, ON_RED},
	{"red and blue", ON_RED, -1, RED_A, {RED_A, BLUE, -1}, 0, 5, ON_RED},
	{"blue first, black falls", ON_RED, -1, BLUE, {BLACK, -1, -1}, 0, 7, ON_RED},
	{"nothing touched", ON_RED, -1, -1, {-1, -1, -1}, 0, 4, ON_RED},
	{"cue ball potted", ON_RED, -1, RED_A, {CUE, -1, -1}, 0, 4, ON_RED},
	{"red and cue ball", ON_RED, -1, RED_A, {RED_A, CUE, -1}, 0, 4, ON_RED},
	{"named colour", ON_COLOUR, BLUE, BLUE, {BLUE, -1, -1}, 5, 0, ON_RED},
	{"colour not named", ON_COLOUR, -1, BLACK, {BLACK, -1, -1}, 7, 0, ON_RED},
	{"other colour first", ON_COLOUR, BLUE, BLACK, {-1, -1, -1}, 0, 7, ON_RED},
	{"other colour falls", ON_COLOUR, BLACK, BLACK, {BLUE, -1, -1}, 0, 7, ON_RED},
	{"red on a colour", ON_COLOUR, BLUE, RED_A, {-1, -1, -1}, 0, 5, ON_RED},
	{"black named, nothing touched", ON_COLOUR, BLACK, -1, {-1, -1, -1}, 0, 7, ON_RED},
	{"lowest", ON_CLEARANCE, -1, YELLOW, {YELLOW, -1, -1}, 2, 0, ON_CLEARANCE},
	{"not the lowest", ON_CLEARANCE, -1, BLUE, {-1, -1, -1}, 0, 5, ON_RED},
	{"any ball", ON_ANY, -1, BLUE, {BLUE, RED_A, -1}, 6, 0, ON_ANY},
	{"any ball, cue ball potted", ON_ANY, -1, BLUE, {BLUE, CUE, -1}, 0, 4, ON_ANY},
};

START_TEST(shots_are_judged)
{
	const struct shot_case *c = &shot_case[_i];
	struct game g;
	usual(&g);
	event(&g, EVENT_CUSHION, CUE, 0); /* cushion first is legal */
	if (c->first >= 0)
		event(&g, EVENT_BALL_BALL, CUE, c->first);
	for (int i = 0; i < 3 && c->potted[i] >= 0; i++)
		event(&g, EVENT_POCKET, c->potted[i], 0);
	struct rules_outcome out = judge(&g, c->on, c->nominated);
	ck_assert_msg(out.points == c->points, "%s: %d points", c->name, out.points);
	ck_assert_msg(out.foul == c->foul, "%s: foul %d", c->name, out.foul);
	ck_assert_msg(out.next.on == c->next, "%s: next %d", c->name, (int)out.next.on);
	ck_assert_int_eq(out.next.in_hand, out.cue_potted);
	bool reds_left = out.ball[RED_A].phase != BALL_POTTED || out.ball[RED_B].phase != BALL_POTTED;
	for (int i = YELLOW; i <= BLACK && reds_left; i++)
		if (c->on != ON_CLEARANCE || c->foul > 0)
			ck_assert_msg(out.ball[i].phase == BALL_REST, "%s: ball %d is not back", c->name, i);
}
END_TEST

START_TEST(first_ball_may_be_ignored)
{
	struct game g;
	usual(&g);
	event(&g, EVENT_BALL_BALL, CUE, RED_A);
	event(&g, EVENT_POCKET, BLUE, 0);
	for (int i = 0; i < g.count; i++)
		g.trace.start[i] = g.ball[i];
	g.trace.ball_count = g.count;
	struct rules_state state = {.on = ON_COLOUR, .any_first = true};
	struct rules_outcome out;
	rules_judge(&g.table, &state, &g.trace, BLUE, &out);
	ck_assert_int_eq(out.foul, 0);
	ck_assert_int_eq(out.points, 5);
	ck_assert(out.next.any_first);
}
END_TEST

/* The last colours go in order and stay off; a foul brings the ball back. */
START_TEST(clearance)
{
	struct game g;
	begin(&g);
	add(&g, COLOUR_WHITE, -0.7, 0);
	int pink = add(&g, COLOUR_PINK, 0.2, 0), black = add(&g, COLOUR_BLACK, 0.5, 0);
	event(&g, EVENT_BALL_BALL, 0, pink);
	event(&g, EVENT_POCKET, pink, 1);
	struct rules_outcome out = judge(&g, ON_CLEARANCE, -1);
	ck_assert_int_eq(out.points, 6);
	ck_assert_int_eq(out.ball[pink].phase, BALL_POTTED);
	ck_assert_int_eq(out.next.on, ON_CLEARANCE);
	ck_assert(rules_ball_on(&out.next, out.ball, g.count, black));
	event(&g, EVENT_POCKET, black, 1);
	out = judge(&g, ON_CLEARANCE, -1);
	ck_assert_int_eq(out.foul, 7);
	ck_assert_int_eq(out.ball[pink].phase, BALL_REST);
	ck_assert_int_eq(out.ball[black].phase, BALL_REST);
}
END_TEST

/* The colour after the last red comes back; then the lowest is on. */
START_TEST(colour_after_the_last_red)
{
	struct game g;
	begin(&g);
	add(&g, COLOUR_WHITE, -0.7, 0);
	int yellow = add(&g, COLOUR_YELLOW, -0.6, 0.2), black = add(&g, COLOUR_BLACK, 0.5, 0);
	event(&g, EVENT_BALL_BALL, 0, black);
	event(&g, EVENT_POCKET, black, 1);
	struct rules_outcome out = judge(&g, ON_COLOUR, black);
	ck_assert_int_eq(out.points, 7);
	ck_assert_int_eq(out.ball[black].phase, BALL_REST);
	ck_assert_double_eq(out.ball[black].pos.x, g.table.spot[COLOUR_BLACK].x);
	ck_assert_int_eq(out.next.on, ON_CLEARANCE);
	ck_assert(rules_ball_on(&out.next, out.ball, g.count, yellow));
}
END_TEST

/* A ball lies within the bed as a whole: its centre a radius from every cushion. */
START_TEST(places_lie_a_radius_from_the_cushions)
{
	struct game g;
	begin(&g);
	double x = g.table.length / 2 - g.table.ball_radius, y = g.table.width / 2 - g.table.ball_radius;
	for (int side = -1; side <= 1; side += 2) {
		ck_assert(respot_is_free(&g.table, g.ball, 0, (vec2){side * (x - 1e-6), side * (y - 1e-6)}));
		ck_assert(!respot_is_free(&g.table, g.ball, 0, (vec2){side * (x + 1e-6), 0}));
		ck_assert(!respot_is_free(&g.table, g.ball, 0, (vec2){0, side * (y + 1e-6)}));
	}
}
END_TEST

START_TEST(next_higher_spot)
{
	struct game g;
	vec2 pos;
	begin(&g);
	ck_assert(rules_respot_thesis(&g.table, g.ball, 0, COLOUR_BLUE, &pos));
	ck_assert_double_eq(pos.x, g.table.spot[COLOUR_BLUE].x);
	add(&g, COLOUR_RED, g.table.spot[COLOUR_BLUE].x + 0.02, 0);
	ck_assert(rules_respot_thesis(&g.table, g.ball, g.count, COLOUR_BLUE, &pos));
	ck_assert_double_eq(pos.x, g.table.spot[COLOUR_PINK].x);
	add(&g, COLOUR_RED, g.table.spot[COLOUR_PINK].x, 0);
	ck_assert(rules_respot_thesis(&g.table, g.ball, g.count, COLOUR_BLUE, &pos));
	ck_assert_double_eq(pos.x, g.table.spot[COLOUR_BLACK].x);
	/* none above is free: the highest that is */
	add(&g, COLOUR_RED, g.table.spot[COLOUR_BLACK].x - 0.01, 0);
	ck_assert(rules_respot_thesis(&g.table, g.ball, g.count, COLOUR_BLUE, &pos));
	ck_assert_double_eq(pos.x, g.table.spot[COLOUR_BROWN].x);
	ck_assert_double_eq(pos.y, g.table.spot[COLOUR_BROWN].y);
}
END_TEST

static void occupy_spots(struct game *g)
{
	for (int c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++)
		add(g, COLOUR_RED, g->table.spot[c].x, g->table.spot[c].y);
}

START_TEST(all_spots_occupied)
{
	struct game g;
	vec2 pos;
	begin(&g);
	occupy_spots(&g);
	double d = 2 * g.table.ball_radius;
	ck_assert(rules_respot_thesis(&g.table, g.ball, g.count, COLOUR_BLUE, &pos));
	ck_assert_double_eq_tol(pos.x, g.table.spot[COLOUR_BLUE].x + d, 2e-9);
	ck_assert_double_eq(pos.y, 0);
	/* a ball in that place, off the line by half a radius: touching it from behind */
	double dy = g.table.ball_radius / 2;
	add(&g, COLOUR_RED, d * 1.2, dy);
	ck_assert(rules_respot_thesis(&g.table, g.ball, g.count, COLOUR_BLUE, &pos));
	ck_assert_double_eq_tol(pos.x, d * 1.2 + sqrt(d * d - dy * dy), 2e-9);
	/* black: its spot is nearer to the cushion than a ball is wide, so the first free place of the grid: beside it
	 */
	ck_assert(rules_respot_thesis(&g.table, g.ball, g.count, COLOUR_BLACK, &pos));
	ck_assert_double_eq_tol(pos.x, g.table.spot[COLOUR_BLACK].x, 1e-12);
	ck_assert_double_eq_tol(pos.y, d, 1e-12);
}
END_TEST

/* Random crowds: a respot never overlaps or leaves the bed, and no place on the line towards the top cushion is nearer.
 */
START_TEST(respots_are_free_and_nearest)
{
	struct random random = random_begin("respots_are_free_and_nearest");
	for (int n = 0; n < 2000; n++) {
		struct game g;
		vec2 pos;
		begin(&g);
		occupy_spots(&g);
		while (g.count < BALL_MAX)
			add(&g, COLOUR_RED, random_in(&random, -0.1, 0.9), random_in(&random, -0.08, 0.08));
		enum ball_colour colour = (enum ball_colour)(COLOUR_YELLOW + n % 6);
		vec2 spot = g.table.spot[colour];
		ck_assert(rules_respot_thesis(&g.table, g.ball, g.count, colour, &pos));
		ck_assert(respot_is_free(&g.table, g.ball, g.count, pos));
		if (!respot_towards_top(&g.table, g.ball, g.count, spot, &pos))
			continue;
		for (double x = spot.x; x < pos.x - 1e-6; x += 1e-4)
			ck_assert(!respot_is_free(&g.table, g.ball, g.count, (vec2){x, spot.y}));
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("rules");
	TCase *tc = tcase_create("judge");
	tcase_add_test(tc, balls_on);
	tcase_add_loop_test(tc, shots_are_judged, 0, sizeof shot_case / sizeof shot_case[0]);
	tcase_add_test(tc, first_ball_may_be_ignored);
	tcase_add_test(tc, clearance);
	tcase_add_test(tc, colour_after_the_last_red);
	suite_add_tcase(suite, tc);
	tc = tcase_create("respot");
	tcase_set_timeout(tc, 30);
	tcase_add_test(tc, places_lie_a_radius_from_the_cushions);
	tcase_add_test(tc, next_higher_spot);
	tcase_add_test(tc, all_spots_occupied);
	tcase_add_test(tc, respots_are_free_and_nearest);
	suite_add_tcase(suite, tc);
	return suite;
}
