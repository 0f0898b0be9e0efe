#include "physics/bed.h"

#include "physics/tolerances.h"

double bed_height(const struct bed *bed, vec2 pos)
{
	return vec2_dot(bed->slope, pos) +
	       0.5 * (bed->bowl[0] * pos.x * pos.x + 2 * bed->bowl[1] * pos.x * pos.y + bed->bowl[2] * pos.y * pos.y);
}

/* Way up: rise per way along x and y. */
static vec2 bed_gradient(const struct bed *bed, vec2 pos)
{
	return (vec2){bed->slope.x + bed->bowl[0] * pos.x + bed->bowl[1] * pos.y,
		      bed->slope.y + bed->bowl[1] * pos.x + bed->bowl[2] * pos.y};
}

/* ---- equations of motion ---- */

/* A ball's motion in one phase. What friction works against is the slip of a sliding ball and the velocity of a rolling
 * one; it keeps nothing but its direction, and its end is the phase's. */
struct course {
	vec2 pos, vel, against; /* m, m/s, m/s */
};

struct law {
	const struct bed *bed;
	double pull;	/* m/s^2 that the centre feels per slope */
	double brake;	/* m/s^2, friction on the centre */
	double decline; /* m/s^2, by which friction shortens `against` */
};

static struct law law_of(enum ball_phase phase, const struct table *table)
{
	const struct material *m = &table->material;
	if (phase == BALL_ROLLING)
		return (struct law){&table->bed, 5.0 / 7 * m->gravity, m->mu_roll * m->gravity,
				    m->mu_roll * m->gravity};
	return (struct law){&table->bed, m->gravity, m->mu_slide * m->gravity, 3.5 * m->mu_slide * m->gravity};
}

static struct course course_of(const struct ball *ball, double radius)
{
	vec2 slip = {ball->vel.x - radius * ball->spin[1], ball->vel.y + radius * ball->spin[0]};
	return (struct course){ball->pos, ball->vel, ball->phase == BALL_ROLLING ? ball->vel : slip};
}

static struct course rates(const struct law *law, const struct course *at)
{
	vec2 pull = vec2_scale(bed_gradient(law->bed, at->pos), -law->pull), along = vec2_unit(at->against);
	return (struct course){at->vel, vec2_madd(pull, -law->brake, along), vec2_madd(pull, -law->decline, along)};
}

static struct course moved(const struct course *from, double dt, const struct course *rate)
{
	return (struct course){vec2_madd(from->pos, dt, rate->pos), vec2_madd(from->vel, dt, rate->vel),
			       vec2_madd(from->against, dt, rate->against)};
}

/* One classical Runge-Kutta step. */
static struct course stepped(const struct law *law, const struct course *from, double h)
{
	struct course k1 = rates(law, from), at = moved(from, 0.5 * h, &k1), k2 = rates(law, &at);
	at = moved(from, 0.5 * h, &k2);
	struct course k3 = rates(law, &at);
	at = moved(from, h, &k3);
	struct course k4 = rates(law, &at);
	at = moved(from, h / 6, &k1);
	at = moved(&at, h / 3, &k2);
	at = moved(&at, h / 3, &k3);
	return moved(&at, h / 6, &k4);
}

/* ---- pieces ---- */

/* A cubic differs from the parabola between its ends by at most 2/81 of its third derivative times the cube of the
 * time. */
static double longest_piece(double path_error, double third)
{
	return cbrt(40.5 * path_error / third);
}

static double bowl_size(const struct bed *bed)
{
	return fabs(bed->bowl[0]) + 2 * fabs(bed->bowl[1]) + fabs(bed->bowl[2]);
}

struct bed_piece bed_piece(const struct ball *ball, const struct table *table)
{
	struct law law = law_of(ball->phase, table);
	struct course at = course_of(ball, table->ball_radius);
	vec2 pull = vec2_scale(bed_gradient(law.bed, at.pos), -law.pull), along = vec2_unit(at.against);
	double size = vec2_norm(at.against), across = fabs(vec2_cross(along, pull));
	double left = size / (law.decline - vec2_dot(pull, along)); /* s, were the direction to stay; bed_holds() */
	double bowl = law.pull * bowl_size(law.bed) * vec2_norm(at.vel);
	double error = law.bed->path_error;
	bool last = 0.5 * across * left * left <= LAST_PIECE * error && left <= longest_piece(error, bowl);
	if (last || size == 0)
		return (struct bed_piece){vec2_madd(pull, -law.brake, along), left, true};
	/* friction turns with what it works against, ever faster as that shortens: at most by half in a piece */
	double h = longest_piece(error, 2 * law.brake * across / size + bowl);
	h = fmin(h, fmin(0.5 * left, PIECE_TURN * size / across));
	struct course end = stepped(&law, &at, h);
	vec2 way = vec2_madd(vec2_sub(end.pos, at.pos), -h, at.vel);
	return (struct bed_piece){vec2_scale(way, 2 / (h * h)), h, false};
}

void bed_turn(const struct ball *from, const struct table *table, double dt, struct ball *to)
{
	double r = table->ball_radius;
	struct law law = law_of(from->phase, table);
	struct course at = course_of(from, r), rate = rates(&law, &at);
	at = bed_piece(from, table).last ? moved(&at, dt, &rate) : stepped(&law, &at, dt);
	to->vel = at.vel;
	vec2 rim = from->phase == BALL_ROLLING ? at.vel : vec2_sub(at.vel, at.against);
	to->spin[0] = -rim.y / r;
	to->spin[1] = rim.x / r;
}

/* The slope grows from the middle to the corners; pockets reach a little beyond. */
bool bed_holds(const struct table *table)
{
	const struct material *m = &table->material;
	double most = STEEPEST * fmin(1.4 * m->mu_roll, 3.5 * m->mu_slide);
	for (int i = 0; i < 4; i++) {
		vec2 corner = {(i & 1 ? 0.55 : -0.55) * table->length, (i & 2 ? 0.55 : -0.55) * table->width};
		if (!(vec2_norm(bed_gradient(&table->bed, corner)) <= most))
			return false;
	}
	return true;
}
