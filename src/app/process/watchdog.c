#include "app/process/watchdog.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

int watchdog_open(struct watchdog *w)
{
	int on = 1;
	struct sockaddr_un address = {.sun_family = AF_UNIX};
	/* An abstract address, chosen by the kernel: no file is left behind. */
	socklen_t size = sizeof(sa_family_t);
	w->fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
	if (w->fd < 0)
		return -errno;
	if (bind(w->fd, (struct sockaddr *)&address, size) < 0 ||
	    setsockopt(w->fd, SOL_SOCKET, SO_PASSCRED, &on, sizeof on) < 0) {
		int r = -errno;
		watchdog_close(w);
		return r;
	}
	size = sizeof address;
	getsockname(w->fd, (struct sockaddr *)&address, &size);
	int length = (int)(size - sizeof(sa_family_t)) - 1;
	snprintf(w->address, sizeof w->address, "@%.*s", length, address.sun_path + 1);
	return 0;
}

void watchdog_close(struct watchdog *w)
{
	if (w->fd >= 0)
		close(w->fd);
	w->fd = -1;
}

void watchdog_invite(const struct watchdog *w, unsigned long period_us)
{
	char number[32];
	if (w->fd < 0)
		return;
	setenv("NOTIFY_SOCKET", w->address, 1);
	snprintf(number, sizeof number, "%lu", period_us);
	setenv("WATCHDOG_USEC", number, 1);
	snprintf(number, sizeof number, "%ld", (long)getpid());
	setenv("WATCHDOG_PID", number, 1);
}

bool watchdog_hear(const struct watchdog *w, pid_t *pid)
{
	char text[512];
	union {
		struct cmsghdr header; /* aligns */
		char bytes[CMSG_SPACE(sizeof(struct ucred))];
	} control;
	struct iovec part = {text, sizeof text};
	struct msghdr message = {
		.msg_iov = &part, .msg_iovlen = 1, .msg_control = &control, .msg_controllen = sizeof control};
	if (w->fd < 0 || recvmsg(w->fd, &message, MSG_DONTWAIT) < 0)
		return false;
	*pid = 0;
	struct cmsghdr *c = CMSG_FIRSTHDR(&message);
	if (c && c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_CREDENTIALS) {
		struct ucred who;
		memcpy(&who, CMSG_DATA(c), sizeof who);
		*pid = who.pid;
	}
	return true;
}
