#include "harness.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shot_compare.h"

/* A table of four rails, one pocket and one jaw, two balls; every part replaced by the tests that break it. */
struct parts {
	const char *table, *params, *models, *cue, *balls, *post_strike;
};

static const struct parts GOOD = {
	.table = "{\"w\":1,\"l\":2,\"linear\":["
		 "{\"id\":\"left\",\"p1\":[0,0,0.03],\"p2\":[0,2,0.03],\"height\":0.03},"
		 "{\"id\":\"right\",\"p1\":[1,2,0.03],\"p2\":[1,0,0.03],\"height\":0.03},"
		 "{\"id\":\"top\",\"p1\":[0,2,0.03],\"p2\":[1,2,0.03],\"height\":0.03},"
		 "{\"id\":\"bottom\",\"p1\":[0,0,0.03],\"p2\":[1,0,0.03],\"height\":0.03}],"
		 "\"circular\":[{\"id\":\"jaw\",\"a\":-0.03,\"b\":1,\"radius\":0.05,\"height\":0.03}],"
		 "\"pockets\":[{\"id\":\"hole\",\"a\":0.9,\"b\":1.9,\"radius\":0.05}]}",
	.params =
		"{\"m\":0.14,\"R\":0.026,\"u_s\":0.2,\"u_r\":0.01,\"u_sp\":0.01,\"u_b\":0.05,\"e_b\":0.95,\"e_c\":0.85,"
		"\"f_c\":0.2,\"g\":9.81}",
	.models = "{\"ball_ball\":\"FrictionlessElastic()\",\"ball_linear_cushion\":\"UnrealisticLinear(restitution="
		  "True)\"}",
	.cue = "{\"ball\":\"cue\"}",
	.balls = "{\"cue\":{\"s\":0,\"r\":[0.5,0.5,0.026],\"v\":[0,0,0],\"w\":[0,0,0]},"
		 "\"b1\":{\"s\":0,\"r\":[0.5,1.5,0.026],\"v\":[0,0,0],\"w\":[0,0,0]}}",
	.post_strike = "{\"s\":2,\"r\":[0.5,0.5,0.026],\"v\":[0,3,0],\"w\":[1,2,3]}",
};

static int parse(const struct parts *p, struct shot_file *file, char err[300])
{
	char text[8192];
	int size = snprintf(
		text, sizeof text,
		"{\"table\":%s,\n\"params\":%s,\n\"models\":%s,\n\"cue\":%s,\n\"balls\":%s,\n\"post_strike\":%s}",
		p->table, p->params, p->models, p->cue, p->balls, p->post_strike);
	return shot_file_parse(file, "shot", text, (size_t)size, err, 300);
}

START_TEST(frame_is_turned_and_moved)
{
	static struct shot_file f;
	char err[300] = "";
	ck_assert_msg(parse(&GOOD, &f, err) == 0, "%s", err);
	ck_assert_int_eq(f.ball_count, 2);
	ck_assert_str_eq(f.ball_id[0], "cue");
	/* (0.5, 0.5) of 1 x 2 lies in the middle of the width and half a metre before the middle of the length. */
	ck_assert_double_eq_tol(f.ball[0].pos.x, -0.5, 1e-15);
	ck_assert_double_eq_tol(f.ball[0].pos.y, 0, 1e-15);
	ck_assert_double_eq_tol(f.ball[0].vel.x, 3, 1e-15);
	ck_assert_double_eq_tol(f.ball[0].spin[0], 2, 1e-15);
	ck_assert_double_eq_tol(f.ball[0].spin[1], -1, 1e-15);
	ck_assert_double_eq_tol(f.ball[0].spin[2], 3, 1e-15);
	ck_assert_int_eq(f.ball[0].colour, COLOUR_WHITE);
	ck_assert_int_eq(f.ball[0].phase, BALL_SLIDING);
	ck_assert_int_eq(f.ball[1].phase, BALL_REST);
	ck_assert_int_eq(f.model.ball, BALL_MODEL_ELASTIC);
	ck_assert_int_eq(f.model.cushion, CUSHION_MODEL_RESTITUTION);
	ck_assert_int_eq(f.table.jaw_count, 1);
	for (int i = 0; i < 4; i++)
		ck_assert(f.table.cushion[i].main_rail);
	ck_assert_double_eq_tol(f.table.material.mu_spin, 0.01 * 0.026, 1e-18);
}
END_TEST

