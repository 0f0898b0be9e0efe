/* Hard cases by name, and requests that must be refused. */
#include "harness.h"
#include "search_scenes.h"
#include "scenes.h"

#include <errno.h>
#include <math.h>
#include <string.h>

enum { TRACE_MAX = 4096 };
static struct trace_entry entry[TRACE_MAX];

/* A small scene on one table, searched once. */
struct hard {
	struct table table;
	struct ball ball[BALL_MAX];
	int count;
	struct plan_request request;
	struct plan_result result;
	struct planner *planner;
};

static void begin(struct hard *hard, bool thesis)
{
	memset(hard, 0, sizeof *hard);
	hard->table = thesis ? scene_thesis_table() : scene_snooker_table();
}

static int add(struct hard *hard, enum ball_colour colour, double x, double y)
{
	hard->ball[hard->count] = ball_at(colour, (vec2){x, y});
	return hard->count++;
}

static void add_spot(struct hard *hard, enum ball_colour colour)
{
	add(hard, colour, hard->table.spot[colour].x, hard->table.spot[colour].y);
}

static void set_rules(struct hard *hard)
{
	hard->request = scene_request(hard->ball, hard->count);
	hard->request.target = TARGET_RULES;
}

/* By the rules in earnest: what the thesis' program lets pass is off. */
static void search_with(struct hard *hard, const char *model)
{
	struct cost_profile profile = cost_profile_thesis();
	struct model m;
	profile.any_first = profile.keep_flukes = false;
	profile.aims = 3;
	hard->planner = scene_planner(&hard->table, model, &profile, 1);
	hard->result = scene_run(hard->planner, &hard->request);
	ck_assert(model_from_name(model, &m));
	ck_assert_int_gt(hard->result.plan_count, 0);
	for (int i = 0; i < hard->result.plan_count; i++)
		for (int s = 0; s < hard->result.plan[i].shot_count; s++) {
			struct trace trace;
			trace_init(&trace, entry, TRACE_MAX);
			ck_assert(
				plan_shot_replay(&hard->table, &m, &hard->result.plan[i].shot[s], hard->count, &trace));
		}
}

static void end(struct hard *hard)
{
	planner_destroy(hard->planner);
}

static const struct plan_shot *best(const struct hard *hard)
{
	return &hard->result.plan[0].shot[0];
}

static bool proposes(const struct hard *hard, int target, int pocket)
{
	for (int i = 0; i < hard->result.plan_count; i++) {
		const struct plan_shot *shot = &hard->result.plan[i].shot[0];
		if (shot->target == target && shot->pocket == pocket)
			return true;
	}
	return false;
}

START_TEST(no_red_left)
{
	struct hard h;
	begin(&h, true);
	add(&h, COLOUR_WHITE, 0.1, 0.05);
	for (int c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++)
		if (c != COLOUR_BLUE)
			add_spot(&h, (enum ball_colour)c);
	set_rules(&h);
	h.request.rails = 1;
	search_with(&h, "thesis");
	for (int i = 0; i < h.result.plan_count; i++)
		ck_assert_int_eq(h.ball[h.result.plan[i].shot[0].target].colour, COLOUR_YELLOW);
	end(&h);
}
END_TEST

START_TEST(two_colours_left_on_their_spots)
{
	struct hard h;
	begin(&h, true);
	add(&h, COLOUR_WHITE, 0.1, 0.1);
	add_spot(&h, COLOUR_PINK);
	add_spot(&h, COLOUR_BLACK);
	set_rules(&h);
	h.request.depth = 2;
	h.request.rails = 1;
	h.request.speeds = 3;
	search_with(&h, "thesis");
	const struct plan *plan = &h.result.plan[0];
	ck_assert_int_eq(plan->shot_count, 2);
	ck_assert_int_eq(plan->shot[0].target, 1);
	ck_assert_int_eq(plan->shot[1].target, 2);
	ck_assert_int_eq(plan->shot[1].start[1].phase, BALL_POTTED);
	end(&h);
}
END_TEST

START_TEST(one_ball_left)
{
	struct hard h;
	begin(&h, true);
	add(&h, COLOUR_WHITE, -0.2, 0.1);
	add(&h, COLOUR_BLACK, 0.5, 0.2);
	set_rules(&h);
	h.request.depth = 3; /* deeper than there are balls */
	search_with(&h, "thesis");
	ck_assert_int_eq(best(&h)->target, 1);
	ck_assert_int_eq(h.result.plan[0].shot_count, 1);
	end(&h);
}
END_TEST

