#include "physics/table.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "physics/bed.h"
#include "physics/tolerances.h"

__attribute__((format(printf, 3, 4))) static int refuse(char *err, size_t err_size, const char *format, ...)
{
	if (err && err_size) {
		va_list args;
		va_start(args, format);
		vsnprintf(err, err_size, format, args);
		va_end(args);
	}
	return -EINVAL;
}

static bool in_range(double x, double low, double high)
{
	return x >= low && x <= high; /* false for NaN */
}

static int check_sizes(const struct table *t, char *err, size_t err_size)
{
	if (!in_range(t->length, 0.1, 20) || !in_range(t->width, 0.1, 20))
		return refuse(err, err_size, "table size %g x %g m is not within 0.1 to 20 m", t->length, t->width);
	if (!in_range(t->ball_radius, 0.001, 0.1))
		return refuse(err, err_size, "ball radius %g m is not within 0.001 to 0.1 m", t->ball_radius);
	if (!in_range(t->ball_mass, 0.001, 10))
		return refuse(err, err_size, "ball mass %g kg is not within 0.001 to 10 kg", t->ball_mass);
	if (t->cushion_count < 0 || t->cushion_count > CUSHION_MAX)
		return refuse(err, err_size, "%d cushions, at most %d are possible", t->cushion_count, CUSHION_MAX);
	if (t->jaw_count < 0 || t->jaw_count > JAW_MAX)
		return refuse(err, err_size, "%d jaws, at most %d are possible", t->jaw_count, JAW_MAX);
	if (t->pocket_count < 0 || t->pocket_count > POCKET_MAX)
		return refuse(err, err_size, "%d pockets, at most %d are possible", t->pocket_count, POCKET_MAX);
	return 0;
}

static int check_material(const struct material *m, char *err, size_t err_size)
{
	const struct {
		const char *name;
		double value, low, high;
	} range[] = {
		{"gravity", m->gravity, 1, 30},
		{"mu_slide", m->mu_slide, 1e-4, 2},
		{"mu_roll", m->mu_roll, 1e-5, 1},
		{"mu_spin", m->mu_spin, 1e-6, 1},
		{"loss_ball", m->loss_ball, 0, 0.99},
		{"loss_cushion", m->loss_cushion, 0, 0.99},
		{"topspin_factor", m->topspin_factor, 0, 10},
		{"e_ball", m->e_ball, 0, 1},
		{"e_cushion", m->e_cushion, 0, 1},
		{"mu_cushion", m->mu_cushion, 0, 2},
		{"mu_ball_a", m->mu_ball_a, 0, 2},
		{"mu_ball_b", m->mu_ball_b, 0, 2},
		{"mu_ball_c", m->mu_ball_c, 0, 100},
		{"ball_fall", m->ball_fall, 0, 1},
		{"cushion_fall", m->cushion_fall, 0, 1},
		{"cue_end_mass", m->cue_end_mass, 0, 0.1},
		{"stronge_omega", m->stronge_omega, 0, 100},
		{"hertz_modulus", m->hertz_modulus, 0, 1e12},
		{"topspin_variant", m->topspin_variant, 0, 2},
	};
	for (size_t i = 0; i < sizeof range / sizeof *range; i++) {
		if (!in_range(range[i].value, range[i].low, range[i].high))
			return refuse(err, err_size, "%s = %g is not within %g to %g", range[i].name, range[i].value,
				      range[i].low, range[i].high);
	}
	return 0;
}

/* A point that balls may come from: the bed's centre, or for a jaw its pocket (a jaw of a long rail has the bed's
 * centre behind it). */
static vec2 playing_side(const struct table *t, const struct cushion *c)
{
	vec2 middle = vec2_scale(vec2_add(c->a, c->b), 0.5), nearest = {0, 0};
	double best = INFINITY;
	for (int i = 0; !c->main_rail && i < t->pocket_count; i++) {
		double distance = vec2_dist(middle, t->pocket[i].centre);
		if (distance < best) {
			best = distance;
			nearest = t->pocket[i].centre;
		}
	}
	return nearest;
}

