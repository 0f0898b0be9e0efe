#include "app/virtual/player.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
static const double SPEED_MIN = 0.01, SPEED_MAX = 20;	  /* m/s */
static const double ELEVATION_MAX = 1.57;		  /* rad */
static const double TIME_MAX = 120;			  /* s: balls rest long before */
static const double PLACE_STEP = 0.01, PLACE_GAP = 0.002; /* m, for the cue ball in hand */
static const double RACK_GAP = 0.001;			  /* m between pink and the first red */

/* ---- positions ---- */

void player_rack(const struct table *table, struct ball ball[BALL_MAX])
{
	double d = 2 * table->ball_radius;
	int n = 0;
	ball[n++] = ball_at(COLOUR_WHITE, vec2_add(table->baulk_d_centre, (vec2){0, 0.55 * table->baulk_d_radius}));
	vec2 apex = vec2_add(table->spot[COLOUR_PINK], (vec2){d + RACK_GAP, 0});
	for (int row = 0; row < 5; row++)
		for (int k = 0; k <= row; k++)
			ball[n++] =
				ball_at(COLOUR_RED, vec2_add(apex, (vec2){row * d * sqrt(0.75), (k - 0.5 * row) * d}));
	for (int colour = COLOUR_YELLOW; colour <= COLOUR_BLACK; colour++)
		ball[n++] = ball_at((enum ball_colour)colour, table->spot[colour]);
	assert(n == BALL_MAX);
}

static uint64_t mix(uint64_t z)
{
	z += 0x9e3779b97f4a7c15u;
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return z ^ (z >> 31);
}

static double uniform(uint64_t *state)
{
	*state = mix(*state);
	return (double)(*state >> 11) * 0x1p-53;
}

/* Adds a ball at a random place where it fits; leaves it out when none is found. */
static int scatter_one(const struct table *table, struct ball *ball, int count, enum ball_colour colour,
		       uint64_t *state)
{
	char reason[160];
	for (int tries = 0; tries < 200; tries++) {
		double x = (uniform(state) - 0.5) * (table->length - 2 * table->ball_radius),
		       y = (uniform(state) - 0.5) * (table->width - 2 * table->ball_radius);
		ball[count] = ball_at(colour, (vec2){x, y});
		if (table_check_balls(table, ball, count + 1, &(int){0}, &(int){0}, reason, sizeof reason) == 0)
			return count + 1;
	}
	return count;
}

int player_scatter(const struct table *table, uint64_t seed, struct ball ball[BALL_MAX])
{
	uint64_t state = mix(seed);
	int n = 0, reds = 1 + (int)(10 * uniform(&state));
	for (int colour = COLOUR_YELLOW; colour <= COLOUR_BLACK; colour++)
		ball[n++] = ball_at((enum ball_colour)colour, table->spot[colour]);
	for (int i = 0; i < 6; i++)
		if (uniform(&state) < 0.3) { /* it lies where the last shot left it */
			struct ball first = ball[i];
			for (int k = i; k + 1 < n; k++)
				ball[k] = ball[k + 1];
			n = scatter_one(table, ball, n - 1, first.colour, &state);
		}
	for (int i = 0; i < reds; i++)
		n = scatter_one(table, ball, n, COLOUR_RED, &state);
	return scatter_one(table, ball, n, COLOUR_WHITE, &state);
}

static int cue_ball(const struct virtual_table *vt)
{
	for (int i = 0; i < vt->count; i++)
		if (vt->ball[i].colour == COLOUR_WHITE && vt->ball[i].phase != BALL_POTTED)
			return i;
	return -1;
}

static bool is_free(const struct virtual_table *vt, vec2 pos)
{
	double r = vt->table->ball_radius;
	if (fabs(pos.x) > vt->table->length / 2 - r - PLACE_GAP || fabs(pos.y) > vt->table->width / 2 - r - PLACE_GAP)
		return false;
	for (int i = 0; i < vt->count; i++)
		if (vt->ball[i].phase != BALL_POTTED && vec2_dist(vt->ball[i].pos, pos) < 2 * r + PLACE_GAP)
			return false;
	for (int i = 0; i < vt->table->pocket_count; i++)
		if (vec2_dist(vt->table->pocket[i].centre, pos) < vt->table->pocket[i].radius + r)
			return false;
	return true;
}

static bool in_the_d(const struct table *table, vec2 pos)
{
	return pos.x <= table->baulk_d_centre.x && vec2_dist(pos, table->baulk_d_centre) <= table->baulk_d_radius;
}

