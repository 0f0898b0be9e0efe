/* Where a ball may be, and what a whole frame's finds become: on rendered pictures, a step inside and a step outside. */
#include "vision/detector.h"

#include <math.h>
#include <string.h>

#include "vision_scene.h"

static const double mm = 1e-3;
static struct detector detector;
static struct table table;
static struct camera camera;
static struct image_buffer image;

static void setup(void)
{
	table = scene_table();
	camera = scene_camera(0.01, -0.01);
	ck_assert_int_eq(detector_init(&detector, &table, NULL, 1280, 720), 0);
	ck_assert(detector_place(&detector, &camera));
}

static void teardown(void)
{
	detector_finish(&detector);
	image_buffer_finish(&image);
}

static void detect(const struct scene_ball *ball, int count)
{
	struct random r = {7};
	scene_paint(&camera, &table, ball, count, 2, &r, &image);
	ck_assert(detector_frame(&detector, &image.image, &camera));
}

/* In a pocket's hole it has fallen; in its mouth it hangs; beyond the noses it cannot be. */
START_TEST(test_where_a_ball_may_be)
{
	double hx = table.length / 2 - table.ball_radius, hy = table.width / 2 - table.ball_radius;
	ck_assert(detect_possible(&table, (vec2){0, 0}));
	ck_assert(detect_possible(&table, (vec2){0.4, hy + 6.5 * mm}));
	ck_assert(!detect_possible(&table, (vec2){0.4, hy + 7.5 * mm}));
	ck_assert(detect_possible(&table, (vec2){-hx - 6.5 * mm, 0.2}));
	ck_assert(!detect_possible(&table, (vec2){-hx - 7.5 * mm, 0.2}));
	for (int i = 0; i < table.pocket_count; i++) {
		const struct pocket *p = &table.pocket[i];
		vec2 in = vec2_unit(vec2_scale(p->centre, -1));
		ck_assert(!detect_possible(&table, p->centre));
		ck_assert(!detect_possible(&table, vec2_madd(p->centre, 0.78 * p->radius, in)));
		ck_assert(detect_possible(&table, vec2_madd(p->centre, 0.82 * p->radius, in)));
		/* Away from the table the mouth ends, too. */
		ck_assert(detect_possible(&table, vec2_madd(p->centre, -1.58 * p->radius, in)));
		ck_assert(!detect_possible(&table, vec2_madd(p->centre, -1.62 * p->radius, in)));
	}
}
END_TEST

/* Red in the hole of a middle pocket: not reported, in the mouth it is. */
START_TEST(test_ball_in_a_pocket_is_gone)
{
	const struct pocket *p = &table.pocket[1];
	struct scene_ball ball = {{p->centre.x, p->centre.y + 1.1 * p->radius}, {20, 20, 210}};
	detect(&ball, 1);
	ck_assert_int_eq(detector.count, 1);
	ck_assert_double_lt(vec2_dist(detector.candidate[0].fit.pos, ball.pos), 2 * mm);
	ball.pos.y = p->centre.y + 0.7 * p->radius;
	detect(&ball, 1);
	ck_assert_int_eq(detector.count, 0);
}
END_TEST

/* Painted into one another, as no balls lie: told apart, and each as far from the other as balls are. */
START_TEST(test_balls_are_solid)
{
	double d = 2 * table.ball_radius;
	for (int i = 0; i < 3; i++) {
		struct scene_ball ball[2] = {
			{{0, 0.1}, {20, 20, 210}},
			{{(d - i * 1.5 * mm) * cos(i), 0.1 + (d - i * 1.5 * mm) * sin(i)}, {200, 110, 20}}};
		detect(ball, 2);
		ck_assert_int_eq(detector.count, 2);
		ck_assert_double_gt(vec2_dist(detector.candidate[0].fit.pos, detector.candidate[1].fit.pos),
				    d - 0.05 * mm);
		for (int k = 0; k < 2; k++)
			ck_assert_double_lt(fmin(vec2_dist(detector.candidate[k].fit.pos, ball[0].pos),
						 vec2_dist(detector.candidate[k].fit.pos, ball[1].pos)),
					    2.5 * mm);
	}
}
END_TEST

