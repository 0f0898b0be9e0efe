#include "app/virtual/habits.h"

#include <math.h>

static const double WIPE_TIME = 2.5, LINGER_TIME = 8, TOUCH_TIME = 1; /* s */
static const double WHIM_AFTER = 0.3;				      /* s of rest */
static const double OWN_SPEED = 1.5;				      /* m/s of a shot of his own */
static const double TOUCH_LOW = 0.003, TOUCH_HIGH = 0.030;	      /* m a touched ball is moved */
static const double BRIDGE = 0.22, FOREARM = 0.75;		      /* m behind the cue ball */
static const double FEATHER = 0.06, FEATHER_PERIOD = 0.4;	      /* m, s of the strokes before the strike */
static const double TIP_GAP = 0.012;				      /* m between tip and ball when he aims */

enum whim { WHIM_OTHER, WHIM_QUICK, WHIM_TOUCH, WHIM_WIPE, WHIM_LINGER, WHIM_BALL, WHIM_FAR, WHIM_WAY, WHIM_COUNT };

static uint64_t mix(uint64_t z)
{
	z += 0x9e3779b97f4a7c15u;
	z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
	z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
	return z ^ (z >> 31);
}

/* Uniform in [0, 1), belongs to this turn. */
static double chance(const struct habits *h, enum whim whim)
{
	return (double)(mix(h->def.seed ^ mix(h->turn * WHIM_COUNT + (uint64_t)whim + 1)) >> 11) * 0x1p-53;
}

void habits_init(struct habits *h, const struct table *table, const struct config_virtual *def)
{
	*h = (struct habits){.table = table, .def = *def, .rest = NAN};
}

static void enter(struct habits *h, enum habits_state state, double now)
{
	h->state = state;
	h->since = now;
}

static int cue_ball(const struct habits_view *view)
{
	for (int i = 0; i < view->count; i++)
		if (view->ball[i].colour == COLOUR_WHITE && view->ball[i].phase != BALL_POTTED)
			return i;
	return -1;
}

/* Straight at the nearest ball, or at one that chance picks. */
static struct shot own_shot(const struct habits *h, const struct habits_view *view, int cue, bool nearest)
{
	int best = -1, pick = (int)(chance(h, WHIM_BALL) * view->count);
	for (int k = 0; k < view->count; k++) {
		int i = (k + pick) % view->count;
		if (i == cue || view->ball[i].phase == BALL_POTTED)
			continue;
		double d = vec2_dist(view->ball[i].pos, view->ball[cue].pos);
		if (best < 0 || (nearest && d < vec2_dist(view->ball[best].pos, view->ball[cue].pos)))
			best = i;
	}
	vec2 way = best < 0 ? (vec2){1, 0} : vec2_sub(view->ball[best].pos, view->ball[cue].pos);
	return (struct shot){.angle = atan2(way.y, way.x), .speed = OWN_SPEED * (0.5 + chance(h, WHIM_FAR))};
}

/* ---- whims of a rest ---- */

static void begin_whim(struct habits *h, double now)
{
	h->whim_done = true;
	h->touching = chance(h, WHIM_TOUCH) < h->def.habit.touch;
	h->wiping = !h->touching && chance(h, WHIM_WIPE) < h->def.habit.wipe;
	bool lingers = chance(h, WHIM_LINGER) < h->def.habit.linger;
	h->busy = h->touching ? TOUCH_TIME : h->wiping ? WIPE_TIME : lingers ? LINGER_TIME : 0;
	if (h->busy > 0)
		enter(h, HABITS_BUSY, now);
}

static bool is_free(const struct habits *h, const struct habits_view *view, int ball, vec2 at)
{
	struct ball moved[BALL_MAX];
	char reason[160];
	for (int i = 0; i < view->count; i++)
		moved[i] = view->ball[i];
	moved[ball].pos = at;
	return table_check_balls(h->table, moved, view->count, &(int){0}, &(int){0}, reason, sizeof reason) == 0;
}

/* The ball that chance picks, moved a little; nothing when it would lie in another one. */
static void touch(const struct habits *h, const struct habits_view *view, struct habits_act *act)
{
	int ball = (int)(chance(h, WHIM_BALL) * view->count);
	double far = TOUCH_LOW + (TOUCH_HIGH - TOUCH_LOW) * chance(h, WHIM_FAR),
	       way = 6.283185307179586 * chance(h, WHIM_WAY);
	vec2 to = vec2_madd(view->ball[ball].pos, far, vec2_from_angle(way));
	if (view->ball[ball].phase == BALL_POTTED || !is_free(h, view, ball, to))
		return;
	act->touched = ball;
	act->to = to;
}

/* ---- shots ---- */

