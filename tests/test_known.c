/* Results that are known from the literature of the game, each with its source and its own formula: what a player knows a
 * ball to do. The figures are in docs/results/physics.md. */
#include "harness.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>

#include "physics/motion.h"
#include "physics/sim.h"

static const double DEGREE = M_PI / 180;

static struct model model_named(const char *name)
{
	struct model model;
	ck_assert(model_from_name(name, &model));
	return model;
}

/* A large bed of snooker cloth, frictionless balls of no loss if so wished. */
static struct table open_table(double e)
{
	struct table t = scene_box_table(19, 19);
	t.material.e_ball = e;
	return t;
}

/* The cue ball at speed v along x, `roll` of natural roll and `side` of v as rim speed about the vertical, touches a red so
 * that the line of centres is turned by cut: what both do just after. */
static void hit(const struct table *t, const struct model *model, double v, double cut, double roll, double side,
		struct sim *sim)
{
	struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){0, 0}),
			       ball_at(COLOUR_RED, vec2_scale(vec2_from_angle(cut), 2 * t->ball_radius))};
	ball[0].vel.x = v;
	ball[0].spin[1] = roll * v / t->ball_radius;
	ball[0].spin[2] = side * v / t->ball_radius;
	struct event event;
	sim_init(sim, t, model, ball, 2);
	ck_assert(sim_step(sim, &event));
	ck_assert_int_eq(event.kind, EVENT_BALL_BALL);
}

static double direction(vec2 v)
{
	return atan2(v.y, v.x);
}

/* ---- throw ---- */

/* Alciatore TP A.14: tan of the throw is the friction over the normal impulse: mu(v_rel) while the balls slip, and at most
 * a seventh of the slip. */
static double throw_by_tp_a14(const struct material *m, double v, double cut, double roll, double side)
{
	double across = v * (sin(cut) - side), up = v * roll * cos(cut), slip = hypot(across, up);
	double mu = m->mu_ball_a + m->mu_ball_b * exp(-m->mu_ball_c * slip);
	return slip > 0 ? atan(fmin(mu * v * cos(cut) / slip, 1.0 / 7) * across / (v * cos(cut))) : 0;
}

START_TEST(throw_against_cut_and_speed)
{
	struct table ideal = open_table(1), usual = open_table(0.95);
	struct model model = model_named("real");
	static const double speed[] = {0.447, 1.34, 3.13}; /* 1, 3, 7 mph */
	static struct sim sim;
	for (int rolls = 0; rolls < 2; rolls++) {
		for (int s = 0; s < 3; s++) {
			double most = 0, at = 0, half = 0;
			for (int cut = 1; cut < 89; cut++) {
				double want = throw_by_tp_a14(&ideal.material, speed[s], cut * DEGREE, rolls, 0);
				hit(&ideal, &model, speed[s], cut * DEGREE, rolls, 0, &sim);
				double got = cut * DEGREE - direction(sim.ball[1].vel);
				/* thrown the way the cue ball goes */
				ck_assert_double_eq_tol(got, want, 1e-9);
				hit(&usual, &model, speed[s], cut * DEGREE, rolls, 0, &sim);
				got = cut * DEGREE - direction(sim.ball[1].vel);
				ck_assert_double_le(got, want * (1 + 1e-9) * 2 / (1 + 0.95));
				ck_assert_double_ge(got, want * (1 - 1e-9) * 0.95 * 2 / (1 + 0.95));
				half = cut == 30 ? got : half;
				at = got > most ? cut : at;
				most = fmax(most, got);
			}
			printf("throw, %s, %.2f m/s: half-ball %.2f degrees, most %.2f at a cut of %.0f\n",
			       rolls ? "rolling" : "stun", speed[s], half / DEGREE, most / DEGREE, at);
		}
	}
	/* slow stun shots throw most, by 5 to 6 degrees near half-ball; a rolling ball throws less */
	ck_assert_double_gt(throw_by_tp_a14(&ideal.material, 0.447, 33 * DEGREE, 0, 0), 5 * DEGREE);
	ck_assert_double_lt(throw_by_tp_a14(&ideal.material, 0.447, 33 * DEGREE, 0, 0), 6 * DEGREE);
}
END_TEST

