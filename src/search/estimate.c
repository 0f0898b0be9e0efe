#include "search/estimate.h"

#include "search/geometry.h"
#include "search/respot.h"

/* A ball is sent to a pocket at about this speed (m/s): the window's, when no shot is known. */
static const double POT_SPEED = 1.5;
static const double CUT_MIN_COS = 0.139; /* 82 degrees: thinner cuts are not estimated */
static const double COLOUR_POINTS = 5.3; /* mean of the colour that follows a red in a good visit */
/* Share of what the average visit brings that a miss leaves to the opponent, and that a safety shot leaves. */
static const double MISS_SHARE = 0.35, SAFE_SHARE = 0.06;
static const double SNOOKERED = -2; /* points: no ball on can be hit directly */
static const double LEAST_GAIN = 0.2;
static const double BEHIND = -0.2; /* cosine of the way into a pocket's middle with the line of centres */
static const double TOUCHING = 1e-4, OVERLAP = 1e-3; /* m; share of the diameter that a camera's errors make */
static const double EDGE = 0.9;			     /* of the diameter beside the middle: a thin contact */
/* An error of the tip, as a share of the radius, is felt as so many radians of the aim: swerve. Measured: at half a
 * radius of side and 2 m/s, 0.01 over a metre. */
static const double TIP_TO_ANGLE = 0.02;

double within_chance(double half, double bias, double sigma)
{
	if (sigma <= 0)
		return fabs(bias) < half ? 1 : 0;
	double k = 1 / (sigma * M_SQRT2);
	return (erf((half - bias) * k) + erf((half + bias) * k)) / 2;
}

static int find_cue(const struct setting *from)
{
	for (int i = 0; i < from->count; i++)
		if (from->ball[i].colour == COLOUR_WHITE && from->ball[i].phase != BALL_POTTED)
			return i;
	return -1;
}

static int count_reds(const struct setting *from)
{
	int reds = 0;
	for (int i = 0; i < from->count; i++)
		reds += from->ball[i].colour == COLOUR_RED && from->ball[i].phase != BALL_POTTED;
	return reds;
}

static int points_of(const struct ball *ball)
{
	return ball->colour >= COLOUR_RED && ball->colour <= COLOUR_BLACK ? (int)ball->colour : 0;
}

/* 1 in a frame; less in positions laid out without all colours, where a red is followed by less. */
static double share_of_colours(const struct setting *from)
{
	int colours = 0;
	for (int i = 0; i < from->count; i++)
		colours += from->ball[i].colour >= COLOUR_YELLOW && from->ball[i].colour <= COLOUR_BLACK &&
			   from->ball[i].phase != BALL_POTTED;
	return fmin(1, colours / 6.0);
}

/* Any ball is on: what the balls but one may bring. */
static double practice_visit(const struct estimator *e, const struct setting *from)
{
	static const double POINTS = 3; /* of a ball, about */
	double sum = 0;
	int left = -1;
	for (int i = 0; i < from->count; i++)
		left += rules_ball_on(from->rules, from->ball, from->count, i);
	for (int i = 0; i < left; i++)
		sum = e->flow * (POINTS + sum);
	return sum;
}

/* What the visit may bring after this pot. */
static double after_pot(const struct estimator *e, const struct setting *from, int index)
{
	int reds = count_reds(from);
	switch (from->rules->on) {
	case ON_RED:
		return share_of_colours(from) * e->going_on[ON_COLOUR][reds > 0 ? reds - 1 : 0];
	case ON_COLOUR:
		return share_of_colours(from) *
		       (reds > 0 ? e->going_on[ON_RED][reds] : e->going_on[ON_CLEARANCE][COLOUR_YELLOW]);
	case ON_CLEARANCE:
		if (from->ball[index].colour >= COLOUR_BLACK)
			return 0;
		return e->going_on[ON_CLEARANCE][from->ball[index].colour + 1];
	default:
		return practice_visit(e, from);
	}
}

/* What the average visit from here brings. */
static double average_visit(const struct estimator *e, const struct setting *from)
{
	int reds = count_reds(from);
	if (from->rules->on == ON_ANY)
		return 0; /* practice: no opponent gains by a miss */
	if (reds > 0) {
		double share = share_of_colours(from);
		return share * e->going_on[ON_RED][reds] + (1 - share) * e->flow;
	}
	for (int c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++)
		for (int i = 0; i < from->count; i++)
			if (from->ball[i].phase != BALL_POTTED && (int)from->ball[i].colour == c)
				return e->going_on[ON_CLEARANCE][c];
	return 0;
}

static void fill_going_on(struct estimator *e)
{
	double f = e->flow, next = 0;
	for (int c = COLOUR_BLACK; c >= COLOUR_YELLOW; c--)
		next = e->going_on[ON_CLEARANCE][c] = f * (c + next);
	e->going_on[ON_RED][0] = next;
	for (int reds = 0; reds < 16; reds++) {
		if (reds > 0)
			e->going_on[ON_RED][reds] = f * (1 + e->going_on[ON_COLOUR][reds - 1]);
		e->going_on[ON_COLOUR][reds] = f * (COLOUR_POINTS + e->going_on[ON_RED][reds]);
	}
}

