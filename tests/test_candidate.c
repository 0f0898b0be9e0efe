/* Chains built backwards: geometry, speeds, limits. */
#include "harness.h"
#include "inverse_forward.h"
#include "search_scenes.h"
#include "scenes.h"

#include <string.h>

#include "physics/inverse.h"
#include "search/candidate.h"

enum { CHILDREN = 4096 };

/* A scene with everything on. */
struct stage {
	struct table table;
	struct mirrors mirrors;
	struct cost_profile profile;
	struct ball ball[BALL_MAX];
	struct scene scene;
	struct node child[CHILDREN], next[CHILDREN];
};

static void set(struct stage *stage, int count, int rails, int balls)
{
	stage->table = scene_thesis_table();
	stage->profile = cost_profile_thesis();
	mirrors_init(&stage->mirrors, &stage->table);
	stage->scene = (struct scene){
		.table = &stage->table,
		.mirrors = &stage->mirrors,
		.profile = &stage->profile,
		.ball = stage->ball,
		.count = count,
		.cue = 0,
		.on = ((1u << count) - 1) & ~1u,
		.wanted = ((1u << count) - 1) & ~1u,
		.rails = rails,
		.balls = balls,
	};
}

static struct stage *stage_new(void)
{
	static struct stage stage;
	memset(&stage, 0, sizeof stage);
	return &stage;
}

/* One red straight in front of a pocket, the cue ball behind it. */
START_TEST(straight_pot)
{
	struct stage *s = stage_new();
	bool overflow = false;
	set(s, 2, 0, 1);
	int pocket = table_pocket(&s->table, "TOP-CENTER");
	s->ball[0] = ball_at(COLOUR_WHITE, (vec2){0, -0.2});
	s->ball[1] = ball_at(COLOUR_RED, (vec2){0, 0.2});
	struct node root = candidate_root(&s->scene, pocket, 0);
	ck_assert_int_eq(candidate_expand(&s->scene, &root, s->child, CHILDREN, &overflow), 1);
	ck_assert_int_eq(s->child[0].chain[0], 1);
	ck_assert(!s->child[0].complete);
	ck_assert_double_eq_tol(s->child[0].to.y, 0.2 - 2 * s->table.ball_radius, 1e-12);
	ck_assert_int_eq(candidate_expand(&s->scene, &s->child[0], s->next, CHILDREN, &overflow), 1);
	ck_assert(s->next[0].complete);
	ck_assert_double_eq_tol(s->next[0].angle, M_PI / 2, 1e-12);
	ck_assert(!overflow);
	/* straight on: no angle cost, one ball struck, the two distances */
	double d1 = s->table.pocket[pocket].centre.y - 0.2, d2 = 0.4 - 2 * s->table.ball_radius;
	double want = cost_distance(&s->table, d1 * d1) * (1 + cost_distance(&s->table, d2 * d2)) + 0.5;
	ck_assert_double_eq_tol(s->next[0].search_cost, want, 1e-12);
}
END_TEST

/* Speeds without the program's simplification: forward along the chain gives back the speed at the pocket. */
START_TEST(speeds_are_inverse)
{
	struct random random = random_begin("speeds_are_inverse");
	struct stage *s = stage_new();
	int tried = 0;
	for (int n = 0; n < 300; n++) {
		bool overflow = false;
		set(s, 3, 0, 1);
		s->profile.program_speed = false;
		scene_random(&random, &s->table, 0.02, s->ball, 3);
		for (int p = 0; p < s->table.pocket_count; p++) {
			struct node root = candidate_root(&s->scene, p, 0);
			int count = candidate_expand(&s->scene, &root, s->child, CHILDREN, &overflow);
			for (int i = 0; i < count; i++) {
				const struct node *c = &s->child[i];
				int complete = candidate_expand(&s->scene, c, s->next, CHILDREN, &overflow);
				for (int k = 0; k < complete; k++) {
					double way = vec2_dist(c->to, s->ball[0].pos);
					double v = leg_forward(&s->table, s->next[k].speed, way);
					v = hit_forward(&s->table, v, vec2_dot(s->next[k].after, c->after));
					v = leg_forward(&s->table, v, vec2_dist(s->ball[c->chain[0]].pos, root.to));
					ck_assert_double_eq_tol(v, s->profile.pocket_speed, 1e-6);
					tried++;
				}
			}
		}
	}
	ck_assert_int_gt(tried, 300);
}
END_TEST

/* No ball twice, no cut beyond the limit, no speed beyond the limit, cost grows along a chain. */
static void check_chain(const struct stage *s, const struct node *parent, const struct node *node)
{
	uint32_t seen = 0;
	for (int i = 0; i < node->chain_count; i++) {
		ck_assert(!(seen >> node->chain[i] & 1));
		seen |= 1u << node->chain[i];
	}
	ck_assert(node->cost >= parent->cost);
	ck_assert(node->speed <= s->profile.max_speed);
	ck_assert(node->speed >= parent->speed);
	ck_assert(node->rails - parent->rails <= s->scene.rails);
	ck_assert_int_eq(node->complete, node->chain[node->chain_count - 1] == s->scene.cue);
	ck_assert_int_le(node->chain_count, s->scene.balls + 1);
	if (node->complete)
		ck_assert(fabs(remainder(node->angle - atan2(node->after.y, node->after.x), 2 * M_PI)) < 1e-12);
	if (parent->chain_count > 0 && node->sequence[node->chain_count - 1] == 0)
		ck_assert(vec2_dot(node->after, parent->after) > cos(s->profile.max_cut) - 1e-12);
}

