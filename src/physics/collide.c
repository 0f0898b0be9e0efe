#include "physics/collide.h"

#include "physics/cluster.h"
#include "physics/contact.h"
#include "physics/contact_real.h"
#include "physics/motion.h"
#include "physics/tolerances.h"

/* Balls whose contact with this one is due. */
static uint32_t due_partners(const struct sim *sim, int ball, double limit)
{
	uint32_t partners = 0;
	for (int i = 0; i < ball; i++)
		partners |= (uint32_t)(queue_pair(&sim->queue, i, ball) <= limit) << i;
	for (int i = ball + 1; i < sim->ball_count; i++)
		partners |= (uint32_t)(queue_pair(&sim->queue, ball, i) <= limit) << i;
	return partners;
}

void collide_collect(const struct sim *sim, const struct event *first, struct group *group)
{
	double limit = first->time + SAME_INSTANT;
	uint32_t partners[BALL_MAX], done = 0;
	group->balls = 1u << first->ball | 1u << first->other;
	while (done != group->balls) {
		int ball = __builtin_ctz(group->balls & ~done);
		partners[ball] = due_partners(sim, ball, limit);
		group->balls |= partners[ball];
		done |= 1u << ball;
	}
	group->count = 0;
	for (uint32_t low = group->balls; low; low &= low - 1) {
		int a = __builtin_ctz(low);
		uint32_t higher = partners[a] & ~((2u << a) - 1);
		for (; higher && group->count < GROUP_MAX; higher &= higher - 1)
			group->contact[group->count++] = (struct event){first->time, EVENT_BALL_BALL, (int16_t)a,
									(int16_t)__builtin_ctz(higher)};
	}
}

/* ---- energy ---- */

/* Twice the energy per mass, m^2/s^2. */
static double energy(const struct ball *ball, double radius)
{
	double w2 = ball->spin[0] * ball->spin[0] + ball->spin[1] * ball->spin[1] + ball->spin[2] * ball->spin[2];
	return vec2_norm2(ball->vel) + 0.4 * radius * radius * w2;
}

static void scale_motion(struct ball *ball, double k)
{
	ball->vel = vec2_scale(ball->vel, k);
	for (int i = 0; i < 3; i++)
		ball->spin[i] *= k;
}

/* ---- pressing contacts ---- */

/* Separation speed that keeps two bodies apart for a while when they press with acceleration `press`. */
static double lift_speed(const struct sim *sim, double press, double rms_speed)
{
	const struct material *m = &sim->table->material;
	double interval = fmax(PRESS_INTERVAL, PRESS_SHARE * rms_speed / (m->mu_slide * m->gravity));
	double lift = 0.5 * press * interval;
	double most = LIFT_SHARE * rms_speed;
	if (sim->instant_contacts > CASCADE_MAX)
		lift = fmax(lift, CASCADE_LIFT * rms_speed * (sim->instant_contacts - CASCADE_MAX));
	return lift < most ? lift : most;
}

/* Balls that leave a contact slower than the cloth presses them together get the speed to stay apart a while, taken
 * from their own motion: the energy stays. */
static void lift_balls(const struct sim *sim, struct ball *a, struct ball *b)
{
	double r = sim->table->ball_radius;
	vec2 n = vec2_unit(vec2_sub(b->pos, a->pos));
	double press = vec2_dot(vec2_sub(motion_acceleration(a, sim->table), motion_acceleration(b, sim->table)), n);
	double leave = vec2_dot(vec2_sub(b->vel, a->vel), n);
	double before = energy(a, r) + energy(b, r);
	double lift = lift_speed(sim, press, sqrt(before));
	if (leave >= lift)
		return;
	a->vel = vec2_madd(a->vel, -0.5 * (lift - leave), n);
	b->vel = vec2_madd(b->vel, 0.5 * (lift - leave), n);
	double k = sqrt(before / (energy(a, r) + energy(b, r)));
	if (k < 1) {
		scale_motion(a, k);
		scale_motion(b, k);
	}
	contact_set_phase(sim->table, &sim->model, a->phase, a);
	contact_set_phase(sim->table, &sim->model, b->phase, b);
}

static void lift_at_cushion(const struct sim *sim, vec2 normal, struct ball *ball)
{
	bool rolls = ball->phase == BALL_ROLLING;
	if (ball->phase != BALL_SLIDING && !(rolls && sim->table->bed.uneven))
		return; /* a rolling path on a level bed is straight: it leads away for good */
	double r = sim->table->ball_radius;
	double press = -vec2_dot(motion_acceleration(ball, sim->table), normal);
	double leave = vec2_dot(ball->vel, normal);
	double before = energy(ball, r);
	double lift = lift_speed(sim, press, sqrt(before));
	if (rolls)
		lift = fmin(0.5 * press * ROLL_PRESS_INTERVAL, LIFT_SHARE * sqrt(before));
	if (leave >= lift)
		return;
	ball->vel = vec2_madd(ball->vel, lift - leave, normal);
	double k = sqrt(before / energy(ball, r));
	if (k < 1)
		scale_motion(ball, k);
	motion_classify(ball, sim->table);
}

/* ---- contacts of one instant ---- */

struct joint {
	struct ball *a, *b;
	vec2 n;		/* unit, from a to b */
	double target;	/* separation speed after the contact */
	double e;	/* restitution */
	double impulse; /* per mass, so far */
	double change;
};

