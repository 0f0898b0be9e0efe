#include "physics/cluster.h"

#include "physics/contact.h"
#include "physics/motion.h"
#include "physics/tolerances.h"

/* A ball of the cluster. Friction and spin as in contact_ball_real.c; forces are per mass. */
struct body {
	vec2 pos, vel;	/* m, m/s */
	double spin[3]; /* rad/s */
	vec2 pull;	/* m/s^2, of all its contacts */
	vec2 rub;	/* m/s, friction of the step */
	double turn[3]; /* rad/s, the same */
	int8_t ball;	/* index in the simulation */
	bool touched;
};

/* Two bodies that may touch. */
struct bond {
	int8_t a, b;
	bool touched;
	double length; /* m, centre distance at which they touch */
};

struct cluster {
	struct body body[BALL_MAX];
	struct bond bond[GROUP_MAX];
	int body_count, bond_count, active;
	int8_t begun[GROUP_MAX]; /* bonds in the order in which their contacts began */
	int begun_count;
	double stiffness; /* m^-1/2 s^-2, force per mass of one ball and d^(3/2) */
	double damping;	  /* the same for d^(1/4) and the speed of approach */
	double share;	  /* of the normal impulse, that friction is taken of: 2 e / (1 + e) */
	double dt;	  /* s */
	const struct table *table;
};

/* ---- Hertz's contact ---- */

/* k / m: 4/3 of half the modulus, the root of half the radius. */
static double stiffness_of(const struct table *table)
{
	return 4.0 / 3 * (0.5 * table->material.hertz_modulus) * sqrt(0.5 * table->ball_radius) / table->ball_mass;
}

/* s, how long two balls touch that meet with this speed, alone: 2.943 times the depth over the speed. Their relative
 * acceleration is twice what each has. */
static double contact_time(double stiffness, double speed)
{
	double depth = pow(1.25 * speed * speed / (2 * stiffness), 0.4);
	return 2.9432 * depth / speed;
}

/* Per mass of one ball, two of which share the relative motion: sqrt(m/2 k) / m. */
static double damping_of(double stiffness, double e)
{
	double l = log(fmax(e, LEAST_RESTITUTION));
	return -sqrt(5) * l / sqrt(l * l + M_PI * M_PI) * sqrt(0.5 * stiffness);
}

/* ---- who takes part ---- */

static struct ball ball_now(const struct sim *sim, int i)
{
	return motion_advance_by(&sim->ball[i], sim->table, sim->motion[i].acceleration, sim->time - sim->ball_time[i]);
}

static double approach_speed(const struct ball *a, const struct ball *b)
{
	return vec2_dot(vec2_sub(a->vel, b->vel), vec2_unit(vec2_sub(b->pos, a->pos)));
}

static double fastest_approach(const struct sim *sim, const struct group *group)
{
	double most = 0;
	for (int i = 0; i < group->count; i++)
		most = fmax(most,
			    approach_speed(&sim->ball[group->contact[i].ball], &sim->ball[group->contact[i].other]));
	return most;
}

/* m, the widest gap that can close while contacts last. */
static double reach_of(const struct ball *a, const struct ball *b, double speed, double lasts)
{
	return CLUSTER_REACH * lasts * (speed + vec2_dist(a->vel, b->vel));
}

/* All balls that hang together with the group by such gaps (bit i: ball i), and how they move now. */
static uint32_t within_reach(const struct sim *sim, const struct group *group, double speed, double lasts,
			     struct ball now[BALL_MAX])
{
	uint32_t in = group->balls, done = 0;
	for (int i = 0; i < sim->ball_count; i++)
		now[i] = ball_now(sim, i);
	while (done != in) {
		int i = __builtin_ctz(in & ~done);
		done |= 1u << i;
		for (int k = 0; k < sim->ball_count; k++) {
			double far = 2 * sim->table->ball_radius + reach_of(&now[i], &now[k], speed, lasts);
			if (now[k].phase != BALL_POTTED && vec2_norm2(vec2_sub(now[i].pos, now[k].pos)) <= far * far)
				in |= 1u << k;
		}
	}
	return in;
}

