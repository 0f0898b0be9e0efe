#include "app/control/fsm.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness.h"

enum { CONTENT = FSM_DO_CLEAR | FSM_DO_SHOW | FSM_DO_NOTE };

static const struct fsm_limits limits = {5, 60};

static struct fsm at(enum fsm_state state)
{
	return (struct fsm){state, 10};
}

/* What a step from state by event leads to and asks for. */
static unsigned step(enum fsm_state state, enum fsm_event event, enum fsm_state *next)
{
	struct fsm fsm = at(state);
	unsigned actions = fsm_step(&fsm, event, 11);
	*next = fsm.state;
	return actions;
}

#define FOR_ALL_CELLS(s, e)                                                                                            \
	for (enum fsm_state s = 0; s < FSM_STATE_COUNT; s++)                                                           \
		for (enum fsm_event e = 0; e < FSM_EVENT_COUNT; e++)

START_TEST(every_state_is_reached_from_the_first)
{
	bool reached[FSM_STATE_COUNT] = {[FSM_BLIND] = true};
	for (int round = 0; round < FSM_STATE_COUNT; round++)
		FOR_ALL_CELLS(s, e)
		{
			enum fsm_state next;
			if (!reached[s])
				continue;
			step(s, e, &next);
			reached[next] = true;
		}
	for (int s = 0; s < FSM_STATE_COUNT; s++)
		ck_assert_msg(reached[s], "%s cannot be reached", fsm_state_name((enum fsm_state)s));
}
END_TEST

/* No state is a trap: from each there is a way to a new request. */
START_TEST(planning_is_reached_from_every_state)
{
	bool leads[FSM_STATE_COUNT] = {[FSM_PLANNING] = true};
	for (int round = 0; round < FSM_STATE_COUNT; round++)
		FOR_ALL_CELLS(s, e)
		{
			enum fsm_state next;
			step(s, e, &next);
			leads[s] = leads[s] || leads[next];
		}
	for (int s = 0; s < FSM_STATE_COUNT; s++)
		ck_assert_msg(leads[s], "no way out of %s", fsm_state_name((enum fsm_state)s));
}
END_TEST

START_TEST(unwritten_cells_change_nothing)
{
	FOR_ALL_CELLS(s, e)
	{
		struct fsm fsm = at(s);
		unsigned actions = fsm_step(&fsm, e, 11);
		if (fsm.state != s)
			ck_assert_double_eq(fsm.since, 11);
		if (!fsm_written(s, e))
			ck_assert(actions == 0 && fsm.state == s && fsm.since == 10);
	}
}
END_TEST

START_TEST(planning_is_entered_only_with_a_request)
{
	FOR_ALL_CELLS(s, e)
	{
		enum fsm_state next;
		unsigned actions = step(s, e, &next);
		if (s != FSM_PLANNING && next == FSM_PLANNING)
			ck_assert_msg(actions & (FSM_DO_REQUEST | FSM_DO_REPEAT), "%s, %s", fsm_state_name(s),
				      fsm_event_name(e));
		if (next != FSM_PLANNING)
			ck_assert(!(actions & (FSM_DO_REQUEST | FSM_DO_REPEAT)));
		if (actions & FSM_DO_REPEAT)
			ck_assert_int_eq(s, FSM_PLANNING);
	}
}
END_TEST

START_TEST(planning_is_left_without_an_answer_only_with_a_cancel)
{
	FOR_ALL_CELLS(s, e)
	{
		enum fsm_state next;
		unsigned actions = step(s, e, &next);
		bool answer = e == FSM_READY || e == FSM_NONE,
		     left = next != FSM_PLANNING || (actions & FSM_DO_REQUEST);
		bool wanted = s == FSM_PLANNING && left && !answer;
		ck_assert_msg(wanted == !!(actions & FSM_DO_CANCEL), "%s, %s", fsm_state_name(s), fsm_event_name(e));
	}
}
END_TEST

/* The picture: what is shown in SHOWING goes when SHOWING is left, and is never left without being replaced or cleared.
 */
