/* Ranking by value: the player's error, what pockets take, the estimate, and positions whose answer is known. */
#include "harness.h"
#include "scenes.h"
#include "search_scenes.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "search/estimate.h"
#include "search/stroke.h"

static const double degree = M_PI / 180;

/* ---- the player's error ------------------------------------------------------------------------------------------ */

START_TEST(quantiles)
{
	for (int i = 1; i < 2000; i++) {
		double p = i / 2000.0, want = gsl_cdf_ugaussian_Pinv(p);
		ck_assert_double_eq_tol(normal_quantile(p), want, 2e-9 * fmax(1, fabs(want)));
	}
	for (double p = 1e-12; p < 0.02; p *= 3) {
		double want = gsl_cdf_ugaussian_Pinv(p);
		ck_assert_double_eq_tol(normal_quantile(p), want, 2e-9 * fabs(want));
		ck_assert_double_eq_tol(normal_quantile(1 - p), -gsl_cdf_ugaussian_Pinv(p), 1e-3);
	}
}
END_TEST

/* Prefixes of the sequence, as races use them: mean, variance, no correlation, the share in each tenth. */
START_TEST(points_are_normal)
{
	enum { MANY = 512 };
	static struct deviate point[MANY];
	for (uint64_t seed = 0; seed < 3; seed++)
		for (int n = 32; n <= MANY; n *= 2) {
			player_error_points(point, n, seed);
			/* few points are as good as random ones, many stay within one standard error of them */
			double mean_bar = (n < 128 ? 1.5 : 1) / sqrt(n), tenth_bar = 0.75 / sqrt(n);
			for (int k = 0; k < ERROR_DIMENSIONS; k++) {
				double sum = 0, squares = 0, cross = 0;
				int tenth[10] = {0};
				for (int i = 0; i < n; i++) {
					double z = point[i].z[k];
					sum += z;
					squares += z * z;
					cross += z * point[i].z[(k + 1) % ERROR_DIMENSIONS];
					tenth[(int)(10 * gsl_cdf_ugaussian_P(z))]++;
				}
				ck_assert_msg(fabs(sum / n) < mean_bar, "%d points, dimension %d: mean %g", n, k,
					      sum / n);
				ck_assert_double_eq_tol(squares / n, 1, 0.03 + 6.0 / n);
				ck_assert_double_eq_tol(cross / n, 0, 2 / sqrt(n));
				for (int t = 0; t < 10; t++)
					ck_assert_double_eq_tol((double)tenth[t] / n, 0.1, tenth_bar);
			}
		}
}
END_TEST

/* The first 2^k points lie one in each 2^k-th of every dimension: what makes a few of them worth many. */
START_TEST(points_are_spread)
{
	enum { MOST = 256 };
	static struct deviate point[MOST];
	for (uint64_t seed = 0; seed < 5; seed++)
		for (int n = 2; n <= MOST; n *= 2) {
			player_error_points(point, n, seed);
			for (int k = 0; k < ERROR_DIMENSIONS; k++) {
				bool taken[MOST] = {false};
				for (int i = 0; i < n; i++) {
					int cell = (int)(n * gsl_cdf_ugaussian_P(point[i].z[k]));
					ck_assert_int_lt(cell, n);
					ck_assert_msg(!taken[cell], "seed %d, %d points, dimension %d", (int)seed, n,
						      k);
					taken[cell] = true;
				}
			}
		}
}
END_TEST

START_TEST(errors_are_applied)
{
	struct shot shot = {.angle = 1, .speed = 2, .side = 0.1, .follow = -0.2, .elevation = 0.1};
	struct player_error none = {.angle = 0}, error = {0.01, 0.002, 0.05, -0.1, 0.04, 0.03, -0.02, 0.1, 0.01};
	struct deviate d = {{1, -2, 0.5, 1, -1}};
	struct shot same = player_error_apply(&none, &shot, &d), out = player_error_apply(&error, &shot, &d);
	ck_assert_mem_eq(&same, &shot, sizeof shot);
	ck_assert_double_eq_tol(out.angle, 1 + 0.002 + 0.01, 1e-15);
	ck_assert_double_eq_tol(out.speed, 2 * (1 - 0.1 - 2 * 0.05), 1e-15);
	ck_assert_double_eq_tol(out.side, 0.1 + 0.03 + 0.5 * 0.04, 1e-15);
	ck_assert_double_eq_tol(out.follow, -0.2 - 0.02 + 0.04, 1e-15);
	ck_assert_double_eq_tol(out.elevation, 0.1 + 0.01 - 0.1, 1e-15);
	/* what no strike can be is kept within its limits */
	d = (struct deviate){{0, -100, 100, 100, -100}};
	out = player_error_apply(&error, &shot, &d);
	ck_assert(out.speed > 0 && hypot(out.side, out.follow) <= 0.9 + 1e-12 && out.elevation == 0);
}
END_TEST

