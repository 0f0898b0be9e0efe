#include "harness.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/virtual/table_camera.h"
#include "scenes.h"
#include "vision/markers_cv.h"
#include "vision/pose.h"

/* A small picture keeps these tests fast, also under sanitizers. */
enum { WIDTH = 960, HEIGHT = 540 };

static struct config config;
static char err[200];
static uint8_t pixels[2][3 * WIDTH * HEIGHT];
static struct image frame[2] = {{pixels[0], WIDTH, HEIGHT, 3 * WIDTH}, {pixels[1], WIDTH, HEIGHT, 3 * WIDTH}};

static void fill_config(void)
{
	memset(&config, 0, sizeof(config));
	config.table = scene_thesis_table();
	config.camera = (struct camera_intrinsics){
		.width = WIDTH, .height = HEIGHT, .fx = 687.8, .fy = 687.9, .cx = 487.2, .cy = 269.5};
	config.markers = (struct marker_layout){
		.dictionary_count = 4, .dictionary_bits = 3, .side = 0.05, .height = 0.0381, .count = 4};
	for (int i = 0; i < 4; i++) {
		config.markers.marker[i].id = i;
		config.markers.marker[i].centre = (vec2){i == 0 || i == 3 ? -0.8615 : 0.8605, i < 2 ? -0.543 : 0.542};
	}
	config.projector = (struct config_projector){
		.width = 960, .height = 540, .homography = {450, 0, 480, 0, -450, 270, 0, 0, 1}};
	config.virtual_table = (struct config_virtual){.exposure = 1,
						       .projector_light = 0.35,
						       .seed = 3,
						       .camera_height = 1.535,
						       .camera_x = 0.006,
						       .camera_y = -0.004,
						       .camera_tilt_x = 0.0035,
						       .camera_tilt_y = -0.0026};
}

static struct table_camera *begin(void)
{
	struct table_camera *camera;
	ck_assert_msg(table_camera_create(&camera, &config, err, sizeof(err)) == 0, "%s", err);
	return camera;
}

static int grey(const struct image *image, int x, int y)
{
	const uint8_t *p = image->data + y * image->stride + 3 * x;
	return p[0] + p[1] + p[2];
}

/* ---- geometry ---- */

START_TEST(camera_stands_where_it_is_configured)
{
	fill_config();
	struct table_camera *camera = begin();
	double eye[3];
	vec2 below;
	camera_centre(table_camera_truth(camera), eye);
	ck_assert_double_eq_tol(eye[0], 0.006, 1e-12);
	ck_assert_double_eq_tol(eye[1], -0.004, 1e-12);
	ck_assert_double_eq_tol(eye[2], 1.535 + 0.0381, 1e-12);
	/* tilts move the centre of the view by about height * angle */
	ck_assert(camera_unproject(table_camera_truth(camera), (vec2){config.camera.cx, config.camera.cy}, 0, &below));
	ck_assert_double_eq_tol(vec2_dist(below, (vec2){eye[0], eye[1]}), eye[2] * hypot(0.0035, 0.0026), 1e-4);
	/* +x to the right, +y up */
	vec2 a, b;
	camera_project(table_camera_truth(camera), (vec2){0.5, 0}, 0, &a);
	camera_project(table_camera_truth(camera), (vec2){0, 0.3}, 0, &b);
	ck_assert(a.x > 500 && fabs(a.y - 270) < 10 && b.y < 200 && fabs(b.x - 483) < 10);
	table_camera_destroy(camera);
}
END_TEST