START_TEST(a_proposal_never_stays_on_a_table_that_changed)
{
	FOR_ALL_CELLS(s, e)
	{
		enum fsm_state next;
		unsigned actions = step(s, e, &next);
		if (s == FSM_SHOWING && next != FSM_SHOWING)
			ck_assert(actions & FSM_DO_CLEAR);
		if (next == FSM_SHOWING && fsm_written(s, e))
			ck_assert(actions & (FSM_DO_SHOW | FSM_DO_NOTE | FSM_DO_REDRAW));
		if (actions & FSM_DO_SHOW)
			ck_assert_int_eq(next, FSM_SHOWING);
		/* At most one of showing and saying why not. */
		ck_assert((actions & (FSM_DO_SHOW | FSM_DO_NOTE)) != (FSM_DO_SHOW | FSM_DO_NOTE));
	}
}
END_TEST

START_TEST(losing_the_table_is_always_said)
{
	for (enum fsm_state s = 0; s < FSM_PAUSED; s++) {
		enum fsm_state next;
		unsigned actions = step(s, FSM_LOST, &next);
		ck_assert_int_eq(next, FSM_BLIND);
		ck_assert(actions & FSM_DO_NOTE);
		actions = step(s, FSM_SILENT, &next);
		ck_assert_int_eq(next, FSM_BLIND);
		ck_assert(actions & FSM_DO_NOTE);
	}
}
END_TEST

/* Whatever is on the table, light for balls that moved goes: in every state, on every way. */
START_TEST(a_ball_that_moves_clears_the_picture_in_every_state)
{
	for (enum fsm_state s = 0; s < FSM_PAUSED; s++) {
		enum fsm_state next;
		unsigned actions = step(s, FSM_MOVING, &next);
		ck_assert_msg(actions & FSM_DO_CLEAR, "%s", fsm_state_name(s));
		ck_assert(next == FSM_SHOT || next == FSM_WATCHING);
	}
	/* Other balls than those asked for: what is drawn for them goes, too. */
	for (enum fsm_state s = 0; s < FSM_PAUSED; s++) {
		enum fsm_state next;
		ck_assert(step(s, FSM_STABLE, &next) & FSM_DO_CLEAR);
	}
}
END_TEST

/* From every state there is a way out; by what can happen at the table alone, but for PAUSED. */
START_TEST(no_state_is_without_a_way_out)
{
	for (enum fsm_state s = 0; s < FSM_STATE_COUNT; s++) {
		int ways = 0;
		for (enum fsm_event e = 0; e < FSM_EVENT_COUNT; e++) {
			enum fsm_state next;
			step(s, e, &next);
			ways += next != s && (s == FSM_PAUSED || e < FSM_PAUSE);
		}
		ck_assert_msg(ways > 0, "%s", fsm_state_name(s));
	}
}
END_TEST

/* The drawing holds every written cell and nothing else. */
START_TEST(the_drawing_is_the_table)
{
	char *text = NULL;
	size_t size = 0;
	FILE *out = open_memstream(&text, &size);
	ck_assert_ptr_nonnull(out);
	fsm_write_dot(out);
	fclose(out);
	int cells = 0, said = 0;
	FOR_ALL_CELLS(s, e)
	{
		enum fsm_state next;
		char arrow[64];
		step(s, e, &next);
		snprintf(arrow, sizeof arrow, "\t%s -> %s ", fsm_state_name(s), fsm_state_name(next));
		if (!fsm_written(s, e))
			continue;
		cells++;
		const char *line = strstr(text, arrow);
		ck_assert_msg(line != NULL, "%s", arrow);
		const char *name = strstr(line, fsm_event_name(e));
		ck_assert_msg(name && name < strchr(line, '\n'), "%s %s", arrow, fsm_event_name(e));
	}
	for (const char *p = strstr(text, " / "); p; p = strstr(p + 1, " / "))
		said++;
	ck_assert_int_eq(said, cells);
	/* docs/fsm.dot is this drawing (`build/billiard fsm --dot >docs/fsm.dot`). */
	static char kept[16384];
	FILE *file = fopen("docs/fsm.dot", "r");
	ck_assert_ptr_nonnull(file);
	kept[fread(kept, 1, sizeof kept - 1, file)] = 0;
	fclose(file);
	ck_assert_msg(strcmp(kept, text) == 0, "docs/fsm.dot is another table");
	free(text);
}
END_TEST

START_TEST(pause_holds_whatever_is_seen)
{
	for (enum fsm_state s = 0; s < FSM_STATE_COUNT; s++) {
		enum fsm_state next;
		step(s, FSM_PAUSE, &next);
		ck_assert_int_eq(next, FSM_PAUSED);
	}
	for (enum fsm_event e = 0; e < FSM_EVENT_COUNT; e++) {
		enum fsm_state next;
		unsigned actions = step(FSM_PAUSED, e, &next);
		ck_assert_int_eq(next, e == FSM_RESUME || e == FSM_TOGGLE ? FSM_BLIND : FSM_PAUSED);
		ck_assert_uint_eq(actions & ~(unsigned)(FSM_DO_CLEAR | FSM_DO_REDRAW | FSM_DO_FORGET), 0);
	}
}
END_TEST

