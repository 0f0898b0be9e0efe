/* billiard judge LOG... and --live: whole runs. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <systemd/sd-event.h>

#include "app/commands/cmd.h"
#include "app/commands/cmd_judge.h"
#include "app/process/bus.h"
#include "app/process/clock.h"
#include "app/process/event_log.h"
#include "app/virtual/judge.h"

enum { REPLAY_MAX = 500, PATH_SIZE = 512 };

/* One event of the last seconds, for replays. */
struct kept {
	int64_t utime;
	const char *channel; /* of the table below */
	uint8_t *data;	     /* owned */
	size_t size;
};

struct run {
	const struct judge_options *options;
	struct judge *judge; /* owned */
	const char *name;    /* of the log */
	struct kept *kept;   /* owned, kept_count from kept_first on */
	size_t kept_first, kept_count, kept_capacity;
	int64_t last;	 /* us, of the newest event */
	sd_event *event; /* borrowed, of --live; NULL: a log */
	int replays;
	bool has_truth;
};

/* ---- channels ------------------------------------------------------------------------------------------------------- */

static void feed_truth(struct run *r, int64_t now, const void *message)
{
	r->has_truth = true;
	judge_truth(r->judge, now, message);
}

static void feed_status(struct run *r, int64_t now, const void *message)
{
	(void)now;
	judge_status(r->judge, message);
}

static void feed_state(struct run *r, int64_t now, const void *message)
{
	(void)now;
	judge_state(r->judge, message);
}

static void feed_request(struct run *r, int64_t now, const void *message)
{
	judge_request(r->judge, now, message);
}

static void feed_plan(struct run *r, int64_t now, const void *message)
{
	(void)now;
	judge_plan(r->judge, message);
}

static void feed_draw(struct run *r, int64_t now, const void *message)
{
	judge_draw(r->judge, now, message);
}

static void feed_lease(struct run *r, int64_t now, const void *message)
{
	judge_lease(r->judge, now, message);
}

/* feed NULL: only kept for replays. */
static const struct channel {
	const char *name;
	const struct bus_type *type;
	void (*feed)(struct run *run, int64_t now, const void *message);
} channels[] = {
	{"TRUTH", &bus_table_state, feed_truth},
	{"STATUS", &bus_status, feed_status},
	{"TABLE_STATE", &bus_table_state, feed_state},
	{"PLAN_REQUEST", &bus_plan_request, feed_request},
	{"PLAN", &bus_plan, feed_plan},
	{"DRAW", &bus_draw_list, feed_draw},
	{"LEASE", &bus_lease, feed_lease},
	{"CAMERA", &bus_image, NULL},
};
enum { CHANNEL_COUNT = sizeof channels / sizeof channels[0] };

static const struct channel *channel_of(const char *name)
{
	for (int i = 0; i < CHANNEL_COUNT; i++)
		if (strcmp(channels[i].name, name) == 0)
			return &channels[i];
	return NULL;
}

/* ---- replays -------------------------------------------------------------------------------------------------------- */

static void forget_old(struct run *r)
{
	while (r->kept_count > 0 && 1e-6 * (double)(r->last - r->kept[r->kept_first].utime) > r->options->keep) {
		free(r->kept[r->kept_first++].data);
		r->kept_count--;
	}
}

/* Takes the data. Without memory a replay has a gap. */
static void keep(struct run *r, const struct kept *event)
{
	if (r->kept_first > 0 && r->kept_first + r->kept_count == r->kept_capacity) {
		memmove(r->kept, r->kept + r->kept_first, r->kept_count * sizeof *r->kept);
		r->kept_first = 0;
	}
	if (r->kept_count == r->kept_capacity) {
		size_t capacity = r->kept_capacity ? 2 * r->kept_capacity : 256;
		struct kept *bigger = realloc(r->kept, capacity * sizeof *bigger);
		if (!bigger) {
			free(event->data);
			return;
		}
		r->kept = bigger;
		r->kept_capacity = capacity;
	}
	r->kept[r->kept_first + r->kept_count++] = *event;
	forget_old(r);
}

