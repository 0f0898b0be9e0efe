#include "search/export.h"

void shot_export(const struct record *record, const struct ball *ball, int count, struct plan_shot *out)
{
	*out = (struct plan_shot){
		.shot = record->shot,
		.target = record->target,
		.pocket = record->pocket,
		.chain_count = record->chain_count,
		.rails = record->rails,
		.potted_count = record->potted_count,
		.points = record->points,
		.foul = record->foul,
		.search_cost = record->search_cost,
		.cost = record->cost,
		.tolerance_angle = record->tolerance_angle,
		.tolerance_speed = record->tolerance_speed,
		.success = record->success,
		.value = NAN,
		.leave_radius = NAN,
		.why_ball = -1,
		.hash = record->hash,
	};
	for (int i = 0; i < count; i++)
		out->start[i] = ball[i];
	for (int i = 0; i < PLAN_CHAIN_MAX; i++)
		out->chain[i] = record->chain[i];
	for (int i = 0; i < record->potted_count; i++) {
		out->potted[i].ball = record->potted[i].ball;
		out->potted[i].pocket = record->potted[i].pocket;
	}
}

static void export_plan(const struct planner *planner, const struct solution *solution, struct plan *plan)
{
	const struct state *from = &planner->task.state[solution->state];
	int shots = from->shots + 1;
	plan->shot_count = shots;
	plan->cost = solution->cost;
	shot_export(&solution->last, from->ball, planner->task.ball_count, &plan->shot[shots - 1]);
	for (int i = shots - 2; i >= 0; i--) {
		const struct state *before = &planner->task.state[from->parent];
		shot_export(&from->record, before->ball, planner->task.ball_count, &plan->shot[i]);
		from = before;
	}
}

void planner_export(struct planner *planner, int limit, struct plan_result *result)
{
	struct solutions *list = results_best(planner->results);
	*result = (struct plan_result){
		.plan = planner->plan,
		.found = list ? list->count : 0,
		.nodes = planner->count[COUNT_NODES],
		.sims = planner->count[COUNT_SIMS],
		.tried = planner->count[COUNT_TRIED],
		.landed = planner->count[COUNT_LANDED],
		.refined = planner->count[COUNT_REFINED],
		.exhausted = !planner->cut && !planner->overflow,
	};
	if (result->found > planner->task.request->plans)
		result->found = planner->task.request->plans;
	result->plan_count = limit > 0 && limit < result->found ? limit : result->found;
	for (int i = 0; i < result->plan_count; i++)
		export_plan(planner, solutions_at(list, i), &planner->plan[i]);
	result->status = result->plan_count > 0 ? PLAN_OK : PLAN_NONE;
}
