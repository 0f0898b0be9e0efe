#include "physics/predict.h"

#include "physics/motion.h"
#include "physics/roots.h"
#include "physics/tolerances.h"

struct motion predict_motion(const struct table *table, const struct ball *ball, double now)
{
	struct motion m = {.begin = now, .straight = true};
	double duration = motion_phase_end(ball, table, &m.end_kind);
	m.end = now + duration;
	if (ball->phase != BALL_ROLLING && ball->phase != BALL_SLIDING)
		return m;
	m.acceleration = motion_acceleration(ball, table);
	m.speed = vec2_norm(ball->vel);
	if (ball->phase == BALL_SLIDING) {
		double a = table->material.mu_slide * table->material.gravity;
		m.reach = m.speed * duration + 0.5 * a * duration * duration;
		m.straight = m.speed > 0 && fabs(vec2_cross(ball->vel, m.acceleration)) <= ROUNDING * m.speed * a;
	} else {
		m.reach = 0.5 * m.speed * duration;
	}
	if (table->bed.uneven) {
		m.reach = m.speed * duration + 0.5 * vec2_norm(m.acceleration) * duration * duration;
		m.straight = false;
	}
	return m;
}

/* The point p + v t + a t^2 / 2 and a disc about the origin. */
struct approach {
	vec2 p, v, a;	 /* m, m/s, m/s^2 */
	double distance; /* m, radius of the disc */
	double gap;	 /* m^2, p.p - distance^2 */
	double speeds;	 /* m/s, of the two bodies: what v is rounded by */
	bool straight;	 /* a is parallel to v */
};

/* The squared distance from the disc as a polynomial of time. */
static void distance_polynomial(const struct approach *d, double c[5])
{
	c[0] = d->gap;
	c[1] = 2 * vec2_dot(d->p, d->v);
	c[2] = vec2_norm2(d->v) + vec2_dot(d->p, d->a);
	c[3] = vec2_dot(d->v, d->a);
	c[4] = 0.25 * vec2_norm2(d->a);
}

/* Entry where a is parallel to v, v not zero, gap > 0: a chord of the circle first, then the time along the line. A
 * sliding ball that turns back within the horizon is a general case: -1. */
static double straight_entry(const struct approach *d, double horizon)
{
	double v2 = vec2_norm2(d->v), pv = vec2_dot(d->p, d->v), va = vec2_dot(d->v, d->a);
	if (va < 0 && v2 + va * horizon < -ROUNDING * v2)
		return -1;
	if (pv >= 0)
		return INFINITY;
	double cross = vec2_cross(d->p, d->v);
	double half2 = d->distance * d->distance * v2 - cross * cross;
	if (half2 < 0)
		return INFINITY;
	/* in units of v: the first crossing at k, by the root without cancellation */
	double k = d->gap / (-pv + sqrt(half2));
	double disc = 1 + 2 * va / v2 * k;
	if (disc < 0)
		return INFINITY;
	double t = 2 * k / (1 + sqrt(disc));
	return t <= horizon ? t : INFINITY;
}

/* Where the approach at a touching start is rounding only, the acceleration decides. */
static bool settle_touch(struct approach *d)
{
	if (d->gap > TOUCH * (d->distance * d->distance))
		return false;
	double pv = vec2_dot(d->p, d->v);
	if (fabs(pv) > 16 * ROUNDING * d->speeds * d->distance)
		return false;
	d->v = vec2_madd(d->v, -pv / vec2_norm2(d->p), d->p);
	d->gap = 0;
	return true;
}

static double touching_entry(const struct approach *d, double horizon)
{
	double c2 = vec2_norm2(d->v) + vec2_dot(d->p, d->a);
	if (fabs(c2) <= 64 * ROUNDING * (vec2_norm2(d->v) + vec2_norm(d->p) * vec2_norm(d->a)))
		c2 = 0;
	const double c[5] = {0, 0, c2, vec2_dot(d->v, d->a), 0.25 * vec2_norm2(d->a)};
	return roots_quartic_entry(c, horizon);
}