/* Touching, the way away from it: legal contact with another ball, never a push through the touching one. */
START_TEST(cue_ball_frozen_to_a_ball)
{
	struct hard h;
	begin(&h, true);
	double d = 2 * h.table.ball_radius;
	add(&h, COLOUR_WHITE, -0.3, 0);
	add(&h, COLOUR_RED, -0.3 + d, 0);
	add(&h, COLOUR_RED, -0.6, 0.3);
	set_rules(&h);
	search_with(&h, "thesis");
	ck_assert_int_eq(h.result.status, PLAN_OK);
	ck_assert(best(&h)->foul == 0);
	end(&h);
}
END_TEST

START_TEST(cue_ball_frozen_to_a_cushion)
{
	struct hard h;
	begin(&h, true);
	add(&h, COLOUR_WHITE, -0.3, h.table.width / 2 - h.table.ball_radius);
	add(&h, COLOUR_RED, -0.2, -0.3);
	set_rules(&h);
	h.request.rails = 2;
	search_with(&h, "thesis");
	ck_assert_int_eq(best(&h)->target, 1);
	/* never over the cushion that it lies on as the first */
	for (int i = 0; i < h.result.plan_count; i++)
		ck_assert(sin(h.result.plan[i].shot[0].shot.angle) < 1e-9);
	end(&h);
}
END_TEST

START_TEST(object_ball_frozen_to_the_cushion)
{
	struct hard h;
	begin(&h, true);
	double y = h.table.width / 2 - h.table.ball_radius;
	add(&h, COLOUR_WHITE, 0.2, 0.2);
	int red = add(&h, COLOUR_RED, 0.65, y);
	set_rules(&h);
	search_with(&h, "thesis");
	ck_assert(proposes(&h, red, table_pocket(&h.table, "TOP-RIGHT")));
	end(&h);
}
END_TEST

/* Behind a wall of other balls: the answer goes over a cushion. */
START_TEST(snookered_on_all_balls)
{
	struct hard h;
	begin(&h, true);
	add(&h, COLOUR_WHITE, -0.8, 0);
	for (int i = 0; i < 6; i++)
		add(&h, (enum ball_colour)(COLOUR_YELLOW + i), -0.65, -0.14 + 0.056 * i);
	int red = add(&h, COLOUR_RED, 0.3, 0);
	set_rules(&h);
	search_with(&h, "thesis");
	ck_assert_int_eq(best(&h)->foul, 0);
	ck_assert_int_eq(best(&h)->target, -1);
	ck_assert_int_eq(best(&h)->chain[1], red);
	ck_assert_int_gt(best(&h)->rails, 0);
	end(&h);
}
END_TEST

/* Walled in completely: no legal shot, so the cheapest foul, and it says so. */
START_TEST(no_legal_shot)
{
	struct hard h;
	begin(&h, true);
	add(&h, COLOUR_WHITE, 0, 0);
	for (int i = 0; i < 7; i++) {
		double a = 2 * M_PI * i / 7, r = 0.062;
		add(&h, i < 6 ? (enum ball_colour)(COLOUR_YELLOW + i) : COLOUR_UNKNOWN, r * cos(a), r * sin(a));
	}
	add(&h, COLOUR_RED, 0.7, 0.3);
	set_rules(&h);
	search_with(&h, "thesis");
	ck_assert_int_eq(h.result.status, PLAN_OK);
	ck_assert_int_eq(best(&h)->target, -1);
	ck_assert_int_gt(best(&h)->foul, 0);
	end(&h);
}
END_TEST

/* Cue ball, one to three balls and a pocket in one line, from everywhere: the cosine of the cut is 1 or a hair more. */
static void line_up(struct hard *hard, struct random *random, int pocket, int balls)
{
	const struct table *t = &hard->table;
	double half_x = t->length / 2 - t->ball_radius, half_y = t->width / 2 - t->ball_radius;
	vec2 hole = t->pocket[pocket].centre;
	vec2 cue = {random_in(random, -half_x, half_x), random_in(random, -half_y, half_y)};
	vec2 way = vec2_sub(hole, cue);
	double length = vec2_norm(way), room = 4 * t->ball_radius / length;
	add(hard, COLOUR_WHITE, cue.x, cue.y);
	for (int i = 0; i < balls; i++) {
		vec2 at = vec2_madd(cue, room + (1 - 2 * room) * i / balls, way);
		if (fabs(at.x) <= half_x && fabs(at.y) <= half_y)
			add(hard, i % 2 ? COLOUR_BLACK : COLOUR_RED, at.x, at.y);
	}
}

