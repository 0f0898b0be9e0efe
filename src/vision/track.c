#include "vision/track.h"

#include <limits.h>
#include <math.h>
#include <string.h>

enum {
	CONFIRM_FRAMES = 3, /* a new ball is reported when it has been seen this often */
	LOST_FRAMES = 4,    /* a ball gone from a free place is kept this long */
	TURN = 12,	    /* of resting balls, every TURN-th is fitted again in each frame */
	LOOKS_MAX = 40
};
static const double NOISE_PX = 0.12; /* a resting ball trembles by, whatever its size in the picture */
static const double FASTEST = 9;     /* m/s; no ball is faster */
static const double CONFIRM_SUPPORT = 0.78, CONFIRM_BEND = 0.3; /* radii */
static const double FIRST_SUPPORT = 0.75;			/* a first frame is believed what has that much rim */
static const double LOOK_DISTANCE = 1.2;			/* features further apart are another ball's */
static const double LOOK_SAME = 0.3;	 /* of a resting ball: further apart, and it is not the ball it was */
static const double JUMP_REACH = 1.2;	 /* radii off its way: a track found further away proves its colour anew */
static const double PLACE_REACH = 0.9;	 /* radii; nearer than that two finds at rest are one ball */
static const double PLACE_SAME = 0.0015; /* m; further off, the ball at rest lies elsewhere than was believed */
static const double COVERED_SHARE = 0.35;
static const double POCKET_REACH = 1.0; /* radii beyond a pocket's circle: what is dark there is the pocket */
enum {
	LOOKS_SURE = 2,	  /* whole looks that make a ball which is clearly seen */
	LOOKS_UNSURE = 4, /* one that is not */
	LOOKS_ABSENT = 2, /* whole looks without it that end one */
	HURRY_MAX = 6	  /* in each frame; then it takes time */
};
static const double LOOK_INTERVAL = 0.9, LOOK_DOUBT = 0.2; /* s between whole looks, all being well and not */

void tracker_init(struct tracker *t, struct detector *detector)
{
	*t = (struct tracker){.detector = detector, .next_id = 1};
}

void tracker_forget(struct tracker *t)
{
	memset(t->track, 0, sizeof(t->track));
}

/* ---- one track
 * ------------------------------------------------------------------------------------------------------- */

static void learn_look(struct track *k, const struct colour_feature *look)
{
	k->looks += k->looks < LOOKS_MAX;
	for (int i = 0; i < COLOUR_FEATURES; i++)
		k->look.v[i] += (look->v[i] - k->look.v[i]) / k->looks;
}

/* Three places in a row on a line, evenly spaced: chance finds on an arm jump about. */
static bool moves_like_a_ball(const struct tracker *t, const struct track *k)
{
	const vec2 *raw = k->steady.raw;
	if (k->steady.raw_count < 3)
		return false;
	vec2 bend = vec2_add(vec2_madd(raw[0], -2, raw[1]), raw[2]);
	return k->seen.fit.support > CONFIRM_SUPPORT &&
	       vec2_norm(bend) < CONFIRM_BEND * t->detector->table->ball_radius;
}

static void notice(const struct tracker *t, struct track *k)
{
	k->age++;
	k->misses = k->absent = 0;
	k->seen_time = t->time;
}

static void update(struct tracker *t, struct track *k, const struct sighting *c)
{
	double noise = NOISE_PX * t->detector->table->ball_radius / c->fit.outline.radius_px;
	notice(t, k);
	if (c->fixed)
		return;
	k->seen = *c;
	/* Blurred, a ball looks like another; at rest, what looks like another is another. */
	if (!k->steady.moving && colour_difference(&k->look, &c->look) > LOOK_SAME)
		k->looks = 0;
	stabilise_add(&k->steady, c->fit.pos, t->time, noise);
	learn_look(k, &c->look);
	k->confirmed = k->confirmed || (k->age >= CONFIRM_FRAMES && moves_like_a_ball(t, k));
}

