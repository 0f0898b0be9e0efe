#include "physics/sim.h"

#include <assert.h>
#include <string.h>

#include "physics/bed.h"
#include "physics/collide.h"
#include "physics/motion.h"

/* ---- events that are known in advance (thesis 8.14) ---- */

static struct mover mover(const struct sim *sim, int i)
{
	return (struct mover){&sim->ball[i], &sim->motion[i]};
}

/* A touched ball's motion is new: its own event and its row and column of pairs with it. */
static void renew_motion(struct sim *sim, const struct predictor *by, int i)
{
	sim->motion[i] = predict_motion(sim->table, &sim->ball[i], sim->ball_time[i]);
	struct mover self = mover(sim, i);
	struct event own = predict_own(by, &self, i);
	queue_set_own(&sim->queue, i, &own);
}

/* Pairs of ball i with the others; those with balls in `done` are new already. */
static void renew_pairs(struct sim *sim, const struct predictor *by, int i, uint32_t done)
{
	struct mover self = mover(sim, i);
	for (int k = 0; k < sim->ball_count; k++) {
		if (k == i || done >> k & 1)
			continue;
		struct mover other = mover(sim, k);
		double time = INFINITY;
		if (other.ball->phase != BALL_POTTED && self.ball->phase != BALL_POTTED)
			time = i < k ? predict_pair(by, &self, &other, sim->time)
				     : predict_pair(by, &other, &self, sim->time);
		queue_set_pair(&sim->queue, i < k ? i : k, i < k ? k : i, time);
	}
}

static void renew(struct sim *sim, uint32_t balls)
{
	struct predictor by = {sim->table, &sim->model, &sim->solved};
	for (uint32_t left = balls; left; left &= left - 1)
		renew_motion(sim, &by, __builtin_ctz(left));
	for (uint32_t left = balls; left; left &= left - 1) {
		int i = __builtin_ctz(left);
		renew_pairs(sim, &by, i, balls & ((1u << i) - 1));
	}
}

/* ---- public ---- */

void sim_init(struct sim *sim, const struct table *table, const struct model *model, const struct ball *ball, int count)
{
	assert(count >= 1 && count <= BALL_MAX);
	sim->table = table;
	sim->model = *model;
	sim->time = sim->instant = 0;
	sim->ball_count = count;
	sim->event_count = sim->instant_contacts = 0;
	sim->pending_count = sim->pending_next = 0;
	sim->solved = (struct solve_count){0};
	queue_init(&sim->queue, count);
	for (int i = 0; i < count; i++) {
		assert(ball_is_finite(&ball[i]));
		sim->ball[i] = ball[i];
		sim->ball_time[i] = 0;
		if (sim->ball[i].phase != BALL_POTTED)
			motion_classify(&sim->ball[i], table);
		sim->motion[i] = (struct motion){.end = INFINITY, .straight = true};
	}
	uint32_t moving = 0;
	for (int i = 0; i < count; i++) {
		if (sim->ball[i].phase != BALL_POTTED && sim->ball[i].phase != BALL_REST)
			moving |= 1u << i;
	}
	renew(sim, moving);
}

static void advance(struct sim *sim, int i)
{
	sim->ball[i] = motion_advance_by(&sim->ball[i], sim->table, sim->motion[i].acceleration,
					 sim->time - sim->ball_time[i]);
	sim->ball_time[i] = sim->time;
}

bool shot_is_playable(const struct shot *shot)
{
	return isfinite(shot->angle) && shot->speed > 0 && shot->speed <= SHOT_SPEED_MAX &&
	       shot->side * shot->side + shot->follow * shot->follow < 1 && shot->elevation >= 0 &&
	       shot->elevation < SHOT_ELEVATION_MAX;
}

/* Alciatore TP A.31: the impulse that turns the ball also moves the cue's end aside, and the ball the other way. */
double shot_squirt(const struct table *table, double side)
{
	double end = table->material.cue_end_mass, up = 1 - side * side;
	if (end == 0)
		return 0;
	return atan(2.5 * side * sqrt(up) / (1 + table->ball_mass / end + 2.5 * up));
}

