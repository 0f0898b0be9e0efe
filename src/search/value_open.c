/* From positions to strokes: every direct pot over speeds and tip places, each aimed in the simulation. */
#include <string.h>

#include "search/value_state.h"

/* m/s; the useful range, in steps of about 30 %. */
static const double SPEEDS[] = {0.5, 0.65, 0.85, 1.1, 1.45, 1.9, 2.5, 3.2, 4.1, 5.2};
/* Share of the radius, within the miscue limit of a half. */
static const double FOLLOWS[] = {0, 0.4, -0.4, 0.2, -0.2}, SIDES[] = {0, 0.3, -0.3};
/* The least chance of a pot that is opened. */
static const double CHANCE_MIN = 0.03;

enum { SPEED_COUNT = sizeof SPEEDS / sizeof *SPEEDS };

/* How finely a pot is opened: every speed_step-th speed, the first follows and sides. */
static const struct {
	int speed_step, follows, sides;
} grids[] = {{2, 3, 1}, {1, 3, 1}, {1, 5, 1}, {1, 5, 3}};

/* Simulations of one stroke: one whole, and the few short ones of the aim count as half. */
static const double STROKE_SIMS = 1.5;
static const double OPEN_SHARE = 0.25; /* of all simulations */

static void set_record(const struct value_search *v, const struct opening *opening, const struct aimed *aimed,
		       struct record *record)
{
	memset(record, 0, sizeof *record);
	record->shot = aimed->shot;
	record->target = opening->pot.ball;
	record->pocket = opening->pot.pocket;
	record->chain[0] = (int16_t)v->request.cue;
	record->chain[1] = opening->pot.ball;
	record->chain[2] = record->chain[3] = -1;
	record->chain_count = 2;
	record->success = aimed->chance;
	record->tolerance_angle = opening->pot.half / fmax(aimed->gain, 1e-6);
}

bool value_try(struct value_search *v, struct value_worker *worker, const struct opening *opening,
	       const struct shot *shot, struct stroke *out)
{
	const struct value_root *root = &v->request.root[opening->root];
	struct aimed aimed = {.shot = *shot};
	struct rules_outcome outcome;
	if (!stroke_aim(&v->estimator, &v->model, &root->ball[v->request.cue], &root->ball[opening->pot.ball],
			&opening->pot, &aimed))
		return false;
	*out = (struct stroke){.root = opening->root, .opening = (int)(opening - v->opening), .chance = aimed.chance};
	set_record(v, opening, &aimed, &out->record);
	if (!value_play(v, worker, opening->root, &out->record, &outcome) || out->record.foul != 0 ||
	    !shot_is_as_meant(&out->record))
		return false;
	double end = value_of_outcome(v, worker, &out->record, &outcome, false);
	out->value = aimed.chance * end - (1 - aimed.chance) * opening->pot.costs;
	return true;
}

static void keep(struct stroke *list, int *count, int most, const struct stroke *stroke)
{
	int at = *count;
	while (at > 0 && stroke->value > list[at - 1].value)
		at--;
	if (at == most)
		return;
	if (*count < most)
		(*count)++;
	memmove(&list[at + 1], &list[at], (size_t)(*count - 1 - at) * sizeof *stroke);
	list[at] = *stroke;
}

/* All strokes of one grid at a pot; the best of them. */
static int open_pot(struct value_search *v, struct value_worker *worker, const struct opening *opening, int grid,
		    struct stroke list[VALUE_PER_POT])
{
	int count = 0, step = grids[grid].speed_step;
	for (int s = step - 1; s < SPEED_COUNT && SPEEDS[s] <= v->request.max_speed; s += step)
		for (int f = 0; f < grids[grid].follows; f++)
			for (int side = 0; side < grids[grid].sides; side++) {
				struct shot shot = {.speed = SPEEDS[s], .follow = FOLLOWS[f], .side = SIDES[side]};
				struct stroke stroke;
				if (!value_is_over(v) && value_try(v, worker, opening, &shot, &stroke))
					keep(list, &count, VALUE_PER_POT, &stroke);
			}
	return count;
}

static void open_item(void *context, int item, int worker)
{
	struct value_search *v = context;
	struct stroke *list = &v->stroke[item * VALUE_PER_POT];
	int count = open_pot(v, &v->worker[worker], &v->opening[item], v->grid, list);
	for (int i = count; i < VALUE_PER_POT; i++)
		list[i].samples = -1; /* no stroke */
}

