#include "search/candidate.h"

#include <assert.h>
#include <stdlib.h>

#include "physics/inverse.h"

/* Aims beside a pocket's middle: across it and towards the bed, shares of its radius; each on both sides. A ball that
 * comes flat along a cushion must fall at the front of a pocket, before it meets the far jaw or the near nose. */
static const struct {
	double across, front;
} aim_place[] = {{0, 0}, {0.5, 0.8}, {0.8, 0}, {0.2, 0.9}, {0.8, 0.5}};
/* What such an aim costs, so that the middle comes first. */
static const double AIM_COST = 0.25;
/* Share of a pocket's radius that the middle of a ball along a cushion may lie off its middle. */
static const double ALONG_SPREAD = 0.8;

/* A ball this near to a cushion (m) cannot be hit so that it goes straight for a pocket along it: the one that strikes
 * it would meet the cushion first. It is played against the cushion by a small angle, and comes off it by the same. */
static const double FROZEN = 2e-3, ALONG_TILT = 0.5 * M_PI / 180;

/* Where to aim a ball at from on a cushion; false when it lies on none or the pocket is not at its end. */
static bool along_point(const struct scene *scene, int pocket, vec2 from, vec2 *point)
{
	const struct pocket *p = &scene->table->pocket[pocket];
	for (int i = 0; i < scene->mirrors->count; i++) {
		const struct mirror *m = &scene->mirrors->mirror[i];
		vec2 along = vec2_perp(m->normal);
		double ahead = vec2_dot(vec2_sub(p->centre, from), along);
		vec2 foot = vec2_madd(from, ahead, along);
		if (vec2_dot(vec2_sub(from, m->point), m->normal) > FROZEN ||
		    vec2_dist(foot, p->centre) > ALONG_SPREAD * p->radius)
			continue;
		*point = vec2_madd(foot, -fabs(ahead) * tan(ALONG_TILT), m->normal);
		return true;
	}
	return false;
}

static vec2 aim_point(const struct scene *scene, int pocket, int aim)
{
	const struct pocket *p = &scene->table->pocket[pocket];
	int place = abs(aim);
	assert(place < (int)(sizeof aim_place / sizeof aim_place[0]));
	double across = aim < 0 ? -aim_place[place].across : aim_place[place].across;
	vec2 point = vec2_madd(p->centre, across * p->radius, vec2_perp(p->normal));
	return vec2_madd(point, aim_place[place].front * p->radius, p->normal);
}

struct node candidate_root(const struct scene *scene, int pocket, int aim)
{
	const struct pocket *p = &scene->table->pocket[pocket];
	double cost = aim != 0 ? AIM_COST : 0;
	return (struct node){
		.cost = cost,
		.search_cost = cost,
		.speed = scene->profile->pocket_speed,
		.carry = 1,
		.to = aim == AIM_ALONG ? p->centre : aim_point(scene, pocket, aim),
		.after = vec2_scale(p->normal, -1),
		.pocket = (int16_t)pocket,
		.aim = (int8_t)aim,
	};
}

/* What a ball that first slides must have of the square of the speed that one has which rolls from the start (4.33). */
static double slide_gain(const struct material *m)
{
	return 49 * m->mu_slide / (49 * m->mu_slide + 24 * (m->mu_roll - m->mu_slide));
}

/* The thesis' program uses the rolling branch of 4.33 for every leg, short ones and those off a cushion too. */
static double program_leg_backward(const struct material *m, double v_end, double way)
{
	return sqrt(slide_gain(m) * (v_end * v_end + 2 * m->gravity * m->mu_roll * way));
}

double candidate_leg_backward(const struct scene *scene, double v_end, double way, bool rolling)
{
	if (scene->profile->program_speed)
		return program_leg_backward(&scene->table->material, v_end, way);
	return rolling ? leg_rolling_backward(scene->table, v_end, way) : leg_backward(scene->table, v_end, way);
}

/* Start speed for an arrival speed over a whole way. */
static double way_backward(const struct scene *scene, const struct way *way, double v)
{
	for (int i = way->rails; i >= 0; i--) {
		v = candidate_leg_backward(scene, v, way->leg[i], i > 0);
		if (i > 0)
			v = cushion_backward(scene->table, v);
	}
	return v;
}