/* Offsets are measured across the cue. side > 0 (left of the line of aim) turns the ball clockwise seen from above,
 * spin z < 0; follow > 0 turns it forward. Instantaneous point impact: spin = 5 v / (2 r) times the offset (Leckie and
 * Greenspan 2006), v the speed along the cue. */
void sim_strike(struct sim *sim, int ball, const struct shot *shot)
{
	assert(ball >= 0 && ball < sim->ball_count && sim->ball[ball].phase != BALL_POTTED);
	assert(shot_is_playable(shot));
	advance(sim, ball);
	struct ball *b = &sim->ball[ball];
	double squirt = shot_squirt(sim->table, shot->side);
	vec2 way = vec2_from_angle(shot->angle - squirt), ahead = vec2_from_angle(shot->angle),
	     right = {ahead.y, -ahead.x};
	double cos_e = cos(shot->elevation), sin_e = sin(shot->elevation);
	double k = sim->model.thesis_motion ? 0 : 2.5 * shot->speed / (cos_e * sim->table->ball_radius);
	vec2 spin = vec2_add(vec2_scale(right, -k * shot->follow), vec2_scale(ahead, -k * shot->side * sin_e));
	b->vel = vec2_scale(way, shot->speed);
	b->spin[0] = spin.x;
	b->spin[1] = spin.y;
	b->spin[2] = -k * shot->side * cos_e;
	motion_classify(b, sim->table);
	renew(sim, 1u << ball);
	assert(sim->pending_count < GROUP_MAX);
	sim->pending[sim->pending_count++] = (struct event){sim->time, EVENT_STRIKE, (int16_t)ball, -1};
}

static void pot(struct ball *ball)
{
	ball->vel = (vec2){0, 0};
	ball->spin[0] = ball->spin[1] = ball->spin[2] = 0;
	ball->phase = BALL_POTTED;
}

static void count_instant(struct sim *sim)
{
	if (sim->time > sim->instant) {
		sim->instant = sim->time;
		sim->instant_contacts = 0;
	}
	sim->instant_contacts++;
}

/* Reports the first contact of the group now, the others one by one after it. */
static void resolve_balls(struct sim *sim, struct event *event)
{
	struct group group;
	collide_collect(sim, event, &group);
	for (int i = 0; i < sim->ball_count; i++) {
		if (group.balls >> i & 1)
			advance(sim, i);
	}
	count_instant(sim);
	collide_balls(sim, &group);
	renew(sim, group.balls);
	*event = group.contact[0];
	for (int i = 1; i < group.count; i++)
		sim->pending[sim->pending_count++] = group.contact[i];
}

static void resolve_own(struct sim *sim, const struct event *event)
{
	int i = event->ball;
	advance(sim, i);
	struct ball *ball = &sim->ball[i];
	if (event->kind == EVENT_CUSHION) {
		const struct cushion *c = &sim->table->cushion[event->other];
		count_instant(sim);
		struct nose nose = table_nose(sim->table, predict_cushion_normal(c, ball->pos), c->nose_height);
		nose.e = c->e > 0 ? c->e : nose.e;
		nose.mu = c->mu > 0 ? c->mu : nose.mu;
		collide_cushion(sim, i, &nose);
	} else if (event->kind == EVENT_JAW) {
		const struct jaw *jaw = &sim->table->jaw[event->other];
		count_instant(sim);
		vec2 normal = vec2_unit(vec2_sub(ball->pos, jaw->centre));
		struct nose nose = table_nose(sim->table, normal, jaw->nose_height);
		collide_cushion(sim, i, &nose);
	} else if (event->kind == EVENT_POCKET) {
		pot(ball);
	} else {
		motion_transition(ball, sim->table, event->kind);
	}
	renew(sim, 1u << i);
}