static int finish_cushion(struct table *t, int i, char *err, size_t err_size)
{
	struct cushion *c = &t->cushion[i];
	if (!vec2_is_finite(c->a) || !vec2_is_finite(c->b) || !in_range(c->nose_height, 0, 2 * t->ball_radius))
		return refuse(err, err_size, "cushion %d: not finite, or its nose is not at a ball's height", i);
	if (!in_range(c->e, 0, 1) || !in_range(c->mu, 0, 2))
		return refuse(err, err_size,
			      "cushion %d: restitution %g is not within 0 to 1, or friction %g not 0 to 2", i, c->e,
			      c->mu);
	c->span = vec2_dist(c->a, c->b);
	if (c->span < 1e-3)
		return refuse(err, err_size, "cushion %d is shorter than 1 mm", i);
	c->along = vec2_scale(vec2_sub(c->b, c->a), 1 / c->span);
	c->normal = vec2_perp(c->along);
	double side = vec2_dot(c->normal, vec2_sub(playing_side(t, c), c->a));
	if (fabs(side) < 1e-6 && !c->two_sided)
		return refuse(err, err_size, "cushion %d has no playing side: mark it two-sided", i);
	if (side < 0)
		c->normal = vec2_scale(c->normal, -1);
	return 0;
}

static bool end_is_covered(const struct table *t, vec2 end)
{
	for (int i = 0; i < t->jaw_count; i++) {
		if (fabs(vec2_dist(end, t->jaw[i].centre) - t->jaw[i].radius) < COVER_TOLERANCE)
			return true;
	}
	return false;
}

/* A straight joint of two cushions in line is no corner: nothing to hit there. */
static int add_tips(struct table *t, char *err, size_t err_size)
{
	for (int i = 0; i < t->cushion_count; i++) {
		const struct cushion *c = &t->cushion[i];
		for (int k = 0; k < 2 && !c->open_ends; k++) {
			vec2 end = k ? c->b : c->a;
			if (end_is_covered(t, end))
				continue;
			if (t->jaw_count == JAW_MAX)
				return refuse(err, err_size, "more than %d jaws and free cushion ends", JAW_MAX);
			t->jaw[t->jaw_count++] = (struct jaw){end, 0, c->nose_height};
		}
	}
	return 0;
}

static int finish_jaws_and_pockets(struct table *t, char *err, size_t err_size)
{
	for (int i = 0; i < t->jaw_count; i++) {
		const struct jaw *j = &t->jaw[i];
		if (!vec2_is_finite(j->centre) || !in_range(j->radius, 0, 1) ||
		    !in_range(j->nose_height, 0, 2 * t->ball_radius))
			return refuse(err, err_size, "jaw %d is not finite or out of range", i);
	}
	for (int i = 0; i < t->pocket_count; i++) {
		const struct pocket *p = &t->pocket[i];
		if (!vec2_is_finite(p->centre) || !in_range(p->radius, 1e-3, 1) || !vec2_is_finite(p->normal) ||
		    !memchr(p->name, '\0', sizeof p->name))
			return refuse(err, err_size, "pocket %d is not finite, out of range or without a name", i);
	}
	return add_tips(t, err, err_size);
}

static int nearest_region(const struct table *t, vec2 point)
{
	int best = 0;
	for (int i = 1; i < t->region_count; i++) {
		if (vec2_dist(point, t->pocket[i].centre) < vec2_dist(point, t->pocket[best].centre))
			best = i;
	}
	return best;
}

static void region_add(struct table_region *region, vec2 point, double reach)
{
	region->low.x = fmin(region->low.x, point.x - reach);
	region->low.y = fmin(region->low.y, point.y - reach);
	region->high.x = fmax(region->high.x, point.x + reach);
	region->high.y = fmax(region->high.y, point.y + reach);
}

