#include "app/virtual/judge.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "app/light/draw.h"
#include "search/plan.h"
#include "search/rules.h"

static const double PLACE_MAX = 0.005;	      /* m a ball asked for may lie off */
static const double MOVED = 0.0005;	      /* m: a ball that lies elsewhere by more is a new position */
static const double HALO_OFF = 0.010;	      /* m: a ring lies at a ball's old place */
static const int64_t SETTLED_US = 1000000;    /* a frame's belief is counted after so much rest */
static const int64_t SILENT_US = 5000000;     /* a rest of so long without a request is one too long */
static const int64_t STALE_TOLD_US = 2000000; /* light for a wrong position that long is told */

const char *judge_cause_name(enum judge_cause cause)
{
	static const char *const name[] = {"double", "ghost", "missing", "colour", "place"};
	return name[cause];
}

/* ---- times ---------------------------------------------------------------------------------------------------------- */

static void add_time(struct judge_times *times, int64_t us)
{
	double ms = fmax(0, 1e-3 * (double)us);
	times->bin[(int)fmin(ms, JUDGE_MS_MAX)]++;
	times->count++;
	times->max = fmax(times->max, ms);
}

double judge_times_share(const struct judge_times *times, double share)
{
	int64_t seen = 0;
	for (int i = 0; i <= JUDGE_MS_MAX && times->count > 0; i++) {
		seen += times->bin[i];
		if ((double)seen >= share * (double)times->count)
			return i;
	}
	return 0;
}

/* ---- what was found ------------------------------------------------------------------------------------------------- */

