#include "physics/detect.h"

#include "physics/motion.h"
#include "physics/roots.h"

/* Two velocities or accelerations whose difference is below this share of their sizes are equal up to rounding. */
static const double ROUNDING = 4e-16;
/* Balls closer than this share of their squared distance touch: rounding of the positions and of a contact's time. */
static const double TOUCH = 1e-12;
/* Boxes around paths are widened by this: far above rounding. */
static const double BOX_SLACK = 1e-9; /* m */

struct motion detect_motion(const struct table *table, const struct ball *ball, double now)
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
	return m;
}

/* Entry of the point p + v t + a t^2 / 2 into a disc about the origin, within horizon. */
static double curved_entry(vec2 p, vec2 v, vec2 a, double gap, double horizon)
{
	const double c[5] = {gap, 2 * vec2_dot(p, v), vec2_norm2(v) + vec2_dot(p, a), vec2_dot(v, a),
			     0.25 * vec2_norm2(a)};
	return roots_quartic_entry(c, horizon);
}

/* The same where a is parallel to v, v not zero: a chord of the circle first, then the time along the line.
 * gap = p.p - distance^2 > 0. A sliding ball that turns back within the horizon is a general case: -1. */
static double straight_entry(vec2 p, vec2 v, vec2 a, double gap, double distance2, double horizon)
{
	double v2 = vec2_norm2(v), pv = vec2_dot(p, v), va = vec2_dot(v, a);
	if (va < 0 && v2 + va * horizon < -ROUNDING * v2)
		return -1;
	if (pv >= 0)
		return INFINITY;
	double cross = vec2_cross(p, v);
	double half2 = distance2 * v2 - cross * cross;
	if (half2 < 0)
		return INFINITY;
	/* in units of v: the first crossing at k, by the root without cancellation */
	double k = gap / (-pv + sqrt(half2));
	double disc = 1 + 2 * va / v2 * k;
	if (disc < 0)
		return INFINITY;
	double t = 2 * k / (1 + sqrt(disc));
	return t <= horizon ? t : INFINITY;
}

/* Where the approach at a touching start is rounding only, the acceleration decides. */
static bool settle_touch(vec2 p, vec2 *v, double speeds, double *gap, double distance2)
{
	if (*gap > TOUCH * distance2)
		return false;
	double pv = vec2_dot(p, *v);
	if (fabs(pv) > 16 * ROUNDING * speeds * sqrt(distance2))
		return false;
	*v = vec2_madd(*v, -pv / vec2_norm2(p), p);
	*gap = 0;
	return true;
}

static double touching_entry(vec2 p, vec2 v, vec2 a, double horizon)
{
	double c2 = vec2_norm2(v) + vec2_dot(p, a);
	if (fabs(c2) <= 64 * ROUNDING * (vec2_norm2(v) + vec2_norm(p) * vec2_norm(a)))
		c2 = 0;
	const double c[5] = {0, 0, c2, vec2_dot(v, a), 0.25 * vec2_norm2(a)};
	return roots_quartic_entry(c, horizon);
}

static double disc_entry(vec2 p, vec2 v, vec2 a, double distance, double horizon, double speeds, bool straight,
			 struct solve_count *count)
{
	double distance2 = distance * distance, gap = vec2_norm2(p) - distance2;
	if (settle_touch(p, &v, speeds, &gap, distance2)) {
		count->quadratic++;
		return touching_entry(p, v, a, horizon);
	}
	if (straight && gap > 0) {
		double t = straight_entry(p, v, a, gap, distance2, horizon);
		if (t >= 0) {
			count->quadratic++;
			return t;
		}
	}
	if (a.x == 0 && a.y == 0) {
		count->quadratic++;
		return roots_quadratic_entry(gap, 2 * vec2_dot(p, v), vec2_norm2(v), horizon);
	}
	count->quartic++;
	return curved_entry(p, v, a, gap, horizon);
}

struct place {
	vec2 pos, vel;
};

static inline struct place place_at(const struct ball *ball, const struct motion *m, double now)
{
	double dt = now - m->begin;
	if (dt <= 0 || m->reach == 0)
		return (struct place){ball->pos, ball->vel};
	return (struct place){vec2_madd(vec2_madd(ball->pos, dt, ball->vel), 0.5 * dt * dt, m->acceleration),
			      vec2_madd(ball->vel, dt, m->acceleration)};
}

/* Every coefficient is rounded down, so for t >= 0 the rounded distance is never more than the true one: contacts come
 * early, balls never overlap. False for balls closer than the grid can tell, where only the exact way sees who
 * approaches. */
static bool entry_on_grid(double grid, vec2 p, vec2 v, vec2 a, double gap, double horizon, double *t)
{
	double c[5] = {gap, 2 * vec2_dot(p, v), vec2_norm2(v) + vec2_dot(p, a), vec2_dot(v, a), 0.25 * vec2_norm2(a)};
	if (gap < grid)
		return false;
	for (int i = 0; i < 5; i++)
		c[i] = floor(c[i] / grid) * grid;
	*t = roots_quartic_entry(c, horizon);
	return true;
}