START_TEST(models_are_known_by_their_names)
{
	static struct shot_file f;
	char err[300] = "";
	struct parts p = GOOD;
	p.models = "{\"ball_ball\":\"FrictionalInelastic(friction=AlciatoreBallBallFriction(a=0.01, b=0.2, c=1.5))\","
		   "\"ball_linear_cushion\":\"StrongeCompliantLinear(omega_ratio=1.7)\"}";
	ck_assert_int_eq(parse(&p, &f, err), 0);
	ck_assert_int_eq(f.model.ball, BALL_MODEL_FRICTIONAL);
	ck_assert_int_eq(f.model.cushion, CUSHION_MODEL_STRONGE);
	ck_assert_double_eq(f.table.material.mu_ball_b, 0.2);
	ck_assert_double_eq(f.table.material.stronge_omega, 1.7);
	p.models = "{\"ball_ball\":\"FrictionalInelastic(friction=AverageBallBallFriction())\","
		   "\"ball_linear_cushion\":\"Mathavan2010Linear(max_steps=5000, delta_p=0.0001)\"}";
	ck_assert_int_eq(parse(&p, &f, err), 0);
	ck_assert_int_eq(f.model.cushion, CUSHION_MODEL_MATHAVAN);
	ck_assert_double_eq(f.table.material.mu_ball_a, 0.05);
	ck_assert_double_eq(f.table.material.mu_ball_b, 0);
}
END_TEST

struct refusal {
	struct parts parts;
	const char *reason;
};

START_TEST(bad_files_are_refused_with_a_reason)
{
	const struct refusal all[] = {
		{{.table = "{\"w\":1,\"l\":2}"}, "table.linear"},
		{{.table = "7"}, "table"},
		{{.params = "{}"}, "params"},
		{{.models = "{\"ball_ball\":\"Magic()\",\"ball_linear_cushion\":\"UnrealisticLinear(restitution=True)"
			    "\"}"},
		 "Magic"},
		{{.models = "{\"ball_ball\":\"FrictionlessElastic()\",\"ball_linear_cushion\":\"Rubber()\"}"},
		 "Rubber"},
		{{.cue = "{\"ball\":\"nobody\"}"}, "nobody"},
		{{.balls = "{}"}, "balls"},
		{{.balls = "{\"cue\":{}, \"b1\":{\"s\":0,\"r\":[0.5,\"x\",0],\"v\":[0,0,0],\"w\":[0,0,0]}}"}, "b1"},
		{{.balls = "{\"cue\":{}, \"b1\":{\"s\":0,\"r\":[0.5,9,0],\"v\":[0,0,0],\"w\":[0,0,0]}}"}, "b1"},
		{{.balls = "{\"cue\":{}, \"b1\":{\"s\":0,\"r\":[0.5,0.51,0],\"v\":[0,0,0],\"w\":[0,0,0]}}"}, "b1"},
		{{.post_strike = "{\"s\":2,\"r\":[0.5,0.5,0.026],\"v\":[0,1e9,0],\"w\":[1,2,3]}"}, "cue"},
		{{.post_strike = "{\"s\":2,\"r\":[0.5,0.5,0.026],\"v\":[0,1e999,0],\"w\":[1,2,3]}"}, "shot:6"},
	};
	for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
		struct parts p = GOOD;
		const struct parts *bad = &all[i].parts;
		p.table = bad->table ? bad->table : p.table;
		p.params = bad->params ? bad->params : p.params;
		p.models = bad->models ? bad->models : p.models;
		p.cue = bad->cue ? bad->cue : p.cue;
		p.balls = bad->balls ? bad->balls : p.balls;
		p.post_strike = bad->post_strike ? bad->post_strike : p.post_strike;
		static struct shot_file f;
		char err[300] = "";
		f.ball_count = -5;
		ck_assert_int_eq(parse(&p, &f, err), -EINVAL);
		ck_assert_int_eq(f.ball_count, -5);
		ck_assert_msg(strstr(err, all[i].reason), "case %zu: \"%s\" does not say \"%s\"", i, err,
			      all[i].reason);
	}
}
END_TEST

START_TEST(missing_file_is_named)
{
	static struct shot_file f;
	char err[300] = "";
	ck_assert_int_eq(shot_file_read(&f, "/nowhere/shot.json", err, sizeof err), -ENOENT);
	ck_assert_ptr_nonnull(strstr(err, "/nowhere/shot.json"));
}
END_TEST

