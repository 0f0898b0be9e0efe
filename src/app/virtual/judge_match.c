#include "app/virtual/judge_match.h"

#include <math.h>
#include <stdbool.h>

#include "app/process/ball_message.h"

/* How near a real ball a believed one lies that is its double: two tracks of one ball are pushed a diameter apart before they
 * are asked for. In reaches. */
static const double DOUBLE_REACH = 1.25;

void judge_position_from(struct judge_position *out, const billiard_ball_t *ball, int count)
{
	out->count = 0;
	for (int i = 0; i < count; i++) {
		struct ball b = ball_from_message(&ball[i]);
		if (b.phase == BALL_POTTED)
			continue;
		out->ball[out->count].at = b.pos;
		out->ball[out->count].colour = b.colour;
		out->ball[out->count++].track = ball[i].track;
	}
}

static double distance(const struct judge_position *a, int i, const struct judge_position *b, int k)
{
	return vec2_dist(a->ball[i].at, b->ball[k].at);
}

/* The nearest pair of two that have no partner yet; false when none is within reach. */
static bool nearest_pair(const struct judge_position *real, const struct judge_position *believed, double reach,
			 const struct judge_match *match, int pair[2])
{
	double best = reach;
	bool found = false;
	for (int i = 0; i < real->count; i++)
		for (int k = 0; k < believed->count; k++) {
			double d = distance(real, i, believed, k);
			if (match->believed_of[i] >= 0 || match->real_of[k] >= 0 || d > best || (found && d == best))
				continue;
			best = d;
			pair[0] = i, pair[1] = k;
			found = true;
		}
	return found;
}

static bool is_double(const struct judge_position *real, const struct judge_position *believed, int k, double reach)
{
	for (int i = 0; i < real->count; i++)
		if (distance(real, i, believed, k) < DOUBLE_REACH * reach)
			return true;
	return false;
}

void judge_match(const struct judge_position *real, const struct judge_position *believed, double reach,
		 struct judge_match *out)
{
	int pair[2], pairs = 0;
	*out = (struct judge_match){0};
	for (int i = 0; i < BALL_MAX; i++)
		out->real_of[i] = out->believed_of[i] = -1;
	for (; nearest_pair(real, believed, reach, out, pair); pairs++) {
		int i = pair[0], k = pair[1];
		out->believed_of[i] = k;
		out->real_of[k] = i;
		out->colour_wrong += real->ball[i].colour != believed->ball[k].colour;
		out->max_error = fmax(out->max_error, distance(real, i, believed, k));
	}
	out->missing = real->count - pairs;
	out->extra = believed->count - pairs;
	for (int k = 0; k < believed->count; k++)
		out->doubles += out->real_of[k] < 0 && is_double(real, believed, k, reach);
}