/* Gearing: outside side of 2/5 sin(cut) of the radius rolls off the object ball without throw (Alciatore TP A.26): half-ball
 * 0.2. More throws the other way. */
START_TEST(gearing_outside_side)
{
	struct table t = open_table(0.95);
	struct model model = model_named("real");
	static struct sim sim;
	for (int cut = 5; cut < 85; cut += 5) {
		/* a tip 2/5 sin(cut) off the middle turns the rim at 5/2 of that share of v */
		double rim = 2.5 * 0.4 * sin(cut * DEGREE);
		hit(&t, &model, 1.5, cut * DEGREE, 0, rim, &sim);
		ck_assert_double_eq_tol(direction(sim.ball[1].vel), cut * DEGREE, 1e-12);
		hit(&t, &model, 1.5, cut * DEGREE, 0, 1.2 * rim, &sim);
		ck_assert_double_gt(direction(sim.ball[1].vel), cut * DEGREE + 1e-4);
		hit(&t, &model, 1.5, cut * DEGREE, 0, 0.8 * rim, &sim);
		ck_assert_double_lt(direction(sim.ball[1].vel), cut * DEGREE - 1e-4);
	}
}
END_TEST

/* ---- where the cue ball goes ---- */

/* Direction of the cue ball when it rolls again. */
static double final_direction(const struct table *t, const struct model *model, double v, double cut, double roll)
{
	static struct sim sim;
	struct event event;
	hit(t, model, v, cut, roll, 0, &sim);
	while (sim.ball[0].phase == BALL_SLIDING)
		ck_assert(sim_step(&sim, &event));
	return direction(sim_ball(&sim, 0).vel);
}

/* The 30 degree rule (Alciatore TP 3.3; Wallace and Schroeder 1988): a rolling ball leaves at tan = sin cos / (sin^2 +
 * 2/5), 33.7 degrees at most, 30 +- 4 from a quarter-ball hit to three quarters. */
START_TEST(thirty_degree_rule)
{
	struct table t = open_table(1), usual = open_table(0.95);
	struct model elastic = model_named("simple-elastic"), real = model_named("real");
	double most = 0, at = 0, most_real = 0;
	for (int k = 1; k < 890; k++) {
		double cut = 0.1 * k * DEGREE, s = sin(cut), want = atan(s * cos(cut) / (s * s + 0.4));
		double got = -final_direction(&t, &elastic, 1, cut, 1),
		       really = -final_direction(&usual, &real, 1, cut, 1);
		ck_assert_double_eq_tol(got, want, 1e-9);
		at = got > most ? cut : at;
		most = fmax(most, got);
		most_real = fmax(most_real, really);
		double share = 1 - s; /* of the ball that is hit */
		ck_assert(share < 0.25 || share > 0.75 || fabs(got - 30 * DEGREE) < 4.1 * DEGREE);
	}
	printf("rolling cue ball: turned by at most %.2f degrees at a cut of %.1f; real: %.2f\n", most / DEGREE,
	       at / DEGREE, most_real / DEGREE);
	ck_assert_double_eq_tol(most, 33.749 * DEGREE, 1e-3 * DEGREE);
	ck_assert_double_eq_tol(at, 28.1 * DEGREE, 0.06 * DEGREE);
	ck_assert_double_eq_tol(most_real, most, 4 * DEGREE);
}
END_TEST

/* A stun shot parts the balls at a right angle; with restitution e at atan((1 - e) / 2 / tan(cut)) less. */
START_TEST(ninety_degrees_for_stun)
{
	static struct sim sim;
	for (int k = 0; k < 2; k++) {
		double e = k ? 0.95 : 1;
		struct table t = open_table(e);
		struct model model = model_named("simple");
		for (int cut = 5; cut < 90; cut += 5) {
			hit(&t, &model, 2, cut * DEGREE, 0, 0, &sim);
			double between = direction(sim.ball[1].vel) - direction(sim.ball[0].vel);
			ck_assert_double_eq_tol(between, M_PI / 2 - atan(0.5 * (1 - e) / tan(cut * DEGREE)), 1e-12);
		}
	}
	struct table t = open_table(0.95);
	struct model real = model_named("real");
	hit(&t, &real, 2, 30 * DEGREE, 0, 0, &sim);
	printf("stun, half-ball, real: %.2f degrees between\n",
	       (direction(sim.ball[1].vel) - direction(sim.ball[0].vel)) / DEGREE);
}
END_TEST

