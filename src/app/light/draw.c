#include "app/light/draw.h"

#include <assert.h>
#include <string.h>

static const double DASH = 0.030, GAP = 0.025; /* m */

struct draw_options draw_options_default(void)
{
	return (struct draw_options){.halo = true, .other_paths = true};
}

uint32_t draw_ball_rgba(int colour)
{
	static const uint32_t rgba[COLOUR_COUNT] = {
		[COLOUR_WHITE] = 0xffffffff, [COLOUR_RED] = 0xff9888ff,	  [COLOUR_YELLOW] = 0xffe040ff,
		[COLOUR_GREEN] = 0x90ffb0ff, [COLOUR_BROWN] = 0xf0b888ff, [COLOUR_BLUE] = 0x90c8ffff,
		[COLOUR_PINK] = 0xffa0c8ff,  [COLOUR_BLACK] = 0xb8b8d0ff, [COLOUR_UNKNOWN] = 0xc0c0c0ff,
	};
	return colour >= 0 && colour < COLOUR_COUNT ? rgba[colour] : rgba[COLOUR_UNKNOWN];
}

void draw_clear(billiard_draw_list_t *list)
{
	memset(list, 0, sizeof(*list));
}

/* A new item on the given points, or NULL when the list is full. */
static billiard_draw_item_t *add(billiard_draw_list_t *list, enum draw_kind kind, enum draw_layer layer,
				 const vec2 *point, int count)
{
	assert(count >= 1);
	if (list->item_count >= DRAW_ITEM_MAX || count > DRAW_POINT_MAX - list->point_count)
		return NULL;
	billiard_draw_item_t *item = &list->items[list->item_count++];
	memset(item, 0, sizeof(*item));
	item->kind = (int8_t)kind;
	item->layer = (int8_t)layer;
	item->point_first = list->point_count;
	item->point_count = count;
	for (int i = 0; i < count; i++) {
		assert(vec2_is_finite(point[i]));
		list->xs[list->point_count] = point[i].x;
		list->ys[list->point_count++] = point[i].y;
	}
	return item;
}

bool draw_polyline(billiard_draw_list_t *list, const vec2 *point, int count, double width, uint32_t rgba)
{
	billiard_draw_item_t *item = add(list, DRAW_POLYLINE, DRAW_LAYER_PATH, point, count);
	if (!item)
		return false;
	item->width = width;
	item->rgba = (int32_t)rgba;
	return true;
}

bool draw_dashed(billiard_draw_list_t *list, const vec2 *point, int count, double width, uint32_t rgba)
{
	if (!draw_polyline(list, point, count, width, rgba))
		return false;
	list->items[list->item_count - 1].dash = DASH;
	list->items[list->item_count - 1].gap = GAP;
	return true;
}

bool draw_ring(billiard_draw_list_t *list, vec2 centre, double radius, double width, uint32_t rgba)
{
	billiard_draw_item_t *item = add(list, DRAW_RING, DRAW_LAYER_HALO, &centre, 1);
	if (!item)
		return false;
	item->radius = radius;
	item->width = width;
	item->rgba = (int32_t)rgba;
	return true;
}

bool draw_text(billiard_draw_list_t *list, vec2 at, double height, uint32_t rgba, const char *text)
{
	billiard_draw_item_t *item = add(list, DRAW_TEXT, DRAW_LAYER_TEXT, &at, 1);
	if (!item)
		return false;
	item->radius = height;
	item->rgba = (int32_t)rgba;
	memcpy(item->text, text, strnlen(text, sizeof(item->text) - 1));
	return true;
}

double draw_text_width(const char *text, double height)
{
	double ems = 0;
	for (; *text; text++)
		ems += strchr(" .,:;-/|!'ijlI", *text) ? 0.42 : strchr("mMwW%@", *text) ? 1.05 : 0.80;
	return ems * height;
}

static bool item_check(const billiard_draw_list_t *list, const billiard_draw_item_t *item)
{
	bool one_point = item->kind == DRAW_RING || item->kind == DRAW_TEXT;
	if (!one_point && item->kind != DRAW_POLYLINE)
		return false;
	if (item->point_first > list->point_count || item->point_count > list->point_count - item->point_first)
		return false;
	return (!one_point || item->point_count == 1) && memchr(item->text, 0, sizeof(item->text)) != NULL;
}

bool draw_check(const billiard_draw_list_t *list)
{
	for (int i = 0; i < list->item_count; i++)
		if (!item_check(list, &list->items[i]))
			return false;
	return true;
}
