/* Contact times against extended precision and another method; what is culled must indeed never meet. */
#include "harness.h"
#include "poly_judge.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "physics/predict.h"
#include "physics/motion.h"

struct state {
	long double p[2], v[2], a[2];
};

/* The closed form once more, in extended precision and from the laws themselves. */
static struct state state_at(const struct ball *b, const struct table *table, long double dt)
{
	struct state s = {{b->pos.x, b->pos.y}, {b->vel.x, b->vel.y}, {0, 0}};
	long double d[2] = {0, 0}, g = table->material.gravity;
	if (b->phase == BALL_SLIDING) {
		d[0] = s.v[0] - (long double)table->ball_radius * b->spin[1];
		d[1] = s.v[1] + (long double)table->ball_radius * b->spin[0];
		g *= table->material.mu_slide;
	} else if (b->phase == BALL_ROLLING) {
		d[0] = s.v[0];
		d[1] = s.v[1];
		g *= table->material.mu_roll;
	}
	long double n = sqrtl(d[0] * d[0] + d[1] * d[1]);
	for (int i = 0; i < 2 && n > 0; i++) {
		s.a[i] = -g * d[i] / n;
		s.p[i] += s.v[i] * dt + 0.5L * s.a[i] * dt * dt;
		s.v[i] += s.a[i] * dt;
	}
	return s;
}

static void distance_polynomial(const struct state *a, const struct state *b, long double distance, long double c[5])
{
	long double p[2], v[2], h[2];
	for (int i = 0; i < 5; i++)
		c[i] = 0;
	for (int i = 0; i < 2; i++) {
		p[i] = b->p[i] - a->p[i];
		v[i] = b->v[i] - a->v[i];
		h[i] = 0.5L * (b->a[i] - a->a[i]);
		c[0] += p[i] * p[i];
		c[1] += 2 * p[i] * v[i];
		c[2] += v[i] * v[i] + 2 * p[i] * h[i];
		c[3] += 2 * v[i] * h[i];
		c[4] += h[i] * h[i];
	}
	c[0] -= distance * distance;
}

static struct ball random_ball(struct random *r, const struct table *table)
{
	struct ball b = ball_at(COLOUR_RED, (vec2){random_in(r, -0.9, 0.9), random_in(r, -0.4, 0.4)});
	double speed = pow(10, random_in(r, -3, 1));
	uint64_t kind = random_u64(r) % 8;
	if (kind == 0)
		return b;
	b.vel = vec2_scale(vec2_from_angle(random_in(r, -M_PI, M_PI)), speed);
	if (kind < 4) {
		motion_roll(&b, table);
		return b;
	}
	b.phase = BALL_SLIDING;
	if (kind > 5) {
		b.spin[0] = random_in(r, -3, 3) * speed / table->ball_radius;
		b.spin[1] = random_in(r, -3, 3) * speed / table->ball_radius;
	}
	return b;
}

/* Half of the pairs are aimed at each other, so that there is something to find. */
static void aim(struct random *r, const struct table *table, struct ball *a, const struct ball *b)
{
	if (random_u64(r) & 1)
		return;
	vec2 to = vec2_sub(b->pos, a->pos);
	double angle = atan2(to.y, to.x) + random_in(r, -1.5, 1.5) * 2 * table->ball_radius / vec2_norm(to);
	a->vel = vec2_scale(vec2_from_angle(angle), vec2_norm(a->vel));
	if (a->phase == BALL_ROLLING)
		motion_roll(a, table);
}

static double least_end(const struct motion *a, const struct motion *b)
{
	return a->reach == 0 ? b->end : b->reach == 0 ? a->end : fmin(a->end, b->end);
}

struct tally {
	int met, missed, invented, grazing;
	double worst; /* s */
};

static void judge(struct tally *tally, const long double c[5], long double horizon, double t)
{
	struct judge_entry entry = judge_first_entry(c, horizon);
	bool found = t < INFINITY;
	tally->met += entry.certain;
	tally->missed += entry.certain && !found;
	if (!found)
		return;
	/* the time since the shot began is itself rounded */
	long double slope = fabsl(judge_slope(c, t)), rounding = 64 * judge_noise(c, t) + 1e-15L * slope;
	if (fabsl(judge_value(c, t)) > rounding) {
		tally->invented++;
		return;
	}
	long double error = fabsl(judge_value(c, t)) / slope;
	/* a touch without depth has no time better than the root of the rounding */
	if (64 * judge_noise(c, t) / slope > 1e-10L)
		tally->grazing++;
	else
		tally->worst =
			fmax(tally->worst, (double)(entry.certain ? fmaxl(error, fabsl(entry.root - t)) : error));
}

static const struct model exact;

