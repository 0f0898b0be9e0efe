/* The services on a bus of their own, and what is heard of them. */
#ifndef BILLIARD_TESTS_SERVICE_FIXTURE_H
#define BILLIARD_TESTS_SERVICE_FIXTURE_H

#include "app/config/config.h"
#include "bus_fixture.h"

enum { PROGRAM_COUNT = 5, STATUS_MAX = 16, TEXT_SIZE = 2000 };
extern const char *const programs[PROGRAM_COUNT];

/* The newest messages of each channel and how many there were. */
extern struct heard {
	billiard_status_t status[STATUS_MAX]; /* the newest of each process */
	int status_count;
	billiard_plan_request_t request;
	billiard_plan_t plan;
	billiard_draw_list_t draw;
	billiard_table_state_t state;
	int64_t requests, plans, draws, states;
} heard;
extern struct bus *bus;
extern struct config config;
extern char conf[128]; /* path of config: the shipped table, played fast, all services on the virtual camera */

/* For each test: configuration, bus, subscriptions; kills what still runs. */
void service_setup(void);
void service_teardown(void);
void service_listen(struct bus *to);

/* Starts a program with the configuration and waits until it says that it runs. */
pid_t service_start(const char *program);
/* The newest STATUS of a process, NULL when none was heard. */
const billiard_status_t *service_status(pid_t pid);
/* The program ends with status 2, having said nothing but one line on stderr that contains text. */
void service_refused(const char *program, const char *const *arguments, const char *text);

#endif