START_TEST(markers_are_seen_where_they_lie)
{
	static const vec2 corner[4] = {{-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}};
	fill_config();
	config.virtual_table.noise = 2;
	struct table_camera *camera = begin();
	struct marker_finder *finder;
	struct marker_view view[MARKER_MAX];
	table_camera_render(camera, NULL, 0, 1, &frame[0]);
	ck_assert_int_eq(marker_finder_create(&finder, 4, 3, err, sizeof(err)), 0);
	ck_assert_int_eq(marker_find(finder, &frame[0], view, MARKER_MAX), 4);
	for (int i = 0; i < 4; i++) {
		/* white paper outshines the black square's rim, as on photographs: it looks smaller, but lies where it
		 * lies */
		vec2 seen = {0, 0}, truth = {0, 0};
		for (int k = 0; k < 4; k++) {
			vec2 px, at = vec2_madd(config.markers.marker[view[i].id].centre, 0.05, corner[k]);
			camera_project(table_camera_truth(camera), at, 0.0381, &px);
			ck_assert_double_le(vec2_dist(px, (vec2){view[i].x[k], view[i].y[k]}), 1);
			seen = vec2_madd(seen, 0.25, (vec2){view[i].x[k], view[i].y[k]});
			truth = vec2_madd(truth, 0.25, px);
		}
		ck_assert_double_le(vec2_dist(seen, truth), 0.25);
	}
	struct camera found = {.in = config.camera};
	struct pose_fit fit;
	double eye[3], truth[3];
	ck_assert(pose_from_markers(&config.markers, view, 4, &found, &fit));
	camera_centre(&found, eye);
	camera_centre(table_camera_truth(camera), truth);
	for (int c = 0; c < 3; c++)
		ck_assert_double_eq_tol(eye[c], truth[c], 0.005);
	marker_finder_destroy(finder);
	table_camera_destroy(camera);
}
END_TEST

enum { RIM = 72 };

/* Rim of the sphere's image, from the cone of rays that touch it: the circle of contact lies in a plane across the line
 * of sight. */
static void silhouette(const struct camera *camera, vec2 pos, double radius, vec2 px[RIM])
{
	double eye[3], d[3], distance, u[3], v[3];
	camera_centre(camera, eye);
	d[0] = eye[0] - pos.x, d[1] = eye[1] - pos.y, d[2] = eye[2] - radius;
	distance = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
	for (int c = 0; c < 3; c++)
		d[c] /= distance;
	double k = 1 / hypot(d[0], d[2]);
	u[0] = d[2] * k, u[1] = 0, u[2] = -d[0] * k;
	v[0] = d[1] * u[2] - d[2] * u[1], v[1] = d[2] * u[0] - d[0] * u[2], v[2] = d[0] * u[1] - d[1] * u[0];
	double ahead = radius * radius / distance, ring = radius * sqrt(1 - radius * radius / distance / distance);
	for (int i = 0; i < RIM; i++) {
		double c = cos(i * 2 * M_PI / RIM), s = sin(i * 2 * M_PI / RIM);
		vec2 at = {pos.x + ahead * d[0] + ring * (c * u[0] + s * v[0]),
			   pos.y + ahead * d[1] + ring * (c * u[1] + s * v[1])};
		camera_project(camera, at, radius + ahead * d[2] + ring * (c * u[2] + s * v[2]), &px[i]);
	}
}

/* What the two frames differ by, bilinear. */
static double difference(vec2 p)
{
	int x = (int)floor(p.x), y = (int)floor(p.y);
	double u = p.x - x, v = p.y - y, d[4];
	for (int k = 0; k < 4; k++)
		d[k] = grey(&frame[0], x + k % 2, y + k / 2) - grey(&frame[1], x + k % 2, y + k / 2);
	return (1 - v) * ((1 - u) * d[0] + u * d[1]) + v * ((1 - u) * d[2] + u * d[3]);
}

/* px along the normal from a rim point to where the difference has fallen to half of what it is 2.5 px inside. */
static double edge_offset(vec2 rim, vec2 normal)
{
	double half = difference(vec2_madd(rim, -2.5, normal)) / 2, s = -2.5;
	while (s < 3 && difference(vec2_madd(rim, s, normal)) > half)
		s += 0.01;
	return s;
}

