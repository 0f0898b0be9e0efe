#include "physics/contact.h"

#include "physics/contact_real.h"
#include "physics/motion.h"

double contact_restitution(const struct table *table, const struct model *model, double speed)
{
	bool loses = model->ball == BALL_MODEL_RESTITUTION || model->ball == BALL_MODEL_FRICTIONAL;
	return loses ? ball_restitution(&table->material, speed) : 1;
}

double contact_speed_left(const struct table *table, const struct model *model)
{
	return model->ball == BALL_MODEL_THESIS ? 1 - table->material.loss_ball : 1;
}

/* Thesis motion knows no spin: whatever does not roll slides as if just struck. */
static void slide(const struct table *table, struct ball *ball)
{
	ball->spin[0] = ball->spin[1] = ball->spin[2] = 0;
	motion_classify(ball, table);
}

void contact_set_phase(const struct table *table, const struct model *model, enum ball_phase phase, struct ball *ball)
{
	if (!model->thesis_motion)
		motion_classify(ball, table);
	else if (phase == BALL_ROLLING)
		motion_roll(ball, table);
	else
		slide(table, ball);
}

/* Equal masses, no friction: the normal components are exchanged, the approach times e. */
static void exchange(const struct table *table, const struct model *model, struct ball *a, struct ball *b)
{
	vec2 n = vec2_unit(vec2_sub(b->pos, a->pos));
	double approach = vec2_dot(vec2_sub(a->vel, b->vel), n);
	double impulse = 0.5 * (1 + contact_restitution(table, model, approach)) * approach;
	a->vel = vec2_madd(a->vel, -impulse, n);
	b->vel = vec2_madd(b->vel, impulse, n);
}

/* 4.56 to 4.61: what topspin adds to the tangential part; at most the incoming speed. v is the velocity after the loss.
 */
static vec2 topspin(const struct material *m, enum ball_phase phase, vec2 v, vec2 tangential)
{
	if (phase != BALL_ROLLING || m->topspin_variant == 0)
		return tangential;
	vec2 push = m->topspin_variant == 1 ? vec2_unit(v) : v;
	vec2 sum = vec2_madd(tangential, m->topspin_factor, push);
	double speed = vec2_norm(v), size = vec2_norm(sum);
	return size > speed ? vec2_scale(sum, speed / size) : sum;
}

/* 4.43 to 4.55 */
static void thesis_balls(const struct table *table, struct ball *a, struct ball *b)
{
	const struct material *m = &table->material;
	vec2 z = vec2_unit(vec2_sub(b->pos, a->pos));
	vec2 va = vec2_scale(a->vel, 1 - m->loss_ball), vb = vec2_scale(b->vel, 1 - m->loss_ball);
	vec2 za = vec2_scale(z, vec2_dot(va, z)), zb = vec2_scale(z, vec2_dot(vb, z));
	a->vel = vec2_add(zb, topspin(m, a->phase, va, vec2_sub(va, za)));
	b->vel = vec2_add(za, topspin(m, b->phase, vb, vec2_sub(vb, zb)));
}

void contact_balls(const struct table *table, const struct model *model, struct ball *a, struct ball *b)
{
	enum ball_phase phase_a = a->phase, phase_b = b->phase;
	switch (model->ball) {
	case BALL_MODEL_ELASTIC:
	case BALL_MODEL_RESTITUTION:
		exchange(table, model, a, b);
		break;
	case BALL_MODEL_THESIS:
		thesis_balls(table, a, b);
		break;
	case BALL_MODEL_FRICTIONAL:
		contact_ball_frictional(table, a, b);
		break;
	}
	contact_set_phase(table, model, phase_a, a);
	contact_set_phase(table, model, phase_b, b);
}

static void mirror(double restitution, vec2 normal, struct ball *ball)
{
	ball->vel = vec2_madd(ball->vel, -(1 + restitution) * vec2_dot(ball->vel, normal), normal);
}

void contact_cushion(const struct table *table, const struct model *model, const struct nose *nose, struct ball *ball)
{
	vec2 normal = nose->normal;
	switch (model->cushion) {
	case CUSHION_MODEL_MIRROR:
		mirror(1, normal, ball);
		break;
	case CUSHION_MODEL_RESTITUTION:
		mirror(nose_restitution(table, nose, -vec2_dot(ball->vel, normal)), normal, ball);
		break;
	case CUSHION_MODEL_THESIS:
		/* 4.62, 4.63 with (1 - E) for 1/(1 + E); rolls at once (4.6.4.9) */
		mirror(1, normal, ball);
		ball->vel = vec2_scale(ball->vel, 1 - table->material.loss_cushion);
		motion_roll(ball, table);
		return;
	case CUSHION_MODEL_STRONGE:
		contact_cushion_stronge(table, nose, ball);
		break;
	case CUSHION_MODEL_MATHAVAN:
		contact_cushion_mathavan(table, nose, ball);
		break;
	}
	motion_classify(ball, table);
}