/* Entry of the point into the disc, within horizon. */
static double disc_entry(struct approach d, double horizon, struct solve_count *count)
{
	if (settle_touch(&d)) {
		count->quadratic++;
		return touching_entry(&d, horizon);
	}
	if (d.straight && d.gap > 0) {
		double t = straight_entry(&d, horizon);
		if (t >= 0) {
			count->quadratic++;
			return t;
		}
	}
	if (d.a.x == 0 && d.a.y == 0) {
		count->quadratic++;
		return roots_quadratic_entry(d.gap, 2 * vec2_dot(d.p, d.v), vec2_norm2(d.v), horizon);
	}
	double c[5];
	distance_polynomial(&d, c);
	count->quartic++;
	return roots_quartic_entry(c, horizon);
}

struct motion_place {
	vec2 pos, vel;
};

static inline struct motion_place place_at(const struct mover *mover, double now)
{
	const struct ball *ball = mover->ball;
	const struct motion *m = mover->motion;
	double dt = now - m->begin;
	if (dt <= 0 || m->reach == 0)
		return (struct motion_place){ball->pos, ball->vel};
	return (struct motion_place){vec2_madd(vec2_madd(ball->pos, dt, ball->vel), 0.5 * dt * dt, m->acceleration),
				     vec2_madd(ball->vel, dt, m->acceleration)};
}

/* Every coefficient is rounded down, so for t >= 0 the rounded distance is never more than the true one: contacts come
 * early, balls never overlap. False for balls closer than the grid can tell, where only the exact way sees who
 * approaches. */
static bool entry_on_grid(const struct approach *d, double grid, double horizon, double *t)
{
	double c[5];
	if (d->gap < grid)
		return false;
	distance_polynomial(d, c);
	for (int i = 0; i < 5; i++)
		c[i] = floor(c[i] / grid) * grid;
	*t = roots_quartic_entry(c, horizon);
	return true;
}

double predict_pair(const struct predictor *by, const struct mover *a, const struct mover *b, double now)
{
	const struct motion *ma = a->motion, *mb = b->motion;
	double distance = 2 * by->table->ball_radius;
	double reach = distance + ma->reach + mb->reach;
	vec2 between = vec2_sub(b->ball->pos, a->ball->pos);
	if (vec2_norm2(between) > reach * reach || (ma->reach == 0 && mb->reach == 0)) {
		by->count->culled++;
		return INFINITY;
	}
	double end = ma->reach == 0 ? mb->end : mb->reach == 0 ? ma->end : fmin(ma->end, mb->end);
	struct motion_place pa = place_at(a, now), pb = place_at(b, now);
	struct approach d = {.p = vec2_sub(pb.pos, pa.pos),
			     .v = vec2_sub(pb.vel, pa.vel),
			     .a = vec2_sub(mb->acceleration, ma->acceleration),
			     .distance = distance,
			     .speeds = ma->speed + mb->speed,
			     .straight = (ma->reach == 0 && mb->straight) || (mb->reach == 0 && ma->straight)};
	d.gap = vec2_norm2(d.p) - distance * distance;
	double horizon = fmax(end - now, 0), grid = by->model->contact_grid, t;
	if (grid > 0 && entry_on_grid(&d, grid, horizon, &t))
		by->count->quartic++;
	else
		t = disc_entry(d, horizon, by->count);
	return now + t;
}

/* ---- cushions, jaws and pockets ---- */

struct box {
	vec2 low, high;
};

/* Least and greatest of p + v t + a t^2 / 2 on [0, horizon]. */
struct extent {
	double low, high;
};

static struct extent extent_of(double p, double v, double a, double horizon)
{
	double end = p + horizon * (v + 0.5 * a * horizon);
	struct extent e = {fmin(p, end), fmax(p, end)};
	if (a != 0 && -v / a > 0 && -v / a < horizon) {
		double turn = p - 0.5 * v * v / a;
		e.low = fmin(e.low, turn);
		e.high = fmax(e.high, turn);
	}
	return e;
}

struct path {
	const struct predictor *by;
	vec2 p, v, a;
	double speed;
	bool straight;
	struct box box; /* around the path up to the horizon or a later time */
	double horizon; /* s, to the best event so far */
	double excess;	/* m, by which the best event's contact point lies beyond its cushion */
	struct event best;
	double begin;
};

