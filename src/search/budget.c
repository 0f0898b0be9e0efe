#include "search/budget.h"

double budget_now(const struct budget *budget)
{
	return budget->now ? budget->now(budget->now_context) : 0;
}

void budget_cancel(struct budget *budget, uint64_t run)
{
	uint64_t before = atomic_load_explicit(&budget->cancelled, memory_order_relaxed);
	while (before < run && !atomic_compare_exchange_weak_explicit(&budget->cancelled, &before, run,
								      memory_order_relaxed, memory_order_relaxed))
		continue;
}

bool budget_is_cancelled(const struct budget *budget)
{
	return budget->run > 0 && budget->run <= atomic_load_explicit(&budget->cancelled, memory_order_relaxed);
}

bool budget_is_over(const struct budget *budget)
{
	return budget_is_cancelled(budget) || (budget->now && budget_now(budget) >= budget->deadline);
}
