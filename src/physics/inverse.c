#include "physics/inverse.h"

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

double hit_backward(const struct table *table, double u, double cos_cut)
{
	return u / (at_most_one(cos_cut) * (1 - table->material.loss_ball));
}

double cushion_backward(const struct table *table, double u)
{
	return u / (1 - table->material.loss_cushion);
}
