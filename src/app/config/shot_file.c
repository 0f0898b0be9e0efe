#include "app/config/shot_file.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/text_file.h"
#include "physics/motion.h"

enum { FILE_SIZE_MAX = 4 << 20 };

struct reader {
	struct shot_file *file;
	const char *name;
	char *err;
	size_t err_size;
};

__attribute__((format(printf, 2, 3))) static int refuse(const struct reader *reader, const char *format, ...)
{
	char reason[200];
	va_list args;
	va_start(args, format);
	vsnprintf(reason, sizeof reason, format, args);
	va_end(args);
	snprintf(reader->err, reader->err_size, "%s: %s", reader->name, reason);
	return -EINVAL;
}

/* ---- frames: a turn by 90 degrees, and the origin from the corner to the centre -------------------------------------
 */

static vec2 turned_in(double x, double y)
{
	return (vec2){y, -x};
}

static vec2 turned_out(vec2 v)
{
	return (vec2){-v.y, v.x};
}

static vec2 place_in(const struct table *table, double x, double y)
{
	return turned_in(x - 0.5 * table->width, y - 0.5 * table->length);
}

static vec2 place_out(const struct table *table, vec2 v)
{
	vec2 corner = {0.5 * table->width, 0.5 * table->length};
	return vec2_add(turned_out(v), corner);
}

/* ---- table ----------------------------------------------------------------------------------------------------------
 */

static int keep_id(const struct reader *reader, const char *id, char out[SHOT_ID_SIZE])
{
	if (strlen(id) >= SHOT_ID_SIZE)
		return refuse(reader, "the id \"%.40s\" is longer than %d", id, SHOT_ID_SIZE - 1);
	strcpy(out, id);
	return 0;
}

static int read_linear(const struct reader *reader, json_t *item, size_t i)
{
	struct table *t = &reader->file->table;
	json_error_t error;
	const char *id;
	double ax, ay, bx, by, z, height;
	if (json_unpack_ex(item, &error, 0, "{s:s, s:[F,F,F], s:[F,F,F], s:F}", "id", &id, "p1", &ax, &ay, &z, "p2",
			   &bx, &by, &z, "height", &height) < 0)
		return refuse(reader, "table.linear[%zu]: %s", i, error.text);
	/* A rail lies along an edge of the bed; what lies elsewhere belongs to a pocket. */
	double edge = 1e-6;
	bool along_y = (fabs(ax) < edge || fabs(ax - t->width) < edge) && fabs(ax - bx) < edge;
	bool along_x = (fabs(ay) < edge || fabs(ay - t->length) < edge) && fabs(ay - by) < edge;
	/* That simulator has neither sides nor tips to its segments. */
	t->cushion[i] = (struct cushion){.a = place_in(t, ax, ay),
					 .b = place_in(t, bx, by),
					 .nose_height = height,
					 .main_rail = along_x || along_y,
					 .two_sided = !(along_x || along_y),
					 .open_ends = true};
	t->cushion_count = (int)i + 1;
	return keep_id(reader, id, reader->file->cushion_id[i]);
}

static int read_circular(const struct reader *reader, json_t *item, size_t i)
{
	struct table *t = &reader->file->table;
	json_error_t error;
	const char *id;
	double x, y, radius, height;
	if (json_unpack_ex(item, &error, 0, "{s:s, s:F, s:F, s:F, s:F}", "id", &id, "a", &x, "b", &y, "radius", &radius,
			   "height", &height) < 0)
		return refuse(reader, "table.circular[%zu]: %s", i, error.text);
	/* That simulator's contact normal points from the circle's centre, at nose height, to the ball's centre: as
	 * flat as that of a straight nose this much nearer to the ball's middle. */
	double r = t->ball_radius, nose = r + (height - r) * r / (r + radius);
	t->jaw[i] = (struct jaw){place_in(t, x, y), radius, nose};
	t->jaw_count = (int)i + 1;
	return keep_id(reader, id, reader->file->jaw_id[i]);
}