static void add_bodies(struct cluster *c, uint32_t balls, const struct ball now[BALL_MAX])
{
	for (; balls; balls &= balls - 1) {
		int i = __builtin_ctz(balls);
		const struct ball *b = &now[i];
		c->body[c->body_count++] = (struct body){
			.pos = b->pos, .vel = b->vel, .spin = {b->spin[0], b->spin[1], b->spin[2]}, .ball = (int8_t)i};
	}
}

static void add_bonds(struct cluster *c, double speed, double lasts, const struct ball now[BALL_MAX])
{
	double touch = 2 * c->table->ball_radius;
	for (int a = 0; a < c->body_count; a++) {
		for (int b = a + 1; b < c->body_count && c->bond_count < GROUP_MAX; b++) {
			const struct ball *one = &now[c->body[a].ball], *other = &now[c->body[b].ball];
			double distance = vec2_dist(one->pos, other->pos);
			/* what a camera saw overlap is not under load */
			if (distance <= touch + reach_of(one, other, speed, lasts))
				c->bond[c->bond_count++] =
					(struct bond){(int8_t)a, (int8_t)b, false, fmin(touch, distance)};
		}
	}
}

/* ---- through time ---- */

/* Slip of a's surface on b's along t (n turned by +90 degrees) and z. */
static vec2 slip_of(const struct cluster *c, const struct body *a, const struct body *b, vec2 n)
{
	double r = c->table->ball_radius,
	       about = vec2_cross(n, (vec2){a->spin[0] + b->spin[0], a->spin[1] + b->spin[1]});
	return (vec2){vec2_cross(n, vec2_sub(a->vel, b->vel)) + r * (a->spin[2] + b->spin[2]), -r * about};
}

static void turn(struct body *body, vec2 n, vec2 impulse, double radius)
{
	double k = 2.5 / radius;
	body->turn[0] -= k * impulse.y * -n.y;
	body->turn[1] -= k * impulse.y * n.x;
	body->turn[2] += k * impulse.x;
}

/* Friction of one step with normal impulse `push` per mass: mu of it, at most what ends half the slip. In the law of a
 * single contact it is a share of e times the approach, here of (1 + e) / 2 of it. */
static void rub(struct cluster *c, const struct bond *bond, vec2 n, double push)
{
	const struct material *m = &c->table->material;
	struct body *a = &c->body[bond->a], *b = &c->body[bond->b];
	vec2 slip = slip_of(c, a, b, n);
	double size = vec2_norm(slip);
	if (size == 0)
		return;
	double mu = c->share * (m->mu_ball_a + m->mu_ball_b * exp(-m->mu_ball_c * size));
	vec2 impulse = vec2_scale(slip, -fmin(mu * push / size, 1.0 / 14));
	a->rub = vec2_madd(a->rub, impulse.x, vec2_perp(n));
	b->rub = vec2_madd(b->rub, -impulse.x, vec2_perp(n));
	turn(a, n, impulse, c->table->ball_radius);
	turn(b, n, impulse, c->table->ball_radius);
}

static void press(struct cluster *c, struct bond *bond, bool frictional)
{
	struct body *a = &c->body[bond->a], *b = &c->body[bond->b];
	vec2 between = vec2_sub(b->pos, a->pos);
	double distance2 = vec2_norm2(between);
	if (distance2 >= bond->length * bond->length)
		return;
	double distance = sqrt(distance2), depth = bond->length - distance, root = sqrt(depth);
	vec2 n = vec2_scale(between, 1 / distance);
	double closing = vec2_dot(vec2_sub(a->vel, b->vel), n);
	double push = c->stiffness * depth * root + c->damping * sqrt(root) * closing;
	c->active++;
	a->pull = vec2_madd(a->pull, -push, n);
	b->pull = vec2_madd(b->pull, push, n);
	if (!bond->touched) {
		bond->touched = a->touched = b->touched = true;
		c->begun[c->begun_count++] = (int8_t)(bond - c->bond);
	}
	if (frictional && push > 0)
		rub(c, bond, n, push * c->dt);
}

/* Half a kick and a drift. */
static void drift(struct cluster *c)
{
	for (int i = 0; i < c->body_count; i++) {
		struct body *b = &c->body[i];
		b->vel = vec2_madd(b->vel, 0.5 * c->dt, b->pull);
		b->pos = vec2_madd(b->pos, c->dt, b->vel);
		b->pull = b->rub = (vec2){0, 0};
		b->turn[0] = b->turn[1] = b->turn[2] = 0;
	}
}

