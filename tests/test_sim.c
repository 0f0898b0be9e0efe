/* The whole simulation: invariants over random shots, repeatability, the interface. */
#include "harness.h"
#include "scenes.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "physics/motion.h"
#include "physics/queue.h"
#include "physics/sim.h"

static const char *const every_model[] = {"thesis", "simple", "simple-elastic", "real", "real-mathavan"};
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

/* ---- random positions and shots ---- */

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

/* ---- invariants ---- */

struct watch {
	const struct table *table;
	bool jaws;
	double slack;		     /* J, by which energy may seem to grow */
	double energy, start_energy; /* J */
	double overlap;		     /* m, deepest so far */
	double gain;		     /* share, largest growth of energy so far */
	double behind;		     /* m, farthest behind a rail's nose less a radius */
	int lost;		     /* balls that are not finite or off the table */
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
		/* counted: an assertion of its own at every ball and event would take longer than the simulation */
		w->lost += !ball_is_finite(&ball[i]) || fabs(ball[i].pos.x) > w->table->length / 2 + 0.1 ||
			   fabs(ball[i].pos.y) > w->table->width / 2 + 0.1;
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
	/* the clock's rounding, times an acceleration, is a velocity: below a billionth of the shot's energy it shows
	 */
	bool falls = w->slack > 0 && event->kind == EVENT_POCKET; /* takes its height with it */
	if (!may_gain(before, event) && !falls && w->start_energy != 0)
		w->gain = fmax(w->gain,
			       (energy - w->energy - w->slack) / fmax(fabs(w->energy), 1e-9 * fabs(w->start_energy)));
	w->energy = energy;
	struct ball now[BALL_MAX], middle[BALL_MAX];
	double half = 0.5 * (sim->time - before->time);
	struct sim at = *before;
	at.time = before->time + half;
	for (int i = 0; i < sim->ball_count; i++) {
		now[i] = sim_ball(sim, i);
		middle[i] = sim_ball(&at, i);
	}
	watch_balls(w, now, sim->ball_count);
	if (half > 0)
		watch_balls(w, middle, sim->ball_count);
	w->events++;
}

static void run_watched(struct watch *w, struct sim *sim)
{
	static struct sim before;
	struct event event;
	w->energy = w->start_energy = sim_energy(sim);
	int events = 0;
	for (;;) {
		before = *sim;
		double last = sim->time;
		if (!sim_step(sim, &event))
			break;
		if (!(sim->time >= last && isfinite(sim->time)) || ++events == EVENTS_MAX)
			ck_abort_msg("time %g after %g, %d events", sim->time, last, events);
		watch_step(w, &before, sim, &event);
	}
	struct ball end[BALL_MAX];
	for (int i = 0; i < sim->ball_count; i++) {
		end[i] = sim_ball(sim, i);
		w->lost += end[i].phase != BALL_REST && end[i].phase != BALL_POTTED;
	}
	watch_balls(w, end, sim->ball_count);
}

static void check_invariants(const char *name, const struct table *table, const struct model *model, int shots)
{
	struct random r = random_begin(name);
	/* on pieces the energy is as exact as the place: 10 um of 4 mm per metre, and a slow ball's 0.1 mm/s */
	struct watch w = {
		.table = table, .jaws = model->pocket == POCKET_MODEL_JAWS, .slack = table->bed.uneven ? 3e-7 : 0};
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
		int lost = w.lost;
		run_watched(&w, &sim);
		most = sim.event_count > most ? sim.event_count : most;
		if ((w.overlap > overlap && w.overlap > 1e-9) || (w.gain > gain && w.gain > 1e-9) ||
		    (w.behind > behind && w.behind > 1e-9) || w.lost > lost)
			printf("%s: shot %d, BILLIARD_TEST_SEED=%" PRIu64
			       ": overlap %.3g gain %.3g behind %.3g lost %d\n",
			       name, i, seed, w.overlap, w.gain, w.behind, w.lost);
	}
	printf("%s: %d shots, %d events watched, overlap %.2g m, energy gain %.2g, behind a rail %.2g m, most events "
	       "%d\n",
	       name, shots, w.events, w.overlap, w.gain, w.behind, most);
	fflush(stdout);
	ck_assert_int_eq(w.lost, 0);
	ck_assert_double_le(w.overlap, 1e-9);
	ck_assert_double_le(w.gain, 1e-9);
	ck_assert_double_le(w.behind, 1e-9);
}

