/* Contact laws of the thesis and of the simple models, and contacts that are solved together. */
#include "harness.h"
#include "inverse_forward.h"
#include "scenes.h"

#include <math.h>

#include "physics/collide.h"
#include "physics/contact.h"
#include "physics/inverse.h"
#include "physics/motion.h"
#include "physics/sim.h"

static struct model model_named(const char *name)
{
	struct model model;
	ck_assert(model_from_name(name, &model));
	return model;
}

static struct ball moving(vec2 pos, vec2 vel, enum ball_phase phase, const struct table *table)
{
	struct ball b = ball_at(COLOUR_RED, pos);
	b.vel = vel;
	b.phase = phase;
	if (phase == BALL_ROLLING)
		motion_roll(&b, table);
	return b;
}

/* Touching, approaching, in any phases. */
static void random_pair(struct random *r, const struct table *table, struct ball *a, struct ball *b)
{
	do {
		vec2 n = vec2_from_angle(random_in(r, -M_PI, M_PI));
		*a = moving((vec2){0, 0}, (vec2){random_in(r, -3, 3), random_in(r, -3, 3)},
			    random_u64(r) & 1 ? BALL_ROLLING : BALL_SLIDING, table);
		*b = ball_at(COLOUR_RED, (vec2){0, 0});
		if (random_u64(r) & 1)
			*b = moving(b->pos, (vec2){random_in(r, -3, 3), random_in(r, -3, 3)}, BALL_ROLLING, table);
		b->pos = vec2_scale(n, 2 * table->ball_radius);
	} while (vec2_dot(vec2_sub(a->vel, b->vel), b->pos) <= 0);
}

static vec2 momentum(const struct ball *a, const struct ball *b)
{
	return vec2_add(a->vel, b->vel);
}

START_TEST(simple_keeps_momentum_and_separates)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("simple_keeps_momentum_and_separates");
	const char *const names[] = {"simple-elastic", "simple"};
	for (int i = 0; i < 20000; i++) {
		struct model model = model_named(names[i & 1]);
		double e = contact_restitution(&table, &model, 1);
		struct ball a, b;
		random_pair(&r, &table, &a, &b);
		vec2 n = vec2_unit(b.pos), before = momentum(&a, &b);
		double approach = vec2_dot(vec2_sub(a.vel, b.vel), n), energy = vec2_norm2(a.vel) + vec2_norm2(b.vel);
		double spin = a.spin[0];
		contact_balls(&table, &model, &a, &b);
		ck_assert_double_le(vec2_dist(momentum(&a, &b), before), 1e-14);
		ck_assert_double_eq_tol(vec2_dot(vec2_sub(b.vel, a.vel), n), e * approach, 1e-14);
		double loss = 0.5 * (1 - e * e) * approach * approach;
		ck_assert_double_eq_tol(vec2_norm2(a.vel) + vec2_norm2(b.vel), energy - loss, 1e-13);
		ck_assert(a.spin[0] == spin);
	}
}
END_TEST

/* 4.43 to 4.55 without topspin: a sliding ball on a resting one. */
START_TEST(thesis_without_topspin)
{
	struct table table = scene_thesis_table();
	struct model model = model_named("thesis");
	struct random r = random_begin("thesis_without_topspin");
	for (int i = 0; i < 5000; i++) {
		double v = random_in(&r, 0.1, 5), cut = random_in(&r, -1.5, 1.5);
		struct ball a = moving((vec2){0, 0}, (vec2){v, 0}, BALL_SLIDING, &table);
		struct ball b = ball_at(COLOUR_RED, vec2_scale(vec2_from_angle(cut), 2 * table.ball_radius));
		contact_balls(&table, &model, &a, &b);
		ck_assert_double_eq_tol(vec2_norm(b.vel), hit_forward(&table, v, cos(cut)), 1e-14);
		ck_assert_double_eq_tol(vec2_norm(a.vel), v * fabs(sin(cut)) * (1 - table.material.loss_ball), 1e-14);
		ck_assert_double_eq_tol(vec2_dot(a.vel, b.vel), 0, 1e-13);
		ck_assert_int_eq(b.phase, BALL_SLIDING);
		ck_assert(a.phase == BALL_SLIDING || vec2_norm(a.vel) < 1e-7);
	}
}
END_TEST