/* ---- what pockets take ------------------------------------------------------------------------------------------- */

static struct estimator estimator; /* large */
static struct table table;
static struct model model;
static const struct player_error STEADY = {.angle = 0.1 * M_PI / 180, .speed = 0.03};

static void setup_estimator(void)
{
	table = scene_snooker_table();
	ck_assert(model_from_name("real", &model));
	estimator_init(&estimator, &table, &model, &STEADY);
}

/* Does a ball that comes along way, at an offset to the left of the pocket's centre, fall? */
static bool falls(int pocket, vec2 way, double offset, double speed)
{
	static struct sim sim;
	vec2 end = vec2_madd(table.pocket[pocket].centre, offset, vec2_perp(way));
	struct ball ball = ball_at(COLOUR_WHITE, vec2_madd(end, -0.5, way));
	sim_init(&sim, &table, &model, &ball, 1);
	sim_strike(&sim, 0, &(struct shot){.angle = atan2(way.y, way.x), .speed = speed});
	sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = 500}, NULL);
	return sim_ball(&sim, 0).phase == BALL_POTTED;
}

/* Within the window, less a margin, all fall; the middle does in any case. Windows are read between measured angles and
 * speeds, so right at the edge either is right. */
START_TEST(windows_hold)
{
	struct random random = random_begin("windows_hold");
	int in = 0, fell = 0, out = 0, stayed = 0;
	for (int n = 0; n < 300; n++) {
		int pocket = (int)random_in(&random, 0, table.pocket_count);
		vec2 normal = table.pocket[pocket].normal;
		double turn = random_in(&random, -0.5, 0.5), speed = 1.2;
		vec2 way = vec2_from_angle(atan2(-normal.y, -normal.x) + turn);
		struct acceptance_window w = acceptance_at(&estimator.acceptance, &table, pocket, way, speed);
		if (w.high - w.low < 0.01)
			continue;
		double margin = 0.004;
		for (double s = 0; s <= 1; s += 0.25) {
			in++;
			fell += falls(pocket, way, w.low + margin + s * (w.high - w.low - 2 * margin), speed);
		}
		for (int side = -1; side <= 1; side += 2) {
			out++;
			stayed += !falls(pocket, way, (side < 0 ? w.low : w.high) + side * margin, speed);
		}
	}
	printf("acceptance: %d of %d within fell, %d of %d beyond stayed\n", fell, in, stayed, out);
	ck_assert_int_gt(in, 500);
	ck_assert_int_ge(100 * fell, 95 * in);
	ck_assert_int_ge(100 * stayed, 80 * out);
}
END_TEST

/* ---- the estimate against sampling ------------------------------------------------------------------------------- */

static double sampled_chance(const struct ball *ball, int count, const struct pot *pot, const struct shot *shot)
{
	enum { SAMPLES = 100 };
	static struct sim sim;
	static struct deviate point[SAMPLES];
	int made = 0;
	player_error_points(point, SAMPLES, 5);
	for (int i = 0; i < SAMPLES; i++) {
		struct shot played = player_error_apply(&STEADY, shot, &point[i]);
		sim_init(&sim, &table, &model, ball, count);
		sim_strike(&sim, 0, &played);
		sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = 500}, NULL);
		struct ball end = sim_ball(&sim, pot->ball);
		const struct pocket *pocket = &table.pocket[pot->pocket];
		made += end.phase == BALL_POTTED && vec2_dist(end.pos, pocket->centre) < 2 * pocket->radius;
	}
	return (double)made / SAMPLES;
}

