/* The realistic contact laws against resolutions that another simulator recorded, and Mathavan's law against 180
 * rebounds that were integrated in small steps. Skipped where the data are not there. */
#include "harness.h"

#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "physics/contact_real.h"

static double number(const json_t *object, const char *key)
{
	return json_number_value(json_object_get(object, key));
}

static json_t *load(const char *test, const char *name)
{
	const char *folder = test_data_folder(test);
	if (!folder)
		return NULL;
	char path[512];
	snprintf(path, sizeof path, "%s/shots/%s", folder, name);
	json_t *root = json_load_file(path, 0, NULL);
	ck_assert_ptr_nonnull(root);
	return root;
}

static struct table recorded_table(const json_t *params)
{
	struct table t = {.ball_radius = number(params, "R"), .ball_mass = number(params, "m")};
	t.material = (struct material){
		.gravity = number(params, "g"),
		.mu_slide = number(params, "u_s"),
		.e_ball = number(params, "e_b"),
		.e_cushion = number(params, "e_c"),
		.mu_cushion = number(params, "f_c"),
		.mu_ball_a = 0.009951,
		.mu_ball_b = 0.108,
		.mu_ball_c = 1.088,
		.stronge_omega = 1.8,
	};
	return t;
}

static struct ball recorded_ball(const json_t *event, const char *when, const char *id)
{
	const json_t *b = json_object_get(json_object_get(event, when), id);
	const json_t *r = json_object_get(b, "r"), *v = json_object_get(b, "v"), *w = json_object_get(b, "w");
	struct ball ball = {
		.pos = {json_number_value(json_array_get(r, 0)), json_number_value(json_array_get(r, 1))},
		.vel = {json_number_value(json_array_get(v, 0)), json_number_value(json_array_get(v, 1))},
	};
	for (size_t i = 0; i < 3; i++)
		ball.spin[i] = json_number_value(json_array_get(w, i));
	return ball;
}

/* Largest difference in m/s, spin counted at the surface, relative to the speeds before. */
static double relative_difference(const struct table *t, const struct ball *a, const struct ball *b, double speed)
{
	double d = vec2_dist(a->vel, b->vel);
	for (int i = 0; i < 3; i++)
		d = fmax(d, t->ball_radius * fabs(a->spin[i] - b->spin[i]));
	return d / speed;
}

/* After resolving, the recording simulator moves a tenth of the faster ball's speed along the line of centres to the
 * slower one where two balls move nearly alike. It raises the energy and is no part of the law; here it is done to the
 * law's result before comparing. */
static bool recorder_parts_slow_pairs(struct ball *a, struct ball *b)
{
	vec2 n = vec2_unit(vec2_sub(b->pos, a->pos));
	double va = vec2_dot(n, a->vel), vb = vec2_dot(n, b->vel);
	double alike = vec2_dot(a->vel, b->vel) / (vec2_norm(a->vel) * vec2_norm(b->vel));
	if (!(fabs(vb - va) < 0.01 && alike > 0.9))
		return false;
	double taken = 0.1 * (va > vb ? va : -vb);
	a->vel = vec2_madd(a->vel, -taken, n);
	b->vel = vec2_madd(b->vel, taken, n);
	return true;
}

struct tally {
	double worst[3];
	int count[3], parted;
};

static void check_balls(const struct table *t, const json_t *event, const char *first, const char *second,
			struct tally *tally)
{
	struct ball a = recorded_ball(event, "pre", first), b = recorded_ball(event, "pre", second);
	struct ball want_a = recorded_ball(event, "post", first), want_b = recorded_ball(event, "post", second);
	double speed = vec2_norm(a.vel) + vec2_norm(b.vel);
	/* The recorder moves the balls apart by its spacer before it resolves: the line of centres is that of the post
	 * state. */
	a.pos = want_a.pos;
	b.pos = want_b.pos;
	contact_ball_frictional(t, &a, &b);
	tally->parted += recorder_parts_slow_pairs(&a, &b);
	tally->count[0]++;
	tally->worst[0] = fmax(tally->worst[0], relative_difference(t, &a, &want_a, speed));
	tally->worst[0] = fmax(tally->worst[0], relative_difference(t, &b, &want_b, speed));
}

static const json_t *cushion_by_id(const json_t *table, const char *kind, const char *id)
{
	size_t i;
	const json_t *c;
	json_array_foreach(json_object_get(table, kind), i,
			   c) if (strcmp(json_string_value(json_object_get(c, "id")), id) == 0) return c;
	ck_abort_msg("no cushion %s", id);
	return NULL;
}

