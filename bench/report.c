#include "report.h"

#include <errno.h>
#include <jansson.h>
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

uint64_t bench_now(void)
{
	struct timespec now;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

static double mean_time(void (*run)(void *context), void *context, uint64_t count)
{
	uint64_t begin = bench_now();
	for (uint64_t i = 0; i < count; i++)
		run(context);
	return (double)(bench_now() - begin) / (double)count;
}

double bench_time(void (*run)(void *context), void *context)
{
	const double round_ns = 20e6;
	uint64_t count = 1;
	double best = mean_time(run, context, count);
	while (best * (double)count < round_ns / 2) {
		count *= 2;
		best = mean_time(run, context, count);
	}
	for (int i = 0; i < 15; i++) {
		double mean = mean_time(run, context, count);
		best = mean < best ? mean : best;
	}
	return best;
}