/* A white and a black ball at one place differ on the ball and nowhere else. */
START_TEST(balls_have_the_outline_of_a_sphere)
{
	struct random random = random_begin("balls_have_the_outline_of_a_sphere");
	fill_config();
	struct table_camera *camera = begin();
	double least = INFINITY, most = -INFINITY;
	for (int i = 0; i < 40; i++) {
		vec2 pos = {random_in(&random, -0.9, 0.9), random_in(&random, -0.44, 0.44)}, rim[RIM], shift = {0, 0};
		double grown = 0;
		struct ball ball = ball_at(COLOUR_WHITE, pos);
		table_camera_render(camera, &ball, 1, 0, &frame[0]);
		ball.colour = COLOUR_BLACK;
		table_camera_render(camera, &ball, 1, 0, &frame[1]);
		silhouette(table_camera_truth(camera), pos, config.table.ball_radius, rim);
		for (int k = 0; k < RIM; k++) {
			vec2 along = vec2_unit(vec2_sub(rim[(k + 1) % RIM], rim[(k + RIM - 1) % RIM])),
			     out = vec2_perp(along);
			vec2 across = vec2_sub(rim[k], rim[(k + RIM / 2) % RIM]);
			out = vec2_dot(out, across) < 0 ? vec2_scale(out, -1) : out;
			double offset = edge_offset(rim[k], out);
			ck_assert_double_lt(fabs(offset), 1);
			shift = vec2_madd(shift, 2 * offset / RIM, out);
			grown += offset / RIM;
		}
		ck_assert_double_le(vec2_norm(shift), 0.1);
		least = fmin(least, grown);
		most = fmax(most, grown);
	}
	/* a ball mirrors the cloth towards its rim, which draws the half level inside: equally much everywhere */
	ck_assert(least > -0.7 && most < 0);
	ck_assert_double_lt(most - least, 0.1);
	table_camera_destroy(camera);
}
END_TEST

/* The rim mirrors what is seen beside it: cloth before cloth, and nothing before the dark of a pocket. A pixel inside
 * of the rim much of that is left. */
START_TEST(rim_mirrors_what_is_behind)
{
	fill_config();
	struct table_camera *camera = begin();
	vec2 pos = {0.887, -0.402}, rim[RIM], middle = {0, 0};
	struct ball ball = ball_at(COLOUR_BLACK, pos);
	table_camera_render(camera, &ball, 1, 0, &frame[0]);
	silhouette(table_camera_truth(camera), pos, config.table.ball_radius, rim);
	for (int k = 0; k < RIM; k++)
		middle = vec2_madd(middle, 1.0 / RIM, rim[k]);
	double before_dark = 0, before_cloth = 0;
	int dark = 0, cloth = 0;
	for (int k = 0; k < RIM; k++) {
		vec2 out = vec2_unit(vec2_sub(rim[k], middle)), beside = vec2_madd(rim[k], 3, out),
		     rather = vec2_madd(rim[k], -1, out);
		int behind = grey(&frame[0], (int)lround(beside.x), (int)lround(beside.y));
		int seen = grey(&frame[0], (int)lround(rather.x), (int)lround(rather.y));
		if (behind < 30) {
			dark++;
			before_dark += seen;
		} else if (behind > 270) {
			cloth++;
			before_cloth += seen;
		}
	}
	ck_assert_int_ge(dark, 8);
	ck_assert_int_ge(cloth, 8);
	ck_assert_double_lt(before_dark / dark, 0.75 * before_cloth / cloth);
	table_camera_destroy(camera);
}
END_TEST

START_TEST(potted_and_far_balls_are_not_seen)
{
	fill_config();
	struct table_camera *camera = begin();
	struct ball ball[3] = {ball_at(COLOUR_RED, (vec2){0, 0}), ball_at(COLOUR_RED, (vec2){7, 3}),
			       ball_at(COLOUR_RED, (vec2){-0.1, -40})};
	ball[0].phase = BALL_POTTED;
	table_camera_render(camera, ball, 3, 0, &frame[0]);
	table_camera_render(camera, NULL, 0, 0, &frame[1]);
	ck_assert_int_eq(memcmp(pixels[0], pixels[1], sizeof(pixels[0])), 0);
	table_camera_destroy(camera);
}
END_TEST