/* The free place nearest to the middle of the D; one in the D if there is any. False when the bed is full. */
static bool place_for_cue(const struct virtual_table *vt, vec2 *out)
{
	const struct table *table = vt->table;
	vec2 middle = {table->baulk_d_centre.x - table->baulk_d_radius / 2, table->baulk_d_centre.y};
	int nx = (int)(table->length / PLACE_STEP), ny = (int)(table->width / PLACE_STEP);
	double best = INFINITY;
	for (int i = -nx; i <= nx; i++)
		for (int j = -ny; j <= ny; j++) {
			vec2 pos = vec2_madd(middle, PLACE_STEP, (vec2){i, j});
			double distance = vec2_dist(pos, middle) + (in_the_d(table, pos) ? 0 : table->length);
			if (distance >= best || !is_free(vt, pos))
				continue;
			best = distance;
			*out = pos;
		}
	return best < INFINITY;
}

/* ---- the player's hand ---- */

/* Two Gaussian samples with sigma 1 that belong to this shot (Box and Muller). */
static void gauss(uint64_t seed, int64_t shot, double out[2])
{
	uint64_t a = mix(seed ^ mix((uint64_t)shot)), b = mix(a);
	double u = ((double)(a >> 11) + 1) * 0x1p-53, v = (double)(b >> 11) * 0x1p-53, r = sqrt(-2 * log(u));
	out[0] = r * cos(2 * PI * v);
	out[1] = r * sin(2 * PI * v);
}

static struct shot with_error(const struct virtual_table *vt, const struct shot *shot)
{
	struct shot out = *shot;
	double error[2];
	gauss(vt->seed, vt->shots, error);
	out.angle += vt->error_angle * error[0];
	out.speed = fmax(SPEED_MIN, fmin(SPEED_MAX, out.speed * (1 + vt->error_speed * error[1])));
	return out;
}

static bool shot_ok(const struct shot *shot)
{
	return isfinite(shot->angle) && shot->speed > 0 && shot->speed <= SPEED_MAX &&
	       shot->side * shot->side + shot->follow * shot->follow < 1 && shot->elevation >= 0 &&
	       shot->elevation < ELEVATION_MAX;
}

/* ---- shots ---- */

/* The table that is really there. */
static void wear(struct table *table, const struct config_virtual *def)
{
	struct material *m = &table->material;
	char reason[160];
	m->mu_roll *= def->cloth;
	m->e_cushion = fmin(1, m->e_cushion * def->bounce);
	m->loss_cushion = fmin(0.95, fmax(0, 1 - (1 - m->loss_cushion) * def->bounce));
	if (def->tilt[0] == 0 && def->tilt[1] == 0)
		return;
	struct table level = *table;
	table->bed.slope = vec2_add(table->bed.slope, (vec2){def->tilt[0], def->tilt[1]});
	if (table_finish(table, reason, sizeof reason) < 0)
		*table = level; /* so steep that no ball would rest */
}

void player_init(struct virtual_table *vt, const struct table *table, const struct model *model,
		 const struct config_virtual *def, bool rules, const struct ball *ball, int count)
{
	assert(table_check_balls(table, ball, count, &(int){0}, &(int){0}, (char[200]){0}, 200) == 0);
	memset(vt, 0, sizeof(*vt));
	vt->table = table;
	if (def->cloth > 0 && def->bounce > 0) {
		vt->own = *table;
		wear(&vt->own, def);
		vt->table = &vt->own;
	}
	vt->model = *model;
	vt->error_angle = def->error_angle;
	vt->error_speed = def->error_speed;
	vt->time_scale = def->time_scale;
	vt->place_time = def->habit.place_time;
	vt->seed = def->seed;
	vt->count = count;
	for (int i = 0; i < count; i++)
		vt->ball[i] = ball[i];
	vt->state = rules ? rules_state_from_position(ball, count) : (struct rules_state){.on = ON_ANY};
	vt->result.first = -1;
}

/* First contact and potted balls, from the trace. */
static void read_trace(struct virtual_table *vt, int cue)
{
	struct player_result *result = &vt->result;
	for (int i = 0; i < vt->trace.count; i++) {
		const struct event *event = &vt->trace.entry[i].event;
		/* A ball that only turns on the spot lies still to everybody who looks. */
		if (event->kind != EVENT_SPINNING_REST)
			result->duration = event->time;
		bool of_cue = event->ball == cue || event->other == cue;
		if (event->kind == EVENT_BALL_BALL && of_cue && result->first < 0)
			result->first = event->ball == cue ? event->other : event->ball;
		if (event->kind == EVENT_POCKET && result->potted_count < BALL_MAX) {
			result->potted[result->potted_count].ball = event->ball;
			result->potted[result->potted_count++].pocket = event->other;
		}
	}
}

