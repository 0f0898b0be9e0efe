#include "vision/detector.h"

#include <math.h>
#include <string.h>

static const double EDGE_SLACK = 0.007; /* m a fitted centre may lie beyond where cushions let it be */
static const double MOUTH_INNER = 0.8;	/* of a pocket's radius: nearer to its centre a ball has fallen */
static const double SUPPORT_SEED = 0.42, SUPPORT_PACKED = 0.33, SUPPORT_MIN = 0.55;
static const double CLOTH_OFF = 0.22, CLOTH_OFF_RIM = 0.1, CLOTH_RIM = 0.85;
static const double CLOTH_DARK = -0.8, CLOTH_LIGHT = 0.3; /* ln of levels over the cloth's */
enum { ROUNDS = 3 };
static const double SUPPORT_ROUGH = 0.17; /* less in the first round */
static const double SUPPORT_CROWDED = 0.75,
		    RING_FREE = 0.35; /* more of it is wanted where it lies among other foreign things */
static const double COVER_MIN = 0.55;
static const double PART_SUPPORT = 0.75; /* with less rim it may be part of something larger ... */
static const double PART_AREA = 2;	 /* ... than so many balls */
static const double PART_REACH = 1.15;	 /* radii that a ball, with its shadow, and a pocket reach to */
static const double SCALE_MIN = 0.86, SCALE_MAX = 1.085;
static const double USUAL_SCALE = 0.965, USUAL_SPREAD = 0.02; /* apparent radius of any ball */
static const double LIKE_SPREAD = 0.004;		      /* the same among balls of one look in one frame */
static const double LIKE_DISTANCE = 0.45;		      /* features nearer than that are of one look */
static const double OVERLAP_DISTANCE = 0.80;		      /* the same for finished fits */
static const double PACK_DISTANCE = 1.08, PACK_COVER = 0.9, SMALL_RADIUS = 7;
static const double DOUBLE_DISTANCE = 0.75; /* of a diameter: nearer than that two fits are of one ball */

int detector_init(struct detector *d, const struct table *table, const struct colour_classifier *colours, int width,
		  int height)
{
	*d = (struct detector){.table = table, .colours = colours};
	int rc = scan_init(&d->scan, width, height);
	if (rc == 0)
		rc = seeds_init(&d->seeds, width, height);
	if (rc == 0)
		rc = region_init(&d->region, width, height);
	if (rc < 0)
		detector_finish(d);
	return rc;
}

void detector_finish(struct detector *d)
{
	scan_finish(&d->scan);
	seeds_finish(&d->seeds);
	region_finish(&d->region);
}

bool detector_place(struct detector *d, const struct camera *camera)
{
	return scan_place(&d->scan, camera, d->table) && seeds_place(&d->seeds, &d->scan, camera, d->table);
}

bool detect_possible(const struct table *table, vec2 pos)
{
	double hx = table->length / 2 - table->ball_radius + EDGE_SLACK,
	       hy = table->width / 2 - table->ball_radius + EDGE_SLACK;
	bool inside = fabs(pos.x) <= hx && fabs(pos.y) <= hy;
	for (int i = 0; i < table->pocket_count; i++) {
		double far = vec2_dist(pos, table->pocket[i].centre) / table->pocket[i].radius;
		if (far < MOUTH_INNER)
			return false;
		inside = inside || far < 1.6;
	}
	return inside;
}

/* Share of marked small pixels around a full pixel, within reach small radii. */
static double cover_at(const struct detector *d, vec2 px, double reach)
{
	const struct scan *s = &d->scan;
	vec2 mid = scan_from_full(s, px);
	int r = (int)(reach * SMALL_RADIUS), in = 0, marked = 0;
	for (int y = (int)mid.y - r; y <= (int)mid.y + r; y++)
		for (int x = (int)mid.x - r; x <= (int)mid.x + r; x++) {
			if (x < 0 || y < 0 || x >= s->width || y >= s->height ||
			    (x - mid.x) * (x - mid.x) + (y - mid.y) * (y - mid.y) > r * r)
				continue;
			in++;
			marked += s->mark[y * s->width + x] >= SCAN_FOREIGN / 2;
		}
	return in > 0 ? (double)marked / in : 0;
}

