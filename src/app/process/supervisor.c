#include "app/process/supervisor.h"

#include <errno.h>
#include <glib.h>
#include <libgen.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

enum { RESTART_US = 500000, RESTART_MAX_US = 8000000, KILL_US = 3000000 };
enum {
	SETTLED_US = 5000000, /* who lives that long did not die at once */
	SIGN_US = 2000000,    /* asked for between two signs of life, at most */
	HUNG_US = 5000000,    /* without one: three seconds of standing still are forgiven */
	WATCH_US = 500000     /* between looks for such */
};

void supervisor_block(void)
{
	sigset_t set;
	sigemptyset(&set);
	sigaddset(&set, SIGCHLD);
	sigprocmask(SIG_BLOCK, &set, NULL);
}

static uint64_t monotonic_us(const struct supervisor *s)
{
	uint64_t now = 0;
	sd_event_now(s->event, CLOCK_MONOTONIC, &now);
	return now;
}

static int on_sign(sd_event_source *source, int fd, uint32_t events, void *context)
{
	(void)source, (void)fd, (void)events;
	struct supervisor *s = context;
	pid_t pid;
	while (watchdog_hear(&s->watchdog, &pid))
		for (int i = 0; i < s->count; i++)
			if (s->service[i].pid && s->service[i].pid == pid)
				s->service[i].heard = monotonic_us(s);
	return 0;
}

/* A service that gave signs of life and gives none any more hangs: it is killed, and so started again. */
static int on_watch(sd_event_source *source, uint64_t usec, void *context)
{
	(void)usec;
	struct supervisor *s = context;
	uint64_t now = monotonic_us(s);
	for (int i = 0; i < s->count; i++) {
		struct supervised *c = &s->service[i];
		if (!c->pid || !c->heard || now - c->heard < HUNG_US)
			continue;
		fprintf(stderr, "billiard: %s hangs\n", c->name);
		kill(c->pid, SIGKILL);
		c->heard = 0;
	}
	sd_event_source_set_time_relative(source, WATCH_US);
	return sd_event_source_set_enabled(source, SD_EVENT_ONESHOT);
}

void supervisor_init(struct supervisor *s, sd_event *event, const char *config, const char *bus)
{
	*s = (struct supervisor){.event = event, .config = config, .bus = bus};
	supervisor_block();
	/* Without it nobody is watched, and all else goes on. */
	int r = watchdog_open(&s->watchdog);
	if (r >= 0)
		r = sd_event_add_io(event, &s->watch_io, s->watchdog.fd, EPOLLIN, on_sign, s);
	if (r >= 0)
		r = sd_event_add_time_relative(event, &s->watch_timer, CLOCK_MONOTONIC, WATCH_US, 0, on_watch, s);
	if (r < 0)
		fprintf(stderr, "billiard: no watchdog: %s\n", strerror(-r));
}

/* In the child: becomes the program. Never returns. */
static _Noreturn void become(const struct supervised *c, const char *path, pid_t parent)
{
	sigset_t none;
	sigemptyset(&none);
	sigprocmask(SIG_SETMASK, &none, NULL);
	/* Should this process be killed, its children must not stay behind. */
	prctl(PR_SET_PDEATHSIG, SIGTERM);
	if (getppid() != parent)
		_exit(0);
	watchdog_invite(&c->supervisor->watchdog, SIGN_US);
	execv(path, c->argv);
	fprintf(stderr, "%s: %s\n", path, strerror(errno));
	_exit(127);
}

static int on_child(sd_event_source *source, const siginfo_t *info, void *context);

static int launch(struct supervised *c, char *err, size_t err_size)
{
	char self[PATH_MAX], path[PATH_MAX + 32];
	ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
	if (n < 0) {
		snprintf(err, err_size, "/proc/self/exe: %s", strerror(errno));
		return -errno;
	}
	self[n] = '\0';
	snprintf(path, sizeof path, "%s/%s", dirname(self), c->name);
	if (access(path, X_OK) < 0) {
		snprintf(err, err_size, "%s: %s", path, strerror(errno));
		return -errno;
	}
	fflush(NULL);
	pid_t parent = getpid(), pid = fork();
	if (pid == 0)
		become(c, path, parent);
	int r = pid < 0 ? -errno : sd_event_add_child(c->supervisor->event, &c->child, pid, WEXITED, on_child, c);
	if (r < 0) {
		snprintf(err, err_size, "%s: %s", c->name, strerror(-r));
		if (pid > 0) { /* nobody would wait for it */
			kill(pid, SIGKILL);
			waitpid(pid, NULL, 0);
		}
		return r;
	}
	c->pid = pid;
	c->launched = monotonic_us(c->supervisor);
	c->heard = 0;
	return 0;
}

static bool any_runs(const struct supervisor *s)
{
	for (int i = 0; i < s->count; i++)
		if (s->service[i].pid)
			return true;
	return false;
}

/* A service that failed and is to be started again. */
static bool any_waits(const struct supervisor *s)
{
	for (int i = 0; i < s->count; i++) {
		int enabled = SD_EVENT_OFF;
		if (s->service[i].restart && sd_event_source_get_enabled(s->service[i].restart, &enabled) >= 0 &&
		    enabled != SD_EVENT_OFF)
			return true;
	}
	return false;
}