/* ---- how far balls go ---- */

static double run_way(const struct table *t, const struct model *model, double roll, int ball)
{
	static struct sim sim;
	double before = ball ? 2 * t->ball_radius : 0;
	hit(t, model, 1, 0, roll, 0, &sim);
	sim_run(&sim, &(struct sim_limits){INFINITY, 100}, NULL);
	return sim.ball[ball].pos.x - before;
}

/* Full hits with follow and draw: the cue ball keeps its spin, slides 2/49 k^2 v^2 / (mu_s g) and rolls off with 2/7 k v; the
 * object ball has 5/7 v after 12/49 v^2 / (mu_s g) (Wallace and Schroeder 1988; thesis 8.12). */
START_TEST(draw_and_follow)
{
	struct table t = open_table(1);
	struct model model = model_named("simple-elastic");
	double g = t.material.gravity, slide = t.material.mu_slide * g, roll = t.material.mu_roll * g;
	for (int k = -8; k <= 8; k++) {
		double spin = 0.2 * k, sign = k < 0 ? -1 : 1;
		double cue = sign * (2.0 / 49 * spin * spin / slide + 4.0 / 49 * spin * spin / (2 * roll));
		ck_assert_double_eq_tol(run_way(&t, &model, spin, 0), cue, 1e-9);
		ck_assert_double_eq_tol(run_way(&t, &model, spin, 1), 12.0 / 49 / slide + 25.0 / 49 / (2 * roll), 1e-9);
	}
	printf("full hit at 1 m/s, rolling: object ball %.3f m, cue ball %.3f m after it (%.2f to 1)\n",
	       run_way(&t, &model, 1, 1), run_way(&t, &model, 1, 0),
	       run_way(&t, &model, 1, 1) / run_way(&t, &model, 1, 0));
}
END_TEST

/* Coriolis 1835: a ball struck with a raised cue rolls off in the direction from its point of rest to where the cue's line
 * meets the cloth, whatever the cloth. */
START_TEST(coriolis_masse)
{
	struct table t = open_table(1);
	struct model model = model_named("simple-elastic");
	struct random r = random_begin("coriolis_masse");
	for (int n = 0; n < 500; n++) {
		double offset = random_in(&r, 0, 0.7), around = random_in(&r, -M_PI, M_PI),
		       up = random_in(&r, 0.1, 1.4);
		struct shot shot = {
			.speed = 1, .side = offset * cos(around), .follow = offset * sin(around), .elevation = up};
		/* the tip, in radii: across to the left, along the cue's own up, and back along the cue */
		double a = shot.side, b = shot.follow, back = sqrt(1 - a * a - b * b);
		double x = -back * cos(up) + b * sin(up), z = 1 + back * sin(up) + b * cos(up);
		vec2 meets = {x + z / tan(up), a};
		t.material.mu_slide = random_in(&r, 0.1, 0.4);
		struct ball ball = ball_at(COLOUR_WHITE, (vec2){0, 0});
		static struct sim sim;
		struct event event;
		sim_init(&sim, &t, &model, &ball, 1);
		sim_strike(&sim, 0, &shot);
		while (sim.ball[0].phase == BALL_SLIDING)
			ck_assert(sim_step(&sim, &event));
		vec2 rolls = sim_ball(&sim, 0).vel;
		ck_assert_double_le(fabs(vec2_cross(vec2_unit(rolls), vec2_unit(meets))), 1e-6);
		ck_assert(vec2_norm(rolls) < 1e-3 || vec2_dot(rolls, meets) > 0);
	}
}
END_TEST

/* ---- cushions and pockets ---- */

/* Angle from the normal, towards where the ball was going, after a rolling ball came in at 45 degrees with side. */
static double rebound(const char *name, double v, double side)
{
	struct table t = scene_snooker_table();
	struct model model = model_named(name);
	model.pocket = POCKET_MODEL_NONE;
	struct ball ball = ball_at(COLOUR_WHITE, (vec2){0.4, t.width / 2 - t.ball_radius});
	ball.vel = vec2_scale((vec2){1, 1}, v * sqrt(0.5));
	motion_roll(&ball, &t);
	ball.spin[2] = side * v / t.ball_radius;
	static struct sim sim;
	struct event event;
	sim_init(&sim, &t, &model, &ball, 1);
	ck_assert(sim_step(&sim, &event) && event.kind == EVENT_CUSHION);
	return atan2(sim.ball[0].vel.x, -sim.ball[0].vel.y);
}