START_TEST(all_in_one_line)
{
	static const char *const model[] = {"thesis", "simple", "simple-elastic", "real", "real-mathavan"};
	struct random random = random_begin("all_in_one_line");
	random.state += (uint64_t)_i;
	for (int profile = 0; profile < 2; profile++) {
		struct cost_profile p = cost_profile_thesis();
		struct hard h;
		begin(&h, _i >= 5);
		if (profile == 1) {
			p.any_first = p.keep_flukes = p.program_speed = false;
			p.aims = 9;
			p.clearance = 0.002;
			p.ranking = RANK_SUCCESS;
		}
		h.planner = scene_planner(&h.table, model[_i % 5], &p, 1);
		for (int n = 0; n < 60; n++) {
			h.count = 0;
			line_up(&h, &random, n % 6, 1 + n / 6 % 3);
			set_rules(&h);
			h.request.target = n & 1 ? TARGET_RULES : TARGET_ANY;
			h.request.rails = n % 4 == 0;
			h.request.budget.nodes = 60;
			h.request.plans = 3;
			char err[200] = "";
			if (plan_request_check(&h.table, &h.request, err, sizeof err) != 0)
				continue; /* too near to each other */
			h.result = scene_run(h.planner, &h.request);
			ck_assert(h.count == 1 || h.result.plan_count > 0);
		}
		end(&h);
	}
}
END_TEST

/* A straight pot over a whole circle of directions: proposed, at the very angle of the line. */
START_TEST(straight_pots_are_proposed)
{
	int tried = 0;
	for (int n = 0; n < 300; n++) {
		struct hard h;
		begin(&h, true);
		int pocket = n % 6;
		vec2 hole = h.table.pocket[pocket].centre, out = h.table.pocket[pocket].normal;
		double turn = (n / 6 - 25) * 0.4 / 25;
		vec2 in = vec2_unit(vec2_madd(vec2_scale(out, cos(turn)), sin(turn), vec2_perp(out)));
		vec2 red = vec2_madd(hole, 0.25, in), cue = vec2_madd(hole, 0.5, in);
		if (fabs(red.x) > 0.88 || fabs(red.y) > 0.42 || fabs(cue.x) > 0.85 || fabs(cue.y) > 0.4)
			continue; /* too near to a cushion for clearance and cue */
		add(&h, COLOUR_WHITE, cue.x, cue.y);
		int ball = add(&h, COLOUR_RED, red.x, red.y);
		set_rules(&h);
		search_with(&h, "thesis");
		double off = INFINITY;
		for (int i = 0; i < h.result.plan_count; i++) {
			const struct plan_shot *shot = &h.result.plan[i].shot[0];
			if (shot->target == ball && shot->pocket == pocket)
				off = fmin(off, fabs(remainder(shot->shot.angle - atan2(-in.y, -in.x), 2 * M_PI)));
		}
		ck_assert(off < 1e-9);
		tried++;
		end(&h);
	}
	ck_assert_int_gt(tried, 100);
}
END_TEST

/* A ball that nothing can reach: red in a ring of others. */
static void wall_in(struct hard *hard, vec2 at)
{
	add(hard, COLOUR_RED, at.x, at.y);
	for (int i = 0; i < 7; i++) {
		vec2 out = vec2_madd(at, 0.062, vec2_from_angle(2 * M_PI * i / 7));
		add(hard, i < 6 ? (enum ball_colour)(COLOUR_YELLOW + i) : COLOUR_UNKNOWN, out.x, out.y);
	}
}