START_TEST(thesis_topspin_variants)
{
	struct table table = scene_thesis_table();
	struct model model = model_named("thesis");
	double keep = 1 - table.material.loss_ball, d = 2 * table.ball_radius;
	for (int variant = 0; variant <= 2; variant++) {
		table.material.topspin_variant = variant;
		table.material.topspin_factor = variant == 1 ? 0.1 : 0.25;
		struct ball a = moving((vec2){0, 0}, (vec2){2, 0}, BALL_ROLLING, &table);
		struct ball b = ball_at(COLOUR_RED, (vec2){d, 0});
		contact_balls(&table, &model, &a, &b);
		/* full hit: all goes over; the topspin's part is what the rolling ball goes on with */
		double want = variant == 0 ? 0 : variant == 1 ? 0.1 : 0.25 * 2 * keep;
		ck_assert_double_eq_tol(a.vel.x, want, 1e-15);
		ck_assert_double_eq_tol(b.vel.x, 2 * keep, 1e-15);
		ck_assert_int_eq(a.phase, variant ? BALL_ROLLING : BALL_REST);
		/* a sliding ball has no topspin */
		a = moving((vec2){0, 0}, (vec2){2, 0}, BALL_SLIDING, &table);
		b = ball_at(COLOUR_RED, (vec2){d, 0});
		contact_balls(&table, &model, &a, &b);
		ck_assert_double_eq(a.vel.x, 0);
		/* thin hit: at most the incoming speed along the tangent (4.58) */
		a = moving((vec2){0, 0}, (vec2){2, 0}, BALL_ROLLING, &table);
		b = ball_at(COLOUR_RED, vec2_scale(vec2_from_angle(1.5), d));
		contact_balls(&table, &model, &a, &b);
		ck_assert_double_le(vec2_norm(a.vel), 2 * keep * (1 + 1e-15));
	}
}
END_TEST

/* What topspin may add: 1.24-fold on a ball at rest, 1.41-fold of two that both roll (docs/physics.md). */
START_TEST(thesis_topspin_gains_so_much)
{
	struct table table = scene_thesis_table();
	struct model model = model_named("thesis");
	struct random r = random_begin("thesis_topspin_gains_so_much");
	double most[2] = {0, 0};
	for (int i = 0; i < 400000; i++) {
		struct ball a = moving((vec2){0, 0}, vec2_from_angle(random_in(&r, -M_PI, M_PI)), BALL_ROLLING, &table);
		struct ball b = ball_at(COLOUR_RED, (vec2){2 * table.ball_radius, 0});
		if (i & 1)
			b = moving(b.pos, vec2_scale(vec2_from_angle(random_in(&r, -M_PI, M_PI)), random_in(&r, 0, 2)),
				   BALL_ROLLING, &table);
		if (a.vel.x - b.vel.x <= 0)
			continue;
		double before = vec2_norm2(a.vel) + vec2_norm2(b.vel);
		contact_balls(&table, &model, &a, &b);
		most[i & 1] = fmax(most[i & 1], (vec2_norm2(a.vel) + vec2_norm2(b.vel)) / before);
	}
	ck_assert_double_eq_tol(most[0], 1.241, 2e-3);
	ck_assert_double_le(most[1], 1.411);
	ck_assert_double_ge(most[1], 1.38);
}
END_TEST

