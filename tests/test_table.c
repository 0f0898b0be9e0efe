#include "harness.h"
#include "scenes.h"

#include <errno.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "physics/sim.h"
#include "physics/table.h"

static vec2 nearest_pocket(const struct table *t, vec2 point)
{
	vec2 best = t->pocket[0].centre;
	for (int i = 1; i < t->pocket_count; i++) {
		if (vec2_dist(t->pocket[i].centre, point) < vec2_dist(best, point))
			best = t->pocket[i].centre;
	}
	return best;
}

/* Rails face the bed, jaws the mouth of their pocket. */
START_TEST(normals_point_to_the_playing_side)
{
	struct table table[2] = {scene_thesis_table(), scene_snooker_table()};
	for (int k = 0; k < 2; k++) {
		for (int i = 0; i < table[k].cushion_count; i++) {
			const struct cushion *c = &table[k].cushion[i];
			ck_assert_double_eq_tol(vec2_norm(c->normal), 1, 1e-15);
			ck_assert_double_eq_tol(vec2_dot(c->normal, c->along), 0, 1e-15);
			if (c->main_rail)
				ck_assert_double_gt(vec2_dot(c->normal, vec2_scale(c->a, -1)), 0);
			else
				ck_assert_double_gt(
					vec2_dot(c->normal, vec2_sub(nearest_pocket(&table[k], c->a), c->a)), 0);
			ck_assert_double_le(vec2_dist(vec2_madd(c->a, c->span, c->along), c->b), 1e-15);
		}
	}
}
END_TEST

/* Every cushion end is covered by a jaw; finishing twice adds nothing. */
START_TEST(free_ends_get_tips)
{
	struct table table[3] = {scene_thesis_table(), scene_snooker_table(), scene_box_table(2, 1)};
	for (int k = 0; k < 3; k++) {
		struct table *t = &table[k];
		for (int i = 0; i < 2 * t->cushion_count; i++) {
			vec2 end = i & 1 ? t->cushion[i / 2].b : t->cushion[i / 2].a;
			bool covered = false;
			for (int j = 0; j < t->jaw_count; j++)
				covered = covered || fabs(vec2_dist(end, t->jaw[j].centre) - t->jaw[j].radius) < 1e-3;
			ck_assert(covered);
		}
		int jaws = t->jaw_count;
		char err[100];
		ck_assert_int_eq(table_finish(t, err, sizeof err), 0);
		ck_assert_int_eq(t->jaw_count, jaws);
	}
	ck_assert_int_eq(table[2].jaw_count, 4);
}
END_TEST

START_TEST(regions_hold_what_is_near)
{
	struct table t = scene_snooker_table();
	uint32_t jaws = 0, cushions = 0, pockets = 0;
	for (int i = 0; i < t.region_count; i++) {
		ck_assert_int_eq((int)(jaws & t.region[i].jaws), 0);
		jaws |= t.region[i].jaws;
		cushions |= t.region[i].cushions;
		pockets |= t.region[i].pockets;
		/* the middle of the table is far from every pocket */
		ck_assert(t.region[i].low.x > 0.4 || t.region[i].high.x < -0.4 || t.region[i].low.y > 0.4 ||
			  t.region[i].high.y < -0.4);
	}
	ck_assert_int_eq((int)jaws, (int)((1ull << t.jaw_count) - 1));
	ck_assert_int_eq((int)pockets, 63);
	for (int i = 0; i < t.cushion_count; i++)
		ck_assert((cushions >> i & 1) == !t.cushion[i].main_rail);
}
END_TEST

