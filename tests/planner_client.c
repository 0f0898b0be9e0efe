#include "planner_client.h"

#include <check.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/process/ball_message.h"
#include "app/planner/plan_message.h"
#include "app/process/process.h"

static char conf[128];

static bool on_plan(void *context, const void *message)
{
	struct planner_client *c = context;
	const billiard_plan_t *plan = message;
	double now = clock_seconds();
	c->finals += plan->is_final;
	c->cancelled += plan->is_final && plan->status == PLAN_MESSAGE_CANCELLED;
	c->refused += plan->is_final && plan->status == PLAN_MESSAGE_REFUSED;
	if (plan->request_id != c->id) {
		c->foreign++;
		c->other = *plan;
		return true;
	}
	c->plan = *plan;
	if (c->plans++ == 0) {
		c->first = now;
		c->first_plan = *plan;
	}
	if (plan->is_final)
		c->last = now;
	return true;
}

static bool on_status(void *context, const void *message)
{
	struct planner_client *c = context;
	c->status = *(const billiard_status_t *)message;
	return true;
}

static void write_conf(const struct planner_setup *setup)
{
	char command[1200], cwd[512], edits[400];
	ck_assert_ptr_nonnull(getcwd(cwd, sizeof cwd));
	snprintf(conf, sizeof conf, "%s", fixture_file("table.conf"));
	int n = snprintf(edits, sizeof edits, "-e 's#\"colours.json\"#\"%s/config/colours.json\"#'", cwd);
	if (setup->scheme)
		n += snprintf(edits + n, sizeof edits - (size_t)n, " -e 's/scheme = \"[a-z]*\"/scheme = \"%s\"/'",
			      setup->scheme);
	if (setup->workers)
		n += snprintf(edits + n, sizeof edits - (size_t)n, " -e 's/workers = [0-9]*/workers = %d/'",
			      setup->workers);
	/* the thesis' way, unless another model is asked for: what these tests are about does not turn on it */
	snprintf(edits + n, sizeof edits - (size_t)n,
		 " -e 's/^model = \"[a-z-]*\"/model = \"%s\"/' -e 's/^profile = \"[a-z]*\"/profile = \"thesis\"/'",
		 setup->model ? setup->model : "thesis");
	snprintf(command, sizeof command, "sed %s config/thesis-table.conf >%s", edits, conf);
	ck_assert_int_eq(system(command), 0);
}

void client_start(struct planner_client *client)
{
	struct ball ball[2] = {ball_at(COLOUR_WHITE, (vec2){0, 0}), ball_at(COLOUR_RED, (vec2){0.5, 0.1})};
	client->pid = fixture_start("billiard-planner", (const char *const[]){"-c", conf, NULL});
	billiard_plan_request_t kept = client->request;
	client_fill(client, ball, 2);
	double end = clock_seconds() + 20;
	do {
		ck_assert(clock_seconds() < end);
		client_ask(client);
	} while (!client_wait(client, 0.2));
	client->request = kept;
}

void client_begin(struct planner_client *client, const struct planner_setup *setup)
{
	*client = (struct planner_client){.id = 1};
	write_conf(setup);
	client->bus = fixture_bus();
	ck_assert_int_eq(
		bus_subscribe(client->bus, &(struct bus_subscription){"PLAN", &bus_plan, BUS_EACH, on_plan, client}),
		0);
	ck_assert_int_eq(bus_subscribe(client->bus,
				       &(struct bus_subscription){"STATUS", &bus_status, BUS_EACH, on_status, client}),
			 0);
	client_start(client);
}

void client_end(struct planner_client *client)
{
	bus_close(client->bus);
	fixture_cleanup();
}

void client_fill(struct planner_client *client, const struct ball *ball, int count)
{
	billiard_plan_request_t *r = &client->request;
	*r = (billiard_plan_request_t){.ball_count = count, .depth = 1, .max_balls = 1, .speeds = 1, .plans = 10};
	for (int i = 0; i < count; i++) {
		char name[16];
		snprintf(name, sizeof name, "BALL%d", i);
		ball_to_message(&r->balls[i], &ball[i], name, i + 1);
	}
}

void client_repeat(struct planner_client *client)
{
	client->request.id = client->id;
	bus_publish(client->bus, "PLAN_REQUEST", &bus_plan_request, &client->request);
}

void client_ask(struct planner_client *client)
{
	client->id++;
	client->first = client->last = 0;
	client->plans = 0;
	client->sent = clock_seconds();
	client->request.utime = clock_utime();
	client_repeat(client);
}

void client_cancel(struct planner_client *client, int64_t id)
{
	billiard_command_t command = {.utime = clock_utime()};
	char text[24];
	snprintf(text, sizeof text, "%lld", (long long)id);
	text_set(command.target, sizeof command.target, "billiard-planner");
	text_set(command.name, sizeof command.name, "cancel");
	text_set(command.argument, sizeof command.argument, text);
	bus_publish(client->bus, "COMMAND", &bus_command, &command);
}

static bool wait_for(struct planner_client *client, const double *what, double seconds)
{
	double end = clock_seconds() + seconds;
	struct pollfd fd = {bus_descriptor(client->bus), POLLIN, 0};
	do {
		double left = end - clock_seconds();
		struct timespec t = {(time_t)fmax(left, 0), (long)(1e9 * fmod(fmax(left, 0), 1))};
		if (*what == 0)
			ppoll(&fd, 1, &t, NULL);
		ck_assert_int_eq(bus_drain(client->bus), 0);
	} while (*what == 0 && clock_seconds() < end);
	return *what != 0;
}

bool client_wait(struct planner_client *client, double seconds)
{
	return wait_for(client, &client->last, seconds);
}

bool client_wait_first(struct planner_client *client, double seconds)
{
	return wait_for(client, &client->first, seconds);
}

double client_metric(const struct planner_client *client, const char *name)
{
	for (int i = 0; i < client->status.metric_count; i++)
		if (strcmp((const char *)client->status.metrics[i].name, name) == 0)
			return client->status.metrics[i].value;
	return NAN;
}

static FILE *proc(const struct planner_client *client, const char *name)
{
	char path[64];
	snprintf(path, sizeof path, "/proc/%d/%s", (int)client->pid, name);
	FILE *f = fopen(path, "r");
	ck_assert_ptr_nonnull(f);
	return f;
}

long client_memory(const struct planner_client *client)
{
	long data = 0;
	FILE *f = proc(client, "statm");
	ck_assert_int_eq(fscanf(f, "%*d %*d %*d %*d %*d %ld", &data), 1);
	fclose(f);
	return data * sysconf(_SC_PAGESIZE) / 1024;
}

double client_cpu(const struct planner_client *client)
{
	long user = 0, system = 0;
	FILE *f = proc(client, "stat");
	ck_assert_int_eq(fscanf(f, "%*d (%*[^)]) %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %ld %ld", &user, &system),
			 2);
	fclose(f);
	return (double)(user + system) / (double)sysconf(_SC_CLK_TCK);
}