/* Every leg of every ball passes clear of the others: of balls of the chain that still lie there by a diameter, of all
 * more by the clearance. Where the cue ball lies does not count: it has left by then. */
static void check_ways(const struct stage *s, const struct node *node)
{
	static struct images images;
	struct goal goal[PLAN_CHAIN_MAX];
	double diameter = 2 * s->table.ball_radius;
	uint32_t before = 0;
	ck_assert(candidate_goals(&s->scene, node, goal));
	for (int i = 0; i < node->chain_count; i++) {
		struct way way;
		int ball = node->chain[i];
		images_init(&images, &s->mirrors, goal[i].point, (vec2){1, 0}, s->scene.rails);
		ck_assert(way_build(&way, &s->mirrors, &images, node->sequence[i], s->ball[ball].pos));
		ck_assert_int_eq(way.rails, goal[i].rails);
		for (int b = 0; b < s->scene.count; b++)
			for (int leg = 0; leg <= way.rails && b != ball && b != s->scene.cue; leg++) {
				bool struck = i > 0 && b == node->chain[i - 1] && leg == way.rails;
				double least = before >> b & 1 ? diameter : diameter + s->profile.clearance;
				double d2 = segment_distance2(way.point[leg], way.point[leg + 1], s->ball[b].pos);
				ck_assert(struck || sqrt(d2) >= least - 1e-9);
			}
		before |= 1u << ball;
	}
}

static void descend(struct stage *s, const struct node *node, int *nodes)
{
	bool overflow = false;
	struct node child[256];
	if (node->complete || *nodes > 20000)
		return;
	int count = candidate_expand(&s->scene, node, child, 256, &overflow);
	for (int i = 0; i < count; i++) {
		check_chain(s, node, &child[i]);
		if (child[i].complete)
			check_ways(s, &child[i]);
		++*nodes;
		descend(s, &child[i], nodes);
	}
}

START_TEST(chains_hold_their_limits)
{
	struct random random = random_begin("chains_hold_their_limits");
	struct stage *s = stage_new();
	for (int n = 0; n < 10; n++) {
		int nodes = 0;
		set(s, 4 + n, n % 4, 1 + n % 3);
		scene_random(&random, &s->table, 0.01, s->ball, 4 + n);
		for (int p = 0; p < s->table.pocket_count; p++) {
			struct node root = candidate_root(&s->scene, p, 0);
			descend(s, &root, &nodes);
		}
		ck_assert_int_gt(nodes, 0);
	}
}
END_TEST

/* A cut of exactly the limit is refused, one a hair finer is not. */
START_TEST(cut_of_exactly_the_limit)
{
	for (int finer = 0; finer < 2; finer++) {
		struct stage *s = stage_new();
		bool overflow = false;
		set(s, 2, 0, 1);
		s->profile.max_speed = 1000;
		double cut = s->profile.max_cut - (finer ? 1e-6 : -1e-9);
		s->ball[1] = ball_at(COLOUR_RED, (vec2){0, 0.2});
		double ghost = 0.2 - 2 * s->table.ball_radius;
		s->ball[0] = ball_at(COLOUR_WHITE, (vec2){-0.3 * sin(cut), ghost - 0.3 * cos(cut)});
		struct node root = candidate_root(&s->scene, table_pocket(&s->table, "TOP-CENTER"), 0);
		ck_assert_int_eq(candidate_expand(&s->scene, &root, s->child, CHILDREN, &overflow), 1);
		ck_assert_int_eq(candidate_expand(&s->scene, &s->child[0], s->next, CHILDREN, &overflow), finer);
	}
}
END_TEST

START_TEST(blocked_ways)
{
	struct stage *s = stage_new();
	bool overflow = false;
	set(s, 3, 0, 1);
	s->scene.wanted = 2;
	double least = 2 * s->table.ball_radius + s->profile.clearance;
	s->ball[0] = ball_at(COLOUR_WHITE, (vec2){0, -0.3});
	s->ball[1] = ball_at(COLOUR_RED, (vec2){0, 0.2});
	s->ball[2] = ball_at(COLOUR_RED, (vec2){least + 1e-9, 0.4});
	struct node root = candidate_root(&s->scene, table_pocket(&s->table, "TOP-CENTER"), 0);
	ck_assert_int_eq(candidate_expand(&s->scene, &root, s->child, CHILDREN, &overflow), 1);
	s->ball[2].pos.x = least - 1e-9;
	ck_assert_int_eq(candidate_expand(&s->scene, &root, s->next, CHILDREN, &overflow), 0);
	/* in the cue ball's way instead */
	s->ball[2].pos = (vec2){0, 0};
	ck_assert_int_eq(candidate_expand(&s->scene, &s->child[0], s->next, CHILDREN, &overflow), 0);
	/* or behind the cue ball, where the cue must be */
	s->ball[2].pos = (vec2){0, -0.38};
	ck_assert_int_eq(candidate_expand(&s->scene, &s->child[0], s->next, CHILDREN, &overflow), 0);
	s->ball[2].phase = BALL_POTTED;
	ck_assert_int_eq(candidate_expand(&s->scene, &s->child[0], s->next, CHILDREN, &overflow), 1);
}
END_TEST