static void start(struct tracker *t, const struct sighting *c, bool confirmed)
{
	for (int i = 0; i < TRACK_MAX; i++) {
		struct track *k = &t->track[i];
		if (k->id != 0)
			continue;
		*k = (struct track){.id = t->next_id++,
				    .age = 1,
				    .looked = 1,
				    .seen_time = t->time,
				    .confirmed = confirmed,
				    .seen = *c,
				    .steady = stabilise_begin(c->fit.pos, t->time)};
		learn_look(k, &c->look);
		return;
	}
}

/* Within a pocket's dark mouth. */
static bool is_at_pocket(const struct table *table, vec2 pos)
{
	for (int i = 0; i < table->pocket_count; i++)
		if (vec2_dist(pos, table->pocket[i].centre) <
		    table->pocket[i].radius + POCKET_REACH * table->ball_radius)
			return true;
	return false;
}

/* Something lies over its place that is neither another ball nor a pocket. */
static bool is_hidden(const struct tracker *t, const struct track *k)
{
	const struct detector *d = t->detector;
	for (int j = 0; j < d->count; j++)
		if (vec2_dist(d->candidate[j].fit.pos, k->steady.pos) < 2 * PLACE_REACH * d->table->ball_radius)
			return false;
	return !is_at_pocket(d->table, k->steady.pos) && detector_cover(d, k->seen.fit.outline.centre) > COVERED_SHARE;
}

static void drop(struct tracker *t, struct track *k)
{
	t->judged = t->judged && !k->confirmed;
	*k = (struct track){0};
}

static void miss(struct tracker *t, struct track *k)
{
	k->age++;
	k->misses++;
	k->looked = 0;
	if (k->confirmed && !k->steady.moving && is_hidden(t, k))
		return;
	if (!k->confirmed || k->misses > LOST_FRAMES)
		drop(t, k);
}

/* ---- matching
 * -------------------------------------------------------------------------------------------------------- */

static vec2 predicted(const struct track *k, double time)
{
	double dt = fmin(fmax(time - k->seen_time, 0), 0.2);
	return vec2_madd(k->steady.pos, dt, k->steady.vel);
}

/* How badly a new candidate fits a track that was not found where it was; infinite when it cannot be it. */
static double mismatch(const struct tracker *t, const struct track *k, const struct sighting *c)
{
	double reach = 2 * t->detector->table->ball_radius;
	/* What is not yet known to be a ball has no claim to things far away. */
	if (k->confirmed)
		reach += FASTEST * fmin(t->time - k->seen_time, 0.15);
	double far = vec2_dist(predicted(k, t->time), c->fit.pos), other = colour_difference(&k->look, &c->look);
	return far < reach && other < LOOK_DISTANCE ? far / reach + 0.5 * other / LOOK_DISTANCE : INFINITY;
}

/* The place of a ball that is somewhere else than where it should be is its own; its colour it must prove anew. */
static void take(struct tracker *t, struct track *k, const struct sighting *c)
{
	if (vec2_dist(predicted(k, t->time), c->fit.pos) > JUMP_REACH * t->detector->table->ball_radius)
		k->looks = 0;
	update(t, k, c);
}

/* Best pair first, until none is left. */
static void match_new(struct tracker *t, bool found[TRACK_MAX], bool taken[DETECT_MAX])
{
	struct detector *d = t->detector;
	for (;;) {
		double best = INFINITY;
		int bi = 0, bj = 0;
		for (int i = 0; i < TRACK_MAX; i++)
			for (int j = 0; j < d->count && t->track[i].id != 0 && !found[i]; j++) {
				double m = taken[j] ? INFINITY : mismatch(t, &t->track[i], &d->candidate[j]);
				if (m < best) {
					best = m;
					bi = i;
					bj = j;
				}
			}
		if (!isfinite(best))
			return;
		found[bi] = taken[bj] = true;
		take(t, &t->track[bi], &d->candidate[bj]);
	}
}

