/* A request between its bus message and the search. Pure. */
#ifndef BILLIARD_APP_REQUEST_MESSAGE_H
#define BILLIARD_APP_REQUEST_MESSAGE_H

#include "lcmtypes/billiard_plan_request_t.h"
#include "search/plan.h"

/* A request as it came from the wire, checked against the table. 0, or -EINVAL with the reason. */
int plan_request_from_message(struct plan_request *out, const billiard_plan_request_t *message,
			      const struct table *table, char *err, size_t err_size);

#endif