/* Shares of marked small pixels inside of 0.8 outlines, and between 1.2 and 1.5 of them where no other ball is. */
static void look_around(struct detector *d, struct sighting *c, bool ring)
{
	const struct scan *s = &d->scan;
	vec2 mid = scan_from_full(s, c->fit.outline.centre);
	double r = c->fit.outline.radius_px / s->factor;
	int reach = (int)(1.5 * r) + 1, in = 0, marked = 0, out = 0, foreign = 0;
	for (int y = (int)mid.y - reach; y <= (int)mid.y + reach; y++)
		for (int x = (int)mid.x - reach; x <= (int)mid.x + reach; x++) {
			if (x < 0 || y < 0 || x >= s->width || y >= s->height)
				continue;
			double q2 = ((x - mid.x) * (x - mid.x) + (y - mid.y) * (y - mid.y)) / (r * r);
			int mark = s->mark[y * s->width + x] >= SCAN_FOREIGN / 2;
			if (q2 < 0.8 * 0.8) {
				in++;
				marked += mark;
			} else if (ring && q2 > 1.2 * 1.2 && q2 < 1.5 * 1.5) {
				bool ball = false;
				for (int i = 0; i < d->count && !ball; i++)
					ball = vec2_dist(scan_to_full(s, x, y), d->candidate[i].fit.outline.centre) <
					       1.1 * d->candidate[i].fit.outline.radius_px;
				out++;
				foreign += !ball && mark;
			}
		}
	c->cover = in > 0 ? (double)marked / in : 0;
	c->ring = out > 0 ? (double)foreign / out : 0;
}

static void refuse(struct detector *d, const struct sighting *c, enum refusal why)
{
	if (d->refused_count == SEED_MAX)
		return;
	d->refused[d->refused_count] = *c;
	d->refused[d->refused_count++].refusal = why;
}

static double worth(const struct sighting *c)
{
	return c->fit.support * c->cover * sqrt(c->fit.contrast);
}

/* Adds a candidate unless a better one of the same place is there; a worse one gives way. */
static void add(struct detector *d, const struct sighting *c)
{
	double apart = DOUBLE_DISTANCE * 2 * d->table->ball_radius;
	for (int i = 0; i < d->count; i++) {
		if (vec2_dist(d->candidate[i].fit.pos, c->fit.pos) > apart)
			continue;
		if (d->candidate[i].tag >= 0 || worth(&d->candidate[i]) >= worth(c)) {
			refuse(d, c, REFUSED_DOUBLE);
			return;
		}
		refuse(d, &d->candidate[i], REFUSED_DOUBLE);
		d->candidate[i--] = d->candidate[--d->count];
	}
	if (d->count < DETECT_MAX)
		d->candidate[d->count++] = *c;
}

static void look_at(const struct detector *d, struct sighting *c)
{
	scan_cloth_at(&d->scan, c->fit.outline.centre, c->fit.cloth);
	c->look = colour_measure(d->view.frame, &c->fit.outline, c->fit.cloth);
}

/* A ball that is known lies there: no need to find it again. */
static bool is_known(const struct detector *d, vec2 pos)
{
	for (int i = 0; i < d->count; i++)
		if (d->candidate[i].tag >= 0 && vec2_dist(d->candidate[i].fit.pos, pos) < d->table->ball_radius)
			return true;
	return false;
}

static void try_place(struct detector *d, vec2 px, double support)
{
	struct sighting c = {
		.fit = {.scale = USUAL_SCALE, .expected_scale = USUAL_SCALE, .scale_spread = USUAL_SPREAD},
		.cover = 1,
		.tag = -1,
	};
	if (!camera_unproject(d->view.camera, px, d->view.radius, &c.fit.pos) || is_known(d, c.fit.pos))
		return;
	scan_cloth_at(&d->scan, px, c.fit.cloth);
	bool fitted = fit_refine(&d->view, &c.fit, 2);
	if (!fitted || c.fit.support < support)
		refuse(d, &c, REFUSED_FIT);
	else if (!detect_possible(d->table, c.fit.pos))
		refuse(d, &c, REFUSED_PLACE);
	else {
		look_around(d, &c, false);
		look_at(d, &c);
		add(d, &c);
	}
}

/* As they are now: a fit that moves does not move what hides the others. */
static void know_neighbours(struct detector *d)
{
	for (int i = 0; i < d->count; i++)
		d->neighbour[i] = d->candidate[i].fit;
	d->view.other_count = d->count;
}

static bool is_vacant(const struct detector *d, vec2 pos)
{
	for (int i = 0; i < d->count; i++)
		if (vec2_dist(d->candidate[i].fit.pos, pos) < OVERLAP_DISTANCE * 2 * d->table->ball_radius)
			return false;
	return detect_possible(d->table, pos);
}

