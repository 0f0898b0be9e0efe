#include "app/control/layout.h"

#include <math.h>

enum { SETTLE_ROUNDS = 200 };

static const double NEAREST_MAX = 0.025; /* m, less than half the distance of touching balls */
static const double RESIDUAL = 1e-9;	 /* m of overlap that is left */

int layout_find(const struct layout *layout, const struct ball *ball, int track)
{
	int nearest = -1;
	double best = NEAREST_MAX;
	for (int i = 0; i < layout->count; i++) {
		double d = vec2_dist(layout->ball[i].pos, ball->pos);
		if (track > 0 && layout->track[i] == track)
			return i;
		if (track <= 0 && layout->ball[i].colour == ball->colour && d < best) {
			best = d;
			nearest = i;
		}
	}
	return nearest;
}

int layout_second_of_colour(const struct layout *layout)
{
	int count[COLOUR_COUNT] = {0};
	for (int i = 0; i < layout->count; i++) {
		enum ball_colour colour = layout->ball[i].colour;
		if (++count[colour] > 1 && colour != COLOUR_RED)
			return i;
	}
	return -1;
}

bool layout_differs(const struct layout *a, const struct layout *b, double distance)
{
	if (a->count != b->count)
		return true;
	/* Identities may have been given anew: match by place and colour. */
	bool used[BALL_MAX] = {false};
	for (int i = 0; i < a->count; i++) {
		int match = -1;
		for (int j = 0; j < b->count && match < 0; j++)
			if (!used[j] && a->ball[i].colour == b->ball[j].colour &&
			    vec2_dist(a->ball[i].pos, b->ball[j].pos) <= distance)
				match = j;
		if (match < 0)
			return true;
		used[match] = true;
	}
	return false;
}

/* ---- settling --------------------------------------------------------------------------------------------------------- */

static bool overlaps_more(const struct layout *layout, double distance, int *culprit)
{
	for (int i = 0; i < layout->count; i++)
		for (int j = i + 1; j < layout->count; j++)
			if (vec2_dist(layout->ball[i].pos, layout->ball[j].pos) < distance) {
				*culprit = i;
				return true;
			}
	return false;
}

/* One round of pushing overlapping pairs apart by equal shares; the largest overlap met. */
static double push_apart(struct layout *layout, double distance)
{
	double worst = 0;
	for (int i = 0; i < layout->count; i++) {
		for (int j = i + 1; j < layout->count; j++) {
			vec2 d = vec2_sub(layout->ball[j].pos, layout->ball[i].pos);
			double gap = vec2_norm(d), overlap = distance - gap;
			if (overlap <= 0)
				continue;
			worst = fmax(worst, overlap);
			vec2 u = gap > 0 ? vec2_scale(d, 1 / gap) : (vec2){1, 0};
			layout->ball[i].pos = vec2_madd(layout->ball[i].pos, -overlap / 2, u);
			layout->ball[j].pos = vec2_madd(layout->ball[j].pos, overlap / 2, u);
		}
	}
	return worst;
}

/* Out of a nose that reaches into the ball, by at most reach: a ball that is deeper in is behind another part of the table. The way. */
static double push_off_cushion(vec2 *pos, const struct cushion *c, double radius, double reach)
{
	vec2 from = vec2_sub(*pos, c->a);
	double along = vec2_dot(from, c->along), before = vec2_dot(from, c->normal);
	vec2 normal = c->two_sided && before < 0 ? vec2_scale(c->normal, -1) : c->normal;
	double depth = radius - (c->two_sided ? fabs(before) : before);
	if (along < 0 || along > c->span || depth <= 0 || depth > radius + reach)
		return 0;
	*pos = vec2_madd(*pos, depth, normal);
	return depth;
}

static double push_off_jaw(vec2 *pos, const struct jaw *jaw, double radius)
{
	vec2 from = vec2_sub(*pos, jaw->centre);
	double gap = vec2_norm(from), depth = jaw->radius + radius - gap;
	if (depth <= 0 || gap <= 0)
		return 0;
	*pos = vec2_madd(*pos, depth / gap, from);
	return depth;
}

/* A ball in a pocket's circle would have fallen: seen there, it hangs on the edge. */
static double pull_to_edge(vec2 *pos, const struct pocket *pocket)
{
	vec2 from = vec2_sub(*pos, pocket->centre);
	double gap = vec2_norm(from), depth = pocket->radius + RESIDUAL - gap;
	if (depth <= 0 || gap <= 0)
		return 0;
	*pos = vec2_madd(*pos, depth / gap, from);
	return depth;
}

/* In front of all that is solid, and out of the pockets; the farthest way. */
static double keep_on_table(struct layout *layout, const struct table *table, const struct layout_limits *limits)
{
	double worst = 0, radius = table->ball_radius;
	for (int i = 0; i < layout->count; i++) {
		vec2 *pos = &layout->ball[i].pos;
		for (int k = 0; k < table->cushion_count; k++)
			if (limits->jaws || table->cushion[k].main_rail)
				worst = fmax(worst, push_off_cushion(pos, &table->cushion[k], radius, limits->shift));
		for (int k = 0; k < table->jaw_count; k++)
			if (limits->jaws || table->jaw[k].radius > 0)
				worst = fmax(worst, push_off_jaw(pos, &table->jaw[k], radius));
		for (int k = 0; k < table->pocket_count; k++)
			worst = fmax(worst, pull_to_edge(pos, &table->pocket[k]));
	}
	return worst;
}

bool layout_settle(struct layout *layout, const struct table *table, const struct layout_limits *limits, int *culprit)
{
	struct layout before = *layout;
	double worst = INFINITY, radius = table->ball_radius;
	char reason[96];
	*culprit = 0;
	if (overlaps_more(layout, 2 * radius - limits->overlap, culprit))
		return false;
	for (int round = 0; round < SETTLE_ROUNDS && worst > RESIDUAL; round++) {
		/* A hair more than touching, so that the rounds end. */
		worst = push_apart(layout, 2 * radius + RESIDUAL);
		worst = fmax(worst, keep_on_table(layout, table, limits));
	}
	for (int i = 0; i < layout->count; i++) {
		*culprit = i;
		if (!(vec2_dist(before.ball[i].pos, layout->ball[i].pos) <= limits->shift))
			return false;
	}
	*culprit = 0;
	int second;
	return worst <= RESIDUAL &&
	       table_check_balls(table, layout->ball, layout->count, culprit, &second, reason, sizeof reason) == 0;
}