/* The order in the array is not the order of drawing. */
START_TEST(order_of_balls_does_not_matter)
{
	fill_config();
	struct table_camera *camera = begin();
	struct ball ball[SCENE_RACK_COUNT], back[SCENE_RACK_COUNT];
	scene_rack(&config.table, ball);
	for (int i = 0; i < SCENE_RACK_COUNT; i++)
		back[i] = ball[SCENE_RACK_COUNT - 1 - i];
	table_camera_render(camera, ball, SCENE_RACK_COUNT, 0, &frame[0]);
	table_camera_render(camera, back, SCENE_RACK_COUNT, 0, &frame[1]);
	int worst = 0;
	for (size_t i = 0; i < sizeof(pixels[0]); i++)
		worst = abs(pixels[0][i] - pixels[1][i]) > worst ? abs(pixels[0][i] - pixels[1][i]) : worst;
	ck_assert_int_le(worst, 1); /* shadows are multiplied in another order */
	table_camera_destroy(camera);
}
END_TEST

/* ---- light ---- */

static uint32_t picture[540 * 960];

START_TEST(light_falls_where_the_homography_says)
{
	fill_config();
	struct table_camera *camera = begin();
	vec2 at = {0.3, -0.2}, px, sum = {0, 0};
	double n = 0;
	memset(picture, 0, sizeof(picture));
	for (int y = 0; y < 540; y++)
		for (int x = 0; x < 960; x++)
			if (hypot(x + 0.5 - (450 * at.x + 480), y + 0.5 - (-450 * at.y + 270)) < 9)
				picture[y * 960 + x] = 0xffffff;
	table_camera_render(camera, NULL, 0, 0, &frame[1]);
	table_camera_light(camera, picture, 960, 540, 960 * 4);
	table_camera_render(camera, NULL, 0, 0, &frame[0]);
	for (int y = 0; y < HEIGHT; y++)
		for (int x = 0; x < WIDTH; x++) {
			double d = grey(&frame[0], x, y) - grey(&frame[1], x, y);
			sum = vec2_madd(sum, d, (vec2){x, y});
			n += d;
		}
	ck_assert_double_gt(n, 1000);
	camera_project(table_camera_truth(camera), at, 0, &px);
	ck_assert_double_le(vec2_dist(vec2_scale(sum, 1 / n), px), 0.1);
	table_camera_light(camera, NULL, 0, 0, 0);
	table_camera_render(camera, NULL, 0, 0, &frame[0]);
	ck_assert_int_eq(memcmp(pixels[0], pixels[1], sizeof(pixels[0])), 0);
	table_camera_destroy(camera);
}
END_TEST

START_TEST(light_has_its_share_and_throws_shadows)
{
	fill_config();
	struct table_camera *camera = begin();
	vec2 px, shadow;
	struct ball ball = ball_at(COLOUR_RED, (vec2){0, 0});
	for (int i = 0; i < 540 * 960; i++)
		picture[i] = 0xffffff;
	table_camera_render(camera, &ball, 1, 0, &frame[1]);
	table_camera_light(camera, picture, 960, 540, 960 * 4);
	table_camera_render(camera, &ball, 1, 0, &frame[0]);
	camera_project(table_camera_truth(camera), (vec2){0.4, 0.2}, 0, &px);
	int x = (int)px.x, y = (int)px.y;
	double share =
		frame[0].data[y * frame[0].stride + 3 * x + 1] / (double)frame[1].data[y * frame[1].stride + 3 * x + 1];
	ck_assert_double_eq_tol(share, 1.35, 0.02);
	/* the projector stands at -y: the ball keeps its light off the cloth at +y */
	camera_project(table_camera_truth(camera), (vec2){0, 0.036}, 0, &shadow);
	ck_assert_int_lt(grey(&frame[0], (int)(shadow.x + 0.5), (int)(shadow.y + 0.5)), grey(&frame[0], x, y) * 4 / 5);
	table_camera_destroy(camera);
}
END_TEST