/* Balls inside a pack show little rim to vote with: one may touch any two that touch each other. */
static void try_packed(struct detector *d)
{
	double diameter = 2 * d->table->ball_radius;
	know_neighbours(d);
	for (int i = 0; i < d->count; i++)
		for (int j = 0; j < i; j++) {
			vec2 a = d->candidate[i].fit.pos, way = vec2_sub(d->candidate[j].fit.pos, a), px;
			if (vec2_norm(way) > PACK_DISTANCE * diameter)
				continue;
			for (int side = -1; side <= 1; side += 2) {
				vec2 pos = vec2_madd(vec2_madd(a, 0.5, way), side * 0.8660254, vec2_perp(way));
				if (is_vacant(d, pos) && camera_project(d->view.camera, pos, d->view.radius, &px) &&
				    cover_at(d, px, 0.8) > PACK_COVER)
					try_place(d, px, SUPPORT_PACKED);
			}
		}
	d->view.other_count = 0;
}

/* Lit or shaded, but cloth all the same: the projector draws circles as large as balls. */
static bool looks_like_cloth(const struct sighting *c)
{
	const struct colour_feature *look = &c->look;
	double mean = (look->v[0] + look->v[1] + look->v[2]) / 3, off = 0;
	for (int i = 0; i < 3; i++)
		off = fmax(off, fabs(look->v[i] - mean));
	/* A whole rim speaks for a pale ball. */
	double bar = c->fit.support > CLOTH_RIM ? CLOTH_OFF_RIM : CLOTH_OFF;
	return off < bar && mean > CLOTH_DARK && mean < CLOTH_LIGHT;
}

static struct region_disc disc_of(const struct sighting *c)
{
	return (struct region_disc){c->fit.outline.centre, PART_REACH * c->fit.outline.radius_px};
}

static int pocket_discs(const struct detector *d, struct region_disc *out)
{
	int count = 0;
	for (int i = 0; i < d->table->pocket_count; i++) {
		const struct pocket *p = &d->table->pocket[i];
		vec2 side;
		if (!camera_project(d->view.camera, p->centre, 0, &out[count].px) ||
		    !camera_project(d->view.camera, (vec2){p->centre.x + PART_REACH * p->radius, p->centre.y}, 0,
				    &side))
			continue;
		out[count].radius = vec2_dist(out[count].px, side);
		count++;
	}
	return count;
}

/* Hands, sleeves and cues have edges that pass for a poor rim: they hang together with more than balls do. */
static bool is_part(struct detector *d, const struct sighting *c)
{
	struct region_disc disc[1 + DETECT_MAX + POCKET_MAX] = {disc_of(c)};
	int count = 1;
	for (int i = 0; i < d->count; i++)
		if (&d->candidate[i] != c && d->candidate[i].fit.support >= PART_SUPPORT)
			disc[count++] = disc_of(&d->candidate[i]);
	count += pocket_discs(d, disc + count);
	double radius = c->fit.outline.radius_px / d->scan.factor, area = 3.14159 * radius * radius;
	int limit = (int)(PART_AREA * area);
	return region_beyond(&d->region, &d->scan, disc, count, limit) >= limit;
}

static enum refusal judge(struct detector *d, const struct sighting *c, double relief)
{
	if (!detect_possible(d->table, c->fit.pos))
		return REFUSED_PLACE;
	if (c->cover < COVER_MIN || looks_like_cloth(c))
		return REFUSED_INSIDE;
	if (c->fit.support < SUPPORT_MIN - relief + SUPPORT_CROWDED * fmax(0, c->ring - RING_FREE))
		return REFUSED_RIM;
	if (c->fit.scale < SCALE_MIN || c->fit.scale > SCALE_MAX)
		return REFUSED_SIZE;
	if (c->tag < 0 && c->fit.support < PART_SUPPORT && is_part(d, c))
		return REFUSED_PART;
	return REFUSED_NOT;
}

static bool is_clear(const struct sighting *c)
{
	return c->fit.rays >= OUTLINE_POINTS * 3 / 4 && c->fit.support > 0.9;
}

/* Median apparent radius of clear balls that look like one; returns how many there are. */
static int scale_of_like(const struct detector *d, int i, const enum ball_colour class[DETECT_MAX], double *median)
{
	double like[DETECT_MAX];
	int n = 0;
	for (int j = 0; j < d->count; j++) {
		const struct sighting *o = &d->candidate[j];
		if (!is_clear(o) || class[j] != class[i] ||
		    colour_difference(&d->candidate[i].look, &o->look) > LIKE_DISTANCE)
			continue;
		int at = n++;
		for (; at > 0 && like[at - 1] > o->fit.scale; at--)
			like[at] = like[at - 1];
		like[at] = o->fit.scale;
	}
	*median = n > 0 ? like[n / 2] : USUAL_SCALE;
	return n;
}

