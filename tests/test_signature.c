/* Golden signatures: what the code gives for fixed inputs, held against tests/signatures.txt, so that a change that was
 * meant to change nothing is seen to have done so. `make signatures` writes the file anew; a commit that changes it says
 * which entries and why. The same on gcc and clang, at every optimisation level and number of workers. */
#include "harness.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/control/fsm.h"
#include "app/light/draw.h"
#include "app/planner/plan_message.h"
#include "app/process/ball_message.h"
#include "scenes.h"
#include "search_scenes.h"
#include "vision_rig.h"

static const char FILE_NAME[] = "tests/signatures.txt";
static const char *const models[] = {"thesis", "simple", "simple-elastic", "real", "real-mathavan"};
enum { MODELS = sizeof models / sizeof *models, ENTRY_MAX = 256, VALUE_MAX = 96, NAME_SIZE = 48 };
/* Found balls go through OpenCV's marker search: other versions of it move them by less than this. */
static const double FOUND_TOLERANCE = 0.021; /* mm */

struct entry {
	char name[NAME_SIZE], value[VALUE_MAX];
};

struct entries {
	struct entry entry[ENTRY_MAX];
	int count;
};

static struct entries found, golden;

__attribute__((format(printf, 2, 3))) static void add(const char *name, const char *format, ...)
{
	ck_assert_int_lt(found.count, ENTRY_MAX);
	struct entry *entry = &found.entry[found.count++];
	snprintf(entry->name, sizeof entry->name, "%s", name);
	va_list args;
	va_start(args, format);
	vsnprintf(entry->value, sizeof entry->value, format, args);
	va_end(args);
}

static uint64_t fold(uint64_t hash, const void *data, size_t size)
{
	const unsigned char *byte = data;
	for (size_t i = 0; i < size; i++)
		hash = (hash ^ byte[i]) * 0x100000001b3u;
	return hash;
}

static uint64_t fold_number(uint64_t hash, double number)
{
	return fold(hash, &number, sizeof number);
}

static const uint64_t HASH_BEGIN = 0xcbf29ce484222325u;

/* ---- the file ---- */

static void read_golden(const char *part)
{
	char line[NAME_SIZE + VALUE_MAX];
	FILE *file = fopen(FILE_NAME, "r");
	ck_assert_msg(file != NULL, "%s cannot be read", FILE_NAME);
	golden.count = 0;
	while (golden.count < ENTRY_MAX && fgets(line, sizeof line, file)) {
		struct entry *entry = &golden.entry[golden.count];
		if (sscanf(line, "%47s %95[^\n]", entry->name, entry->value) != 2)
			continue;
		size_t length = strlen(part);
		golden.count += strncmp(entry->name, part, length) == 0 && entry->name[length] == '.';
	}
	fclose(file);
}

static const char *golden_value(const char *name)
{
	for (int i = 0; i < golden.count; i++)
		if (strcmp(golden.entry[i].name, name) == 0)
			return golden.entry[i].value;
	return "(none)";
}

/* Renewing: entries go to the file that `make signatures` names. */
static bool write_found(void)
{
	const char *path = getenv("BILLIARD_SIGNATURES");
	if (!path)
		return false;
	FILE *file = fopen(path, "a");
	ck_assert_msg(file != NULL, "%s cannot be written", path);
	for (int i = 0; i < found.count; i++)
		fprintf(file, "%s %s\n", found.entry[i].name, found.entry[i].value);
	ck_assert_int_eq(fclose(file), 0);
	return true;
}

static bool same_ball(const char *a, const char *b)
{
	char colour[2][16];
	double at[2][2];
	return sscanf(a, "%15s %lf %lf", colour[0], &at[0][0], &at[0][1]) == 3 &&
	       sscanf(b, "%15s %lf %lf", colour[1], &at[1][0], &at[1][1]) == 3 && strcmp(colour[0], colour[1]) == 0 &&
	       fabs(at[0][0] - at[1][0]) < FOUND_TOLERANCE && fabs(at[0][1] - at[1][1]) < FOUND_TOLERANCE;
}

