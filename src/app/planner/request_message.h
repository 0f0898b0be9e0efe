/* A request between its bus message and the search. Pure. */
#ifndef BILLIARD_APP_REQUEST_MESSAGE_H
#define BILLIARD_APP_REQUEST_MESSAGE_H

#include "lcmtypes/billiard_plan_request_t.h"
#include "search/plan.h"

/* The one border of a request behind the bus: a message whose numbers passed message_check(), checked against the table and the limits of
 * the search. 0, or -EINVAL with the reason and *out untouched. */
int plan_request_from_message(struct plan_request *out, const billiard_plan_request_t *message,
			      const struct table *table, char *err, size_t err_size);

#endif
