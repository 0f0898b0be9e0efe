/* Speed against error: whole shots by this project's engine and by a plain event simulation with other solvers, against
 * a reference in extended precision. Writes BUILD/physics.csv; scripts/plot-physics draws it. */
#include <complex.h>
#include <gsl/gsl_poly.h>
#include <gsl/gsl_rng.h>
#include <stdio.h>
#include <stdlib.h>

#include "physics/motion.h"
#include "physics/roots.h"
#include "physics/sim.h"
#include "plain_sim.h"
#include "report.h"
#include "scenes.h"

/* SPARE: events after the reference's last, to tell one that comes early from one that is left out. */
enum { SHOTS = 150, EVENTS = 40, BALLS = 8, SPARE = 3 };

/* ---- solvers
 * --------------------------------------------------------------------------------------------------------------- */

static double slope(const double c[5], double t)
{
	return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * 4 * c[4]));
}

/* Of the roots that count as real, the earliest in (0, horizon] at which the polynomial falls. */
static double earliest(const double c[5], const double complex *root, int count, double horizon, double tolerance)
{
	double best = INFINITY;
	for (int i = 0; i < count; i++) {
		double t = creal(root[i]);
		if (fabs(cimag(root[i])) <= tolerance * cabs(root[i]) && t > 0 && t <= horizon && t < best &&
		    slope(c, t) < 0)
			best = t;
	}
	return best;
}

static double low_degree(const double c[5], double horizon)
{
	double root[2];
	int count = roots_quadratic(c[2], c[1], c[0], root);
	for (int i = 0; i < count; i++)
		if (root[i] > 0 && root[i] <= horizon && slope(c, root[i]) < 0)
			return root[i];
	return INFINITY;
}

/* The general formula of thesis 4.69 to 4.75, in complex numbers. */
static double ferrari_entry(const double k[5], double horizon, double tolerance)
{
	double a = k[4], b = k[3], c = k[2], d = k[1], e = k[0];
	if (a == 0 && b == 0)
		return low_degree(k, horizon);
	double p = (8 * a * c - 3 * b * b) / (8 * a * a);
	double q = (b * b * b - 4 * a * b * c + 8 * a * a * d) / (8 * a * a * a);
	double d0 = c * c - 3 * b * d + 12 * a * e;
	double d1 = 2 * c * c * c - 9 * b * c * d + 27 * b * b * e + 27 * a * d * d - 72 * a * c * e;
	double complex big = cpow((d1 + csqrt(d1 * d1 - 4 * d0 * d0 * d0)) / 2, 1.0 / 3);
	double complex s = 0.5 * csqrt(-2.0 / 3 * p + (big + d0 / big) / (3 * a));
	double complex plus = 0.5 * csqrt(-4 * s * s - 2 * p + q / s), minus = 0.5 * csqrt(-4 * s * s - 2 * p - q / s);
	double shift = -b / (4 * a);
	const double complex root[4] = {shift - s + plus, shift - s - plus, shift + s + minus, shift + s - minus};
	return earliest(k, root, 4, horizon, tolerance);
}

static gsl_poly_complex_workspace *workspace[5];

static double gsl_entry(const double c[5], double horizon, double tolerance)
{
	int degree = 4;
	while (degree > 2 && c[degree] == 0)
		degree--;
	if (degree == 2)
		return low_degree(c, horizon);
	double z[8];
	double complex root[4];
	gsl_poly_complex_solve(c, (size_t)degree + 1, workspace[degree], z);
	for (int i = 0; i < degree; i++)
		root[i] = z[2 * i] + I * z[2 * i + 1];
	return earliest(c, root, degree, horizon, tolerance);
}

static double our_entry(const double c[5], double horizon, double tolerance)
{
	(void)tolerance;
	/* The plain simulation has just resolved what touches: only a polynomial that comes from above can fall
	 * through. */
	return roots_quartic_entry(c, horizon);
}

/* ---- shots
 * -------------------------------------------------------------------------------------------------------------------
 */

struct shots {
	struct table table;
	struct model model;
	struct ball ball[SHOTS][BALL_MAX];
	int count[SHOTS];
	struct plain_event reference[SHOTS][EVENTS], log[EVENTS + SPARE];
	int events[SHOTS], most;	   /* events of the reference, cut at most */
	const struct plain_solver *solver; /* NULL: this project's engine */
	struct sim sim;
	int current;
};

static double uniform(gsl_rng *r, double low, double high)
{
	return low + (high - low) * gsl_rng_uniform(r);
}

