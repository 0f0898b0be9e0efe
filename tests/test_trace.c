/* The trace tells at any time what the simulation itself would. */
#include "harness.h"
#include "scenes.h"

#include <math.h>

#include "physics/sim.h"

enum { ENTRIES = 3000 };
static struct trace_entry entry[ENTRIES];

static void break_shot(struct sim *sim, const struct table *table, const char *name)
{
	struct model model;
	ck_assert(model_from_name(name, &model));
	struct ball ball[SCENE_RACK_COUNT];
	scene_rack(table, ball);
	sim_init(sim, table, &model, ball, SCENE_RACK_COUNT);
	struct shot shot = {.angle = 0.1, .speed = 7, .side = 0.2, .follow = 0.1};
	sim_strike(sim, 0, &shot);
}

static const char *const names[] = {"thesis", "simple", "real"};

START_TEST(agrees_with_the_simulation)
{
	struct table table = scene_snooker_table();
	static struct sim sim, again;
	struct trace trace;
	struct sim_limits limits = {INFINITY, ENTRIES};
	trace_init(&trace, entry, ENTRIES);
	break_shot(&sim, &table, names[_i]);
	ck_assert_int_eq(sim_run(&sim, &limits, &trace), SIM_AT_REST);
	ck_assert_int_eq(trace.count, sim.event_count);
	ck_assert_double_eq(trace_end(&trace), sim.time);
	break_shot(&again, &table, names[_i]);
	struct event event;
	struct sim before = again;
	while (sim_step(&again, &event)) {
		double middle = 0.5 * (before.time + again.time);
		for (int i = 0; i < again.ball_count && middle > before.time && middle < again.time; i++) {
			struct sim at = before;
			at.time = middle;
			struct ball want = sim_ball(&at, i), got = trace_at(&trace, i, middle);
			ck_assert_double_le(vec2_dist(want.pos, got.pos), 1e-12);
			ck_assert_double_le(vec2_dist(want.vel, got.vel), 1e-12);
			ck_assert_int_eq(want.phase, got.phase);
		}
		before = again;
	}
	for (int i = 0; i < sim.ball_count; i++) {
		struct ball end = trace_at(&trace, i, sim.time + 10);
		ck_assert(end.pos.x == sim.ball[i].pos.x && end.pos.y == sim.ball[i].pos.y);
	}
}
END_TEST

static struct ball last_after(const struct trace *trace, int ball, int upto, double *time)
{
	struct ball last = trace->start[ball];
	*time = 0;
	for (int i = 0; i <= upto; i++) {
		const struct event *e = &trace->entry[i].event;
		if (e->ball != ball && !(e->kind == EVENT_BALL_BALL && e->other == ball))
			continue;
		last = trace->entry[i].after[e->ball != ball];
		*time = e->time;
	}
	return last;
}

/* At an event's own time the state is that after it, down to velocity, spin and phase; a moment before, that before. */
START_TEST(an_event_counts_from_its_own_time)
{
	struct table table = scene_snooker_table();
	static struct sim sim;
	struct trace trace;
	struct sim_limits limits = {INFINITY, ENTRIES};
	trace_init(&trace, entry, ENTRIES);
	break_shot(&sim, &table, names[_i]);
	sim_run(&sim, &limits, &trace);
	int turned = 0;
	for (int i = 0; i < trace.count; i++) {
		const struct event *e = &trace.entry[i].event;
		bool last_of_instant = i + 1 == trace.count || trace.entry[i + 1].event.time > e->time;
		bool first_of_instant = i > 0 && trace.entry[i - 1].event.time < e->time;
		struct ball want = trace.entry[i].after[0], got = trace_at(&trace, e->ball, e->time);
		if (last_of_instant) {
			ck_assert(got.vel.x == want.vel.x && got.vel.y == want.vel.y && got.phase == want.phase);
			ck_assert(got.spin[0] == want.spin[0] && got.spin[1] == want.spin[1] &&
				  got.spin[2] == want.spin[2]);
			ck_assert(got.pos.x == want.pos.x && got.pos.y == want.pos.y);
		}
		if (!first_of_instant)
			continue;
		double moment = e->time - 1e-9, begin;
		struct ball before = last_after(&trace, e->ball, i - 1, &begin);
		if (moment <= begin)
			continue;
		got = trace_at(&trace, e->ball, moment);
		ck_assert_int_eq(got.phase, before.phase);
		turned += e->kind <= EVENT_JAW && vec2_dist(got.vel, want.vel) > 0.01;
	}
	ck_assert_int_gt(turned, 5);
}
END_TEST

/* A phase does not outlast its end, whatever the clock says: time before the start is the start, and a ball whose trace
 * was cut off stops where its phase does. */
START_TEST(a_cut_trace_stops)
{
	struct table table = scene_snooker_table();
	struct trace trace;
	trace_init(&trace, NULL, 0);
	trace.table = &table;
	trace.ball_count = 1;
	trace.start[0] = ball_at(COLOUR_WHITE, (vec2){0, 0});
	trace.start[0].vel = (vec2){0.2, 0};
	trace.start[0].spin[1] = 0.2 / table.ball_radius;
	trace.start[0].phase = BALL_ROLLING;
	double way = 0.5 * 0.2 * 0.2 / (table.material.mu_roll * table.material.gravity);
	ck_assert_double_eq_tol(trace_at(&trace, 0, 1000).pos.x, way, 1e-12);
	ck_assert_double_eq(trace_at(&trace, 0, 0).vel.x, 0.2);
	ck_assert_double_eq(trace_at(&trace, 0, -1).pos.x, 0);
	ck_assert_double_eq(trace_at(&trace, 0, -1).vel.x, 0.2);
}
END_TEST

START_TEST(keeps_the_first_when_full)
{
	struct table table = scene_snooker_table();
	static struct sim sim;
	struct trace trace;
	struct sim_limits limits = {INFINITY, ENTRIES};
	trace_init(&trace, entry, 5);
	break_shot(&sim, &table, "simple");
	sim_run(&sim, &limits, &trace);
	ck_assert(trace.overflow);
	ck_assert_int_eq(trace.count, 5);
	ck_assert_int_eq(trace.entry[0].event.kind, EVENT_STRIKE);
}
END_TEST

START_TEST(an_empty_trace_is_the_start)
{
	struct table table = scene_snooker_table();
	struct trace trace;
	trace_init(&trace, NULL, 0);
	trace.table = &table;
	trace.ball_count = 1;
	trace.start[0] = ball_at(COLOUR_BLUE, (vec2){0.1, 0.2});
	ck_assert_double_eq(trace_end(&trace), 0);
	ck_assert_double_eq(trace_at(&trace, 0, 3).pos.x, 0.1);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("trace");
	TCase *tcase = tcase_create("trace");
	tcase_set_timeout(tcase, 60);
	tcase_add_loop_test(tcase, agrees_with_the_simulation, 0, 3);
	tcase_add_loop_test(tcase, an_event_counts_from_its_own_time, 0, 3);
	tcase_add_test(tcase, a_cut_trace_stops);
	tcase_add_test(tcase, keeps_the_first_when_full);
	tcase_add_test(tcase, an_empty_trace_is_the_start);
	suite_add_tcase(suite, tcase);
	return suite;
}
