/* Ways, mirrors and room for the cue against their definitions. */
#include "harness.h"
#include "scenes.h"

#include "search/geometry.h"

static vec2 random_place(struct random *random, const struct table *table)
{
	double x = table->length / 2 - table->ball_radius, y = table->width / 2 - table->ball_radius;
	return (vec2){random_in(random, -x, x), random_in(random, -y, y)};
}

START_TEST(segment_distance)
{
	struct random random = random_begin("segment_distance");
	for (int n = 0; n < 2000; n++) {
		vec2 a = {random_in(&random, -1, 1), random_in(&random, -1, 1)};
		vec2 b = {random_in(&random, -1, 1), random_in(&random, -1, 1)};
		vec2 p = {random_in(&random, -1, 1), random_in(&random, -1, 1)};
		double least = INFINITY;
		for (int i = 0; i <= 1000; i++)
			least = fmin(least, vec2_dist(vec2_madd(a, i / 1000.0, vec2_sub(b, a)), p));
		double d = sqrt(segment_distance2(a, b, p));
		ck_assert(d <= least + 1e-12);
		ck_assert(least - d < 2e-3);
	}
	vec2 a = {1, 2};
	ck_assert_double_eq_tol(segment_distance2(a, a, (vec2){4, 6}), 25, 1e-12);
}
END_TEST

START_TEST(four_mirrors)
{
	struct table table = scene_thesis_table();
	struct mirrors mirrors;
	mirrors_init(&mirrors, &table);
	ck_assert_int_eq(mirrors.count, 4);
	ck_assert_int_eq(mirrors.sequence_count[0], 1);
	ck_assert_int_eq(mirrors.sequence_count[1], 5);
	ck_assert_int_eq(mirrors.sequence_count[2], 17);
	ck_assert_int_eq(mirrors.sequence_count[3], 53);
	int spans = 0;
	for (int i = 0; i < 4; i++) {
		const struct mirror *m = &mirrors.mirror[i];
		spans += m->span_count;
		double half = fabs(m->normal.x) > 0.5 ? table.length / 2 : table.width / 2;
		ck_assert_double_eq_tol(-vec2_dot(m->point, m->normal), half - table.ball_radius, 1e-9);
	}
	ck_assert_int_eq(spans, 6);
}
END_TEST

/* Angle of incidence equals angle of reflection; the way is as long as the straight line to the image; cushions are met
 * in front. */
START_TEST(ways_are_reflections)
{
	struct random random = random_begin("ways_are_reflections");
	struct table table = scene_thesis_table();
	struct mirrors mirrors;
	mirrors_init(&mirrors, &table);
	int built = 0;
	for (int n = 0; n < 500; n++) {
		vec2 from = random_place(&random, &table), to = random_place(&random, &table);
		struct images images;
		images_init(&images, &mirrors, to, (vec2){1, 0}, 3);
		for (int s = 0; s < images.count; s++) {
			struct way way;
			if (!images.valid[s] || !way_build(&way, &mirrors, &images, s, from))
				continue;
			built++;
			ck_assert_int_eq(way.rails, mirrors.sequence[s].length);
			double length = 0;
			for (int i = 0; i <= way.rails; i++)
				length += way.leg[i];
			ck_assert_double_eq_tol(length, vec2_dist(images.at[s], from), 1e-9);
			for (int i = 0; i < way.rails; i++) {
				vec2 in = vec2_unit(vec2_sub(way.point[i + 1], way.point[i]));
				vec2 out = vec2_unit(vec2_sub(way.point[i + 2], way.point[i + 1]));
				ck_assert_double_eq_tol(vec2_dot(in, way.normal[i]), -vec2_dot(out, way.normal[i]),
							1e-9);
				ck_assert(vec2_dot(out, way.normal[i]) > 0);
			}
			ck_assert(vec2_dist(way.point[way.rails + 1], to) < 1e-12);
		}
	}
	ck_assert_int_gt(built, 5000);
}
END_TEST

/* The way back over the same cushions is the same way. */
START_TEST(ways_are_reversible)
{
	struct random random = random_begin("ways_are_reversible");
	struct table table = scene_thesis_table();
	struct mirrors mirrors;
	mirrors_init(&mirrors, &table);
	for (int n = 0; n < 300; n++) {
		vec2 a = random_place(&random, &table), b = random_place(&random, &table);
		struct images there, back;
		images_init(&there, &mirrors, b, (vec2){1, 0}, 3);
		images_init(&back, &mirrors, a, (vec2){1, 0}, 3);
		int count_there = 0, count_back = 0;
		double sum_there = 0, sum_back = 0;
		for (int s = 0; s < there.count; s++) {
			struct way way;
			if (there.valid[s] && way_build(&way, &mirrors, &there, s, a)) {
				count_there++;
				sum_there += vec2_dist(there.at[s], a);
			}
			if (back.valid[s] && way_build(&way, &mirrors, &back, s, b)) {
				count_back++;
				sum_back += vec2_dist(back.at[s], b);
			}
		}
		ck_assert_int_eq(count_there, count_back);
		ck_assert_double_eq_tol(sum_there, sum_back, 1e-9);
	}
}
END_TEST

START_TEST(no_mirror_behind_the_target)
{
	struct table table = scene_thesis_table();
	struct mirrors mirrors;
	mirrors_init(&mirrors, &table);
	/* a middle pocket lies behind the long cushions' line: none of them leads there */
	int pocket = table_pocket(&table, "TOP-CENTER");
	struct images images;
	images_init(&images, &mirrors, table.pocket[pocket].centre, (vec2){0, 1}, 1);
	for (int s = 1; s < images.count; s++)
		if (mirrors.mirror[mirrors.sequence[s].mirror].normal.y < -0.5)
			ck_assert(!images.valid[s]);
}
END_TEST

START_TEST(room_for_the_cue)
{
	struct table table = scene_thesis_table();
	struct cost_profile profile = cost_profile_thesis();
	double least = profile.cue_clearance + table.ball_radius;
	struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){0, 0}), ball_at(COLOUR_RED, (vec2){-0.03, least + 1e-6})};
	ck_assert(cue_has_room(&table, &profile, &(struct obstacles){ball, 2, 2}, ball[0].pos, (vec2){1, 0}));
	ball[1].pos.y = least - 1e-6;
	ck_assert(!cue_has_room(&table, &profile, &(struct obstacles){ball, 2, 2}, ball[0].pos, (vec2){1, 0}));
	ball[1].pos = (vec2){-profile.cue_room - least - 1e-6, 0};
	ck_assert(cue_has_room(&table, &profile, &(struct obstacles){ball, 2, 2}, ball[0].pos, (vec2){1, 0}));
	ball[1].phase = BALL_POTTED;
	ball[1].pos = (vec2){-0.03, 0};
	ck_assert(cue_has_room(&table, &profile, &(struct obstacles){ball, 2, 2}, ball[0].pos, (vec2){1, 0}));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("geometry");
	TCase *tc = tcase_create("geometry");
	tcase_set_timeout(tc, 30);
	tcase_add_test(tc, segment_distance);
	tcase_add_test(tc, four_mirrors);
	tcase_add_test(tc, ways_are_reflections);
	tcase_add_test(tc, ways_are_reversible);
	tcase_add_test(tc, no_mirror_behind_the_target);
	tcase_add_test(tc, room_for_the_cue);
	suite_add_tcase(suite, tc);
	return suite;
}