int player_play(struct virtual_table *vt, const struct shot *shot, double now, char *err, size_t err_size)
{
	int cue = cue_ball(vt);
	if (vt->running) {
		snprintf(err, err_size, "balls are still moving");
		return -EBUSY;
	}
	if (cue < 0 || !shot_ok(shot)) {
		snprintf(err, err_size, cue < 0 ? "there is no cue ball" : "the shot is out of range");
		return -EINVAL;
	}
	vt->result = (struct player_result){.played = with_error(vt, shot), .first = -1};
	sim_init(&vt->sim, vt->table, &vt->model, vt->ball, vt->count);
	sim_strike(&vt->sim, cue, &vt->result.played);
	trace_init(&vt->trace, vt->entry, PLAYER_EVENTS_MAX);
	sim_run(&vt->sim, &(struct sim_limits){TIME_MAX, PLAYER_EVENTS_MAX - 1}, &vt->trace);
	read_trace(vt, cue);
	vt->shots++;
	vt->running = true;
	vt->started = now;
	return 0;
}

static double shot_time(const struct virtual_table *vt, double now)
{
	return fmax(0, (now - vt->started) * vt->time_scale);
}

static void put_cue_in_hand(struct virtual_table *vt)
{
	for (int i = 0; i < vt->count; i++) {
		vec2 pos;
		if (vt->ball[i].colour == COLOUR_WHITE && vt->ball[i].phase == BALL_POTTED && place_for_cue(vt, &pos))
			vt->ball[i] = ball_at(COLOUR_WHITE, pos);
	}
}

static bool has_fallen(const struct virtual_table *vt, int ball)
{
	for (int i = 0; i < vt->result.potted_count; i++)
		if (vt->result.potted[i].ball == ball)
			return true;
	return false;
}

/* Takes the balls that came back off again: a hand brings them, colours first, the cue ball last. */
static void take_in_hand(struct virtual_table *vt, double now)
{
	vt->placing_count = 0;
	vt->place_since = now;
	for (int cue = 0; cue < 2; cue++)
		for (int i = 0; i < vt->count; i++) {
			bool back = has_fallen(vt, i) && vt->ball[i].phase != BALL_POTTED;
			if (!back || (vt->ball[i].colour == COLOUR_WHITE) != cue)
				continue;
			vt->placed[vt->placing_count] = vt->ball[i];
			vt->placing[vt->placing_count++] = i;
			vt->ball[i].phase = BALL_POTTED;
		}
}

bool player_place(struct virtual_table *vt, double now, vec2 *where)
{
	if (vt->placing_count > 0 && now - vt->place_since >= vt->place_time) {
		vt->ball[vt->placing[0]] = vt->placed[0];
		vt->place_since = now;
		vt->placing_count--;
		for (int i = 0; i < vt->placing_count; i++) {
			vt->placing[i] = vt->placing[i + 1];
			vt->placed[i] = vt->placed[i + 1];
		}
	}
	if (vt->placing_count > 0)
		*where = vt->placed[0].pos;
	return vt->placing_count > 0;
}

void player_touch(struct virtual_table *vt, int ball, vec2 to)
{
	assert(!vt->running && ball >= 0 && ball < vt->count);
	vt->ball[ball].pos = to;
}

bool player_tick(struct virtual_table *vt, double now)
{
	if (!vt->running || shot_time(vt, now) < vt->result.duration)
		return false;
	struct rules_outcome outcome;
	rules_judge(vt->table, &vt->state, &vt->trace, -1, &outcome);
	for (int i = 0; i < vt->count; i++)
		vt->ball[i] = outcome.ball[i];
	vt->result.points = outcome.points;
	vt->result.foul = outcome.foul;
	vt->result.cue_potted = outcome.cue_potted;
	vt->result.respot_failed = outcome.respot_failed;
	vt->state = outcome.next;
	put_cue_in_hand(vt);
	if (vt->place_time > 0)
		take_in_hand(vt, now);
	vt->running = false;
	return true;
}

void player_balls(const struct virtual_table *vt, double now, struct ball out[BALL_MAX])
{
	for (int i = 0; i < vt->count; i++)
		out[i] = vt->running ? trace_at(&vt->trace, i, shot_time(vt, now)) : vt->ball[i];
}

bool player_is_done(const struct virtual_table *vt)
{
	for (int i = 0; i < vt->count; i++)
		if (vt->ball[i].colour != COLOUR_WHITE && vt->ball[i].phase != BALL_POTTED)
			return false;
	return true;
}