static double joint_change(const struct joint *j, double share)
{
	double missing = j->target - vec2_dot(vec2_sub(j->b->vel, j->a->vel), j->n);
	double change = 0.5 * share * missing;
	return change > -j->impulse ? change : -j->impulse;
}

/* Projected Jacobi iteration: every contact ends with its own separation speed or without impulse (Moreau's law). All
 * changes of a sweep are found before any is applied: no order among the contacts. */
static void solve_joints(struct joint *joint, int count, double share, double speed)
{
	for (int sweep = 0; sweep < SWEEPS_MAX; sweep++) {
		double largest = 0;
		for (int i = 0; i < count; i++) {
			joint[i].change = joint_change(&joint[i], share);
			largest = fmax(largest, fabs(joint[i].change));
		}
		for (int i = 0; i < count; i++) {
			struct joint *j = &joint[i];
			j->impulse += j->change;
			j->a->vel = vec2_madd(j->a->vel, -j->change, j->n);
			j->b->vel = vec2_madd(j->b->vel, j->change, j->n);
		}
		if (largest <= SWEEP_END * speed)
			break;
	}
}

static int most_contacts(const struct group *group)
{
	int degree[BALL_MAX] = {0}, most = 1;
	for (int i = 0; i < group->count; i++) {
		int a = ++degree[group->contact[i].ball], b = ++degree[group->contact[i].other];
		most = a > most ? a : most;
		most = b > most ? b : most;
	}
	return most;
}

/* Friction of the contacts, each with its own normal impulse and at most its share of the slip; all from the same
 * state. The normal impulses have left the slips as they were but for what one contact's normal is to another's
 * tangent. */
static void rub_joints(const struct table *table, const struct joint *joint, int count, double share)
{
	vec2 impulse[GROUP_MAX];
	for (int i = 0; i < count; i++) {
		const struct joint *j = &joint[i];
		impulse[i] = contact_ball_friction(table, j->a, j->b, j->e * (2 / (1 + j->e) * j->impulse), share);
	}
	for (int i = 0; i < count; i++)
		contact_ball_rub(table, impulse[i], joint[i].a, joint[i].b);
}

static void collide_jointly(struct sim *sim, const struct group *group)
{
	const struct table *table = sim->table;
	struct joint joint[GROUP_MAX];
	enum ball_phase phase[BALL_MAX];
	double speed = 0;
	double left = contact_speed_left(table, &sim->model);
	for (int i = 0; i < sim->ball_count; i++)
		phase[i] = sim->ball[i].phase;
	for (int i = 0; i < group->count; i++) {
		struct ball *a = &sim->ball[group->contact[i].ball], *b = &sim->ball[group->contact[i].other];
		vec2 n = vec2_unit(vec2_sub(b->pos, a->pos));
		double approach = vec2_dot(vec2_sub(a->vel, b->vel), n);
		double e = contact_restitution(table, &sim->model, fmax(approach, 0));
		joint[i] = (struct joint){.a = a, .b = b, .n = n, .target = e * fmax(approach, 0), .e = e};
		speed = fmax(speed, approach);
	}
	double share = 1.0 / most_contacts(group);
	solve_joints(joint, group->count, share, speed);
	if (sim->model.ball == BALL_MODEL_FRICTIONAL)
		rub_joints(table, joint, group->count, share);
	for (int i = 0; i < sim->ball_count; i++) {
		if (!(group->balls >> i & 1))
			continue;
		if (left != 1)
			scale_motion(&sim->ball[i], left);
		contact_set_phase(table, &sim->model, phase[i], &sim->ball[i]);
	}
	for (int i = 0; i < group->count; i++)
		lift_balls(sim, joint[i].a, joint[i].b);
}

/* Of a cluster's pairs those that still touch are held apart; what approaches again is a contact of its own. */
static void lift_cluster(struct sim *sim, const struct group *group)
{
	for (int i = 0; i < group->count; i++) {
		struct ball *a = &sim->ball[group->contact[i].ball], *b = &sim->ball[group->contact[i].other];
		vec2 between = vec2_sub(b->pos, a->pos);
		double touch = 2 * sim->table->ball_radius * (1 + TOUCH);
		if (vec2_norm2(between) <= touch * touch && vec2_dot(vec2_sub(b->vel, a->vel), between) >= 0)
			lift_balls(sim, a, b);
	}
}

void collide_balls(struct sim *sim, struct group *group)
{
	if (cluster_collide(sim, group)) {
		lift_cluster(sim, group);
		return;
	}
	if (group->count > 1) {
		collide_jointly(sim, group);
		return;
	}
	struct ball *a = &sim->ball[group->contact[0].ball], *b = &sim->ball[group->contact[0].other];
	vec2 n = vec2_unit(vec2_sub(b->pos, a->pos));
	bool alone = sim->model.ball != BALL_MODEL_THESIS || sim->instant_contacts <= TOPSPIN_MAX;
	if (!alone)
		collide_jointly(sim, group);
	else if (vec2_dot(vec2_sub(a->vel, b->vel), n) > 0)
		contact_balls(sim->table, &sim->model, a, b);
	if (alone)
		lift_balls(sim, a, b);
}

void collide_cushion(struct sim *sim, int ball, const struct nose *nose)
{
	struct ball *b = &sim->ball[ball];
	if (vec2_dot(b->vel, nose->normal) < 0)
		contact_cushion(sim->table, &sim->model, nose, b);
	lift_at_cushion(sim, nose->normal, b);
}
