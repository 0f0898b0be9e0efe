#include "app/light/draw.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/light/draw_field.h"
#include "app/light/draw_path.h"

/* The thesis' rings are 1.9 R wide; that touches what the camera sees of a ball in the corners, which stand out to 1.97
 * R from its foot. */
static const double HALO = 2.2;			/* radii */
static const double GHOST = 1.0;		/* radii */
static const double TIP_TOLD = 0.05;		/* of the radius: nearer to the middle is the middle */
static const double POCKET = 1.6;		/* pocket radii: outside the hole, inside the markers on the rails */
static const double LINE = 0.005, THIN = 0.004; /* m */
static const double TEXT_HEIGHT = 0.055, POCKET_HEIGHT = 0.04, INFO_HEIGHT = 0.024; /* m */
static const double TEXT_REACH = 10, POCKET_REACH = 0.6, INFO_REACH = 0.2;	    /* m */
/* Left free for the text by the paths of the other balls. */
enum { ITEMS_KEPT = 4, POINTS_KEPT = 8 };
enum { POCKET_POINTS = 49 };
static const double RADIAN = 57.29577951308232; /* degrees */

static const uint32_t HALO_RGBA = 0xc0ffffff, GHOST_RGBA = 0xffffffff, CUE_RGBA = 0xffffffff, TABLE_RGBA = 0x80c0ffff,
		      TEXT_RGBA = 0xe0ffffff, INFO_RGBA = 0xa0e0e0ff;

/* What all parts of one picture need. */
struct proposal {
	billiard_draw_list_t *list;
	const struct table *table;
	const billiard_plan_t *plan;
	const billiard_plan_shot_t *shot;
	const struct draw_options *options;
	struct draw_field field;
	int ball_count;
};

static void draw_table(billiard_draw_list_t *list, const struct table *table)
{
	int first = list->item_count;
	for (int i = 0; i < table->cushion_count; i++)
		draw_polyline(list, (vec2[]){table->cushion[i].a, table->cushion[i].b}, 2, THIN, TABLE_RGBA);
	for (int i = 0; i < table->pocket_count; i++)
		draw_ring(list, table->pocket[i].centre, table->pocket[i].radius, THIN, TABLE_RGBA);
	for (int i = first; i < list->item_count; i++)
		list->items[i].layer = DRAW_LAYER_TABLE;
}

static void draw_halos(const struct draw_field *field, billiard_draw_list_t *list)
{
	const struct draw_pen pen = {LINE, HALO_RGBA, false};
	for (int i = 0; i < field->count; i++)
		draw_field_ring(field, list, field->ball[i], HALO * field->table->ball_radius, &pen);
}

static void draw_info(const struct draw_field *field, billiard_draw_list_t *list, vec2 pos, const char *name)
{
	char text[64];
	snprintf(text, sizeof(text), "%.15s %.0f %.0f", name, 1000 * pos.x, 1000 * pos.y);
	vec2 beside = vec2_madd(pos, -3.5 * field->table->ball_radius, (vec2){0, 1});
	draw_field_text(field, list, &(struct draw_label){text, beside, INFO_REACH, INFO_HEIGHT, INFO_RGBA});
}

/* ---- proposal ---- */

static bool ball_lies(const struct proposal *proposal, int ball)
{
	return ball >= 0 && proposal->shot->start_on[ball];
}

static vec2 ball_start(const struct proposal *proposal, int ball)
{
	return (vec2){proposal->shot->start_x[ball], proposal->shot->start_y[ball]};
}

static int cue_ball(const struct proposal *proposal)
{
	for (int i = 0; i < proposal->ball_count; i++)
		if (proposal->plan->colours[i] == COLOUR_WHITE)
			return i;
	return -1;
}

static bool has_room(const billiard_draw_list_t *list, int points)
{
	return list->item_count < DRAW_ITEM_MAX - ITEMS_KEPT &&
	       list->point_count + points < DRAW_POINT_MAX - POINTS_KEPT;
}

/* Parts of a path that cannot be drawn whole are better not drawn at all. */
static void stroke(const struct proposal *proposal, const vec2 *point, int count, const struct draw_pen *pen)
{
	if (count >= 2 && has_room(proposal->list, count))
		draw_field_stroke(&proposal->field, proposal->list, point, count, pen);
}

static void draw_ghost(const struct proposal *proposal, vec2 at)
{
	const struct draw_pen pen = {THIN, GHOST_RGBA, false};
	draw_field_ring(&proposal->field, proposal->list, at, GHOST * proposal->table->ball_radius, &pen);
}

static bool falls(const struct proposal *proposal, int ball)
{
	for (int i = 0; i < proposal->shot->potted_count; i++)
		if (proposal->shot->potted_ball[i] == ball)
			return true;
	return false;
}

/* Where a ball that moved comes to rest. */
static void draw_end(const struct proposal *proposal, int ball, const struct draw_path *path, uint32_t rgba)
{
	double radius = proposal->table->ball_radius;
	if (path->count < 2 || falls(proposal, ball) ||
	    vec2_dist(path->point[0], path->point[path->count - 1]) < radius)
		return;
	const struct draw_pen pen = {THIN, rgba, false};
	if (has_room(proposal->list, 1))
		draw_field_ring(&proposal->field, proposal->list, path->point[path->count - 1], radius, &pen);
}

