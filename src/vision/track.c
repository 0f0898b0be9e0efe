#include "vision/track.h"

#include <math.h>
#include <string.h>

enum {
	CONFIRM_FRAMES = 3,   /* a new ball is reported when it has been seen this often */
	LOST_FRAMES = 4,      /* a ball gone from a free place is kept this long */
	COVERED_FRAMES = 150, /* one that something covers */
	TURN = 8,	      /* of resting balls, every TURN-th is fitted again in each frame */
	LOOKS_MAX = 40
};
static const double NOISE_PX = 0.12; /* a resting ball trembles by, whatever its size in the picture */
static const double FASTEST = 9;     /* m/s; no ball is faster */
static const double CONFIRM_SUPPORT = 0.78, CONFIRM_BEND = 0.3; /* radii */
static const double LOOK_DISTANCE = 1.2;			/* features further apart are another ball's */
static const double COVERED_SHARE = 0.35;

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

static void update(struct tracker *t, struct track *k, const struct sighting *c)
{
	double noise = NOISE_PX * t->detector->table->ball_radius / c->fit.outline.radius_px;
	k->age++;
	k->misses = 0;
	k->seen_time = t->time;
	if (c->fixed)
		return;
	k->seen = *c;
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
				    .seen_time = t->time,
				    .confirmed = confirmed,
				    .seen = *c,
				    .steady = stabilise_begin(c->fit.pos, t->time)};
		learn_look(k, &c->look);
		return;
	}
}

static void miss(struct tracker *t, struct track *k)
{
	k->age++;
	k->misses++;
	bool covered = detector_cover(t->detector, k->seen.fit.outline.centre) > COVERED_SHARE;
	if (!k->confirmed || k->misses > (covered && !k->steady.moving ? COVERED_FRAMES : LOST_FRAMES))
		*k = (struct track){0};
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
		update(t, &t->track[bi], &d->candidate[bj]);
	}
}

static void take_over(struct tracker *t, bool confirmed)
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
			start(t, &d->candidate[j], confirmed);
}

/* ---- frames
 * ---------------------------------------------------------------------------------------------------------- */

void tracker_restart(struct tracker *t, double time)
{
	bool first = true;
	for (int i = 0; i < TRACK_MAX; i++)
		first = first && t->track[i].id == 0;
	t->time = time;
	t->fitted = t->detector->count;
	take_over(t, first);
}

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
	return k->steady.moving || k->misses > 0 || k->age < TURN || (t->frame + (unsigned)k->id) % TURN == 0 ||
	       is_disturbed(&t->detector->scan, &k->seen.fit);
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
	take_over(t, false);
}
