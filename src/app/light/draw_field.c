#include "app/light/draw_field.h"

#include <assert.h>
#include <string.h>

/* Seen from a camera 1.6 R-lengths of the table above it, a ball in the corner hides the cloth up to 1.97 R from its
 * foot. */
static const double KEEP = 2.05;       /* radii */
static const double TEXT_STEP = 0.025; /* m between tried places */
static const double TEXT_GAP = 0.015;  /* m between text and anything else */
static const double TEXT_LEAST = 0.5;  /* text shrinks to this share of its height before it is left out */
static const double TEXT_KEEP = 0.75;  /* radii beyond keep: text is broad, and detectors look around a ball */
enum { RING_POINTS = 25 };	       /* sagitta below 0.5 mm for a halo */

void draw_field_init(struct draw_field *field, const struct table *table)
{
	*field = (struct draw_field){.table = table, .keep = KEEP * table->ball_radius};
}

void draw_field_add(struct draw_field *field, vec2 ball)
{
	assert(field->count < BALL_MAX);
	field->ball[field->count++] = ball;
}

/* ---- strokes ---- */

struct cut {
	double from, to; /* share of the segment inside a disc */
};

/* Part of a..b inside the disc, if any. */
static bool cut_by_disc(vec2 a, vec2 b, vec2 centre, double radius, struct cut *cut)
{
	vec2 d = vec2_sub(b, a), f = vec2_sub(a, centre);
	double aa = vec2_norm2(d), half_b = vec2_dot(f, d), c = vec2_norm2(f) - radius * radius;
	double disc = half_b * half_b - aa * c;
	if (aa == 0 || disc <= 0)
		return false;
	double root = sqrt(disc);
	*cut = (struct cut){fmax(0, (-half_b - root) / aa), fmin(1, (-half_b + root) / aa)};
	return cut->from < cut->to;
}

/* All cuts of a segment, in order of from. keep: m around the balls. */
static int cuts_of(const struct draw_field *field, double keep, vec2 a, vec2 b, struct cut cut[BALL_MAX])
{
	int n = 0;
	for (int i = 0; i < field->count; i++) {
		struct cut c;
		if (!cut_by_disc(a, b, field->ball[i], keep, &c))
			continue;
		int k = n++;
		for (; k > 0 && cut[k - 1].from > c.from; k--)
			cut[k] = cut[k - 1];
		cut[k] = c;
	}
	return n;
}

struct piece {
	billiard_draw_list_t *list;
	const struct draw_pen *pen;
	vec2 point[DRAW_POINT_MAX];
	int count;
	bool full;
};

static double piece_length(const struct piece *piece)
{
	double length = 0;
	for (int i = 1; i < piece->count; i++)
		length += vec2_dist(piece->point[i - 1], piece->point[i]);
	return length;
}

static void piece_flush(struct piece *piece)
{
	/* specks shorter than a line is wide only disturb */
	if (piece->count >= 2 && piece_length(piece) > 2 * piece->pen->width) {
		bool done = piece->pen->dashed ? draw_dashed(piece->list, piece->point, piece->count, piece->pen->width,
							     piece->pen->rgba)
					       : draw_polyline(piece->list, piece->point, piece->count,
							       piece->pen->width, piece->pen->rgba);
		piece->full |= !done;
	}
	piece->count = 0;
}

static void piece_add(struct piece *piece, vec2 a, vec2 b)
{
	if (piece->count == 0)
		piece->point[piece->count++] = a;
	if (piece->count < DRAW_POINT_MAX)
		piece->point[piece->count++] = b;
}

static void piece_segment(struct piece *piece, const struct draw_field *field, vec2 a, vec2 b)
{
	struct cut cut[BALL_MAX];
	int n = cuts_of(field, field->keep + piece->pen->width / 2, a, b, cut);
	vec2 d = vec2_sub(b, a);
	double at = 0;
	for (int i = 0; i < n; i++) {
		if (cut[i].from > at)
			piece_add(piece, vec2_madd(a, at, d), vec2_madd(a, cut[i].from, d));
		if (cut[i].to > at) {
			piece_flush(piece);
			at = cut[i].to;
		}
	}
	if (at < 1)
		piece_add(piece, vec2_madd(a, at, d), b);
}

bool draw_field_stroke(const struct draw_field *field, billiard_draw_list_t *list, const vec2 *point, int count,
		       const struct draw_pen *pen)
{
	struct piece piece = {.list = list, .pen = pen};
	for (int i = 1; i < count; i++)
		if (vec2_dist(point[i - 1], point[i]) > 0)
			piece_segment(&piece, field, point[i - 1], point[i]);
	piece_flush(&piece);
	return !piece.full;
}