START_TEST(contact_times_of_two_balls)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("contact_times_of_two_balls");
	struct tally tally = {0};
	struct solve_count count = {0};
	int meetings = 100000, pairs = 0;
	while (tally.met < meetings) {
		struct ball a = random_ball(&r, &table), b = random_ball(&r, &table);
		if (vec2_dist(a.pos, b.pos) < 2 * table.ball_radius)
			continue;
		aim(&r, &table, &a, &b);
		pairs++;
		struct motion ma = predict_motion(&table, &a, 0), mb = predict_motion(&table, &b, 0);
		double end = least_end(&ma, &mb), now = random_u64(&r) & 1 ? 0 : random_in(&r, 0, 0.9) * end;
		if (!isfinite(end))
			continue;
		struct state sa = state_at(&a, &table, now), sb = state_at(&b, &table, now);
		long double c[5];
		distance_polynomial(&sa, &sb, 2 * (long double)table.ball_radius, c);
		if (c[0] <= 0)
			continue;
		struct predictor by = {&table, &exact, &count};
		double t = predict_pair(&by, &(struct mover){&a, &ma}, &(struct mover){&b, &mb}, now);
		int before = tally.missed + tally.invented;
		judge(&tally, c, (long double)end - now, t - now);
		if (tally.missed + tally.invented > before && before < 5)
			printf("pair %d: now %.17g t %.17g\n", pairs, now, t);
	}
	printf("%d pairs, %d met, %d missed, %d invented, %d grazing, worst error %.2g s; quartic %lu quadratic %lu "
	       "culled %lu\n",
	       pairs, tally.met, tally.missed, tally.invented, tally.grazing, tally.worst, (unsigned long)count.quartic,
	       (unsigned long)count.quadratic, (unsigned long)count.culled);
	fflush(stdout);
	ck_assert_int_eq(tally.missed, 0);
	ck_assert_int_eq(tally.invented, 0);
	ck_assert_int_lt(tally.grazing, meetings / 100);
	ck_assert_double_le(tally.worst, 1e-9);
}
END_TEST

/* Rounded down, a contact is never late, and the balls are as near as the grid allows: five coefficients, each less
 * than one step too low. */
START_TEST(contacts_on_a_grid_come_early)
{
	struct table table = scene_thesis_table();
	struct model grid = {.contact_grid = 1e-6};
	struct random r = random_begin("contacts_on_a_grid_come_early");
	struct solve_count count = {0};
	double worst = 0;
	for (int met = 0; met < 20000;) {
		struct ball a = random_ball(&r, &table), b = random_ball(&r, &table);
		if (vec2_dist(a.pos, b.pos) < 2 * table.ball_radius)
			continue;
		aim(&r, &table, &a, &b);
		struct motion ma = predict_motion(&table, &a, 0), mb = predict_motion(&table, &b, 0);
		struct mover one = {&a, &ma}, other_one = {&b, &mb};
		double t = predict_pair(&(struct predictor){&table, &grid, &count}, &one, &other_one, 0);
		ck_assert_double_le(t, predict_pair(&(struct predictor){&table, &exact, &count}, &one, &other_one, 0) +
					       1e-9);
		if (!isfinite(t))
			continue;
		met++;
		struct ball at = motion_advance(&a, &table, t), other = motion_advance(&b, &table, t);
		double gap = vec2_norm2(vec2_sub(at.pos, other.pos)) - 4 * table.ball_radius * table.ball_radius;
		double most = grid.contact_grid * (1 + t * (1 + t * (1 + t * (1 + t))));
		ck_assert_double_ge(gap, -1e-12);
		ck_assert_double_le(gap, most + 1e-12);
		worst = fmax(worst, vec2_dist(at.pos, other.pos) - 2 * table.ball_radius);
	}
	printf("balls apart at the contact: at most %.2g m\n", worst);
	fflush(stdout);
}
END_TEST

START_TEST(cushion_is_met_at_one_radius)
{
	struct table table = scene_box_table(2, 1);
	struct model model = {BALL_MODEL_ELASTIC, CUSHION_MODEL_MIRROR, POCKET_MODEL_NONE, false, 0, false};
	struct random r = random_begin("cushion_is_met_at_one_radius");
	struct solve_count count = {0};
	int hits = 0;
	for (int i = 0; i < 20000; i++) {
		struct ball b = random_ball(&r, &table);
		struct motion m = predict_motion(&table, &b, 0);
		struct predictor by = {&table, &model, &count};
		struct event e = predict_own(&by, &(struct mover){&b, &m}, 0);
		for (int k = 0; k <= 50 && isfinite(e.time); k++) {
			struct ball at = motion_advance(&b, &table, e.time * k / 50);
			ck_assert_double_le(fabs(at.pos.x), 1 - table.ball_radius + 1e-12);
			ck_assert_double_le(fabs(at.pos.y), 0.5 - table.ball_radius + 1e-12);
		}
		if (e.kind != EVENT_CUSHION)
			continue;
		hits++;
		struct ball at = motion_advance(&b, &table, e.time);
		const struct cushion *c = &table.cushion[e.other];
		ck_assert_double_eq_tol(vec2_dot(c->normal, vec2_sub(at.pos, c->a)), table.ball_radius, 1e-12);
		ck_assert_double_le(vec2_dot(c->normal, at.vel), 0);
	}
	ck_assert_int_gt(hits, 4000);
}
END_TEST