static void find_box(struct path *path)
{
	struct extent x = extent_of(path->p.x, path->v.x, path->a.x, path->horizon);
	struct extent y = extent_of(path->p.y, path->v.y, path->a.y, path->horizon);
	path->box = (struct box){{x.low, y.low}, {x.high, y.high}};
}

/* True when no point of the box is within distance of the line through point, on the side of normal. */
static bool box_beyond_line(const struct box *box, vec2 point, vec2 normal, double distance)
{
	vec2 nearest = {normal.x > 0 ? box->low.x : box->high.x, normal.y > 0 ? box->low.y : box->high.y};
	return vec2_dot(normal, vec2_sub(nearest, point)) > distance;
}

static bool box_beyond_disc(const struct box *box, vec2 centre, double radius)
{
	return box->low.x > centre.x + radius || box->high.x < centre.x - radius || box->low.y > centre.y + radius ||
	       box->high.y < centre.y - radius;
}

static void offer(struct path *path, double t, enum event_kind kind, int other, double excess)
{
	struct event e = {path->begin + t, kind, path->best.ball, (int16_t)other};
	bool same_rails = e.time == path->best.time && kind == EVENT_CUSHION && path->best.kind == EVENT_CUSHION;
	if (same_rails ? excess < path->excess : event_compare(&e, &path->best) < 0) {
		path->best = e;
		path->horizon = t;
		path->excess = excess;
	}
}

vec2 predict_cushion_normal(const struct cushion *cushion, vec2 pos)
{
	bool behind = vec2_dot(cushion->normal, vec2_sub(pos, cushion->a)) < 0;
	return cushion->two_sided && behind ? vec2_scale(cushion->normal, -1) : cushion->normal;
}

/* How far the foot of the perpendicular lies beyond the cushion's ends at time t; 0 on it. */
static double foot_excess(const struct path *path, const struct cushion *c, double t)
{
	vec2 at = vec2_madd(vec2_madd(path->p, t, path->v), 0.5 * t * t, path->a);
	double foot = vec2_dot(vec2_sub(at, c->a), c->along);
	return foot < 0 ? -foot : foot > c->span ? foot - c->span : 0;
}

/* A ball past the edge line beside the cushion meets it when its foot comes over the end (models without tips). */
static void sunk_entry(struct path *path, const struct cushion *c, int index, const double d[3])
{
	vec2 rel = vec2_sub(path->p, c->a);
	double f0 = vec2_dot(rel, c->along), f1 = vec2_dot(path->v, c->along), f2 = 0.5 * vec2_dot(path->a, c->along);
	double depth_max = path->by->table->ball_radius;
	for (int side = 0; side < 2; side++) {
		double root[2];
		int n_roots = roots_quadratic(f2, f1, f0 - (side ? c->span : 0), root);
		for (int i = 0; i < n_roots; i++) {
			double t = root[i];
			if (!(t >= 0 && t <= path->horizon))
				continue;
			double distance = d[0] + t * (d[1] + t * d[2]);
			bool enters = side ? f1 + 2 * f2 * t < 0 : f1 + 2 * f2 * t > 0;
			if (enters && distance <= 0 && distance > -depth_max && d[1] + 2 * d[2] * t < 0)
				offer(path, t, EVENT_CUSHION, index, 0);
		}
	}
}

/* From beyond the edge line, beside the cushion: out over the line and in again. */
static double later_entry(const double d[3], double horizon)
{
	double root[2];
	int n = roots_quadratic(d[2], d[1], d[0], root);
	return d[2] < 0 && n == 2 && root[1] >= 0 && root[1] <= horizon ? root[1] : INFINITY;
}

