#include "search/geometry.h"

#include <assert.h>

/* m: noses closer than this to one line are one mirror. */
static const double SAME_LINE = 1e-6;
/* m: a ball closer than this to a mirror lies on it and cannot be played over it. */
static const double ON_MIRROR = 1e-9;

static double height(const struct mirror *mirror, vec2 p)
{
	return vec2_dot(vec2_sub(p, mirror->point), mirror->normal);
}

static vec2 turn(const struct mirror *mirror, vec2 direction)
{
	return vec2_madd(direction, -2 * vec2_dot(direction, mirror->normal), mirror->normal);
}

static struct mirror *find_mirror(struct mirrors *mirrors, const struct cushion *cushion, vec2 point)
{
	for (int i = 0; i < mirrors->count; i++) {
		struct mirror *m = &mirrors->mirror[i];
		if (vec2_dot(m->normal, cushion->normal) > 1 - 1e-9 && fabs(height(m, point)) < SAME_LINE)
			return m;
	}
	if (mirrors->count == MIRROR_MAX)
		return NULL;
	struct mirror *m = &mirrors->mirror[mirrors->count++];
	*m = (struct mirror){.point = point, .normal = cushion->normal, .along = vec2_perp(cushion->normal)};
	return m;
}

static void add_cushion(struct mirrors *mirrors, const struct cushion *cushion, double radius)
{
	struct mirror *m = find_mirror(mirrors, cushion, vec2_madd(cushion->a, radius, cushion->normal));
	if (!m || m->span_count == MIRROR_SPANS)
		return;
	double a = vec2_dot(cushion->a, m->along), b = vec2_dot(cushion->b, m->along);
	m->span[m->span_count][0] = fmin(a, b);
	m->span[m->span_count][1] = fmax(a, b);
	m->span_count++;
}

/* Appends the sequences that are one cushion longer than those in [begin, end). */
static int grow(struct mirrors *mirrors, int begin, int end)
{
	int count = end;
	for (int parent = begin; parent < end; parent++)
		for (int m = 0; m < mirrors->count; m++) {
			const struct sequence *p = &mirrors->sequence[parent];
			if (p->length > 0 && p->mirror == m)
				continue;
			assert(count < SEQUENCE_MAX);
			mirrors->sequence[count++] =
				(struct sequence){(uint16_t)parent, (uint8_t)m, (uint8_t)(p->length + 1)};
		}
	return count;
}

void mirrors_init(struct mirrors *mirrors, const struct table *table)
{
	*mirrors = (struct mirrors){.count = 0};
	for (int i = 0; i < table->cushion_count; i++)
		if (table->cushion[i].main_rail)
			add_cushion(mirrors, &table->cushion[i], table->ball_radius);
	int begin = 0, end = 1;
	mirrors->sequence_count[0] = 1;
	for (int rails = 1; rails <= PLAN_RAILS_MAX; rails++) {
		int next = grow(mirrors, begin, end);
		begin = end;
		end = next;
		mirrors->sequence_count[rails] = end;
	}
}

void images_init(struct images *images, const struct mirrors *mirrors, vec2 target, vec2 direction, int rails)
{
	assert(rails >= 0 && rails <= PLAN_RAILS_MAX);
	images->count = mirrors->sequence_count[rails];
	images->at[0] = target;
	images->direction[0] = direction;
	images->valid[0] = true;
	for (int i = 1; i < images->count; i++) {
		const struct sequence *s = &mirrors->sequence[i];
		const struct mirror *m = &mirrors->mirror[s->mirror];
		double h = height(m, images->at[s->parent]);
		images->behind[i] = h;
		images->valid[i] = images->valid[s->parent] && h > ON_MIRROR;
		images->at[i] = vec2_madd(images->at[s->parent], -2 * h, m->normal);
		images->direction[i] = turn(m, images->direction[s->parent]);
	}
}

static bool has_nose(const struct mirror *mirror, vec2 p)
{
	double at = vec2_dot(p, mirror->along);
	for (int i = 0; i < mirror->span_count; i++)
		if (at >= mirror->span[i][0] && at <= mirror->span[i][1])
			return true;
	return false;
}

bool way_build(struct way *way, const struct mirrors *mirrors, const struct images *images, int sequence, vec2 start)
{
	int n = 0;
	assert(images->valid[sequence]);
	way->point[0] = start;
	for (int s = sequence; s > 0; s = mirrors->sequence[s].parent) {
		const struct mirror *m = &mirrors->mirror[mirrors->sequence[s].mirror];
		double here = height(m, way->point[n]);
		if (here <= ON_MIRROR)
			return false;
		vec2 d = vec2_sub(images->at[s], way->point[n]);
		vec2 hit = vec2_madd(way->point[n], here / (here + images->behind[s]), d);
		if (!has_nose(m, hit))
			return false;
		way->normal[n] = m->normal;
		way->point[++n] = hit;
	}
	way->point[n + 1] = images->at[0];
	way->rails = n;
	for (int i = 0; i <= n; i++)
		way->leg[i] = vec2_dist(way->point[i], way->point[i + 1]);
	return true;
}

double segment_distance2(vec2 a, vec2 b, vec2 p)
{
	vec2 d = vec2_sub(b, a), q = vec2_sub(p, a);
	double along = vec2_dot(q, d), length2 = vec2_norm2(d);
	if (along <= 0)
		return vec2_norm2(q);
	if (along >= length2)
		return vec2_norm2(vec2_sub(p, b));
	double across = vec2_cross(d, q);
	return across * across / length2;
}

bool segment_is_free(const struct obstacles *obstacles, vec2 a, vec2 b, double distance)
{
	double least = distance * distance;
	for (int i = 0; i < obstacles->count; i++) {
		const struct ball *ball = &obstacles->ball[i];
		if ((obstacles->mask >> i & 1) && ball->phase != BALL_POTTED &&
		    segment_distance2(a, b, ball->pos) < least)
			return false;
	}
	return true;
}

bool cue_has_room(const struct table *table, const struct cost_profile *profile, const struct obstacles *obstacles,
		  vec2 cue, vec2 direction)
{
	vec2 back = vec2_madd(cue, -profile->cue_room, direction);
	return segment_is_free(obstacles, cue, back, profile->cue_clearance + table->ball_radius);
}
