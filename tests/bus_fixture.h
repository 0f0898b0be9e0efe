/* A bus of its own for a test program, and programs started on it. */
#ifndef BILLIARD_TESTS_BUS_FIXTURE_H
#define BILLIARD_TESTS_BUS_FIXTURE_H

#include <stdbool.h>
#include <sys/types.h>

#include "app/process/bus.h"

#define FIXTURE_URL "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304"

/* To be called first in test_suite(): runs the test program again under scripts/with-bus, unless it runs there already.
 */
void fixture_begin(void);

/* Opens the bus of this run. Caller closes. */
struct bus *fixture_bus(void);

/* Drains the bus until condition holds. False after that many seconds without. */
bool fixture_wait(struct bus *bus, bool (*condition)(void), double seconds);

/* Encodes anything: struct bus_type for messages that are no messages. */
struct raw_message {
	const void *bytes;
	int size;
};
extern const struct bus_type bus_raw;

/* A program of the build folder (or with a full path) with its arguments (the last NULL). What it says goes to files
 * that fixture_said() reads. */
pid_t fixture_start(const char *program, const char *const *arguments);
/* Waits for its end. Exit status, 128 + signal, or -1 after that many seconds. */
int fixture_end(pid_t pid, double seconds);
/* What it said so far on stdout (1) or stderr (2), at most size - 1 bytes. */
void fixture_said(pid_t pid, int descriptor, char *out, size_t size);
/* Path of a file in a folder of this test's own, valid until the next call. */
const char *fixture_file(const char *name);
/* Kills what still runs and removes the folder. */
void fixture_cleanup(void);

#endif