/* Where only fouls are left, the first that is tried (along +x) would pot the cue ball: another one as cheap does not. */
START_TEST(no_foul_that_pots_the_cue_ball)
{
	static struct sim sim;
	struct hard h;
	begin(&h, true);
	add(&h, COLOUR_WHITE, 0.7, 0.4415);
	wall_in(&h, (vec2){-0.4, -0.2});
	struct model model;
	ck_assert(model_from_name("thesis", &model));
	sim_init(&sim, &h.table, &model, h.ball, h.count);
	sim_strike(&sim, 0, &(struct shot){.speed = 2.5});
	sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = 1000}, NULL);
	ck_assert_int_eq(sim_ball(&sim, 0).phase, BALL_POTTED);
	set_rules(&h);
	search_with(&h, "thesis");
	ck_assert_int_eq(best(&h)->target, -1);
	ck_assert_int_eq(best(&h)->foul, 4);
	for (int i = 0; i < best(&h)->potted_count; i++)
		ck_assert_int_ne(best(&h)->potted[i].ball, 0);
	end(&h);
}
END_TEST

/* The contact that is proposed where there is no pot: legal where one is, names the ball that it strikes, arrives. */
START_TEST(contacts_are_legal)
{
	struct random random = random_begin("contacts_are_legal");
	int contacts = 0;
	for (int n = 0; n < 150; n++) {
		struct hard h;
		begin(&h, n & 1);
		h.count = 3 + n % 4;
		scene_random(&random, &h.table, 0.01, h.ball, h.count);
		set_rules(&h);
		h.request.budget.nodes = 1; /* no time for pots */
		search_with(&h, n % 3 ? "thesis" : "real");
		const struct plan_shot *shot = best(&h);
		if (shot->target < 0) {
			contacts++;
			ck_assert_int_eq(shot->foul, 0);
			ck_assert_int_eq(shot->chain[0], 0);
			ck_assert_int_eq(h.ball[shot->chain[1]].colour, COLOUR_RED);
			ck_assert(shot->chain[2] == -1 && shot->chain_count == 2 && shot->pocket == -1);
			ck_assert(isnan(shot->success));
			ck_assert(shot->shot.speed >= 0.3 && shot->shot.speed <= 5);
		}
		ck_assert(h.result.plan_count == 1 || shot->target >= 0);
		end(&h);
	}
	ck_assert_int_gt(contacts, 100);
}
END_TEST

/* The simplest contact with the red would send a colour down: another one is found that does not. */
START_TEST(no_contact_that_pots_a_colour)
{
	static struct sim sim;
	struct hard h;
	struct model model;
	begin(&h, true);
	add(&h, COLOUR_WHITE, 0, 0);
	add(&h, COLOUR_RED, 0, 0.3);
	int black = add(&h, COLOUR_BLACK, 0, 0.43);
	ck_assert(model_from_name("thesis", &model));
	sim_init(&sim, &h.table, &model, h.ball, h.count);
	sim_strike(&sim, 0, &(struct shot){.angle = M_PI / 2, .speed = 0.6});
	sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = 1000}, NULL);
	ck_assert_int_eq(sim_ball(&sim, black).phase, BALL_POTTED);
	set_rules(&h);
	h.request.budget.nodes = 1;
	search_with(&h, "thesis");
	ck_assert_int_eq(best(&h)->target, -1);
	ck_assert_int_eq(best(&h)->foul, 0);
	end(&h);
}
END_TEST

/* A colour or a ball that is asked for is the one that falls, and by the rules the one that is struck. */
START_TEST(what_is_asked_for_is_played)
{
	struct random random = random_begin("what_is_asked_for_is_played");
	int played = 0;
	for (int n = 0; n < 120; n++) {
		struct hard h;
		begin(&h, n & 1);
		h.count = 8 + n % 3; /* all six colours, and one red or more */
		scene_random(&random, &h.table, 0.02, h.ball, h.count);
		if (n % 4 == 3)
			for (int i = 1; i < h.count - 6; i++)
				h.ball[i].phase = BALL_POTTED; /* no red left: any colour after the last one */
		set_rules(&h);
		int wanted = h.count - 1 - n % 6;
		h.request.target = n % 12 < 6 ? TARGET_COLOUR : TARGET_BALL;
		h.request.target_colour = h.ball[wanted].colour;
		h.request.target_ball = wanted;
		search_with(&h, "thesis");
		for (int i = 0; i < h.result.plan_count; i++) {
			const struct plan_shot *shot = &h.result.plan[i].shot[0];
			if (shot->target < 0)
				continue;
			played++;
			ck_assert_int_eq(shot->target, wanted);
			ck_assert_int_eq(shot->chain[1], wanted);
			ck_assert_int_eq(shot->foul, 0);
			ck_assert_int_eq(shot->points, (int)h.ball[wanted].colour);
		}
		end(&h);
	}
	ck_assert_int_gt(played, 50);
}
END_TEST