bool draw_field_ring(const struct draw_field *field, billiard_draw_list_t *list, vec2 centre, double radius,
		     const struct draw_pen *pen)
{
	/* a halo around a ball is wide enough not to be near its own ball */
	bool near = false;
	for (int i = 0; i < field->count; i++)
		near |= fabs(vec2_dist(field->ball[i], centre) - radius) < field->keep + pen->width / 2;
	if (!near)
		return draw_ring(list, centre, radius, pen->width, pen->rgba);
	vec2 point[RING_POINTS];
	for (int i = 0; i < RING_POINTS; i++)
		point[i] = vec2_madd(centre, radius, vec2_from_angle(i * 2 * acos(-1) / (RING_POINTS - 1)));
	return draw_field_stroke(field, list, point, RING_POINTS, pen);
}

/* ---- text ---- */

struct box {
	vec2 low, high;
};

static double box_distance(const struct box *box, vec2 p)
{
	double dx = fmax(0, fmax(box->low.x - p.x, p.x - box->high.x));
	double dy = fmax(0, fmax(box->low.y - p.y, p.y - box->high.y));
	return sqrt(dx * dx + dy * dy);
}

/* Does a..b come into the box? Liang and Barsky's clipping. */
static bool box_meets_segment(const struct box *box, vec2 a, vec2 b)
{
	const double p[4] = {a.x - b.x, b.x - a.x, a.y - b.y, b.y - a.y};
	const double q[4] = {a.x - box->low.x, box->high.x - a.x, a.y - box->low.y, box->high.y - a.y};
	double from = 0, to = 1;
	for (int i = 0; i < 4; i++) {
		if (p[i] == 0 && q[i] < 0)
			return false;
		if (p[i] < 0)
			from = fmax(from, q[i] / p[i]);
		else if (p[i] > 0)
			to = fmin(to, q[i] / p[i]);
	}
	return from <= to;
}

static struct box text_box(vec2 at, double height, const char *text)
{
	return (struct box){{at.x, at.y - 0.25 * height}, {at.x + draw_text_width(text, height), at.y + height}};
}

static bool box_meets_item(const struct box *box, const billiard_draw_list_t *list, const billiard_draw_item_t *item)
{
	const double *xs = &list->xs[item->point_first], *ys = &list->ys[item->point_first];
	if (item->kind == DRAW_TEXT) {
		struct box other = text_box((vec2){xs[0], ys[0]}, item->radius, (const char *)item->text);
		return box->low.x < other.high.x && other.low.x < box->high.x && box->low.y < other.high.y &&
		       other.low.y < box->high.y;
	}
	if (item->point_count == 1)
		return box_distance(box, (vec2){xs[0], ys[0]}) < item->radius + item->width;
	for (int i = 1; i < item->point_count; i++)
		if (box_meets_segment(box, (vec2){xs[i - 1], ys[i - 1]}, (vec2){xs[i], ys[i]}))
			return true;
	return false;
}

static bool box_is_free(const struct draw_field *field, const billiard_draw_list_t *list, const struct box *box)
{
	const struct table *table = field->table;
	double far = fmax(fmax(-box->low.x, box->high.x) - table->length / 2,
			  fmax(-box->low.y, box->high.y) - table->width / 2);
	if (far > 0)
		return false;
	for (int i = 0; i < field->count; i++)
		if (box_distance(box, field->ball[i]) < field->keep + TEXT_KEEP * table->ball_radius)
			return false;
	for (int i = 0; i < table->pocket_count; i++)
		if (box_distance(box, table->pocket[i].centre) < table->pocket[i].radius)
			return false;
	for (int i = 0; i < list->item_count; i++)
		if (list->items[i].layer != DRAW_LAYER_TABLE && box_meets_item(box, list, &list->items[i]))
			return false;
	return true;
}

/* The free place nearest to where the label should be. */
static bool find_place(const struct draw_field *field, const billiard_draw_list_t *list, const struct draw_label *label,
		       double height, vec2 *place)
{
	struct box whole = text_box((vec2){0, 0}, height, label->text);
	vec2 middle = vec2_scale(vec2_add(whole.low, whole.high), 0.5);
	int steps_x = (int)(field->table->length / 2 / TEXT_STEP), steps_y = (int)(field->table->width / 2 / TEXT_STEP);
	double best = label->reach;
	for (int i = -steps_x; i <= steps_x; i++)
		for (int j = -steps_y; j <= steps_y; j++) {
			vec2 centre = {i * TEXT_STEP, j * TEXT_STEP}, at = vec2_sub(centre, middle);
			struct box box = text_box(at, height, label->text);
			struct box wide = {{box.low.x - TEXT_GAP, box.low.y - TEXT_GAP},
					   {box.high.x + TEXT_GAP, box.high.y + TEXT_GAP}};
			if (vec2_dist(centre, label->near) >= best || !box_is_free(field, list, &wide))
				continue;
			*place = at;
			best = vec2_dist(centre, label->near);
		}
	return best < label->reach;
}

bool draw_field_text(const struct draw_field *field, billiard_draw_list_t *list, const struct draw_label *label)
{
	for (double share = 1; share >= TEXT_LEAST; share -= 0.25) {
		vec2 at;
		if (find_place(field, list, label, share * label->height, &at))
			return draw_text(list, at, share * label->height, label->rgba, label->text);
	}
	return false;
}