static void scatter(struct shots *s, gsl_rng *r, int shot)
{
	struct ball *ball = s->ball[shot];
	double x = s->table.length / 2 - 0.1, y = s->table.width / 2 - 0.1;
	for (int i = 0; i < BALLS; i++) {
		double nearest = INFINITY;
		ball[i] = ball_at(i ? COLOUR_RED : COLOUR_WHITE, (vec2){uniform(r, -x, x), uniform(r, -y, y)});
		for (int k = 0; k < i; k++)
			nearest = fmin(nearest, vec2_dist(ball[i].pos, ball[k].pos));
		i -= nearest < 2.1 * s->table.ball_radius;
	}
	s->count[shot] = BALLS;
	ball[0].vel = vec2_scale(vec2_from_angle(uniform(r, 0, 2 * M_PI)), uniform(r, 0.5, 7));
	for (int k = 0; k < 3; k++)
		ball[0].spin[k] = uniform(r, -80, 80);
	motion_classify(&ball[0], &s->table);
}

static struct ball rolling(const struct table *t, vec2 pos, vec2 vel)
{
	struct ball b = ball_at(COLOUR_RED, pos);
	b.vel = vel;
	b.spin[0] = -vel.y / t->ball_radius;
	b.spin[1] = vel.x / t->ball_radius;
	b.phase = BALL_ROLLING;
	return b;
}

/* Two balls only, in the ways that solvers fail on: following each other with (nearly) equal deceleration, where the
 * quartic's leading terms vanish, and passing with a closest approach of two radii give or take 1e-10 to 1e-6 m. */
static void hard_pair(struct shots *s, gsl_rng *r, int shot)
{
	struct ball *ball = s->ball[shot];
	double d = 2 * s->table.ball_radius, v = uniform(r, 0.3, 1.5), angle = uniform(r, -M_PI, M_PI);
	vec2 way = vec2_from_angle(angle), across = vec2_perp(way), from = vec2_scale(way, -0.5);
	s->count[shot] = 2;
	ball[0] = rolling(&s->table, from, vec2_scale(way, v));
	if (shot % 2) {
		double share = uniform(r, 0.2, 0.9), turn = pow(10, uniform(r, -17, -3));
		vec2 other = vec2_from_angle(angle + turn);
		ball[1] = rolling(&s->table, vec2_madd(from, 0.2, way), vec2_scale(other, share * v));
	} else {
		double miss = d + (gsl_rng_uniform(r) < 0.5 ? -1 : 1) * pow(10, uniform(r, -10, -6));
		vec2 at = vec2_madd(vec2_scale(way, -0.2), miss, across);
		ball[1] = ball_at(COLOUR_RED, at);
	}
}

/* ---- comparison
 * ---------------------------------------------------------------------------------------------------------------- */

static int play_engine(struct shots *s, int shot)
{
	struct event event;
	int n = 0;
	sim_init(&s->sim, &s->table, &s->model, s->ball[shot], s->count[shot]);
	while (n < s->events[shot] + SPARE && sim_step(&s->sim, &event)) {
		s->log[n].event = event;
		s->log[n].pos[0] = s->log[n].pos[1] = sim_ball(&s->sim, event.ball).pos;
		if (event.kind == EVENT_BALL_BALL)
			s->log[n].pos[1] = sim_ball(&s->sim, event.other).pos;
		n++;
	}
	return n;
}

static int play_one(struct shots *s, int shot)
{
	if (!s->solver)
		return play_engine(s, shot);
	return plain_run(&s->table, &s->model, s->ball[shot], s->count[shot], s->solver, s->log,
			 s->events[shot] + SPARE);
}

static void play_all(void *context)
{
	struct shots *s = context;
	for (int i = 0; i < SHOTS; i++)
		play_one(s, i);
}

struct outcome {
	double position, time; /* largest error over all events up to the first that differs; m, s */
	int missed, invented;  /* shots whose first difference is an event of the reference left out, or one that is not
				  in it */
	double us;	       /* per shot */
};

static bool is_same(const struct event *a, const struct event *b)
{
	return a->kind == b->kind && a->ball == b->ball && a->other == b->other;
}

static bool is_in(const struct event *event, const struct plain_event *log, int from, int count)
{
	for (int i = from; i < count && i < from + 6; i++)
		if (is_same(event, &log[i].event) && fabs(event->time - log[i].event.time) < 1e-3)
			return true;
	return false;
}

/* Events of one instant (two equal balls begin to roll together) may come in any order: brings the log's into the
 * reference's. */
static void settle_tie(const struct event *want, struct plain_event *log, int i, int count)
{
	const double tie = 1e-7; /* s */
	for (int k = i + 1; k < count && log[k].event.time - log[i].event.time < tie; k++) {
		if (is_same(want, &log[k].event)) {
			struct plain_event found = log[k];
			log[k] = log[i];
			log[i] = found;
			return;
		}
	}
}

