#include "report.h"

#include <errno.h>
#include <jansson.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct report {
	char path[512];
	json_t *root;
};

struct report *report_open(const char *build, const char *name)
{
	struct report *report = calloc(1, sizeof *report);
	if (report) {
		snprintf(report->path, sizeof report->path, "%s/%s", build, name);
		report->root = json_load_file(report->path, 0, NULL);
		if (!json_is_object(report->root)) {
			json_decref(report->root);
			report->root = json_object();
		}
	}
	if (!report || !report->root) {
		fprintf(stderr, "bench: out of memory\n");
		exit(EXIT_FAILURE);
	}
	return report;
}

void report_number(struct report *report, const char *name, double value, const char *unit)
{
	printf("%-36s %12.4g %s\n", name, value, unit);
	fflush(stdout);
	json_object_set_new(report->root, name, json_pack("{s:f, s:s}", "value", value, "unit", unit));
}

int report_close(struct report *report)
{
	int r = json_dump_file(report->root, report->path, JSON_INDENT(1) | JSON_REAL_PRECISION(6));
	if (r < 0)
		fprintf(stderr, "bench: %s: %s\n", report->path, strerror(errno));
	json_decref(report->root);
	free(report);
	return r;
}

/* Time this thread has run, in ns: what else runs on the machine does not count. */
static double now_ns(void)
{
	struct timespec now;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
	return (double)now.tv_sec * 1e9 + (double)now.tv_nsec;
}

static double mean_time(void (*run)(void *context), void *context, uint64_t count)
{
	double begin = now_ns();
	for (uint64_t i = 0; i < count; i++)
		run(context);
	return (now_ns() - begin) / (double)count;
}

double bench_time(void (*run)(void *context), void *context)
{
	const double round_ns = 8e6;
	uint64_t count = 1;
	double best = mean_time(run, context, count);
	while (best * (double)count < round_ns / 2) {
		count *= 2;
		best = mean_time(run, context, count);
	}
	for (int i = 0; i < 30; i++) {
		double mean = mean_time(run, context, count);
		best = mean < best ? mean : best;
	}
	return best;
}
