#include "physics/inverse.h"

/* Way of a ball struck without spin until it rolls: 12/49 v^2 / (mu_s g) (8.12); it then has 5/7 of its speed. */
static double slide_way(const struct material *m, double v)
{
	return 12.0 / 49 * v * v / (m->mu_slide * m->gravity);
}

static double root_or_zero(double v2)
{
	return v2 > 0 ? sqrt(v2) : 0;
}

double leg_forward(const struct table *table, double v_start, double way)
{
	const struct material *m = &table->material;
	double s = slide_way(m, v_start);
	if (way <= s)
		return root_or_zero(v_start * v_start - 2 * m->gravity * m->mu_slide * way);
	return leg_rolling_forward(table, 5.0 / 7 * v_start, way - s);
}

double leg_backward(const struct table *table, double v_end, double way)
{
	const struct material *m = &table->material;
	double sliding2 = v_end * v_end + 2 * m->gravity * m->mu_slide * way;
	if (way <= 12.0 / 49 * sliding2 / (m->mu_slide * m->gravity))
		return sqrt(sliding2);
	/* 4.33: rolls on arrival */
	double rolling2 = v_end * v_end + 2 * m->gravity * m->mu_roll * way;
	return sqrt(49 * m->mu_slide * rolling2 / (25 * m->mu_slide + 24 * m->mu_roll));
}

double leg_rolling_forward(const struct table *table, double v_start, double way)
{
	const struct material *m = &table->material;
	return root_or_zero(v_start * v_start - 2 * m->gravity * m->mu_roll * way);
}

double leg_rolling_backward(const struct table *table, double v_end, double way)
{
	const struct material *m = &table->material;
	return sqrt(v_end * v_end + 2 * m->gravity * m->mu_roll * way);
}

/* The cosine of two directions in line comes out as 1 + 2^-52 as often as not. */
static double at_most_one(double cosine)
{
	return cosine < 1 ? cosine : 1;
}

double hit_forward(const struct table *table, double v, double cos_cut)
{
	return v * at_most_one(cos_cut) * (1 - table->material.loss_ball);
}

double hit_backward(const struct table *table, double u, double cos_cut)
{
	return u / (at_most_one(cos_cut) * (1 - table->material.loss_ball));
}

double cushion_forward(const struct table *table, double v)
{
	return v * (1 - table->material.loss_cushion);
}

double cushion_backward(const struct table *table, double u)
{
	return u / (1 - table->material.loss_cushion);
}