/* Pockets, jaws and jaw cushions by the nearest pocket, each with the box from within which it can be touched. */
static void finish_regions(struct table *t)
{
	t->region_count = t->pocket_count > 0 ? t->pocket_count : 1;
	for (int i = 0; i < t->region_count; i++)
		t->region[i] = (struct table_region){.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
	for (int i = 0; i < t->pocket_count; i++) {
		t->region[i].pockets |= 1u << i;
		region_add(&t->region[i], t->pocket[i].centre, t->pocket[i].radius + REGION_SLACK);
	}
	for (int i = 0; i < t->jaw_count; i++) {
		struct table_region *region = &t->region[nearest_region(t, t->jaw[i].centre)];
		region->jaws |= 1u << i;
		region_add(region, t->jaw[i].centre, t->jaw[i].radius + t->ball_radius + REGION_SLACK);
	}
	for (int i = 0; i < t->cushion_count; i++) {
		const struct cushion *c = &t->cushion[i];
		if (c->main_rail)
			continue;
		struct table_region *region = &t->region[nearest_region(t, vec2_scale(vec2_add(c->a, c->b), 0.5))];
		region->cushions |= 1u << i;
		region_add(region, c->a, t->ball_radius + REGION_SLACK);
		region_add(region, c->b, t->ball_radius + REGION_SLACK);
	}
}

static int finish_bed(struct table *t, char *err, size_t err_size)
{
	struct bed *bed = &t->bed;
	if (!in_range(bed->path_error, 0, 1e-3))
		return refuse(err, err_size, "path error %g m is not within 0 to 0.001 m", bed->path_error);
	if (bed->path_error == 0)
		bed->path_error = PATH_ERROR;
	bed->uneven =
		bed->slope.x != 0 || bed->slope.y != 0 || bed->bowl[0] != 0 || bed->bowl[1] != 0 || bed->bowl[2] != 0;
	if (bed->uneven && !bed_holds(t))
		return refuse(err, err_size, "the bed is so steep that no ball would come to rest");
	return 0;
}

int table_finish(struct table *table, char *err, size_t err_size)
{
	int r = check_sizes(table, err, err_size);
	if (r == 0)
		r = check_material(&table->material, err, err_size);
	if (r == 0)
		r = finish_bed(table, err, err_size);
	for (int i = 0; r == 0 && i < table->cushion_count; i++)
		r = finish_cushion(table, i, err, err_size);
	if (r == 0)
		r = finish_jaws_and_pockets(table, err, err_size);
	if (r == 0)
		finish_regions(table);
	return r;
}

struct nose table_nose(const struct table *table, vec2 normal, double height)
{
	return (struct nose){normal, height, table->material.e_cushion, table->material.mu_cushion};
}

double nose_restitution(const struct table *table, const struct nose *nose, double speed)
{
	return nose->e / (1 + table->material.cushion_fall * speed);
}

double ball_restitution(const struct material *material, double speed)
{
	return material->e_ball / (1 + material->ball_fall * speed);
}

int table_pocket(const struct table *table, const char *name)
{
	for (int i = 0; i < table->pocket_count; i++) {
		if (strncmp(table->pocket[i].name, name, sizeof table->pocket[i].name) == 0)
			return i;
	}
	return -1;
}

static bool on_bed(const struct table *table, vec2 pos)
{
	return fabs(pos.x) <= table->length / 2 && fabs(pos.y) <= table->width / 2;
}

static bool behind_nose(const struct cushion *c, vec2 pos)
{
	vec2 from = vec2_sub(pos, c->a);
	double along = vec2_dot(from, c->along);
	return !c->two_sided && along >= 0 && along <= c->span && vec2_dot(from, c->normal) <= 0;
}

/* In the mouth of a pocket a ball may lie beyond the line of the noses: before the pocket and no farther from it than
 * its jaws, not yet within its circle, and outside of all that is solid. */
static bool in_mouth(const struct table *table, int pocket, vec2 pos)
{
	const struct pocket *p = &table->pocket[pocket];
	vec2 from = vec2_sub(pos, p->centre);
	double reach = 0;
	for (int i = 0; i < table->jaw_count; i++) {
		if (vec2_dist(pos, table->jaw[i].centre) <= table->jaw[i].radius)
			return false;
		if (table->region[pocket].jaws >> i & 1)
			reach = fmax(reach, vec2_dist(table->jaw[i].centre, p->centre));
	}
	if (vec2_dot(from, p->normal) <= 0 || vec2_norm(from) <= p->radius || vec2_norm(from) > reach)
		return false;
	for (int i = 0; i < table->cushion_count; i++)
		if (behind_nose(&table->cushion[i], pos))
			return false;
	return true;
}

/* The centre must be on the bed or in the mouth of a pocket; where exactly a nose or a jaw begins is for the simulation
 * to find. */
static bool may_lie(const struct table *table, vec2 pos)
{
	bool may = on_bed(table, pos);
	for (int i = 0; i < table->pocket_count && !may; i++)
		may = in_mouth(table, i, pos);
	return may;
}

int table_check_balls(const struct table *table, const struct ball *ball, int count, int *first, int *second, char *err,
		      size_t err_size)
{
	*first = *second = -1;
	for (int i = 0; i < count; i++) {
		if (ball[i].phase == BALL_POTTED)
			continue;
		*first = i;
		if (!ball_is_finite(&ball[i]))
			return refuse(err, err_size, "position or motion is not finite");
		if (!may_lie(table, ball[i].pos))
			return refuse(err, err_size, "(%.1f, %.1f) mm is not on the bed", 1e3 * ball[i].pos.x,
				      1e3 * ball[i].pos.y);
		for (int j = 0; j < i; j++) {
			double overlap = 2 * table->ball_radius - vec2_dist(ball[i].pos, ball[j].pos);
			if (ball[j].phase == BALL_POTTED || overlap <= OVERLAP_ALLOWED)
				continue;
			*first = j;
			*second = i;
			return refuse(err, err_size, "two balls overlap by %.2f mm", 1e3 * overlap);
		}
	}
	*first = -1;
	return 0;
}