/* Whether he goes to the table now, and with which shot. */
static bool wants_shot(struct habits *h, const struct habits_view *view, int cue, double now)
{
	double patience = h->def.habit.patience;
	bool proposed = view->proposal && view->proposal != h->played;
	if (proposed && view->proposal != h->seen) {
		h->seen = view->proposal;
		h->seen_at = now;
	}
	if (h->again) {
		h->shot = own_shot(h, view, cue, true);
		return true;
	}
	if (proposed && now - h->seen_at >= h->def.think_time) {
		bool other = chance(h, WHIM_OTHER) < h->def.habit.other;
		h->played = view->proposal;
		h->shot = other ? own_shot(h, view, cue, false) : view->shot;
		return true;
	}
	if (proposed || patience <= 0 || now - h->rest < patience)
		return false;
	h->shot = own_shot(h, view, cue, true);
	return true;
}

static void strike(struct habits *h, struct habits_act *act, double now)
{
	act->strike = true;
	act->shot = h->shot;
	h->again = !h->again && chance(h, WHIM_QUICK) < h->def.habit.quick;
	h->turn++;
	enter(h, h->def.habit.aim_time > 0 ? HABITS_LEAVE : HABITS_LOOK, now);
}

static void look(struct habits *h, const struct habits_view *view, struct habits_act *act, double now)
{
	int cue = cue_ball(view);
	if (cue < 0 || isnan(h->rest))
		return;
	if (!h->whim_done && !h->again && now - h->rest > WHIM_AFTER)
		begin_whim(h, now);
	if (h->state != HABITS_LOOK || !wants_shot(h, view, cue, now))
		return;
	h->cue = view->ball[cue].pos;
	if (h->def.habit.aim_time > 0 && !h->again)
		enter(h, HABITS_AIM, now);
	else
		strike(h, act, now);
}

static void note_rest(struct habits *h, const struct habits_view *view, double now)
{
	if (!view->at_rest) {
		h->rest = NAN;
		h->whim_done = false;
	} else if (isnan(h->rest)) {
		h->rest = now;
		h->turn++;
	}
}

struct habits_act habits_tick(struct habits *h, const struct habits_view *view, double now)
{
	struct habits_act act = {.touched = -1};
	double passed = now - h->since;
	note_rest(h, view, now);
	switch (h->state) {
	case HABITS_LOOK:
		look(h, view, &act, now);
		break;
	case HABITS_AIM:
		if (cue_ball(view) < 0)
			enter(h, HABITS_LOOK, now);
		else if (passed >= h->def.habit.aim_time)
			strike(h, &act, now);
		break;
	case HABITS_LEAVE:
		if (passed >= h->def.habit.leave_time)
			enter(h, HABITS_LOOK, now);
		break;
	case HABITS_BUSY:
		if (h->touching && view->at_rest && passed >= h->busy / 2) {
			h->touching = false;
			touch(h, view, &act);
		}
		if (passed >= h->busy)
			enter(h, HABITS_LOOK, now);
		break;
	}
	return act;
}

/* ---- arm ---- */

/* A hand at a place, its arm from the nearest long side. */
static struct table_arm reach(const struct habits *h, vec2 at)
{
	double side = at.y < 0 ? -1 : 1;
	return (struct table_arm){
		.hand = true, .bridge = at, .elbow = {at.x + 0.1, side * (h->table->width / 2 + 0.35)}};
}

static struct table_arm cue_arm(const struct habits *h, double back)
{
	vec2 way = vec2_from_angle(h->shot.angle);
	double r = h->table->ball_radius;
	return (struct table_arm){.cue = true,
				  .hand = true,
				  .tip = vec2_madd(h->cue, -(r + TIP_GAP + back), way),
				  .bridge = vec2_madd(h->cue, -(r + BRIDGE), way),
				  .elbow = vec2_madd(h->cue, -(r + BRIDGE + FOREARM), way)};
}

struct table_arm habits_arm(const struct habits *h, const struct habits_view *view, double now)
{
	double passed = now - h->since, aim = h->def.habit.aim_time;
	if (view->placing)
		return reach(h, *view->placing);
	if (h->state == HABITS_AIM)
		return cue_arm(h, FEATHER * (0.5 - 0.5 * cos(6.283185307179586 * (aim - passed) / FEATHER_PERIOD)));
	if (h->state == HABITS_LEAVE) {
		struct table_arm arm = cue_arm(h, 0);
		double share = h->def.habit.leave_time > 0 ? fmin(1, passed / h->def.habit.leave_time) : 1;
		vec2 away = vec2_madd((vec2){0, 0}, -share * 2 * h->table->length, vec2_from_angle(h->shot.angle));
		arm.tip = vec2_add(arm.tip, away);
		arm.bridge = vec2_add(arm.bridge, away);
		arm.elbow = vec2_add(arm.elbow, away);
		return arm;
	}
	if (h->state != HABITS_BUSY)
		return (struct table_arm){0};
	int ball = (int)(chance(h, WHIM_BALL) * view->count);
	double across = h->wiping ? 0.25 * h->table->length * sin(2 * passed) : 0.03;
	return reach(h, (vec2){view->ball[ball].pos.x + across, view->ball[ball].pos.y});
}