/* Angle terms on arrival: at the target and at each cushion against its normal. */
static double way_angles(const struct way *way, double cos_target)
{
	double sum = cost_angle(cos_target);
	for (int i = 0; i < way->rails; i++) {
		vec2 leg = vec2_sub(way->point[i + 1], way->point[i]);
		sum += cost_angle(-vec2_dot(leg, way->normal[i]) / way->leg[i]);
	}
	return sum;
}

static double way_length2(const struct way *way)
{
	double sum = 0;
	for (int i = 0; i <= way->rails; i++)
		sum += way->leg[i] * way->leg[i];
	return sum;
}

/* No ball stands in the way of ball. The cue ball has left its place by then; balls of the chain are hit on purpose, so
 * for them the clearance does not count, but they must not be met before their turn. */
static bool way_is_free(const struct scene *scene, const struct node *node, const struct way *way, int ball)
{
	double diameter = 2 * scene->table->ball_radius;
	uint32_t chain = 0, struck = 0;
	for (int i = 0; i < node->chain_count; i++)
		chain |= 1u << node->chain[i];
	if (node->chain_count > 0)
		struck = 1u << node->chain[node->chain_count - 1];
	struct obstacles others = {scene->ball, scene->count, ~(chain | 1u << ball | 1u << scene->cue)};
	struct obstacles tight = {scene->ball, scene->count, chain};
	for (int i = 0; i <= way->rails; i++) {
		if (i == way->rails)
			tight.mask &= ~struck;
		if (!segment_is_free(&others, way->point[i], way->point[i + 1], diameter + scene->profile->clearance) ||
		    !segment_is_free(&tight, way->point[i], way->point[i + 1], diameter))
			return false;
	}
	return true;
}

/* A ball that comes in front of a chain: its way there, and the speed that it needs. */
struct link {
	int ball, sequence;
	double cos_target, speed;
	struct way way;
};

static void extend(const struct scene *scene, const struct node *node, const struct link *link, struct node *child)
{
	const struct way *way = &link->way;
	bool is_cue = link->ball == scene->cue;
	vec2 direction = vec2_scale(vec2_sub(way->point[1], way->point[0]), 1 / way->leg[0]);
	struct cost_way terms = {
		.way2 = way_length2(way),
		.carry = is_cue ? node->carry : 1,
		.angles = way_angles(way, link->cos_target),
		.rails = way->rails,
		.strikes = !is_cue,
	};
	double step = cost_search(scene->table, scene->profile, &terms);
	*child = *node;
	child->search_cost += step;
	child->cost += step;
	child->carry = cost_distance(scene->table, way->leg[0] * way->leg[0]);
	child->speed = link->speed;
	child->to = vec2_madd(scene->ball[link->ball].pos, -2 * scene->table->ball_radius, direction);
	child->after = direction;
	child->angle = atan2(direction.y, direction.x);
	child->sequence[child->chain_count] = (uint16_t)link->sequence;
	child->chain[child->chain_count++] = (int8_t)link->ball;
	child->rails = (uint8_t)(child->rails + way->rails);
	child->complete = is_cue;
}

/* One node being expanded, and what all its ways have in common. */
struct expansion {
	const struct scene *scene;
	const struct node *node;
	double cos2; /* square of the cosine of the largest cut */
	double least_gain[PLAN_RAILS_MAX +
			  1]; /* by cushions: the start speed is at least so many times that on arrival */
	struct images images;
};

static void expansion_init(struct expansion *x, const struct scene *scene, const struct node *node)
{
	double cos_max = cos(scene->profile->max_cut);
	double leg = scene->profile->program_speed ? sqrt(slide_gain(&scene->table->material)) : 1;
	x->scene = scene;
	x->node = node;
	x->cos2 = cos_max * cos_max;
	x->least_gain[0] = leg;
	for (int i = 1; i <= PLAN_RAILS_MAX; i++)
		x->least_gain[i] = cushion_backward(scene->table, x->least_gain[i - 1]) * leg;
}

/* Start speed over a way that is built; more than the largest when it has no length. */
static double start_speed(const struct expansion *x, const struct way *way, double arrival)
{
	for (int i = 0; i <= way->rails; i++)
		if (way->leg[i] <= 0)
			return INFINITY;
	double speed = way_backward(x->scene, way, arrival);
	if (x->node->chain_count == 0 && x->node->aim == AIM_ALONG)
		speed = cushion_backward(x->scene->table, speed);
	return speed;
}

