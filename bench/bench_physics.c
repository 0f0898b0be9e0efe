/* Speed of the physics: roots beside GSL's, single contacts, whole shots, and the equations that a shot costs. */
#include <gsl/gsl_poly.h>
#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>

#include "physics/contact_real.h"
#include "physics/roots.h"
#include "physics/sim.h"
#include "report.h"
#include "scenes.h"

static volatile double sink;

static double uniform(gsl_rng *r, double low, double high)
{
	return low + (high - low) * gsl_rng_uniform(r);
}

/* ---- quartics: meetings of two sliding balls
 * --------------------------------------------------------------------------- */

enum { QUARTICS = 512 };

struct quartics {
	double c[QUARTICS][5], horizon[QUARTICS];
	gsl_poly_complex_workspace *workspace;
};

/* Distance squared of two sliding balls, less (2 r)^2; half of them aim at each other well enough to meet. */
static void random_meeting(gsl_rng *r, double c[5], double *horizon)
{
	const double slide = 0.2 * 9.81, distance = 0.0525;
	vec2 p = vec2_scale(vec2_from_angle(uniform(r, 0, 2 * M_PI)), uniform(r, 0.06, 1.5));
	vec2 v = vec2_scale(vec2_from_angle(uniform(r, -0.1, 0.1)), -uniform(r, 0.5, 6) / vec2_norm(p));
	v = (vec2){v.x * p.x - v.y * p.y, v.y * p.x + v.x * p.y};
	vec2 a = vec2_scale(vec2_from_angle(uniform(r, 0, 2 * M_PI)), slide);
	a = vec2_madd(a, slide, vec2_from_angle(uniform(r, 0, 2 * M_PI)));
	c[0] = vec2_norm2(p) - distance * distance;
	c[1] = 2 * vec2_dot(p, v);
	c[2] = vec2_norm2(v) + vec2_dot(p, a);
	c[3] = vec2_dot(v, a);
	c[4] = 0.25 * vec2_norm2(a);
	*horizon = uniform(r, 0.1, 1);
}

static void solve_ours(void *context)
{
	const struct quartics *q = context;
	double sum = 0;
	for (int i = 0; i < QUARTICS; i++) {
		double t = roots_quartic_entry(q->c[i], q->horizon[i]);
		sum += t < INFINITY ? t : 0;
	}
	sink = sum;
}

static void solve_gsl(void *context)
{
	const struct quartics *q = context;
	double sum = 0, z[8];
	for (int i = 0; i < QUARTICS; i++) {
		gsl_poly_complex_solve(q->c[i], 5, q->workspace, z);
		sum += z[0];
	}
	sink = sum;
}

static void bench_roots(struct report *report)
{
	static struct quartics q;
	gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937); /* its default seed: the same numbers every time */
	for (int i = 0; i < QUARTICS; i++)
		random_meeting(r, q.c[i], &q.horizon[i]);
	gsl_rng_free(r);
	q.workspace = gsl_poly_complex_workspace_alloc(5);
	double ours = bench_time(solve_ours, &q) / QUARTICS, gsl = bench_time(solve_gsl, &q) / QUARTICS;
	gsl_poly_complex_workspace_free(q.workspace);
	report_number(report, "roots.quartic_ns", ours, "ns");
	report_number(report, "roots.gsl_ns", gsl, "ns");
	report_number(report, "roots.gsl_multiple", gsl / ours, "x");
}

/* ---- single contacts
 * --------------------------------------------------------------------------------------------------- */

enum { CONTACTS = 256 };

struct contacts {
	struct table table;
	struct ball ball[CONTACTS];
	void (*law)(const struct table *table, const struct nose *nose, struct ball *ball);
};

static void hit_cushion(void *context)
{
	const struct contacts *c = context;
	struct nose nose = table_nose(&c->table, (vec2){0, 1}, 1.4 * c->table.ball_radius);
	double sum = 0;
	for (int i = 0; i < CONTACTS; i++) {
		struct ball b = c->ball[i];
		c->law(&c->table, &nose, &b);
		sum += b.vel.x;
	}
	sink = sum;
}

static void hit_ball(void *context)
{
	const struct contacts *c = context;
	double sum = 0;
	for (int i = 0; i < CONTACTS; i++) {
		struct ball a = c->ball[i], b = {.pos = {0, -2 * c->table.ball_radius}};
		contact_ball_frictional(&c->table, &a, &b);
		sum += b.vel.x;
	}
	sink = sum;
}

static void bench_contacts(struct report *report)
{
	static struct contacts c;
	gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937); /* its default seed: the same numbers every time */
	c.table = scene_snooker_table();
	for (int i = 0; i < CONTACTS; i++) {
		c.ball[i].vel = (vec2){uniform(r, -4, 4), -uniform(r, 0.1, 4)};
		for (int k = 0; k < 3; k++)
			c.ball[i].spin[k] = uniform(r, -100, 100);
	}
	gsl_rng_free(r);
	report_number(report, "contact.ball_ns", bench_time(hit_ball, &c) / CONTACTS, "ns");
	c.law = contact_cushion_stronge;
	report_number(report, "contact.stronge_ns", bench_time(hit_cushion, &c) / CONTACTS, "ns");
	c.law = contact_cushion_mathavan;
	report_number(report, "contact.mathavan_us", bench_time(hit_cushion, &c) / CONTACTS / 1e3, "us");
}

/* ---- whole shots
 * --------------------------------------------------------------------------------------------------------- */