START_TEST(exposure_scales_and_clips)
{
	fill_config();
	struct table_camera *camera = begin();
	table_camera_render(camera, NULL, 0, 0, &frame[0]);
	table_camera_destroy(camera);
	config.virtual_table.exposure = 0.5;
	camera = begin();
	table_camera_render(camera, NULL, 0, 0, &frame[1]);
	table_camera_destroy(camera);
	/* half the light: grey levels go with its 2.2nd root */
	ck_assert_double_eq_tol(grey(&frame[1], 480, 270) / (double)grey(&frame[0], 480, 270), pow(0.5, 1 / 2.2), 0.02);
	config.virtual_table.exposure = 20;
	camera = begin();
	table_camera_render(camera, NULL, 0, 0, &frame[1]);
	table_camera_destroy(camera);
	ck_assert_int_eq(grey(&frame[1], 480, 270), 3 * 255);
}
END_TEST

/* ---- sensor ---- */

START_TEST(same_seed_same_pixels)
{
	fill_config();
	config.virtual_table.noise = 2;
	struct ball ball = ball_at(COLOUR_BLUE, (vec2){0.2, 0.1});
	struct table_camera *camera = begin(), *again = begin();
	table_camera_render(camera, &ball, 1, 7, &frame[0]);
	table_camera_render(again, &ball, 1, 3, &frame[1]);
	ck_assert_int_ne(memcmp(pixels[0], pixels[1], sizeof(pixels[0])), 0);
	table_camera_render(again, &ball, 1, 7, &frame[1]);
	ck_assert_int_eq(memcmp(pixels[0], pixels[1], sizeof(pixels[0])), 0);
	table_camera_destroy(camera);
	table_camera_destroy(again);
}
END_TEST

START_TEST(noise_has_its_sigma)
{
	fill_config();
	config.virtual_table.noise = 3;
	struct table_camera *camera = begin();
	double sum = 0, sum2 = 0, n = 0;
	for (int k = 0; k < 4; k++) {
		table_camera_render(camera, NULL, 0, (uint64_t)(2 * k), &frame[0]);
		table_camera_render(camera, NULL, 0, (uint64_t)(2 * k + 1), &frame[1]);
		for (int y = 200; y < 300; y++)
			for (int x = 3 * 300; x < 3 * 600; x++) {
				double d = pixels[0][y * 3 * WIDTH + x] - pixels[1][y * 3 * WIDTH + x];
				sum += d, sum2 += d * d, n++;
			}
	}
	ck_assert_double_eq_tol(sum / n, 0, 0.05);
	/* two frames, each with the noise and the rounding to whole levels */
	ck_assert_double_eq_tol(sqrt(sum2 / n / 2), sqrt(9 + 1.0 / 12), 0.1);
	table_camera_destroy(camera);
}
END_TEST

/* ---- bad configurations ---- */

static void refused(const char *part)
{
	struct table_camera *camera;
	ck_assert_int_eq(table_camera_create(&camera, &config, err, sizeof(err)), -EINVAL);
	ck_assert_ptr_null(camera);
	ck_assert_msg(strstr(err, part) != NULL, "%s", err);
}

START_TEST(bad_configurations_are_refused)
{
	fill_config(), config.camera.width = 0, refused("camera");
	fill_config(), config.camera.fx = NAN, refused("camera");
	fill_config(), config.virtual_table.exposure = NAN, refused("exposure");
	fill_config(), config.virtual_table.camera_height = 0, refused("camera_height");
	fill_config(), config.projector.height = 100000, refused("projector");
	fill_config(), config.markers.marker[2].id = 4, refused("id 4");
	table_camera_destroy(NULL);
}
END_TEST

/* A camera that sees beside the table, upside down or past the horizon shows something and does not fall over. */
START_TEST(odd_poses_work)
{
	static const double tilt[][2] = {{0.6, 0}, {0, 1.2}, {3.1, 0}, {0.7, -0.7}};
	for (size_t i = 0; i < sizeof(tilt) / sizeof(tilt[0]); i++) {
		struct ball ball = ball_at(COLOUR_BLUE, (vec2){0.2, 0.1});
		fill_config();
		config.virtual_table.camera_tilt_x = tilt[i][0];
		config.virtual_table.camera_tilt_y = tilt[i][1];
		struct table_camera *camera = begin();
		table_camera_render(camera, &ball, 1, 0, &frame[0]);
		table_camera_destroy(camera);
	}
}
END_TEST