static int count_differing(void)
{
	int differing = 0;
	for (int i = 0; i < found.count; i++) {
		const struct entry *entry = &found.entry[i];
		const char *want = golden_value(entry->name);
		if (strcmp(entry->value, want) == 0 || same_ball(entry->value, want))
			continue;
		differing++;
		printf("signature %s differs: %s, in the file %s\n", entry->name, entry->value, want);
	}
	fflush(stdout);
	return differing;
}

/* Entries found so far against those of the file that begin with part. */
static void hold_against_file(const char *part)
{
	if (write_found())
		return;
	read_golden(part);
	int differing = count_differing();
	ck_assert_msg(differing == 0 && golden.count == found.count,
		      "%s: %d of %d entries differ, the file has %d: see above; `make signatures` if it was meant",
		      part, differing, found.count, golden.count);
}

/* ---- the mathematical library ---- */

static uint64_t libm_hash(void)
{
	uint64_t hash = HASH_BEGIN;
	for (int i = 1; i <= 2000; i++) {
		volatile double x = i * 0.0015707, y = 1 / (x + 0.1);
		const double value[] = {sin(x),	     cos(x),  tan(x),	 atan2(x, y - 2), acos(cos(y)), exp(-x),
					hypot(x, y), cbrt(x), pow(x, y), fmod(9 * x, y),  log(x),	asin(sin(y))};
		for (size_t k = 0; k < sizeof value / sizeof *value; k++)
			hash = fold_number(hash, value[k]);
	}
	return hash;
}

/* Bits are promised for one libm: with another one (or a processor for which it takes other code) they are not compared. */
static bool libm_is_ours(const char *test)
{
	char value[VALUE_MAX];
	if (getenv("BILLIARD_SIGNATURES"))
		return true;
	snprintf(value, sizeof value, "%016" PRIx64, libm_hash());
	read_golden("libm");
	if (strcmp(value, golden_value("libm.functions")) == 0)
		return true;
	printf("%s: skipped: the mathematical library rounds otherwise than the one that the signatures were made "
	       "with\n",
	       test);
	return false;
}

START_TEST(libm)
{
	if (!libm_is_ours("libm"))
		return;
	add("libm.functions", "%016" PRIx64, libm_hash());
	hold_against_file("libm");
}
END_TEST

/* ---- shots ---- */

struct named_shot {
	const char *name;
	double speed, turn, side, follow, elevation; /* turn: rad beside the way to the pink spot */
};

static const struct named_shot shots[] = {
	{"break", 7, 0, 0, 0, 0},	    {"slow", 0.8, 0.004, 0, 0, 0},	{"stun", 3, 0.02, 0, -0.1, 0},
	{"follow", 2.5, -0.015, 0, 0.5, 0}, {"draw", 4, 0.012, 0, -0.5, 0},	{"side", 3, -0.02, 0.4, 0.1, 0},
	{"cushions", 6, 0.9, -0.4, 0.2, 0}, {"raised", 2, 2.2, 0.3, -0.3, 0.4},
};
enum { SHOTS = sizeof shots / sizeof *shots };

static void add_shot(const char *place, const struct table *table, const char *model_name,
		     const struct named_shot *named)
{
	static struct sim sim;
	struct ball ball[SCENE_RACK_COUNT];
	struct model model;
	struct event event;
	char name[NAME_SIZE];
	ck_assert(model_from_name(model_name, &model));
	scene_rack(table, ball);
	vec2 way = vec2_sub(table->spot[COLOUR_PINK], ball[0].pos);
	struct shot shot = {.angle = atan2(way.y, way.x) + named->turn,
			    .speed = named->speed,
			    .side = named->side,
			    .follow = named->follow,
			    .elevation = named->elevation};
	sim_init(&sim, table, &model, ball, SCENE_RACK_COUNT);
	sim_strike(&sim, 0, &shot);
	uint64_t hash = HASH_BEGIN;
	int events = 0;
	for (; events < 100000 && sim_step(&sim, &event); events++) {
		const int what[] = {(int)event.kind, event.ball, event.other};
		hash = fold_number(fold(hash, what, sizeof what), event.time);
	}
	snprintf(name, sizeof name, "shot.%s.%s.%s", place, model_name, named->name);
	add(name, "%016" PRIx64 " %016" PRIx64 " %d", hash, sim_hash(&sim, 0), events);
}