double detect_pair(const struct table *table, const struct model *model, const struct ball *a, const struct motion *ma,
		   const struct ball *b, const struct motion *mb, double now, struct solve_count *count)
{
	double distance = 2 * table->ball_radius;
	double reach = distance + ma->reach + mb->reach;
	vec2 between = vec2_sub(b->pos, a->pos);
	if (vec2_norm2(between) > reach * reach || (ma->reach == 0 && mb->reach == 0)) {
		count->culled++;
		return INFINITY;
	}
	double end = ma->reach == 0 ? mb->end : mb->reach == 0 ? ma->end : fmin(ma->end, mb->end);
	struct place pa = place_at(a, ma, now), pb = place_at(b, mb, now);
	bool straight = (ma->reach == 0 && mb->straight) || (mb->reach == 0 && ma->straight);
	vec2 p = vec2_sub(pb.pos, pa.pos), v = vec2_sub(pb.vel, pa.vel);
	vec2 acceleration = vec2_sub(mb->acceleration, ma->acceleration);
	double horizon = fmax(end - now, 0), gap = vec2_norm2(p) - distance * distance, t;
	if (model->contact_grid > 0 && entry_on_grid(model->contact_grid, p, v, acceleration, gap, horizon, &t))
		count->quartic++;
	else
		t = disc_entry(p, v, acceleration, distance, horizon, ma->speed + mb->speed, straight, count);
	return now + t;
}

/* ---- cushions, jaws and pockets ---- */

struct box {
	vec2 low, high;
};

/* Least and greatest of p + v t + a t^2 / 2 on [0, horizon]. */
static void extent(double p, double v, double a, double horizon, double *low, double *high)
{
	double end = p + horizon * (v + 0.5 * a * horizon);
	*low = fmin(p, end);
	*high = fmax(p, end);
	if (a != 0 && -v / a > 0 && -v / a < horizon) {
		double turn = p - 0.5 * v * v / a;
		*low = fmin(*low, turn);
		*high = fmax(*high, turn);
	}
}

struct path {
	const struct table *table;
	const struct model *model;
	vec2 p, v, a;
	double speed;
	bool straight;
	struct solve_count *count;
	struct box box; /* around the path up to the horizon or a later time */
	double horizon; /* s, to the best event so far */
	double excess;	/* m, by which the best event's contact point lies beyond its cushion */
	struct event best;
	double begin;
};

static void find_box(struct path *path)
{
	extent(path->p.x, path->v.x, path->a.x, path->horizon, &path->box.low.x, &path->box.high.x);
	extent(path->p.y, path->v.y, path->a.y, path->horizon, &path->box.low.y, &path->box.high.y);
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

vec2 detect_cushion_normal(const struct cushion *cushion, vec2 pos)
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
	double depth_max = path->table->ball_radius;
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
	const struct cushion *c = &path->table->cushion[index];
	vec2 n = detect_cushion_normal(c, path->p);
	double radius = path->table->ball_radius;
	if (box_beyond_line(&path->box, c->a, n, radius + BOX_SLACK)) {
		path->count->culled++;
		return;
	}
	double d[3] = {vec2_dot(n, vec2_sub(path->p, c->a)) - radius, vec2_dot(n, path->v), 0.5 * vec2_dot(n, path->a)};
	if (d[0] > 0 && d[1] >= 0 && d[2] >= 0)
		return;
	if (fabs(d[1]) <= ROUNDING * path->speed)
		d[1] = 0;
	if (fabs(d[2]) <= ROUNDING * vec2_norm(path->a))
		d[2] = 0;
	bool unbounded = path->model->pocket == POCKET_MODEL_NONE;
	bool behind = !unbounded && d[0] < -radius;
	if (behind && d[2] >= 0) /* only a bent way leads out from behind the line and in again */
		return;
	if (d[2] == 0)
		path->count->linear++;
	else
		path->count->quadratic++;
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
		path->count->culled++;
		return INFINITY;
	}
	return disc_entry(vec2_sub(path->p, centre), path->v, path->a, distance, path->horizon, path->speed,
			  path->straight, path->count);
}

static void try_pocket(struct path *path, int index)
{
	const struct pocket *pocket = &path->table->pocket[index];
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
		const struct jaw *jaw = &path->table->jaw[i];
		if (jaw->radius == 0 && path->model->pocket != POCKET_MODEL_JAWS)
			continue;
		double t = try_disc(path, jaw->centre, jaw->radius + path->table->ball_radius);
		if (t < INFINITY)
			offer(path, t, EVENT_JAW, i, 0);
	}
}

static bool boxes_meet(const struct box *a, const struct table_region *b)
{
	return a->low.x <= b->high.x && a->high.x >= b->low.x && a->low.y <= b->high.y && a->high.y >= b->low.y;
}

struct event detect_own(const struct table *table, const struct model *model, const struct ball *ball, int index,
			const struct motion *motion, struct solve_count *count)
{
	struct path path = {
		.table = table,
		.model = model,
		.p = ball->pos,
		.v = ball->vel,
		.a = motion->acceleration,
		.speed = motion->speed,
		.straight = motion->straight,
		.count = count,
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
	if (model->pocket == POCKET_MODEL_NONE)
		return path.best;
	if (path.best.kind == EVENT_CUSHION)
		find_box(&path); /* up to the rail only */
	for (int i = 0; i < table->region_count; i++) {
		if (boxes_meet(&path.box, &table->region[i]))
			try_region(&path, &table->region[i]);
	}
	return path.best;
}
