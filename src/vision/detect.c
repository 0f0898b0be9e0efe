#include "vision/detect.h"

#include <math.h>
#include <string.h>

static const double EDGE_SLACK = 0.007;		/* m a fitted centre may lie beyond where cushions let it be */
static const double MOUTH_INNER = 0.8;		/* of a pocket's radius: nearer to its centre a ball has fallen */
static const double SUPPORT_SEED = 0.4, SUPPORT_MIN = 0.62;
static const double COVER_MIN = 0.55;
static const double SCALE_MIN = 0.885, SCALE_MAX = 1.085;
static const double DOUBLE_DISTANCE = 0.75;	/* of a diameter: nearer than that two fits are of one ball */

int detector_init(struct detector *d, const struct table *table, int width, int height)
{
	*d = (struct detector){.table = table};
	int rc = scan_init(&d->scan, width, height);
	if (rc == 0)
		rc = seeds_init(&d->seeds, width, height);
	if (rc < 0)
		detector_finish(d);
	return rc;
}

void detector_finish(struct detector *d)
{
	scan_finish(&d->scan);
	seeds_finish(&d->seeds);
}

bool detector_place(struct detector *d, const struct camera *camera)
{
	return scan_place(&d->scan, camera, d->table) && seeds_place(&d->seeds, &d->scan, camera, d->table);
}

bool detect_possible(const struct table *table, vec2 pos)
{
	double hx = table->length / 2 - table->ball_radius + EDGE_SLACK, hy = table->width / 2 - table->ball_radius + EDGE_SLACK;
	bool inside = fabs(pos.x) <= hx && fabs(pos.y) <= hy;
	for (int i = 0; i < table->pocket_count; i++) {
		double far = vec2_dist(pos, table->pocket[i].centre) / table->pocket[i].radius;
		if (far < MOUTH_INNER)
			return false;
		inside = inside || far < 1.6;
	}
	return inside;
}

/* Shares of marked small pixels inside of 0.8 outlines, and between 1.2 and 1.5 of them where no other ball is. */
static void look_around(struct detector *d, struct candidate *c, bool ring)
{
	const struct scan *s = &d->scan;
	vec2 mid = scan_from_full(s, c->fit.outline.centre);
	double r = c->fit.outline.radius_px / s->factor;
	int reach = (int)(1.5 * r) + 1, in = 0, marked = 0, out = 0, foreign = 0;
	for (int y = (int)mid.y - reach; y <= (int)mid.y + reach; y++)
		for (int x = (int)mid.x - reach; x <= (int)mid.x + reach; x++) {
			if (x < 0 || y < 0 || x >= s->width || y >= s->height)
				continue;
			double q = hypot(x - mid.x, y - mid.y) / r;
			int mark = s->mark[y * s->width + x] >= SCAN_FOREIGN / 2;
			if (q < 0.8) {
				in++;
				marked += mark;
			} else if (ring && q > 1.2 && q < 1.5) {
				bool ball = false;
				for (int i = 0; i < d->count && !ball; i++)
					ball = vec2_dist(scan_to_full(s, x, y), d->candidate[i].fit.outline.centre) <
					       1.1 * d->candidate[i].fit.outline.radius_px;
				out += !ball;
				foreign += !ball && mark;
			}
		}
	c->cover = in > 0 ? (double)marked / in : 0;
	c->ring = out > 0 ? (double)foreign / out : 0;
}

static void refuse(struct detector *d, const struct candidate *c, enum refusal why)
{
	if (d->refused_count == SEED_MAX)
		return;
	d->refused[d->refused_count] = *c;
	d->refused[d->refused_count++].refusal = why;
}

static double worth(const struct candidate *c)
{
	return c->fit.support * c->cover * sqrt(c->fit.contrast);
}

/* Adds a candidate unless a better one of the same place is there; a worse one gives way. */
static void add(struct detector *d, const struct candidate *c)
{
	double apart = DOUBLE_DISTANCE * 2 * d->table->ball_radius;
	for (int i = 0; i < d->count; i++) {
		if (vec2_dist(d->candidate[i].fit.pos, c->fit.pos) > apart)
			continue;
		if (worth(&d->candidate[i]) >= worth(c)) {
			refuse(d, c, REFUSED_DOUBLE);
			return;
		}
		refuse(d, &d->candidate[i], REFUSED_DOUBLE);
		d->candidate[i--] = d->candidate[--d->count];
	}
	if (d->count < DETECT_MAX)
		d->candidate[d->count++] = *c;
}

static void try_seed(struct detector *d, const struct fit_view *view, const struct seed *seed)
{
	struct candidate c = {.fit = {.scale = 1}, .cover = seed->cover};
	if (!camera_unproject(view->camera, seed->px, view->radius, &c.fit.pos))
		return;
	bool fitted = fit_refine(view, &c.fit, 2);
	if (!fitted || c.fit.support < SUPPORT_SEED)
		refuse(d, &c, REFUSED_FIT);
	else if (!detect_possible(d->table, c.fit.pos))
		refuse(d, &c, REFUSED_PLACE);
	else
		add(d, &c);
}

static enum refusal judge(const struct detector *d, const struct candidate *c)
{
	if (!detect_possible(d->table, c->fit.pos))
		return REFUSED_PLACE;
	if (c->cover < COVER_MIN)
		return REFUSED_INSIDE;
	if (c->fit.support < SUPPORT_MIN)
		return REFUSED_RIM;
	if (c->fit.scale < SCALE_MIN || c->fit.scale > SCALE_MAX)
		return REFUSED_SIZE;
	return REFUSED_NOT;
}

/* Fits each again knowing its neighbours, then judges. */
static void settle(struct detector *d, struct fit_view *view)
{
	struct fit other[DETECT_MAX];
	for (int i = 0; i < d->count; i++)
		other[i] = d->candidate[i].fit;
	view->other = other;
	view->other_count = d->count;
	for (int i = 0; i < d->count; i++) {
		struct candidate *c = &d->candidate[i];
		bool fitted = fit_refine(view, &c->fit, 3);
		look_around(d, c, true);
		c->refusal = fitted ? judge(d, c) : REFUSED_FIT;
		c->confidence = c->fit.support * c->cover;
	}
	int kept = 0;
	for (int i = 0; i < d->count; i++) {
		if (d->candidate[i].refusal == REFUSED_NOT)
			d->candidate[kept++] = d->candidate[i];
		else
			refuse(d, &d->candidate[i], d->candidate[i].refusal);
	}
	d->count = kept;
}

bool detector_frame(struct detector *d, const struct image *frame, const struct camera *camera)
{
	d->count = d->refused_count = 0;
	if (!scan_frame(&d->scan, frame))
		return false;
	seeds_find(&d->seeds, &d->scan, 0, 0, d->scan.width, d->scan.height);
	struct fit_view view = {frame, camera, d->table->ball_radius, NULL, 0};
	for (int i = 0; i < d->seeds.count; i++)
		try_seed(d, &view, &d->seeds.seed[i]);
	settle(d, &view);
	return true;
}
