/* What the processes of a bus say of themselves within a while. */
#ifndef BILLIARD_APP_STATUS_LISTEN_H
#define BILLIARD_APP_STATUS_LISTEN_H

#include "app/process/bus.h"

enum { STATUS_PROCESS_MAX = 32 };

/* The newest STATUS of each process, by name and pid. */
struct status_heard {
	billiard_status_t status[STATUS_PROCESS_MAX];
	int count;
};

/* Takes a message up; false when its counts are out of range or there are too many processes. */
bool status_take(struct status_heard *heard, const billiard_status_t *message);
/* True when a process of that name has spoken. */
bool status_knows(const struct status_heard *heard, const char *name);
/* Listens for so many seconds. 0 or a negative errno. */
int status_listen(struct status_heard *heard, struct bus *bus, double seconds);

#endif