START_TEST(cushions_mirror)
{
	struct table table = scene_thesis_table();
	struct random r = random_begin("cushions_mirror");
	const char *const names[] = {"simple-elastic", "simple", "thesis"};
	for (int i = 0; i < 20000; i++) {
		struct model model = model_named(names[i % 3]);
		vec2 n = vec2_from_angle(random_in(&r, -M_PI, M_PI)), v = {random_in(&r, -3, 3), random_in(&r, -3, 3)};
		if (vec2_dot(v, n) >= 0)
			continue;
		struct ball b = moving((vec2){0, 0}, v, BALL_SLIDING, &table);
		struct nose nose = table_nose(&table, n, 0.03);
		contact_cushion(&table, &model, &nose, &b);
		double e = i % 3 == 1 ? table.material.e_cushion : 1,
		       keep = i % 3 == 2 ? 1 - table.material.loss_cushion : 1;
		ck_assert_double_eq_tol(vec2_dot(b.vel, n), -e * keep * vec2_dot(v, n), 1e-14);
		ck_assert_double_eq_tol(vec2_cross(b.vel, n), keep * vec2_cross(v, n), 1e-14);
		if (i % 3 == 2) {
			ck_assert_double_eq_tol(vec2_norm(b.vel), cushion_forward(&table, vec2_norm(v)), 1e-14);
			ck_assert_int_eq(b.phase, BALL_ROLLING);
		} else {
			ck_assert(b.spin[0] == 0 && b.spin[1] == 0);
		}
	}
}
END_TEST

/* Restitution of a cushion that is hit harder is less, by the same share in every law that has one. */
START_TEST(restitution_falls_with_speed)
{
	struct table table = scene_thesis_table();
	const char *const names[] = {"simple", "real", "real-mathavan"};
	table.material.cushion_fall = 0.08;
	table.material.mu_slide = 1e-4; /* Mathavan's cloth takes nothing */
	for (int k = 0; k < 3; k++) {
		struct model model = model_named(names[k]);
		for (double v = 0.01; v < 8; v *= 1.7) {
			struct nose nose = table_nose(&table, (vec2){-1, 0}, table.ball_radius);
			nose.mu = 0;
			nose.e = 0.9;
			struct ball b = moving((vec2){0, 0}, (vec2){v, 0.3}, BALL_SLIDING, &table);
			contact_cushion(&table, &model, &nose, &b);
			ck_assert_double_eq_tol(b.vel.x, -v * 0.9 / (1 + 0.08 * v), 1e-3 * v);
			ck_assert_double_eq_tol(b.vel.y, 0.3, 1e-3 * v);
		}
	}
}
END_TEST

/* The same between balls: single contacts of both models, and two at once. */
START_TEST(balls_that_hit_harder_lose_more)
{
	struct table table = scene_box_table(3, 1.5);
	table.material.ball_fall = 0.01;
	double d = 2 * table.ball_radius;
	for (double v = 0.02; v < 9; v *= 1.9) {
		double e = 0.95 / (1 + 0.01 * v);
		for (int k = 0; k < 2; k++) {
			struct model model = model_named(k ? "real" : "simple");
			struct ball a = moving((vec2){0, 0}, (vec2){v, 0}, BALL_SLIDING, &table);
			struct ball b = ball_at(COLOUR_RED, (vec2){d, 0});
			contact_balls(&table, &model, &a, &b);
			ck_assert_double_eq_tol(b.vel.x - a.vel.x, e * v, 1e-14 * v);
			/* one between two, all touching: each contact has half the geometry's approach */
			model.pocket = POCKET_MODEL_NONE;
			double half = sqrt(0.75), u = v * half;
			struct ball ball[3] = {moving((vec2){-d * half, 0}, (vec2){v, 0}, BALL_SLIDING, &table),
					       ball_at(COLOUR_RED, (vec2){0, d / 2}),
					       ball_at(COLOUR_RED, (vec2){0, -d / 2})};
			static struct sim sim;
			sim_init(&sim, &table, &model, ball, 3);
			table.material.mu_ball_a = table.material.mu_ball_b = 0;
			struct group group = {.contact = {{0, EVENT_BALL_BALL, 0, 1}, {0, EVENT_BALL_BALL, 0, 2}},
					      .count = 2,
					      .balls = 7};
			collide_balls(&sim, &group);
			vec2 n = {half, 0.5};
			double leave = vec2_dot(vec2_sub(sim.ball[1].vel, sim.ball[0].vel), n);
			ck_assert_double_eq_tol(leave, 0.95 / (1 + 0.01 * u) * u, 1e-3 * v);
		}
	}
}
END_TEST