START_TEST(invariants_thesis_table)
{
	struct table table = scene_thesis_table();
	struct model model = model_named(every_model[_i]);
	char name[64];
	snprintf(name, sizeof name, "invariants %s, thesis table", every_model[_i]);
	check_invariants(name, &table, &model, shots_wanted(_i == 4 ? 500 : 5000));
}
END_TEST

START_TEST(invariants_snooker_table)
{
	struct table table = scene_snooker_table();
	struct model model = model_named(every_model[_i]);
	char name[64];
	snprintf(name, sizeof name, "invariants %s, snooker table", every_model[_i]);
	check_invariants(name, &table, &model, shots_wanted(_i == 4 ? 500 : 5000));
}
END_TEST

START_TEST(invariants_no_pockets)
{
	struct table table = scene_box_table(1.0, 0.6);
	struct model model = model_named(every_model[_i]);
	model.pocket = POCKET_MODEL_NONE;
	char name[64];
	snprintf(name, sizeof name, "invariants %s, no pockets", every_model[_i]);
	check_invariants(name, &table, &model, shots_wanted(_i == 4 ? 300 : 3000));
}
END_TEST

/* A plane and a bowl: pieces of paths instead of closed forms. */
START_TEST(invariants_uneven)
{
	struct table table = scene_snooker_table();
	table.bed = (struct bed){.slope = {1.5e-3, -2e-3}, .bowl = {5e-4, -5e-4, 1e-3}};
	ck_assert_int_eq(table_finish(&table, NULL, 0), 0);
	struct model model = model_named(every_model[_i]);
	char name[64];
	snprintf(name, sizeof name, "invariants %s, uneven table", every_model[_i]);
	check_invariants(name, &table, &model, shots_wanted(_i == 4 ? 200 : 1000));
}
END_TEST

/* Contacts that overlap in time, from racks and positions with gaps of camera errors' size. */
START_TEST(invariants_lasting_contacts)
{
	struct table table = scene_snooker_table();
	table.material.hertz_modulus = 6.4e9;
	struct model model = model_named("real");
	ck_assert(model.lasting_contacts);
	check_invariants("invariants real, lasting contacts", &table, &model, shots_wanted(3000));
}
END_TEST

/* All that a real table has, at once. */
START_TEST(invariants_everything)
{
	struct table table = scene_snooker_table();
	table.bed = (struct bed){.slope = {-1e-3, 1e-3}, .bowl = {1e-3, 5e-4, 5e-4}};
	table.material.hertz_modulus = 6.4e9;
	table.material.cue_end_mass = 0.005;
	table.material.cushion_fall = 0.05;
	table.cushion[1].e = 0.54;
	table.cushion[1].mu = 0.35;
	ck_assert_int_eq(table_finish(&table, NULL, 0), 0);
	struct model model = model_named("real");
	check_invariants("invariants real, everything", &table, &model, shots_wanted(1000));
}
END_TEST

/* ---- repeatability ---- */

enum table_kind { PLAIN, LASTING, UNEVEN };

static struct table table_of_kind(enum table_kind kind)
{
	struct table table = scene_snooker_table();
	if (kind == LASTING)
		table.material.hertz_modulus = 6.4e9;
	if (kind == UNEVEN)
		table.bed = (struct bed){.slope = {1e-3, -1.5e-3}, .bowl = {5e-4, 2e-4, 1e-3}};
	ck_assert_int_eq(table_finish(&table, NULL, 0), 0);
	return table;
}

