#include "bus_fixture.h"

#include <check.h>
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/process/clock.h"
#include "app/process/process.h"

/* Sanitizers and the leak check at the end take their time. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
static const double SLOWER = 10;
#else
static const double SLOWER = 1;
#endif

enum { CHILD_MAX = 32, ARGUMENT_MAX = 16 };
static pid_t child[CHILD_MAX];
static int child_count;
static char folder[64];

void fixture_begin(void)
{
	char self[PATH_MAX];
	ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
	if (getenv("BILLIARD_TEST_BUS") || n < 0)
		return;
	self[n] = '\0';
	setenv("BILLIARD_TEST_BUS", "1", 1);
	unsetenv("LCM_DEFAULT_URL");
	execl("scripts/with-bus", "with-bus", self, (char *)NULL);
	fprintf(stderr, "scripts/with-bus: %s\n", strerror(errno));
	exit(1);
}

struct bus *fixture_bus(void)
{
	struct bus *bus;
	char err[300];
	ck_assert_msg(bus_open(&bus, bus_url(FIXTURE_URL), err, sizeof err) == 0, "%s", err);
	return bus;
}

bool fixture_wait(struct bus *bus, bool (*condition)(void), double seconds)
{
	double end = clock_seconds() + SLOWER * seconds;
	struct pollfd fd = {bus_descriptor(bus), POLLIN, 0};
	while (!condition()) {
		double left = end - clock_seconds();
		if (left <= 0)
			return false;
		poll(&fd, 1, left < 0.02 ? 1 : 20); /* the condition may be about something else than the bus */
		ck_assert_int_eq(bus_drain(bus), 0);
	}
	return true;
}

/* ---- raw messages ------------------------------------------------------------------------------------------------ */

static int raw_size(const void *message)
{
	return ((const struct raw_message *)message)->size;
}

static int raw_encode(void *bytes, int offset, int max, const void *message)
{
	const struct raw_message *raw = message;
	if (raw->size > max)
		return -1;
	if (raw->size > 0)
		memcpy((char *)bytes + offset, raw->bytes, (size_t)raw->size);
	return raw->size;
}

const struct bus_type bus_raw = {
	.name = "raw", .size = sizeof(struct raw_message), .encoded_size = raw_size, .encode = raw_encode};

/* ---- programs ---------------------------------------------------------------------------------------------------- */

const char *fixture_file(const char *name)
{
	static char path[128];
	if (!folder[0]) {
		snprintf(folder, sizeof folder, "/tmp/billiard-test-XXXXXX");
		ck_assert_ptr_nonnull(mkdtemp(folder));
	}
	snprintf(path, sizeof path, "%s/%s", folder, name);
	return path;
}

static const char *output_file(pid_t pid, int descriptor)
{
	char name[48];
	snprintf(name, sizeof name, "output-%d-%d", (int)pid, descriptor);
	return fixture_file(name);
}

static void redirect(int descriptor)
{
	int fd = open(output_file(getpid(), descriptor), O_WRONLY | O_CREAT | O_TRUNC, 0600);
	dup2(fd, descriptor);
	close(fd);
}

static _Noreturn void become(const char *program, const char *const *arguments)
{
	char self[PATH_MAX], path[PATH_MAX + 64];
	char *argv[ARGUMENT_MAX + 2] = {(char *)program};
	ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
	self[n > 0 ? n : 0] = '\0';
	if (program[0] == '/')
		snprintf(path, sizeof path, "%s", program);
	else
		snprintf(path, sizeof path, "%s/../%s", dirname(self), program);
	for (int i = 0; i < ARGUMENT_MAX && arguments[i]; i++)
		argv[i + 1] = (char *)arguments[i];
	redirect(STDOUT_FILENO);
	redirect(STDERR_FILENO);
	prctl(PR_SET_PDEATHSIG, SIGKILL);
	setenv("SDL_VIDEODRIVER", "dummy", 1);
	execv(path, argv);
	fprintf(stderr, "%s: %s\n", path, strerror(errno));
	_exit(127);
}

pid_t fixture_start(const char *program, const char *const *arguments)
{
	fixture_file(""); /* the folder is there before the fork */
	ck_assert_int_lt(child_count, CHILD_MAX);
	fflush(NULL);
	pid_t pid = fork();
	ck_assert_int_ge(pid, 0);
	if (pid == 0)
		become(program, arguments);
	child[child_count++] = pid;
	return pid;
}

static void forget(pid_t pid)
{
	for (int i = 0; i < child_count; i++)
		if (child[i] == pid)
			child[i] = child[--child_count];
}

int fixture_end(pid_t pid, double seconds)
{
	double end = clock_seconds() + SLOWER * seconds;
	for (;;) {
		int status;
		pid_t r = waitpid(pid, &status, WNOHANG);
		ck_assert_int_ge(r, 0);
		if (r == pid) {
			forget(pid);
			return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
		}
		if (clock_seconds() > end)
			return -1;
		poll(NULL, 0, 2);
	}
}

void fixture_said(pid_t pid, int descriptor, char *out, size_t size)
{
	FILE *f = fopen(output_file(pid, descriptor), "r");
	size_t n = f ? fread(out, 1, size - 1, f) : 0;
	out[n] = '\0';
	if (f)
		fclose(f);
}

void fixture_cleanup(void)
{
	while (child_count > 0) {
		kill(child[child_count - 1], SIGKILL);
		waitpid(child[--child_count], NULL, 0);
	}
	if (folder[0]) {
		char command[96];
		snprintf(command, sizeof command, "rm -rf %s", folder);
		if (system(command) != 0)
			fprintf(stderr, "%s stays\n", folder);
		folder[0] = '\0';
	}
}
