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

START_TEST(windows_join)
{
	struct table table = scene_snooker_table();
	static struct sim sim;
	static struct keyframe_window window[500];
	struct trace trace;
	struct sim_limits limits = {INFINITY, ENTRIES};
	trace_init(&trace, entry, ENTRIES);
	break_shot(&sim, &table, names[_i]);
	sim_run(&sim, &limits, &trace);
	int moving = 0;
	for (int ball = 0; ball < sim.ball_count; ball++) {
		int n = trace_windows(&trace, ball, window, 500);
		ck_assert_int_le(n, 500);
		ck_assert_int_eq(trace_windows(&trace, ball, window, 0), n);
		moving += n > 0;
		double last = 0;
		for (int k = 0; k < n; k++) {
			ck_assert_double_eq(window[k].begin, last);
			ck_assert_double_lt(window[k].begin, window[k].end);
			/* an event changes velocities, never positions */
			if (k > 0)
				ck_assert_double_le(vec2_dist(window[k].from.pos, window[k - 1].to.pos), 1e-12);
			last = window[k].end;
		}
	}
	ck_assert_int_gt(moving, 5);
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
	ck_assert_int_eq(trace_windows(&trace, 0, NULL, 0), 0);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("trace");
	TCase *tcase = tcase_create("trace");
	tcase_set_timeout(tcase, 60);
	tcase_add_loop_test(tcase, agrees_with_the_simulation, 0, 3);
	tcase_add_loop_test(tcase, windows_join, 0, 3);
	tcase_add_test(tcase, keeps_the_first_when_full);
	tcase_add_test(tcase, an_empty_trace_is_the_start);
	suite_add_tcase(suite, tcase);
	return suite;
}
