#include "vision/stabilise.h"

enum { MEAN_MAX = 100, REST_FRAMES = 3 };
static const double REST_GATE = 3, JUMP_GATE = 8; /* times the noise */

struct stabiliser stabilise_begin(vec2 raw, double time)
{
	return (struct stabiliser){
		.pos = raw, .mean = raw, .mean_count = 1, .raw = {raw}, .time = {time}, .raw_count = 1};
}

static void remember(struct stabiliser *s, vec2 raw, double time)
{
	if (s->raw_count < STABILISE_HISTORY)
		s->raw_count++;
	for (int i = s->raw_count - 1; i > 0; i--) {
		s->raw[i] = s->raw[i - 1];
		s->time[i] = s->time[i - 1];
	}
	s->raw[0] = raw;
	s->time[0] = time;
}

/* Over the last three positions; over two right after the start. */
static vec2 velocity(const struct stabiliser *s)
{
	int last = s->raw_count < 3 ? s->raw_count - 1 : 2;
	double dt = last > 0 ? s->time[0] - s->time[last] : 0;
	return dt > 0 ? vec2_scale(vec2_sub(s->raw[0], s->raw[last]), 1 / dt) : (vec2){0, 0};
}

static bool has_come_to_rest(const struct stabiliser *s, double noise)
{
	if (s->raw_count < REST_FRAMES)
		return false;
	for (int i = 1; i < REST_FRAMES; i++)
		if (vec2_dist(s->raw[0], s->raw[i]) > REST_GATE * noise)
			return false;
	return true;
}

static void rest(struct stabiliser *s)
{
	s->moving = false;
	s->mean = (vec2){0, 0};
	s->mean_count = REST_FRAMES;
	for (int i = 0; i < REST_FRAMES; i++)
		s->mean = vec2_madd(s->mean, 1.0 / REST_FRAMES, s->raw[i]);
	s->away = 0;
}

static void add_resting(struct stabiliser *s, vec2 raw, double noise)
{
	double far = vec2_dist(raw, s->mean);
	if (far < REST_GATE * noise) {
		s->away = 0;
		if (s->mean_count < MEAN_MAX)
			s->mean_count++;
		s->mean = vec2_madd(s->mean, 1.0 / s->mean_count, vec2_sub(raw, s->mean));
	} else if (++s->away >= 2 || far > JUMP_GATE * noise) {
		s->moving = true;
	}
}

void stabilise_add(struct stabiliser *s, vec2 raw, double time, double noise)
{
	remember(s, raw, time);
	if (!s->moving)
		add_resting(s, raw, noise);
	else if (has_come_to_rest(s, noise))
		rest(s);
	s->pos = s->moving ? raw : s->mean;
	s->vel = s->moving ? velocity(s) : (vec2){0, 0};
}

vec2 thesis_stabilise(struct thesis_stabiliser *s, vec2 raw, double max_distance, int least)
{
	int last = (s->next + THESIS_HISTORY - 1) % THESIS_HISTORY;
	if (s->count > 0 && vec2_dist(raw, s->raw[last]) > max_distance)
		s->count = s->next = 0;
	s->raw[s->next] = raw;
	s->next = (s->next + 1) % THESIS_HISTORY;
	s->count += s->count < THESIS_HISTORY;
	if (s->count < least)
		return raw;
	vec2 mean = {0, 0};
	for (int i = 0; i < s->count; i++)
		mean = vec2_madd(mean, 1.0 / s->count, s->raw[i]);
	double f = vec2_dist(raw, mean) / max_distance;
	f = f < 1 ? f : 1;
	return vec2_madd(vec2_scale(raw, f), 1 - f, mean);
}