static void draw_cue(const struct proposal *proposal, int cue)
{
	struct draw_path path;
	draw_path_of(&path, proposal->plan, proposal->shot, cue);
	int solid = path.contact >= 0 ? path.contact + 1 : path.count;
	stroke(proposal, path.point, solid, &(struct draw_pen){LINE, CUE_RGBA, false});
	if (path.contact < 0)
		return;
	draw_ghost(proposal, path.point[path.contact]);
	if (!proposal->options->other_paths)
		return;
	stroke(proposal, path.point + path.contact, path.count - path.contact,
	       &(struct draw_pen){THIN, CUE_RGBA, true});
	draw_end(proposal, cue, &path, CUE_RGBA);
}

static void draw_object(const struct proposal *proposal, int ball, bool dashed)
{
	struct draw_path path;
	draw_path_of(&path, proposal->plan, proposal->shot, ball);
	struct draw_pen pen = {dashed ? THIN : LINE, draw_ball_rgba(proposal->plan->colours[ball]), dashed};
	stroke(proposal, path.point, path.count, &pen);
	draw_end(proposal, ball, &path, pen.rgba);
}

/* A shot whose keyframes did not fit: straight from ball to ball as far as the start position tells. */
static void draw_without_keyframes(const struct proposal *proposal, int cue)
{
	int target = proposal->shot->target, pocket = proposal->shot->pocket;
	double angle = proposal->shot->angle;
	if (ball_lies(proposal, cue)) {
		vec2 from = ball_start(proposal, cue);
		vec2 aim[2] = {from, vec2_madd(from, proposal->table->width / 2, vec2_from_angle(angle))};
		stroke(proposal, aim, 2, &(struct draw_pen){LINE, CUE_RGBA, false});
	}
	if (proposal->shot->rails == 0 && ball_lies(proposal, target) && pocket >= 0) {
		vec2 way[2] = {ball_start(proposal, target), proposal->table->pocket[pocket].centre};
		stroke(proposal, way, 2,
		       &(struct draw_pen){LINE, draw_ball_rgba(proposal->plan->colours[target]), false});
	}
}

static void draw_paths(const struct proposal *proposal)
{
	int cue = cue_ball(proposal), target = proposal->shot->target;
	if (proposal->shot->keyframe_count == 0) {
		draw_without_keyframes(proposal, cue);
		return;
	}
	if (ball_lies(proposal, cue))
		draw_cue(proposal, cue);
	if (target != cue && ball_lies(proposal, target))
		draw_object(proposal, target, false);
	if (!proposal->options->other_paths)
		return;
	for (int i = 0; i < proposal->ball_count; i++)
		if (i != cue && i != target && ball_lies(proposal, i))
			draw_object(proposal, i, true);
}

/* The part of a ring around the pocket that lies on the bed: light on the rails would disturb the markers. */
static void draw_pocket_arc(const struct proposal *proposal, const struct pocket *pocket, const struct draw_pen *pen)
{
	vec2 arc[POCKET_POINTS];
	int count = 0;
	/* from the side that looks away from the bed, so that what lies on the bed is one piece */
	double begin = atan2(-pocket->normal.y, -pocket->normal.x);
	for (int i = 0; i < POCKET_POINTS; i++) {
		vec2 p = vec2_madd(pocket->centre, POCKET * pocket->radius,
				   vec2_from_angle(begin + i * 2 * acos(-1) / (POCKET_POINTS - 1)));
		if (fabs(p.x) < proposal->table->length / 2 && fabs(p.y) < proposal->table->width / 2)
			arc[count++] = p;
	}
	stroke(proposal, arc, count, pen);
}

static void draw_pocket(const struct proposal *proposal)
{
	int pocket = proposal->shot->pocket, target = proposal->shot->target;
	if (pocket < 0)
		return;
	uint32_t rgba = ball_lies(proposal, target) ? draw_ball_rgba(proposal->plan->colours[target]) : GHOST_RGBA;
	draw_pocket_arc(proposal, &proposal->table->pocket[pocket], &(struct draw_pen){2 * LINE, rgba, false});
}

/* Where the tip meets the ball, in words: what is struck beside the middle and not told would be struck through it. */
static void tip_words(const billiard_plan_shot_t *shot, char *out, size_t size)
{
	double follow = shot->follow, side = shot->side;
	char high[24] = "", left[24] = "";
	if (fabs(follow) >= TIP_TOLD)
		snprintf(high, sizeof(high), "  %s %.0f%%", follow > 0 ? "high" : "low", 100 * fabs(follow));
	if (fabs(side) >= TIP_TOLD)
		snprintf(left, sizeof(left), "  %s %.0f%%", side > 0 ? "left" : "right", 100 * fabs(side));
	snprintf(out, size, "%s%s", high, left);
}

