/* The whole simulation: invariants over random shots, repeatability, the interface. */
#include "harness.h"
#include "scenes.h"

#include <inttypes.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "physics/motion.h"
#include "physics/sim.h"

static const char *const model_names[] = {"thesis", "simple", "simple-elastic", "real", "real-mathavan"};
enum { MODELS = 5, EVENTS_MAX = 20000 };

static struct model model_named(const char *name)
{
	struct model model;
	ck_assert(model_from_name(name, &model));
	return model;
}

static int shots_wanted(int usual)
{
	const char *text = getenv("BILLIARD_TEST_SHOTS");
	return text ? atoi(text) : usual;
}

/* ---- random positions and shots ---------------------------------------------------------------------------------------- */

static bool is_free(const struct table *t, const struct ball *ball, int count, vec2 pos)
{
	double r = t->ball_radius;
	if (fabs(pos.x) > t->length / 2 - r || fabs(pos.y) > t->width / 2 - r)
		return false;
	for (int i = 0; i < t->pocket_count; i++) {
		if (vec2_dist(pos, t->pocket[i].centre) < t->pocket[i].radius + 1e-6)
			return false;
	}
	for (int i = 0; i < t->jaw_count; i++) {
		if (vec2_dist(pos, t->jaw[i].centre) < t->jaw[i].radius + r)
			return false;
	}
	for (int i = 0; i < count; i++) {
		if (vec2_dist(pos, ball[i].pos) < 2 * r)
			return false;
	}
	return true;
}

/* Anywhere, frozen to an earlier ball, or frozen to a rail. */
static vec2 random_place(struct random *r, const struct table *t, const struct ball *ball, int count)
{
	double x = t->length / 2 - t->ball_radius, y = t->width / 2 - t->ball_radius;
	vec2 pos = {random_in(r, -x, x), random_in(r, -y, y)};
	uint64_t kind = random_u64(r) % 4;
	if (kind == 0 && count > 0) {
		vec2 at = ball[random_u64(r) % (unsigned)count].pos;
		pos = vec2_madd(at, 2 * t->ball_radius, vec2_from_angle(random_in(r, 0, 2 * M_PI)));
	} else if (kind == 1 && random_u64(r) % 2) {
		pos.y = y;
	}
	return pos;
}

static int random_position(struct random *r, const struct table *t, struct ball *ball)
{
	int wanted = 2 + (int)(random_u64(r) % (BALL_MAX - 1)), count = 0;
	for (int tries = 0; count < wanted && tries < 2000; tries++) {
		vec2 pos = random_place(r, t, ball, count);
		if (is_free(t, ball, count, pos))
			ball[count++] = ball_at(COLOUR_RED, pos);
	}
	return count;
}

static struct shot random_shot(struct random *r)
{
	struct shot shot = {.angle = random_in(r, -M_PI, M_PI), .speed = random_in(r, 0.05, 9.6)};
	double offset = random_in(r, 0, 0.7), around = random_in(r, 0, 2 * M_PI);
	if (random_u64(r) % 8 == 0)
		shot.speed = 20 * pow(10, random_in(r, -7, 0));
	shot.side = offset * cos(around);
	shot.follow = offset * sin(around);
	shot.elevation = random_u64(r) % 2 ? random_in(r, 0, 1.2) : 0;
	return shot;
}

/* ---- invariants -------------------------------------------------------------------------------------------------------- */

struct watch {
	const struct table *table;
	bool jaws;
	double energy;
	double overlap;	 /* m, deepest so far */
	double gain;	 /* share, largest growth of energy so far */
	double behind;	 /* m, farthest behind a rail's nose less a radius */
	int events;
};

static void watch_balls(struct watch *w, const struct ball *ball, int count)
{
	for (int i = 0; i < count; i++) {
		for (int k = 0; k < i; k++) {
			if (ball[i].phase == BALL_POTTED || ball[k].phase == BALL_POTTED)
				continue;
			double overlap = 2 * w->table->ball_radius - vec2_dist(ball[i].pos, ball[k].pos);
			w->overlap = fmax(w->overlap, overlap);
		}
		for (int k = 0; k < w->table->cushion_count; k++) {
			const struct cushion *c = &w->table->cushion[k];
			vec2 rel = vec2_sub(ball[i].pos, c->a);
			double foot = vec2_dot(rel, c->along);
			if (!c->main_rail || ball[i].phase == BALL_POTTED || foot < 0 || foot > c->span)
				continue;
			double limit = w->jaws ? w->table->ball_radius : 0;
			w->behind = fmax(w->behind, limit - vec2_dot(rel, c->normal));
		}
		ck_assert(ball_is_finite(&ball[i]));
		ck_assert(fabs(ball[i].pos.x) < w->table->length / 2 + 0.1);
		ck_assert(fabs(ball[i].pos.y) < w->table->width / 2 + 0.1);
	}
}