/* Each cushion may have its own constants; the others keep the material's. */
START_TEST(a_cushion_of_its_own)
{
	struct table table = scene_box_table(3, 1.5);
	table.cushion[1].e = 0.5;  /* the right rail */
	table.cushion[0].mu = 0.4; /* the left one: each constant for itself */
	for (int right = 0; right < 2; right++) {
		for (int k = 0; k < 2; k++) {
			struct model model = model_named(k ? "real" : "simple");
			model.pocket = POCKET_MODEL_NONE;
			double x = (right ? 1 : -1) * (1.5 - table.ball_radius);
			struct ball ball = moving((vec2){x, 0}, (vec2){right ? 1 : -1, 0.5}, BALL_ROLLING, &table),
				    want = ball;
			struct nose nose = table_nose(&table, (vec2){right ? -1 : 1, 0}, table.cushion[0].nose_height);
			nose.e = right ? 0.5 : table.material.e_cushion;
			nose.mu = right ? table.material.mu_cushion : 0.4;
			static struct sim sim;
			struct event event;
			sim_init(&sim, &table, &model, &ball, 1);
			ck_assert(sim_step(&sim, &event) && event.kind == EVENT_CUSHION);
			contact_cushion(&table, &model, &nose, &want);
			ck_assert_double_eq_tol(sim.ball[0].vel.x, want.vel.x, 1e-12);
			ck_assert_double_eq_tol(sim.ball[0].vel.y, want.vel.y, 1e-12);
		}
	}
	table.cushion[1].e = 1.5;
	ck_assert_int_ne(table_finish(&table, NULL, 0), 0);
}
END_TEST

/* ---- together ---- */

/* A ball hits two that touch each other, full in the middle: the textbook's answer for elastic balls is -v/5 and
 * 2 sqrt(3) / 5 v at 30 degrees. */
START_TEST(one_on_two)
{
	struct table table = scene_box_table(3, 1.5);
	struct model model = model_named("simple-elastic");
	model.pocket = POCKET_MODEL_NONE;
	double d = 2 * table.ball_radius, v = 2;
	struct ball ball[3] = {moving((vec2){-d * sqrt(0.75) - 1e-4, 0}, (vec2){v, 0}, BALL_SLIDING, &table),
			       ball_at(COLOUR_RED, (vec2){0, d / 2}), ball_at(COLOUR_RED, (vec2){0, -d / 2})};
	struct sim sim;
	sim_init(&sim, &table, &model, ball, 3);
	struct event event;
	do
		ck_assert(sim_step(&sim, &event));
	while (event.kind != EVENT_BALL_BALL);
	double u = v - 1e-4 / v * table.material.mu_slide * table.material.gravity; /* to first order */
	ck_assert_double_eq_tol(sim.ball[0].vel.x, -u / 5, 1e-8);
	ck_assert_double_eq_tol(vec2_norm(sim.ball[1].vel), 2 * sqrt(3) / 5 * u, 1e-8);
	ck_assert_double_eq_tol(sim.ball[1].vel.y / sim.ball[1].vel.x, tan(M_PI / 6), 1e-12);
	ck_assert(sim_step(&sim, &event) && event.kind == EVENT_BALL_BALL);
	ck_assert(event.ball == 0 && event.other == 2);
}
END_TEST

/* Random clusters that are hit at once: momentum stays, energy never grows, every contact separates as its law says or
 * carries no impulse. */