static int write_kept(const struct run *r, const char *path)
{
	FILE *file = fopen(path, "wb");
	int code = file ? 0 : -errno;
	for (size_t i = 0; i < r->kept_count && code == 0; i++) {
		const struct kept *k = &r->kept[r->kept_first + i];
		code = event_log_write(file, (int64_t)i, &(struct log_event){k->utime, k->channel, k->data, k->size});
	}
	if (file && fclose(file) != 0)
		code = -errno;
	return code;
}

/* A replay of the last seconds, and a line in DIR/README that says what is wrong in it. */
static void save_replay(struct run *r, const char *what)
{
	char path[PATH_SIZE], list[PATH_SIZE], kind[24] = "";
	const char *slash = strrchr(r->name, '/'), *name = slash ? slash + 1 : r->name, *colon = strstr(what, ": ");
	if (colon)
		sscanf(colon + 2, "%20[a-z]", kind);
	if (++r->replays > REPLAY_MAX)
		return;
	snprintf(path, sizeof path, "%s/%.*s-%03d-%s.lcmlog", r->options->out, (int)strcspn(name, "."), name,
		 r->replays, kind);
	snprintf(list, sizeof list, "%s/README", r->options->out);
	int code = write_kept(r, path);
	FILE *file = code == 0 ? fopen(list, "a") : NULL;
	if (file)
		fprintf(file, "%s: %s\n", strrchr(path, '/') + 1, what);
	if (!file || fclose(file) != 0)
		fprintf(stderr, "billiard judge: %s: %s\n", path, strerror(code < 0 ? -code : errno));
}

static void tell_finding(struct run *r)
{
	char what[JUDGE_TEXT_SIZE];
	if (!judge_finding(r->judge, what, sizeof what))
		return;
	if (!r->options->json)
		printf("%s: %s\n", r->name, what);
	if (r->options->out)
		save_replay(r, what);
}

/* ---- report --------------------------------------------------------------------------------------------------------- */

static json_t *times_json(const struct judge_times *t)
{
	return json_pack("{s:f,s:f,s:f,s:I}", "median", judge_times_share(t, 0.5), "p99", judge_times_share(t, 0.99),
			 "max", t->max, "count", (json_int_t)t->count);
}

static json_t *causes_json(const struct judge_report *p)
{
	json_t *causes = json_object();
	for (int i = 0; i < JUDGE_CAUSE_COUNT; i++)
		json_object_set_new(causes, judge_cause_name((enum judge_cause)i), json_integer(p->wrong_by[i]));
	return causes;
}

/* Null: the run had nothing to tell it by. */
static json_t *by_rules(const struct judge_report *p, int64_t value)
{
	return p->asked_by_rules ? json_integer(value) : json_null();
}

static int print_json(const struct run *r)
{
	const struct judge_report *p = &r->judge->report;
	json_t *o = json_pack("{s:s,s:I,s:I,s:I,s:I,s:o,s:I,s:o,s:o,s:I,s:o,s:o,s:n,s:I,s:I}", "log", r->name, "shots",
			      (json_int_t)p->shots, "rests", (json_int_t)p->rests, "requests", (json_int_t)p->requests,
			      "wrong", (json_int_t)p->wrong, "wrong_by", causes_json(p), "more_than_one_request",
			      (json_int_t)p->more_than_one_request, "rest_to_drawn_ms", times_json(&p->rest_to_drawn),
			      "stale_light_ms", times_json(&p->stale_light), "changed_after_drawn",
			      (json_int_t)p->changed_after_drawn, "ball_on_wrong", by_rules(p, p->ball_on_wrong),
			      "in_hand_wrong", by_rules(p, p->in_hand_wrong), "score_wrong", "proposed_pots",
			      (json_int_t)p->proposed_pots, "made", (json_int_t)p->made);
	if (o) {
		json_object_set_new(o, "without_request", json_integer(p->without_request));
		json_object_set_new(o, "repeated", json_integer(p->repeated));
		json_object_set_new(o, "frames", json_integer(p->frames));
		json_object_set_new(o, "frames_wrong", json_integer(p->frames_wrong));
	}
	return cmd_json_line(o);
}

static void print_times(const char *what, const struct judge_times *t)
{
	printf("  %-24s median %.0f ms, 99 %% %.0f ms, longest %.0f ms (%lld)\n", what, judge_times_share(t, 0.5),
	       judge_times_share(t, 0.99), t->max, (long long)t->count);
}