static int read_pocket(const struct reader *reader, json_t *item, size_t i)
{
	struct table *t = &reader->file->table;
	json_error_t error;
	const char *id;
	double x, y, radius;
	if (json_unpack_ex(item, &error, 0, "{s:s, s:F, s:F, s:F}", "id", &id, "a", &x, "b", &y, "radius", &radius) < 0)
		return refuse(reader, "table.pockets[%zu]: %s", i, error.text);
	struct pocket *pocket = &t->pocket[i];
	*pocket = (struct pocket){.centre = place_in(t, x, y), .radius = radius};
	pocket->normal = vec2_scale(vec2_unit(pocket->centre), -1);
	snprintf(pocket->name, sizeof pocket->name, "%s", id);
	t->pocket_count = (int)i + 1;
	return keep_id(reader, id, reader->file->pocket_id[i]);
}

typedef int item_reader(const struct reader *reader, json_t *item, size_t i);

static int read_list(const struct reader *reader, json_t *table, const char *key, size_t most, item_reader *read)
{
	json_t *list = json_object_get(table, key), *item;
	if (!json_is_array(list))
		return refuse(reader, "table.%s: not a list", key);
	if (json_array_size(list) > most)
		return refuse(reader, "table.%s: %zu of them, at most %zu are possible", key, json_array_size(list),
			      most);
	size_t i;
	int r = 0;
	json_array_foreach(list, i, item)
	{
		r = r ? r : read(reader, item, i);
	}
	return r;
}

static int read_params(const struct reader *reader, json_t *params)
{
	struct table *t = &reader->file->table;
	struct material *m = &t->material;
	json_error_t error;
	double u_sp;
	if (json_unpack_ex(params, &error, 0, "{s:F, s:F, s:F, s:F, s:F, s:F, s:F, s:F, s:F}", "m", &t->ball_mass, "R",
			   &t->ball_radius, "u_s", &m->mu_slide, "u_r", &m->mu_roll, "u_sp", &u_sp, "e_b", &m->e_ball,
			   "e_c", &m->e_cushion, "f_c", &m->mu_cushion, "g", &m->gravity) < 0)
		return refuse(reader, "params: %s", error.text);
	m->mu_spin = u_sp * t->ball_radius;
	return 0;
}

static int read_table(const struct reader *reader, json_t *table)
{
	struct table *t = &reader->file->table;
	json_error_t error;
	if (json_unpack_ex(table, &error, 0, "{s:F, s:F}", "w", &t->width, "l", &t->length) < 0)
		return refuse(reader, "table: %s", error.text);
	int r = read_list(reader, table, "linear", CUSHION_MAX, read_linear);
	r = r ? r : read_list(reader, table, "circular", JAW_MAX, read_circular);
	r = r ? r : read_list(reader, table, "pockets", POCKET_MAX, read_pocket);
	char reason[160];
	if (r == 0 && table_finish(t, reason, sizeof reason) < 0)
		r = refuse(reader, "table: %s", reason);
	return r;
}

/* ---- models: the names are the other simulator's
 * ---------------------------------------------------------------------- */

static int read_ball_model(const struct reader *reader, const char *text, double average)
{
	struct material *m = &reader->file->table.material;
	struct model *model = &reader->file->model;
	if (strcmp(text, "FrictionlessElastic()") == 0) {
		model->ball = BALL_MODEL_ELASTIC;
		return 0;
	}
	model->ball = BALL_MODEL_FRICTIONAL;
	if (sscanf(text, "FrictionalInelastic(friction=AlciatoreBallBallFriction(a=%lf, b=%lf, c=%lf", &m->mu_ball_a,
		   &m->mu_ball_b, &m->mu_ball_c) == 3)
		return 0;
	if (strcmp(text, "FrictionalInelastic(friction=AverageBallBallFriction())") == 0) {
		m->mu_ball_a = average;
		return 0;
	}
	return refuse(reader, "models.ball_ball: \"%.80s\" is not known", text);
}

static int read_cushion_model(const struct reader *reader, const char *text)
{
	struct model *model = &reader->file->model;
	if (strcmp(text, "UnrealisticLinear(restitution=False)") == 0)
		model->cushion = CUSHION_MODEL_MIRROR;
	else if (strcmp(text, "UnrealisticLinear(restitution=True)") == 0)
		model->cushion = CUSHION_MODEL_RESTITUTION;
	else if (sscanf(text, "StrongeCompliantLinear(omega_ratio=%lf", &reader->file->table.material.stronge_omega) ==
		 1)
		model->cushion = CUSHION_MODEL_STRONGE;
	else if (strncmp(text, "Mathavan2010Linear(", 19) == 0)
		model->cushion = CUSHION_MODEL_MATHAVAN;
	else
		return refuse(reader, "models.ball_linear_cushion: \"%.80s\" is not known", text);
	return 0;
}