struct scene {
	struct table table;
	struct model model;
	struct ball ball[BALL_MAX];
	int count;
	struct shot shot;
	struct sim sim;
};

static void play(void *context)
{
	struct scene *s = context;
	sim_init(&s->sim, &s->table, &s->model, s->ball, s->count);
	sim_strike(&s->sim, 0, &s->shot);
	enum sim_end end = sim_run(&s->sim, &(struct sim_limits){INFINITY, 100000}, NULL);
	if (end != SIM_AT_REST)
		abort();
}

static void report_scene(struct report *report, const char *name, struct scene *s)
{
	char full[64];
	double us = bench_time(play, s) / 1e3;
	const struct solve_count *n = &s->sim.solved;
	const struct {
		const char *what;
		double value;
		const char *unit;
	} row[] = {
		{"us", us, "us"},
		{"events", s->sim.event_count, "count"},
		{"quartics", (double)n->quartic, "count"},
		{"quadratics", (double)n->quadratic, "count"},
		{"linears", (double)n->linear, "count"},
		{"culled", (double)n->culled, "count"},
	};
	for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
		snprintf(full, sizeof full, "sim.%s_%s", name, row[i].what);
		report_number(report, full, row[i].value, row[i].unit);
	}
}

static void set_model(struct scene *s, const char *name)
{
	if (!model_from_name(name, &s->model))
		abort();
}

/* A red before the top-right pocket and the cue ball behind it in line, at a pace that leaves the cue ball on the
 * table. */
static void place_pot(struct scene *s)
{
	vec2 pocket = s->table.pocket[table_pocket(&s->table, "TOP-RIGHT")].centre;
	vec2 way = vec2_unit((vec2){1, 0.6});
	vec2 red = vec2_madd(pocket, -0.35, way);
	s->ball[1] = ball_at(COLOUR_RED, red);
	s->ball[0] = ball_at(COLOUR_WHITE, vec2_madd(red, -0.4, way));
	s->shot = (struct shot){.angle = atan2(way.y, way.x) + 0.005, .speed = 1.5};
}

static void check_potted(const struct scene *s, int ball)
{
	if (s->sim.ball[ball].phase != BALL_POTTED)
		fprintf(stderr, "bench: the ball meant to fall did not\n");
}

static void bench_pots(struct report *report, const struct table *table, const char *model, const char *suffix)
{
	static struct scene s;
	char name[48];
	s.table = *table;
	set_model(&s, model);
	place_pot(&s);
	s.count = 2;
	snprintf(name, sizeof name, "pot2%s", suffix);
	report_scene(report, name, &s);
	check_potted(&s, 1);
	/* The same shot with the other 20 balls where a frame begins. */
	struct ball rack[SCENE_RACK_COUNT];
	scene_rack(&s.table, rack);
	for (int i = 2; i < SCENE_RACK_COUNT; i++)
		s.ball[i] = rack[i];
	s.count = SCENE_RACK_COUNT;
	snprintf(name, sizeof name, "pot22%s", suffix);
	report_scene(report, name, &s);
	check_potted(&s, 1);
}

static void bench_break(struct report *report, const struct table *table, const char *model, const char *name)
{
	static struct scene s;
	s.table = *table;
	set_model(&s, model);
	scene_rack(&s.table, s.ball);
	s.count = SCENE_RACK_COUNT;
	vec2 apex = {-INFINITY, 0};
	for (int i = 1; i < s.count; i++)
		if (s.ball[i].colour == COLOUR_RED && (apex.x == -INFINITY || s.ball[i].pos.x < apex.x))
			apex = s.ball[i].pos;
	vec2 way = vec2_sub(apex, s.ball[0].pos);
	s.shot = (struct shot){.angle = atan2(way.y, way.x) + 0.01, .speed = 9.6};
	report_scene(report, name, &s);
}

/* The price of a bed that is not level, by the error that its pieces of path may have. */
static void bench_uneven(struct report *report, const struct table *level)
{
	static const struct {
		double error;
		const char *name;
	} row[] = {{1e-3, "break22_uneven_1mm"},
		   {1e-4, "break22_uneven_100um"},
		   {1e-5, "break22_uneven_10um"},
		   {1e-6, "break22_uneven_1um"}};
	for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
		struct table t = *level;
		t.bed = (struct bed){.slope = {1.5e-3, 1e-3}, .bowl = {5e-4, 0, 0}, .path_error = row[i].error};
		if (table_finish(&t, NULL, 0) != 0)
			abort();
		bench_break(report, &t, "real", row[i].name);
	}
}

int main(int argc, char **argv)
{
	if (argc != 2) {
		fprintf(stderr, "usage: %s BUILD\n", argv[0]);
		return EXIT_FAILURE;
	}
	struct report *report = report_open(argv[1], "bench.json");
	bench_roots(report);
	bench_contacts(report);
	/* On the table of the thesis, whose program is the yardstick, and on a full-size one. */
	const struct table thesis = scene_thesis_table(), full = scene_snooker_table();
	bench_pots(report, &thesis, "simple", "");
	bench_pots(report, &thesis, "real", "_real");
	bench_pots(report, &full, "simple", "_12ft");
	bench_pots(report, &full, "real", "_12ft_real");
	bench_break(report, &full, "simple", "break22");
	bench_break(report, &full, "real", "break22_real");
	bench_break(report, &full, "real-mathavan", "break22_mathavan");
	struct table lasting = full;
	lasting.material.hertz_modulus = 6.4e9;
	bench_break(report, &lasting, "real", "break22_lasting");
	bench_uneven(report, &full);
	return report_close(report) < 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}
