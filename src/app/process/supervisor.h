/* Starts the services of a table as child processes, starts one again that failed or hangs, and stops them all. For use without systemd. */
#ifndef BILLIARD_APP_SUPERVISOR_H
#define BILLIARD_APP_SUPERVISOR_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>
#include <systemd/sd-event.h>

#include "app/process/watchdog.h"

enum { SUPERVISOR_MAX = 8 };

struct supervised {
	struct supervisor *supervisor;
	char name[24];			  /* program, found beside this one */
	char **argv;			  /* owned, of the program */
	pid_t pid;			  /* 0: not running */
	sd_event_source *child, *restart; /* owned */
	int restarts;
	uint64_t launched; /* us, monotonic */
	uint64_t heard;	   /* us, its last sign of life; 0: none yet, it is not watched */
	uint64_t delay;	   /* us until it is started again: longer for those that die at once */
};

struct supervisor {
	sd_event *event;    /* borrowed */
	const char *config; /* borrowed, passed on as -c */
	const char *bus;    /* borrowed, passed on as --bus; NULL: not */
	struct supervised service[SUPERVISOR_MAX];
	int count;
	bool stopping;
	int status;		     /* to exit with when all have gone */
	sd_event_source *kill_timer; /* owned */
	struct watchdog watchdog;
	sd_event_source *watch_io, *watch_timer; /* owned */
};

/* Blocks SIGCHLD, as sd-event needs it: to be called before other threads exist (a bus starts one). */
void supervisor_block(void);
void supervisor_init(struct supervisor *s, sd_event *event, const char *config, const char *bus);
/* arguments are split as a shell would, quotes and all. 0, -ENOSPC, -EINVAL (an open quote), or a negative errno with the reason. */
int supervisor_start(struct supervisor *s, const char *name, const char *arguments, char *err, size_t err_size);
/* Asks all to end (SIGTERM, after three seconds SIGKILL); the event loop exits with status when the last has gone. */
void supervisor_stop(struct supervisor *s, int status);
/* Kills what still runs and waits for it; frees. */
void supervisor_finish(struct supervisor *s);

#endif
