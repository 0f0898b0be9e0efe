/* Where light may fall: strokes cut away around the balls, places for text. Internal to the draw lists. */
#ifndef BILLIARD_APP_DRAW_FIELD_H
#define BILLIARD_APP_DRAW_FIELD_H

#include "app/draw.h"

/* The balls as they lie while the picture is shown. */
struct draw_field {
	const struct table *table;	/* borrowed */
	vec2 ball[BALL_MAX];		/* m */
	int count;
	double keep;			/* m around a ball's centre that stay dark */
};

struct draw_pen {
	double width;			/* m */
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
/* Text in the free place nearest to `near` (of the text's centre) on the bed: clear of balls and of everything in the list. Not drawn (false)
 * when there is none within reach (m) or the list is full. */
bool draw_field_text(const struct draw_field *field, billiard_draw_list_t *list, vec2 near, double reach, double height,
		     const char *text);

#endif