static uint64_t break_hash(const char *name, enum table_kind kind)
{
	static struct sim sim;
	struct table table = table_of_kind(kind);
	struct model model = model_named(name);
	struct sim_limits limits = {INFINITY, EVENTS_MAX};
	struct ball ball[SCENE_RACK_COUNT];
	scene_rack(&table, ball);
	sim_init(&sim, &table, &model, ball, SCENE_RACK_COUNT);
	struct shot shot = {.angle = 0.0625, .speed = 9.6, .side = 0.25, .follow = -0.125};
	sim_strike(&sim, 0, &shot);
	ck_assert_int_eq(sim_run(&sim, &limits, NULL), SIM_AT_REST);
	ck_assert_int_gt(sim.event_count, 50);
	return sim_hash(&sim, 0);
}

/* Recorded with gcc and clang, -O0 and -O2, on x86-64 and glibc 2.36: a change of one of these is a change of results.
 */
static const struct {
	const char *name;
	enum table_kind kind;
	uint64_t hash;
} golden[] = {
	{"thesis", PLAIN, 0xac778b2bad38e9d7},	       {"simple", PLAIN, 0xd215d73122f37fd7},
	{"simple-elastic", PLAIN, 0x2e1aa36f81a05d4d}, {"real", PLAIN, 0x3a5e40d726dca41e},
	{"real", LASTING, 0xd4773c29dd63f00b},	       {"real", UNEVEN, 0x52ea205b8d0be5b6},
	{"thesis", UNEVEN, 0x3ea89a50748d3197},
};
enum { GOLDEN = sizeof golden / sizeof *golden };

START_TEST(break_has_the_recorded_hash)
{
	uint64_t hash = break_hash(golden[_i].name, golden[_i].kind);
	printf("%s, table %d: 0x%016" PRIx64 "\n", golden[_i].name, (int)golden[_i].kind, hash);
	fflush(stdout);
	ck_assert(hash == golden[_i].hash);
	ck_assert(break_hash(golden[_i].name, golden[_i].kind) == hash);
}
END_TEST

START_TEST(a_copy_goes_on_alike)
{
	struct table table = scene_snooker_table();
	struct model model = model_named("real");
	struct ball ball[SCENE_RACK_COUNT];
	scene_rack(&table, ball);
	static struct sim one, other;
	sim_init(&one, &table, &model, ball, SCENE_RACK_COUNT);
	struct shot shot = {.angle = 0.1, .speed = 5};
	sim_strike(&one, 0, &shot);
	struct event e, f;
	for (int i = 0; i < 30; i++)
		sim_step(&one, &e);
	other = one;
	while (sim_step(&one, &e)) {
		ck_assert(sim_step(&other, &f));
		ck_assert_int_eq(event_compare(&e, &f), 0);
	}
	ck_assert(!sim_step(&other, &f));
	ck_assert(sim_hash(&one, 7) == sim_hash(&other, 7));
	ck_assert(sim_hash(&one, 7) != sim_hash(&one, 8));
}
END_TEST

/* ---- no allocation ---- */

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)
/* This program's own allocator counts; glibc's does the work. */
static unsigned long allocations;
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

void *malloc(size_t size)
{
	allocations++;
	return __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
	allocations++;
	return __libc_calloc(count, size);
}

void *realloc(void *old, size_t size)
{
	allocations++;
	return __libc_realloc(old, size);
}

START_TEST(a_simulation_allocates_nothing)
{
	static struct trace_entry entry[2000];
	static struct sim sim;
	struct table table = scene_snooker_table();
	struct ball ball[SCENE_RACK_COUNT];
	scene_rack(&table, ball);
	unsigned long before = allocations;
	void *volatile probe = malloc(10);
	free(probe);
	ck_assert_msg(allocations == before + 1, "the count does not work");
	before = allocations;
	for (int k = 0; k < MODELS; k++) {
		struct model model;
		struct trace trace;
		struct sim_limits limits = {INFINITY, 2000};
		struct shot shot = {.angle = 0.1, .speed = 9.6, .side = 0.2};
		model_from_name(every_model[k], &model);
		trace_init(&trace, entry, 2000);
		sim_init(&sim, &table, &model, ball, SCENE_RACK_COUNT);
		sim_strike(&sim, 0, &shot);
		sim_run(&sim, &limits, &trace);
		for (int i = 0; i < SCENE_RACK_COUNT; i++)
			trace_at(&trace, i, 1);
	}
	ck_assert_int_eq((int)(allocations - before), 0);
}
END_TEST
#else
START_TEST(a_simulation_allocates_nothing)
{
	printf("a_simulation_allocates_nothing: SKIPPED, the sanitizer has the allocator\n");
}
END_TEST
#endif