static int read_models(const struct reader *reader, json_t *models, json_t *params)
{
	json_error_t error;
	const char *ball, *cushion;
	double average = 0;
	if (json_unpack_ex(models, &error, 0, "{s:s, s:s}", "ball_ball", &ball, "ball_linear_cushion", &cushion) < 0)
		return refuse(reader, "models: %s", error.text);
	if (json_unpack_ex(params, &error, 0, "{s?F}", "u_b", &average) < 0)
		return refuse(reader, "params: %s", error.text);
	reader->file->model.pocket = POCKET_MODEL_JAWS;
	int r = read_ball_model(reader, ball, average);
	return r ? r : read_cushion_model(reader, cushion);
}

/* ---- balls
 * ------------------------------------------------------------------------------------------------------------ */

static int read_ball(const struct reader *reader, const char *id, json_t *state, struct ball *ball)
{
	const struct table *t = &reader->file->table;
	json_error_t error;
	int code;
	double r[3], v[3], w[3];
	if (json_unpack_ex(state, &error, 0, "{s:i, s:[F,F,F], s:[F,F,F], s:[F,F,F]}", "s", &code, "r", &r[0], &r[1],
			   &r[2], "v", &v[0], &v[1], &v[2], "w", &w[0], &w[1], &w[2]) < 0)
		return refuse(reader, "ball \"%.40s\": %s", id, error.text);
	if (hypot(v[0], v[1]) > 100 || sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) > 1e5)
		return refuse(reader, "ball \"%.40s\": faster than 100 m/s or 100000 rad/s", id);
	vec2 spin = turned_in(w[0], w[1]);
	*ball = (struct ball){.pos = place_in(t, r[0], r[1]),
			      .vel = turned_in(v[0], v[1]),
			      .spin = {spin.x, spin.y, w[2]},
			      .colour = COLOUR_UNKNOWN};
	if (code == 4)
		ball->phase = BALL_POTTED;
	else
		motion_classify(ball, t);
	return 0;
}

static int check_places(const struct reader *reader)
{
	struct shot_file *f = reader->file;
	char reason[160];
	int first = -1, second = -1;
	if (table_check_balls(&f->table, f->ball, f->ball_count, &first, &second, reason, sizeof reason) == 0)
		return 0;
	return refuse(reader, "ball \"%s\"%s%s: %s", first >= 0 ? f->ball_id[first] : "?", second >= 0 ? " and " : "",
		      second >= 0 ? f->ball_id[second] : "", reason);
}

/* The struck ball's state comes from "post_strike". */
static int read_balls(const struct reader *reader, json_t *root)
{
	struct shot_file *f = reader->file;
	json_error_t error;
	json_t *balls, *struck, *state;
	const char *cue, *id;
	if (json_unpack_ex(root, &error, 0, "{s:o, s:{s:s}, s:o}", "balls", &balls, "cue", "ball", &cue, "post_strike",
			   &struck) < 0)
		return refuse(reader, "%s", error.text);
	if (!json_is_object(balls) || json_object_size(balls) == 0 || json_object_size(balls) > BALL_MAX)
		return refuse(reader, "balls: %zu of them, 1 to %d are possible", json_object_size(balls), BALL_MAX);
	if (!json_object_get(balls, cue))
		return refuse(reader, "cue.ball: there is no ball \"%.40s\"", cue);
	json_object_foreach(balls, id, state)
	{
		bool is_cue = strcmp(id, cue) == 0;
		int i = f->ball_count++, r = keep_id(reader, id, f->ball_id[i]);
		r = r ? r : read_ball(reader, id, is_cue ? struck : state, &f->ball[i]);
		if (r)
			return r;
		if (is_cue)
			f->ball[i].colour = COLOUR_WHITE;
	}
	return check_places(reader);
}

