#include "search/respot.h"

#include <stdint.h>

/* m between balls that a respot leaves: "without touching" by the rules, and far below what anything can resolve. */
static const double RESPOT_GAP = 1e-9;

static bool inside(const struct table *table, vec2 pos)
{
	return fabs(pos.x) <= table->length / 2 - table->ball_radius &&
	       fabs(pos.y) <= table->width / 2 - table->ball_radius;
}

bool respot_is_free(const struct table *table, const struct ball *ball, int count, vec2 pos)
{
	double least = 2 * table->ball_radius;
	for (int i = 0; i < count; i++)
		if (ball[i].phase != BALL_POTTED && vec2_norm2(vec2_sub(ball[i].pos, pos)) < least * least)
			return false;
	return inside(table, pos);
}

/* From *pos, the spot, to the free place; way: 1 towards +x, -1 towards -x. *pos is untouched when there is none. */
static bool towards(const struct table *table, const struct ball *ball, int count, double way, vec2 *pos)
{
	const vec2 spot = *pos;
	double least = 2 * table->ball_radius + RESPOT_GAP;
	bool found = false;
	/* The nearest free place is the spot itself or just clear of one of the balls. */
	for (int i = -1; i < count; i++) {
		vec2 place = spot;
		if (i >= 0) {
			double dy = ball[i].pos.y - spot.y;
			if (ball[i].phase == BALL_POTTED || fabs(dy) >= least)
				continue;
			place.x = ball[i].pos.x + way * sqrt(least * least - dy * dy);
		}
		if (way * (place.x - spot.x) >= 0 && (!found || way * (place.x - pos->x) < 0) &&
		    respot_is_free(table, ball, count, place)) {
			*pos = place;
			found = true;
		}
	}
	return found;
}

bool respot_towards_top(const struct table *table, const struct ball *ball, int count, vec2 spot, vec2 *pos)
{
	*pos = spot;
	return towards(table, ball, count, 1, pos);
}

bool respot_towards_bottom(const struct table *table, const struct ball *ball, int count, vec2 spot, vec2 *pos)
{
	*pos = spot;
	return towards(table, ball, count, -1, pos);
}

enum { GRID = 64, CELLS = (2 * GRID + 1) * (2 * GRID + 1) };

struct respot_cell {
	int8_t x, y;
};

bool respot_breadth_first(const struct table *table, const struct ball *ball, int count, vec2 spot, vec2 *pos)
{
	static const struct respot_cell step[] = {{1, 0}, {0, 1}, {0, -1}, {-1, 0}};
	bool seen[2 * GRID + 1][2 * GRID + 1] = {{false}};
	struct respot_cell queue[CELLS];
	int head = 0, tail = 0;
	double width = 2 * table->ball_radius;
	queue[tail++] = (struct respot_cell){0, 0};
	seen[GRID][GRID] = true;
	while (head < tail) {
		struct respot_cell at = queue[head++];
		for (int i = 0; i < 4; i++) {
			struct respot_cell next = {(int8_t)(at.x + step[i].x), (int8_t)(at.y + step[i].y)};
			vec2 place = {spot.x + next.x * width, spot.y + next.y * width};
			if (next.x < -GRID || next.x > GRID || next.y < -GRID || next.y > GRID ||
			    !inside(table, place) || seen[next.x + GRID][next.y + GRID])
				continue;
			if (respot_is_free(table, ball, count, place)) {
				*pos = place;
				return true;
			}
			seen[next.x + GRID][next.y + GRID] = true;
			queue[tail++] = next;
		}
	}
	return false;
}