/* The chance that geometry gives, before any simulation, and the one of the aimed stroke. */
START_TEST(estimate_against_sampling)
{
	struct random random = random_begin("estimate_against_sampling");
	double off = 0, aimed_off = 0, bias = 0;
	int n = 0;
	for (int tries = 0; tries < 2000 && n < 150; tries++) {
		struct ball ball[2];
		struct pot pot[POTS_MAX];
		struct rules_state rules = {.on = ON_RED};
		scene_random(&random, &table, 0.05, ball, 2);
		ball[1].colour = COLOUR_RED;
		const struct setting from = {&table, &model, ball, 2, &rules};
		int pots = estimate_pots(&estimator, &from, 0.05, pot);
		if (pots == 0)
			continue;
		struct aimed aimed = {.shot = {.speed = 2.5}};
		if (!stroke_aim(&estimator, &model, &ball[0], &ball[1], &pot[0], &aimed))
			continue;
		double chance = sampled_chance(ball, 2, &pot[0], &aimed.shot);
		off += fabs(pot[0].chance - chance);
		bias += pot[0].chance - chance;
		aimed_off += fabs(aimed.chance - chance);
		n++;
	}
	printf("chance of %d pots against sampling: by geometry off by %.3f (bias %+.3f), aimed by %.3f\n", n, off / n,
	       bias / n, aimed_off / n);
	fflush(stdout);
	ck_assert_int_eq(n, 150);
	/* Both are cautious: what falls off a jaw, beyond the window where everything does, is not in them. 100 samples
	 * scatter by up to 0.05 besides. */
	ck_assert_double_lt(off / n, 0.11);
	ck_assert_double_lt(bias / n, 0.02);
	ck_assert_double_lt(aimed_off / n, 0.1);
}
END_TEST

/* Mirrored across the long axis nothing changes but numbers' last digits and where windows were measured. */
START_TEST(estimate_mirrored)
{
	struct random random = random_begin("estimate_mirrored");
	for (int n = 0; n < 100; n++) {
		struct ball ball[10], mirror[10];
		struct rules_state rules = {.on = n % 2 ? ON_RED : ON_COLOUR};
		scene_random(&random, &table, 0.01, ball, 10);
		for (int i = 0; i < 10; i++) {
			mirror[i] = ball[i];
			mirror[i].pos.y = -ball[i].pos.y;
		}
		double value = estimate_value(&estimator, &(struct setting){&table, &model, ball, 10, &rules});
		double other = estimate_value(&estimator, &(struct setting){&table, &model, mirror, 10, &rules});
		ck_assert_msg(fabs(value - other) <= 0.02 * fmax(1, fabs(value)), "%d: %g and %g", n, value, other);
	}
}
END_TEST

/* ---- whole searches ---------------------------------------------------------------------------------------------- */

static struct cost_profile player(double angle, double speed)
{
	struct cost_profile profile = cost_profile_thesis();
	profile.ranking = RANK_VALUE;
	profile.program_speed = profile.any_first = profile.keep_flukes = false;
	profile.clearance = profile.cue_clearance = 0.002;
	profile.max_speed = 8;
	profile.error = (struct player_error){.angle = angle * degree, .speed = speed};
	return profile;
}

/* A position in the making. */
struct lay {
	struct ball ball[BALL_MAX];
	int count;
	enum rules_on on;
	bool in_hand;
};

static void put(struct lay *lay, enum ball_colour colour, double x, double y)
{
	lay->ball[lay->count++] = ball_at(colour, (vec2){x, y});
}

static struct plan_request request_for(const struct lay *lay, uint64_t nodes)
{
	struct plan_request request = scene_request(lay->ball, lay->count);
	request.target = TARGET_RULES;
	request.state = (struct rules_state){.on = lay->on, .in_hand = lay->in_hand};
	request.rails = 1;
	request.plans = 20;
	request.budget.nodes = nodes;
	return request;
}

/* The best plan. Its planner is left to the caller, whose plans they are. */
static struct plan_shot best_of(const struct lay *lay, uint64_t nodes)
{
	struct cost_profile profile = player(0.1, 0.03);
	struct planner *planner = scene_planner(&table, "real", &profile, 1);
	struct plan_request request = request_for(lay, nodes);
	struct plan_result result = scene_run(planner, &request);
	ck_assert_int_gt(result.plan_count, 0);
	struct plan_shot shot = result.plan[0].shot[0];
	char why[80];
	printf("%d: target %d pocket %d, %.1f deg, %.2f m/s, side %+.2f follow %+.2f, success %.2f, value %.1f: %s\n",
	       lay->count, shot.target, shot.pocket, shot.shot.angle / degree, shot.shot.speed, shot.shot.side,
	       shot.shot.follow, shot.success, shot.value, plan_why_text(&shot, why, sizeof why));
	fflush(stdout);
	ck_assert_int_eq(shot.foul, 0);
	ck_assert(isfinite(shot.value) && shot.success >= 0 && shot.success <= 1 && shot.why != WHY_UNKNOWN);
	planner_destroy(planner);
	return shot;
}

