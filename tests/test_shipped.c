/* The shipped tables under play: whatever is struck and in whichever model, every ball ends on the bed or in a pocket.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/config/config.h"
#include "harness.h"
#include "physics/sim.h"
#include "scenes.h"

enum { SHOTS = 10000, EVENTS = 5000 };
static const char *const model_name[] = {"thesis", "simple", "simple-elastic", "real", "real-mathavan"};
static const char *const file_name[] = {"config/thesis-table.conf", "config/snooker-12ft.conf"};
enum { MODELS = sizeof model_name / sizeof *model_name, FILES = sizeof file_name / sizeof *file_name };

static struct config config;

static void load(const char *path)
{
	char err[640] = "";
	ck_assert_msg(config_load(&config, path, err, sizeof err) == 0, "%s", err);
}

/* Cue ball and a few others, none overlapping. */
static int random_balls(struct random *random, struct ball *ball, int most)
{
	int count = 0, first, second;
	char err[128];
	double x = config.table.length / 2 - config.table.ball_radius,
	       y = config.table.width / 2 - config.table.ball_radius;
	for (int tries = 0; tries < 100 && count < most; tries++) {
		ball[count] = ball_at(count ? COLOUR_RED : COLOUR_WHITE,
				      (vec2){random_in(random, -x, x), random_in(random, -y, y)});
		if (table_check_balls(&config.table, ball, count + 1, &first, &second, err, sizeof err) == 0)
			count++;
	}
	return count;
}

static bool on_bed(vec2 at)
{
	double slack = config.table.ball_radius; /* a ball may rest in a jaw, its centre behind the nose line */
	return fabs(at.x) <= config.table.length / 2 + slack && fabs(at.y) <= config.table.width / 2 + slack;
}

static void play(struct random *random, const struct model *model, const struct ball *ball, int count)
{
	static struct sim sim;
	struct shot shot = {.angle = random_in(random, -M_PI, M_PI),
			    .speed = random_in(random, 0.1, 8),
			    .side = random_in(random, -0.4, 0.4),
			    .follow = random_in(random, -0.4, 0.4)};
	sim_init(&sim, &config.table, model, ball, count);
	sim_strike(&sim, 0, &shot);
	enum sim_end end = sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = EVENTS}, NULL);
	ck_assert_msg(end == SIM_AT_REST, "no end: angle %.17g speed %.17g", shot.angle, shot.speed);
	for (int i = 0; i < count; i++) {
		struct ball b = sim_ball(&sim, i);
		ck_assert_msg(b.phase == BALL_POTTED || on_bed(b.pos),
			      "ball %d left at (%.1f, %.1f) mm: cue ball (%.17g, %.17g) angle %.17g speed %.17g", i,
			      b.pos.x * 1000, b.pos.y * 1000, ball[0].pos.x, ball[0].pos.y, shot.angle, shot.speed);
	}
}

START_TEST(no_ball_is_lost)
{
	char name[80];
	struct model model;
	struct ball ball[BALL_MAX];
	load(file_name[_i / MODELS]);
	ck_assert(model_from_name(model_name[_i % MODELS], &model));
	snprintf(name, sizeof name, "no_ball_is_lost %s %s", config.name, model_name[_i % MODELS]);
	struct random random = random_begin(name);
	for (int n = 0; n < SHOTS; n++)
		play(&random, &model, ball, random_balls(&random, ball, 6));
}
END_TEST

START_TEST(breaks_end)
{
	struct model model;
	struct ball rack[SCENE_RACK_COUNT];
	load(file_name[_i / MODELS]);
	ck_assert(model_from_name(model_name[_i % MODELS], &model));
	struct random random = random_begin("breaks_end");
	scene_rack(&config.table, rack);
	for (int n = 0; n < 5; n++)
		play(&random, &model, rack, SCENE_RACK_COUNT);
}
END_TEST

/* A slow ball straight at the middle of each pocket falls, in every model. */
START_TEST(every_pocket_takes_a_ball)
{
	struct model model;
	load(file_name[_i / MODELS]);
	ck_assert(model_from_name(model_name[_i % MODELS], &model));
	for (int i = 0; i < config.table.pocket_count; i++) {
		const struct pocket *p = &config.table.pocket[i];
		static struct sim sim;
		struct ball ball = ball_at(COLOUR_WHITE, vec2_madd(p->centre, 0.3, p->normal));
		vec2 way = vec2_sub(p->centre, ball.pos);
		sim_init(&sim, &config.table, &model, &ball, 1);
		sim_strike(&sim, 0, &(struct shot){.angle = atan2(way.y, way.x), .speed = 1});
		ck_assert_int_eq(sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = EVENTS}, NULL),
				 SIM_AT_REST);
		ck_assert_msg(sim_ball(&sim, 0).phase == BALL_POTTED, "%s of %s takes no ball in %s", p->name,
			      config.name, model_name[_i % MODELS]);
	}
}
END_TEST

/* A ball with much spin begins behind the line of a jaw, bends round in front of it and meets it at the nose's corner.
 */
START_TEST(bent_way_round_a_nose)
{
	struct model model;
	static struct sim sim;
	load(file_name[0]);
	ck_assert(model_from_name("simple", &model));
	struct ball ball = ball_at(COLOUR_WHITE, (vec2){-0.73791, -0.03117});
	ball.vel = (vec2){0.3566, 1.0062};
	ball.spin[0] = 176.8;
	ball.spin[1] = -203.7;
	sim_init(&sim, &config.table, &model, &ball, 1);
	ck_assert_int_eq(sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = EVENTS}, NULL),
			 SIM_AT_REST);
	struct ball end = sim_ball(&sim, 0);
	ck_assert_msg(end.phase == BALL_POTTED || on_bed(end.pos), "(%.1f, %.1f) mm", end.pos.x * 1000,
		      end.pos.y * 1000);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("shipped");
	TCase *tcase = tcase_create("tables");
	tcase_set_timeout(tcase, 120);
	tcase_add_loop_test(tcase, no_ball_is_lost, 0, MODELS * FILES);
	tcase_add_loop_test(tcase, breaks_end, 0, MODELS * FILES);
	tcase_add_loop_test(tcase, every_pocket_takes_a_ball, 0, MODELS * FILES);
	tcase_add_test(tcase, bent_way_round_a_nose);
	suite_add_tcase(suite, tcase);
	return suite;
}
