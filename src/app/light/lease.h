/* How long a picture on the table is true. Whoever shows pictures keeps a lease beside them: when it has run out, nobody vouches for what is
 * shown any more. Pure: time is s of any steady clock. */
#ifndef BILLIARD_APP_LEASE_H
#define BILLIARD_APP_LEASE_H

#include <stdbool.h>

#include "lcmtypes/billiard_draw_list_t.h"
#include "lcmtypes/billiard_lease_t.h"

/* Begins as {0}: pictures without a lease (recordings, other senders) stay. */
struct lease {
	bool known;	/* a lease was heard: from then on pictures run out */
	double seconds; /* s, that of the last one */
	double until;	/* s */
	int64_t seq;	/* of the picture shown */
};

/* A picture came. It is true at least for as long as the last lease said. */
void lease_picture(struct lease *lease, int64_t seq, double now);
/* A lease came. One for another picture than the one shown says nothing for this. */
void lease_take(struct lease *lease, const billiard_lease_t *message, double now);
bool lease_is_over(const struct lease *lease, double now);

/* The picture shown then: one line of text beside the bed. width: m, of the bed. */
void lease_notice(billiard_draw_list_t *list, double width);

#endif
