/* A client of billiard-planner on the test's own bus, for tests, bench and soak. */
#ifndef BILLIARD_TESTS_PLANNER_CLIENT_H
#define BILLIARD_TESTS_PLANNER_CLIENT_H

#include <sys/types.h>

#include "bus_fixture.h"
#include "physics/ball.h"

/* How the planner is to be configured. */
struct planner_setup {
	const char *scheme; /* NULL: as shipped */
	int workers;	    /* 0: as shipped */
	const char *model;  /* NULL: as shipped */
};

/* What is known of the request asked last. Times are s, monotonic. */
struct planner_client {
	struct bus *bus;
	pid_t pid;
	int64_t id;				     /* of that request; grows */
	double sent, first, last;		     /* request published; first and final plan received; 0: not yet */
	int plans;				     /* received for it */
	int64_t finals, cancelled, refused, foreign; /* of all requests; foreign: not for the one asked last */
	billiard_plan_request_t request;
	billiard_plan_t plan;	    /* the newest for it */
	billiard_plan_t first_plan; /* the first for it */
	billiard_plan_t other;	    /* the newest for any other */
	billiard_status_t status;
};

/* A bus and a planner on it; waits until it answers. fixture_begin() comes before. */
void client_begin(struct planner_client *client, const struct planner_setup *setup);
void client_start(struct planner_client *client); /* another process after the first has ended */
void client_end(struct planner_client *client);

/* Fills client->request: those balls, one shot deep, direct, 10 plans, no budget. */
void client_fill(struct planner_client *client, const struct ball *ball, int count);
/* Publishes client->request under a new id. client_repeat: under the same. */
void client_ask(struct planner_client *client);
void client_repeat(struct planner_client *client);
void client_cancel(struct planner_client *client, int64_t id);
/* Handles what comes in for at most so long; returns when the final plan is there (true) or the time is over. */
bool client_wait(struct planner_client *client, double seconds);
bool client_wait_first(struct planner_client *client, double seconds);
/* Value of a metric in the newest STATUS, NAN when it is not there. */
double client_metric(const struct planner_client *client, const char *name);

/* KiB of memory taken, touched or not (what was taken at the start becomes resident only as searches need it); s of CPU
 * time used so far. */
long client_memory(const struct planner_client *client);
double client_cpu(const struct planner_client *client);

#endif