START_TEST(clusters)
{
	struct table table = scene_box_table(3, 1.5);
	struct random r = random_begin("clusters");
	const char *const names[] = {"simple-elastic", "simple", "real"};
	for (int i = 0; i < 3000; i++) {
		struct model model = model_named(names[i % 3]);
		model.pocket = POCKET_MODEL_NONE;
		static struct sim sim;
		struct ball ball[7];
		double d = 2 * table.ball_radius;
		struct group group = {.count = 0, .balls = 127};
		vec2 before = {0, 0}, after = {0, 0};
		for (int k = 0; k < 7; k++) {
			vec2 at = k == 0 ? (vec2){0, 0} : vec2_scale(vec2_from_angle((k - 1) * M_PI / 3), d);
			ball[k] = ball_at(COLOUR_RED, at);
		}
		sim_init(&sim, &table, &model, ball, 7);
		for (int k = 0; k < 7; k++) {
			sim.ball[k].vel = (vec2){random_in(&r, -2, 2), random_in(&r, -2, 2)};
			sim.ball[k].phase = BALL_SLIDING;
			before = vec2_add(before, sim.ball[k].vel);
			for (int m = 0; m < k; m++) {
				vec2 n = vec2_sub(ball[k].pos, ball[m].pos);
				if (vec2_norm(n) < 1.01 * d &&
				    vec2_dot(vec2_sub(sim.ball[m].vel, sim.ball[k].vel), n) > 0)
					group.contact[group.count++] =
						(struct event){0, EVENT_BALL_BALL, (int16_t)m, (int16_t)k};
			}
		}
		double energy = sim_energy(&sim);
		collide_balls(&sim, &group);
		for (int k = 0; k < 7; k++)
			after = vec2_add(after, sim.ball[k].vel);
		ck_assert_double_le(vec2_dist(before, after), group.count ? 1e-4 : 0);
		ck_assert_double_le(sim_energy(&sim), energy * (1 + 1e-12));
		for (int k = 0; k < group.count && i % 3 < 2; k++) {
			const struct ball *a = &sim.ball[group.contact[k].ball], *b = &sim.ball[group.contact[k].other];
			ck_assert_double_ge(vec2_dot(vec2_sub(b->vel, a->vel), vec2_sub(b->pos, a->pos)), -1e-3);
		}
	}
}
END_TEST

/* Which contacts are one instant: those due within 4 ps that hang together by a shared ball, each once, in order. */
START_TEST(what_is_one_instant)
{
	struct table table = scene_box_table(3, 1.5);
	struct model model = model_named("real");
	struct ball ball[6];
	for (int i = 0; i < 6; i++)
		ball[i] = ball_at(COLOUR_RED, (vec2){0.2 * i - 0.5, 0});
	static struct sim sim;
	sim_init(&sim, &table, &model, ball, 6);
	queue_set_pair(&sim.queue, 1, 3, 1);
	queue_set_pair(&sim.queue, 0, 3, 1 + 3.9e-12); /* at once, shares ball 3 */
	queue_set_pair(&sim.queue, 0, 5, 1 + 1e-12);   /* hangs on by ball 0 */
	queue_set_pair(&sim.queue, 2, 4, 1);	       /* at once, shares nothing */
	queue_set_pair(&sim.queue, 2, 3, 1 + 4.5e-12); /* later */
	struct event first = {1, EVENT_BALL_BALL, 1, 3};
	struct group group;
	collide_collect(&sim, &first, &group);
	ck_assert_int_eq(group.count, 3);
	ck_assert_int_eq((int)group.balls, 1 << 0 | 1 << 1 | 1 << 3 | 1 << 5);
	const int want[3][2] = {{0, 3}, {0, 5}, {1, 3}};
	for (int i = 0; i < 3; i++) {
		ck_assert_int_eq(group.contact[i].ball, want[i][0]);
		ck_assert_int_eq(group.contact[i].other, want[i][1]);
		ck_assert_double_eq(group.contact[i].time, 1);
	}
}
END_TEST

/* A pressed pair parts with half the pressing acceleration times 2 ms, at the cost of its own motion. */
START_TEST(a_pressed_pair_parts)
{
	struct table table = scene_box_table(3, 1.5);
	struct model model = model_named("simple");
	model.pocket = POCKET_MODEL_NONE;
	double d = 2 * table.ball_radius, g = table.material.mu_slide * table.material.gravity;
	struct ball ball[2] = {ball_at(COLOUR_RED, (vec2){0, 0}), ball_at(COLOUR_RED, (vec2){d, 0})};
	ball[0].vel = (vec2){1e-3, 0};
	ball[0].spin[1] = 150; /* topspin drives it on */
	static struct sim sim;
	sim_init(&sim, &table, &model, ball, 2);
	double energy = sim_energy(&sim);
	struct group group = {.contact = {{0, EVENT_BALL_BALL, 0, 1}}, .count = 1, .balls = 3};
	collide_balls(&sim, &group);
	double leave = sim.ball[1].vel.x - sim.ball[0].vel.x;
	double rms = sqrt(1e-6 + 0.4 * table.ball_radius * table.ball_radius * 150 * 150);
	double interval = fmax(2e-3, 2e-3 * rms / g);
	/* the driven ball slides forward under its spin, the other backward against its own slip: both press */
	ck_assert_double_ge(leave, 0.49 * g * interval);
	ck_assert_double_le(leave, 1.01 * g * interval);
	ck_assert_double_le(sim_energy(&sim), energy * (1 + 1e-12));
	ck_assert_double_ge(sim_energy(&sim), 0.95 * energy);
}
END_TEST

