#include "search/acceptance.h"

enum { EVENTS = 40, HALVINGS = 7, PROBES = 9 };
static const double ANGLE_STEP = 5 * M_PI / 180;	    /* rad, between the measured ways */
static const double SPEED[ACCEPT_SPEEDS] = {0.5, 1.5, 3.5}; /* m/s at the start of the way */
static const double RUN_UP = 0.5;			    /* m before the pocket's centre */
static const double SPREAD = 1.0;			    /* pocket radii to either side that are probed */

/* One way into one pocket. */
struct probe {
	const struct table *table;
	const struct model *model;
	int pocket;
	vec2 way; /* unit */
	double speed;
};

static bool is_on_bed(const struct table *table, vec2 p)
{
	return fabs(p.x) <= table->length / 2 - table->ball_radius &&
	       fabs(p.y) <= table->width / 2 - table->ball_radius;
}

/* As far before the pocket as the bed reaches. False when the way never crosses the bed. */
static bool find_start(const struct probe *probe, double offset, vec2 *start)
{
	const struct pocket *p = &probe->table->pocket[probe->pocket];
	vec2 foot = vec2_madd(p->centre, offset, vec2_perp(probe->way));
	for (double back = RUN_UP; back > 2 * probe->table->ball_radius; back -= 0.01) {
		*start = vec2_madd(foot, -back, probe->way);
		if (is_on_bed(probe->table, *start))
			return true;
	}
	return false;
}

static bool falls(const struct probe *probe, double offset)
{
	struct sim sim;
	struct event event;
	struct ball ball = ball_at(COLOUR_RED, (vec2){0, 0});
	if (!find_start(probe, offset, &ball.pos))
		return false;
	double r = probe->table->ball_radius;
	ball.phase = BALL_ROLLING;
	ball.vel = vec2_scale(probe->way, probe->speed);
	ball.spin[0] = -ball.vel.y / r;
	ball.spin[1] = ball.vel.x / r;
	sim_init(&sim, probe->table, probe->model, &ball, 1);
	for (int i = 0; i < EVENTS && sim_step(&sim, &event); i++) {
		if (event.kind == EVENT_POCKET)
			return event.other == probe->pocket;
		if (event.kind == EVENT_CUSHION && probe->table->cushion[event.other].main_rail)
			return false; /* what comes back from a rail was no way into this pocket */
	}
	return false;
}

/* The border of what falls between good and bad. */
static double border(const struct probe *probe, double good, double bad)
{
	for (int i = 0; i < HALVINGS; i++) {
		double middle = (good + bad) / 2;
		if (falls(probe, middle))
			good = middle;
		else
			bad = middle;
	}
	return good;
}

static struct acceptance_window measure(const struct probe *probe)
{
	double reach = SPREAD * probe->table->pocket[probe->pocket].radius;
	double step = 2 * reach / (PROBES - 1);
	int best = -1, best_length = 0;
	bool good[PROBES];
	for (int i = 0, length = 0; i < PROBES; i++) {
		good[i] = falls(probe, -reach + i * step);
		length = good[i] ? length + 1 : 0;
		if (length > best_length) {
			best_length = length;
			best = i - length + 1;
		}
	}
	if (best < 0)
		return (struct acceptance_window){0, 0};
	double low = -reach + best * step, high = low + (best_length - 1) * step;
	return (struct acceptance_window){border(probe, low, low - step), border(probe, high, high + step)};
}

static vec2 way_at(const struct table *table, int pocket, double angle)
{
	vec2 in = vec2_scale(table->pocket[pocket].normal, -1);
	double c = cos(angle), s = sin(angle);
	return (vec2){c * in.x - s * in.y, s * in.x + c * in.y};
}

void acceptance_measure(struct acceptance *acceptance, const struct table *table, const struct model *model)
{
	*acceptance = (struct acceptance){.window = {{{{0, 0}}}}};
	for (int p = 0; p < table->pocket_count && model->pocket != POCKET_MODEL_NONE; p++)
		for (int s = 0; s < ACCEPT_SPEEDS; s++)
			for (int a = 0; a < ACCEPT_ANGLES; a++) {
				double angle = (a - ACCEPT_ANGLES / 2) * ANGLE_STEP;
				struct probe probe = {table, model, p, way_at(table, p, angle), SPEED[s]};
				acceptance->window[p][s][a] = measure(&probe);
			}
}

static struct acceptance_window between(const struct acceptance_window *a, const struct acceptance_window *b, double t)
{
	if (a->high <= a->low || b->high <= b->low)
		return t < 0.5 ? *a : *b;
	return (struct acceptance_window){a->low + t * (b->low - a->low), a->high + t * (b->high - a->high)};
}

struct acceptance_window acceptance_at(const struct acceptance *acceptance, const struct table *table, int pocket,
				       vec2 way, double speed)
{
	vec2 in = vec2_scale(table->pocket[pocket].normal, -1);
	double at = atan2(vec2_cross(in, way), vec2_dot(in, way)) / ANGLE_STEP + ACCEPT_ANGLES / 2;
	if (at < 0 || at > ACCEPT_ANGLES - 1)
		return (struct acceptance_window){0, 0};
	int a = at >= ACCEPT_ANGLES - 1 ? ACCEPT_ANGLES - 2 : (int)at;
	int s = speed < 1 ? 0 : speed < 2.5 ? 1 : 2;
	const struct acceptance_window *w = acceptance->window[pocket][s];
	return between(&w[a], &w[a + 1], at - a);
}
