#include "app/light/render.h"

#include <cairo.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/text.h"
#include "app/light/draw.h"
#include "app/light/keyframe.h"
#include "app/light/picture.h"

/* Names: px_ is a place in the picture, everything else is in table metres. */

struct render {
	struct config_projector projector;
	cairo_surface_t *surface;
	cairo_t *cairo;
};

enum { SIZE_MAX_PX = 8192, CIRCLE_POINTS = 72 };
static const double PI = 3.14159265358979323846;
static const double ANIMATED_WIDTH = 0.004; /* m */

static int fail(char *err, size_t err_size, int code, const char *reason)
{
	snprintf(err, err_size, "projector: %s", reason);
	return code;
}

/* ---- table to picture ---- */

/* False for points behind the projector or so far away that Cairo's numbers end. */
static bool to_px(const struct render *render, vec2 p, vec2 *px)
{
	const double *h = render->projector.homography;
	double w = h[6] * p.x + h[7] * p.y + h[8];
	if (!(w > 1e-9))
		return false;
	*px = (vec2){(h[0] * p.x + h[1] * p.y + h[2]) / w, (h[3] * p.x + h[4] * p.y + h[5]) / w};
	return fabs(px->x) < 32000 && fabs(px->y) < 32000;
}

/* Columns of the local affine map at p: px per m along x and along y. */
static bool jacobian(const struct render *render, vec2 p, vec2 *along_x, vec2 *along_y)
{
	const double step = 1e-3;
	vec2 o, x, y;
	if (!to_px(render, p, &o) || !to_px(render, (vec2){p.x + step, p.y}, &x) ||
	    !to_px(render, (vec2){p.x, p.y + step}, &y))
		return false;
	*along_x = vec2_scale(vec2_sub(x, o), 1 / step);
	*along_y = vec2_scale(vec2_sub(y, o), 1 / step);
	return true;
}

/* Mean px per m at p; 0 where nothing can be drawn. */
static double scale_at(const struct render *render, vec2 p)
{
	vec2 x, y;
	return jacobian(render, p, &x, &y) ? sqrt(fabs(vec2_cross(x, y))) : 0;
}

static void set_rgba(cairo_t *cairo, uint32_t rgba)
{
	cairo_set_source_rgba(cairo, (rgba >> 24) / 255.0, (rgba >> 16 & 255) / 255.0, (rgba >> 8 & 255) / 255.0,
			      (rgba & 255) / 255.0);
}

/* Appends p to the current path. */
static bool line_to(const struct render *render, vec2 p)
{
	vec2 px;
	if (!to_px(render, p, &px))
		return false;
	cairo_line_to(render->cairo, px.x, px.y);
	return true;
}

/* A whole path or none: half of a path behind the projector is nothing to show. */
static bool path_points(const struct render *render, const billiard_draw_list_t *list, const billiard_draw_item_t *item)
{
	cairo_new_path(render->cairo);
	for (int i = item->point_first; i < item->point_first + item->point_count; i++)
		if (!line_to(render, (vec2){list->xs[i], list->ys[i]}))
			return false;
	return true;
}

static bool path_circle(const struct render *render, vec2 centre, double radius)
{
	cairo_new_path(render->cairo);
	for (int i = 0; i < CIRCLE_POINTS; i++)
		if (!line_to(render, vec2_madd(centre, radius, vec2_from_angle(2 * PI * i / CIRCLE_POINTS))))
			return false;
	cairo_close_path(render->cairo);
	return true;
}

static void stroke(const struct render *render, vec2 at, double width, double dash, double gap)
{
	double scale = scale_at(render, at);
	if (!(scale > 0)) { /* too far out for a width */
		cairo_new_path(render->cairo);
		return;
	}
	double dashes[2] = {dash * scale, gap * scale};
	cairo_set_line_width(render->cairo, fmax(1, width * scale));
	cairo_set_dash(render->cairo, dashes, dashes[0] > 0 && dashes[1] > 0 ? 2 : 0, 0);
	cairo_stroke(render->cairo);
}

/* ---- items ---- */

static void draw_text_item(const struct render *render, const billiard_draw_item_t *item, vec2 at)
{
	vec2 px, x, y;
	char text[sizeof(item->text)];
	/* What is no UTF-8 would put an end to all drawing. */
	text_get(text, sizeof text, item->text, sizeof item->text);
	if (!to_px(render, at, &px) || !jacobian(render, at, &x, &y) || !(item->radius > 0))
		return;
	/* font space: one unit is one em, its y axis runs down */
	cairo_matrix_t matrix = {
		x.x * item->radius, x.y * item->radius, -y.x * item->radius, -y.y * item->radius, 0, 0};
	if (fabs(matrix.xx * matrix.yy - matrix.xy * matrix.yx) < 1)
		return;
	cairo_set_font_matrix(render->cairo, &matrix);
	cairo_move_to(render->cairo, px.x, px.y);
	cairo_show_text(render->cairo, text);
}

static void draw_item(const struct render *render, const billiard_draw_list_t *list, const billiard_draw_item_t *item)
{
	vec2 at = {list->xs[item->point_first], list->ys[item->point_first]};
	set_rgba(render->cairo, (uint32_t)item->rgba);
	switch ((enum draw_kind)item->kind) {
	case DRAW_POLYLINE:
		if (path_points(render, list, item))
			stroke(render, at, item->width, item->dash, item->gap);
		break;
	case DRAW_RING:
		if (path_circle(render, at, item->radius))
			stroke(render, at, item->width, item->dash, item->gap);
		break;
	case DRAW_TEXT:
		draw_text_item(render, item, at);
		break;
	}
}

