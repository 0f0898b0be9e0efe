/* Draw lists: what the projector shows, in table metres. Builders for the pictures of a proposal. Pure. */
#ifndef BILLIARD_APP_DRAW_H
#define BILLIARD_APP_DRAW_H

#include "lcmtypes/billiard_draw_list_t.h"
#include "lcmtypes/billiard_plan_t.h"
#include "physics/table.h"

enum { DRAW_ITEM_MAX = 160, DRAW_POINT_MAX = 2048 };
/* Numbers of the protocol: those between belong to kinds that are no more. */
enum draw_kind { DRAW_POLYLINE = 0, DRAW_RING = 3, DRAW_TEXT = 5 };
/* Drawn from the lowest up; within a layer in the order of the list. */
enum draw_layer { DRAW_LAYER_TABLE, DRAW_LAYER_PATH, DRAW_LAYER_HALO, DRAW_LAYER_TEXT };

/* What of a proposal is drawn (toggles of thesis 4.8). */
struct draw_options {
	bool halo;	  /* rings around the balls */
	bool other_paths; /* dashed paths of the other balls */
	bool table;	  /* cushions and pockets */
	bool info;	  /* position and id beside each ball */
};
struct draw_options draw_options_default(void);

void draw_clear(billiard_draw_list_t *list);
/* Each adds one item; false when the list is full (nothing is added then). rgba 0xRRGGBBAA, lengths in m. */
bool draw_polyline(billiard_draw_list_t *list, const vec2 *point, int count, double width, uint32_t rgba);
bool draw_dashed(billiard_draw_list_t *list, const vec2 *point, int count, double width, uint32_t rgba);
bool draw_ring(billiard_draw_list_t *list, vec2 centre, double radius, double width, uint32_t rgba);
/* at: left end of the baseline, text runs along +x with its top towards +y; height: of the font's em square. Cut at 63
 * bytes. */
bool draw_text(billiard_draw_list_t *list, vec2 at, double height, uint32_t rgba, const char *text);
/* More than the width that any of the fonts in use gives that text at that height, m. */
double draw_text_width(const char *text, double height);

/* Light that stands for a ball of that colour, 0xRRGGBBFF; never black, which a projector cannot show. */
uint32_t draw_ball_rgba(int colour);

/* True when a list whose numbers the bus let through (message_check()) agrees with itself: to be called on every list from the wire. */
bool draw_check(const billiard_draw_list_t *list);

/* One shot of a proposal: plan->entries[entry].shots[shot]. */
struct draw_subject {
	const billiard_plan_t *plan; /* borrowed; plan_check() accepted it */
	int entry, shot;
};
/* Halos on the balls it is played from, ghost ball, solid paths of cue and object ball, dashed paths of the others, a mark at the pocket,
 * speed, angle and pocket as text. table: for radius and pockets. No light falls on or next to a ball: the camera has to see its outline. */
void draw_proposal(billiard_draw_list_t *list, const struct table *table, const struct draw_subject *subject,
		   const struct draw_options *options);

/* The D, in which the cue ball may be placed: dashed, and dark beside the balls. */
void draw_region_in_hand(billiard_draw_list_t *list, const struct table *table, const struct ball *ball, int count);

/* Balls without a proposal, and a line of text at the bottom (empty: none). All borrowed. */
struct draw_resting {
	const struct ball *ball;
	int count;
	const char *note;
};
void draw_idle(billiard_draw_list_t *list, const struct table *table, const struct draw_resting *resting,
	       const struct draw_options *options);

#endif