static void take_over(struct tracker *t)
{
	struct detector *d = t->detector;
	bool found[TRACK_MAX] = {false}, taken[DETECT_MAX] = {false};
	for (int j = 0; j < d->count; j++) {
		int tag = d->candidate[j].tag;
		if (tag < 0)
			continue;
		update(t, &t->track[tag], &d->candidate[j]);
		found[tag] = taken[j] = true;
	}
	match_new(t, found, taken);
	for (int i = 0; i < TRACK_MAX; i++)
		if (t->track[i].id != 0 && !found[i])
			miss(t, &t->track[i]);
	for (int j = 0; j < d->count; j++)
		if (!taken[j])
			start(t, &d->candidate[j], false);
}

/* ---- whole looks
 * ------------------------------------------------------------------------------------------------------ */

static bool is_sure(const struct sighting *c)
{
	return c->confidence >= TRACK_SURE;
}

/* Beside a hand a poor rim may be the hand's: no number of looks makes it a ball. */
static int looks_needed(const struct tracker *t, const struct sighting *c)
{
	if (c->fit.support > CONFIRM_SUPPORT)
		return LOOKS_SURE;
	return t->occluded ? INT_MAX : LOOKS_UNSURE;
}

/* A resting ball and what the frame shows in its place: where they differ the frame is right, if it is clear. */
static void believe(struct tracker *t, struct track *k, const struct sighting *c)
{
	bool elsewhere = vec2_dist(k->steady.pos, c->fit.pos) > PLACE_SAME;
	k->looked++;
	k->disputed = elsewhere && !is_sure(c);
	if (k->disputed) {
		notice(t, k);
		t->judged = false;
		return;
	}
	if (elsewhere)
		k->steady = stabilise_begin(c->fit.pos, t->time);
	update(t, k, c);
	k->confirmed = k->confirmed || k->looked >= looks_needed(t, c);
	t->judged = t->judged && k->confirmed;
}

/* Nearest first, within a ball's place. */
static void match_places(struct tracker *t, bool found[TRACK_MAX], bool taken[DETECT_MAX])
{
	struct detector *d = t->detector;
	for (;;) {
		double best = PLACE_REACH * d->table->ball_radius;
		int bi = -1, bj = 0;
		for (int i = 0; i < TRACK_MAX; i++)
			for (int j = 0; j < d->count && t->track[i].id != 0 && !found[i]; j++) {
				double far = vec2_dist(t->track[i].steady.pos, d->candidate[j].fit.pos);
				if (!taken[j] && far < best) {
					best = far;
					bi = i;
					bj = j;
				}
			}
		if (bi < 0)
			return;
		found[bi] = taken[bj] = true;
		believe(t, &t->track[bi], &d->candidate[bj]);
	}
}

/* Nothing there: it is hidden, or after another look gone. */
static void doubt(struct tracker *t, struct track *k)
{
	k->age++;
	k->misses++;
	k->looked = 0;
	if (k->confirmed && is_hidden(t, k))
		return;
	t->judged = false;
	if (!k->confirmed || ++k->absent >= LOOKS_ABSENT)
		drop(t, k);
}

static void judge(struct tracker *t)
{
	struct detector *d = t->detector;
	bool found[TRACK_MAX] = {false}, taken[DETECT_MAX] = {false};
	t->judged = true;
	match_places(t, found, taken);
	for (int i = 0; i < TRACK_MAX; i++)
		if (t->track[i].id != 0 && !found[i])
			doubt(t, &t->track[i]);
	for (int j = 0; j < d->count; j++)
		if (!taken[j]) {
			start(t, &d->candidate[j], false);
			t->judged = false;
		}
}

/* A first frame is all there is to believe; but what has little rim may be part of an arm. */
static void begin(struct tracker *t)
{
	struct detector *d = t->detector;
	for (int j = 0; j < d->count; j++)
		start(t, &d->candidate[j], d->candidate[j].fit.support >= FIRST_SUPPORT);
}

