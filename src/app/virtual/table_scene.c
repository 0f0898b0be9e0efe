#include "app/virtual/table_scene.h"

#include <errno.h>
#include <stdio.h>

/* Sizes and colours as on the thesis' photographs. m, grey levels. */
static const double CUSHION_WIDTH = 0.036, RAIL_WIDTH = 0.075;
static const double HOLE_MORE = 0.006, CASTING_MORE = 0.016;	 /* beyond a pocket's radius */
static const double CORNER_ALONG = 0.052, CORNER_ACROSS = 0.032; /* casting of a corner, from the noses' corner */
static const double MOUTH_REACH = 0.15;				 /* of a pocket's mouth from its centre, at most */
static const double MARKER_BORDER = 0.22;			 /* white paper around a marker, in sides */
static const double DIAMOND = 0.0045;
static const double LINE_HALF = 0.0006, LINE_FADE = 0.0014; /* baulk line and D */
static const double NOSE_SHADE = 0.012;			    /* width of the darker strip of cloth along the noses */

static const float COLOURS[][3] = {
	[SURFACE_FLOOR] = {16, 13, 17},	     [SURFACE_BED] = {131, 154, 146},	[SURFACE_UNDER_NOSE] = {62, 98, 100},
	[SURFACE_CUSHION] = {119, 155, 143}, [SURFACE_RAIL] = {118, 54, 52},	[SURFACE_CASTING] = {40, 35, 41},
	[SURFACE_HOLE] = {7, 5, 9},	     [SURFACE_WHITE] = {252, 232, 240}, [SURFACE_BLACK] = {58, 28, 42},
};

/* ---- places ---- */

/* How far p lies outside the rectangle of the noses; negative inside. */
static double outside(const struct table *table, vec2 p)
{
	return fmax(fabs(p.x) - table->length / 2, fabs(p.y) - table->width / 2);
}

static double mouth_depth(const struct table *table, const struct pocket *pocket)
{
	double depth = 0;
	for (int i = 0; i < table->cushion_count; i++) {
		const struct cushion *c = &table->cushion[i];
		if (!c->main_rail &&
		    fmin(vec2_dist(c->a, pocket->centre), vec2_dist(c->b, pocket->centre)) < MOUTH_REACH)
			depth = fmax(depth, fmax(outside(table, c->a), outside(table, c->b)));
	}
	return depth;
}

int table_scene_init(struct table_scene *scene, const struct table *table, const struct marker_layout *markers,
		     const double eye[3], char *err, size_t err_size)
{
	*scene = (struct table_scene){
		.table = table, .markers = *markers, .rail_height = markers->height, .eye = {eye[0], eye[1], eye[2]}};
	for (int i = 0; i < markers->count; i++) {
		if (marker_bits(markers->dictionary_count, markers->dictionary_bits, markers->marker[i].id,
				scene->bits[i]))
			continue;
		snprintf(err, err_size, "markers: id %d is not in a dictionary of %d markers of %d bits",
			 markers->marker[i].id, markers->dictionary_count, markers->dictionary_bits);
		return -EINVAL;
	}
	for (int i = 0; i < table->pocket_count; i++)
		scene->mouth_depth[i] = mouth_depth(table, &table->pocket[i]);
	return 0;
}

/* The same ray at rail height. */
static vec2 raise(const struct table_scene *scene, vec2 p)
{
	double k = (scene->eye[2] - scene->rail_height) / scene->eye[2];
	return (vec2){scene->eye[0] + k * (p.x - scene->eye[0]), scene->eye[1] + k * (p.y - scene->eye[1])};
}

/* Do the segments a..b and c..d cross? */
static bool segments_cross(vec2 a, vec2 b, vec2 c, vec2 d)
{
	vec2 ab = vec2_sub(b, a), cd = vec2_sub(d, c);
	double c_side = vec2_cross(ab, vec2_sub(c, a)), d_side = vec2_cross(ab, vec2_sub(d, a));
	double a_side = vec2_cross(cd, vec2_sub(a, c)), b_side = vec2_cross(cd, vec2_sub(b, c));
	return (c_side > 0) != (d_side > 0) && (a_side > 0) != (b_side > 0);
}