/* ---- the interface ---- */

/* The strike: side on the left gives clockwise spin, follow forward spin, an elevated cue tilts the side's axis. */
START_TEST(strike_gives_speed_and_spin)
{
	struct table table = scene_snooker_table();
	struct model model = model_named("real");
	struct ball ball = ball_at(COLOUR_WHITE, (vec2){0, 0});
	struct sim sim;
	double r = table.ball_radius;
	sim_init(&sim, &table, &model, &ball, 1);
	struct shot shot = {.angle = 0, .speed = 2, .side = 0.3, .follow = 0.4};
	sim_strike(&sim, 0, &shot);
	ck_assert_double_eq_tol(sim.ball[0].vel.x, 2, 1e-15);
	ck_assert_double_eq_tol(sim.ball[0].spin[0], 0, 1e-12);
	ck_assert_double_eq_tol(sim.ball[0].spin[1], 2 / r, 1e-9); /* 0.4 of the radius up: rolls at once */
	ck_assert_double_eq_tol(sim.ball[0].spin[2], -2.5 * 2 / r * 0.3, 1e-9);
	ck_assert_int_eq(sim.ball[0].phase, BALL_ROLLING);
	struct event event;
	ck_assert(sim_step(&sim, &event));
	ck_assert_int_eq(event.kind, EVENT_STRIKE);

	sim_init(&sim, &table, &model, &ball, 1);
	shot = (struct shot){.angle = M_PI / 2, .speed = 2, .side = 0.3, .elevation = M_PI / 6};
	sim_strike(&sim, 0, &shot);
	ck_assert_double_eq_tol(sim.ball[0].vel.y, 2, 1e-15);
	double k = 2.5 * 2 / (r * cos(M_PI / 6)) * 0.3;
	ck_assert_double_eq_tol(sim.ball[0].spin[1], -k * 0.5, 1e-9);
	ck_assert_double_eq_tol(sim.ball[0].spin[2], -k * cos(M_PI / 6), 1e-9);
}
END_TEST

/* Squirt by TP A.31 for a ball of 30 end masses: 1.886 degrees at half a radius, away from the side; undone exactly by
 * the cue's turn; none without an end mass. */
START_TEST(squirt_and_its_inverse)
{
	struct table table = scene_snooker_table();
	struct model model = model_named("real");
	struct ball ball = ball_at(COLOUR_WHITE, (vec2){0, 0});
	struct sim sim;
	ck_assert(shot_squirt(&table, 0.5) == 0);
	table.material.cue_end_mass = table.ball_mass / 30;
	ck_assert_double_eq_tol(shot_squirt(&table, 0.5), atan(2.5 * 0.5 * sqrt(0.75) / (31 + 2.5 * 0.75)), 1e-15);
	ck_assert_double_eq_tol(shot_squirt(&table, 0.5) * 180 / M_PI, 1.886, 1e-3);
	ck_assert_double_eq(shot_squirt(&table, -0.3), -shot_squirt(&table, 0.3));
	for (int k = -9; k <= 9; k++) {
		double side = 0.1 * k, want = 0.7;
		struct shot shot = {.angle = want + shot_squirt(&table, side), .speed = 3, .side = side, .follow = 0.1};
		sim_init(&sim, &table, &model, &ball, 1);
		sim_strike(&sim, 0, &shot);
		ck_assert_double_eq_tol(atan2(sim.ball[0].vel.y, sim.ball[0].vel.x), want, 1e-15);
		ck_assert_double_eq_tol(vec2_norm(sim.ball[0].vel), 3, 1e-14);
		ck_assert(k * sim.ball[0].spin[2] <= 0);
		shot.angle = 0;
		sim_init(&sim, &table, &model, &ball, 1);
		sim_strike(&sim, 0, &shot);
		ck_assert(k == 0 || k * sim.ball[0].vel.y < 0); /* left of the middle: to the right */
	}
}
END_TEST