/* Speed and angle (counter-clockwise from the way to the black cushion) where the player looks, at the cue ball; the pocket's name at the
 * pocket. */
static void draw_labels(const struct proposal *proposal, int number, int shots)
{
	char text[64], which[32] = "", tip[48];
	int pocket = proposal->shot->pocket, cue = cue_ball(proposal);
	if (shots > 1)
		snprintf(which, sizeof(which), "  %d/%d", number, shots);
	tip_words(proposal->shot, tip, sizeof(tip));
	snprintf(text, sizeof(text), "%.1f m/s  %.0f\u00b0%s%s", proposal->shot->speed, proposal->shot->angle * RADIAN,
		 tip, which);
	vec2 at_cue = ball_lies(proposal, cue) ? ball_start(proposal, cue) : (vec2){0, 0};
	draw_field_text(&proposal->field, proposal->list,
			&(struct draw_label){text, at_cue, TEXT_REACH, TEXT_HEIGHT, TEXT_RGBA});
	if (pocket < 0)
		return;
	const struct pocket *p = &proposal->table->pocket[pocket];
	draw_field_text(&proposal->field, proposal->list,
			&(struct draw_label){p->name, p->centre, POCKET_REACH, POCKET_HEIGHT, TEXT_RGBA});
}

static void draw_infos(const struct proposal *proposal)
{
	for (int i = 0; i < proposal->ball_count; i++) {
		if (!ball_lies(proposal, i))
			continue;
		char name[16] = "";
		memcpy(name, proposal->plan->names[i], sizeof(name) - 1);
		draw_info(&proposal->field, proposal->list, ball_start(proposal, i), name);
	}
}

void draw_proposal(billiard_draw_list_t *list, const struct table *table, const struct draw_subject *subject,
		   const struct draw_options *options)
{
	const billiard_plan_t *plan = subject->plan;
	const billiard_plan_entry_t *entry = &plan->entries[subject->entry];
	struct proposal proposal = {list, table, plan, &entry->shots[subject->shot], options, {0}, plan->ball_count};
	draw_clear(list);
	list->plan_id = plan->request_id;
	draw_field_init(&proposal.field, table);
	for (int i = 0; i < proposal.ball_count; i++)
		if (ball_lies(&proposal, i))
			draw_field_add(&proposal.field, ball_start(&proposal, i));
	if (options->table)
		draw_table(list, table);
	if (options->halo)
		draw_halos(&proposal.field, list);
	draw_pocket(&proposal);
	draw_paths(&proposal);
	if (proposal.shot->speed > 0)
		draw_labels(&proposal, subject->shot + 1, entry->shot_count);
	if (options->info)
		draw_infos(&proposal);
}

static bool is_free_of_balls(vec2 at, double reach, const struct ball *ball, int count)
{
	for (int i = 0; i < count; i++)
		if (ball[i].phase != BALL_POTTED && vec2_dist(at, ball[i].pos) < reach)
			return false;
	return true;
}

void draw_region_in_hand(billiard_draw_list_t *list, const struct table *table, const struct ball *ball, int count)
{
	enum { DASHES = 18 };
	static const double WIDTH = 0.006; /* m */
	static const uint32_t RGBA = 0xffffffff;
	double reach = 3 * table->ball_radius, r = table->baulk_d_radius;
	vec2 c = table->baulk_d_centre;
	/* Half a circle towards the bottom cushion, and the line that closes it. */
	for (int i = 0; i < DASHES; i++) {
		vec2 arc[2], line[2];
		for (int k = 0; k < 2; k++) {
			double share = (i + 0.25 + 0.5 * k) / DASHES;
			arc[k] = vec2_madd(c, r, vec2_from_angle(M_PI / 2 + M_PI * share));
			line[k] = (vec2){c.x, c.y - r + 2 * r * share};
		}
		if (is_free_of_balls(arc[0], reach, ball, count) && is_free_of_balls(arc[1], reach, ball, count))
			draw_polyline(list, arc, 2, WIDTH, RGBA);
		if (is_free_of_balls(line[0], reach, ball, count) && is_free_of_balls(line[1], reach, ball, count))
			draw_polyline(list, line, 2, WIDTH, RGBA);
	}
}

void draw_idle(billiard_draw_list_t *list, const struct table *table, const struct draw_resting *resting,
	       const struct draw_options *options)
{
	const struct ball *ball = resting->ball;
	const struct draw_label note = {resting->note, {0, -table->width / 2}, TEXT_REACH, TEXT_HEIGHT, TEXT_RGBA};
	struct draw_field field;
	draw_clear(list);
	draw_field_init(&field, table);
	for (int i = 0; i < resting->count; i++)
		if (ball[i].phase != BALL_POTTED)
			draw_field_add(&field, ball[i].pos);
	if (options->table)
		draw_table(list, table);
	if (options->halo)
		draw_halos(&field, list);
	if (resting->note[0])
		draw_field_text(&field, list, &note);
	for (int i = 0; options->info && i < resting->count; i++)
		if (ball[i].phase != BALL_POTTED)
			draw_info(&field, list, ball[i].pos, ball_colour_name(ball[i].colour));
}