static void compare_shot(struct shots *s, int shot, struct outcome *o)
{
	int n = play_one(s, shot), want = s->events[shot];
	const struct plain_event *reference = s->reference[shot];
	struct plain_event *log = s->log;
	for (int i = 0; i < want || (i < n && want < s->most); i++) {
		if (i < n && i < want && !is_same(&reference[i].event, &log[i].event))
			settle_tie(&reference[i].event, log, i, n);
		if (i >= n || i >= want || !is_same(&reference[i].event, &log[i].event)) {
			bool left_out = i < want && !is_in(&reference[i].event, log, i, n);
			o->missed += left_out;
			o->invented += !left_out && i < n && !is_in(&log[i].event, reference, i, want);
			return; /* what follows is another shot */
		}
		o->time = fmax(o->time, fabs(reference[i].event.time - log[i].event.time));
		for (int k = 0; k < 2; k++)
			o->position = fmax(o->position, vec2_dist(reference[i].pos[k], log[i].pos[k]));
	}
}

static void measure(struct shots *s, FILE *csv, const char *family, const char *solver, const struct plain_solver *with)
{
	struct outcome o = {0};
	s->solver = with;
	for (int i = 0; i < SHOTS; i++)
		compare_shot(s, i, &o);
	o.us = bench_time(play_all, s) / SHOTS / 1e3;
	double tolerance = with ? with->tolerance : 0;
	fprintf(csv, "%s,%s,%g,%.4g,%.3g,%.3g,%d,%d,%d\n", family, solver, tolerance, o.us, o.position, o.time,
		o.missed, o.invented, SHOTS);
	printf("%-14s %-14s %-8g %10.3g us %10.2g m %10.2g s %5d missed %5d invented\n", family, solver, tolerance,
	       o.us, o.position, o.time, o.missed, o.invented);
	fflush(stdout);
}

static void measure_family(struct shots *s, FILE *csv, const char *family, int most)
{
	for (int i = 0; i < SHOTS; i++)
		s->events[i] =
			plain_run_long(&s->table, &s->model, s->ball[i], s->count[i], NULL, s->reference[i], most);
	const double tolerance[] = {1e-3, 1e-6, 1e-9, 1e-12};
	for (size_t i = 0; i < sizeof tolerance / sizeof *tolerance; i++) {
		measure(s, csv, family, "thesis formula", &(struct plain_solver){ferrari_entry, tolerance[i]});
		measure(s, csv, family, "GSL", &(struct plain_solver){gsl_entry, tolerance[i]});
	}
	measure(s, csv, family, "ours (plain)", &(struct plain_solver){our_entry, 0});
	measure(s, csv, family, "ours (engine)", NULL);
}

static void run_families(FILE *csv)
{
	static struct shots s;
	static const char *const model[] = {"simple", "real", "real-mathavan"};
	s.table = scene_snooker_table();
	for (size_t m = 0; m < sizeof model / sizeof *model; m++) {
		gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
		model_from_name(model[m], &s.model);
		for (int i = 0; i < SHOTS; i++)
			scatter(&s, r, i);
		measure_family(&s, csv, model[m], EVENTS);
		gsl_rng_free(r);
	}
	gsl_rng *r = gsl_rng_alloc(gsl_rng_mt19937);
	model_from_name("simple", &s.model);
	for (int i = 0; i < SHOTS; i++)
		hard_pair(&s, r, i);
	/* The first event is the question. What a contact at 1e-5 m/s leads to is decided by how the engine keeps
	 * pressing balls apart. */
	measure_family(&s, csv, "hard pairs", 1);
	gsl_rng_free(r);
}

int main(int argc, char **argv)
{
	if (argc != 2) {
		fprintf(stderr, "usage: %s BUILD\n", argv[0]);
		return EXIT_FAILURE;
	}
	char path[512];
	snprintf(path, sizeof path, "%s/physics.csv", argv[1]);
	FILE *csv = fopen(path, "w");
	if (!csv) {
		perror(path);
		return EXIT_FAILURE;
	}
	for (size_t degree = 3; degree < 5; degree++)
		workspace[degree] = gsl_poly_complex_workspace_alloc(degree + 1);
	fprintf(csv, "family,solver,tolerance,us_per_shot,position_error_m,time_error_s,missed,invented,shots\n");
	run_families(csv);
	for (size_t degree = 3; degree < 5; degree++)
		gsl_poly_complex_workspace_free(workspace[degree]);
	return fclose(csv) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