START_TEST(limits_stop_a_run)
{
	struct table table = scene_snooker_table();
	struct model model = model_named("simple");
	struct ball ball[SCENE_RACK_COUNT];
	scene_rack(&table, ball);
	static struct sim sim;
	struct shot shot = {.angle = 0.1, .speed = 5};
	sim_init(&sim, &table, &model, ball, SCENE_RACK_COUNT);
	sim_strike(&sim, 0, &shot);
	struct sim_limits limits = {0.3, 10000};
	ck_assert_int_eq(sim_run(&sim, &limits, NULL), SIM_TIME_LIMIT);
	ck_assert_double_le(sim.time, 0.3);
	limits = (struct sim_limits){INFINITY, 3};
	int before = sim.event_count;
	ck_assert_int_eq(sim_run(&sim, &limits, NULL), SIM_EVENT_LIMIT);
	ck_assert_int_eq(sim.event_count, before + 3);
	limits.max_events = 10000;
	ck_assert_int_eq(sim_run(&sim, &limits, NULL), SIM_AT_REST);
	struct event event;
	ck_assert(!sim_step(&sim, &event));
	ck_assert_int_eq(sim_run(&sim, &limits, NULL), SIM_AT_REST);
}
END_TEST

/* A ball may be struck a second time, and a moving ball may be handed in. */
START_TEST(struck_again_while_moving)
{
	struct table table = scene_box_table(3, 1.5);
	struct model model = model_named("simple");
	model.pocket = POCKET_MODEL_NONE;
	struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){0, 0}), ball_at(COLOUR_RED, (vec2){1, 0})};
	ball[0].vel = (vec2){0, 1};
	struct sim sim;
	sim_init(&sim, &table, &model, ball, 2);
	struct sim_limits limits = {0.1, 100};
	ck_assert_int_eq(sim_run(&sim, &limits, NULL), SIM_TIME_LIMIT);
	struct shot shot = {.angle = 0, .speed = 1};
	vec2 to = vec2_sub(ball[1].pos, sim_ball(&sim, 0).pos);
	shot.angle = atan2(to.y, to.x);
	sim_strike(&sim, 0, &shot);
	struct event event;
	bool hit = false;
	while (sim_step(&sim, &event))
		hit = hit || event.kind == EVENT_BALL_BALL;
	ck_assert(hit);
}
END_TEST

/* A time limit does not cut through an instant: all contacts of a group are reported. */
START_TEST(a_limit_keeps_an_instant_whole)
{
	struct table table = scene_box_table(3, 1.5);
	struct model model = model_named("simple");
	model.pocket = POCKET_MODEL_NONE;
	double d = 2 * table.ball_radius;
	struct ball ball[3] = {ball_at(COLOUR_WHITE, (vec2){-d * sqrt(0.75) - 0.1, 0}),
			       ball_at(COLOUR_RED, (vec2){0, d / 2}), ball_at(COLOUR_RED, (vec2){0, -d / 2})};
	static struct sim sim, again;
	static struct trace_entry entry[100];
	struct trace trace;
	struct event event;
	struct shot shot = {.angle = 0, .speed = 2};
	sim_init(&sim, &table, &model, ball, 3);
	sim_strike(&sim, 0, &shot);
	do
		ck_assert(sim_step(&sim, &event));
	while (event.kind != EVENT_BALL_BALL);
	sim_init(&again, &table, &model, ball, 3);
	sim_strike(&again, 0, &shot);
	trace_init(&trace, entry, 100);
	ck_assert_int_eq(sim_run(&again, &(struct sim_limits){sim.time, 100}, &trace), SIM_TIME_LIMIT);
	int contacts = 0;
	for (int i = 0; i < trace.count; i++)
		contacts += trace.entry[i].event.kind == EVENT_BALL_BALL;
	ck_assert_int_eq(contacts, 2);
	ck_assert_int_eq(again.pending_count, 0);
}
END_TEST

