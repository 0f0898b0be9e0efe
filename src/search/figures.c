#include "search/figures.h"

#include "search/crew.h"

void show_begin(struct planner *planner)
{
	struct shown *shown = &planner->shown;
	shown->nodes_before = atomic_load(&shown->nodes);
	shown->sims_before = atomic_load(&shown->sims);
	atomic_store(&shown->depth, 0);
	atomic_store(&shown->busy, planner->def.workers);
}

void show_step(struct planner *planner)
{
	struct shown *shown = &planner->shown;
	int depth = planner->results->depth;
	while (depth > 0 && planner->results->list[depth - 1].count == 0)
		depth--;
	atomic_store_explicit(&shown->nodes, shown->nodes_before + planner->count[COUNT_NODES], memory_order_relaxed);
	atomic_store_explicit(&shown->sims, shown->sims_before + planner->count[COUNT_SIMS], memory_order_relaxed);
	atomic_store_explicit(&shown->open, planner->frontier.count, memory_order_relaxed);
	atomic_store_explicit(&shown->depth, depth, memory_order_relaxed);
}

void show_end(struct planner *planner)
{
	atomic_store(&planner->shown.busy, 0);
	atomic_store(&planner->shown.open, 0);
}

void planner_figures(const struct planner *planner, struct plan_figures *out)
{
	const struct shown *shown = &planner->shown;
	*out = (struct plan_figures){
		.nodes = atomic_load(&shown->nodes),
		.sims = atomic_load(&shown->sims),
		.open = atomic_load(&shown->open),
		.busy = atomic_load(&shown->busy),
		.depth = atomic_load(&shown->depth),
	};
	if (planner->crew)
		crew_figures(planner->crew, out);
}
