#include "app/process/message_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/bus.h"
#include "harness.h"

/* Every member that a table knows is put a step outside and a step inside what the table itself says; that the tables say enough is read
 * from the message definitions. */
static const struct bus_type *const types[] = {&bus_image,     &bus_table_state, &bus_plan_request, &bus_plan,
					       &bus_draw_list, &bus_animation,	 &bus_command,	    &bus_status};
enum { TYPE_COUNT = sizeof types / sizeof types[0] };

static char reason[128];

static void put(enum member_kind kind, void *at, double value)
{
	if (kind == MEMBER_INT8)
		*(int8_t *)at = (int8_t)value;
	else if (kind == MEMBER_INT16)
		*(int16_t *)at = (int16_t)value;
	else if (kind == MEMBER_INT32)
		*(int32_t *)at = (int32_t)value;
	else if (kind == MEMBER_INT64)
		*(int64_t *)at = (int64_t)value;
	else
		*(double *)at = value;
}

/* A message with everything at its lowest, but all arrays full. */
static void fill(const struct message_table *table, uint8_t *message)
{
	for (int i = 0; i < table->count; i++) {
		const struct message_member *m = &table->member[i];
		bool counts = false;
		for (int k = 0; k < table->count; k++)
			counts |= table->member[k].counted && strcmp(table->member[k].counted, m->name) == 0;
		for (int k = 0; k < m->count; k++) {
			uint8_t *at = message + m->offset + (size_t)k * m->size;
			if (m->kind == MEMBER_MESSAGE)
				fill(m->table, at);
			else
				put(m->kind, at, counts ? m->high : isinf(m->low) ? 0 : m->low);
		}
	}
}

static int largest_integer(enum member_kind kind)
{
	return kind == MEMBER_INT8 ? INT8_MAX : kind == MEMBER_INT16 ? INT16_MAX : INT32_MAX;
}

/* One number of a full message: allowed at both ends, refused by a step beyond, with its name in the reason. */
static int64_t try_number(const struct bus_type *type, uint8_t *message, const struct message_member *m, uint8_t *at)
{
	uint8_t before[8];
	bool real = m->kind == MEMBER_DOUBLE;
	const struct {
		double value;
		bool allowed;
	} tries[] = {
		{m->low, isfinite(m->low)},
		{m->high, isfinite(m->high)},
		{real ? nextafter(m->low, -INFINITY) : m->low - 1, false},
		{real ? nextafter(m->high, INFINITY) : m->high + 1, false},
		{NAN, false},
	};
	memcpy(before, at, m->size);
	for (int i = 0; i < 5; i++) {
		double value = tries[i].value;
		/* An integer cannot hold everything that a table allows. */
		if (!real && (isnan(value) || isinf(value) || value > largest_integer(m->kind)))
			continue;
		put(m->kind, at, value);
		/* What is counted may leave less to check, never more. */
		bool ok = message_check(type->table, message, reason, sizeof reason);
		ck_assert_msg(ok == tries[i].allowed, "%s: %s = %g: %s", type->name, m->name, value, ok ? "" : reason);
		ck_assert_msg(ok || strstr(reason, m->name), "%s: %s", m->name, reason);
	}
	memcpy(at, before, m->size);
	return 1;
}

/* What counts comes first, and never says more than the array holds. */
static void check_counter(const struct message_table *table, const struct message_member *m)
{
	if (!m->counted)
		return;
	const struct message_member *counter = NULL;
	for (int i = 0; &table->member[i] < m; i++)
		if (strcmp(table->member[i].name, m->counted) == 0)
			counter = &table->member[i];
	ck_assert_msg(counter != NULL, "%s", m->name);
	ck_assert_msg(counter->low >= 0 && counter->high == m->count, "%s: %g..%g", m->counted, counter->low,
		      counter->high);
}

static int64_t try_all(const struct bus_type *type, uint8_t *message, const struct message_table *table, uint8_t *part)
{
	int64_t tried = 0;
	for (int i = 0; i < table->count; i++) {
		const struct message_member *m = &table->member[i];
		check_counter(table, m);
		for (int k = 0; k < m->count; k += k + 2 < m->count && m->count > 30 ? m->count / 3 - 1 : 1) {
			uint8_t *at = part + m->offset + (size_t)k * m->size;
			tried += m->kind == MEMBER_MESSAGE ? try_all(type, message, m->table, at)
							   : try_number(type, message, m, at);
		}
	}
	return tried;
}