static int on_restart(sd_event_source *source, uint64_t usec, void *context);

static void plan_restart(struct supervised *c)
{
	sd_event *event = c->supervisor->event;
	c->restart = sd_event_source_unref(c->restart);
	/* Who dies at once again and again is given longer and longer. */
	bool at_once = monotonic_us(c->supervisor) - c->launched < SETTLED_US;
	uint64_t longer = 2 * c->delay < RESTART_MAX_US ? 2 * c->delay : RESTART_MAX_US;
	c->delay = at_once && c->restarts > 0 ? longer : RESTART_US;
	if (sd_event_add_time_relative(event, &c->restart, CLOCK_MONOTONIC, c->delay, 0, on_restart, c) < 0)
		fprintf(stderr, "billiard: %s cannot be started again\n", c->name);
}

static int on_restart(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	struct supervised *c = context;
	char err[PATH_MAX + 128];
	c->restarts++;
	if (c->supervisor->stopping || launch(c, err, sizeof err) == 0)
		return 0;
	fprintf(stderr, "billiard: %s\n", err);
	plan_restart(c);
	return 0;
}

static int on_child(sd_event_source *source, const siginfo_t *info, void *context)
{
	(void)source;
	struct supervised *c = context;
	struct supervisor *s = c->supervisor;
	c->pid = 0;
	c->child = sd_event_source_unref(c->child);
	if (s->stopping)
		return any_runs(s) ? 0 : sd_event_exit(s->event, s->status);
	bool bad_use = info->si_code == CLD_EXITED && info->si_status == 2;
	fprintf(stderr, "billiard: %s ended (%s %d)%s\n", c->name, info->si_code == CLD_EXITED ? "status" : "signal",
		info->si_status, bad_use ? ", not started again" : ", starting it again");
	/* Status 2 is a wrong configuration or address: trying again changes nothing. */
	if (!bad_use)
		plan_restart(c);
	else if (!any_runs(s) && !any_waits(s))
		sd_event_exit(s->event, 2);
	return 0;
}

/* The command line of a service, NULL when its arguments cannot be read. The caller frees with g_strfreev(). */
static char **command_line(const struct supervised *c, const char *arguments)
{
	char **own = NULL;
	if (arguments[strspn(arguments, " ")] && !g_shell_parse_argv(arguments, NULL, &own, NULL))
		return NULL;
	GStrvBuilder *builder = g_strv_builder_new();
	g_strv_builder_add_many(builder, c->name, "-c", c->supervisor->config, NULL);
	if (c->supervisor->bus)
		g_strv_builder_add_many(builder, "--bus", c->supervisor->bus, NULL);
	if (own)
		g_strv_builder_addv(builder, (const char **)own);
	char **argv = g_strv_builder_end(builder);
	g_strv_builder_unref(builder);
	g_strfreev(own);
	return argv;
}

int supervisor_start(struct supervisor *s, const char *name, const char *arguments, char *err, size_t err_size)
{
	if (s->count == SUPERVISOR_MAX) {
		snprintf(err, err_size, "%s: more than %d services", name, SUPERVISOR_MAX);
		return -ENOSPC;
	}
	struct supervised *c = &s->service[s->count++];
	*c = (struct supervised){.supervisor = s, .delay = RESTART_US};
	snprintf(c->name, sizeof c->name, "%s", name);
	c->argv = command_line(c, arguments);
	if (!c->argv) {
		snprintf(err, err_size, "%s: arguments \"%s\" cannot be split", name, arguments);
		s->count--;
		return -EINVAL;
	}
	return launch(c, err, err_size);
}

static void signal_all(struct supervisor *s, int number)
{
	for (int i = 0; i < s->count; i++)
		if (s->service[i].pid)
			kill(s->service[i].pid, number);
}

static int on_kill_timer(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	signal_all(context, SIGKILL);
	return 0;
}

void supervisor_stop(struct supervisor *s, int status)
{
	if (s->stopping)
		return;
	s->stopping = true;
	s->status = status;
	if (!any_runs(s)) {
		sd_event_exit(s->event, status);
		return;
	}
	signal_all(s, SIGTERM);
	sd_event_add_time_relative(s->event, &s->kill_timer, CLOCK_MONOTONIC, KILL_US, 0, on_kill_timer, s);
}

void supervisor_finish(struct supervisor *s)
{
	signal_all(s, SIGKILL);
	for (int i = 0; i < s->count; i++) {
		struct supervised *c = &s->service[i];
		sd_event_source_disable_unref(c->child);
		sd_event_source_disable_unref(c->restart);
		g_strfreev(c->argv);
		if (c->pid)
			waitpid(c->pid, NULL, 0);
	}
	sd_event_source_disable_unref(s->kill_timer);
	sd_event_source_disable_unref(s->watch_io);
	sd_event_source_disable_unref(s->watch_timer);
	watchdog_close(&s->watchdog);
	*s = (struct supervisor){0};
}