/* Events of one shot as JSON lines. */
static json_t *run(const struct shot_file *file)
{
	char *text = NULL;
	size_t size = 0;
	FILE *out = open_memstream(&text, &size);
	ck_assert_int_eq(shot_file_run(file, 10000, out), 0);
	fclose(out);
	json_t *events = json_array();
	for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"))
		json_array_append_new(events, json_loads(line, 0, NULL));
	free(text);
	return events;
}

START_TEST(events_come_in_the_files_frame)
{
	static struct shot_file f;
	char err[300] = "", want[] = "ball_ball";
	struct parts p = GOOD;
	p.post_strike = "{\"s\":2,\"r\":[0.5,0.5,0.026],\"v\":[0,3,0],\"w\":[0,0,0]}";
	ck_assert_int_eq(parse(&p, &f, err), 0);
	json_t *events = run(&f), *event;
	size_t i;
	bool met = false;
	json_array_foreach(events, i, event)
	{
		if (strcmp(json_string_value(json_object_get(event, "event")), want) != 0 || met)
			continue;
		met = true;
		json_t *post = json_object_get(event, "post"), *r = json_object_get(json_object_get(post, "cue"), "r");
		json_t *v = json_object_get(json_object_get(post, "b1"), "v");
		ck_assert_double_eq_tol(json_number_value(json_array_get(r, 0)), 0.5, 1e-12);
		ck_assert_double_eq_tol(json_number_value(json_array_get(r, 1)), 1.5 - 0.052, 1e-12);
		ck_assert_double_gt(json_number_value(json_array_get(v, 1)), 1);
		ck_assert_double_eq_tol(json_number_value(json_array_get(v, 0)), 0, 1e-12);
	}
	ck_assert(met);
	json_decref(events);
	FILE *full = fopen("/dev/full", "w");
	ck_assert_ptr_nonnull(full);
	setvbuf(full, NULL, _IONBF, 0);
	ck_assert_int_eq(shot_file_run(&f, 10000, full), -EIO);
	fclose(full);
	FILE *null = fopen("/dev/null", "w");
	ck_assert_int_eq(shot_file_run(&f, 1, null), -ETIME);
	fclose(null);
}
END_TEST

/* ---- the recorded shots with the simplest models: every event -------------------------------------------------------
 */

static const double TIME_BAR = 5e-6, PLACE_BAR = 2e-6; /* s, m */

START_TEST(simple_shots_are_reproduced_event_by_event)
{
	const char *folder = test_data_folder("simple_shots_are_reproduced_event_by_event");
	if (!folder)
		return;
	char path[512], err[300] = "";
	snprintf(path, sizeof path, "%s/shots/pooltool_shots.json", folder);
	json_t *root = json_load_file(path, 0, NULL), *shot;
	ck_assert_ptr_nonnull(root);
	size_t i;
	int count = 0;
	double dt = 0, dpos = 0;
	json_array_foreach(json_object_get(root, "shots"), i, shot)
	{
		if (strncmp(json_string_value(json_object_get(shot, "set")), "simple_", 7) != 0)
			continue;
		static struct shot_file file;
		ck_assert_msg(shot_from_collection(root, shot, &file, err, sizeof err) == 0, "%s", err);
		struct shot_comparison c = shot_compare(&file, json_object_get(shot, "events"), 0);
		ck_assert_msg(c.same, "shot %zu differs at %.9f s", i, c.time);
		dt = fmax(dt, c.dt);
		dpos = fmax(dpos, c.dpos);
		count++;
	}
	json_decref(root);
	printf("%d shots: times within %.2g s, positions within %.2g m\n", count, dt, dpos);
	ck_assert_int_gt(count, 0);
	ck_assert_double_le(dt, TIME_BAR);
	ck_assert_double_le(dpos, PLACE_BAR);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("shot_file");
	TCase *reading = tcase_create("reading"), *running = tcase_create("running");
	tcase_add_test(reading, frame_is_turned_and_moved);
	tcase_add_test(reading, models_are_known_by_their_names);
	tcase_add_test(reading, bad_files_are_refused_with_a_reason);
	tcase_add_test(reading, missing_file_is_named);
	suite_add_tcase(suite, reading);
	tcase_set_timeout(running, 60);
	tcase_add_test(running, events_come_in_the_files_frame);
	tcase_add_test(running, simple_shots_are_reproduced_event_by_event);
	suite_add_tcase(suite, running);
	return suite;
}
