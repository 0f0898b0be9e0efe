/* Positions and limits from bytes, through the search: all tables, models and profiles that are shipped. Whatever the
 * bytes are, the request is refused with a reason or answered with shots that do as they say. */
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/config/config.h"
#include "search/plan.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { TABLES = 2, MODELS = 5, PROFILES = CONFIG_PROFILE_MAX, PLANS = 4, TRACE = 4096 };

/* How a ball's place is made of its bytes: anywhere, or as nothing random ever lies. */
enum place { FREE, ON_A_LINE, TOUCHING, AT_A_CUSHION, AT_A_POCKET, PLACES };

struct bytes {
	const uint8_t *at;
	size_t left;
};

static unsigned next(struct bytes *bytes)
{
	if (bytes->left == 0)
		return 0;
	bytes->left--;
	return *bytes->at++;
}

/* -1 to 1 in 65535 steps. */
static double share(struct bytes *bytes)
{
	unsigned high = next(bytes), low = next(bytes);
	return ((double)(high << 8 | low) - 32767.5) / 32767.5;
}

static const struct config *shipped(unsigned table)
{
	static const char *const name[TABLES] = {"config/thesis-table.conf", "config/snooker-12ft.conf"};
	static struct config config[TABLES];
	static bool loaded[TABLES];
	char err[640];
	if (!loaded[table] && config_load(&config[table], name[table], err, sizeof err) != 0) {
		fprintf(stderr, "%s\n", err);
		abort();
	}
	loaded[table] = true;
	return &config[table];
}

/* One planner for each combination, made when it is first asked for. */
static struct planner *planner_of(unsigned table, unsigned model, unsigned profile, struct planner_def *def)
{
	static const char *const name[MODELS] = {"thesis", "simple", "simple-elastic", "real", "real-mathavan"};
	static struct planner *made[TABLES][MODELS][PROFILES];
	const struct config *config = shipped(table);
	*def = planner_def_default();
	def->table = &config->table;
	def->profile = config->profiles[profile];
	if (!model_from_name(name[model], &def->model))
		abort();
	struct planner **planner = &made[table][model][profile];
	if (!*planner && planner_create(planner, def) != 0)
		abort();
	return *planner;
}

static vec2 place(const struct table *table, const struct plan_request *request, struct bytes *bytes)
{
	unsigned kind = next(bytes), which = next(bytes);
	double a = share(bytes), b = share(bytes), r = table->ball_radius;
	vec2 cue = request->ball[0].pos;
	const struct ball *last = &request->ball[request->ball_count > 0 ? request->ball_count - 1 : 0];
	const struct pocket *pocket = &table->pocket[which % (unsigned)table->pocket_count];
	const struct cushion *c = &table->cushion[which % (unsigned)table->cushion_count];
	switch (kind % PLACES) {
	case ON_A_LINE: /* of the cue ball and a pocket */
		return vec2_madd(cue, (a + 1) / 2, vec2_sub(pocket->centre, cue));
	case TOUCHING: /* the last ball, within a tenth of a millimetre */
		return vec2_madd(last->pos, 2 * r + 1e-4 * b, vec2_from_angle(M_PI * a));
	case AT_A_CUSHION:
		return vec2_madd(vec2_madd(c->a, (a + 1) / 2 * c->span, c->along), r + 1e-3 * b, c->normal);
	case AT_A_POCKET:
		return vec2_madd(pocket->centre, pocket->radius * (1 + (b + 1) / 2), vec2_from_angle(M_PI * a));
	default:
		return (vec2){a * table->length / 2, b * table->width / 2};
	}
}

static struct plan_request request_from(const struct table *table, struct bytes *bytes)
{
	struct plan_request request = plan_request_default();
	unsigned flags = next(bytes), limits = next(bytes), target = next(bytes);
	request.state = (struct rules_state){.on = (enum rules_on)(flags & 3), .in_hand = flags >> 2 & 1};
	request.tolerances = flags >> 3 & 1;
	request.target = (enum plan_target_kind)(flags >> 4 & 3);
	request.depth = 1 + (int)(limits & 3);
	request.rails = (int)(limits >> 2 & 3);
	request.balls = 1 + (int)(limits >> 4 & 3) % (PLAN_CHAIN_MAX - 1);
	request.speeds = 1 + (int)(limits >> 6 & 3);
	request.target_colour = (enum ball_colour)(target % COLOUR_COUNT);
	request.target_ball = (int)(target % BALL_MAX);
	request.plans = PLANS;
	request.budget.nodes = 40;
	while (bytes->left > 0 && request.ball_count < BALL_MAX) {
		unsigned colour = next(bytes);
		struct ball ball =
			ball_at((enum ball_colour)(request.ball_count == 0 ? COLOUR_WHITE : colour % COLOUR_COUNT),
				place(table, &request, bytes));
		if (colour >= 0xf0)
			ball.phase = BALL_POTTED;
		request.ball[request.ball_count++] = ball;
	}
	return request;
}

static void check(const struct planner_def *def, const struct plan_request *request, const struct plan_result *result)
{
	static struct trace_entry entry[TRACE];
	if (result->plan_count > request->plans)
		abort();
	for (int i = 0; i < result->plan_count; i++)
		for (int s = 0; s < result->plan[i].shot_count; s++) {
			struct trace trace;
			trace_init(&trace, entry, TRACE);
			if (!plan_shot_replay(def->table, &def->model, &result->plan[i].shot[s], request->ball_count,
					      &trace))
				abort();
		}
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	struct bytes bytes = {data, size};
	unsigned table = next(&bytes) % TABLES, model = next(&bytes) % MODELS;
	unsigned profile = next(&bytes) % (unsigned)shipped(table)->profile_count;
	struct planner_def def;
	struct planner *planner = planner_of(table, model, profile, &def);
	struct plan_request request = request_from(def.table, &bytes);
	if (def.model.cushion == CUSHION_MODEL_MATHAVAN) /* integrated: a hundred times slower */
		request.depth = request.speeds = 1, request.rails = 0;
	struct plan_result result;
	char err[200] = "";
	int rc = planner_run(planner, &request, NULL, NULL, &result, err, sizeof err);
	if (rc == 0)
		check(&def, &request, &result);
	else if (rc != -EINVAL || err[0] == '\0')
		abort();
	return 0;
}