/* Balls that look the same have the same apparent radius: whole rims tell it to those that are half hidden. */
static void expect_scales(struct detector *d)
{
	enum ball_colour class[DETECT_MAX];
	for (int i = 0; i < d->count; i++)
		class[i] = d->colours ? colour_likeliest(d->colours, &d->candidate[i].look) : COLOUR_UNKNOWN;
	for (int i = 0; i < d->count; i++) {
		struct fit *fit = &d->candidate[i].fit;
		double median;
		int like = scale_of_like(d, i, class, &median);
		bool known = class[i] != COLOUR_UNKNOWN;
		fit->expected_scale = like > 1 ? median : known ? d->colours->scale[class[i]] : USUAL_SCALE;
		fit->scale_spread = like > 1 ? LIKE_SPREAD : known ? d->colours->scale_spread[class[i]] : USUAL_SPREAD;
	}
}

static void find_alone(struct detector *d)
{
	for (int i = 0; i < d->count; i++) {
		bool alone = true;
		for (int j = 0; j < d->count && alone; j++)
			alone = j == i || vec2_dist(d->candidate[i].fit.pos, d->candidate[j].fit.pos) >
						  3.2 * d->table->ball_radius;
		d->candidate[i].alone = alone;
	}
}

/* Fits all again, each knowing its neighbours. Those without any need it only once. */
static void fit_together(struct detector *d)
{
	know_neighbours(d);
	for (int i = 0; i < d->count; i++) {
		struct sighting *c = &d->candidate[i];
		c->judged = c->judged && c->alone;
		if (!c->fixed && !c->judged && !fit_refine(&d->view, &c->fit, c->alone ? 1 : 2))
			c->refusal = REFUSED_FIT;
	}
	d->view.other_count = 0;
}

static void drop_refused(struct detector *d)
{
	int kept = 0;
	for (int i = 0; i < d->count; i++) {
		if (d->candidate[i].refusal == REFUSED_NOT)
			d->candidate[kept++] = d->candidate[i];
		else
			refuse(d, &d->candidate[i], d->candidate[i].refusal);
	}
	d->count = kept;
}

/* Two balls cannot be in one place: of two fits that overlap the worse one goes. */
static void refuse_overlaps(struct detector *d)
{
	double apart = OVERLAP_DISTANCE * 2 * d->table->ball_radius;
	for (int i = 0; i < d->count; i++)
		for (int j = 0; j < i; j++) {
			struct sighting *a = &d->candidate[i], *b = &d->candidate[j];
			if (a->refusal != REFUSED_NOT || b->refusal != REFUSED_NOT ||
			    vec2_dist(a->fit.pos, b->fit.pos) > apart)
				continue;
			bool drop_a = a->fixed != b->fixed ? b->fixed : worth(a) < worth(b);
			(drop_a ? a : b)->refusal = REFUSED_DOUBLE;
		}
}

static const double FIXED_FIRMNESS = 1e6; /* others give way to what has not moved */

/* How firmly a fit stands: edges that hold it. */
static double firmness(const struct sighting *c)
{
	return c->fixed ? FIXED_FIRMNESS : c->fit.rays * c->fit.support * fmin(1, c->fit.contrast / 60) + 1;
}

/* Balls are solid: where fits overlap, the one that few edges hold gives way more. */
static void push_apart(struct detector *d, int sweeps)
{
	double diameter = 2 * d->table->ball_radius;
	for (int s = 0; s < sweeps; s++)
		for (int i = 0; i < d->count; i++)
			for (int j = 0; j < i; j++) {
				struct sighting *a = &d->candidate[i], *b = &d->candidate[j];
				vec2 way = vec2_sub(b->fit.pos, a->fit.pos);
				double gap = vec2_norm(way) - diameter;
				if (gap >= 0)
					continue;
				double fa = firmness(a), fb = firmness(b);
				vec2 unit = vec2_unit(way);
				a->fit.pos = vec2_madd(a->fit.pos, gap * fb / (fa + fb), unit);
				b->fit.pos = vec2_madd(b->fit.pos, -gap * fa / (fa + fb), unit);
			}
}