/* Ball over one sequence to the node's target: cheap tests first. */
static bool try_way(const struct expansion *x, int ball, int sequence, struct node *child)
{
	const struct scene *scene = x->scene;
	const struct node *node = x->node;
	double most = scene->profile->max_speed;
	vec2 start = scene->ball[ball].pos, d = vec2_sub(x->images.at[sequence], start);
	double along = vec2_dot(d, x->images.direction[sequence]), length2 = vec2_norm2(d);
	if (along <= 0 || along * along <= x->cos2 * length2)
		return false;
	struct link link = {.ball = ball, .sequence = sequence, .cos_target = along / sqrt(length2)};
	double arrival =
		node->chain_count == 0 ? node->speed : hit_backward(scene->table, node->speed, link.cos_target);
	if (arrival * x->least_gain[scene->mirrors->sequence[sequence].length] > most ||
	    !way_build(&link.way, scene->mirrors, &x->images, sequence, start))
		return false;
	link.speed = start_speed(x, &link.way, arrival);
	if (link.speed > most || !way_is_free(scene, node, &link.way, ball))
		return false;
	extend(scene, node, &link, child);
	const struct obstacles all = {scene->ball, scene->count, ~(1u << scene->cue)};
	return !child->complete || cue_has_room(scene->table, scene->profile, &all, start, child->after);
}

/* Which balls may come in front of the chain. */
static uint32_t next_balls(const struct scene *scene, const struct node *node)
{
	uint32_t used = 0;
	for (int i = 0; i < node->chain_count; i++)
		used |= 1u << node->chain[i];
	uint32_t cue = 1u << scene->cue;
	uint32_t balls = 0;
	if (node->chain_count == 0)
		balls = scene->wanted;
	else if (node->chain_count < scene->balls && !scene->named)
		balls = ~used & ~cue;
	if (node->chain_count > 0 && (scene->on >> node->chain[node->chain_count - 1] & 1))
		balls |= cue;
	return balls;
}

/* Where children go. */
struct children {
	struct node *node;
	int capacity, count;
	bool overflow;
};

static void expand_ball(const struct expansion *x, int ball, struct children *out)
{
	for (int s = 0; s < x->images.count; s++) {
		struct node next;
		if (!x->images.valid[s] || !try_way(x, ball, s, &next))
			continue;
		if (out->count < out->capacity)
			out->node[out->count++] = next;
		else
			out->overflow = true;
	}
}

int candidate_expand(const struct scene *scene, const struct node *node, struct node *child, int capacity,
		     bool *overflow)
{
	assert(!node->complete);
	struct expansion x;
	struct children out = {.node = child, .capacity = capacity};
	uint32_t balls = next_balls(scene, node);
	/* The root for balls on cushions: each has an aim of its own, and no cushions in between. */
	bool along = node->chain_count == 0 && node->aim == AIM_ALONG;
	expansion_init(&x, scene, node);
	if (!along)
		images_init(&x.images, scene->mirrors, node->to, node->after, scene->rails);
	for (int b = 0; b < scene->count; b++) {
		vec2 point;
		if (!(balls >> b & 1) || scene->ball[b].phase == BALL_POTTED)
			continue;
		if (along && !along_point(scene, node->pocket, scene->ball[b].pos, &point))
			continue;
		if (along)
			images_init(&x.images, scene->mirrors, point, node->after, 0);
		expand_ball(&x, b, &out);
	}
	*overflow |= out.overflow;
	return out.count;
}

bool candidate_goals(const struct scene *scene, const struct node *node, struct goal goal[PLAN_CHAIN_MAX])
{
	vec2 to = scene->table->pocket[node->pocket].centre;
	if (node->aim != AIM_ALONG)
		to = aim_point(scene, node->pocket, node->aim);
	else
		along_point(scene, node->pocket, scene->ball[node->chain[0]].pos, &to);
	for (int i = 0; i < node->chain_count; i++) {
		struct images images;
		struct way way;
		vec2 start = scene->ball[node->chain[i]].pos;
		images_init(&images, scene->mirrors, to, (vec2){1, 0}, scene->rails);
		if (!images.valid[node->sequence[i]] ||
		    !way_build(&way, scene->mirrors, &images, node->sequence[i], start))
			return false;
		goal[i] = (struct goal){to, way.rails};
		to = vec2_madd(start, -2 * scene->table->ball_radius / way.leg[0], vec2_sub(way.point[1], start));
	}
	return true;
}