/* What has not moved does not give way to what is fitted beside it. */
START_TEST(test_known_balls_stay)
{
	double d = 2 * table.ball_radius;
	struct scene_ball ball[2] = {{{0, 0.1}, {20, 20, 210}}, {{d - 2 * mm, 0.1}, {200, 110, 20}}};
	detect(ball, 1);
	ck_assert_int_eq(detector.count, 1);
	struct sighting known = detector.candidate[0];
	struct random r = {7};
	scene_paint(&camera, &table, ball, 2, 2, &r, &image);
	ck_assert(scan_frame(&detector.scan, &image.image));
	detector_begin(&detector, &image.image, &camera);
	detector_keep(&detector, &known, 3);
	detector_search(&detector, detector.scan.changed);
	detector_settle(&detector);
	ck_assert_int_eq(detector.count, 2);
	ck_assert_ptr_null(detector.view.frame);
	ck_assert_ptr_null(detector.view.other);
	int kept = detector.candidate[0].tag == 3 ? 0 : 1;
	ck_assert_int_eq(detector.candidate[kept].tag, 3);
	ck_assert_int_eq(detector.candidate[1 - kept].tag, -1);
	ck_assert_double_lt(vec2_dist(detector.candidate[kept].fit.pos, known.fit.pos), 0.01 * mm);
	ck_assert_double_gt(vec2_dist(detector.candidate[0].fit.pos, detector.candidate[1].fit.pos), d - 0.05 * mm);
}
END_TEST

/* ---- hands
 * ----------------------------------------------------------------------------------------------------------- */

static void paint_disc(vec2 mid, double radius)
{
	static const uint8_t SKIN[3] = {110, 140, 205};
	for (int y = (int)(mid.y - radius); y <= mid.y + radius; y++)
		for (int x = (int)(mid.x - radius); x <= mid.x + radius; x++)
			if (x >= 0 && y >= 0 && x < 1280 && y < 720 && hypot(x - mid.x, y - mid.y) <= radius)
				memcpy(image.image.data + y * image.image.stride + 3 * x, SKIN, 3);
}

static void paint_finger(vec2 from, vec2 to, double radius)
{
	for (int i = 0; i <= 40; i++)
		paint_disc(vec2_madd(from, i / 40.0, vec2_sub(to, from)), radius);
}

/* Four fingers as thick as balls and a palm, hanging on an arm from the cushion. */
static void paint_hand(vec2 at, double turn)
{
	paint_finger((vec2){at.x, 0}, at, 40);
	for (int i = 0; i < 4; i++)
		paint_finger(at, vec2_madd(at, 75 + 6 * (i % 2), vec2_from_angle(turn + 0.5 * i)), 15.5);
}

START_TEST(test_a_hand_is_no_ball)
{
	struct random r = random_begin("detector_hand");
	struct scene_ball ball = {{0.6, -0.3}, {20, 20, 210}};
	int ghosts = 0;
	for (int i = 0; i < 25; i++) {
		scene_paint(&camera, &table, &ball, 1, 2, &r, &image);
		paint_hand((vec2){random_in(&r, 250, 800), random_in(&r, 200, 350)}, random_in(&r, 0.2, 1.4));
		ck_assert(detector_frame(&detector, &image.image, &camera));
		ghosts += detector.count - 1;
		bool found = false;
		for (int k = 0; k < detector.count; k++)
			found = found || vec2_dist(detector.candidate[k].fit.pos, ball.pos) < 1 * mm;
		ck_assert(found);
	}
	ck_assert_int_eq(ghosts, 0);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("detector");
	TCase *tc = tcase_create("detector");
	tcase_add_checked_fixture(tc, setup, teardown);
	tcase_add_test(tc, test_where_a_ball_may_be);
	tcase_add_test(tc, test_ball_in_a_pocket_is_gone);
	tcase_add_test(tc, test_balls_are_solid);
	tcase_add_test(tc, test_known_balls_stay);
	tcase_add_test(tc, test_a_hand_is_no_ball);
	tcase_set_timeout(tc, 120);
	suite_add_tcase(suite, tc);
	return suite;
}
