#include "search_scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes.h"

struct plan_request scene_request(const struct ball *ball, int count)
{
	struct plan_request request = plan_request_default();
	memcpy(request.ball, ball, (size_t)count * sizeof *ball);
	request.ball_count = count;
	request.state = rules_state_from_position(ball, count);
	request.balls = 3;
	request.plans = PLAN_MAX;
	request.tolerances = 0;
	return request;
}

static enum ball_colour colour_of(int index, int count)
{
	if (index == 0)
		return COLOUR_WHITE;
	int from_end = count - 1 - index;
	return count >= 8 && from_end < 6 ? (enum ball_colour)(COLOUR_BLACK - from_end) : COLOUR_RED;
}

void scene_random(struct random *random, const struct table *table, double gap, struct ball *ball, int count)
{
	double x = table->length / 2 - table->ball_radius, y = table->width / 2 - table->ball_radius;
	for (int i = 0; i < count;) {
		vec2 pos = {random_in(random, -x, x), random_in(random, -y, y)};
		bool is_free = true;
		for (int k = 0; k < i; k++)
			is_free &= vec2_dist(pos, ball[k].pos) > 2 * table->ball_radius + gap;
		for (int p = 0; p < table->pocket_count; p++)
			is_free &=
				vec2_dist(pos, table->pocket[p].centre) > table->pocket[p].radius + table->ball_radius;
		if (is_free) {
			ball[i] = ball_at(colour_of(i, count), pos);
			i++;
		}
	}
}

void scene_after_break(const struct table *table, int variant, struct ball ball[BALL_MAX])
{
	static struct sim sim;
	struct model model;
	model_from_name("simple", &model);
	scene_rack(table, ball);
	ball[0].pos.y += 1e-3 + 3e-3 * variant;
	vec2 way = vec2_sub(table->spot[COLOUR_PINK], ball[0].pos);
	sim_init(&sim, table, &model, ball, BALL_MAX);
	sim_strike(&sim, 0, &(struct shot){.angle = atan2(way.y, way.x + 2 * table->ball_radius), .speed = 3.5});
	sim_run(&sim, &(struct sim_limits){.max_time = INFINITY, .max_events = 100000}, NULL);
	for (int i = 0; i < BALL_MAX; i++)
		ball[i] = sim_ball(&sim, i);
}

struct planner *scene_planner(const struct table *table, const char *model, const struct cost_profile *profile,
			      int workers)
{
	struct planner_def def = planner_def_default();
	struct planner *planner = NULL;
	def.table = table;
	def.workers = workers;
	if (profile)
		def.profile = *profile;
	if (!model_from_name(model, &def.model) || planner_create(&planner, &def) != 0) {
		fprintf(stderr, "no planner for model %s\n", model);
		abort();
	}
	return planner;
}

struct plan_result scene_run(struct planner *planner, const struct plan_request *request)
{
	struct plan_result result;
	char err[200];
	int rc = planner_run(planner, request, NULL, NULL, &result, err, sizeof err);
	if (rc != 0) {
		fprintf(stderr, "planner_run: %d: %s\n", rc, rc < 0 ? err : "");
		abort();
	}
	return result;
}

static uint64_t fold(uint64_t hash, const void *data, size_t size)
{
	const unsigned char *byte = data;
	for (size_t i = 0; i < size; i++)
		hash = (hash ^ byte[i]) * 0x100000001b3u;
	return hash;
}

uint64_t scene_hash(const struct plan_result *result, int ball_count)
{
	uint64_t hash = 0xcbf29ce484222325u;
	hash = fold(hash, &result->nodes, sizeof result->nodes);
	hash = fold(hash, &result->sims, sizeof result->sims);
	for (int i = 0; i < result->plan_count; i++) {
		const struct plan *plan = &result->plan[i];
		hash = fold(hash, &plan->cost, sizeof plan->cost);
		for (int s = 0; s < plan->shot_count; s++) {
			const struct plan_shot *shot = &plan->shot[s];
			hash = fold(hash, &shot->shot.angle, sizeof shot->shot.angle);
			hash = fold(hash, &shot->shot.speed, sizeof shot->shot.speed);
			hash = fold(hash, &shot->hash, sizeof shot->hash);
			hash = fold(hash, shot->chain, sizeof shot->chain);
			hash = fold(hash, &shot->tolerance_angle, sizeof shot->tolerance_angle);
			for (int b = 0; b < ball_count; b++)
				hash = fold(hash, &shot->start[b].pos, sizeof shot->start[b].pos);
		}
	}
	return hash;
}