/* The rule of pressing contacts by its own formula: a pair that the cloth presses parts with half the press times 2 ms or
 * 1/500 of the time in which the cloth could take all motion, at most a fifth of the root mean square speed; energy
 * pays. */
static void check_press(double vel, double spin, bool capped, bool long_interval)
{
	struct table table = scene_box_table(3, 1.5);
	struct model model = model_named("simple");
	double d = 2 * table.ball_radius, g = table.material.mu_slide * table.material.gravity;
	struct ball ball[2] = {ball_at(COLOUR_RED, (vec2){0, 0}), ball_at(COLOUR_RED, (vec2){d, 0})};
	ball[0].vel = (vec2){vel, 0};
	ball[0].spin[1] = spin;
	static struct sim sim;
	sim_init(&sim, &table, &model, ball, 2);
	struct group group = {.contact = {{0, EVENT_BALL_BALL, 0, 1}}, .count = 1, .balls = 3};
	collide_balls(&sim, &group);
	contact_balls(&table, &model, &ball[0], &ball[1]);
	double press = motion_acceleration(&ball[0], &table).x - motion_acceleration(&ball[1], &table).x;
	double leave = ball[1].vel.x - ball[0].vel.x, r2 = table.ball_radius * table.ball_radius, energy[2] = {0, 0};
	for (int i = 0; i < 2; i++)
		energy[0] += vec2_norm2(ball[i].vel) + 0.4 * r2 * ball[i].spin[1] * ball[i].spin[1];
	double rms = sqrt(energy[0]), interval = fmax(2e-3, 2e-3 * rms / g), lift = 0.5 * press * interval;
	ck_assert(capped == (lift > 0.2 * rms));
	ck_assert(long_interval == (interval > 2e-3));
	lift = fmin(lift, 0.2 * rms);
	ck_assert_double_lt(leave, lift);
	ball[0].vel.x -= 0.5 * (lift - leave);
	ball[1].vel.x += 0.5 * (lift - leave);
	for (int i = 0; i < 2; i++)
		energy[1] += vec2_norm2(ball[i].vel) + 0.4 * r2 * ball[i].spin[1] * ball[i].spin[1];
	double k = fmin(1, sqrt(energy[0] / energy[1]));
	ck_assert_double_eq_tol(sim.ball[0].vel.x, k * ball[0].vel.x, 1e-14);
	ck_assert_double_eq_tol(sim.ball[1].vel.x, k * ball[1].vel.x, 1e-14);
	ck_assert_double_eq_tol(sim.ball[0].spin[1], k * ball[0].spin[1], 1e-12);
}

START_TEST(pressing_by_its_formula)
{
	check_press(1e-3, 150, false, true);
	check_press(1e-3, 20, false, false);
	check_press(1e-4, 0.3, true, false);
}
END_TEST