/* Cloth between the jaws: from there the pocket's middle is in sight past all cushions. */
static bool in_mouth(const struct table_scene *scene, int index, vec2 p)
{
	const struct table *table = scene->table;
	const struct pocket *pocket = &table->pocket[index];
	vec2 from = vec2_sub(p, pocket->centre);
	/* behind short jaws the middle comes in sight again: that is rail */
	if (vec2_dot(from, pocket->normal) <= 0 || vec2_norm(from) > MOUTH_REACH ||
	    outside(table, p) > scene->mouth_depth[index])
		return false;
	for (int i = 0; i < table->jaw_count; i++)
		if (vec2_dist(p, table->jaw[i].centre) < table->jaw[i].radius)
			return false;
	for (int i = 0; i < table->cushion_count; i++)
		if (segments_cross(p, pocket->centre, table->cushion[i].a, table->cushion[i].b))
			return false;
	return true;
}

static bool in_corner_casting(const struct table *table, vec2 p)
{
	double x = table->length / 2 - fabs(p.x), y = table->width / 2 - fabs(p.y);
	return (x < CORNER_ALONG && y < -CORNER_ACROSS) || (y < CORNER_ALONG && x < -CORNER_ACROSS);
}

static bool on_diamond(const struct table *table, vec2 p)
{
	double out = CUSHION_WIDTH + RAIL_WIDTH / 2 - 0.002;
	vec2 q = {fabs(p.x), fabs(p.y)};
	for (int k = 0; k <= 3; k++) {
		vec2 side = {k * table->length / 8, table->width / 2 + out},
		     end = {table->length / 2 + out, k * table->width / 4};
		if ((k > 0 && vec2_dist(q, side) < DIAMOND) || (k < 2 && vec2_dist(q, end) < DIAMOND))
			return true;
	}
	return false;
}

/* SURFACE_WHITE or _BLACK on a marker, SURFACE_FLOOR beside all of them. */
static enum surface on_marker(const struct table_scene *scene, vec2 p)
{
	const struct marker_layout *m = &scene->markers;
	for (int i = 0; i < m->count; i++) {
		/* from the black square's top left corner, in sides */
		double u = (p.x - m->marker[i].centre.x) / m->side + 0.5,
		       v = 0.5 - (p.y - m->marker[i].centre.y) / m->side;
		if (u < -MARKER_BORDER || v < -MARKER_BORDER || u > 1 + MARKER_BORDER || v > 1 + MARKER_BORDER)
			continue;
		if (u < 0 || v < 0 || u >= 1 || v >= 1)
			return SURFACE_WHITE;
		int cells = m->dictionary_bits + 2, column = (int)(u * cells) - 1, row = (int)(v * cells) - 1;
		if (column < 0 || row < 0 || column >= m->dictionary_bits || row >= m->dictionary_bits)
			return SURFACE_BLACK;
		return scene->bits[i][row * m->dictionary_bits + column] ? SURFACE_WHITE : SURFACE_BLACK;
	}
	return SURFACE_FLOOR;
}

/* Pockets and their mouths; SURFACE_FLOOR where there is none of them. */
static enum surface at_pocket(const struct table_scene *scene, vec2 bed, vec2 top)
{
	const struct table *table = scene->table;
	bool over = outside(table, top) > 0;
	for (int i = 0; i < table->pocket_count; i++) {
		const struct pocket *pocket = &table->pocket[i];
		double hole = pocket->radius + HOLE_MORE;
		if (vec2_dist(bed, pocket->centre) < hole || (over && vec2_dist(top, pocket->centre) < hole))
			return SURFACE_HOLE;
		if (over && in_mouth(scene, i, top))
			return SURFACE_UNDER_NOSE;
		if (over && vec2_dist(top, pocket->centre) < pocket->radius + CASTING_MORE)
			return SURFACE_CASTING;
	}
	return SURFACE_FLOOR;
}