static struct rules_outcome played(const struct lay *lay, const struct plan_shot *shot)
{
	static struct workspace work;
	struct rules_state rules = {.on = lay->on};
	struct record record = {.shot = shot->shot, .target = shot->target, .pocket = shot->pocket};
	struct rules_outcome outcome;
	const struct setting from = {&table, &model, shot->start, lay->count, &rules};
	ck_assert(shot_play(&work, &from, &record, &outcome));
	return outcome;
}

/* A long straight pot: with the tip a little above the middle the cue ball follows into the pocket. */
START_TEST(straight_pot_without_in_off)
{
	struct lay lay = {.on = ON_RED};
	vec2 pocket = table.pocket[3].centre, way = vec2_scale(table.pocket[3].normal, 1);
	vec2 red = vec2_madd(pocket, 0.35, way), white = vec2_madd(pocket, 0.75, way);
	put(&lay, COLOUR_WHITE, white.x, white.y);
	put(&lay, COLOUR_RED, red.x, red.y);
	put(&lay, COLOUR_BLACK, table.spot[COLOUR_BLACK].x, 0);
	struct plan_shot shot = best_of(&lay, 6000), follow = shot;
	ck_assert_int_eq(shot.target, 1);
	ck_assert_double_ge(shot.success, 0.9);
	ck_assert(!played(&lay, &shot).cue_potted);
	follow.shot.follow = 0.4;
	follow.shot.side = 0;
	if (shot.pocket == 3 && shot.shot.follow < 0.2)
		ck_assert(played(&lay, &follow).cue_potted);
}
END_TEST

/* Nothing but a red: it is potted, not left as a safety. */
START_TEST(red_alone)
{
	struct lay lay = {.on = ON_RED};
	put(&lay, COLOUR_WHITE, 0.8, 0.1);
	put(&lay, COLOUR_RED, 1.3, 0.5);
	struct plan_shot shot = best_of(&lay, 4000);
	ck_assert(shot.target == 1 && shot.points == 1);
	ck_assert_double_ge(shot.success, 0.8);
}
END_TEST

/* Two reds that touch, in line with the pocket: what is sent at them goes there. */
START_TEST(plant)
{
	struct lay lay = {.on = ON_RED};
	vec2 pocket = table.pocket[3].centre, way = table.pocket[3].normal;
	double d = 2 * table.ball_radius;
	vec2 near = vec2_madd(pocket, 0.4, way), far = vec2_madd(pocket, 0.4 + d + 1e-7, way);
	put(&lay, COLOUR_WHITE, far.x - 0.5, far.y - 0.1);
	put(&lay, COLOUR_RED, near.x, near.y);
	put(&lay, COLOUR_RED, far.x, far.y);
	put(&lay, COLOUR_BLACK, table.spot[COLOUR_BLACK].x, 0);
	struct plan_shot shot = best_of(&lay, 8000);
	ck_assert_int_eq(shot.target, 1);
	ck_assert_int_eq(shot.pocket, 3);
	ck_assert_double_ge(shot.success, 0.5);
}
END_TEST

START_TEST(frozen_to_the_cushion)
{
	struct lay lay = {.on = ON_RED};
	put(&lay, COLOUR_WHITE, 0.7, 0.5);
	put(&lay, COLOUR_RED, 1.2, table.width / 2 - table.ball_radius - 1e-6);
	put(&lay, COLOUR_BLACK, table.spot[COLOUR_BLACK].x, 0);
	struct plan_shot shot = best_of(&lay, 8000);
	ck_assert_int_eq(shot.target, 1);
	ck_assert_double_ge(shot.success, 0.4);
}
END_TEST