START_TEST(shots_on_both_tables)
{
	if (!libm_is_ours("shots"))
		return;
	struct table thesis = scene_thesis_table(), snooker = scene_snooker_table();
	for (int m = 0; m < MODELS; m++)
		for (int s = 0; s < SHOTS; s++) {
			add_shot("thesis", &thesis, models[m], &shots[s]);
			add_shot("snooker", &snooker, models[m], &shots[s]);
		}
	for (thesis.material.topspin_variant = 0; thesis.material.topspin_variant < 2;
	     thesis.material.topspin_variant++) {
		char place[NAME_SIZE];
		snprintf(place, sizeof place, "topspin-%d", thesis.material.topspin_variant);
		add_shot(place, &thesis, "thesis", &shots[3]);
	}
	hold_against_file("shot");
}
END_TEST

/* ---- searches ---- */

struct named_search {
	const char *table, *model, *profile;
	int depth, rails, balls;
	uint64_t nodes;
};

static const struct named_search searches[] = {
	{"thesis", "thesis", "thesis", 1, 0, 2, 300},	    {"thesis", "thesis", "thesis", 2, 1, 3, 600},
	{"thesis", "thesis", "beginner", 2, 1, 2, 400},	    {"thesis", "thesis", "professional", 1, 2, 2, 500},
	{"thesis", "simple", "thesis", 3, 1, 2, 600},	    {"thesis", "simple-elastic", "thesis", 1, 1, 2, 300},
	{"thesis", "real", "beginner", 1, 0, 1, 200},	    {"thesis", "real", "professional", 2, 1, 2, 400},
	{"thesis", "real-mathavan", "thesis", 1, 1, 2, 60}, {"snooker", "thesis", "thesis", 2, 0, 2, 400},
	{"snooker", "real", "professional", 1, 1, 2, 300},
};
enum { SEARCHES = sizeof searches / sizeof *searches };

static struct table table_named(const char *name)
{
	return strcmp(name, "thesis") == 0 ? scene_thesis_table() : scene_snooker_table();
}

static struct plan_request request_of(const struct named_search *search, const struct table *table)
{
	struct ball ball[BALL_MAX];
	scene_after_break(table, search->depth, ball);
	struct plan_request request = scene_request(ball, BALL_MAX);
	request.target = search->rails == 1 ? TARGET_RULES : TARGET_ANY;
	request.state.any_first = strcmp(search->profile, "thesis") == 0;
	request.depth = search->depth;
	request.rails = search->rails;
	request.balls = search->balls;
	request.speeds = 2;
	request.plans = 20;
	request.tolerances = 1;
	request.budget.nodes = search->nodes;
	return request;
}

static void add_search(const struct named_search *search, const struct cost_profile *profile)
{
	struct table table = table_named(search->table);
	struct plan_request request = request_of(search, &table);
	uint64_t first = 0;
	char name[NAME_SIZE];
	for (int workers = 1; workers <= 8; workers++) {
		struct planner *planner = scene_planner(&table, search->model, profile, workers);
		struct plan_result result = scene_run(planner, &request);
		uint64_t hash = scene_hash(&result, BALL_MAX);
		if (workers == 1) {
			first = hash;
			snprintf(name, sizeof name, "search.%s.%s.%s.%d", search->table, search->model, search->profile,
				 search->depth);
			add(name, "%016" PRIx64 " %d plans", hash, result.plan_count);
		}
		ck_assert_msg(hash == first, "%s: %d workers find otherwise than one", name, workers);
		planner_destroy(planner);
	}
}