static void add_opening(struct value_search *v, const struct pot *pot, int root)
{
	int at = v->opening_count < VALUE_POTS ? v->opening_count++ : VALUE_POTS;
	for (; at > 0 && pot->value > v->opening[at - 1].pot.value; at--)
		if (at < VALUE_POTS)
			v->opening[at] = v->opening[at - 1];
	if (at < VALUE_POTS)
		v->opening[at] = (struct opening){*pot, root};
}

static void find_pots(struct value_search *v)
{
	v->opening_count = 0;
	for (int r = 0; r < v->request.root_count; r++) {
		const struct value_root *root = &v->request.root[r];
		const struct setting from = {v->table, &v->model, root->ball, v->request.ball_count, &root->rules};
		struct pot pot[POTS_MAX];
		int pots = estimate_pots(&v->estimator, &from, CHANCE_MIN, pot);
		for (int i = 0; i < pots; i++)
			if (root->wanted >> pot[i].ball & 1)
				add_opening(v, &pot[i], r);
	}
}

/* The finest grid that its share of the simulations pays for, and then as many pots. */
static void choose_grid(struct value_search *v)
{
	double sims = OPEN_SHARE * (double)v->request.sims;
	int pots = v->opening_count < 6 ? v->opening_count : 6, most = 0;
	v->grid = 0;
	for (int g = 0; g < (int)(sizeof grids / sizeof *grids); g++) {
		double each = STROKE_SIMS * (SPEED_COUNT / grids[g].speed_step) * grids[g].follows * grids[g].sides;
		if (g > 0 && each * pots > sims)
			break;
		v->grid = g;
		most = (int)fmax(3, sims / each);
	}
	if (v->opening_count > most)
		v->opening_count = most;
}

/* Shots found elsewhere are played once; how often they succeed only their samples tell. */
static void price_added(struct value_search *v, struct stroke *stroke)
{
	static const double UNKNOWN_CHANCE = 0.5;
	struct rules_outcome outcome;
	if (value_play(v, &v->worker[0], stroke->root, &stroke->record, &outcome) && stroke->record.foul == 0)
		stroke->value = UNKNOWN_CHANCE * value_of_outcome(v, &v->worker[0], &stroke->record, &outcome, false);
	stroke->chance = UNKNOWN_CHANCE;
}

void value_open(struct value_search *v)
{
	struct stroke added[VALUE_ADDED];
	int added_count = v->stroke_count < VALUE_ADDED ? v->stroke_count : VALUE_ADDED, count = 0;
	memcpy(added, v->stroke, (size_t)added_count * sizeof *added);
	find_pots(v);
	choose_grid(v);
	pool_for(v->pool, v->opening_count, open_item, v);
	for (int i = 0; i < v->opening_count * VALUE_PER_POT; i++)
		if (v->stroke[i].samples >= 0)
			v->stroke[count++] = v->stroke[i];
	for (int i = 0; i < added_count; i++) {
		price_added(v, &added[i]);
		v->stroke[count++] = added[i];
	}
	v->stroke_count = count;
	for (int i = 0; i < count; i++)
		v->stroke[i].key = (uint32_t)i;
	value_sort(v);
}

double value_next_shot(struct value_search *v, struct value_worker *worker, const struct setting *from)
{
	enum { NEXT_POTS = 3, NEXT_SPEEDS = 4, NEXT_FOLLOWS = 3 };
	static const double speeds[NEXT_SPEEDS] = {0.8, 1.4, 2.2, 3.4};
	double best = estimate_value(&v->estimator, from);
	struct pot pot[POTS_MAX];
	struct record record;
	struct rules_outcome outcome;
	if (from->rules->in_hand)
		return best;
	int pots = estimate_pots(&v->estimator, from, CHANCE_MIN, pot);
	double found = -INFINITY;
	for (int i = 0; i < pots && i < NEXT_POTS; i++) {
		struct opening opening = {pot[i], 0};
		for (int k = 0; k < NEXT_SPEEDS * NEXT_FOLLOWS; k++) {
			struct aimed aimed = {
				.shot = {.speed = speeds[k / NEXT_FOLLOWS], .follow = FOLLOWS[k % NEXT_FOLLOWS]}};
			if (value_is_over(v) || !stroke_aim(&v->estimator, &v->model, &from->ball[v->request.cue],
							    &from->ball[pot[i].ball], &pot[i], &aimed))
				continue;
			set_record(v, &opening, &aimed, &record);
			worker->sims++;
			if (!shot_play(&worker->work, from, &record, &outcome) || record.foul != 0 ||
			    record.points == 0)
				continue;
			double end = value_of_outcome(v, worker, &record, &outcome, false);
			found = fmax(found, aimed.chance * end - (1 - aimed.chance) * pot[i].costs);
		}
	}
	return isfinite(found) ? fmax(found, fmin(best, 0)) : best;
}