static void draw_layers(const struct render *render, const billiard_draw_list_t *list)
{
	for (int layer = DRAW_LAYER_TABLE; layer <= DRAW_LAYER_TEXT; layer++)
		for (int i = 0; i < list->item_count; i++) {
			const billiard_draw_item_t *item = &list->items[i];
			int own = item->layer < DRAW_LAYER_TABLE ? DRAW_LAYER_TABLE : item->layer;
			if ((own > DRAW_LAYER_TEXT ? DRAW_LAYER_TEXT : own) == layer)
				draw_item(render, list, item);
		}
}

/* ---- animation ---- */

bool render_animated(const billiard_animation_t *animation, int ball, double t, vec2 *pos)
{
	const billiard_keyframe_t *last = NULL;
	bool moved = false;
	for (int i = 0; i < animation->keyframe_count; i++) {
		const billiard_keyframe_t *key = &animation->keyframes[i];
		if (key->ball != ball || key->begin > t)
			continue;
		moved |= key->vx != 0 || key->vy != 0;
		if (!last || key->begin >= last->begin)
			last = key;
	}
	if (!moved || last->phase == BALL_POTTED)
		return false;
	*pos = keyframe_at(last, fmax(0, fmin(t, last->end) - last->begin));
	return true;
}

static void draw_animation(const struct render *render, const billiard_animation_t *animation, double t)
{
	double radius = animation->ball_radius;
	if (!(radius > 0 && radius < 1))
		return;
	for (int ball = 0; ball < animation->ball_count; ball++) {
		vec2 pos;
		if (!render_animated(animation, ball, t, &pos))
			continue;
		set_rgba(render->cairo, draw_ball_rgba(animation->colours[ball]));
		if (path_circle(render, pos, radius - ANIMATED_WIDTH / 2))
			stroke(render, pos, ANIMATED_WIDTH, 0, 0);
	}
}

/* ---- life ---- */

static int check_projector(const struct config_projector *projector, char *err, size_t err_size)
{
	if (projector->width < 1 || projector->height < 1 || projector->width > SIZE_MAX_PX ||
	    projector->height > SIZE_MAX_PX)
		return fail(err, err_size, -EINVAL, "width and height must be 1 to 8192 px");
	const double *h = projector->homography;
	for (int i = 0; i < 9; i++)
		if (!isfinite(h[i]))
			return fail(err, err_size, -EINVAL, "homography is not finite");
	double det = h[0] * (h[4] * h[8] - h[5] * h[7]) - h[1] * (h[3] * h[8] - h[5] * h[6]) +
		     h[2] * (h[3] * h[7] - h[4] * h[6]);
	if (det == 0 || h[8] <= 0)
		return fail(err, err_size, -EINVAL, "homography is singular or puts the table behind the projector");
	return 0;
}

static void set_defaults(struct render *render)
{
	const char *font = render->projector.font[0] ? render->projector.font : "sans-serif";
	cairo_select_font_face(render->cairo, font, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
	cairo_set_line_join(render->cairo, CAIRO_LINE_JOIN_ROUND);
	cairo_font_options_t *options = cairo_font_options_create();
	cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
	cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
	cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
	cairo_set_font_options(render->cairo, options);
	cairo_font_options_destroy(options);
}

int render_create(struct render **out, const struct config_projector *projector, char *err, size_t err_size)
{
	*out = NULL;
	int status = check_projector(projector, err, err_size);
	if (status < 0)
		return status;
	struct render *render = calloc(1, sizeof(*render));
	if (!render)
		return fail(err, err_size, -ENOMEM, "no memory");
	render->projector = *projector;
	render->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, projector->width, projector->height);
	render->cairo = cairo_create(render->surface);
	if (cairo_status(render->cairo) != CAIRO_STATUS_SUCCESS) {
		render_destroy(render);
		return fail(err, err_size, -ENOMEM, "no memory for the picture");
	}
	set_defaults(render);
	*out = render;
	return 0;
}

void render_destroy(struct render *render)
{
	if (!render)
		return;
	cairo_destroy(render->cairo);
	cairo_surface_destroy(render->surface);
	free(render);
}

/* ---- pictures ---- */

void render_draw(struct render *render, const billiard_draw_list_t *list, const billiard_animation_t *animation,
		 double t)
{
	cairo_set_source_rgb(render->cairo, 0, 0, 0);
	cairo_paint(render->cairo);
	draw_layers(render, list);
	if (animation)
		draw_animation(render, animation, t);
	cairo_surface_flush(render->surface);
}

const uint32_t *render_pixels(const struct render *render, int *width, int *height, int *stride)
{
	*width = render->projector.width;
	*height = render->projector.height;
	*stride = cairo_image_surface_get_stride(render->surface);
	return (const uint32_t *)(const void *)cairo_image_surface_get_data(render->surface);
}

int render_write_png(struct render *render, const char *path, char *err, size_t err_size)
{
	return picture_save_png(render->cairo, path, err, err_size);
}
