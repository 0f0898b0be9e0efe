/* Whether a ball on can be struck at both of its edges past the balls not on. */
#include "search/geometry.h"
#include "search/respot.h"
#include "search/rules.h"

/* The straight way of the cue ball to one edge of ball index is free; side: 1 or -1. */
static bool edge_is_free(const struct table *table, const struct obstacles *others, vec2 cue, vec2 ball, double side)
{
	double diameter = 2 * table->ball_radius;
	vec2 to = vec2_sub(ball, cue);
	double distance = vec2_norm(to);
	if (distance <= diameter)
		return true; /* touching */
	double along = sqrt(distance * distance - diameter * diameter);
	vec2 ahead = vec2_scale(to, 1 / distance);
	/* where the cue ball is when it just touches that edge */
	vec2 end = vec2_madd(cue, along * along / distance, ahead);
	end = vec2_madd(end, side * along * diameter / distance, vec2_perp(ahead));
	return segment_is_free(others, cue, end, diameter);
}

static bool is_snookered_at(const struct table *table, const struct rules_state *state, const struct ball *ball,
			    int count, vec2 cue)
{
	uint32_t on = 0, white = 0;
	for (int i = 0; i < count; i++) {
		on |= (uint32_t)rules_ball_on(state, ball, count, i) << i;
		white |= (uint32_t)(ball[i].colour == COLOUR_WHITE) << i;
	}
	const struct obstacles others = {ball, count, ~(on | white)};
	for (int i = 0; i < count; i++)
		if ((on >> i & 1) && edge_is_free(table, &others, cue, ball[i].pos, 1) &&
		    edge_is_free(table, &others, cue, ball[i].pos, -1))
			return false;
	return on != 0;
}

/* From the D, a grid of a third of a ball. */
static bool is_snookered_in_hand(const struct table *table, const struct rules_state *state, const struct ball *ball,
				 int count)
{
	double step = 2 * table->ball_radius / 3, radius = table->baulk_d_radius;
	struct ball others[BALL_MAX];
	for (int i = 0; i < count; i++) {
		others[i] = ball[i];
		if (ball[i].colour == COLOUR_WHITE)
			others[i].phase = BALL_POTTED;
	}
	for (double x = 0; x <= radius; x += step)
		for (double y = -radius; y <= radius; y += step) {
			vec2 at = vec2_add(table->baulk_d_centre, (vec2){-x, y});
			if (hypot(x, y) <= radius && respot_is_free(table, others, count, at) &&
			    !is_snookered_at(table, state, others, count, at))
				return false;
		}
	return true;
}

bool rules_is_snookered(const struct table *table, const struct rules_state *state, const struct ball *ball, int count)
{
	if (state->in_hand)
		return is_snookered_in_hand(table, state, ball, count);
	for (int i = 0; i < count; i++)
		if (ball[i].colour == COLOUR_WHITE && ball[i].phase != BALL_POTTED)
			return is_snookered_at(table, state, ball, count, ball[i].pos);
	return false;
}