/* More than 150 contacts of an instant: each parts the balls by 1e-4 of their speed more. Topspin counts for 32. */
START_TEST(cascades_are_bounded)
{
	struct table table = scene_thesis_table();
	double d = 2 * table.ball_radius;
	static struct sim sim;
	struct group group = {.contact = {{0, EVENT_BALL_BALL, 0, 1}}, .count = 1, .balls = 3};
	struct ball ball[2] = {moving((vec2){0, 0}, (vec2){1, 0}, BALL_ROLLING, &table),
			       ball_at(COLOUR_RED, (vec2){d, 0})};
	for (int n = 150; n <= 250; n += 50) {
		struct model model = model_named("simple");
		table.material.e_ball = 0;
		sim_init(&sim, &table, &model, ball, 2);
		sim.instant_contacts = n;
		collide_balls(&sim, &group);
		/* plastic balls: nothing but the lift; the rolling ball's own press is less than that of 50 contacts */
		double rms = sqrt(0.5 + 0.4), leave = sim.ball[1].vel.x - sim.ball[0].vel.x;
		ck_assert(n == 150 ? leave < 40e-4 * rms : fabs(leave - 1e-4 * (n - 150) * rms) < 2e-3 * leave);
	}
	for (int n = 32; n <= 33; n++) {
		struct model model = model_named("thesis");
		sim_init(&sim, &table, &model, ball, 2);
		sim.instant_contacts = n;
		collide_balls(&sim, &group);
		ck_assert_double_eq_tol(sim.ball[0].vel.x, n == 32 ? 0.25 * 0.95 : 0, 1e-12);
	}
}
END_TEST

/* On a level bed a rolling ball that leaves a cushion, however slowly, goes as it goes: its path leads away for good. */
START_TEST(rolling_off_a_cushion)
{
	struct table table = scene_box_table(3, 1.5);
	struct model model = model_named("real");
	static struct sim sim;
	struct ball ball = moving((vec2){0, 0.75 - table.ball_radius}, (vec2){1, -1e-9}, BALL_ROLLING, &table);
	sim_init(&sim, &table, &model, &ball, 1);
	struct nose nose = table_nose(&table, (vec2){0, -1}, 1.4 * table.ball_radius);
	collide_cushion(&sim, 0, &nose);
	ck_assert(sim.ball[0].vel.x == 1 && sim.ball[0].vel.y == -1e-9 && sim.ball[0].phase == BALL_ROLLING);
}
END_TEST

/* Thesis motion: who rolled rolls on along its new way, who slid slides anew without spin. */
START_TEST(thesis_phases_after_a_contact)
{
	struct table table = scene_thesis_table();
	struct model model = model_named("thesis");
	vec2 at = vec2_scale(vec2_from_angle(0.6), 2 * table.ball_radius);
	for (int rolls = 0; rolls < 2; rolls++) {
		struct ball a = moving((vec2){0, 0}, (vec2){2, 0}, rolls ? BALL_ROLLING : BALL_SLIDING, &table);
		struct ball b = ball_at(COLOUR_RED, at);
		contact_balls(&table, &model, &a, &b);
		ck_assert_int_eq(a.phase, rolls ? BALL_ROLLING : BALL_SLIDING);
		ck_assert_int_eq(b.phase, BALL_SLIDING);
		ck_assert(b.spin[0] == 0 && b.spin[1] == 0 && b.spin[2] == 0);
		ck_assert(!rolls || fabs(a.spin[1] * table.ball_radius - a.vel.x) < 1e-15);
	}
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("contact");
	TCase *tcase = tcase_create("contact");
	tcase_set_timeout(tcase, 60);
	tcase_add_test(tcase, simple_keeps_momentum_and_separates);
	tcase_add_test(tcase, thesis_without_topspin);
	tcase_add_test(tcase, thesis_topspin_variants);
	tcase_add_test(tcase, thesis_topspin_gains_so_much);
	tcase_add_test(tcase, cushions_mirror);
	tcase_add_test(tcase, restitution_falls_with_speed);
	tcase_add_test(tcase, balls_that_hit_harder_lose_more);
	tcase_add_test(tcase, a_cushion_of_its_own);
	tcase_add_test(tcase, one_on_two);
	tcase_add_test(tcase, clusters);
	tcase_add_test(tcase, what_is_one_instant);
	tcase_add_test(tcase, a_pressed_pair_parts);
	tcase_add_test(tcase, pressing_by_its_formula);
	tcase_add_test(tcase, cascades_are_bounded);
	tcase_add_test(tcase, rolling_off_a_cushion);
	tcase_add_test(tcase, thesis_phases_after_a_contact);
	suite_add_tcase(suite, tcase);
	return suite;
}