/* An event found a little late lies behind the present: time stands still for it, and never runs back. */
START_TEST(time_never_runs_back)
{
	struct table table = scene_box_table(3, 1.5);
	struct model model = model_named("real");
	struct ball ball[3] = {ball_at(COLOUR_WHITE, (vec2){-0.5, 0}), ball_at(COLOUR_RED, (vec2){0, 0}),
			       ball_at(COLOUR_RED, (vec2){0, 0.2})};
	static struct sim sim;
	sim_init(&sim, &table, &model, ball, 3);
	struct shot shot = {.angle = 0, .speed = 1};
	sim_strike(&sim, 0, &shot);
	struct event event;
	do
		ck_assert(sim_step(&sim, &event));
	while (event.kind != EVENT_BALL_BALL);
	double now = sim.time;
	queue_set_pair(&sim.queue, 1, 2, now - 1e-12);
	vec2 place = sim_ball(&sim, 1).pos;
	ck_assert(sim_step(&sim, &event));
	ck_assert(event.ball == 1 && event.other == 2);
	ck_assert_double_eq(event.time, now);
	ck_assert_double_eq(sim.time, now);
	ck_assert(sim.ball_time[1] == now && sim.ball_time[2] == now);
	ck_assert(sim.ball[1].pos.x == place.x && sim.ball[1].pos.y == place.y);
	sim.queue.own[0].time = now - 1e-12;
	ck_assert(sim_step(&sim, &event));
	ck_assert_double_eq(event.time, now);
}
END_TEST

/* Every number of the state is in its hash, and nothing else: neither the sign of a zero nor padding. */
START_TEST(the_hash_sees_every_number)
{
	struct table table = scene_snooker_table();
	struct model model = model_named("real");
	struct ball ball[SCENE_RACK_COUNT];
	scene_rack(&table, ball);
	static struct sim sim, other;
	sim_init(&sim, &table, &model, ball, SCENE_RACK_COUNT);
	struct shot shot = {.angle = 0.1, .speed = 5, .side = 0.1};
	sim_strike(&sim, 0, &shot);
	uint64_t hash = sim_hash(&sim, 1);
	for (int i = 0; i < SCENE_RACK_COUNT; i++) {
		for (int k = 0; k < 10; k++) {
			other = sim;
			struct ball *b = &other.ball[i];
			double *number[] = {&b->pos.x,	 &b->pos.y,   &b->vel.x,   &b->vel.y,
					    &b->spin[0], &b->spin[1], &b->spin[2], &other.ball_time[i]};
			if (k < 8)
				*number[k] = nextafter(*number[k], INFINITY);
			else if (k == 8)
				b->phase = b->phase == BALL_REST ? BALL_SPINNING : BALL_REST;
			else
				b->colour = b->colour == COLOUR_RED ? COLOUR_PINK : COLOUR_RED;
			ck_assert_msg(sim_hash(&other, 1) != hash, "ball %d, number %d", i, k);
		}
	}
	other = sim;
	other.time = nextafter(sim.time, 1);
	ck_assert(sim_hash(&other, 1) != hash);
	other = sim;
	other.event_count++;
	ck_assert(sim_hash(&other, 1) != hash);
	other = sim;
	other.ball[3].vel = (vec2){-0.0, -0.0};
	ck_assert(sim_hash(&other, 1) == hash);
}
END_TEST

