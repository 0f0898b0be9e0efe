#include "app/commands/overlay.h"

#include <cairo.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/light/picture.h"

static const double mm = 1000; /* in a metre */

/* Balls that the detector is less sure of than this are drawn in a warning colour. */
static const double sure = 0.5;

static cairo_surface_t *surface_from(const struct image *frame)
{
	cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, frame->width, frame->height);
	if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
		return surface;
	unsigned char *data = cairo_image_surface_get_data(surface);
	int stride = cairo_image_surface_get_stride(surface);
	for (int y = 0; y < frame->height; y++) {
		const uint8_t *from = frame->data + y * frame->stride;
		uint32_t *to = (uint32_t *)(void *)(data + (ptrdiff_t)y * stride);
		for (int x = 0; x < frame->width; x++, from += 3)
			to[x] = (uint32_t)from[2] << 16 | (uint32_t)from[1] << 8 | from[0];
	}
	cairo_surface_mark_dirty(surface);
	return surface;
}

/* Light on dark, so that it can be read on any picture. Takes the current path or point. */
static void text_at(cairo_t *cr, double x, double y, const char *text)
{
	cairo_move_to(cr, x, y);
	cairo_text_path(cr, text);
	cairo_set_source_rgb(cr, 0, 0, 0);
	cairo_set_line_width(cr, 3);
	cairo_stroke_preserve(cr);
	cairo_set_source_rgb(cr, 1, 1, 1);
	cairo_fill(cr);
}

/* Straight on the table is straight in the picture only without lens distortion: hence in steps. */
static void bed_line(cairo_t *cr, const struct camera *camera, vec2 a, vec2 b)
{
	enum { STEPS = 20 };
	for (int i = 0; i <= STEPS; i++) {
		vec2 px;
		if (camera_project(camera, vec2_madd(a, (double)i / STEPS, vec2_sub(b, a)), 0, &px))
			cairo_line_to(cr, px.x + 0.5, px.y + 0.5);
	}
	cairo_stroke(cr);
}

static void draw_table(cairo_t *cr, const struct camera *camera, const struct table *table)
{
	enum { STEPS = 48 };
	cairo_set_source_rgba(cr, 0.2, 0.9, 1, 0.8);
	cairo_set_line_width(cr, 1);
	for (int i = 0; i < table->cushion_count; i++)
		bed_line(cr, camera, table->cushion[i].a, table->cushion[i].b);
	for (int i = 0; i < table->pocket_count; i++) {
		for (int k = 0; k <= STEPS; k++) {
			vec2 px, at = vec2_madd(table->pocket[i].centre, table->pocket[i].radius,
						vec2_from_angle(2 * M_PI * k / STEPS));
			if (camera_project(camera, at, 0, &px))
				cairo_line_to(cr, px.x + 0.5, px.y + 0.5);
		}
		cairo_stroke(cr);
	}
}

static void draw_ball(cairo_t *cr, const struct vision_ball *ball)
{
	if (ball->confidence < sure)
		cairo_set_source_rgb(cr, 1, 0.2, 0.2);
	else
		cairo_set_source_rgb(cr, 0.2, 1, 0.2);
	cairo_set_line_width(cr, 1);
	cairo_new_path(cr);
	cairo_arc(cr, ball->px.x + 0.5, ball->px.y + 0.5, fmax(ball->radius_px, 1), 0, 2 * M_PI);
	cairo_stroke(cr);
	char label[64];
	snprintf(label, sizeof label, "%s %.2f", ball_colour_name(ball->colour), ball->confidence);
	text_at(cr, ball->px.x + ball->radius_px + 2, ball->px.y - 2, label);
	snprintf(label, sizeof label, "rim %.2f", ball->rim_support);
	text_at(cr, ball->px.x + ball->radius_px + 2, ball->px.y + 10, label);
}

/* Reasons get letters, told at the top of the picture: written out beside each cross they would hide what they speak
 * of. */
enum { REASON_MAX = 8 };
struct legend {
	const char *reason[REASON_MAX];
	int seen[REASON_MAX];
	int count;
};

/* Index of the reason in the legend, which takes it up when it is new. */
static int legend_entry(struct legend *legend, const char *reason)
{
	int i = 0;
	while (i < legend->count && strcmp(legend->reason[i], reason) != 0)
		i++;
	if (i == REASON_MAX)
		return REASON_MAX - 1;
	if (i == legend->count) {
		legend->reason[i] = reason;
		legend->count++;
	}
	legend->seen[i]++;
	return i;
}

static void draw_refusal(cairo_t *cr, const struct overlay *overlay, const struct vision_refusal *refused,
			 struct legend *legend)
{
	const double arm = 4;
	vec2 px;
	int letter = 'a' + legend_entry(legend, refused->reason);
	if (!camera_project(&overlay->result->camera, refused->pos, overlay->table->ball_radius, &px))
		return;
	cairo_set_source_rgb(cr, 1, 0.3, 0.9);
	cairo_set_line_width(cr, 1.5);
	cairo_move_to(cr, px.x - arm, px.y - arm);
	cairo_line_to(cr, px.x + arm, px.y + arm);
	cairo_move_to(cr, px.x - arm, px.y + arm);
	cairo_line_to(cr, px.x + arm, px.y - arm);
	cairo_stroke(cr);
	char label[32];
	snprintf(label, sizeof label, "%c %.2f", letter, refused->rim_support);
	text_at(cr, px.x + arm + 1, px.y + arm, label);
}

static void draw_refusals(cairo_t *cr, const struct overlay *overlay)
{
	struct legend legend = {.count = 0};
	cairo_set_font_size(cr, 8);
	for (int i = 0; i < overlay->refused_count; i++)
		draw_refusal(cr, overlay, &overlay->refused[i], &legend);
	cairo_set_font_size(cr, 12);
	for (int i = 0; i < legend.count; i++) {
		char line[96];
		snprintf(line, sizeof line, "x %c: refused, %s (%d); rim share", 'a' + i, legend.reason[i],
			 legend.seen[i]);
		text_at(cr, 10, 62 + 15 * i, line);
	}
}

static void draw_state(cairo_t *cr, const struct vision_result *result)
{
	char line[160];
	cairo_set_font_size(cr, 16);
	if (result->calibration == CALIBRATION_NONE)
		snprintf(line, sizeof line, "not calibrated: %s", result->reason);
	else
		snprintf(line, sizeof line, "%d markers, residual %.2f px = %.2f mm", result->markers_seen,
			 result->residual_px, result->residual * mm);
	text_at(cr, 10, 22, line);
	snprintf(line, sizeof line, "%d balls%s", result->ball_count,
		 result->occluded ? ", something covers the table" : "");
	text_at(cr, 10, 44, line);
}

static void draw(cairo_t *cr, const struct overlay *overlay)
{
	const struct vision_result *result = overlay->result;
	cairo_select_font_face(cr, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
	if (result->calibration != CALIBRATION_NONE) {
		draw_table(cr, &result->camera, overlay->table);
		draw_refusals(cr, overlay);
	}
	cairo_set_font_size(cr, 10);
	for (int i = 0; i < result->ball_count; i++)
		draw_ball(cr, &result->ball[i]);
	draw_state(cr, result);
}

int overlay_write(const struct overlay *overlay, const char *path, char *err, size_t err_size)
{
	cairo_surface_t *surface = surface_from(overlay->frame);
	cairo_t *cr = cairo_create(surface);
	draw(cr, overlay);
	int code = picture_save_png(cr, path, err, err_size);
	cairo_destroy(cr);
	cairo_surface_destroy(surface);
	return code;
}
