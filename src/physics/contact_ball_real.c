#include <assert.h>

#include "physics/contact_real.h"

/* Components of one plane vector along the line of centres (n) and across it (t = n turned by +90 degrees). */
static vec2 to_line(vec2 n, vec2 v)
{
	return (vec2){vec2_dot(n, v), vec2_cross(n, v)};
}

static vec2 from_line(vec2 n, vec2 v)
{
	return vec2_madd(vec2_scale(n, v.x), v.y, vec2_perp(n));
}

/* Change of the first ball's velocity along t and z (m/s) by friction, per unit mass. slip: of the first ball's surface
 * against the second's, along t and z. Friction of mu times the normal impulse, but never more than ends a share of the
 * slip: one seventh of it, because both balls' surfaces give way with 1 + 5/2 = 7/2 of the impulse. */
static vec2 friction_impulse(const struct material *m, vec2 slip, double normal_impulse, double share)
{
	double speed = vec2_norm(slip);
	if (speed == 0)
		return (vec2){0, 0};
	double mu = m->mu_ball_a + m->mu_ball_b * exp(-m->mu_ball_c * speed);
	return vec2_scale(slip, -fmin(mu * normal_impulse / speed, share / 7));
}

/* A tangential impulse (t, z components, per unit mass) at the end of the radius along +n turns a ball about z
 * and t. */
static void turn(vec2 n, vec2 impulse, double radius, double spin[3])
{
	vec2 about = vec2_scale(vec2_perp(n), -2.5 / radius * impulse.y);
	spin[0] += about.x;
	spin[1] += about.y;
	spin[2] += 2.5 / radius * impulse.x;
}

/* w x (r n) is r (wz t - wt z); the second ball's radius points the other way. */
static vec2 surface_slip(vec2 n, double r, const struct ball *a, const struct ball *b)
{
	vec2 va = to_line(n, a->vel), vb = to_line(n, b->vel);
	vec2 spin = to_line(n, (vec2){a->spin[0] + b->spin[0], a->spin[1] + b->spin[1]});
	return (vec2){va.y - vb.y + r * (a->spin[2] + b->spin[2]), -r * spin.y};
}

vec2 contact_ball_friction(const struct table *table, const struct ball *a, const struct ball *b, double impulse,
			   double share)
{
	vec2 n = vec2_unit(vec2_sub(b->pos, a->pos));
	vec2 slip = surface_slip(n, table->ball_radius, a, b);
	return friction_impulse(&table->material, slip, impulse, share);
}

void contact_ball_rub(const struct table *table, vec2 impulse, struct ball *a, struct ball *b)
{
	vec2 n = vec2_unit(vec2_sub(b->pos, a->pos)), t = vec2_perp(n);
	a->vel = vec2_madd(a->vel, impulse.x, t);
	b->vel = vec2_madd(b->vel, -impulse.x, t);
	turn(n, impulse, table->ball_radius, a->spin);
	turn(n, impulse, table->ball_radius, b->spin);
}

void contact_ball_frictional(const struct table *table, struct ball *a, struct ball *b)
{
	const struct material *m = &table->material;
	double r = table->ball_radius;
	vec2 n = vec2_unit(vec2_sub(b->pos, a->pos));
	/* The very expression by which callers decide that the balls approach: the same to the last bit. */
	double approach = vec2_dot(vec2_sub(a->vel, b->vel), n);
	assert(approach >= 0);

	double e = ball_restitution(m, approach);
	vec2 slip = surface_slip(n, r, a, b);
	/* The reference shots take the separation speed, e times the approach speed, for the impulse that friction is a
	 * share of; Coulomb's law has (1 + e) / 2 of it, 2.6 % more at e = 0.95. */
	vec2 friction = friction_impulse(m, slip, e * approach, 1);
	double normal = 0.5 * (1 + e) * approach;
	vec2 change = from_line(n, (vec2){-normal, friction.x});
	a->vel = vec2_add(a->vel, change);
	b->vel = vec2_sub(b->vel, change);
	turn(n, friction, r, a->spin);
	turn(n, friction, r, b->spin);
}