START_TEST(bad_tables_are_refused)
{
	char err[200];
	struct table t = scene_thesis_table();
	t.ball_radius = NAN;
	ck_assert_int_eq(table_finish(&t, err, sizeof err), -EINVAL);
	ck_assert_ptr_nonnull(strstr(err, "radius"));
	t = scene_thesis_table();
	t.material.e_cushion = 1.1;
	ck_assert_int_eq(table_finish(&t, err, sizeof err), -EINVAL);
	ck_assert_ptr_nonnull(strstr(err, "e_cushion"));
	t = scene_thesis_table();
	t.cushion[3].b = t.cushion[3].a;
	ck_assert_int_eq(table_finish(&t, err, sizeof err), -EINVAL);
	ck_assert_ptr_nonnull(strstr(err, "cushion 3"));
	t = scene_thesis_table();
	t.cushion[0].a = (vec2){-1, 0};
	t.cushion[0].b = (vec2){1, 0};
	ck_assert_int_eq(table_finish(&t, err, sizeof err), -EINVAL);
	t.cushion[0].two_sided = true;
	ck_assert_int_eq(table_finish(&t, err, sizeof err), 0);
	t = scene_thesis_table();
	t.pocket_count = 7;
	ck_assert_int_eq(table_finish(&t, err, sizeof err), -EINVAL);
	t = scene_thesis_table();
	t.pocket[2].centre.y = INFINITY;
	ck_assert_int_eq(table_finish(&t, NULL, 0), -EINVAL);
}
END_TEST

START_TEST(pockets_by_name)
{
	struct table t = scene_thesis_table();
	for (int i = 0; i < t.pocket_count; i++)
		ck_assert_int_eq(table_pocket(&t, t.pocket[i].name), i);
	ck_assert_int_eq(table_pocket(&t, "NOWHERE"), -1);
	ck_assert_int_eq(table_pocket(&t, ""), -1);
}
END_TEST

START_TEST(bad_positions_are_refused)
{
	struct table t = scene_thesis_table();
	struct ball ball[3] = {ball_at(COLOUR_WHITE, (vec2){0, 0}), ball_at(COLOUR_RED, (vec2){0.0523, 0}),
			       ball_at(COLOUR_RED, (vec2){0.3, 0})};
	int first, second;
	char err[200];
	ck_assert_int_eq(table_check_balls(&t, ball, 3, &first, &second, err, sizeof err), 0);
	ck_assert(first == -1 && second == -1);
	ball[2].pos.x = 0.06;
	ck_assert_int_eq(table_check_balls(&t, ball, 3, &first, &second, err, sizeof err), -EINVAL);
	ck_assert(first == 1 && second == 2);
	ball[2].phase = BALL_POTTED;
	ck_assert_int_eq(table_check_balls(&t, ball, 3, &first, &second, err, sizeof err), 0);
	ball[2].phase = BALL_REST;
	ball[2].pos = (vec2){0.95, 0};
	ck_assert_int_eq(table_check_balls(&t, ball, 3, &first, &second, err, sizeof err), -EINVAL);
	ck_assert(first == 2 && second == -1);
	ball[2].pos = (vec2){0.3, NAN};
	ck_assert_int_eq(table_check_balls(&t, ball, 3, &first, &second, err, sizeof err), -EINVAL);
	ball[2].pos.y = 0;
	ball[2].spin[1] = INFINITY;
	ck_assert_int_eq(table_check_balls(&t, ball, 3, &first, &second, err, sizeof err), -EINVAL);
	ck_assert_int_eq(first, 2);
}
END_TEST

static bool is_accepted(const struct table *table, vec2 pos)
{
	struct ball ball = ball_at(COLOUR_RED, pos);
	int first, second;
	char err[200];
	return table_check_balls(table, &ball, 1, &first, &second, err, sizeof err) == 0;
}

static bool is_on_bed(const struct table *table, vec2 pos)
{
	return fabs(pos.x) <= table->length / 2 && fabs(pos.y) <= table->width / 2;
}

