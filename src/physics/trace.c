#include "physics/trace.h"

#include "physics/motion.h"

void trace_init(struct trace *trace, struct trace_entry *entry, int capacity)
{
	*trace = (struct trace){.entry = entry, .capacity = capacity};
}

/* The ball's state just after an entry, NULL when it took no part. */
static const struct ball *part(const struct trace_entry *entry, int ball)
{
	if (entry->event.ball == ball)
		return &entry->after[0];
	return entry->event.kind == EVENT_BALL_BALL && entry->event.other == ball ? &entry->after[1] : NULL;
}

static struct ball advance(const struct trace *trace, const struct ball *from, double dt)
{
	enum event_kind kind;
	double end = motion_phase_end(from, trace->table, &kind);
	return motion_advance(from, trace->table, dt < end ? dt : end);
}

struct ball trace_at(const struct trace *trace, int ball, double t)
{
	const struct ball *from = &trace->start[ball];
	double begin = 0;
	for (int i = 0; i < trace->count && trace->entry[i].event.time <= t; i++) {
		const struct ball *after = part(&trace->entry[i], ball);
		if (after) {
			from = after;
			begin = trace->entry[i].event.time;
		}
	}
	return advance(trace, from, t - begin);
}

double trace_end(const struct trace *trace)
{
	return trace->count > 0 ? trace->entry[trace->count - 1].event.time : 0;
}