/* They rank by success here, with the errors that the entries were made with. */
static struct cost_profile player_named(const struct config *config, const char *name)
{
	const struct cost_profile *named = config_profile(config, name);
	ck_assert_ptr_nonnull(named);
	struct cost_profile profile = *named;
	if (strcmp(name, "beginner") == 0 || strcmp(name, "professional") == 0)
		profile.ranking = RANK_SUCCESS;
	if (strcmp(name, "professional") == 0)
		profile.error.angle = 0.125 * M_PI / 180;
	return profile;
}

START_TEST(searches_at_any_number_of_workers)
{
	static struct config config;
	char err[640];
	if (!libm_is_ours("searches"))
		return;
	ck_assert_msg(config_load(&config, "config/thesis.conf", err, sizeof err) == 0, "%s", err);
	for (int i = 0; i < SEARCHES; i++) {
		struct cost_profile profile = player_named(&config, searches[i].profile);
		add_search(&searches[i], &profile);
	}
	hold_against_file("search");
}
END_TEST

/* ---- what the light shows ---- */

static uint64_t list_hash(const billiard_draw_list_t *list)
{
	uint64_t hash = HASH_BEGIN;
	for (int i = 0; i < list->item_count; i++) {
		const billiard_draw_item_t *item = &list->items[i];
		const int what[] = {item->kind, item->layer, item->rgba, item->point_first, item->point_count};
		hash = fold(hash, what, sizeof what);
		hash = fold_number(fold_number(hash, item->width), item->radius);
		hash = fold_number(fold_number(hash, item->dash), item->gap);
		hash = fold(hash, item->text, strnlen((const char *)item->text, sizeof item->text));
	}
	hash = fold(hash, list->xs, (size_t)list->point_count * sizeof *list->xs);
	return fold(hash, list->ys, (size_t)list->point_count * sizeof *list->ys);
}

static uint64_t animation_hash(const billiard_animation_t *animation)
{
	uint64_t hash = HASH_BEGIN;
	for (int i = 0; i < animation->keyframe_count; i++) {
		const billiard_keyframe_t *key = &animation->keyframes[i];
		hash = fold(hash, &key->ball, sizeof key->ball);
		const double number[] = {key->begin, key->end, key->x, key->y, key->vx, key->vy, key->ax, key->ay};
		hash = fold(hash, number, sizeof number);
	}
	return hash;
}

static void add_picture(const char *model_name, const struct cost_profile *profile)
{
	static billiard_plan_request_t message;
	static billiard_plan_t plan;
	static billiard_draw_list_t list;
	static billiard_animation_t animation;
	static struct trace_entry scratch[PLAN_TRACE_MAX];
	const struct named_search search = {"thesis", model_name, "thesis", 2, 1, 2, 400};
	struct table table = scene_thesis_table();
	struct model model;
	struct plan_request request = request_of(&search, &table);
	struct planner *planner = scene_planner(&table, model_name, profile, 2);
	struct plan_result result = scene_run(planner, &request);
	ck_assert(model_from_name(model_name, &model));
	message.ball_count = BALL_MAX;
	for (int i = 0; i < BALL_MAX; i++)
		ball_to_message(&message.balls[i], &request.ball[i], ball_colour_name(request.ball[i].colour), i);
	plan_message_begin(&plan, &message);
	plan_message_fill(&plan, &result, &table, &model, scratch);
	planner_destroy(planner);
	ck_assert_int_ge(plan.entry_count, 2);
	for (int entry = 0; entry < 2; entry++) {
		char name[NAME_SIZE];
		struct draw_options options = {.halo = true, .other_paths = true, .table = entry, .info = entry};
		draw_proposal(&list, &table, &(struct draw_subject){&plan, entry, 0}, &options);
		plan_message_animation(&animation, &plan, entry, 0);
		snprintf(name, sizeof name, "light.%s.%d", model_name, entry);
		add(name, "%016" PRIx64 " %d items %016" PRIx64, list_hash(&list), list.item_count,
		    animation_hash(&animation));
	}
}

