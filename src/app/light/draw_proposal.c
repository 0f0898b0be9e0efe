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
struct scene {
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

static bool ball_lies(const struct scene *scene, int ball)
{
	return ball >= 0 && scene->shot->start_on[ball];
}

static vec2 ball_start(const struct scene *scene, int ball)
{
	return (vec2){scene->shot->start_x[ball], scene->shot->start_y[ball]};
}

static int cue_ball(const struct scene *scene)
{
	for (int i = 0; i < scene->ball_count; i++)
		if (scene->plan->colours[i] == COLOUR_WHITE)
			return i;
	return -1;
}

static bool has_room(const billiard_draw_list_t *list, int points)
{
	return list->item_count < DRAW_ITEM_MAX - ITEMS_KEPT &&
	       list->point_count + points < DRAW_POINT_MAX - POINTS_KEPT;
}

/* Parts of a path that cannot be drawn whole are better not drawn at all. */
static void stroke(const struct scene *scene, const vec2 *point, int count, const struct draw_pen *pen)
{
	if (count >= 2 && has_room(scene->list, count))
		draw_field_stroke(&scene->field, scene->list, point, count, pen);
}

static void draw_ghost(const struct scene *scene, vec2 at)
{
	const struct draw_pen pen = {THIN, GHOST_RGBA, false};
	draw_field_ring(&scene->field, scene->list, at, GHOST * scene->table->ball_radius, &pen);
}

static bool falls(const struct scene *scene, int ball)
{
	for (int i = 0; i < scene->shot->potted_count; i++)
		if (scene->shot->potted_ball[i] == ball)
			return true;
	return false;
}

/* Where a ball that moved comes to rest. */
static void draw_end(const struct scene *scene, int ball, const struct draw_path *path, uint32_t rgba)
{
	double radius = scene->table->ball_radius;
	if (path->count < 2 || falls(scene, ball) || vec2_dist(path->point[0], path->point[path->count - 1]) < radius)
		return;
	const struct draw_pen pen = {THIN, rgba, false};
	if (has_room(scene->list, 1))
		draw_field_ring(&scene->field, scene->list, path->point[path->count - 1], radius, &pen);
}

static void draw_cue(const struct scene *scene, int cue)
{
	struct draw_path path;
	draw_path_of(&path, scene->plan, scene->shot, cue);
	int solid = path.contact >= 0 ? path.contact + 1 : path.count;
	stroke(scene, path.point, solid, &(struct draw_pen){LINE, CUE_RGBA, false});
	if (path.contact < 0)
		return;
	draw_ghost(scene, path.point[path.contact]);
	if (!scene->options->other_paths)
		return;
	stroke(scene, path.point + path.contact, path.count - path.contact, &(struct draw_pen){THIN, CUE_RGBA, true});
	draw_end(scene, cue, &path, CUE_RGBA);
}

static void draw_object(const struct scene *scene, int ball, bool dashed)
{
	struct draw_path path;
	draw_path_of(&path, scene->plan, scene->shot, ball);
	struct draw_pen pen = {dashed ? THIN : LINE, draw_ball_rgba(scene->plan->colours[ball]), dashed};
	stroke(scene, path.point, path.count, &pen);
	draw_end(scene, ball, &path, pen.rgba);
}

/* A shot whose keyframes did not fit: straight from ball to ball as far as the start position tells. */
static void draw_without_keyframes(const struct scene *scene, int cue)
{
	int target = scene->shot->target, pocket = scene->shot->pocket;
	double angle = scene->shot->angle;
	if (ball_lies(scene, cue)) {
		vec2 from = ball_start(scene, cue);
		vec2 aim[2] = {from, vec2_madd(from, scene->table->width / 2, vec2_from_angle(angle))};
		stroke(scene, aim, 2, &(struct draw_pen){LINE, CUE_RGBA, false});
	}
	if (scene->shot->rails == 0 && ball_lies(scene, target) && pocket >= 0) {
		vec2 way[2] = {ball_start(scene, target), scene->table->pocket[pocket].centre};
		stroke(scene, way, 2, &(struct draw_pen){LINE, draw_ball_rgba(scene->plan->colours[target]), false});
	}
}

static void draw_paths(const struct scene *scene)
{
	int cue = cue_ball(scene), target = scene->shot->target;
	if (scene->shot->keyframe_count == 0) {
		draw_without_keyframes(scene, cue);
		return;
	}
	if (ball_lies(scene, cue))
		draw_cue(scene, cue);
	if (target != cue && ball_lies(scene, target))
		draw_object(scene, target, false);
	if (!scene->options->other_paths)
		return;
	for (int i = 0; i < scene->ball_count; i++)
		if (i != cue && i != target && ball_lies(scene, i))
			draw_object(scene, i, true);
}

/* The part of a ring around the pocket that lies on the bed: light on the rails would disturb the markers. */
static void draw_pocket_arc(const struct scene *scene, const struct pocket *pocket, const struct draw_pen *pen)
{
	vec2 arc[POCKET_POINTS];
	int count = 0;
	/* from the side that looks away from the bed, so that what lies on the bed is one piece */
	double begin = atan2(-pocket->normal.y, -pocket->normal.x);
	for (int i = 0; i < POCKET_POINTS; i++) {
		vec2 p = vec2_madd(pocket->centre, POCKET * pocket->radius,
				   vec2_from_angle(begin + i * 2 * acos(-1) / (POCKET_POINTS - 1)));
		if (fabs(p.x) < scene->table->length / 2 && fabs(p.y) < scene->table->width / 2)
			arc[count++] = p;
	}
	stroke(scene, arc, count, pen);
}

static void draw_pocket(const struct scene *scene)
{
	int pocket = scene->shot->pocket, target = scene->shot->target;
	if (pocket < 0)
		return;
	uint32_t rgba = ball_lies(scene, target) ? draw_ball_rgba(scene->plan->colours[target]) : GHOST_RGBA;
	draw_pocket_arc(scene, &scene->table->pocket[pocket], &(struct draw_pen){2 * LINE, rgba, false});
}

/* Speed and angle (counter-clockwise from the way to the black cushion) where the player looks, at the cue ball; the pocket's name at the
 * pocket. */
static void draw_labels(const struct scene *scene, int number, int shots)
{
	char text[64], which[32] = "";
	int pocket = scene->shot->pocket, cue = cue_ball(scene);
	if (shots > 1)
		snprintf(which, sizeof(which), "  %d/%d", number, shots);
	snprintf(text, sizeof(text), "%.1f m/s  %.0f\u00b0%s", scene->shot->speed, scene->shot->angle * RADIAN, which);
	vec2 at_cue = ball_lies(scene, cue) ? ball_start(scene, cue) : (vec2){0, 0};
	draw_field_text(&scene->field, scene->list,
			&(struct draw_label){text, at_cue, TEXT_REACH, TEXT_HEIGHT, TEXT_RGBA});
	if (pocket < 0)
		return;
	const struct pocket *p = &scene->table->pocket[pocket];
	draw_field_text(&scene->field, scene->list,
			&(struct draw_label){p->name, p->centre, POCKET_REACH, POCKET_HEIGHT, TEXT_RGBA});
}

static void draw_infos(const struct scene *scene)
{
	for (int i = 0; i < scene->ball_count; i++) {
		if (!ball_lies(scene, i))
			continue;
		char name[16] = "";
		memcpy(name, scene->plan->names[i], sizeof(name) - 1);
		draw_info(&scene->field, scene->list, ball_start(scene, i), name);
	}
}

void draw_proposal(billiard_draw_list_t *list, const struct table *table, const struct draw_subject *subject,
		   const struct draw_options *options)
{
	const billiard_plan_t *plan = subject->plan;
	const billiard_plan_entry_t *entry = &plan->entries[subject->entry];
	struct scene scene = {list, table, plan, &entry->shots[subject->shot], options, {0}, plan->ball_count};
	draw_clear(list);
	list->plan_id = plan->request_id;
	draw_field_init(&scene.field, table);
	for (int i = 0; i < scene.ball_count; i++)
		if (ball_lies(&scene, i))
			draw_field_add(&scene.field, ball_start(&scene, i));
	if (options->table)
		draw_table(list, table);
	if (options->halo)
		draw_halos(&scene.field, list);
	draw_pocket(&scene);
	draw_paths(&scene);
	if (scene.shot->speed > 0)
		draw_labels(&scene, subject->shot + 1, entry->shot_count);
	if (options->info)
		draw_infos(&scene);
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