START_TEST(pocket_blocked_by_another_ball)
{
	struct hard h;
	begin(&h, true);
	int pocket = table_pocket(&h.table, "TOP-RIGHT");
	vec2 p = h.table.pocket[pocket].centre;
	add(&h, COLOUR_WHITE, 0.2, 0);
	int red = add(&h, COLOUR_RED, 0.6, 0.2);
	add(&h, COLOUR_BLACK, p.x - 0.06, p.y - 0.05);
	set_rules(&h);
	search_with(&h, "thesis");
	ck_assert(!proposes(&h, red, pocket));
	end(&h);
}
END_TEST

START_TEST(target_in_the_jaws)
{
	static const char *const name[] = {"thesis", "real"};
	struct hard h;
	begin(&h, false);
	int pocket = table_pocket(&h.table, "TOP-RIGHT");
	vec2 p = h.table.pocket[pocket].centre;
	vec2 in = vec2_madd(p, h.table.pocket[pocket].radius + 0.03, h.table.pocket[pocket].normal);
	add(&h, COLOUR_WHITE, 1.2, 0.3);
	int red = add(&h, COLOUR_RED, in.x, in.y);
	set_rules(&h);
	search_with(&h, name[_i]);
	ck_assert(proposes(&h, red, pocket));
	end(&h);
}
END_TEST

/* A rest position of the real model beyond the line of the noses: searched, not refused, and the ball is potted. */
START_TEST(ball_at_rest_between_the_jaws)
{
	struct hard h;
	begin(&h, false);
	int pocket = table_pocket(&h.table, "BOTTOM-LEFT");
	vec2 p = h.table.pocket[pocket].centre;
	vec2 at = vec2_madd(p, h.table.pocket[pocket].radius + 0.001, vec2_from_angle(70 * M_PI / 180));
	ck_assert(at.x < -h.table.length / 2 || at.y < -h.table.width / 2);
	add(&h, COLOUR_WHITE, -1.0, -0.3);
	int red = add(&h, COLOUR_RED, at.x, at.y);
	set_rules(&h);
	search_with(&h, "real");
	ck_assert(proposes(&h, red, pocket));
	end(&h);
}
END_TEST

/* The cue ball comes to lie in the D, free, wherever it lay. */
START_TEST(cue_ball_in_hand)
{
	struct hard h;
	begin(&h, _i == 0);
	add(&h, COLOUR_WHITE, 0.3, 0.3);
	add(&h, COLOUR_RED, -0.2, -0.1);
	add(&h, COLOUR_BLUE, -0.1, 0.2);
	if (_i == 1)
		h.ball[0].phase = BALL_POTTED;
	set_rules(&h);
	h.request.state.in_hand = true;
	search_with(&h, "thesis");
	vec2 cue = best(&h)->start[0].pos;
	ck_assert(vec2_dist(cue, h.table.baulk_d_centre) <= h.table.baulk_d_radius + 1e-9);
	ck_assert(cue.x <= h.table.baulk_d_centre.x + 1e-9);
	ck_assert_int_eq(best(&h)->start[0].phase, BALL_REST);
	/* better than from its middle, or as good */
	double cost = h.result.plan[0].cost;
	planner_destroy(h.planner);
	h.request.state.in_hand = false;
	h.request.ball[0] = ball_at(COLOUR_WHITE, h.table.baulk_d_centre);
	search_with(&h, "thesis");
	ck_assert(best(&h)->target < 0 || cost <= h.result.plan[0].cost);
	end(&h);
}
END_TEST

START_TEST(opening_break)
{
	struct hard h;
	begin(&h, _i == 0);
	h.count = SCENE_RACK_COUNT;
	scene_rack(&h.table, h.ball);
	set_rules(&h);
	search_with(&h, "simple");
	ck_assert_int_eq(best(&h)->foul, 0);
	ck_assert_int_eq(h.ball[best(&h)->chain[1]].colour, COLOUR_RED);
	end(&h);
}
END_TEST

