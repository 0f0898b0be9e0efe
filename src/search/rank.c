#include "search/rank.h"

#include <math.h>

#include "search/tolerance.h"

enum { JOB_MAX = PLAN_MAX * PLAN_SHOTS_MAX };

/* Shots that are to be looked at; one that several plans begin with is looked at once. */
struct ranking {
	struct planner *planner;
	int count;
	struct {
		struct record *record;
		const struct state *from;
	} job[JOB_MAX];
};

static void add_job(struct ranking *ranking, struct record *record, int32_t from)
{
	if (record->target < 0 || ranking->count == JOB_MAX)
		return;
	for (int i = 0; i < ranking->count; i++)
		if (ranking->job[i].record == record)
			return;
	ranking->job[ranking->count].record = record;
	ranking->job[ranking->count].from = &ranking->planner->task.state[from];
	ranking->count++;
}

static void do_job(void *context, int item, int worker)
{
	struct ranking *ranking = context;
	const struct planner *planner = ranking->planner;
	if (budget_is_over(&planner->budget))
		return;
	tolerance_find(&planner->task, ranking->job[item].from, ranking->job[item].record, &planner->work[worker]);
}

/* Chance that all shots of a plan succeed; what is not known counts for nothing. */
static double chance(const struct planner *planner, const struct solution *solution)
{
	double product = isnan(solution->last.success) ? 0 : solution->last.success;
	for (int32_t at = solution->state; planner->task.state[at].parent != NO_STATE;
	     at = planner->task.state[at].parent)
		product *= isnan(planner->task.state[at].record.success) ? 0 : planner->task.state[at].record.success;
	return product;
}

/* Insertion: stable, so that equal chances stay in the order of cost. */
static void sort_by_chance(const struct planner *planner, struct solutions *list, int count)
{
	for (int i = 1; i < count; i++) {
		uint16_t moved = list->order[i];
		double best = chance(planner, &list->item[moved]);
		int at = i;
		for (; at > 0 && chance(planner, &list->item[list->order[at - 1]]) < best; at--)
			list->order[at] = list->order[at - 1];
		list->order[at] = moved;
	}
}

void rank_solutions(struct planner *planner)
{
	struct solutions *list = results_best(planner->results);
	bool by_success = planner->def.profile.ranking == RANK_SUCCESS;
	int wanted = by_success && planner->task.request->tolerances < RANKED_MAX ? RANKED_MAX
										  : planner->task.request->tolerances;
	struct ranking ranking = {.planner = planner, .count = 0};
	if (!list)
		return;
	int count = list->count < wanted ? list->count : wanted;
	for (int i = 0; i < count; i++) {
		struct solution *s = solutions_at(list, i);
		add_job(&ranking, &s->last, s->state);
		for (int32_t at = s->state; planner->task.state[at].parent != NO_STATE;
		     at = planner->task.state[at].parent)
			add_job(&ranking, &planner->task.state[at].record, planner->task.state[at].parent);
	}
	pool_for(planner->pool, ranking.count, do_job, &ranking);
	if (by_success)
		sort_by_chance(planner, list, count);
}