static int print_table(const struct run *r)
{
	const struct judge_report *p = &r->judge->report;
	printf("%s: %lld shots, %lld rests, %lld requests, %lld wrong (", r->name, (long long)p->shots,
	       (long long)p->rests, (long long)p->requests, (long long)p->wrong);
	for (int i = 0; i < JUDGE_CAUSE_COUNT; i++)
		printf("%s%s %lld", i ? ", " : "", judge_cause_name((enum judge_cause)i), (long long)p->wrong_by[i]);
	printf(")\n");
	print_times("rest to drawn", &p->rest_to_drawn);
	print_times("light for a wrong place", &p->stale_light);
	printf("  rests with more than one request %lld, without one %lld; first shot changed after being drawn %lld\n",
	       (long long)p->more_than_one_request, (long long)p->without_request, (long long)p->changed_after_drawn);
	if (p->asked_by_rules)
		printf("  ball on wrong %lld, ball in hand wrong %lld of %lld\n", (long long)p->ball_on_wrong,
		       (long long)p->in_hand_wrong, (long long)p->asked_by_rules);
	printf("  proposed pots %lld, made %lld; frames at rest %lld, seen wrong %lld\n", (long long)p->proposed_pots,
	       (long long)p->made, (long long)p->frames, (long long)p->frames_wrong);
	return CMD_OK;
}

/* ---- runs ----------------------------------------------------------------------------------------------------------- */

static int begin(struct run *r, const struct config *config, const struct judge_options *options, const char *name)
{
	*r = (struct run){.options = options, .name = name, .judge = malloc(sizeof *r->judge)};
	if (!r->judge)
		return -ENOMEM;
	judge_init(r->judge, config->table.ball_radius);
	return 0;
}

static void finish(struct run *r)
{
	for (size_t i = 0; i < r->kept_count; i++)
		free(r->kept[r->kept_first + i].data);
	free(r->kept);
	free(r->judge);
}

static int report(struct run *r)
{
	judge_finish(r->judge, r->last);
	tell_finding(r);
	return r->options->json ? print_json(r) : print_table(r);
}

static int take_event(struct run *r, const struct log_event *event, void *message, char *err, size_t err_size)
{
	const struct channel *c = channel_of(event->channel);
	if (!c)
		return 0;
	r->last = event->utime;
	if (r->options->out) {
		struct kept kept = {event->utime, c->name, malloc(event->size + 1), event->size};
		if (kept.data) {
			memcpy(kept.data, event->data, event->size);
			keep(r, &kept);
		}
	}
	if (!c->feed)
		return 0;
	if (!log_event_decode(event, c->type, message)) {
		snprintf(err, err_size, "%s: %s is malformed or of another version", r->name, c->name);
		return -EINVAL;
	}
	c->feed(r, event->utime, message);
	c->type->cleanup(message);
	tell_finding(r);
	return 0;
}

static void *message_room(void)
{
	size_t size = 0;
	for (int i = 0; i < CHANNEL_COUNT; i++)
		size = channels[i].type->size > size ? channels[i].type->size : size;
	return calloc(1, size);
}

static int read_run(struct run *r, char *err, size_t err_size)
{
	struct event_log *log;
	struct log_event event;
	void *message = message_room();
	int code = message ? event_log_open(&log, r->name, err, err_size) : -ENOMEM;
	if (code < 0) {
		free(message);
		return code;
	}
	while ((code = event_log_next(log, &event, err, err_size)) > 0)
		if ((code = take_event(r, &event, message, err, err_size)) < 0)
			break;
	event_log_close(log);
	free(message);
	if (code == 0 && !r->has_truth) {
		snprintf(err, err_size, "%s: holds no TRUTH", r->name);
		code = -EINVAL;
	}
	return code;
}

static int make_folder(const struct judge_options *options)
{
	if (options->out && mkdir(options->out, 0777) < 0 && errno != EEXIST)
		return cmd_bad_input("billiard judge: %s: %s", options->out, strerror(errno));
	return CMD_OK;
}

int cmd_judge_logs(const struct config *config, const struct judge_options *options, int count, char **path)
{
	int worst = make_folder(options);
	for (int i = 0; i < count && (i == 0 ? worst == CMD_OK : true); i++) {
		char err[CMD_ERROR_SIZE] = "out of memory";
		struct run r;
		int code = begin(&r, config, options, path[i]), status = CMD_OK;
		code = code < 0 ? code : read_run(&r, err, sizeof err);
		status = code < 0 ? cmd_bad_input("%s", err) : report(&r);
		worst = status > worst ? status : worst;
		finish(&r);
		fflush(stdout);
	}
	return worst;
}

