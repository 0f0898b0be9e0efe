/* One step of the joint tree: a batch of the best open nodes is worked on, then what came out is merged in order. */
#include "search/step.h"

#include "search/safety.h"

enum {
	FIRST_BATCH = 8, /* nodes at a time in the first slice, where the first answer is looked for */
	SAFETY_STEP = 4	 /* after so many batches without a proposal a simple contact is proposed */
};

static void work_on(void *context, int item, int worker)
{
	struct planner *planner = context;
	slot_work(&planner->task, &planner->slot[planner->claim[item]], &planner->work[worker]);
}

static void open_state(struct planner *planner, const struct solution *solution, const struct rules_outcome *outcome)
{
	if (planner->state_count == STATES_MAX) {
		planner->overflow = true;
		return;
	}
	int index = planner->state_count++;
	struct node root[ROOTS_MAX];
	solution_open(solution, &planner->task, index, outcome);
	int count = state_roots(&planner->task, index, root);
	for (int i = 0; i < count; i++)
		frontier_push(&planner->frontier, &root[i]);
}

static void merge(struct planner *planner, const struct slot *slot, bool *improved)
{
	for (int i = 0; i < COUNT_KINDS; i++)
		planner->count[i] += slot->count[i];
	planner->overflow |= slot->overflow;
	for (int i = 0; i < slot->played_count; i++) {
		struct finding finding = finding_make(&planner->task, (int32_t)slot->node.state, &slot->played[i]);
		*improved |= results_add(planner->results, &finding.solution, finding.shots);
		if (finding.leads_on && finding.solution.cost <= results_limit(planner->results))
			open_state(planner, &finding.solution, &slot->played[i].outcome);
	}
	double limit = results_limit(planner->results);
	for (int i = 0; i < slot->child_count; i++)
		if (slot->child[i].cost <= limit)
			frontier_push(&planner->frontier, &slot->child[i]);
}

static uint64_t nodes_used(const struct planner *planner)
{
	return planner->count[COUNT_NODES] + planner->count[COUNT_SIMS];
}

/* How many nodes this batch may take: all that is left of a node budget at most. */
static int batch_size(struct planner *planner)
{
	uint64_t budget = planner->task.request->budget.nodes, used = nodes_used(planner);
	int size = planner->batch_count < FIRST_SLICE ? FIRST_BATCH : BATCH;
	return budget == 0 || budget - used >= (uint64_t)size ? size : (int)(budget - used);
}

/* Fills the slots with the best open nodes. Returns how many. */
static int fill_batch(struct planner *planner)
{
	int size = batch_size(planner), count = 0;
	while (count < size && planner->frontier.count > 0) {
		planner->slot[count].node = frontier_pop(&planner->frontier);
		count += !state_is_spare(&planner->task, &planner->slot[count].node);
	}
	return count;
}

/* What is simulated takes longest: workers claim it first, so that they are done at about the same time. */
static void order_claims(struct planner *planner, int count)
{
	int at = 0;
	for (int complete = 1; complete >= 0; complete--)
		for (int i = 0; i < count; i++)
			if (planner->slot[i].node.complete == complete)
				planner->claim[at++] = (uint8_t)i;
}

bool search_step(struct planner *planner, bool *improved)
{
	uint64_t budget = planner->task.request->budget.nodes;
	*improved = false;
	if (planner->frontier.count == 0 || frontier_best(&planner->frontier) > results_limit(planner->results))
		return false;
	if (budget_is_over(&planner->budget) || (budget > 0 && nodes_used(planner) >= budget)) {
		planner->cut = true;
		return false;
	}
	int count = fill_batch(planner);
	order_claims(planner, count);
	if (planner->batch_count < FIRST_SLICE)
		for (int i = 0; i < count; i++)
			work_on(planner, i, 0);
	else
		pool_for(planner->pool, count, work_on, planner);
	for (int i = 0; i < count; i++)
		merge(planner, &planner->slot[i], improved);
	if (++planner->batch_count == SAFETY_STEP && !results_best(planner->results))
		*improved = safety_find(planner, false);
	return true;
}