/* The only red is hidden behind the brown: hit over a cushion. */
START_TEST(escape_from_a_snooker)
{
	struct lay lay = {.on = ON_RED};
	put(&lay, COLOUR_WHITE, -1.3, 0.3);
	put(&lay, COLOUR_BROWN, -1.15, 0.3);
	put(&lay, COLOUR_RED, 0.6, 0.3);
	put(&lay, COLOUR_BLACK, table.spot[COLOUR_BLACK].x, 0);
	struct rules_state rules = {.on = ON_RED};
	ck_assert(rules_is_snookered(&table, &rules, lay.ball, lay.count));
	struct plan_shot shot = best_of(&lay, 10000);
	ck_assert(shot.why == WHY_ESCAPE || shot.target == 2);
	ck_assert_double_ge(shot.success, 0.3);
}
END_TEST

START_TEST(last_black)
{
	struct lay lay = {.on = ON_CLEARANCE};
	put(&lay, COLOUR_WHITE, 1.15, -0.4);
	put(&lay, COLOUR_BLACK, table.spot[COLOUR_BLACK].x, 0);
	struct plan_shot shot = best_of(&lay, 4000);
	ck_assert(shot.target == 1 && shot.points == 7 && shot.why == WHY_LAST);
	ck_assert_double_ge(shot.success, 0.8);
	ck_assert(!played(&lay, &shot).cue_potted);
}
END_TEST

START_TEST(ball_in_hand)
{
	struct lay lay = {.on = ON_RED, .in_hand = true};
	put(&lay, COLOUR_WHITE, 0, 0);
	lay.ball[0].phase = BALL_POTTED;
	put(&lay, COLOUR_RED, -0.1, 0.75);
	put(&lay, COLOUR_BLUE, 0, 0);
	struct plan_shot shot = best_of(&lay, 8000);
	vec2 cue = shot.start[0].pos;
	ck_assert_double_le(vec2_dist(cue, table.baulk_d_centre), table.baulk_d_radius + 1e-9);
	ck_assert_double_le(cue.x, table.baulk_d_centre.x + 1e-9);
	ck_assert_int_eq(shot.target, 1);
	ck_assert_double_ge(shot.success, 0.7);
}
END_TEST

/* After a red the black lies free and near, the yellow far: black. */
START_TEST(colour_after_a_red)
{
	struct lay lay = {.on = ON_COLOUR};
	put(&lay, COLOUR_WHITE, 1.1, 0.2);
	put(&lay, COLOUR_RED, 0.9, -0.4);
	put(&lay, COLOUR_YELLOW, table.spot[COLOUR_YELLOW].x, table.spot[COLOUR_YELLOW].y);
	put(&lay, COLOUR_BLACK, table.spot[COLOUR_BLACK].x, 0);
	struct plan_shot shot = best_of(&lay, 6000);
	ck_assert_int_eq(shot.target, 3);
	ck_assert(shot.why == WHY_POSITION && shot.why_ball == 1);
}
END_TEST

START_TEST(opening_without_a_foul)
{
	struct lay lay = {.on = ON_RED, .in_hand = true, .count = SCENE_RACK_COUNT};
	scene_rack(&table, lay.ball);
	struct plan_shot shot = best_of(&lay, 10000);
	ck_assert_double_ge(shot.success, shot.target < 0 ? 0.9 : 0.5);
}
END_TEST

/* The same work, the same answer, whoever does it. */
START_TEST(any_number_of_workers)
{
	static const int workers[] = {1, 2, 8};
	struct cost_profile profile = player(0.3, 0.05);
	struct lay lay = {.on = ON_RED, .count = BALL_MAX};
	scene_after_break(&table, _i, lay.ball);
	uint64_t first = 0;
	for (int w = 0; w < 3; w++) {
		struct planner *planner = scene_planner(&table, "real", &profile, workers[w]);
		struct plan_request request = request_for(&lay, 4000);
		uint64_t hash = 0;
		for (int again = 0; again < 2; again++) {
			struct plan_result result = scene_run(planner, &request);
			hash = scene_hash(&result, lay.count);
			for (int i = 0; i < result.plan_count; i++)
				hash = hash * 31 + (uint64_t)llround(1e9 * result.plan[i].shot[0].value);
			first = first ? first : hash;
			ck_assert_msg(hash == first, "%d workers, run %d", workers[w], again);
		}
		planner_destroy(planner);
	}
}
END_TEST