/* Velocity Verlet: half a kick, a drift, the forces there, half a kick. All forces are found before any is applied: no
 * order among the contacts, mirrored places give mirrored results. */
static void step(struct cluster *c, bool frictional)
{
	drift(c);
	c->active = 0;
	for (int i = 0; i < c->bond_count; i++)
		press(c, &c->bond[i], frictional);
	for (int i = 0; i < c->body_count; i++) {
		struct body *b = &c->body[i];
		b->vel = vec2_add(vec2_madd(b->vel, 0.5 * c->dt, b->pull), b->rub);
		for (int k = 0; k < 3; k++)
			b->spin[k] += b->turn[k];
	}
}

/* ---- from a group and back ---- */

static void report(const struct cluster *c, struct group *group)
{
	double time = group->contact[0].time;
	group->count = 0;
	group->balls = 0;
	for (int i = 0; i < c->begun_count; i++) {
		const struct bond *bond = &c->bond[c->begun[i]];
		int16_t a = c->body[bond->a].ball, b = c->body[bond->b].ball;
		group->contact[group->count++] = (struct event){time, EVENT_BALL_BALL, a, b};
		group->balls |= 1u << a | 1u << b;
	}
}

static double energy(const struct cluster *c)
{
	double r = c->table->ball_radius, sum = 0;
	for (int i = 0; i < c->body_count; i++) {
		const double *w = c->body[i].spin;
		sum += vec2_norm2(c->body[i].vel) + 0.4 * r * r * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
	}
	return sum;
}

/* Steps in time may leave a little more energy than there was, where no restitution takes any. */
static void hold_energy(struct cluster *c, double before)
{
	double k = sqrt(before / energy(c));
	for (int i = 0; i < c->body_count && k < 1; i++) {
		struct body *b = &c->body[i];
		b->vel = vec2_scale(b->vel, k);
		for (int n = 0; n < 3; n++)
			b->spin[n] *= k;
	}
}

static void write_back(struct sim *sim, const struct cluster *c, const struct ball now[BALL_MAX])
{
	for (int i = 0; i < c->body_count; i++) {
		const struct body *body = &c->body[i];
		if (!body->touched)
			continue;
		struct ball *ball = &sim->ball[body->ball];
		*ball = now[body->ball];
		sim->ball_time[body->ball] = sim->time;
		ball->vel = body->vel;
		for (int k = 0; k < 3; k++)
			ball->spin[k] = body->spin[k];
		contact_set_phase(sim->table, &sim->model, ball->phase, ball);
	}
}

bool cluster_collide(struct sim *sim, struct group *group)
{
	const struct table *table = sim->table;
	if (!sim->model.lasting_contacts || table->material.hertz_modulus == 0 || sim->instant_contacts > CLUSTERS_MAX)
		return false;
	double speed = fastest_approach(sim, group), stiffness = stiffness_of(table);
	if (speed < CLUSTER_SPEED)
		return false;
	double lasts = contact_time(stiffness, speed), e = contact_restitution(table, &sim->model, speed);
	struct ball now[BALL_MAX];
	uint32_t balls = within_reach(sim, group, speed, lasts, now);
	uint32_t others = balls & (balls - 1); /* without the lowest */
	if ((others & (others - 1)) == 0)
		return false; /* two alone keep the law of a single contact */
	struct cluster c = {.stiffness = stiffness,
			    .damping = damping_of(stiffness, e),
			    .share = 2 * e / (1 + e),
			    .dt = lasts / CLUSTER_STEPS,
			    .table = table};
	add_bodies(&c, balls, now);
	add_bonds(&c, speed, lasts, now);
	double before = energy(&c);
	int steps = 0;
	do
		step(&c, sim->model.ball == BALL_MODEL_FRICTIONAL);
	while (c.active > 0 && ++steps < CLUSTER_STEPS_MAX);
	if (c.begun_count < 2)
		return false;
	hold_energy(&c, before);
	report(&c, group);
	write_back(sim, &c, now);
	return true;
}