/* relief: how much less rim than usual is enough. */
static void judge_all(struct detector *d, double relief)
{
	for (int i = 0; i < d->count; i++) {
		struct sighting *c = &d->candidate[i];
		if (c->fixed || c->judged)
			continue;
		look_around(d, c, true);
		look_at(d, c);
		c->refusal = judge(d, c, c->alone ? 0 : relief);
		c->confidence = c->fit.support * c->cover;
		c->judged = c->alone;
	}
	drop_refused(d);
}

/* Outlines where the balls were pushed to. */
static void draw_outlines(struct detector *d)
{
	for (int i = 0; i < d->count; i++) {
		struct fit *fit = &d->candidate[i].fit;
		if (!d->candidate[i].fixed)
			outline_of_ball(d->view.camera, fit->pos, d->view.radius, fit->scale, &fit->outline);
	}
}

/* Rounds of fitting, since every ball's hidden rim depends on its neighbours; then judgement. */
static void settle(struct detector *d)
{
	static const char *const round_name[ROUNDS] = {"round-1", "round-2", "round-3"};
	bool all_fixed = true;
	for (int i = 0; i < d->count; i++)
		all_fixed = all_fixed && d->candidate[i].fixed;
	if (all_fixed)
		return;
	for (int round = 0; round < ROUNDS; round++) {
		if (round > 0)
			push_apart(d, 4);
		expect_scales(d);
		find_alone(d);
		fit_together(d);
		refuse_overlaps(d);
		drop_refused(d);
		/* What is no ball must neither hide nor push one; in the first round rims are still badly known. */
		judge_all(d, round == 0 ? SUPPORT_ROUGH : 0);
		stage_fits(d->watch, round_name[round], d);
		if (round + 1 < ROUNDS)
			try_packed(d);
	}
	push_apart(d, 20);
	draw_outlines(d);
}

void detector_begin(struct detector *d, const struct image *frame, const struct camera *camera)
{
	d->count = d->refused_count = 0;
	d->view = (struct fit_view){
		.frame = frame, .camera = camera, .radius = d->table->ball_radius, .other = d->neighbour};
}

void detector_keep(struct detector *d, const struct sighting *known, int tag)
{
	if (d->count == DETECT_MAX)
		return;
	d->candidate[d->count] = *known;
	d->candidate[d->count].fixed = true;
	d->candidate[d->count].refusal = REFUSED_NOT;
	d->candidate[d->count++].tag = tag;
}

bool detector_follow(struct detector *d, const struct sighting *known, vec2 pos, int tag)
{
	struct sighting c = *known;
	c.fixed = c.judged = false;
	c.refusal = REFUSED_NOT;
	c.tag = tag;
	c.fit.pos = pos;
	know_neighbours(d);
	bool fitted = d->count < DETECT_MAX && fit_refine(&d->view, &c.fit, 2);
	d->view.other_count = 0;
	if (!fitted || c.fit.support < SUPPORT_SEED || !detect_possible(d->table, c.fit.pos) ||
	    !is_vacant(d, c.fit.pos))
		return false;
	look_around(d, &c, false);
	if (c.cover < COVER_MIN)
		return false;
	d->candidate[d->count++] = c;
	return true;
}

void detector_search(struct detector *d, const uint8_t *active)
{
	seeds_find(&d->seeds, &d->scan, active);
	stage_seeds(d->watch, d->view.frame, &d->scan, &d->seeds);
	d->view.coarse = true;
	for (int i = 0; i < d->seeds.count; i++)
		try_place(d, d->seeds.seed[i].px, SUPPORT_SEED);
	stage_fits(d->watch, "fits", d);
	d->view.coarse = false;
}

void detector_settle(struct detector *d)
{
	settle(d);
	stage_fits(d->watch, "balls", d);
	d->view = (struct fit_view){0};
}

double detector_cover(const struct detector *d, vec2 px)
{
	return cover_at(d, px, 0.8);
}

static void find_all(struct detector *d, const struct image *frame, const struct camera *camera)
{
	stage_scan(d->watch, frame, &d->scan);
	detector_begin(d, frame, camera);
	detector_search(d, d->scan.changed);
	detector_settle(d);
}

bool detector_frame(struct detector *d, const struct image *frame, const struct camera *camera)
{
	d->count = d->refused_count = 0;
	if (!scan_frame(&d->scan, frame))
		return false;
	find_all(d, frame, camera);
	return true;
}

bool detector_look(struct detector *d, const struct image *frame, const struct camera *camera)
{
	d->count = d->refused_count = 0;
	if (!scan_again(&d->scan))
		return false;
	find_all(d, frame, camera);
	return true;
}