/* The thesis' topspin is the one law here that can add energy: at a contact of a rolling ball (docs/physics.md). */
static bool may_gain(const struct sim *before, const struct event *event)
{
	if (!before->model.thesis_motion || event->kind != EVENT_BALL_BALL)
		return false;
	for (int i = 0; i < before->ball_count; i++) {
		if (before->ball[i].phase == BALL_ROLLING)
			return true;
	}
	return false;
}

static void watch_step(struct watch *w, const struct sim *before, const struct sim *sim, const struct event *event)
{
	double energy = sim_energy(sim);
	if (!may_gain(before, event) && w->energy > 0)
		w->gain = fmax(w->gain, energy / w->energy - 1);
	w->energy = energy;
	struct ball now[BALL_MAX], middle[BALL_MAX];
	double half = 0.5 * (sim->time - before->time);
	for (int i = 0; i < sim->ball_count; i++) {
		now[i] = sim_ball(sim, i);
		struct sim at = *before;
		at.time = before->time + half;
		middle[i] = sim_ball(&at, i);
	}
	watch_balls(w, now, sim->ball_count);
	if (half > 0)
		watch_balls(w, middle, sim->ball_count);
	w->events++;
}

static void run_watched(struct watch *w, struct sim *sim, struct random *r)
{
	static struct sim before;
	struct event event;
	int watched = (int)(random_u64(r) % 8); /* copying the whole state at each event is dear: one shot in eight is */
	w->energy = sim_energy(sim);
	int events = 0;
	for (;;) {
		if (watched == 0)
			before = *sim;
		double last = sim->time;
		if (!sim_step(sim, &event))
			break;
		ck_assert(sim->time >= last && isfinite(sim->time));
		ck_assert_int_lt(++events, EVENTS_MAX);
		if (watched == 0)
			watch_step(w, &before, sim, &event);
	}
	struct ball end[BALL_MAX];
	for (int i = 0; i < sim->ball_count; i++) {
		end[i] = sim_ball(sim, i);
		ck_assert(end[i].phase == BALL_REST || end[i].phase == BALL_POTTED);
	}
	watch_balls(w, end, sim->ball_count);
}

static void check_invariants(const char *name, const struct table *table, const struct model *model, int shots)
{
	struct random r = random_begin(name);
	struct watch w = {.table = table, .jaws = model->pocket == POCKET_MODEL_JAWS};
	static struct sim sim;
	int most = 0;
	for (int i = 0; i < shots; i++) {
		struct ball ball[BALL_MAX];
		uint64_t seed = r.state;
		int count = random_position(&r, table, ball);
		struct shot shot = random_shot(&r);
		sim_init(&sim, table, model, ball, count);
		sim_strike(&sim, 0, &shot);
		double overlap = w.overlap, gain = w.gain, behind = w.behind;
		run_watched(&w, &sim, &r);
		most = sim.event_count > most ? sim.event_count : most;
		if ((w.overlap > overlap && w.overlap > 1e-9) || (w.gain > gain && w.gain > 1e-9) ||
		    (w.behind > behind && w.behind > 1e-9))
			printf("%s: shot %d, BILLIARD_TEST_SEED=%" PRIu64 ": overlap %.3g gain %.3g behind %.3g\n",
			       name, i, seed, w.overlap, w.gain, w.behind);
	}
	printf("%s: %d shots, %d events watched, overlap %.2g m, energy gain %.2g, behind a rail %.2g m, most events %d\n",
	       name, shots, w.events, w.overlap, w.gain, w.behind, most);
	ck_assert_double_le(w.overlap, 1e-9);
	ck_assert_double_le(w.gain, 1e-9);
	ck_assert_double_le(w.behind, 1e-9);
}

START_TEST(invariants_thesis_table)
{
	struct table table = scene_thesis_table();
	struct model model = model_named(model_names[_i]);
	char name[64];
	snprintf(name, sizeof name, "invariants %s, thesis table", model_names[_i]);
	check_invariants(name, &table, &model, shots_wanted(_i == 4 ? 60 : 2000));
}
END_TEST

START_TEST(invariants_snooker_table)
{
	struct table table = scene_snooker_table();
	struct model model = model_named(model_names[_i]);
	char name[64];
	snprintf(name, sizeof name, "invariants %s, snooker table", model_names[_i]);
	check_invariants(name, &table, &model, shots_wanted(_i == 4 ? 60 : 2000));
}
END_TEST

START_TEST(invariants_no_pockets)
{
	struct table table = scene_box_table(1.0, 0.6);
	struct model model = model_named(model_names[_i]);
	model.pocket = POCKET_MODEL_NONE;
	char name[64];
	snprintf(name, sizeof name, "invariants %s, no pockets", model_names[_i]);
	check_invariants(name, &table, &model, shots_wanted(_i == 4 ? 60 : 1000));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("sim");
	TCase *invariants = tcase_create("invariants");
	tcase_set_timeout(invariants, 3600);
	tcase_add_loop_test(invariants, invariants_thesis_table, 0, MODELS);
	tcase_add_loop_test(invariants, invariants_snooker_table, 0, MODELS);
	tcase_add_loop_test(invariants, invariants_no_pockets, 0, MODELS);
	suite_add_tcase(suite, invariants);
	return suite;
}