static void check_cushion(const struct table *t, const json_t *json_table, const json_t *event, bool circular,
			  double kiss, struct tally *tally)
{
	const json_t *ids = json_object_get(event, "ids");
	const char *id = json_string_value(json_array_get(ids, 0));
	const json_t *c =
		cushion_by_id(json_table, circular ? "circular" : "linear", json_string_value(json_array_get(ids, 1)));
	struct ball ball = recorded_ball(event, "pre", id), want = recorded_ball(event, "post", id);
	double speed = vec2_norm(ball.vel), r = t->ball_radius, distance = r + kiss;
	vec2 normal = vec2_unit((vec2){number(c, "lx"), number(c, "ly")});
	if (circular) {
		normal = vec2_unit(vec2_sub(want.pos, (vec2){number(c, "a"), number(c, "b")}));
		distance += number(c, "radius");
	}
	if (vec2_dot(normal, ball.vel) > 0)
		normal = vec2_scale(normal, -1);
	/* The recorder's contact normal points from the nose line, or a jaw's axis at nose height, to the ball's
	 * centre. */
	struct nose nose = table_nose(t, normal, r + (number(c, "height") - r) * r / distance);
	contact_cushion_stronge(t, &nose, &ball);
	tally->count[1 + circular]++;
	tally->worst[1 + circular] = fmax(tally->worst[1 + circular], relative_difference(t, &ball, &want, speed));
}

static void check_event(const struct table *t, const json_t *json_table, const json_t *event, double kiss,
			struct tally *tally)
{
	const char *type = json_string_value(json_object_get(event, "type"));
	const json_t *ids = json_object_get(event, "ids");
	if (strcmp(type, "ball_ball") == 0)
		check_balls(t, event, json_string_value(json_array_get(ids, 0)),
			    json_string_value(json_array_get(ids, 1)), tally);
	else if (strcmp(type, "ball_linear_cushion") == 0)
		check_cushion(t, json_table, event, false, kiss, tally);
	else if (strcmp(type, "ball_circular_cushion") == 0)
		check_cushion(t, json_table, event, true, kiss, tally);
}

START_TEST(every_recorded_resolution_is_reproduced)
{
	json_t *root = load("every_recorded_resolution_is_reproduced", "pooltool_shots.json");
	if (!root)
		return;
	struct tally tally = {{0}, {0}, 0};
	size_t i, k;
	json_t *shot, *event;
	json_array_foreach(json_object_get(root, "shots"), i, shot)
	{
		const char *name = json_string_value(json_object_get(shot, "set"));
		if (strncmp(name, "default_", 8) != 0)
			continue;
		const json_t *set = json_object_get(json_object_get(root, "sets"), name);
		const char *table = json_string_value(json_object_get(set, "table"));
		const json_t *json_table = json_object_get(json_object_get(root, "tables"), table);
		struct table t = recorded_table(json_object_get(set, "ball_params"));
		json_array_foreach(json_object_get(shot, "events"), k, event)
			check_event(&t, json_table, event, number(set, "kiss"), &tally);
	}
	const char *what[3] = {"ball on ball", "cushion", "jaw"};
	for (int n = 0; n < 3; n++) {
		printf("%s: %d resolutions, worst %.2g relative\n", what[n], tally.count[n], tally.worst[n]);
		ck_assert_int_gt(tally.count[n], 0);
		ck_assert_double_le(tally.worst[n], 1e-9);
	}
	printf("%d slow pairs were parted by the recorder's own rule\n", tally.parted);
	json_decref(root);
}
END_TEST

START_TEST(mathavan_rebounds_are_reproduced)
{
	const char *folder = test_data_folder("mathavan_rebounds_are_reproduced");
	if (!folder)
		return;
	char path[512], line[512];
	snprintf(path, sizeof path, "%s/shots/mathavan_rebounds.csv", folder);
	FILE *file = fopen(path, "r");
	ck_assert_ptr_nonnull(file);
	struct table t = {.ball_radius = 0.02625, .ball_mass = 0.1406};
	t.material = (struct material){.gravity = 9.81, .mu_slide = 0.212, .e_cushion = 0.98, .mu_cushion = 0.14};
	double worst_speed = 0, worst_spin = 0;
	int count = 0;
	while (fgets(line, sizeof line, file)) {
		double v, alpha, top, side, vx, vy, w[3];
		if (sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &v, &alpha, &top, &side, &vx, &vy, &w[0], &w[1],
			   &w[2]) != 9)
			continue;
		alpha *= M_PI / 180;
		struct ball b = {.vel = {v * cos(alpha), v * sin(alpha)},
				 .spin = {-top * sin(alpha), top * cos(alpha), side}};
		struct nose nose = table_nose(&t, (vec2){0, -1}, 0.03675);
		contact_cushion_mathavan(&t, &nose, &b);
		worst_speed = fmax(worst_speed, fmax(fabs(b.vel.x - vx), fabs(b.vel.y - vy)));
		for (int i = 0; i < 3; i++)
			worst_spin = fmax(worst_spin, fabs(b.spin[i] - w[i]));
		count++;
	}
	fclose(file);
	printf("%d rebounds, worst %.2g m/s and %.2g rad/s\n", count, worst_speed, worst_spin);
	ck_assert_int_gt(count, 0);
	ck_assert_double_le(worst_speed, 1e-3);
	ck_assert_double_le(worst_spin, 0.1);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("contact_recorded");
	TCase *all = tcase_create("recorded");
	tcase_add_test(all, every_recorded_resolution_is_reproduced);
	tcase_add_test(all, mathavan_rebounds_are_reproduced);
	suite_add_tcase(suite, all);
	return suite;
}
