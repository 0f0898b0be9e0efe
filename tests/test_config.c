#include "app/config/config.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/config/config_table.h"
#include "app/config/text_file.h"
#include "harness.h"

#define THESIS	   "config/thesis-table.conf"
#define THESIS_WAY "config/thesis.conf"
#define SNOOKER	   "config/snooker-12ft.conf"

enum { TEXT_MAX = 1 << 16, ERR_SIZE = 640 };
static struct config config; /* too large for the stack */

static char *shipped(const char *path)
{
	char err[ERR_SIZE], *text;
	size_t size;
	ck_assert_msg(text_file_read(path, TEXT_MAX, &text, &size, err, sizeof err) == 0, "%s", err);
	return text;
}

/* Loads a text as if it were a file. */
static int load_text(const char *text, size_t size, struct config *out, char *path, char *err)
{
	strcpy(path, "/tmp/billiard-config-XXXXXX");
	int fd = mkstemp(path);
	ck_assert_int_ge(fd, 0);
	ck_assert_int_eq(write(fd, text, size), (ssize_t)size);
	close(fd);
	err[0] = 0;
	int code = config_load(out, path, err, ERR_SIZE);
	unlink(path);
	return code;
}

/* text with the first `from` replaced. Caller frees. */
static char *replaced(const char *text, const char *from, const char *to)
{
	const char *at = strstr(text, from);
	ck_assert_msg(at != NULL, "no \"%s\" in the shipped file", from);
	char *out = malloc(strlen(text) + strlen(to) + 1);
	sprintf(out, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
	return out;
}

static int line_of(const char *text, const char *part)
{
	int line = 1;
	for (const char *p = text; p < strstr(text, part); p++)
		line += *p == '\n';
	return line;
}

static void load(const char *path)
{
	char err[ERR_SIZE] = "";
	ck_assert_msg(config_load(&config, path, err, sizeof err) == 0, "%s", err);
}

/* ---- the shipped files ------------------------------------------------------------------------------------------- */

static void check_near(double value, double wanted)
{
	ck_assert_double_eq_tol(value, wanted, 1e-12);
}

START_TEST(thesis_table_in_si)
{
	load(THESIS_WAY); /* the table of thesis-table.conf, and the thesis' player */
	check_near(config.table.length, 1.881);
	check_near(config.table.width, 0.943);
	check_near(config.table.ball_radius, 0.02615);
	check_near(config.table.material.gravity, 9.8);
	check_near(config.table.material.mu_roll, 0.0142435);
	check_near(config.table.material.topspin_factor, 0.25);
	check_near(config.table.spot[COLOUR_BLACK].x, 0.8938);
	check_near(config.table.spot[COLOUR_YELLOW].y, 0.2);
	check_near(config.profile.max_cut, 87 * M_PI / 180);
	check_near(config.profile.speed_step, 1);
	check_near(config.planner.sync_period, 0.1);
	check_near(config.infinity.still_distance, 0.0005);
	check_near(config.camera.fx, 917.126);
	ck_assert_int_eq(config.table.cushion_count, 18);
	ck_assert_int_eq(config.table.pocket_count, 6);
	ck_assert_int_eq(config.markers.count, 4);
	check_near(config.markers.marker[3].centre.x, -0.8615);
	check_near(config.markers.marker[3].centre.y, 0.542);
	ck_assert_int_eq(config.markers.marker[3].id, 3);
	ck_assert_uint_eq(config.planner.memory, (size_t)32 << 20);
	ck_assert_str_eq(config.colours, "config/colours.json");
	ck_assert_str_eq(config.path, THESIS_WAY);
	ck_assert_int_eq(config.model.ball, BALL_MODEL_THESIS);
}
END_TEST

START_TEST(snooker_table_by_the_rules)
{
	load(SNOOKER);
	const struct table *t = &config.table;
	check_near(t->length, 3.569);
	check_near(t->width, 1.778);
	check_near(t->spot[COLOUR_BROWN].x + t->length / 2, 0.737);
	check_near(t->length / 2 - t->spot[COLOUR_BLACK].x, 0.324);
	check_near(t->spot[COLOUR_PINK].x, t->length / 4);
	check_near(t->spot[COLOUR_GREEN].y, 0.292);
	check_near(t->spot[COLOUR_YELLOW].y, -0.292);
	check_near(t->baulk_d_radius, 0.292);
}
END_TEST

/* The six long noses lie on the bed's edge and face the origin; a jaw faces its pocket; each tangent jaw begins where
 * its nose ends. */
static void check_geometry(const char *path)
{
	load(path);
	const struct table *t = &config.table;
	int main_rails = 0;
	for (int i = 0; i < t->cushion_count; i++) {
		const struct cushion *c = &t->cushion[i];
		vec2 middle = vec2_scale(vec2_add(c->a, c->b), 0.5);
		ck_assert_double_eq_tol(vec2_norm(c->normal), 1, 1e-12);
		ck_assert_double_gt(vec2_cross(vec2_sub(c->b, c->a), vec2_add(vec2_sub(middle, c->a), c->normal)), 0);
		if (!c->main_rail)
			continue;
		main_rails++;
		ck_assert_double_lt(vec2_dot(c->normal, middle), 0);
		check_near(fmax(fabs(middle.x) - t->length / 2, fabs(middle.y) - t->width / 2), 0);
	}
	ck_assert_int_eq(main_rails, 6);
	for (int i = 0; i < t->pocket_count; i++)
		ck_assert_double_lt(vec2_dot(t->pocket[i].normal, t->pocket[i].centre), 0);
}

START_TEST(geometry_of_both)
{
	check_geometry(THESIS);
	check_geometry(SNOOKER);
}
END_TEST

START_TEST(jaws_of_the_big_table_leave_room)
{
	load(SNOOKER);
	const struct table *t = &config.table;
	for (int i = 0; i < t->jaw_count; i++)
		for (int j = 0; j < i; j++) {
			if (t->jaw[i].radius == 0 || t->jaw[j].radius == 0)
				continue;
			double gap =
				vec2_dist(t->jaw[i].centre, t->jaw[j].centre) - t->jaw[i].radius - t->jaw[j].radius;
			ck_assert_double_gt(gap, 0.085);
		}
}
END_TEST

static void check_player(const char *name, double degrees, double share)
{
	const struct cost_profile *player = config_profile(&config, name);
	ck_assert_ptr_nonnull(player);
	check_near(player->error.angle, degrees * M_PI / 180);
	check_near(player->error.speed, share);
	ck_assert_int_eq(player->ranking, RANK_VALUE);
	ck_assert(!player->any_first && !player->keep_flukes);
}

/* What is shipped is snooker as it is played: real balls, the rules, what a club player scores most with. */
static void check_shipped_play(const char *path)
{
	load(path);
	ck_assert_str_eq(config.model_name, "real");
	ck_assert(config.infinity.rules);
	ck_assert_str_eq(config.profile.name, "club");
	check_player("beginner", 0.5, 0.1);
	check_player("club", 0.3, 0.05);
	check_player("professional", 0.1, 0.03);
	ck_assert_ptr_nonnull(config_profile(&config, "thesis"));
	ck_assert_ptr_null(config_profile(&config, "champion"));
}

START_TEST(shipped_play)
{
	check_shipped_play(THESIS);
	check_shipped_play(SNOOKER);
}
END_TEST

/* The thesis' own behaviour is a file of a few lines: its model, its cost, any ball; the table is the same. */
START_TEST(the_way_of_the_thesis)
{
	load(THESIS);
	struct table table = config.table;
	load(THESIS_WAY);
	ck_assert_str_eq(config.model_name, "thesis");
	ck_assert(!config.infinity.rules);
	ck_assert_int_eq(config.profile.ranking, RANK_THESIS);
	ck_assert_mem_eq(&config.table, &table, sizeof table);
	struct cost_profile thesis = cost_profile_thesis();
	check_near(config.profile.max_cut, thesis.max_cut);
	check_near(config.profile.clearance, thesis.clearance);
	check_near(config.profile.w_points, thesis.w_points);
	ck_assert(config.profile.any_first && config.profile.keep_flukes && config.profile.program_speed);
}
END_TEST

/* The shipped default must show the whole table, rails included. */
static void check_projector(const char *path)
{
	load(path);
	const double *h = config.projector.homography;
	for (int sx = -1; sx <= 1; sx += 2)
		for (int sy = -1; sy <= 1; sy += 2) {
			double x = sx * (config.table.length / 2 + 0.08), y = sy * (config.table.width / 2 + 0.08);
			double w = h[6] * x + h[7] * y + h[8];
			double px = (h[0] * x + h[1] * y + h[2]) / w, py = (h[3] * x + h[4] * y + h[5]) / w;
			ck_assert(px > 0 && px < config.projector.width && py > 0 && py < config.projector.height);
			ck_assert((px > config.projector.width / 2) == (sx > 0) &&
				  (py < config.projector.height / 2) == (sy > 0));
		}
}

START_TEST(projector_shows_the_table)
{
	check_projector(THESIS);
	check_projector(SNOOKER);
}
END_TEST

/* ---- errors ------------------------------------------------------------------------------------------------------ */

static const struct {
	const char *from, *to, *message; /* found and allowed */
} bad[] = {
	{"mu_roll = 0.0142435", "mu_roll = 2.5", "material.mu_roll: found 2.5, allowed a number 0.001 to 0.1"},
	{"mu_roll = 0.0142435", "mu_roll = 1e999", "material.mu_roll: found inf, allowed a number 0.001 to 0.1"},
	{"mu_roll = 0.0142435", "mu_roll = \"x\"", "material.mu_roll: found \"x\", allowed a number 0.001 to 0.1"},
	{"mu_roll = 0.0142435", "mu_roll = true", "material.mu_roll: found true, allowed a number 0.001 to 0.1"},
	{"mu_roll = 0.0142435", "mu_roll = ( 1, 2 )",
	 "material.mu_roll: found a list of 2, allowed a number 0.001 to 0.1"},
	{"mu_roll =", "mu_rol =",
	 "material.mu_rol: found an unknown key (nearest is mu_roll), allowed one of gravity mu_slide mu_roll"},
	{"gravity = 9800.0", "gravity = 9.8", "material.gravity: found 9.8, allowed a number 1000 to 20000 mm/s^2"},
	{"workers = 0", "workers = 0.5", "planner.workers: found 0.5, allowed a whole number 0 to 16"},
	{"workers = 0", "workers = 17", "planner.workers: found 17, allowed a whole number 0 to 16"},
	{"seed = 1;", "seed = -1;", "virtual_table.seed: found -1, allowed a whole number 0 to"},
	{"fullscreen = true", "fullscreen = 1", "projector.fullscreen: found 1, allowed true or false"},
	{"name = \"thesis-table\"", "name = \"\"", "name: found \"\", allowed a text of 1 to 31 characters"},
	{"from = ( -55.0, 471.5 )", "from = ( -55.0 )",
	 "table.cushions[2].from: found a list of 1, allowed 2 numbers -5000 to 5000 mm"},
	{"from = ( -55.0, 471.5 )", "from = ( -55.0, 9999.0 )",
	 "table.cushions[2].from[1]: found 9999.0, allowed 2 numbers"},
	{"jaws = ()", "jaws = 3", "table.jaws: found 3, allowed a list ( ) of 0 to 32 groups"},
	{"jaws = ()", "jaws = ( 3 )", "table.jaws[0]: found 3, allowed a group { }"},
	{"model = \"real\"", "model = \"thesi\"",
	 "model: found \"thesi\", allowed thesis, simple, simple-elastic, real, real-mathavan"},
	{"scheme = \"steal\"", "scheme = \"theft\"",
	 "planner.scheme: found \"theft\", allowed batch, windows, queue, steal"},
	{"profile = \"club\"", "profile = \"pro\"", "profile: found \"pro\", allowed a name from profiles"},
	{"id = 3", "id = 1", "markers.list[3].id: found 1, allowed each id once"},
	{"id = 3", "id = 4", "markers.list[3].id: found 4, allowed each id once and below dictionary_count"},
	{"900.0, 0.0, 960.0", "0.0, 0.0, 960.0", "projector.homography: found a singular matrix"},
	{"nose_height = 36.61", "nose_height = 79.0", "table: found "},
	{"black = ( 893.8, 0.0 )", "black = ( 940.6, 0.0 )",
	 "table.spots.black: found a place off the bed, allowed one within half of length and width"},
	{"yellow = ( -600.0, 200.0 )", "yellow = ( -600.0, 471.6 )", "table.spots.yellow: found a place off the bed"},
};

START_TEST(error_names_place_and_range)
{
	char *good = shipped(THESIS), *text = replaced(good, bad[_i].from, bad[_i].to);
	char path[64], err[ERR_SIZE], wanted[ERR_SIZE];
	struct config *before = malloc(sizeof *before);
	memset(&config, 0x5a, sizeof config);
	*before = config;
	ck_assert_int_eq(load_text(text, strlen(text), &config, path, err), -EINVAL);
	ck_assert_msg(memcmp(before, &config, sizeof config) == 0, "config was touched");
	int line =
		strncmp(bad[_i].message, "table: ", 7) == 0 ? line_of(good, "table = {") : line_of(good, bad[_i].from);
	snprintf(wanted, sizeof wanted, "%s:%d: %s", path, line, bad[_i].message);
	ck_assert_msg(strncmp(err, wanted, strlen(wanted)) == 0, "\n   got %s\nwanted %s", err, wanted);
	free(before);
	free(text);
	free(good);
}
END_TEST

/* Line by line: a file of the defaults that lacks any one "key = value;" line outside of a list is the same one. */
START_TEST(any_key_may_be_missing)
{
	static struct config without;
	char *good = shipped(THESIS), file[64], err[ERR_SIZE];
	int removed = 0, depth = 0;
	ck_assert_msg(load_text(good, strlen(good), &config, file, err) == 0, "%s", err);
	for (char *line = good, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
		char key[40], *text = malloc(strlen(good) + 1);
		int after = 0, outside = depth;
		for (char *c = line; c < end && *c != '#'; c++)
			depth += (*c == '(') - (*c == ')');
		if (outside == 0 && depth == 0 && sscanf(line, " %39[a-z_0-9] =%n", key, &after) == 1 && after &&
		    memchr(line, ';', (size_t)(end - line)) && !memchr(line, '{', (size_t)(end - line))) {
			sprintf(text, "%.*s%s", (int)(line - good), good, end);
			ck_assert_msg(load_text(text, strlen(text), &without, file, err) == 0, "without %s: %s", key,
				      err);
			memcpy(without.path, config.path, sizeof config.path);
			memcpy(without.colours, config.colours, sizeof config.colours);
			ck_assert_msg(memcmp(&config, &without, sizeof config) == 0, "without %s", key);
			removed++;
		}
		free(text);
	}
	ck_assert_int_gt(removed, 80);
	free(good);
}
END_TEST

/* Nothing at all is the default table; what is said counts, and only that. */
START_TEST(a_file_holds_what_differs)
{
	char path[64], err[ERR_SIZE];
	ck_assert_msg(load_text("", 0, &config, path, err) == 0, "%s", err);
	check_near(config.table.length, 1.881);
	check_near(config.table.ball_radius, 0.02615);
	ck_assert_int_eq(config.service_count, 5);
	const char *few = "name = \"mine\"; material = { mu_roll = 0.02; }; services = ();";
	ck_assert_msg(load_text(few, strlen(few), &config, path, err) == 0, "%s", err);
	ck_assert_str_eq(config.name, "mine");
	check_near(config.table.material.mu_roll, 0.02);
	check_near(config.table.material.mu_slide, 0.170922);
	ck_assert_int_eq(config.service_count, 0);
	ck_assert_int_eq(config.table.cushion_count, 18);
}
END_TEST

/* An element of a list leans on no other. */
START_TEST(elements_of_lists_are_whole)
{
	char path[64], err[ERR_SIZE];
	const char *half = "services = ( { name = \"billiard-vision\"; enabled = true; } );";
	ck_assert_int_eq(load_text(half, strlen(half), &config, path, err), -EINVAL);
	ck_assert_msg(strstr(err, ":1: services[0].arguments: found nothing, allowed a text") != NULL, "%s", err);
}
END_TEST

static const struct {
	const char *text, *nearest;
} misspelt[] = {
	{"tabel = { };", "table"},
	{"virtualtable = { };", "virtual_table"},
	{"planner = { budget_node = 3; };", "budget_nodes"},
	{"infinity = { stillframes = 3; };", "still_frames"},
	{"camera = { k4 = 0.0; };", "k1"},
};

START_TEST(unknown_keys_name_the_nearest)
{
	char path[64], err[ERR_SIZE], wanted[80];
	ck_assert_int_eq(load_text(misspelt[_i].text, strlen(misspelt[_i].text), &config, path, err), -EINVAL);
	snprintf(wanted, sizeof wanted, "found an unknown key (nearest is %s), allowed one of ", misspelt[_i].nearest);
	ck_assert_msg(strstr(err, wanted) && strncmp(err + strlen(path), ":1: ", 4) == 0, "%s", err);
}
END_TEST

/* A key that came later may be missing: then the value counts that changes nothing. Given, it is read with its unit. */
START_TEST(later_keys_have_defaults)
{
	char *good = shipped(THESIS), path[64], err[ERR_SIZE];
	ck_assert_msg(load_text(good, strlen(good), &config, path, err) == 0, "%s", err);
	ck_assert(!config.table.bed.uneven && config.table.bed.slope.x == 0 && config.table.bed.bowl[2] == 0);
	char *text = replaced(good, "\td_radius", "\tslope = ( 1.5, -2.0 ); bowl = ( 0.5, 0.0, -1.0 );\n\td_radius");
	ck_assert_msg(load_text(text, strlen(text), &config, path, err) == 0, "%s", err);
	ck_assert(config.table.bed.uneven);
	ck_assert_double_eq_tol(config.table.bed.slope.x, 1.5e-3, 1e-18);
	ck_assert_double_eq_tol(config.table.bed.slope.y, -2e-3, 1e-18);
	ck_assert_double_eq_tol(config.table.bed.bowl[0], 5e-4, 1e-18);
	ck_assert_double_eq_tol(config.table.bed.bowl[2], -1e-3, 1e-18);
	free(text);
	text = replaced(good, "	d_radius", "	slope = ( 19.0, 0.0 );\n	d_radius");
	ck_assert_int_eq(load_text(text, strlen(text), &config, path, err), -EINVAL);
	ck_assert_msg(strstr(err, "steep") != NULL, "%s", err);
	free(text);
	text = replaced(good, "	d_radius", "	slope = ( 1.0 );\n	d_radius");
	ck_assert_int_eq(load_text(text, strlen(text), &config, path, err), -EINVAL);
	ck_assert_msg(strstr(err, "slope: found a list of 1, allowed 2 numbers -20 to 20 mm/m") != NULL, "%s", err);
	free(text);
	free(good);
}
END_TEST

START_TEST(what_is_no_file)
{
	char err[ERR_SIZE], path[64];
	ck_assert_int_eq(config_load(&config, "/nonexistent.conf", err, sizeof err), -ENOENT);
	ck_assert_str_eq(err, "/nonexistent.conf: No such file or directory");
	ck_assert_int_eq(config_load(&config, "/tmp", err, sizeof err), -EISDIR);
	ck_assert_str_eq(err, "/tmp: is a folder");
	ck_assert_int_eq(load_text("a\0b", 3, &config, path, err), -EBADMSG);
	ck_assert_int_eq(load_text("name = \n;", 9, &config, path, err), -EINVAL);
	ck_assert_msg(strstr(err, ":2: syntax error") != NULL, "%s", err);
	char *large = malloc(2 << 20);
	memset(large, ' ', 2 << 20);
	ck_assert_int_eq(load_text(large, 2 << 20, &config, path, err), -EFBIG);
	free(large);
}
END_TEST

/* Damaged files: accepted or refused with the file's name, never a crash, and never a value out of range. */
START_TEST(damaged_files)
{
	struct random random = random_begin("damaged_files");
	char *good = shipped(THESIS), path[64], err[ERR_SIZE];
	size_t size = strlen(good);
	for (int i = 0; i < 1500; i++) {
		char *text = strdup(good);
		for (uint64_t n = 1 + random_u64(&random) % 3; n > 0; n--)
			text[random_u64(&random) % size] = (char)(1 + random_u64(&random) % 126);
		if (load_text(text, size, &config, path, err) < 0)
			ck_assert_msg(strncmp(err, path, strlen(path)) == 0, "%s", err);
		else
			ck_assert(config.table.ball_radius >= 0.01 && config.table.ball_radius <= 0.04 &&
				  config.table.cushion_count >= 4);
		free(text);
	}
	free(good);
}
END_TEST

START_TEST(default_path)
{
	unsetenv("BILLIARD_CONF");
	ck_assert_str_eq(config_default_path(), THESIS);
	setenv("BILLIARD_CONF", "/else/where.conf", 1);
	ck_assert_str_eq(config_default_path(), "/else/where.conf");
}
END_TEST

/* Each key has its row in the documentation, with the range that the reader allows. */
static int check_documented(const char *doc, const struct config_key *keys, const char *prefix)
{
	int count = 0;
	for (const struct config_key *key = keys; key->name; key++) {
		char name[100], allowed[CONFIG_ALLOWED_SIZE], row[256];
		snprintf(name, sizeof name, "%s%s", prefix, key->name);
		config_reader_allowed(key, allowed, sizeof allowed);
		snprintf(row, sizeof row, "\n| `%s` | %s | ", name, allowed);
		if (key->type != CONFIG_SECTION)
			ck_assert_msg(strstr(doc, row) != NULL, "docs/configuration.md lacks \"%s\"", row + 1);
		count += key->type != CONFIG_SECTION;
		strcat(name, key->type == CONFIG_LIST ? "[]." : ".");
		if (key->keys)
			count += check_documented(doc, key->keys, name);
	}
	return count;
}

START_TEST(every_key_is_documented)
{
	char *doc = shipped("docs/configuration.md");
	int rows = 0, keys = check_documented(doc, config_keys, "");
	for (const char *row = doc; (row = strstr(row, "\n| `")) != NULL; row++)
		rows += strncmp(row, "\n| `config/", 11) != 0;
	ck_assert_int_eq(rows, keys);
	free(doc);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("config");
	TCase *files = tcase_create("shipped");
	tcase_add_test(files, thesis_table_in_si);
	tcase_add_test(files, snooker_table_by_the_rules);
	tcase_add_test(files, geometry_of_both);
	tcase_add_test(files, jaws_of_the_big_table_leave_room);
	tcase_add_test(files, shipped_play);
	tcase_add_test(files, the_way_of_the_thesis);
	tcase_add_test(files, projector_shows_the_table);
	tcase_add_test(files, default_path);
	tcase_add_test(files, every_key_is_documented);
	suite_add_tcase(suite, files);
	TCase *errors = tcase_create("errors");
	tcase_set_timeout(errors, 60);
	tcase_add_loop_test(errors, error_names_place_and_range, 0, sizeof bad / sizeof *bad);
	tcase_add_test(errors, any_key_may_be_missing);
	tcase_add_test(errors, a_file_holds_what_differs);
	tcase_add_test(errors, elements_of_lists_are_whole);
	tcase_add_loop_test(errors, unknown_keys_name_the_nearest, 0, sizeof misspelt / sizeof *misspelt);
	tcase_add_test(errors, later_keys_have_defaults);
	tcase_add_test(errors, what_is_no_file);
	tcase_add_test(errors, damaged_files);
	suite_add_tcase(suite, errors);
	return suite;
}
