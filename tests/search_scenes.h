/* Positions and requests that the tests and benches of the search share. */
#ifndef BILLIARD_TESTS_SEARCH_SCENES_H
#define BILLIARD_TESTS_SEARCH_SCENES_H

#include "harness.h"
#include "search/plan.h"

/* A request for those balls that wants all there is: chains of three balls, every plan, no tolerances, no budget. */
struct plan_request scene_request(const struct ball *ball, int count);

/* count balls (the cue ball first, reds, one of each colour from 8 balls on) at random places, apart by at least gap
 * (m). */
void scene_random(struct random *random, const struct table *table, double gap, struct ball *ball, int count);

/* All 22 balls after a break shot on that table; variant moves the cue ball a little. */
void scene_after_break(const struct table *table, int variant, struct ball ball[BALL_MAX]);

/* A planner for that table; model by name. Stops the test when it cannot be made. */
struct planner *scene_planner(const struct table *table, const char *model, const struct cost_profile *profile,
			      int workers);

/* Runs a request that must be accepted. */
struct plan_result scene_run(struct planner *planner, const struct plan_request *request);

/* Folds all that a result says into one number. */
uint64_t scene_hash(const struct plan_result *result, int ball_count);

#endif