START_TEST(only_waiting_states_time_out)
{
	FOR_ALL_CELLS(s, e)
	{
		struct fsm fsm = at(s);
		double left = fsm_timeout(&fsm, &limits, 12);
		ck_assert_msg(fsm_written(s, FSM_TIMEOUT) == isfinite(left), "%s", fsm_state_name(s));
		ck_assert_double_ge(left, 0);
		if (e == FSM_TIMEOUT && fsm_written(s, e)) {
			/* Never an event without end at one instant: the step restarts the timer. */
			fsm_step(&fsm, FSM_TIMEOUT, 100);
			ck_assert_double_gt(fsm_timeout(&fsm, &limits, 100), 0);
		}
	}
	struct fsm fsm = at(FSM_PLANNING);
	ck_assert_double_eq_tol(fsm_timeout(&fsm, &limits, 12), 3, 1e-12);
	ck_assert_double_eq(fsm_timeout(&fsm, &limits, 1000), 0);
	/* A shot that nobody saw come to rest: not while balls can still roll, but not for ever. */
	fsm = at(FSM_SHOT);
	ck_assert_double_gt(fsm_timeout(&fsm, &limits, fsm.since + 45), 0);
	ck_assert_double_eq(fsm_timeout(&fsm, &limits, fsm.since + 90), 0);
}
END_TEST

/* Any sequence: never two requests under way without a cancel between, no cancel without a request. */
START_TEST(random_sequences_keep_requests_and_cancels_paired)
{
	struct random random = random_begin("fsm");
	struct fsm fsm = {FSM_BLIND, 0};
	bool waits = false, lit = false;
	for (int i = 0; i < 200000; i++) {
		enum fsm_event e = (enum fsm_event)(random_u64(&random) % FSM_EVENT_COUNT);
		unsigned actions = fsm_step(&fsm, e, i);
		ck_assert(!(actions & FSM_DO_CANCEL) || waits);
		if (actions & FSM_DO_CANCEL || ((e == FSM_READY || e == FSM_NONE) && fsm.state == FSM_SHOWING))
			waits = false;
		ck_assert(!(actions & FSM_DO_REQUEST) || !waits);
		waits = waits || actions & FSM_DO_REQUEST;
		ck_assert_int_eq(waits, fsm.state == FSM_PLANNING);
		if (actions & CONTENT)
			lit = actions & FSM_DO_SHOW;
		ck_assert(!lit || fsm.state == FSM_SHOWING);
	}
}
END_TEST

START_TEST(names_are_there_and_differ)
{
	for (enum fsm_state s = 0; s < FSM_STATE_COUNT; s++)
		for (enum fsm_state t = 0; t < s; t++)
			ck_assert_str_ne(fsm_state_name(s), fsm_state_name(t));
	for (enum fsm_event e = 0; e < FSM_EVENT_COUNT; e++)
		for (enum fsm_event f = 0; f < e; f++)
			ck_assert_str_ne(fsm_event_name(e), fsm_event_name(f));
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("fsm");
	TCase *table = tcase_create("table");
	tcase_add_test(table, every_state_is_reached_from_the_first);
	tcase_add_test(table, planning_is_reached_from_every_state);
	tcase_add_test(table, unwritten_cells_change_nothing);
	tcase_add_test(table, planning_is_entered_only_with_a_request);
	tcase_add_test(table, planning_is_left_without_an_answer_only_with_a_cancel);
	tcase_add_test(table, a_proposal_never_stays_on_a_table_that_changed);
	tcase_add_test(table, losing_the_table_is_always_said);
	tcase_add_test(table, a_ball_that_moves_clears_the_picture_in_every_state);
	tcase_add_test(table, no_state_is_without_a_way_out);
	tcase_add_test(table, the_drawing_is_the_table);
	tcase_add_test(table, pause_holds_whatever_is_seen);
	tcase_add_test(table, only_waiting_states_time_out);
	tcase_add_test(table, random_sequences_keep_requests_and_cancels_paired);
	tcase_add_test(table, names_are_there_and_differ);
	suite_add_tcase(suite, table);
	return suite;
}
