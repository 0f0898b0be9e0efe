/* Tells which child processes are alive, by the protocol of systemd (sd_notify): a socket they write to as long as their event loop turns. */
#ifndef BILLIARD_APP_WATCHDOG_H
#define BILLIARD_APP_WATCHDOG_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

struct watchdog {
	int fd;		  /* owned, -1 none: then nobody is watched */
	char address[64]; /* as NOTIFY_SOCKET wants it */
};

/* 0, or a negative errno; then fd is -1. */
int watchdog_open(struct watchdog *w);
void watchdog_close(struct watchdog *w);
/* In the child, before exec: where to write to, and how often at least, us. */
void watchdog_invite(const struct watchdog *w, unsigned long period_us);
/* The next sign of life: who gave it, by the kernel's word. False: none waits. */
bool watchdog_hear(const struct watchdog *w, pid_t *pid);

#endif