START_TEST(light_of_proposals)
{
	if (!libm_is_ours("light"))
		return;
	struct cost_profile profile = cost_profile_thesis();
	add_picture("thesis", &profile);
	add_picture("real", &profile);
	hold_against_file("light");
}
END_TEST

/* ---- what vision sees ---- */

static int compare_balls(const void *a, const void *b)
{
	const struct vision_ball *p = a, *q = b;
	return p->pos.x < q->pos.x ? -1 : p->pos.x > q->pos.x;
}

START_TEST(balls_of_rendered_frames)
{
	struct random random = {20211221};
	for (int frame = 0; frame < 3; frame++) {
		char err[256], name[NAME_SIZE];
		rig_scatter(&random, 8 + 7 * frame);
		rig_paint(frame);
		ck_assert_int_eq(vision_detect(rig->vision, &rig->image.image, &rig->result, err, sizeof err), 0);
		qsort(rig->result.ball, (size_t)rig->result.ball_count, sizeof *rig->result.ball, compare_balls);
		snprintf(name, sizeof name, "frame.%d.count", frame);
		add(name, "%d balls", rig->result.ball_count);
		for (int i = 0; i < rig->result.ball_count; i++) {
			const struct vision_ball *ball = &rig->result.ball[i];
			snprintf(name, sizeof name, "frame.%d.ball.%02d", frame, i);
			add(name, "%s %.2f %.2f", ball_colour_name(ball->colour), 1000 * ball->pos.x,
			    1000 * ball->pos.y);
		}
	}
	hold_against_file("frame");
}
END_TEST

/* ---- the controller's table ---- */

static void list_actions(unsigned actions, char text[VALUE_MAX])
{
	static const char *const names[] = {"clear", "request",	 "cancel", "show",   "note",
					    "next",  "previous", "repeat", "redraw", "forget"};
	ck_assert_uint_lt(actions, 1u << (sizeof names / sizeof *names));
	text[0] = 0;
	for (size_t i = 0; i < sizeof names / sizeof *names; i++)
		if (actions & 1u << i) {
			size_t length = strlen(text);
			snprintf(text + length, VALUE_MAX - length, " %s", names[i]);
		}
}

START_TEST(transitions_of_the_controller)
{
	char name[NAME_SIZE], actions[VALUE_MAX];
	for (int state = 0; state < FSM_STATE_COUNT; state++) {
		struct fsm fsm = {.state = (enum fsm_state)state};
		snprintf(name, sizeof name, "fsm.%s.timeout", fsm_state_name(fsm.state));
		add(name, "%g s", fsm_timeout(&fsm, &(struct fsm_limits){3, 60}, 0));
		for (int event = 0; event < FSM_EVENT_COUNT; event++) {
			fsm.state = (enum fsm_state)state;
			if (!fsm_written(fsm.state, (enum fsm_event)event))
				continue;
			snprintf(name, sizeof name, "fsm.%s.%s", fsm_state_name(fsm.state),
				 fsm_event_name((enum fsm_event)event));
			list_actions(fsm_step(&fsm, (enum fsm_event)event, 0), actions);
			add(name, "%s%s", fsm_state_name(fsm.state), actions);
		}
	}
	hold_against_file("fsm");
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("signature");
	TCase *plain = tcase_create("plain");
	tcase_set_timeout(plain, 30);
	tcase_add_test(plain, libm);
	tcase_add_test(plain, shots_on_both_tables);
	tcase_add_test(plain, searches_at_any_number_of_workers);
	tcase_add_test(plain, light_of_proposals);
	tcase_add_test(plain, transitions_of_the_controller);
	suite_add_tcase(suite, plain);
	TCase *vision = tcase_create("vision");
	tcase_set_timeout(vision, 30);
	tcase_add_checked_fixture(vision, rig_setup, rig_teardown);
	tcase_add_test(vision, balls_of_rendered_frames);
	suite_add_tcase(suite, vision);
	return suite;
}
