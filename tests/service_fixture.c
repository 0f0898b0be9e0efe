#include "service_fixture.h"

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- what was heard ---------------------------------------------------------------------------------------------- */

struct heard heard;
struct bus *bus;
struct config config; /* too large for the stack */
char conf[128];
const char *const programs[PROGRAM_COUNT] = {"billiard-planner", "billiard-projector", "billiard-infinity",
					     "billiard-vision", "billiard-table"};

static bool on_status(void *context, const void *message)
{
	(void)context;
	const billiard_status_t *s = message;
	int i = 0;
	while (i < heard.status_count && heard.status[i].pid != s->pid)
		i++;
	ck_assert_int_lt(i, STATUS_MAX);
	heard.status_count += i == heard.status_count;
	heard.status[i] = *s;
	return true;
}

#define HEAR(name, type)                                                                                               \
	static bool on_##name(void *context, const void *message)                                                      \
	{                                                                                                              \
		(void)context;                                                                                         \
		heard.name = *(const type *)message;                                                                   \
		heard.name##s++;                                                                                       \
		return true;                                                                                           \
	}
HEAR(request, billiard_plan_request_t)
HEAR(plan, billiard_plan_t)
HEAR(draw, billiard_draw_list_t)
HEAR(state, billiard_table_state_t)

void service_listen(struct bus *to)
{
	ck_assert_int_eq(
		bus_subscribe(to, &(struct bus_subscription){"STATUS", &bus_status, BUS_EACH, on_status, NULL}), 0);
	ck_assert_int_eq(bus_subscribe(to, &(struct bus_subscription){"PLAN_REQUEST", &bus_plan_request, BUS_EACH,
								      on_request, NULL}),
			 0);
	ck_assert_int_eq(bus_subscribe(to, &(struct bus_subscription){"PLAN", &bus_plan, BUS_EACH, on_plan, NULL}), 0);
	ck_assert_int_eq(bus_subscribe(to, &(struct bus_subscription){"DRAW", &bus_draw_list, BUS_EACH, on_draw, NULL}),
			 0);
	ck_assert_int_eq(bus_subscribe(to, &(struct bus_subscription){"TABLE_STATE", &bus_table_state, BUS_EACH,
								      on_state, NULL}),
			 0);
}

/* The shipped table, but played fast, with all services on the virtual camera. */
static void write_conf(void)
{
	char command[1600], cwd[512];
	ck_assert_ptr_nonnull(getcwd(cwd, sizeof cwd));
	snprintf(conf, sizeof conf, "%s", fixture_file("table.conf"));
	snprintf(command, sizeof command,
		 "sed -e 's#\"colours.json\"#\"%s/config/colours.json\"#' -e 's/v4l2:.dev.video0/lcm:CAMERA/' -e "
		 "'s/think_time = [0-9.]*/think_time = 300/' "
		 "-e 's/time_scale = [0-9.]*/time_scale = 8/' -e 's/still_time = [0-9.]*/still_time = 250/' -e "
		 "'s/error_angle = [0-9.]*/error_angle = 0/' "
		 "-e 's/name = \"billiard-table\"; arguments = \"\"; enabled = false/name = \"billiard-table\"; "
		 "arguments = \"\"; enabled = true/' "
		 "-e 's/plan_timeout = [0-9.]*/plan_timeout = 1000/' -e 's/budget = 2000/budget = 300/' "
		 "config/thesis-table.conf >%s",
		 cwd, conf);
	ck_assert_int_eq(system(command), 0);
}

void service_setup(void)
{
	char err[640];
	memset(&heard, 0, sizeof heard);
	write_conf();
	ck_assert_msg(config_load(&config, conf, err, sizeof err) == 0, "%s", err);
	bus = fixture_bus();
	service_listen(bus);
}

void service_teardown(void)
{
	bus_close(bus);
	fixture_cleanup();
}

const billiard_status_t *service_status(pid_t pid)
{
	for (int i = 0; i < heard.status_count; i++)
		if (heard.status[i].pid == pid)
			return &heard.status[i];
	return NULL;
}

static pid_t awaited;
static bool is_there(void)
{
	const billiard_status_t *s = service_status(awaited);
	return s && s->state[0] && strcmp((const char *)s->state, "starting") != 0;
}

pid_t service_start(const char *program)
{
	awaited = fixture_start(program, (const char *[]){"-c", conf, NULL});
	char said[TEXT_SIZE];
	bool there = fixture_wait(bus, is_there, 10);
	fixture_said(awaited, 2, said, sizeof said);
	ck_assert_msg(there, "%s: %s", program, said);
	return awaited;
}

/* Ends with that status, having said one line that contains text. */
void service_refused(const char *program, const char *const *arguments, const char *text)
{
	char said[TEXT_SIZE];
	pid_t pid = fixture_start(program, arguments);
	int status = fixture_end(pid, 10);
	fixture_said(pid, 2, said, sizeof said);
	size_t length = strlen(said);
	ck_assert_msg(status == 2 && length > 1 && strchr(said, '\n') == said + length - 1 && strstr(said, text),
		      "%s: status %d, wanted one line with \"%s\": %s", program, status, text, said);
	fixture_said(pid, 1, said, sizeof said);
	ck_assert_str_eq(said, "");
}