/* Slow balls towards the corners: wherever one comes to rest, also between the jaws, a position with it is accepted. */
START_TEST(what_comes_to_rest_is_accepted)
{
	static struct sim sim;
	struct random r = random_begin("what_comes_to_rest_is_accepted");
	struct table table[2] = {scene_thesis_table(), scene_snooker_table()};
	struct model model;
	int beyond = 0;
	ck_assert(model_from_name("real", &model));
	for (int n = 0; n < 20000; n++) {
		const struct table *t = &table[n & 1];
		const struct pocket *p = &t->pocket[n / 2 % t->pocket_count];
		vec2 from = vec2_madd(p->centre, 0.25, vec2_unit(p->normal));
		from = vec2_add(from, (vec2){random_in(&r, -0.08, 0.08), random_in(&r, -0.08, 0.08)});
		vec2 way = vec2_sub(vec2_add(p->centre, (vec2){random_in(&r, -0.09, 0.09), random_in(&r, -0.09, 0.09)}),
				    from);
		struct ball ball = ball_at(COLOUR_RED, from);
		sim_init(&sim, t, &model, &ball, 1);
		sim_strike(&sim, 0, &(struct shot){.angle = atan2(way.y, way.x), .speed = random_in(&r, 0.3, 0.9)});
		sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = 1000}, NULL);
		ball = sim_ball(&sim, 0);
		if (ball.phase == BALL_POTTED)
			continue;
		ck_assert_msg(is_accepted(t, ball.pos), "(%.17g, %.17g) on table %d", ball.pos.x, ball.pos.y, n & 1);
		beyond += !is_on_bed(t, ball.pos);
	}
	ck_assert_int_gt(beyond, 20);
}
END_TEST

/* Beyond the bed nothing lies in a pocket's circle, in a jaw, behind a nose or behind a pocket. */
START_TEST(solid_places_are_refused)
{
	struct random r = random_begin("solid_places_are_refused");
	struct table table[2] = {scene_thesis_table(), scene_snooker_table()};
	int accepted = 0;
	for (int n = 0; n < 200000; n++) {
		const struct table *t = &table[n & 1];
		vec2 pos = {random_in(&r, -0.6, 0.6) * t->length, random_in(&r, -0.6, 0.6) * t->width};
		if (is_on_bed(t, pos) || !is_accepted(t, pos))
			continue;
		accepted++;
		double nearest = INFINITY;
		for (int i = 0; i < t->pocket_count; i++) {
			nearest = fmin(nearest, vec2_dist(pos, t->pocket[i].centre));
			ck_assert(vec2_dist(pos, t->pocket[i].centre) > t->pocket[i].radius);
		}
		ck_assert_msg(nearest < 0.15, "(%g, %g) is %g m from a pocket", pos.x, pos.y, nearest);
		for (int i = 0; i < t->jaw_count; i++)
			ck_assert(vec2_dist(pos, t->jaw[i].centre) > t->jaw[i].radius);
		for (int i = 0; i < t->cushion_count; i++) {
			/* the way there from the middle of the mouth crosses no nose */
			const struct cushion *c = &t->cushion[i];
			double along = vec2_dot(vec2_sub(pos, c->a), c->along);
			if (along >= 0 && along <= c->span)
				ck_assert(vec2_dot(vec2_sub(pos, c->a), c->normal) > 0);
		}
	}
	ck_assert_int_gt(accepted, 20);
	ck_assert(!is_accepted(&table[1], (vec2){-1.66, -0.892})); /* behind the rail, within reach of the jaw */
	ck_assert(!is_accepted(&table[1], (vec2){-1.85, -0.955})); /* behind the pocket's middle */
	struct table box = scene_box_table(2, 1);
	ck_assert(!is_accepted(&box, (vec2){1.0001, 0}));
	ck_assert(is_accepted(&box, (vec2){1, 0.5}));
	/* width is width and length is length */
	ck_assert(!is_accepted(&box, (vec2){0, 0.6}));
	ck_assert(is_accepted(&box, (vec2){0.6, 0}));
}
END_TEST

/* The bed reaches half its length along x and half its width along y, edges included: a step inside, a step outside, on
 * every side. */