void tracker_look(struct tracker *t, double time, bool resting)
{
	bool first = true;
	for (int i = 0; i < TRACK_MAX; i++)
		first = first && t->track[i].id == 0;
	t->time = t->look_time = time;
	t->fitted = t->detector->count;
	t->judged = false;
	if (first)
		begin(t);
	else if (resting)
		judge(t);
	else
		take_over(t);
	t->hurry = t->judged || !resting ? 0 : t->hurry + 1;
}

bool tracker_wants_look(const struct tracker *t, double time, bool worried)
{
	if (!t->judged && t->hurry < HURRY_MAX)
		return true;
	for (int i = 0; i < TRACK_MAX && !worried; i++) {
		const struct track *k = &t->track[i];
		worried = k->id != 0 && ((k->misses > 0 && !t->occluded) || k->disputed || !is_sure(&k->seen));
	}
	return time - t->look_time > (worried || !t->judged ? LOOK_DOUBT : LOOK_INTERVAL);
}

bool tracker_moves(const struct tracker *t)
{
	for (int i = 0; i < TRACK_MAX; i++)
		if (t->track[i].id != 0 && t->track[i].confirmed && t->track[i].steady.moving)
			return true;
	return false;
}

/* ---- frames
 * ---------------------------------------------------------------------------------------------------------- */

/* A cell that its outline reaches into has changed. */
static bool is_disturbed(const struct scan *s, const struct fit *fit)
{
	vec2 mid = scan_from_full(s, fit->outline.centre);
	double r = fit->outline.radius_px / s->factor + 2;
	int x0 = (int)(mid.x - r) / SCAN_CELL, x1 = (int)(mid.x + r) / SCAN_CELL;
	int y0 = (int)(mid.y - r) / SCAN_CELL, y1 = (int)(mid.y + r) / SCAN_CELL;
	const uint8_t *core = s->changed + s->cells_x * s->cells_y;
	for (int y = y0 < 0 ? 0 : y0; y <= y1 && y < s->cells_y; y++)
		for (int x = x0 < 0 ? 0 : x0; x <= x1 && x < s->cells_x; x++)
			if (core[y * s->cells_x + x])
				return true;
	return false;
}

static bool needs_fit(const struct tracker *t, const struct track *k)
{
	return k->steady.moving || k->steady.away > 0 || k->misses > 0 || k->age < TURN ||
	       (t->frame + (unsigned)k->id) % TURN == 0 || is_disturbed(&t->detector->scan, &k->seen.fit);
}

/* A moving ball is looked for where it should be, then where it was. */
static bool follow(struct tracker *t, int i)
{
	const struct track *k = &t->track[i];
	if (k->steady.moving && detector_follow(t->detector, &k->seen, predicted(k, t->time), i))
		return true;
	return detector_follow(t->detector, &k->seen, k->steady.pos, i);
}

void tracker_step(struct tracker *t, const struct image *frame, const struct camera *camera, double time)
{
	bool fit[TRACK_MAX];
	t->time = time;
	t->frame++;
	t->fitted = 0;
	detector_begin(t->detector, frame, camera);
	/* What rests comes first: the others are fitted around it. */
	for (int i = 0; i < TRACK_MAX; i++) {
		fit[i] = t->track[i].id != 0 && needs_fit(t, &t->track[i]);
		if (t->track[i].id != 0 && !fit[i])
			detector_keep(t->detector, &t->track[i].seen, i);
	}
	for (int i = 0; i < TRACK_MAX; i++)
		t->fitted += fit[i] && follow(t, i);
	detector_search(t->detector, t->detector->scan.changed);
	detector_settle(t->detector);
	take_over(t);
	if (tracker_moves(t)) {
		t->judged = false;
		t->hurry = 0;
	}
	/* Something has come that may be a ball. */
	for (int i = 0; i < TRACK_MAX; i++)
		t->judged = t->judged && (t->track[i].id == 0 || t->track[i].confirmed);
}