/* Ways and cut of an object ball into pot->pocket, whatever stands in the way. False when it cannot be. */
static bool set_ways(const struct estimator *e, vec2 white, vec2 object, struct pot *pot)
{
	double d = 2 * e->table->ball_radius;
	vec2 centre = e->table->pocket[pot->pocket].centre;
	vec2 way = vec2_unit(vec2_sub(centre, object));
	double apart = vec2_dist(object, white);
	if (vec2_dot(way, vec2_sub(object, white)) < BEHIND * apart)
		return false; /* half of all pockets lie behind: they need not be looked at closer */
	struct acceptance_window w = acceptance_at(&e->acceptance, e->table, pot->pocket, way, POT_SPEED);
	if (w.high <= w.low)
		return false;
	pot->goal = vec2_madd(centre, (w.low + w.high) / 2, vec2_perp(way));
	double far = vec2_dist(pot->goal, object);
	if (far < TOUCHING || apart < d * (1 - OVERLAP))
		return false;
	pot->way = vec2_scale(vec2_sub(pot->goal, object), 1 / far);
	vec2 aim = vec2_sub(vec2_madd(object, -d, pot->way), white);
	vec2 axis = vec2_scale(vec2_sub(object, white), 1 / apart);
	/* a ball that touches can only be played along the line of centres */
	vec2 direction = vec2_norm(aim) < TOUCHING ? pot->way : vec2_unit(aim);
	double cos_cut = vec2_dot(direction, pot->way);
	if (cos_cut < CUT_MIN_COS || vec2_dot(axis, pot->way) <= 0)
		return false;
	pot->angle = atan2(direction.y, direction.x);
	/* D sin(aim) = d sin(impact): differentiated */
	pot->gain = fmax(LEAST_GAIN, apart * vec2_dot(direction, axis) / (d * cos_cut));
	pot->half = atan2((w.high - w.low) / 2, far);
	return true;
}

double aim_sigma(const struct player_error *error)
{
	return hypot(error->angle, TIP_TO_ANGLE * error->tip);
}

/* Fills in what the pot is worth; its ball, pocket, brings and costs are set. */
static bool price(const struct estimator *e, const struct setting *from, int cue, struct pot *pot)
{
	if (!set_ways(e, from->ball[cue].pos, from->ball[pot->ball].pos, pot))
		return false;
	double bias = pot->gain * e->error.angle_bias;
	pot->chance = within_chance(pot->half, bias, pot->gain * aim_sigma(&e->error));
	pot->value = pot->chance * pot->brings - (1 - pot->chance) * pot->costs;
	return true;
}

static bool is_open(const struct estimator *e, const struct setting *from, int cue, const struct pot *pot)
{
	double d = 2 * e->table->ball_radius;
	vec2 at = from->ball[pot->ball].pos, ghost = vec2_madd(at, -d, pot->way);
	const struct obstacles others = {from->ball, from->count, ~(1u << pot->ball | 1u << cue)};
	return segment_is_free(&others, at, pot->goal, d) && segment_is_free(&others, from->ball[cue].pos, ghost, d);
}

static struct pot pot_of(const struct estimator *e, const struct setting *from, int ball, double costs)
{
	return (struct pot){
		.ball = (int16_t)ball,
		.brings = points_of(&from->ball[ball]) + after_pot(e, from, ball),
		.costs = costs,
	};
}

static void insert_pot(struct pot *list, int *count, const struct pot *pot)
{
	int at = *count < POTS_MAX ? (*count)++ : POTS_MAX;
	for (; at > 0 && pot->value > list[at - 1].value; at--)
		if (at < POTS_MAX)
			list[at] = list[at - 1];
	if (at < POTS_MAX)
		list[at] = *pot;
}

int estimate_pots(const struct estimator *e, const struct setting *from, double least, struct pot list[POTS_MAX])
{
	int found = 0, cue = find_cue(from);
	double costs = MISS_SHARE * average_visit(e, from);
	for (int i = 0; cue >= 0 && i < from->count; i++) {
		if (!rules_ball_on(from->rules, from->ball, from->count, i))
			continue;
		struct pot pot = pot_of(e, from, i, costs);
		for (pot.pocket = 0; pot.pocket < e->table->pocket_count; pot.pocket++)
			if (price(e, from, cue, &pot) && pot.chance >= least && is_open(e, from, cue, &pot))
				insert_pot(list, &found, &pot);
	}
	return found;
}

/* A ball on that can be hit full, or at an edge, directly. */
static bool can_hit(const struct estimator *e, const struct setting *from, int cue)
{
	double d = 2 * e->table->ball_radius;
	vec2 white = from->ball[cue].pos;
	for (int i = 0; i < from->count; i++) {
		if (!rules_ball_on(from->rules, from->ball, from->count, i))
			continue;
		const struct obstacles others = {from->ball, from->count, ~(1u << i | 1u << cue)};
		vec2 across = vec2_perp(vec2_unit(vec2_sub(from->ball[i].pos, white)));
		for (int side = -1; side <= 1; side++)
			if (segment_is_free(&others, white, vec2_madd(from->ball[i].pos, EDGE * side * d, across), d))
				return true;
	}
	return false;
}

