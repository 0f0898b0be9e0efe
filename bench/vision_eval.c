#include "vision_eval.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

void numbers_add(struct numbers *n, double value)
{
	if (n->count == n->capacity) {
		n->capacity = n->capacity > 0 ? 2 * n->capacity : 256;
		n->value = realloc(n->value, sizeof(*n->value) * (size_t)n->capacity);
		if (!n->value)
			abort();
	}
	n->value[n->count++] = value;
}

static int by_value(const void *a, const void *b)
{
	const double *x = a, *y = b;
	return (*x > *y) - (*x < *y);
}

double numbers_quantile(struct numbers *n, double share)
{
	if (n->count == 0)
		return 0;
	qsort(n->value, (size_t)n->count, sizeof(*n->value), by_value);
	int at = (int)(share * n->count);
	return n->value[at < n->count ? at : n->count - 1];
}

double numbers_rms(const struct numbers *n)
{
	double sum = 0;
	for (int i = 0; i < n->count; i++)
		sum += n->value[i] * n->value[i];
	return n->count > 0 ? sqrt(sum / n->count) : 0;
}

struct vision *eval_vision(const struct config *config, const struct colour_model *colours)
{
	char err[256] = "";
	struct vision *vision;
	struct vision_def def = config_vision_def(config, colours);
	if (vision_create(&vision, &def, err, sizeof(err)) < 0) {
		fprintf(stderr, "vision: %s\n", err);
		exit(1);
	}
	return vision;
}

double eval_seconds(void)
{
	struct timespec t;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void eval_bar(struct report *report, const char *name, double value, const char *unit, double bar)
{
	report_number(report, name, value, unit);
	if (!isnan(bar))
		printf("    bar: at most %g %s%s\n", bar, unit, value <= bar ? "" : "   MISSED");
}

void eval_floor(struct report *report, const char *name, double value, const char *unit, double floor)
{
	report_number(report, name, value, unit);
	printf("    bar: at least %g %s%s\n", floor, unit, value >= floor ? "" : "   MISSED");
}
