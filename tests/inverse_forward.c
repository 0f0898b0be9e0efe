#include "inverse_forward.h"

#include <math.h>

double leg_rolling_forward(const struct table *table, double v_start, double way)
{
	const struct material *m = &table->material;
	return sqrt(fmax(0, v_start * v_start - 2 * m->gravity * m->mu_roll * way));
}

/* It rolls after 12/49 v^2 / (mu_s g) (8.12), with 5/7 of its speed. */
double leg_forward(const struct table *table, double v_start, double way)
{
	const struct material *m = &table->material;
	double sliding = 12.0 / 49 * v_start * v_start / (m->mu_slide * m->gravity);
	if (way <= sliding)
		return sqrt(fmax(0, v_start * v_start - 2 * m->gravity * m->mu_slide * way));
	return leg_rolling_forward(table, 5.0 / 7 * v_start, way - sliding);
}

double hit_forward(const struct table *table, double v, double cos_cut)
{
	return v * fmin(cos_cut, 1) * (1 - table->material.loss_ball);
}

double cushion_forward(const struct table *table, double v)
{
	return v * (1 - table->material.loss_cushion);
}