/* ---- the bus -------------------------------------------------------------------------------------------------------- */

struct tap {
	struct run *run;
	const struct channel *channel;
};

static bool on_message(void *context, const void *message)
{
	const struct tap *tap = context;
	const struct bus_type *type = tap->channel->type;
	struct run *r = tap->run;
	r->last = clock_utime();
	if (r->options->out) {
		size_t size = (size_t)type->encoded_size(message);
		struct kept kept = {r->last, tap->channel->name, malloc(size + 1), size};
		if (kept.data && type->encode(kept.data, 0, (int)size, message) == (int)size)
			keep(r, &kept);
		else
			free(kept.data);
	}
	if (tap->channel->feed)
		tap->channel->feed(r, r->last, message);
	tell_finding(r);
	/* The rest after the last shot is waited for. */
	if (r->options->shots > 0 && (double)r->judge->report.shots > r->options->shots)
		sd_event_exit(r->event, CMD_OK);
	return true;
}

static int on_readable(sd_event_source *source, int fd, uint32_t events, void *context)
{
	(void)fd, (void)events;
	return bus_drain(context) < 0 ? sd_event_exit(sd_event_source_get_event(source), CMD_FAILED) : 0;
}

static int on_signal(sd_event_source *source, const struct signalfd_siginfo *info, void *context)
{
	(void)info, (void)context;
	return sd_event_exit(sd_event_source_get_event(source), CMD_OK);
}

static int on_time(sd_event_source *source, uint64_t usec, void *context)
{
	(void)usec, (void)context;
	return sd_event_exit(sd_event_source_get_event(source), CMD_OK);
}

/* LCM starts a thread: the signals are blocked before. */
static void block_signals(void)
{
	sigset_t set;
	sigemptyset(&set);
	sigaddset(&set, SIGINT);
	sigaddset(&set, SIGTERM);
	sigprocmask(SIG_BLOCK, &set, NULL);
}

static int listen_to(sd_event *event, struct bus *bus, struct tap tap[CHANNEL_COUNT],
		     const struct judge_options *options)
{
	int code = sd_event_add_signal(event, NULL, SIGINT, on_signal, NULL);
	code = code < 0 ? code : sd_event_add_signal(event, NULL, SIGTERM, on_signal, NULL);
	code = code < 0 ? code : sd_event_add_io(event, NULL, bus_descriptor(bus), EPOLLIN, on_readable, bus);
	if (code >= 0 && options->seconds > 0)
		code = sd_event_add_time_relative(event, NULL, CLOCK_MONOTONIC, (uint64_t)(1e6 * options->seconds), 0,
						  on_time, NULL);
	for (int i = 0; i < CHANNEL_COUNT && code >= 0; i++)
		if (channels[i].feed || options->out)
			code = bus_subscribe(bus, &(struct bus_subscription){channels[i].name, channels[i].type,
									     BUS_EACH, on_message, &tap[i]});
	return code;
}

int cmd_judge_live(const struct config *config, const struct judge_options *options)
{
	char err[CMD_ERROR_SIZE] = "billiard judge: cannot listen";
	struct run r = {0};
	struct tap tap[CHANNEL_COUNT];
	struct bus *bus = NULL;
	sd_event *event = NULL;
	int status = make_folder(options);
	if (status != CMD_OK)
		return status;
	block_signals();
	for (int i = 0; i < CHANNEL_COUNT; i++)
		tap[i] = (struct tap){&r, &channels[i]};
	int code = begin(&r, config, options, "live");
	code = code < 0 ? code : sd_event_new(&event);
	r.event = event;
	code = code < 0 ? code : bus_open(&bus, options->bus ? options->bus : bus_url(config->bus), err, sizeof err);
	code = code < 0 ? code : listen_to(event, bus, tap, options);
	if (code >= 0) {
		status = sd_event_loop(event);
		int said = report(&r);
		status = status > said ? status : said;
	} else {
		status = cmd_bad_input("%s", err);
	}
	bus_close(bus);
	sd_event_unref(event);
	finish(&r);
	return status;
}