/* The table is the same seen in a mirror: what is best is worth the same, but for what samples scatter. */
START_TEST(mirrored_positions)
{
	struct lay lay = {.on = ON_RED}, mirror;
	put(&lay, COLOUR_WHITE, 0.4, 0.2);
	put(&lay, COLOUR_RED, 1.0, -0.5);
	put(&lay, COLOUR_RED, 1.3, 0.4);
	put(&lay, COLOUR_BLACK, table.spot[COLOUR_BLACK].x, 0);
	mirror = lay;
	for (int i = 0; i < lay.count; i++)
		mirror.ball[i].pos.y = -lay.ball[i].pos.y;
	double a = best_of(&lay, 12000).value, b = best_of(&mirror, 12000).value;
	ck_assert_msg(fabs(a - b) <= 0.1 * fmax(a, b), "%.2f and %.2f points", a, b);
}
END_TEST

struct first {
	uint64_t work; /* nodes and simulations before the first proposal */
	int told;
	double value; /* of the last one */
};

static void told(void *context, const struct plan_result *result)
{
	struct first *first = context;
	if (first->told++ == 0)
		first->work = result->nodes + result->sims;
	first->value = result->plan[0].shot[0].value;
}

/* The first proposal does not wait for values: it comes after some hundred nodes and simulations, about a millisecond. */
START_TEST(first_proposal_is_early)
{
	struct lay lay = {.on = ON_RED, .count = BALL_MAX};
	struct cost_profile profile = player(0.3, 0.05);
	uint64_t most = 0;
	for (int variant = 0; variant < 10; variant++) {
		char err[200];
		scene_after_break(&table, variant, lay.ball);
		struct planner *planner = scene_planner(&table, "real", &profile, 1);
		struct plan_request request = request_for(&lay, 5000);
		struct plan_result result;
		struct first first = {.told = 0};
		ck_assert_int_eq(planner_run(planner, &request, told, &first, &result, err, sizeof err), 0);
		ck_assert_int_gt(first.told, 0);
		most = first.work > most ? first.work : most;
		planner_destroy(planner);
	}
	printf("first proposal after at most %llu nodes and simulations\n", (unsigned long long)most);
	ck_assert_uint_le(most, 200);
}
END_TEST

/* A player who errs more is promised less. */
START_TEST(worth_falls_with_the_error)
{
	double last = INFINITY;
	struct lay lay = {.on = ON_RED, .count = BALL_MAX};
	scene_after_break(&table, 2, lay.ball);
	for (double angle = 0.05; angle < 1; angle *= 3) {
		struct cost_profile profile = player(angle, 0.05);
		struct planner *planner = scene_planner(&table, "real", &profile, 1);
		struct plan_request request = request_for(&lay, 6000);
		struct plan_result result = scene_run(planner, &request);
		double value = result.plan[0].shot[0].value;
		printf("%.2f degrees: %.1f points\n", angle, value);
		ck_assert_double_lt(value, last + 1);
		last = value;
		planner_destroy(planner);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("value");
	TCase *error = tcase_create("error");
	tcase_add_test(error, quantiles);
	tcase_add_test(error, points_are_normal);
	tcase_add_test(error, points_are_spread);
	tcase_add_test(error, errors_are_applied);
	suite_add_tcase(suite, error);
	TCase *estimates = tcase_create("estimate");
	tcase_set_timeout(estimates, 60);
	tcase_add_unchecked_fixture(estimates, setup_estimator, NULL);
	tcase_add_test(estimates, windows_hold);
	tcase_add_test(estimates, estimate_against_sampling);
	tcase_add_test(estimates, estimate_mirrored);
	suite_add_tcase(suite, estimates);
	TCase *positions = tcase_create("positions");
	tcase_set_timeout(positions, 60);
	tcase_add_unchecked_fixture(positions, setup_estimator, NULL);
	tcase_add_test(positions, straight_pot_without_in_off);
	tcase_add_test(positions, red_alone);
	tcase_add_test(positions, plant);
	tcase_add_test(positions, frozen_to_the_cushion);
	tcase_add_test(positions, escape_from_a_snooker);
	tcase_add_test(positions, last_black);
	tcase_add_test(positions, ball_in_hand);
	tcase_add_test(positions, colour_after_a_red);
	tcase_add_test(positions, opening_without_a_foul);
	tcase_add_loop_test(positions, any_number_of_workers, 0, 2);
	tcase_add_test(positions, mirrored_positions);
	tcase_add_test(positions, first_proposal_is_early);
	tcase_add_test(positions, worth_falls_with_the_error);
	suite_add_tcase(suite, positions);
	return suite;
}