enum surface table_scene_surface(const struct table_scene *scene, vec2 p)
{
	const struct table *table = scene->table;
	vec2 top = raise(scene, p);
	enum surface found = on_marker(scene, top);
	if (found != SURFACE_FLOOR)
		return found;
	found = at_pocket(scene, p, top);
	if (found != SURFACE_FLOOR)
		return found;
	double out = outside(table, top);
	if (out <= 0)
		return outside(table, p) <= 0 ? SURFACE_BED : SURFACE_UNDER_NOSE;
	if (out > CUSHION_WIDTH + RAIL_WIDTH)
		return SURFACE_FLOOR;
	if (in_corner_casting(table, top))
		return SURFACE_CASTING;
	if (out < CUSHION_WIDTH)
		return SURFACE_CUSHION;
	return on_diamond(table, top) ? SURFACE_WHITE : SURFACE_RAIL;
}

double table_scene_meet(const struct table_scene *scene, vec2 p, enum surface surface, vec2 *at)
{
	bool low = surface == SURFACE_BED || surface == SURFACE_UNDER_NOSE || surface == SURFACE_FLOOR ||
		   surface == SURFACE_HOLE;
	*at = low ? p : raise(scene, p);
	return low ? 0 : scene->rail_height;
}

/* ---- colours ---- */

/* -1..1 from whole numbers. */
static double lattice(int x, int y)
{
	uint32_t h = (uint32_t)x * 0x9e3779b1u ^ (uint32_t)y * 0x85ebca77u;
	h ^= h >> 15;
	h *= 0x2c1b3c6du;
	h ^= h >> 12;
	h *= 0x297a2d39u;
	h ^= h >> 15;
	return (double)h / 2147483648.0 - 1;
}

/* Smooth value noise with cells of the given size. */
static double grain(vec2 p, double size_x, double size_y)
{
	double x = p.x / size_x, y = p.y / size_y, fx = floor(x), fy = floor(y);
	int i = (int)fx, j = (int)fy;
	double u = x - fx, v = y - fy;
	return (1 - v) * ((1 - u) * lattice(i, j) + u * lattice(i + 1, j)) +
	       v * ((1 - u) * lattice(i, j + 1) + u * lattice(i + 1, j + 1));
}

/* 0..1: how much of the baulk line and the D covers p. */
static double baulk_line(const struct table *table, vec2 p)
{
	vec2 d = vec2_sub(p, table->baulk_d_centre);
	double line = fabs(d.x), arc = d.x < 0 ? fabs(vec2_norm(d) - table->baulk_d_radius) : INFINITY;
	return fmax(0, fmin(1, 1 - (fmin(line, arc) - LINE_HALF) / LINE_FADE));
}

static double texture(const struct table_scene *scene, vec2 p, enum surface surface)
{
	vec2 at;
	table_scene_meet(scene, p, surface, &at);
	switch (surface) {
	case SURFACE_BED: {
		double near = -outside(scene->table, p);
		double shade = near < NOSE_SHADE ? 0.86 : 1;
		return shade * (1 + 0.022 * grain(p, 0.0025, 0.0025) + 0.018 * grain(p, 0.09, 0.06)) *
		       (1 - 0.55 * baulk_line(scene->table, p));
	}
	case SURFACE_CUSHION:
		return 1 + 0.02 * grain(at, 0.0025, 0.0025);
	case SURFACE_RAIL:
		return 1 +
		       0.16 * (fabs(at.x) > scene->table->length / 2 ? grain(at, 0.005, 0.3) : grain(at, 0.3, 0.005));
	default:
		return 1;
	}
}

void table_scene_light(const struct table_scene *scene, vec2 at, float rgb[3])
{
	double x = fmax(-1.3, fmin(1.3, 2 * at.x / scene->table->length));
	double y = fmax(-1.3, fmin(1.3, 2 * at.y / scene->table->width));
	double level = 1.02 - 0.07 * x * x - 0.05 * y * y + 0.05 * y;
	rgb[0] = (float)(level * (1 + 0.035 * x));
	rgb[1] = (float)(level * (1 - 0.025 * x));
	rgb[2] = (float)(level * (1 - 0.075 * x));
}

void table_scene_colour(const struct table_scene *scene, vec2 p, enum surface surface, float rgb[3])
{
	vec2 at;
	float light[3];
	table_scene_meet(scene, p, surface, &at);
	table_scene_light(scene, at, light);
	double k = texture(scene, p, surface);
	for (int c = 0; c < 3; c++)
		rgb[c] = (float)k * light[c] * COLOURS[surface][c];
}