START_TEST(every_number_is_held_to_its_range)
{
	const struct bus_type *type = types[_i];
	uint8_t *message = calloc(1, type->size);
	ck_assert_ptr_nonnull(message);
	fill(type->table, message);
	ck_assert_msg(message_check(type->table, message, reason, sizeof reason), "%s: %s", type->name, reason);
	int64_t tried = try_all(type, message, type->table, message);
	ck_assert_int_ge(tried, 1);
	free(message);
}
END_TEST

/* ---- nothing is left out ----------------------------------------------------------------------------------------- */

static const struct message_member *find(const struct message_table *table, const char *name)
{
	for (int i = 0; i < table->count; i++)
		if (strcmp(table->member[i].name, name) == 0)
			return &table->member[i];
	return NULL;
}

/* Texts are cut and cleaned where they are read; a name that another message gave is data, too. */
static bool needs_line(const char *kind, const char *name, bool array)
{
	size_t n = strlen(name);
	bool count = n > 6 && strcmp(name + n - 6, "_count") == 0;
	return strcmp(kind, "byte") != 0 && (array || count || strcmp(kind, "double") == 0);
}

/* Members of a .lcm file that the table does not know, except doubles that nobody computes with. */
static void read_definition(const char *type, const struct message_table *table)
{
	char path[64], line[256];
	int members = 0;
	snprintf(path, sizeof path, "lcmtypes/%s.lcm", type);
	FILE *f = fopen(path, "r");
	ck_assert_msg(f != NULL, "%s", path);
	while (fgets(line, sizeof line, f)) {
		char kind[32], names[128], *comment = strstr(line, "//");
		if (comment)
			*comment = '\0';
		if (sscanf(line, " %31[a-z0-9_] %127[^;];", kind, names) != 2 || strcmp(kind, "package") == 0 ||
		    strcmp(kind, "struct") == 0)
			continue;
		for (char *rest, *word = strtok_r(names, ", ", &rest); word; word = strtok_r(NULL, ", ", &rest)) {
			bool array = strchr(word, '[') != NULL;
			word[strcspn(word, "[")] = '\0';
			members++;
			if (!needs_line(kind, word, array) || strcmp(word, "residual_px") == 0 ||
			    strcmp(word, "start_on") == 0)
				continue;
			const struct message_member *m = find(table, word);
			ck_assert_msg(m != NULL, "%s: %s has no line in its table", path, word);
			ck_assert_msg(!array || m->count > 1, "%s: %s", path, word);
			/* "balls" of ball_t */
			if (m->kind == MEMBER_MESSAGE)
				read_definition(kind, m->table);
		}
	}
	fclose(f);
	ck_assert_int_gt(members, 1);
}

START_TEST(every_count_array_and_number_has_a_line)
{
	read_definition(types[_i]->name, types[_i]->table);
}
END_TEST

/* ---- the reason -------------------------------------------------------------------------------------------------- */

START_TEST(the_reason_names_member_value_and_range)
{
	static billiard_plan_t plan;
	fill(&message_plan, (uint8_t *)&plan);
	plan.entries[3].shots[1].speed = 1e9;
	ck_assert(!message_check(&message_plan, &plan, reason, sizeof reason));
	ck_assert_str_eq(reason, "entries[3].shots[1].speed: found 1000000000, allowed -100..100");
	plan.entry_count = 3; /* what the count leaves out is not looked at */
	ck_assert(message_check(&message_plan, &plan, reason, sizeof reason));
	plan.request_id = -1;
	ck_assert(!message_check(&message_plan, &plan, reason, sizeof reason));
	ck_assert_str_eq(reason, "request_id: found -1, allowed 0 and more");
	char cut[8] = "";
	ck_assert(!message_check(&message_plan, &plan, cut, sizeof cut));
	ck_assert_str_eq(cut, "request");
	billiard_ball_t ball = {.confidence = -INFINITY};
	ck_assert(!message_check(&message_ball, &ball, reason, sizeof reason));
	ck_assert_str_eq(reason, "confidence: found -inf, allowed any finite number");
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("message_check");
	TCase *tables = tcase_create("tables");
	tcase_set_timeout(tables, 60);
	tcase_add_loop_test(tables, every_number_is_held_to_its_range, 0, TYPE_COUNT);
	tcase_add_loop_test(tables, every_count_array_and_number_has_a_line, 0, TYPE_COUNT);
	tcase_add_test(tables, the_reason_names_member_value_and_range);
	suite_add_tcase(suite, tables);
	return suite;
}