/* Running side (the near rim goes with the ball) opens the angle, reverse side closes it, the more the more (Mathavan,
 * Jackson, Parkin 2010): anti-clockwise at the upper rail going right. */
START_TEST(running_and_reverse_side)
{
	static const char *const name[] = {"real", "real-mathavan"};
	for (int k = 0; k < 2; k++) {
		double last = -10;
		for (int side = -10; side <= 10; side++) {
			double angle = rebound(name[k], 1.5, 0.1 * side);
			ck_assert_double_ge(angle, last - 1e-6);
			last = angle;
		}
		double reverse = rebound(name[k], 1.5, -0.5), plain = rebound(name[k], 1.5, 0),
		       running = rebound(name[k], 1.5, 0.5);
		printf("%s, 45 degrees at 1.5 m/s: reverse side %.1f, none %.1f, running %.1f degrees from the "
		       "normal\n",
		       name[k], reverse / DEGREE, plain / DEGREE, running / DEGREE);
		ck_assert_double_lt(reverse, plain - 0.5 * DEGREE);
		ck_assert_double_gt(running, plain + 0.5 * DEGREE);
	}
}
END_TEST

/* Width of the aims, m across the way at the pocket, at which a ball from `from` falls. */
static double acceptance(vec2 from, double speed)
{
	struct table t = scene_snooker_table();
	struct model model = model_named("real");
	const struct pocket *p = &t.pocket[table_pocket(&t, "TOP-RIGHT")];
	vec2 way = vec2_sub(p->centre, from);
	double far = vec2_norm(way);
	int falls = 0;
	static struct sim sim;
	for (int k = -200; k <= 200; k++) {
		struct ball ball = ball_at(COLOUR_RED, from);
		ball.vel = vec2_scale(vec2_from_angle(direction(way) + 0.5e-3 * k / far), speed);
		motion_roll(&ball, &t);
		sim_init(&sim, &t, &model, &ball, 1);
		struct event event;
		while (sim_step(&sim, &event) && sim.ball[0].phase != BALL_POTTED && sim.time < 2)
			;
		falls += sim.ball[0].phase == BALL_POTTED && sim.ball[0].pos.x > 1.7 && sim.ball[0].pos.y > 0.8;
	}
	return 0.5e-3 * falls;
}

/* A pocket takes slow balls at a wider range of aims than fast ones, and balls along the diagonal at a wider one than along
 * the rail (Alciatore TP 3.6, 3.7 for pool's straight jaws: rounded ones are far stricter along the rail at speed). */
START_TEST(pocket_acceptance)
{
	struct table t = scene_snooker_table();
	vec2 diagonal = {t.length / 2 - 0.7, t.width / 2 - 0.7},
	     rail = {t.length / 2 - 1, t.width / 2 - 1.2 * t.ball_radius};
	double slow = acceptance(diagonal, 0.7), fast = acceptance(diagonal, 4), along = acceptance(rail, 0.7),
	       along_fast = acceptance(rail, 4);
	printf("corner pocket takes: diagonal %.1f mm at 0.7 m/s, %.1f at 4; along the rail %.1f, %.1f\n", 1e3 * slow,
	       1e3 * fast, 1e3 * along, 1e3 * along_fast);
	ck_assert_double_ge(slow, fast);
	ck_assert_double_ge(along, along_fast);
	ck_assert_double_gt(fast, along_fast);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("known");
	TCase *tcase = tcase_create("known");
	tcase_set_timeout(tcase, 60);
	tcase_add_test(tcase, throw_against_cut_and_speed);
	tcase_add_test(tcase, gearing_outside_side);
	tcase_add_test(tcase, thirty_degree_rule);
	tcase_add_test(tcase, ninety_degrees_for_stun);
	tcase_add_test(tcase, draw_and_follow);
	tcase_add_test(tcase, coriolis_masse);
	tcase_add_test(tcase, running_and_reverse_side);
	tcase_add_test(tcase, pocket_acceptance);
	suite_add_tcase(suite, tcase);
	return suite;
}