bool sim_step(struct sim *sim, struct event *event)
{
	if (sim->pending_next < sim->pending_count) {
		*event = sim->pending[sim->pending_next++];
		if (sim->pending_next == sim->pending_count)
			sim->pending_next = sim->pending_count = 0;
		sim->event_count++;
		return true;
	}
	if (!queue_first(&sim->queue, event))
		return false;
	/* an event found up to SAME_INSTANT late may lie behind the present */
	if (event->time < sim->time)
		event->time = sim->time;
	sim->time = event->time;
	if (event->kind == EVENT_BALL_BALL) {
		resolve_balls(sim, event);
	} else {
		resolve_own(sim, event);
	}
	sim->event_count++;
	return true;
}

static void record(struct trace *trace, const struct sim *sim, const struct event *event)
{
	if (trace->count == trace->capacity) {
		trace->overflow = true;
		return;
	}
	struct trace_entry *entry = &trace->entry[trace->count++];
	entry->event = *event;
	entry->after[0] = sim->ball[event->ball];
	entry->after[1] = event->kind == EVENT_BALL_BALL ? sim->ball[event->other] : sim->ball[event->ball];
}

enum sim_end sim_run(struct sim *sim, const struct sim_limits *limits, struct trace *trace)
{
	if (trace) {
		trace->table = sim->table;
		trace->count = 0;
		trace->overflow = false;
		trace->ball_count = sim->ball_count;
		for (int i = 0; i < sim->ball_count; i++)
			trace->start[i] = sim_ball(sim, i);
	}
	struct event event;
	for (int n = 0; n < limits->max_events; n++) {
		if (sim->pending_next == sim->pending_count) {
			if (!queue_first(&sim->queue, &event))
				return SIM_AT_REST;
			if (event.time > limits->max_time)
				return SIM_TIME_LIMIT;
		}
		if (!sim_step(sim, &event))
			return SIM_AT_REST;
		if (trace)
			record(trace, sim, &event);
	}
	return queue_first(&sim->queue, &event) || sim->pending_count ? SIM_EVENT_LIMIT : SIM_AT_REST;
}

struct ball sim_ball(const struct sim *sim, int ball)
{
	return motion_advance_by(&sim->ball[ball], sim->table, sim->motion[ball].acceleration,
				 sim->time - sim->ball_time[ball]);
}

static uint64_t mix(uint64_t hash, uint64_t word)
{
	hash ^= word;
	hash *= 0x9e3779b97f4a7c15u;
	return hash ^ (hash >> 29);
}

static uint64_t mix_double(uint64_t hash, double x)
{
	uint64_t word;
	x += 0.0; /* -0 and 0 are the same state */
	memcpy(&word, &x, sizeof word);
	return mix(hash, word);
}

uint64_t sim_hash(const struct sim *sim, uint64_t seed)
{
	uint64_t hash = mix_double(mix(mix(seed, (uint64_t)sim->ball_count), (uint64_t)sim->event_count), sim->time);
	for (int i = 0; i < sim->ball_count; i++) {
		const struct ball *b = &sim->ball[i];
		const double number[] = {b->pos.x,   b->pos.y,	 b->vel.x,   b->vel.y,
					 b->spin[0], b->spin[1], b->spin[2], sim->ball_time[i]};
		for (size_t k = 0; k < sizeof number / sizeof *number; k++)
			hash = mix_double(hash, number[k]);
		hash = mix(hash, (uint64_t)b->phase << 8 | (uint64_t)b->colour);
	}
	return hash;
}

double sim_energy(const struct sim *sim)
{
	double r = sim->table->ball_radius, sum = 0;
	for (int i = 0; i < sim->ball_count; i++) {
		struct ball b = sim_ball(sim, i);
		double w2 = b.spin[0] * b.spin[0] + b.spin[1] * b.spin[1] + b.spin[2] * b.spin[2];
		if (sim->model.thesis_motion)
			w2 = 0;
		if (b.phase != BALL_POTTED)
			sum += sim->table->ball_mass *
			       (0.5 * (vec2_norm2(b.vel) + 0.4 * r * r * w2) +
				sim->table->material.gravity * bed_height(&sim->table->bed, b.pos));
	}
	return sum;
}