static double value_from(const struct estimator *e, const struct setting *from, int cue)
{
	double average = average_visit(e, from);
	double best = -SAFE_SHARE * average;
	bool any = false;
	for (int i = 0; i < from->count; i++) {
		if (!rules_ball_on(from->rules, from->ball, from->count, i))
			continue;
		struct pot pot = pot_of(e, from, i, MISS_SHARE * average);
		for (pot.pocket = 0; pot.pocket < e->table->pocket_count; pot.pocket++) {
			/* what is not better need not be open */
			if (!price(e, from, cue, &pot) || pot.value <= best || !is_open(e, from, cue, &pot))
				continue;
			best = pot.value;
			any = true;
		}
	}
	if (!any && average > 0 && !can_hit(e, from, cue))
		return SNOOKERED - SAFE_SHARE * average;
	return best;
}

/* The best of some places in the D. */
static double value_in_hand(const struct estimator *e, const struct setting *from)
{
	static const double place[][2] = {{0, 0}, {0, 0.95}, {0, -0.95}, {0, 0.5}, {0, -0.5}, {0.6, 0.4}, {0.6, -0.4}};
	const struct table *table = e->table;
	struct ball copy[BALL_MAX];
	int cue = -1;
	for (int i = 0; i < from->count; i++) {
		copy[i] = from->ball[i];
		if (copy[i].colour == COLOUR_WHITE)
			cue = i;
	}
	if (cue < 0)
		return 0;
	struct setting placed = *from;
	placed.ball = copy;
	double best = -INFINITY;
	for (size_t k = 0; k < sizeof place / sizeof *place; k++) {
		copy[cue].phase = BALL_POTTED;
		vec2 at = {table->baulk_d_centre.x - place[k][0] * table->baulk_d_radius,
			   table->baulk_d_centre.y + place[k][1] * table->baulk_d_radius};
		if (!respot_is_free(table, copy, from->count, at))
			continue;
		copy[cue] = ball_at(COLOUR_WHITE, at);
		best = fmax(best, value_from(e, &placed, cue));
	}
	return isfinite(best) ? best : 0;
}

double estimate_value(const struct estimator *e, const struct setting *from)
{
	int cue = find_cue(from);
	if (from->rules->in_hand || cue < 0)
		return value_in_hand(e, from);
	return value_from(e, from, cue);
}

/* ---- how well this player keeps a visit going -----------------------------------------------------------------------
 */

enum { TRIALS = 200, TRIAL_REDS = 6 };

static double uniform(uint64_t *state)
{
	uint64_t z = (*state += 0x9e3779b97f4a7c15u);
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static vec2 free_place(const struct table *table, const struct ball *ball, int count, uint64_t *state)
{
	vec2 at = {0, 0};
	for (int i = 0; i < 100; i++) {
		at.x = (uniform(state) - 0.5) * (table->length - 2 * table->ball_radius);
		at.y = (uniform(state) - 0.5) * (table->width - 2 * table->ball_radius);
		if (respot_is_free(table, ball, count, at))
			break;
	}
	return at;
}

/* Mean chance of the best pot over random positions: reds on, then colours. */
static double mean_best_chance(const struct estimator *e)
{
	uint64_t state = 2021;
	double sum = 0;
	for (int t = 0; t < TRIALS; t++) {
		struct ball ball[BALL_MAX];
		int count = 0;
		for (int c = COLOUR_YELLOW; c <= COLOUR_BLACK; c++)
			ball[count++] = ball_at((enum ball_colour)c, e->table->spot[c]);
		for (int i = 0; i < TRIAL_REDS; i++, count++)
			ball[count] = ball_at(COLOUR_RED, free_place(e->table, ball, count, &state));
		ball[count] = ball_at(COLOUR_WHITE, free_place(e->table, ball, count, &state));
		count++;
		struct rules_state rules = {.on = t % 2 ? ON_COLOUR : ON_RED};
		const struct setting from = {e->table, NULL, ball, count, &rules};
		struct pot pot[POTS_MAX];
		int pots = estimate_pots(e, &from, 0, pot);
		double best = 0;
		for (int i = 0; i < pots; i++)
			best = fmax(best, pot[i].chance);
		sum += best;
	}
	return sum / TRIALS;
}

/* Position play chooses: what it leaves is as good as the best of this many random positions. Fitted to visits played
 * (docs/results/play.md): shots of a visit under way succeed in 0.97 of all at 0.1 degrees, in 0.77 at 0.3. */
static const double CHOICES = 2.4;

void estimator_set_error(struct estimator *e, const struct player_error *error)
{
	e->error = *error;
	e->flow = 0.5;
	fill_going_on(e);
	e->flow = 1 - pow(1 - mean_best_chance(e), CHOICES);
	fill_going_on(e);
}

void estimator_init(struct estimator *e, const struct table *table, const struct model *model,
		    const struct player_error *error)
{
	*e = (struct estimator){.table = table};
	acceptance_measure(&e->acceptance, table, model);
	estimator_set_error(e, error);
}