static int read_root(const struct reader *reader, json_t *root)
{
	json_error_t error;
	json_t *table, *params, *models;
	if (json_unpack_ex(root, &error, 0, "{s:o, s:o, s:o}", "table", &table, "params", &params, "models", &models) <
	    0)
		return refuse(reader, "%s", error.text);
	int r = read_params(reader, params);
	r = r ? r : read_models(reader, models, params);
	r = r ? r : read_table(reader, table);
	return r ? r : read_balls(reader, root);
}

int shot_file_parse(struct shot_file *out, const char *name, const char *text, size_t size, char *err, size_t err_size)
{
	struct reader reader = {calloc(1, sizeof *out), name, err, err_size};
	if (!reader.file) {
		snprintf(err, err_size, "%s: out of memory", name);
		return -ENOMEM;
	}
	json_error_t error;
	json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
	int r = root ? read_root(&reader, root) : -EINVAL;
	if (!root)
		snprintf(err, err_size, "%s:%d: %s", name, error.line, error.text);
	if (r == 0)
		*out = *reader.file;
	json_decref(root);
	free(reader.file);
	return r;
}

int shot_file_read(struct shot_file *out, const char *path, char *err, size_t err_size)
{
	char *text;
	size_t size;
	int r = text_file_read(path, FILE_SIZE_MAX, &text, &size, err, err_size);
	if (r < 0)
		return r;
	r = shot_file_parse(out, path, text, size, err, err_size);
	free(text);
	return r;
}

/* ---- output
 * ----------------------------------------------------------------------------------------------------------- */

/* pocket: where the ball has just fallen, or NULL. That simulator puts it at the pocket's centre. */
static json_t *state_json(const struct shot_file *file, const struct sim *sim, int i, const struct pocket *pocket)
{
	static const int code[] = {
		[BALL_REST] = 0, [BALL_SPINNING] = 1, [BALL_SLIDING] = 2, [BALL_ROLLING] = 3, [BALL_POTTED] = 4};
	struct ball b = sim_ball(sim, i);
	vec2 r = place_out(&file->table, pocket ? pocket->centre : b.pos), v = turned_out(b.vel),
	     w = turned_out((vec2){b.spin[0], b.spin[1]});
	return json_pack("{s:i, s:[f,f], s:[f,f], s:[f,f,f]}", "s", code[b.phase], "r", r.x, r.y, "v", v.x, v.y, "w",
			 w.x, w.y, b.spin[2]);
}

static const char *partner_id(const struct shot_file *file, const struct event *event)
{
	switch (event->kind) {
	case EVENT_BALL_BALL:
		return file->ball_id[event->other];
	case EVENT_CUSHION:
		return file->cushion_id[event->other];
	case EVENT_JAW:
		return file->jaw_id[event->other];
	case EVENT_POCKET:
		return file->pocket_id[event->other];
	default:
		return NULL;
	}
}

static json_t *event_json(const struct shot_file *file, const struct sim *sim, const struct event *event)
{
	const char *id = file->ball_id[event->ball], *partner = partner_id(file, event);
	const struct pocket *pocket = event->kind == EVENT_POCKET ? &file->table.pocket[event->other] : NULL;
	json_t *post = json_pack("{s:o}", id, state_json(file, sim, event->ball, pocket));
	if (event->kind == EVENT_BALL_BALL)
		json_object_set_new(post, partner, state_json(file, sim, event->other, NULL));
	json_t *ids = partner ? json_pack("[s,s]", id, partner) : json_pack("[s]", id);
	return json_pack("{s:f, s:s, s:o, s:o}", "t", event->time, "event", event_kind_name(event->kind), "ids", ids,
			 "post", post);
}

static int print_line(json_t *line, FILE *out)
{
	if (!line)
		return -ENOMEM;
	int r = json_dumpf(line, out, JSON_COMPACT) < 0 || fputc('\n', out) == EOF ? -EIO : 0;
	json_decref(line);
	return r;
}

int shot_file_run(const struct shot_file *file, int max_events, FILE *out)
{
	struct sim *sim = malloc(sizeof *sim);
	if (!sim)
		return -ENOMEM;
	sim_init(sim, &file->table, &file->model, file->ball, file->ball_count);
	struct event event;
	int r = 0;
	for (int n = 0; r == 0 && sim_step(sim, &event); n++)
		r = n < max_events ? print_line(event_json(file, sim, &event), out) : -ETIME;
	free(sim);
	return r;
}
