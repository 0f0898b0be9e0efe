/* billiard-planner: PLAN_REQUEST in, PLAN out. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/planner/plan_message.h"
#include "app/planner/planner_service.h"
#include "app/process/process.h"

static const char REQUESTS[] = "PLAN_REQUEST";

struct planner_process {
	struct process process;
	struct config config;
	struct planner_service *service;
	billiard_plan_t answer;
	int64_t malformed;	/* requests that could not be read */
	double work, work_time; /* nodes and simulations at the last STATUS, when that was */
};

static bool on_request(void *context, const void *message)
{
	struct planner_process *p = context;
	return planner_service_request(p->service, message);
}

static bool on_command(void *context, const void *message)
{
	struct planner_process *p = context;
	const billiard_command_t *command = message;
	char name[sizeof command->name], argument[sizeof command->argument];
	text_get(name, sizeof name, command->name, sizeof command->name);
	text_get(argument, sizeof argument, command->argument, sizeof command->argument);
	if (strcmp(name, "cancel") == 0 && bus_is_for(command, p->process.name))
		planner_service_cancel(p->service, strtoll(argument, NULL, 10));
	return true;
}

static int on_answers(sd_event_source *source, int fd, uint32_t events, void *context)
{
	(void)source, (void)fd, (void)events;
	struct planner_process *p = context;
	while (planner_service_answer(p->service, &p->answer)) {
		bus_publish(p->process.bus, "PLAN", &bus_plan, &p->answer);
		if (p->answer.status == PLAN_MESSAGE_REFUSED)
			/* without the id: the same reason again is no news for the journal */
			process_error(&p->process, "request refused: %.90s", p->answer.reason);
	}
	return 0;
}

/* A request that could not be read is answered, too. Its id is not known: 0. */
static void answer_malformed(struct planner_process *p, const char *reason)
{
	p->malformed++;
	p->answer = (billiard_plan_t){.utime = clock_utime(), .is_final = 1, .status = PLAN_MESSAGE_REFUSED};
	text_set(p->answer.reason, sizeof p->answer.reason, reason);
	bus_publish(p->process.bus, "PLAN", &bus_plan, &p->answer);
}

static void on_ignored(void *context, const struct bus_ignored *ignored)
{
	struct planner_process *p = context;
	if (strcmp(ignored->channel, REQUESTS) != 0)
		return;
	if (ignored->fault == BUS_MALFORMED)
		answer_malformed(p, ignored->reason);
	else if (ignored->fault == BUS_RANGE)
		planner_service_refuse(p->service, ignored->message, ignored->reason);
}

/* Expansions and simulations a second since the last STATUS. */
static double rate(struct planner_process *p, const struct planner_service_figures *f)
{
	double now = clock_seconds(), work = (double)(f->nodes + f->sims);
	double rate = now > p->work_time ? (work - p->work) / (now - p->work_time) : 0;
	p->work = work;
	p->work_time = now;
	return rate;
}

static void describe(void *context, struct process *process)
{
	struct planner_process *p = context;
	struct planner_service_figures f;
	planner_service_figures(p->service, &f);
	process_state(process, f.busy ? "searching" : "idle");
	process_metric(process, "requests", "1", (double)f.requests);
	process_metric(process, "refused", "1", (double)f.refused);
	process_metric(process, "malformed", "1", (double)p->malformed);
	process_metric(process, "outdated", "1", (double)f.outdated);
	process_metric(process, "cancelled", "1", (double)f.cancelled);
	process_metric(process, "nodes", "1", (double)f.nodes);
	process_metric(process, "simulations", "1", (double)f.sims);
	process_metric(process, "rate", "1/s", rate(p, &f));
	process_metric(process, "depth", "1", f.search.depth);
	process_metric(process, "manager", "%", f.searched > 0 ? 100 * f.manager / f.searched : 0);
	process_metric(process, "queue", "1", f.search.open);
	process_metric(process, "busy", "1", f.search.busy);
	process_metric(process, "windows", "1", (double)f.search.windows_held);
	process_metric(process, "missed", "1", (double)(f.search.windows_missed + f.search.windows_blocked));
	process_metric(process, "first", "ms", 1e3 * f.last_first);
	process_metric(process, "final", "ms", 1e3 * f.last_final);
}

static int setup(struct planner_process *p, const struct process_options *options)
{
	char err[PROCESS_ERROR_SIZE];
	int r = process_init(&p->process, "billiard-planner", options, &p->config);
	if (r < 0)
		return r;
	if ((r = planner_service_create(&p->service, &p->config, err, sizeof err)) < 0) {
		fprintf(stderr, "billiard-planner: %s\n", err);
		return r;
	}
	p->process.describe = describe;
	p->process.context = p;
	bus_on_ignored(p->process.bus, on_ignored, p);
	if ((r = bus_subscribe(p->process.bus,
			       &(struct bus_subscription){REQUESTS, &bus_plan_request, BUS_EACH, on_request, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus,
			       &(struct bus_subscription){"COMMAND", &bus_command, BUS_EACH, on_command, p})) < 0 ||
	    (r = sd_event_add_io(p->process.event, NULL, planner_service_descriptor(p->service), EPOLLIN, on_answers,
				 p)) < 0)
		fprintf(stderr, "billiard-planner: %s\n", strerror(-r));
	return r;
}

int main(int argc, char **argv)
{
	struct process_options options;
	int r = process_parse(&options, "billiard-planner", argc, argv);
	if (r != 0)
		return r < 0 ? 2 : 0;
	struct planner_process p = {0};
	int status = setup(&p, &options) < 0 ? 2 : process_run(&p.process);
	planner_service_destroy(p.service);
	process_finish(&p.process);
	return status;
}
