#include "app/commands/status_print.h"

#include <math.h>
#include <string.h>

#include "app/process/text.h"

/* The texts of a message, whole and terminated. */
struct texts {
	char process[24], state[24], error[128];
};

struct metric {
	char name[24], unit[12];
	double value;
};

static struct texts texts_of(const billiard_status_t *s)
{
	struct texts t;
	text_get(t.process, sizeof t.process, s->process, sizeof s->process);
	text_get(t.state, sizeof t.state, s->state, sizeof s->state);
	text_get(t.error, sizeof t.error, s->error, sizeof s->error);
	return t;
}

static struct metric metric_of(const billiard_status_t *s, int i)
{
	struct metric m = {.value = s->metrics[i].value};
	text_get(m.name, sizeof m.name, s->metrics[i].name, sizeof s->metrics[i].name);
	text_get(m.unit, sizeof m.unit, s->metrics[i].unit, sizeof s->metrics[i].unit);
	return m;
}

static double up_seconds(const billiard_status_t *s)
{
	return 1e-6 * ((double)s->utime - (double)s->started_utime);
}

static double error_age(const billiard_status_t *s)
{
	return 1e-6 * ((double)s->utime - (double)s->error_utime);
}

/* JSON has no infinity. */
static json_t *number(double value)
{
	return isfinite(value) ? json_real(value) : json_null();
}

json_t *status_json(const billiard_status_t *s)
{
	struct texts t = texts_of(s);
	json_t *metrics = json_object();
	for (int i = 0; i < s->metric_count; i++) {
		struct metric m = metric_of(s, i);
		json_object_set_new(metrics, m.name, json_pack("{s:o,s:s}", "value", number(m.value), "unit", m.unit));
	}
	return json_pack("{s:s,s:i,s:s,s:s,s:o,s:f,s:I,s:I,s:o}", "process", t.process, "pid", (int)s->pid, "state",
			 t.state, "error", t.error, "error_age_s", t.error[0] ? json_real(error_age(s)) : json_null(),
			 "up_s", up_seconds(s), "received", (json_int_t)s->received, "ignored", (json_int_t)s->ignored,
			 "metrics", metrics);
}

void status_print_line(const billiard_status_t *s, FILE *out)
{
	struct texts t = texts_of(s);
	fprintf(out, "%-20s %7d  %-16s up %6.0f s  in %lld, ignored %lld", t.process, s->pid, t.state, up_seconds(s),
		(long long)s->received, (long long)s->ignored);
	for (int i = 0; i < s->metric_count; i++) {
		struct metric m = metric_of(s, i);
		bool plain = strcmp(m.unit, "1") == 0;
		fprintf(out, ", %s %.4g%s%s", m.name, m.value, plain ? "" : " ", plain ? "" : m.unit);
	}
	fputc('\n', out);
	if (t.error[0])
		fprintf(out, "%-20s last error, %.0f s ago: %s\n", "", error_age(s), t.error);
}