/* Where the cue ball lies it is not in anybody's way: it has left before another ball comes there. */
START_TEST(the_cue_balls_place_is_free)
{
	struct stage *s = stage_new();
	bool overflow = false;
	set(s, 3, 0, 2);
	s->ball[0] = ball_at(COLOUR_WHITE, (vec2){0, 0.36});
	s->ball[1] = ball_at(COLOUR_RED, (vec2){0, 0.1});
	s->ball[2] = ball_at(COLOUR_RED, (vec2){0.3, -0.2});
	struct node root = candidate_root(&s->scene, table_pocket(&s->table, "TOP-CENTER"), 0);
	int count = candidate_expand(&s->scene, &root, s->child, CHILDREN, &overflow);
	bool way_over_it = false;
	for (int i = 0; i < count; i++)
		way_over_it |= s->child[i].chain[0] == 1;
	ck_assert(way_over_it);
	/* nor does the cue need room from the ball that it strikes */
	ck_assert(cue_has_room(&s->table, &s->profile, &(struct obstacles){s->ball, 3, ~1u}, s->ball[0].pos,
			       (vec2){0, 1}));
}
END_TEST

/* Only a ball that is on is struck first; with a named one nothing comes between. */
START_TEST(who_may_be_struck_first)
{
	struct stage *s = stage_new();
	bool overflow = false;
	for (int named = 0; named < 2; named++) {
		set(s, 4, 0, 2);
		s->ball[0] = ball_at(COLOUR_WHITE, (vec2){0, -0.3});
		s->ball[1] = ball_at(COLOUR_RED, (vec2){0, 0.25});
		s->ball[2] = ball_at(COLOUR_BLUE, (vec2){0.12, 0}); /* beside the way from the white to the red */
		s->ball[3] = ball_at(COLOUR_BLACK, (vec2){-0.4, 0.2});
		s->scene.on = 1u << 2;
		s->scene.wanted = 1u << 1;
		s->scene.named = named;
		struct node root = candidate_root(&s->scene, table_pocket(&s->table, "TOP-CENTER"), 0);
		ck_assert_int_eq(candidate_expand(&s->scene, &root, s->child, CHILDREN, &overflow), 1);
		ck_assert_int_eq(s->child[0].chain[0], 1);
		int count = candidate_expand(&s->scene, &s->child[0], s->next, CHILDREN, &overflow);
		ck_assert_int_eq(count > 0, !named); /* the red is not on: not by the cue ball */
		bool over_blue = false;
		for (int i = 0; i < count; i++) {
			ck_assert_int_ne(s->next[i].chain[1], 0);
			over_blue |= s->next[i].chain[1] == 2;
		}
		ck_assert_int_eq(over_blue, !named);
		/* over the blue, which is on, it is */
		for (int i = 0; i < count; i++) {
			struct node end[64];
			int ends = candidate_expand(&s->scene, &s->next[i], end, 64, &overflow);
			ck_assert_int_eq(ends, s->next[i].chain[1] == 2);
			ck_assert(ends == 0 || (end[0].complete && end[0].chain_count == 3));
		}
	}
}
END_TEST

START_TEST(full_buffer_is_told)
{
	struct random random = random_begin("full_buffer_is_told");
	struct stage *s = stage_new();
	bool overflow = false;
	set(s, 10, 3, 3);
	scene_random(&random, &s->table, 0.05, s->ball, 10);
	struct node root = candidate_root(&s->scene, 0, 0);
	int all = candidate_expand(&s->scene, &root, s->child, CHILDREN, &overflow);
	ck_assert(!overflow);
	ck_assert_int_gt(all, 3);
	ck_assert_int_eq(candidate_expand(&s->scene, &root, s->next, 3, &overflow), 3);
	ck_assert(overflow);
	ck_assert_mem_eq(s->child, s->next, 3 * sizeof s->child[0]);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("candidate");
	TCase *tc = tcase_create("candidate");
	tcase_set_timeout(tc, 60);
	tcase_add_test(tc, straight_pot);
	tcase_add_test(tc, speeds_are_inverse);
	tcase_add_test(tc, chains_hold_their_limits);
	tcase_add_test(tc, cut_of_exactly_the_limit);
	tcase_add_test(tc, blocked_ways);
	tcase_add_test(tc, the_cue_balls_place_is_free);
	tcase_add_test(tc, who_may_be_struck_first);
	tcase_add_test(tc, full_buffer_is_told);
	suite_add_tcase(suite, tc);
	return suite;
}
