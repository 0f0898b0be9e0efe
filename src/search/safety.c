#include "search/safety.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { AIMS = 5, AIM_MAX = 128, SAFETY_RAILS = 2, FAN_ANGLES = 360, FAN_SPEEDS = 2 };

/* m/s that the cue ball should have left on contact. */
static const double CONTACT_SPEED = 0.3;

struct aim {
	double cost;
	struct shot shot;
	int16_t ball;
	uint16_t rails, state;
};

struct aims {
	struct aim aim[AIM_MAX]; /* best first */
	int count, rails;	 /* cushions that an aim may have */
};

static void add_aim(struct aims *aims, const struct aim *aim)
{
	int at = aims->count;
	while (at > 0 && aim->cost < aims->aim[at - 1].cost)
		at--;
	if (at == AIM_MAX)
		return;
	if (aims->count < AIM_MAX)
		aims->count++;
	memmove(&aims->aim[at + 1], &aims->aim[at], (size_t)(aims->count - 1 - at) * sizeof *aim);
	aims->aim[at] = *aim;
}

static double speed_for(const struct scene *scene, const struct way *way)
{
	double v = CONTACT_SPEED;
	for (int i = way->rails; i >= 0; i--) {
		v = candidate_leg_backward(scene, v, way->leg[i], i > 0);
		if (i > 0)
			v /= 1 - scene->table->material.loss_cushion;
	}
	return fmin(v, scene->profile->max_speed);
}

/* The cue ball to ball over a sequence, aimed beside its middle by off radii. */
static void aim_at(struct aims *aims, const struct scene *scene, int state, int ball, double off)
{
	vec2 cue = scene->ball[scene->cue].pos, target = scene->ball[ball].pos;
	double diameter = 2 * scene->table->ball_radius;
	const struct obstacles others = {scene->ball, scene->count, ~(1u << ball | 1u << scene->cue)};
	const struct obstacles all = {scene->ball, scene->count, ~(1u << scene->cue)};
	vec2 side = vec2_scale(vec2_perp(vec2_unit(vec2_sub(target, cue))), off * scene->table->ball_radius);
	struct images images;
	images_init(&images, scene->mirrors, vec2_add(target, side), (vec2){1, 0}, aims->rails);
	for (int s = 0; s < images.count; s++) {
		struct way way;
		if (!images.valid[s] || !way_build(&way, scene->mirrors, &images, s, cue))
			continue;
		bool is_free = true;
		double way2 = 0;
		for (int i = 0; i <= way.rails && is_free; i++) {
			is_free = segment_is_free(&others, way.point[i], way.point[i + 1], diameter);
			way2 += way.leg[i] * way.leg[i];
		}
		vec2 direction = vec2_unit(vec2_sub(way.point[1], way.point[0]));
		struct cost_way terms = {.way2 = way2, .carry = 1, .rails = way.rails, .strikes = true};
		struct aim aim = {
			.cost = cost_search(scene->table, scene->profile, &terms) + fabs(off) / 2,
			.shot = {.angle = atan2(direction.y, direction.x), .speed = speed_for(scene, &way)},
			.ball = (int16_t)ball,
			.rails = (uint16_t)way.rails,
			.state = (uint16_t)state,
		};
		/* A cue over another ball is awkward, not impossible. */
		if (!cue_has_room(scene->table, scene->profile, &all, cue, direction))
			aim.cost += 1;
		if (is_free)
			add_aim(aims, &aim);
	}
}

static bool play(struct planner *planner, const struct aim *aim, struct record *record)
{
	const struct state *state = &planner->task.state[aim->state];
	struct rules_outcome outcome;
	memset(record, 0, sizeof *record);
	record->shot = aim->shot;
	record->target = aim->ball; /* the ball named, for the judge */
	record->chain[0] = (int16_t)planner->task.cue;
	record->rails = aim->rails;
	record->search_cost = aim->cost;
	planner->count[COUNT_SIMS]++;
	bool done = state_play(&planner->task, state, planner->work, record, &outcome);
	record->target = record->pocket = -1;
	record->chain[1] = done ? (int16_t)rules_first_contact(&planner->work->trace, planner->task.cue) : -1;
	record->chain[2] = record->chain[3] = -1;
	record->chain_count = record->chain[1] >= 0 ? 2 : 1;
	record->cost = record->search_cost +
		       cost_result(&planner->def.profile, record->points, record->shot.speed, record->search_cost);
	record->success = NAN;
	return done && !outcome.cue_potted;
}

static void keep(struct planner *planner, const struct aim *aim, const struct record *record)
{
	struct solution solution = solution_make(&planner->task, aim->state, record);
	solutions_add(&planner->results->list[SAFETY_LIST], &solution);
}

/* No aim works: a fan of directions, the first legal shot or else the cheapest foul. */
static bool fan_find(struct planner *planner)
{
	struct record best, record;
	struct aim aim = {.cost = 10, .ball = -1}, best_aim = aim;
	int best_foul = 1000;
	for (int i = 0; i < FAN_SPEEDS * FAN_ANGLES && best_foul > 0 && !budget_is_cancelled(&planner->budget) &&
			(best_foul == 1000 || !budget_is_over(&planner->budget));
	     i++) {
		aim.shot.angle = 2 * M_PI * (i % FAN_ANGLES) / FAN_ANGLES;
		aim.shot.speed = planner->def.profile.max_speed / (i < FAN_ANGLES ? 2 : 1);
		if (!play(planner, &aim, &record) || record.foul >= best_foul)
			continue;
		best = record;
		best_aim = aim;
		best_foul = record.foul;
	}
	if (best_foul < 1000)
		keep(planner, &best_aim, &best);
	return best_foul < 1000;
}

bool safety_find(struct planner *planner, bool thorough)
{
	static const double off[AIMS] = {0, 0.7, -0.7, 1.6, -1.6};
	int rails = planner->task.request->rails > SAFETY_RAILS ? planner->task.request->rails : SAFETY_RAILS;
	struct aims aims = {.rails = thorough ? rails : 0};
	for (int i = 0; i < planner->state_count && planner->task.state[i].parent == NO_STATE; i++) {
		const struct scene *scene = &planner->task.state[i].scene;
		for (int b = 0; b < scene->count; b++)
			for (int a = 0; a < (thorough ? AIMS : 1) && (scene->on >> b & 1); a++)
				aim_at(&aims, scene, i, b, off[a]);
	}
	for (int i = 0; i < aims.count && (i == 0 || !budget_is_over(&planner->budget)); i++) {
		struct record record;
		if (!play(planner, &aims.aim[i], &record) || record.foul != 0)
			continue;
		keep(planner, &aims.aim[i], &record);
		return true;
	}
	return thorough && planner->task.state[0].scene.on != 0 && fan_find(planner);
}