/* Positions mirrored at the table's long axis: the same costs, angles of the other sign. */
START_TEST(mirrored_tables)
{
	struct random random = random_begin("mirrored_tables");
	for (int n = 0; n < 20; n++) {
		struct hard a, b;
		begin(&a, false);
		begin(&b, false);
		a.count = b.count = 7;
		scene_random(&random, &a.table, 0.05, a.ball, a.count);
		for (int i = 0; i < a.count; i++) {
			b.ball[i] = a.ball[i];
			b.ball[i].pos.y = -a.ball[i].pos.y;
		}
		set_rules(&a);
		set_rules(&b);
		a.request.target = b.request.target = TARGET_ANY;
		a.request.rails = b.request.rails = 1;
		search_with(&a, "thesis");
		search_with(&b, "thesis");
		/* what meets many balls is chaotic: the first are compared */
		int first = a.result.plan_count < 3 ? a.result.plan_count : 3;
		for (int i = 0; i < first; i++) {
			const struct plan_shot *left = &a.result.plan[i].shot[0], *right = &b.result.plan[i].shot[0];
			ck_assert_double_eq_tol(a.result.plan[i].cost, b.result.plan[i].cost, 1e-9);
			ck_assert(fabs(remainder(left->shot.angle + right->shot.angle, 2 * M_PI)) < 1e-9);
			ck_assert_int_eq(left->target, right->target);
		}
		end(&a);
		end(&b);
	}
}
END_TEST

/* ---- requests that are refused
 * --------------------------------------------------------------------------------------- */

static void refused(const struct hard *hard, const char *word)
{
	char err[200] = "";
	ck_assert_int_eq(plan_request_check(&hard->table, &hard->request, err, sizeof err), -EINVAL);
	ck_assert_msg(strstr(err, word) != NULL, "\"%s\" does not say \"%s\"", err, word);
	/* the planner refuses it, too, and leaves the result alone */
	struct planner *planner = scene_planner(&hard->table, "thesis", NULL, 1);
	struct plan_result result = {.plan_count = 77};
	ck_assert_int_eq(planner_run(planner, &hard->request, NULL, NULL, &result, err, sizeof err), -EINVAL);
	ck_assert_int_eq(result.plan_count, 77);
	planner_destroy(planner);
}

static void usual(struct hard *hard)
{
	char err[200];
	begin(hard, true);
	add(hard, COLOUR_WHITE, -0.5, 0);
	add(hard, COLOUR_RED, 0.2, 0.1);
	add(hard, COLOUR_BLACK, 0.5, 0.1);
	set_rules(hard);
	ck_assert_int_eq(plan_request_check(&hard->table, &hard->request, err, sizeof err), 0);
}

START_TEST(bad_balls)
{
	struct hard h;
	usual(&h);
	h.request.ball[2].pos = vec2_add(h.request.ball[1].pos, (vec2){0.01, 0});
	refused(&h, "");
	usual(&h);
	h.request.ball[1].colour = COLOUR_WHITE;
	refused(&h, "both white");
	/* also when one of them is potted, whichever it is, in hand or not */
	for (int n = 0; n < 6; n++) {
		usual(&h);
		h.request.ball[2].colour = COLOUR_WHITE;
		h.request.state.in_hand = n & 1;
		if (n / 2 != 2)
			h.request.ball[n / 2 * 2].phase = BALL_POTTED;
		else
			h.request.ball[0].phase = h.request.ball[2].phase = BALL_POTTED;
		refused(&h, "both white");
	}
	usual(&h);
	h.request.ball[0].colour = COLOUR_RED;
	refused(&h, "no white");
	usual(&h);
	h.request.ball[0].phase = BALL_POTTED;
	refused(&h, "no white");
	usual(&h);
	h.request.ball[1].colour = COLOUR_COUNT;
	refused(&h, "ball 1");
	usual(&h);
	h.request.ball[1].phase = BALL_ROLLING;
	refused(&h, "not at rest");
	usual(&h);
	h.request.ball[1].pos.x = 5;
	refused(&h, "");
	usual(&h);
	h.request.ball[1].pos.y = NAN;
	refused(&h, "");
	usual(&h);
	h.request.ball[2].pos.x = INFINITY;
	refused(&h, "");
}
END_TEST