START_TEST(the_bed_ends_where_it_should)
{
	struct table t = scene_thesis_table();
	double x = t.length / 2, y = t.width / 2, step = 1e-6;
	const struct {
		vec2 pos;
		bool on;
	} place[] = {
		{{x - step, 0}, true},	{{step - x, 0}, true},	{{x + step, 0}, false}, {{-x - step, 0}, false},
		{{0, y - step}, true},	{{0, step - y}, true},	{{0, y + step}, false}, {{0, -y - step}, false},
		{{x, y}, true},		{{-x, -y}, true},	{{y + step, 0}, true},	{{0, x - step}, false},
		{{x, y + step}, false}, {{x + step, y}, false},
	};
	for (size_t i = 0; i < sizeof place / sizeof *place; i++) {
		struct ball ball = ball_at(COLOUR_RED, place[i].pos);
		int first, second, got = table_check_balls(&t, &ball, 1, &first, &second, NULL, 0);
		ck_assert_msg((got == 0) == place[i].on, "(%g, %g)", place[i].pos.x, place[i].pos.y);
		ck_assert_int_eq(first, place[i].on ? -1 : 0);
	}
}
END_TEST

/* Balls may seem to overlap by a tenth of a millimetre; which two is told in order of their numbers. */
START_TEST(an_overlap_has_a_limit)
{
	struct table t = scene_thesis_table();
	double d = 2 * t.ball_radius;
	for (int k = 0; k < 2; k++) {
		struct ball ball[4] = {ball_at(COLOUR_WHITE, (vec2){0, 0}), ball_at(COLOUR_RED, (vec2){0.3, 0}),
				       ball_at(COLOUR_RED, (vec2){-0.3, 0.1}),
				       ball_at(COLOUR_RED, (vec2){0.3, d - (k ? 1.01e-4 : 0.99e-4)})};
		int first, second;
		ck_assert_int_eq(table_check_balls(&t, ball, 4, &first, &second, NULL, 0), k ? -EINVAL : 0);
		ck_assert_int_eq(first, k ? 1 : -1);
		ck_assert_int_eq(second, k ? 3 : -1);
		ball[1].phase = BALL_POTTED; /* what has fallen is in nobody's way */
		ck_assert_int_eq(table_check_balls(&t, ball, 4, &first, &second, NULL, 0), 0);
	}
}
END_TEST

/* Each constant a step outside of each end of its range: refused by its name. */
START_TEST(each_constant_has_a_range)
{
#define AT(name, low, high)                                                                                            \
	{                                                                                                              \
#name, offsetof(struct material, name), low, high                                                      \
	}
	const struct {
		const char *name;
		size_t offset;
		double low, high;
	} row[] = {
		AT(gravity, 1, 30),	AT(mu_slide, 1e-4, 2),	   AT(mu_roll, 1e-5, 1),      AT(mu_spin, 1e-6, 1),
		AT(loss_ball, 0, 0.99), AT(loss_cushion, 0, 0.99), AT(topspin_factor, 0, 10), AT(e_ball, 0, 1),
		AT(e_cushion, 0, 1),	AT(mu_cushion, 0, 2),	   AT(mu_ball_a, 0, 2),	      AT(mu_ball_b, 0, 2),
		AT(mu_ball_c, 0, 100),	AT(stronge_omega, 0, 100),
	};
#undef AT
	for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
		const double value[] = {row[i].low, row[i].high, nextafter(row[i].low, -INFINITY),
					nextafter(row[i].high, INFINITY), NAN};
		for (int k = 0; k < 5; k++) {
			struct table t = scene_thesis_table();
			char err[200] = "";
			memcpy((char *)&t.material + row[i].offset, &value[k], sizeof value[k]);
			ck_assert_msg(table_finish(&t, err, sizeof err) == (k < 2 ? 0 : -EINVAL), "%s %g", row[i].name,
				      value[k]);
			ck_assert(k < 2 || strncmp(err, row[i].name, strlen(row[i].name)) == 0);
		}
	}
}
END_TEST

/* An end is covered by a jaw whose surface passes within half a millimetre, from either side. */
START_TEST(a_jaw_covers_what_it_touches)
{
	for (int k = -2; k <= 2; k++) {
		struct table t = scene_box_table(2, 1);
		int tips = t.jaw_count;
		t.jaw_count = 1;
		t.jaw[0] = (struct jaw){.centre = {1.05, 0.5}, .radius = 0.05 + 0.3e-3 * k, .nose_height = 0.03};
		ck_assert_int_eq(table_finish(&t, NULL, 0), 0);
		/* its corner is the end of two rails */
		ck_assert_int_eq(t.jaw_count, tips + (abs(k) < 2 ? 0 : 1));
	}
}
END_TEST

