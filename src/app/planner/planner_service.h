/* The request/answer service around the search: one search at a time in a thread of its own, so that the event loop
 * stays live. */
#ifndef BILLIARD_APP_PLANNER_SERVICE_H
#define BILLIARD_APP_PLANNER_SERVICE_H

#include "app/config/config.h"
#include "lcmtypes/billiard_plan_request_t.h"
#include "lcmtypes/billiard_plan_t.h"

struct planner_service; /* opaque */

struct planner_service_figures {
	int64_t requests, refused, cancelled, outdated;
	int64_t nodes, sims;
	struct plan_figures search;    /* of now */
	double searched, manager;      /* s spent on searches; CPU time of the thread that runs them */
	double last_first, last_final; /* s from request to first and final answer */
	bool busy;
};

/* Creates planner and thread. 0, or a negative errno with the reason. Caller destroys. */
int planner_service_create(struct planner_service **out, const struct config *config, char *err, size_t err_size);
void planner_service_destroy(struct planner_service *service); /* NULL is fine; cancels what runs */

/* Readable when answers wait. */
int planner_service_descriptor(const struct planner_service *service);

/* A request that passed message_check(): replaces the one that runs (which ends with a final answer marked cancelled); the same id again is
 * answered with the last answer, or goes on. False when it is older than the present one, unless that has been answered
 * for two seconds: it is outdated and gets a final answer marked cancelled that says so. */
bool planner_service_request(struct planner_service *service, const billiard_plan_request_t *request);
/* Answers a request that did not pass, with the reason; its id is that of the answer, its other numbers mean nothing. */
void planner_service_refuse(struct planner_service *service, const billiard_plan_request_t *request,
			    const char *reason);
/* Ends the search for that id, if it runs. */
void planner_service_cancel(struct planner_service *service, int64_t id);

/* Next answer to publish. False when none waits. */
bool planner_service_answer(struct planner_service *service, billiard_plan_t *out);

void planner_service_figures(struct planner_service *service, struct planner_service_figures *out);

#endif