START_TEST(bad_fields)
{
	struct hard h;
	usual(&h);
	h.request.ball_count = 23;
	refused(&h, "ball_count");
	usual(&h);
	h.request.ball_count = 0;
	refused(&h, "ball_count");
	usual(&h);
	h.request.depth = 50;
	refused(&h, "depth");
	usual(&h);
	h.request.rails = 4;
	refused(&h, "rails");
	usual(&h);
	h.request.balls = 0;
	refused(&h, "balls");
	usual(&h);
	h.request.plans = 0;
	refused(&h, "plans");
	usual(&h);
	h.request.speeds = -1;
	refused(&h, "speeds");
	usual(&h);
	h.request.budget.seconds = NAN;
	refused(&h, "budget");
	usual(&h);
	h.request.budget.seconds = -1;
	refused(&h, "budget");
}
END_TEST

START_TEST(bad_targets)
{
	struct hard h;
	usual(&h);
	h.request.target = TARGET_BALL;
	h.request.target_ball = 3;
	refused(&h, "target ball 3");
	h.request.target_ball = 0;
	refused(&h, "target ball 0");
	h.request.target_ball = -1;
	refused(&h, "target ball -1");
	usual(&h);
	h.request.target = TARGET_COLOUR;
	h.request.target_colour = COLOUR_PINK;
	refused(&h, "PINK");
	h.request.target_colour = COLOUR_WHITE;
	refused(&h, "WHITE");
}
END_TEST

/* A zero budget is none; a tiny one still gives an answer. */
START_TEST(tiny_budgets)
{
	struct hard h;
	usual(&h);
	for (uint64_t nodes = 1; nodes < 20; nodes++) {
		h.request.budget.nodes = nodes;
		search_with(&h, "thesis");
		ck_assert_int_eq(h.result.status, PLAN_OK);
		end(&h);
	}
	h.request.budget.nodes = 0;
	search_with(&h, "thesis");
	ck_assert(h.result.exhausted);
	end(&h);
}
END_TEST

START_TEST(only_the_cue_ball)
{
	struct hard h;
	begin(&h, true);
	add(&h, COLOUR_WHITE, 0, 0);
	h.request = scene_request(h.ball, 1);
	h.planner = scene_planner(&h.table, "thesis", NULL, 1);
	h.result = scene_run(h.planner, &h.request);
	ck_assert_int_eq(h.result.status, PLAN_NONE);
	ck_assert_int_eq(h.result.plan_count, 0);
	end(&h);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("plan_hard");
	TCase *tc = tcase_create("cases");
	tcase_set_timeout(tc, 60);
	tcase_add_test(tc, no_red_left);
	tcase_add_test(tc, two_colours_left_on_their_spots);
	tcase_add_test(tc, one_ball_left);
	tcase_add_test(tc, cue_ball_frozen_to_a_ball);
	tcase_add_test(tc, cue_ball_frozen_to_a_cushion);
	tcase_add_test(tc, object_ball_frozen_to_the_cushion);
	tcase_add_test(tc, snookered_on_all_balls);
	tcase_add_test(tc, no_legal_shot);
	tcase_add_loop_test(tc, all_in_one_line, 0, 10);
	tcase_add_test(tc, straight_pots_are_proposed);
	tcase_add_test(tc, no_foul_that_pots_the_cue_ball);
	tcase_add_test(tc, no_contact_that_pots_a_colour);
	tcase_add_test(tc, contacts_are_legal);
	tcase_add_test(tc, what_is_asked_for_is_played);
	tcase_add_test(tc, pocket_blocked_by_another_ball);
	tcase_add_loop_test(tc, target_in_the_jaws, 0, 2);
	tcase_add_test(tc, ball_at_rest_between_the_jaws);
	tcase_add_loop_test(tc, cue_ball_in_hand, 0, 2);
	tcase_add_loop_test(tc, opening_break, 0, 2);
	tcase_add_test(tc, mirrored_tables);
	suite_add_tcase(suite, tc);
	tc = tcase_create("requests");
	tcase_add_test(tc, bad_balls);
	tcase_add_test(tc, bad_fields);
	tcase_add_test(tc, bad_targets);
	tcase_add_test(tc, tiny_budgets);
	tcase_add_test(tc, only_the_cue_ball);
	suite_add_tcase(suite, tc);
	return suite;
}
