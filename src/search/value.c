/* Life of a value search, and what one played stroke is worth. */
#include "search/value.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "search/value_state.h"

static const uint64_t POINTS_SEED = 0; /* of the error's samples: the same for every search */

int value_create(struct value_search **out, const struct table *table, const struct model *model, struct pool *pool,
		 int workers)
{
	*out = NULL;
	struct value_search *v = calloc(1, sizeof *v);
	if (!v)
		return -ENOMEM;
	v->table = table;
	v->model = *model;
	v->pool = pool;
	v->workers = workers;
	v->worker = calloc((size_t)workers, sizeof *v->worker);
	if (!v->worker) {
		value_destroy(v);
		return -ENOMEM;
	}
	player_error_points(v->point, VALUE_SAMPLES, POINTS_SEED);
	estimator_init(&v->estimator, table, model, &(struct player_error){.angle = 0.005, .speed = 0.05});
	*out = v;
	return 0;
}

void value_destroy(struct value_search *v)
{
	if (!v)
		return;
	free(v->worker);
	free(v);
}

static bool same_error(const struct player_error *a, const struct player_error *b)
{
	return a->angle == b->angle && a->angle_bias == b->angle_bias && a->speed == b->speed &&
	       a->speed_bias == b->speed_bias && a->tip == b->tip && a->side_bias == b->side_bias &&
	       a->follow_bias == b->follow_bias && a->elevation == b->elevation &&
	       a->elevation_bias == b->elevation_bias;
}

void value_set_error(struct value_search *v, const struct player_error *error)
{
	if (!same_error(&v->estimator.error, error))
		estimator_set_error(&v->estimator, error);
}

bool value_is_over(const struct value_search *v)
{
	return v->hooks && v->hooks->is_over && v->hooks->is_over(v->hooks->context);
}

void value_begin(struct value_search *v, const struct value_request *request)
{
	v->request = *request;
	v->stroke_count = v->opening_count = 0;
	for (int i = 0; i < v->workers; i++)
		v->worker[i].sims = 0;
}

void value_add(struct value_search *v, int root, const struct record *record)
{
	if (v->stroke_count == VALUE_ADDED)
		return;
	struct stroke *stroke = &v->stroke[v->stroke_count++];
	*stroke = (struct stroke){.record = *record, .root = root, .opening = -1, .value = -1000};
}

bool value_play(struct value_search *v, struct value_worker *worker, int root, struct record *record,
		struct rules_outcome *outcome)
{
	const struct value_root *r = &v->request.root[root];
	worker->sims++;
	const struct setting from = {v->table, &v->model, r->ball, v->request.ball_count, &r->rules};
	return shot_play(&worker->work, &from, record, outcome);
}

double value_of_outcome(struct value_search *v, struct value_worker *worker, const struct record *record,
			const struct rules_outcome *outcome, bool deep)
{
	int count = v->request.ball_count;
	if (record->foul == 0 && record->points > 0) {
		const struct setting next = {v->table, &v->model, outcome->ball, count, &outcome->next};
		return record->points +
		       (deep ? value_next_shot(v, worker, &next) : estimate_value(&v->estimator, &next));
	}
	if (outcome->next.on == ON_ANY)
		return -record->foul; /* practice: no opponent, and a miss gains nothing */
	struct rules_state theirs = record->foul > 0 ? rules_opponent(v->table, outcome, count)
						     : rules_state_from_position(outcome->ball, count);
	theirs.in_hand = outcome->cue_potted;
	theirs.any_first = outcome->next.any_first;
	const struct setting next = {v->table, &v->model, outcome->ball, count, &theirs};
	return -record->foul - estimate_value(&v->estimator, &next);
}

static bool is_before(const struct stroke *a, const struct stroke *b)
{
	if (a->plies != b->plies)
		return a->plies > b->plies;
	if (a->left != b->left)
		return a->left < b->left;
	if (a->value != b->value)
		return a->value > b->value;
	return a->key < b->key;
}

void value_sort(struct value_search *v)
{
	for (int i = 0; i < v->stroke_count; i++) {
		int at = i;
		for (; at > 0 && is_before(&v->stroke[i], &v->stroke[v->order[at - 1]]); at--)
			v->order[at] = v->order[at - 1];
		v->order[at] = (uint16_t)i;
	}
}

const struct stroke *value_result(const struct value_search *v, int rank)
{
	if (rank < 0 || rank >= v->stroke_count || rank >= VALUE_RESULTS)
		return NULL;
	return &v->stroke[v->order[rank]];
}

int value_root_index(const struct value_search *v, int root)
{
	return v->request.root[root].index;
}

const struct estimator *value_estimator(const struct value_search *v)
{
	return &v->estimator;
}

uint64_t value_sims(const struct value_search *v)
{
	uint64_t sum = 0;
	for (int i = 0; i < v->workers; i++)
		sum += v->worker[i].sims;
	return sum;
}

/* Below this value (points) of the best pot a safety shot may be better. */
static bool wants_safety(const struct value_search *v)
{
	if (v->stroke_count == 0)
		return true;
	const struct stroke *best = &v->stroke[v->order[0]];
	return best->chance < 0.8 || best->value < 1;
}

void value_run(struct value_search *v, const struct value_hooks *hooks)
{
	v->hooks = hooks;
	value_open(v);
	if (wants_safety(v))
		value_find_safeties(v);
	value_race(v);
	v->hooks = NULL;
}