/* ---- what moves, and what hides ---- */

static const struct ball flying = {.pos = {0.1, 0.05}, .vel = {4, 0}, .phase = BALL_ROLLING, .colour = COLOUR_WHITE};

/* Middle and half width along x (px) of what a ball changed in the row through its middle. */
static void changed_row(const struct image *without, const struct image *with, int row, double out[2])
{
	double sum = 0, first = 0, second = 0;
	for (int x = 0; x < WIDTH; x++) {
		double d = fmax(0, grey(with, x, row) - grey(without, x, row));
		sum += d, first += d * x, second += d * x * x;
	}
	out[0] = first / sum;
	out[1] = sqrt(second / sum - out[0] * out[0]);
}

START_TEST(a_ball_at_rest_has_no_blur)
{
	struct ball ball = ball_at(COLOUR_RED, (vec2){0.2, 0.1});
	fill_config();
	struct table_camera *sharp = begin();
	config.virtual_table.exposure_time = 0.008;
	config.virtual_table.shutter_time = 0.02;
	struct table_camera *camera = begin();
	table_camera_render(sharp, &ball, 1, 1, &frame[0]);
	table_camera_render(camera, &ball, 1, 1, &frame[1]);
	ck_assert_mem_eq(frame[0].data, frame[1].data, (size_t)frame[0].stride * HEIGHT);
	table_camera_destroy(sharp);
	table_camera_destroy(camera);
}
END_TEST

START_TEST(a_moving_ball_is_blurred_around_its_place)
{
	double sharp[2] = {0}, blurred[2] = {0};
	vec2 px, ahead;
	fill_config();
	for (int k = 0; k < 2; k++) {
		config.virtual_table.exposure_time = k ? 0.008 : 0;
		struct table_camera *camera = begin();
		table_camera_render(camera, NULL, 0, 1, &frame[0]);
		table_camera_render(camera, &flying, 1, 1, &frame[1]);
		camera_project(table_camera_truth(camera), flying.pos, 0.026, &px);
		camera_project(table_camera_truth(camera), vec2_add(flying.pos, (vec2){0.032, 0}), 0.026, &ahead);
		changed_row(&frame[0], &frame[1], (int)px.y, k ? blurred : sharp);
		table_camera_destroy(camera);
	}
	/* 32 mm of way in the exposure: uniform over it, its deviation is 1/sqrt(12) of the way */
	double way = (ahead.x - px.x) / sqrt(12);
	ck_assert_double_eq_tol(blurred[0], sharp[0], 0.5);
	ck_assert_double_eq_tol(blurred[1], hypot(sharp[1], way), 0.6);
}
END_TEST

/* The upper rows are exposed earlier: a ball there is seen where it was. */
START_TEST(a_rolling_shutter_sees_the_upper_rows_earlier)
{
	double at[2][2][2];
	fill_config();
	config.virtual_table.exposure_time = 0.001;
	for (int k = 0; k < 2; k++)
		for (int side = 0; side < 2; side++) {
			struct ball ball = flying;
			vec2 px;
			ball.pos.y = side ? 0.35 : -0.35; /* up in the picture, down */
			config.virtual_table.shutter_time = k ? 0.02 : 0;
			struct table_camera *camera = begin();
			table_camera_render(camera, NULL, 0, 1, &frame[0]);
			table_camera_render(camera, &ball, 1, 1, &frame[1]);
			camera_project(table_camera_truth(camera), ball.pos, 0.026, &px);
			changed_row(&frame[0], &frame[1], (int)px.y, at[k][side]);
			table_camera_destroy(camera);
		}
	ck_assert_double_lt(at[1][1][0], at[0][1][0] - 5);
	ck_assert_double_gt(at[1][0][0], at[0][0][0] + 5);
}
END_TEST