/* Whatever can be touched from a place is in a region whose box holds the place. */
START_TEST(regions_leave_nothing_out)
{
	struct table table[2] = {scene_thesis_table(), scene_snooker_table()};
	struct random r = random_begin("regions_leave_nothing_out");
	for (int n = 0; n < 20000; n++) {
		const struct table *t = &table[n & 1];
		vec2 p = {random_in(&r, -0.55, 0.55) * t->length, random_in(&r, -0.55, 0.55) * t->width};
		uint32_t jaws = 0, cushions = 0, pockets = 0;
		for (int i = 0; i < t->region_count; i++) {
			const struct table_region *g = &t->region[i];
			if (p.x < g->low.x || p.x > g->high.x || p.y < g->low.y || p.y > g->high.y)
				continue;
			jaws |= g->jaws;
			cushions |= g->cushions;
			pockets |= g->pockets;
		}
		for (int i = 0; i < t->jaw_count; i++)
			ck_assert(jaws >> i & 1 || vec2_dist(p, t->jaw[i].centre) > t->jaw[i].radius + t->ball_radius);
		for (int i = 0; i < t->pocket_count; i++)
			ck_assert(pockets >> i & 1 || vec2_dist(p, t->pocket[i].centre) > t->pocket[i].radius);
		for (int i = 0; i < t->cushion_count; i++) {
			const struct cushion *c = &t->cushion[i];
			double foot = fmin(fmax(vec2_dot(vec2_sub(p, c->a), c->along), 0), c->span);
			ck_assert(c->main_rail || cushions >> i & 1 ||
				  vec2_dist(p, vec2_madd(c->a, foot, c->along)) > t->ball_radius);
		}
	}
}
END_TEST

/* A region holds the whole of what is looked for in it: a ball that touches any point of it is inside. */
START_TEST(regions_hold_their_parts)
{
	for (int thesis = 0; thesis < 2; thesis++) {
		struct table t = thesis ? scene_thesis_table() : scene_snooker_table();
		for (int i = 0; i < t.pocket_count; i++) {
			const struct table_region *region = &t.region[i];
			for (int k = 0; k < t.cushion_count; k++) {
				const vec2 end[2] = {t.cushion[k].a, t.cushion[k].b};
				for (int e = 0; e < 2 && region->cushions >> k & 1; e++)
					ck_assert_msg(region->low.x < end[e].x - t.ball_radius &&
							      region->low.y < end[e].y - t.ball_radius &&
							      region->high.x > end[e].x + t.ball_radius &&
							      region->high.y > end[e].y + t.ball_radius,
						      "region %d, cushion %d", i, k);
			}
		}
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("table");
	TCase *tcase = tcase_create("table");
	tcase_set_timeout(tcase, 60);
	tcase_add_test(tcase, normals_point_to_the_playing_side);
	tcase_add_test(tcase, regions_hold_their_parts);
	tcase_add_test(tcase, free_ends_get_tips);
	tcase_add_test(tcase, regions_hold_what_is_near);
	tcase_add_test(tcase, bad_tables_are_refused);
	tcase_add_test(tcase, pockets_by_name);
	tcase_add_test(tcase, bad_positions_are_refused);
	tcase_add_test(tcase, what_comes_to_rest_is_accepted);
	tcase_add_test(tcase, solid_places_are_refused);
	tcase_add_test(tcase, the_bed_ends_where_it_should);
	tcase_add_test(tcase, an_overlap_has_a_limit);
	tcase_add_test(tcase, each_constant_has_a_range);
	tcase_add_test(tcase, a_jaw_covers_what_it_touches);
	tcase_add_test(tcase, regions_leave_nothing_out);
	suite_add_tcase(suite, tcase);
	return suite;
}