static void find(struct judge *j, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void find(struct judge *j, const char *format, ...)
{
	va_list args;
	va_start(args, format);
	if (!j->finding[0])
		vsnprintf(j->finding, sizeof j->finding, format, args);
	va_end(args);
}

bool judge_finding(struct judge *j, char *out, size_t size)
{
	bool found = j->finding[0] != '\0';
	if (found)
		snprintf(out, size, "%s", j->finding);
	j->finding[0] = '\0';
	return found;
}

/* ---- positions ------------------------------------------------------------------------------------------------------ */

static enum judge_cause cause_of(const struct judge_match *m)
{
	return m->doubles		  ? JUDGE_DOUBLE
	       : m->extra		  ? JUDGE_GHOST
	       : m->missing		  ? JUDGE_MISSING
	       : m->colour_wrong	  ? JUDGE_COLOUR
	       : m->max_error > PLACE_MAX ? JUDGE_PLACE
					  : JUDGE_CAUSE_COUNT;
}

static enum judge_cause compare(const struct judge *j, const struct judge_position *real,
				const struct judge_position *believed, struct judge_match *match)
{
	judge_match(real, believed, 2 * j->ball_radius, match);
	return cause_of(match);
}

static int find_track(const struct judge_position *p, int track)
{
	for (int i = 0; i < p->count; i++)
		if (p->ball[i].track == track)
			return i;
	return -1;
}

/* The virtual table's balls keep their numbers. */
static bool same_place(const struct judge_position *a, const struct judge_position *b)
{
	for (int i = 0; i < a->count; i++) {
		int k = find_track(b, a->ball[i].track);
		if (k < 0 || vec2_dist(a->ball[i].at, b->ball[k].at) > MOVED)
			return false;
	}
	return a->count == b->count;
}

static int count_colour(const struct judge_position *p, enum ball_colour colour)
{
	int n = 0;
	for (int i = 0; i < p->count; i++)
		n += p->ball[i].colour == colour;
	return n;
}

/* Says which ball is wrong. */
static void tell_wrong(struct judge *j, enum judge_cause cause, const struct judge_position *real,
		       const struct judge_position *believed, const struct judge_match *m)
{
	char text[160] = "";
	size_t n = 0;
	for (int i = 0; i < real->count && n < sizeof text; i++) {
		int k = m->believed_of[i];
		const char *name = ball_colour_name(real->ball[i].colour);
		double x = 1e3 * real->ball[i].at.x, y = 1e3 * real->ball[i].at.y;
		if (k < 0)
			n += (size_t)snprintf(text + n, sizeof text - n, " %s (%.0f, %.0f) missed;", name, x, y);
		else if (real->ball[i].colour != believed->ball[k].colour)
			n += (size_t)snprintf(text + n, sizeof text - n, " %s (%.0f, %.0f) as %s;", name, x, y,
					      ball_colour_name(believed->ball[k].colour));
		else if (vec2_dist(real->ball[i].at, believed->ball[k].at) > PLACE_MAX)
			n += (size_t)snprintf(text + n, sizeof text - n, " %s (%.0f, %.0f) off by %.1f mm;", name, x, y,
					      1e3 * vec2_dist(real->ball[i].at, believed->ball[k].at));
	}
	for (int k = 0; k < believed->count && n < sizeof text; k++)
		if (m->real_of[k] < 0)
			n += (size_t)snprintf(text + n, sizeof text - n, " %s (%.0f, %.0f) is not there;",
					      ball_colour_name(believed->ball[k].colour), 1e3 * believed->ball[k].at.x,
					      1e3 * believed->ball[k].at.y);
	find(j, "rest %lld: %s:%s", (long long)j->report.rests, judge_cause_name(cause), text);
}

/* ---- light ---------------------------------------------------------------------------------------------------------- */

static struct judge_asked *asked_of(struct judge *j, int64_t id)
{
	int64_t first = j->asked_count > JUDGE_REQUESTS ? j->asked_count - JUDGE_REQUESTS : 0;
	for (int64_t i = j->asked_count; i-- > first;)
		if (j->asked[i % JUDGE_REQUESTS].id == id)
			return &j->asked[i % JUDGE_REQUESTS];
	return NULL;
}

/* A ring as they are drawn around balls, where no ball lies. */
static bool ring_without_ball(const struct judge *j, const struct judge_position *real)
{
	const billiard_draw_list_t *list = &j->light;
	for (int i = 0; i < list->item_count; i++) {
		const billiard_draw_item_t *item = &list->items[i];
		double radii = item->radius / j->ball_radius, nearest = INFINITY;
		if (item->kind != DRAW_RING || item->layer == DRAW_LAYER_TABLE || radii < 1.5 || radii > 3 ||
		    item->point_first < 0 || item->point_first >= DRAW_POINT_MAX)
			continue;
		vec2 at = {list->xs[item->point_first], list->ys[item->point_first]};
		for (int k = 0; k < real->count; k++)
			nearest = fmin(nearest, vec2_dist(at, real->ball[k].at));
		if (nearest > HALO_OFF)
			return true;
	}
	return false;
}

/* Whether the light on the table stands for another position than the one that is there. */
static bool is_stale(struct judge *j)
{
	const struct judge_position *real = &j->truth[j->truths % JUDGE_TRUTHS].position;
	struct judge_asked *asked = j->light.plan_id ? asked_of(j, j->light.plan_id) : NULL;
	struct judge_match match;
	if (j->truths == 0)
		return false;
	if (asked && (!j->at_rest || compare(j, real, &asked->position, &match) != JUDGE_CAUSE_COUNT))
		return true;
	return ring_without_ball(j, real);
}

static void watch_light(struct judge *j, int64_t now)
{
	bool stale = is_stale(j);
	if (stale && !j->is_stale)
		j->stale_since = now;
	if (!stale && j->is_stale) {
		add_time(&j->report.stale_light, now - j->stale_since);
		if (now - j->stale_since > STALE_TOLD_US)
			find(j, "rest %lld: light: for a wrong position for %.1f s", (long long)j->report.rests,
			     1e-6 * (double)(now - j->stale_since));
	}
	j->is_stale = stale;
}

/* Light that nobody vouches for any more is switched off. */
static void expire_light(struct judge *j, int64_t now)
{
	if (!lease_is_over(&j->lease, 1e-6 * (double)now) || j->light.item_count == 0)
		return;
	draw_clear(&j->light);
	j->light.plan_id = 0;
	watch_light(j, (int64_t)(1e6 * j->lease.until));
}

void judge_lease(struct judge *j, int64_t now, const billiard_lease_t *lease)
{
	expire_light(j, now);
	lease_take(&j->lease, lease, 1e-6 * (double)now);
}

/* ---- rests ---------------------------------------------------------------------------------------------------------- */

static void end_rest(struct judge *j, int64_t now)
{
	if (!j->at_rest)
		return;
	j->report.more_than_one_request += j->rest_requests > 1;
	j->report.without_request += j->rest_requests == 0 && now - j->rest_begin > SILENT_US;
	j->at_rest = false;
}

static void begin_rest(struct judge *j, const struct judge_position *position, int64_t utime)
{
	j->report.rests++;
	j->rest = *position;
	j->rest_begin = utime;
	j->at_rest = true;
	j->rest_drawn = j->rest_changed = j->rest_told = false;
	j->rest_requests = 0;
}

static bool fell(const struct judge *j, enum ball_colour low, enum ball_colour high)
{
	for (int i = 0; i < j->before.count; i++)
		if ((j->fallen >> i & 1) && j->before.ball[i].colour >= low && j->before.ball[i].colour <= high)
			return true;
	return false;
}

static int on_of_position(const struct judge_position *p)
{
	return count_colour(p, COLOUR_RED) > 0 ? ON_RED : ON_CLEARANCE;
}

/* The ball on after a shot, as far as what fell tells it: who was touched first is not seen here. */
static void end_of_shot(struct judge *j, const struct judge_position *now)
{
	bool red = fell(j, COLOUR_RED, COLOUR_RED), colour = fell(j, COLOUR_YELLOW, COLOUR_BLACK);
	j->cue_fell = fell(j, COLOUR_WHITE, COLOUR_WHITE);
	j->on = j->on == ON_RED && red && !colour && !j->cue_fell ? ON_COLOUR : on_of_position(now);
	if (j->stale_target != 0) {
		int i = find_track(&j->before, j->stale_target);
		j->report.made += i >= 0 && (j->fallen >> i & 1);
	}
	j->stale_target = 0;
}

/* What is proposed on the table when the player strikes. */
static void begin_of_shot(struct judge *j)
{
	struct judge_asked *asked = j->light.plan_id ? asked_of(j, j->light.plan_id) : NULL;
	j->report.shots++;
	j->before = j->rest;
	j->fallen = 0;
	j->stale_target = asked && asked->drawn.request ? asked->target_track : 0;
	j->report.proposed_pots += j->stale_target != 0;
}

static void remember_truth(struct judge *j, const billiard_table_state_t *truth)
{
	int k = (int)(++j->truths % JUDGE_TRUTHS);
	j->truth[k].utime = truth->utime;
	j->truth[k].moving = truth->moving != 0;
	judge_position_from(&j->truth[k].position, truth->balls, truth->ball_count);
}

/* A rest of a table whose game nobody knows: as the virtual table's own player begins. */
static void first_rest(struct judge *j, const struct judge_position *position, const billiard_table_state_t *truth)
{
	j->on = on_of_position(position);
	begin_rest(j, position, truth->utime);
	j->rest_told = true;
}

void judge_truth(struct judge *j, int64_t now, const billiard_table_state_t *truth)
{
	bool first = j->truths == 0, was_moving = !first && j->truth[j->truths % JUDGE_TRUTHS].moving;
	expire_light(j, now);
	remember_truth(j, truth);
	const struct judge_position *position = &j->truth[j->truths % JUDGE_TRUTHS].position;
	if (truth->moving) {
		if (j->at_rest)
			begin_of_shot(j);
		end_rest(j, now);
		for (int i = 0; i < j->before.count; i++)
			if (find_track(position, j->before.ball[i].track) < 0)
				j->fallen |= 1u << i;
	} else if (first) {
		first_rest(j, position, truth);
	} else if (was_moving || !same_place(&j->rest, position)) {
		end_rest(j, now);
		if (was_moving)
			end_of_shot(j, position);
		begin_rest(j, position, truth->utime);
	} else if (!j->rest_told && j->rest_requests == 0 && now - j->rest_begin > SILENT_US) {
		j->rest_told = true;
		find(j, "rest %lld: silent: no request for %.0f s", (long long)j->report.rests,
		     1e-6 * (double)SILENT_US);
	}
	watch_light(j, now);
}

static bool metric(const billiard_status_t *status, const char *name, double *out)
{
	for (int i = 0; i < status->metric_count; i++)
		if (strncmp((const char *)status->metrics[i].name, name, sizeof status->metrics[i].name) == 0) {
			*out = status->metrics[i].value;
			return true;
		}
	return false;
}

void judge_status(struct judge *j, const billiard_status_t *status)
{
	double on, in_hand, moving;
	if (!j->at_rest || strncmp((const char *)status->process, "billiard-table", sizeof status->process) != 0 ||
	    !metric(status, "ball on", &on) || !metric(status, "in hand", &in_hand) ||
	    !metric(status, "moving", &moving))
		return;
	if (moving > 0 || !(on >= ON_ANY && on <= ON_CLEARANCE))
		return;
	j->on = (int)on;
	j->cue_fell = in_hand > 0;
}

/* ---- belief --------------------------------------------------------------------------------------------------------- */

/* The truth of a frame: the one of that time, else the newest. */
static const struct judge_position *truth_at(const struct judge *j, int64_t utime)
{
	int64_t first = j->truths >= JUDGE_TRUTHS ? j->truths - JUDGE_TRUTHS + 1 : 1;
	for (int64_t i = j->truths; i >= first; i--)
		if (j->truth[i % JUDGE_TRUTHS].utime == utime)
			return &j->truth[i % JUDGE_TRUTHS].position;
	return &j->truth[j->truths % JUDGE_TRUTHS].position;
}

void judge_state(struct judge *j, const billiard_table_state_t *state)
{
	struct judge_position seen;
	struct judge_match match;
	if (j->truths == 0 || !j->at_rest || state->utime < j->rest_begin + SETTLED_US || state->occluded)
		return;
	judge_position_from(&seen, state->balls, state->calibration ? state->ball_count : 0);
	j->report.frames++;
	j->report.frames_wrong += compare(j, &j->rest, &seen, &match) != JUDGE_CAUSE_COUNT;
}

/* ---- requests ------------------------------------------------------------------------------------------------------- */

static void judge_rules(struct judge *j, const billiard_plan_request_t *request)
{
	if (request->target_kind != TARGET_RULES || j->report.shots == 0)
		return;
	j->report.asked_by_rules++;
	j->report.in_hand_wrong += (request->in_hand != 0) != j->cue_fell;
	j->report.ball_on_wrong += request->on != j->on;
}

/* A cue ball in hand lies nowhere: wherever it is planned from, it is not wrong. */
static void leave_out_cue_in_hand(struct judge_position *asked, const struct judge_position *real, bool in_hand)
{
	if (!in_hand || count_colour(real, COLOUR_WHITE) > 0)
		return;
	for (int i = 0; i < asked->count; i++)
		if (asked->ball[i].colour == COLOUR_WHITE)
			asked->ball[i] = asked->ball[--asked->count];
}

void judge_request(struct judge *j, int64_t now, const billiard_plan_request_t *request)
{
	if (j->truths == 0)
		return;
	if (asked_of(j, request->id)) {
		j->report.repeated++;
		return;
	}
	struct judge_asked *asked = &j->asked[j->asked_count++ % JUDGE_REQUESTS];
	*asked = (struct judge_asked){.id = request->id};
	judge_position_from(&asked->position, request->balls, request->ball_count);
	const struct judge_position *real = truth_at(j, request->id);
	leave_out_cue_in_hand(&asked->position, real, request->in_hand != 0);
	struct judge_match match;
	enum judge_cause cause = compare(j, real, &asked->position, &match);
	j->report.requests++;
	j->rest_requests++;
	if (cause != JUDGE_CAUSE_COUNT) {
		j->report.wrong++;
		j->report.wrong_by[cause]++;
		tell_wrong(j, cause, real, &asked->position, &match);
	} else {
		judge_rules(j, request);
	}
	watch_light(j, now);
}

void judge_plan(struct judge *j, const billiard_plan_t *plan)
{
	struct judge_asked *asked = asked_of(j, plan->request_id);
	if (!asked || plan->status != 0 || plan->entry_count < 1 || plan->entries[0].shot_count < 1)
		return;
	const billiard_plan_shot_t *s = &plan->entries[0].shots[0];
	asked->best = (struct judge_shot){plan->request_id, s->angle, s->speed, s->target, s->pocket};
	asked->target_track = 0;
	if (s->target < 0 || s->pocket < 0 || s->target >= BALL_MAX)
		return;
	vec2 at = {s->start_x[s->target], s->start_y[s->target]};
	double nearest = j->ball_radius;
	for (int i = 0; i < j->rest.count; i++)
		if (vec2_dist(j->rest.ball[i].at, at) < nearest) {
			nearest = vec2_dist(j->rest.ball[i].at, at);
			asked->target_track = j->rest.ball[i].track;
		}
}

static bool same_shot(const struct judge_shot *a, const struct judge_shot *b)
{
	return a->request == b->request && a->angle == b->angle && a->speed == b->speed && a->target == b->target &&
	       a->pocket == b->pocket;
}

static bool same_picture(const billiard_draw_list_t *a, const billiard_draw_list_t *b)
{
	billiard_draw_list_t c = *a;
	c.utime = b->utime;
	c.seq = b->seq;
	return memcmp(&c, b, sizeof c) == 0;
}

void judge_draw(struct judge *j, int64_t now, const billiard_draw_list_t *list)
{
	struct judge_asked *asked = list->plan_id ? asked_of(j, list->plan_id) : NULL;
	bool changed = !same_picture(&j->light, list);
	expire_light(j, now);
	j->light = *list;
	lease_picture(&j->lease, list->seq, 1e-6 * (double)now);
	if (asked && changed && asked->drawn.request == 0) {
		asked->drawn = asked->best;
	} else if (asked && changed && !j->rest_changed && !same_shot(&asked->drawn, &asked->best)) {
		j->rest_changed = true;
		j->report.changed_after_drawn++;
	}
	if (asked && j->at_rest && !j->rest_drawn && asked->id >= j->rest_begin) {
		j->rest_drawn = true;
		if (j->report.shots > 0)
			add_time(&j->report.rest_to_drawn, now - j->rest_begin);
	}
	watch_light(j, now);
}

/* ---- life ----------------------------------------------------------------------------------------------------------- */

void judge_init(struct judge *j, double ball_radius)
{
	memset(j, 0, sizeof *j);
	j->ball_radius = ball_radius;
}

void judge_finish(struct judge *j, int64_t now)
{
	end_rest(j, now);
	if (j->is_stale)
		add_time(&j->report.stale_light, now - j->stale_since);
	j->is_stale = false;
}