/* m v^2 / 2 + 2/5 m r^2 w^2 / 2 of what is on the table; in thesis motion translation only. */
START_TEST(energy_by_hand)
{
	struct table table = scene_snooker_table();
	struct model real = model_named("real"), thesis = model_named("thesis");
	struct ball ball[3] = {ball_at(COLOUR_WHITE, (vec2){0, 0}), ball_at(COLOUR_RED, (vec2){0.5, 0}),
			       ball_at(COLOUR_RED, (vec2){1, 0})};
	double m = table.ball_mass, r = table.ball_radius;
	ball[0].vel = (vec2){3, 4};
	ball[0].spin[0] = 10;
	ball[1].spin[2] = 20;
	ball[2].vel = (vec2){9, 9};
	ball[2].phase = BALL_POTTED;
	static struct sim sim;
	sim_init(&sim, &table, &real, ball, 3);
	ck_assert_double_eq_tol(sim_energy(&sim), 0.5 * m * (25 + 0.4 * r * r * 500), 1e-15);
	sim_init(&sim, &table, &thesis, ball, 3);
	ck_assert_double_eq_tol(sim_energy(&sim), 0.5 * m * 25, 1e-15);
}
END_TEST

/* The borders of what may be struck, a step inside and a step outside each. */
START_TEST(playable_shots)
{
	const struct {
		struct shot shot;
		bool ok;
	} row[] = {
		{{.speed = 1e-9}, true},
		{{.speed = 20}, true},
		{{.speed = 0}, false},
		{{.speed = -1}, false},
		{{.speed = 20.0001}, false},
		{{.speed = NAN}, false},
		{{.speed = 1, .angle = 1e6}, true},
		{{.speed = 1, .angle = NAN}, false},
		{{.speed = 1, .angle = INFINITY}, false},
		{{.speed = 1, .side = 0.6, .follow = 0.799}, true},
		{{.speed = 1, .side = 0.6, .follow = 0.8}, false},
		{{.speed = 1, .side = -1, .follow = 0}, false},
		{{.speed = 1, .side = NAN}, false},
		{{.speed = 1, .elevation = 1.57}, true},
		{{.speed = 1, .elevation = 1.5708}, false},
		{{.speed = 1, .elevation = -1e-9}, false},
		{{.speed = 1, .elevation = NAN}, false},
	};
	for (size_t i = 0; i < sizeof row / sizeof *row; i++)
		ck_assert_msg(shot_is_playable(&row[i].shot) == row[i].ok, "row %zu", i);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("sim");
	TCase *repeat = tcase_create("repeat");
	tcase_add_loop_test(repeat, break_has_the_recorded_hash, 0, GOLDEN);
	tcase_add_test(repeat, a_copy_goes_on_alike);
	tcase_add_test(repeat, a_simulation_allocates_nothing);
	suite_add_tcase(suite, repeat);
	TCase *interface = tcase_create("interface");
	tcase_add_test(interface, strike_gives_speed_and_spin);
	tcase_add_test(interface, squirt_and_its_inverse);
	tcase_add_test(interface, limits_stop_a_run);
	tcase_add_test(interface, struck_again_while_moving);
	tcase_add_test(interface, a_limit_keeps_an_instant_whole);
	tcase_add_test(interface, time_never_runs_back);
	tcase_add_test(interface, the_hash_sees_every_number);
	tcase_add_test(interface, energy_by_hand);
	tcase_add_test(interface, playable_shots);
	suite_add_tcase(suite, interface);
	TCase *invariants = tcase_create("invariants");
	tcase_set_timeout(invariants, 3600);
	tcase_add_loop_test(invariants, invariants_thesis_table, 0, MODELS);
	tcase_add_loop_test(invariants, invariants_snooker_table, 0, MODELS);
	tcase_add_loop_test(invariants, invariants_no_pockets, 0, MODELS);
	tcase_add_loop_test(invariants, invariants_uneven, 0, MODELS);
	tcase_add_test(invariants, invariants_lasting_contacts);
	tcase_add_test(invariants, invariants_everything);
	suite_add_tcase(suite, invariants);
	return suite;
}
