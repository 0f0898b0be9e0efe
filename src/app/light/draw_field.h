/* Where light may fall: strokes cut away around the balls, places for text. Internal to the draw lists. */
#ifndef BILLIARD_APP_DRAW_FIELD_H
#define BILLIARD_APP_DRAW_FIELD_H

#include "app/light/draw.h"

/* The balls as they lie while the picture is shown. */
struct draw_field {
	const struct table *table; /* borrowed */
	vec2 ball[BALL_MAX];	   /* m */
	int count;
	double keep; /* m around a ball's centre that stay dark */
};

struct draw_pen {
	double width; /* m */
	uint32_t rgba;
	bool dashed;
};

/* keep is chosen so that a camera above the table sees a dark rim around every ball, also in the corners. */
void draw_field_init(struct draw_field *field, const struct table *table);
void draw_field_add(struct draw_field *field, vec2 ball);

/* The parts of the line that lie outside all kept discs, as polylines. False when the list is full. */
bool draw_field_stroke(const struct draw_field *field, billiard_draw_list_t *list, const vec2 *point, int count,
		       const struct draw_pen *pen);
/* The same for a ring; a DRAW_RING when no ball is near. */
bool draw_field_ring(const struct draw_field *field, billiard_draw_list_t *list, vec2 centre, double radius,
		     const struct draw_pen *pen);
/* A text that goes where it disturbs nothing. */
struct draw_label {
	const char *text;
	vec2 near;     /* m, where its middle should be */
	double reach;  /* m, how far from there it may be */
	double height; /* m; it is drawn smaller, down to half of this, before it is left out */
	uint32_t rgba;
};
/* Puts it in the nearest free place on the bed: clear of balls, pockets and everything in the list but the table's own
 * lines. False when there is none or the list is full. */
bool draw_field_text(const struct draw_field *field, billiard_draw_list_t *list, const struct draw_label *label);

#endif