/* What costs no quartic: at rest, out of reach, straight paths, equal accelerations. */
START_TEST(easy_cases_cost_no_quartic)
{
	struct table table = scene_box_table(3.5, 1.7);
	struct ball rest = ball_at(COLOUR_RED, (vec2){0.5, 0}), far = ball_at(COLOUR_RED, (vec2){1.6, 0.8});
	struct ball roll = ball_at(COLOUR_RED, (vec2){0, 0}), same = ball_at(COLOUR_RED, (vec2){-0.3, 0});
	roll.vel = (vec2){0.4, 0};
	same.vel = (vec2){0.9, 0};
	motion_roll(&roll, &table);
	motion_roll(&same, &table);
	struct ball slide = roll;
	slide.pos.x = 0.5 - 2 * table.ball_radius - 0.01;
	slide.phase = BALL_SLIDING;
	slide.spin[0] = slide.spin[1] = 0;
	const struct ball *pair[][2] = {{&rest, &far}, {&roll, &far}, {&roll, &rest}, {&slide, &rest}, {&roll, &same}};
	const double want_quadratic[] = {0, 0, 1, 1, 1};
	for (int i = 0; i < 5; i++) {
		struct solve_count count = {0};
		struct motion a = predict_motion(&table, pair[i][0], 0), b = predict_motion(&table, pair[i][1], 0);
		struct predictor by = {&table, &exact, &count};
		predict_pair(&by, &(struct mover){pair[i][0], &a}, &(struct mover){pair[i][1], &b}, 0);
		ck_assert_int_eq((int)count.quartic, 0);
		ck_assert_int_eq((int)count.quadratic, (int)want_quadratic[i]);
		ck_assert_int_eq((int)(count.quadratic + count.culled), 1);
	}
}
END_TEST

/* Two rails on one line, endless without pockets: the one is named on which the ball's foot lies. */
START_TEST(rails_in_line)
{
	struct table table = scene_thesis_table();
	struct model model = {.pocket = POCKET_MODEL_NONE};
	struct solve_count count = {0};
	struct predictor by = {&table, &model, &count};
	for (int k = 0; k < 4; k++) {
		struct ball b = ball_at(COLOUR_RED, (vec2){k & 1 ? 0.4 : -0.4, 0.3 * (k & 2 ? 1 : -1)});
		b.vel.y = k & 2 ? 2 : -2;
		motion_roll(&b, &table);
		struct motion m = predict_motion(&table, &b, 0);
		struct event e = predict_own(&by, &(struct mover){&b, &m}, 0);
		const struct cushion *c = &table.cushion[e.other];
		ck_assert_int_eq(e.kind, EVENT_CUSHION);
		ck_assert(fmin(c->a.x, c->b.x) <= b.pos.x && b.pos.x <= fmax(c->a.x, c->b.x) && c->a.y * b.pos.y > 0);
	}
}
END_TEST

/* Sharp tips are there for the realistic models only; a ball behind a two-sided cushion meets its other side. */
START_TEST(tips_and_sides)
{
	struct table table = scene_thesis_table();
	struct solve_count count = {0};
	vec2 tip = {-0.0575, -0.4715};
	for (int k = 0; k < 2; k++) {
		struct model model;
		ck_assert(model_from_name(k ? "real" : "simple", &model));
		struct predictor by = {&table, &model, &count};
		struct ball b = ball_at(COLOUR_WHITE, vec2_madd(tip, 0.1, vec2_from_angle(1.2)));
		b.vel = vec2_scale(vec2_from_angle(1.2), -1.5);
		motion_roll(&b, &table);
		struct motion m = predict_motion(&table, &b, 0);
		struct event e = predict_own(&by, &(struct mover){&b, &m}, 0);
		ck_assert(k ? e.kind == EVENT_JAW : e.kind != EVENT_JAW);
	}
	struct cushion c = {.a = {0, 0}, .b = {1, 0}, .normal = {0, 1}, .along = {1, 0}, .span = 1};
	for (int k = 0; k < 4; k++) {
		c.two_sided = k & 1;
		vec2 n = predict_cushion_normal(&c, (vec2){0.5, k & 2 ? -0.1 : 0.1});
		ck_assert(n.x == 0 && n.y == (k == 3 ? -1 : 1));
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("predict");
	TCase *tcase = tcase_create("predict");
	tcase_set_timeout(tcase, 120);
	tcase_add_test(tcase, contact_times_of_two_balls);
	tcase_add_test(tcase, contacts_on_a_grid_come_early);
	tcase_add_test(tcase, cushion_is_met_at_one_radius);
	tcase_add_test(tcase, rails_in_line);
	tcase_add_test(tcase, tips_and_sides);
	tcase_add_test(tcase, easy_cases_cost_no_quartic);
	suite_add_tcase(suite, tcase);
	return suite;
}