START_TEST(an_arm_hides_what_lies_below_it_and_nothing_far)
{
	struct ball ball = ball_at(COLOUR_WHITE, (vec2){0.3, 0.1});
	struct table_disturbance d = {.arm = {true, true, {0.25, 0.1}, {0.05, 0.1}, {-0.7, 0.1}}, .gain = 1};
	fill_config();
	struct table_camera *camera = begin();
	vec2 far, sleeve;
	table_camera_render(camera, &ball, 1, 1, &frame[0]);
	table_camera_disturb(camera, &d);
	table_camera_render(camera, &ball, 1, 1, &frame[1]);
	camera_project(table_camera_truth(camera), (vec2){0.6, -0.3}, 0, &far);
	camera_project(table_camera_truth(camera), (vec2){-0.3, 0.1}, 0.12, &sleeve);
	ck_assert_int_eq(grey(&frame[1], (int)far.x, (int)far.y), grey(&frame[0], (int)far.x, (int)far.y));
	ck_assert_int_lt(grey(&frame[1], (int)sleeve.x, (int)sleeve.y), 200);
	table_camera_disturb(camera, NULL);
	table_camera_render(camera, &ball, 1, 1, &frame[1]);
	ck_assert_mem_eq(frame[0].data, frame[1].data, (size_t)frame[0].stride * HEIGHT);
	table_camera_destroy(camera);
}
END_TEST

START_TEST(gain_and_a_turned_camera)
{
	fill_config();
	struct table_camera *camera = begin();
	table_camera_render(camera, NULL, 0, 1, &frame[0]);
	table_camera_disturb(camera, &(struct table_disturbance){.gain = 0.125});
	table_camera_render(camera, NULL, 0, 1, &frame[1]);
	ck_assert_int_lt(grey(&frame[1], 480, 270), grey(&frame[0], 480, 270) / 2);
	for (int k = 0; k < 4; k++) {
		int dx = k & 1 ? 5 : -5, dy = k & 2 ? 3 : -3;
		table_camera_disturb(camera, &(struct table_disturbance){.gain = 1, .shift_x = dx, .shift_y = dy});
		table_camera_render(camera, NULL, 0, 1, &frame[1]);
		for (int y = 20; y < HEIGHT - 20; y += 7)
			ck_assert_mem_eq(frame[1].data + y * frame[1].stride + 3 * 20,
					 frame[0].data + (y - dy) * frame[0].stride + 3 * (20 - dx), 3 * (WIDTH - 40));
	}
	table_camera_destroy(camera);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("table_camera");
	TCase *geometry = tcase_create("geometry"), *light = tcase_create("light"), *sensor = tcase_create("sensor");
	tcase_set_timeout(geometry, 60);
	tcase_set_timeout(light, 60);
	tcase_set_timeout(sensor, 60);
	tcase_add_test(geometry, camera_stands_where_it_is_configured);
	tcase_add_test(geometry, markers_are_seen_where_they_lie);
	tcase_add_test(geometry, balls_have_the_outline_of_a_sphere);
	tcase_add_test(geometry, rim_mirrors_what_is_behind);
	tcase_add_test(geometry, potted_and_far_balls_are_not_seen);
	tcase_add_test(geometry, order_of_balls_does_not_matter);
	tcase_add_test(geometry, odd_poses_work);
	tcase_add_test(light, light_falls_where_the_homography_says);
	tcase_add_test(light, light_has_its_share_and_throws_shadows);
	tcase_add_test(light, exposure_scales_and_clips);
	tcase_add_test(sensor, same_seed_same_pixels);
	tcase_add_test(sensor, noise_has_its_sigma);
	tcase_add_test(sensor, bad_configurations_are_refused);
	tcase_add_test(sensor, a_ball_at_rest_has_no_blur);
	tcase_add_test(sensor, a_moving_ball_is_blurred_around_its_place);
	tcase_add_test(sensor, a_rolling_shutter_sees_the_upper_rows_earlier);
	tcase_add_test(sensor, an_arm_hides_what_lies_below_it_and_nothing_far);
	tcase_add_test(sensor, gain_and_a_turned_camera);
	suite_add_tcase(suite, geometry);
	suite_add_tcase(suite, light);
	suite_add_tcase(suite, sensor);
	return suite;
}