static void try_cushion(struct path *path, int index)
{
	const struct cushion *c = &path->by->table->cushion[index];
	vec2 n = predict_cushion_normal(c, path->p);
	double radius = path->by->table->ball_radius;
	if (box_beyond_line(&path->box, c->a, n, radius + BOX_SLACK)) {
		path->by->count->culled++;
		return;
	}
	double d[3] = {vec2_dot(n, vec2_sub(path->p, c->a)) - radius, vec2_dot(n, path->v), 0.5 * vec2_dot(n, path->a)};
	if (d[0] > 0 && d[1] >= 0 && d[2] >= 0)
		return;
	if (fabs(d[1]) <= ROUNDING * path->speed)
		d[1] = 0;
	if (fabs(d[2]) <= ROUNDING * vec2_norm(path->a))
		d[2] = 0;
	bool unbounded = path->by->model->pocket == POCKET_MODEL_NONE;
	bool behind = !unbounded && d[0] < -radius;
	if (behind && d[2] >= 0) /* only a bent way leads out from behind the line and in again */
		return;
	if (d[2] == 0)
		path->by->count->linear++;
	else
		path->by->count->quadratic++;
	bool beside = behind || (d[0] < 0 && !unbounded && foot_excess(path, c, 0) > 0);
	double t = beside ? later_entry(d, path->horizon) : roots_quadratic_entry(d[0], d[1], d[2], path->horizon);
	double excess = t < INFINITY ? foot_excess(path, c, t) : 0;
	if (t < INFINITY && (excess == 0 || unbounded))
		offer(path, t, EVENT_CUSHION, index, excess);
	else if (t < INFINITY || beside)
		sunk_entry(path, c, index, d);
}

static double try_disc(struct path *path, vec2 centre, double distance)
{
	if (box_beyond_disc(&path->box, centre, distance + BOX_SLACK)) {
		path->by->count->culled++;
		return INFINITY;
	}
	struct approach d = {.p = vec2_sub(path->p, centre),
			     .v = path->v,
			     .a = path->a,
			     .distance = distance,
			     .speeds = path->speed,
			     .straight = path->straight};
	d.gap = vec2_norm2(d.p) - distance * distance;
	return disc_entry(d, path->horizon, path->by->count);
}

static void try_pocket(struct path *path, int index)
{
	const struct pocket *pocket = &path->by->table->pocket[index];
	double t = 0;
	if (vec2_norm2(vec2_sub(path->p, pocket->centre)) > pocket->radius * pocket->radius)
		t = try_disc(path, pocket->centre, pocket->radius);
	if (t < INFINITY)
		offer(path, t, EVENT_POCKET, index, 0);
}

static void try_region(struct path *path, const struct table_region *region)
{
	for (uint32_t mask = region->pockets; mask; mask &= mask - 1)
		try_pocket(path, __builtin_ctz(mask));
	for (uint32_t mask = region->cushions; mask; mask &= mask - 1)
		try_cushion(path, __builtin_ctz(mask));
	for (uint32_t mask = region->jaws; mask; mask &= mask - 1) {
		int i = __builtin_ctz(mask);
		const struct jaw *jaw = &path->by->table->jaw[i];
		if (jaw->radius == 0 && path->by->model->pocket != POCKET_MODEL_JAWS)
			continue;
		double t = try_disc(path, jaw->centre, jaw->radius + path->by->table->ball_radius);
		if (t < INFINITY)
			offer(path, t, EVENT_JAW, i, 0);
	}
}

static bool boxes_meet(const struct box *a, const struct table_region *b)
{
	return a->low.x <= b->high.x && a->high.x >= b->low.x && a->low.y <= b->high.y && a->high.y >= b->low.y;
}

struct event predict_own(const struct predictor *by, const struct mover *mover, int index)
{
	const struct table *table = by->table;
	const struct ball *ball = mover->ball;
	const struct motion *motion = mover->motion;
	struct path path = {
		.by = by,
		.p = ball->pos,
		.v = ball->vel,
		.a = motion->acceleration,
		.speed = motion->speed,
		.straight = motion->straight,
		.horizon = motion->end - motion->begin,
		.excess = 0,
		.best = {motion->end, motion->end_kind, (int16_t)index, -1},
		.begin = motion->begin,
	};
	if (ball->phase != BALL_ROLLING && ball->phase != BALL_SLIDING)
		return path.best;
	find_box(&path);
	for (int i = 0; i < table->cushion_count; i++) {
		if (table->cushion[i].main_rail)
			try_cushion(&path, i);
	}
	if (by->model->pocket == POCKET_MODEL_NONE)
		return path.best;
	if (path.best.kind == EVENT_CUSHION)
		find_box(&path); /* up to the rail only */
	for (int i = 0; i < table->region_count; i++) {
		if (boxes_meet(&path.box, &table->region[i]))
			try_region(&path, &table->region[i]);
	}
	return path.best;
}
