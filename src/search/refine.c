/* Mirrors and centre-to-centre contacts are where the aim starts from, not where it ends. */
#include "search/refine.h"

#include <math.h>

enum { STEPS_MAX = 8, HALVINGS_MAX = 3, FASTER_MAX = 4 };
static const double PROBE = 2e-4;    /* rad, first step of the secant */
static const double STEP_MAX = 0.06; /* rad */
static const double GOOD = 1e-3;     /* m beside the goal that is good enough */
static const double FASTER = 1.12;   /* a shot that stops short is played faster by this */

/* How far a chain got, and by how much its last leg passes its goal. */
struct miss {
	int stage;     /* contacts and cushions made as meant */
	double offset; /* m, of the goal to the left of the way */
	bool is_short; /* the ball stopped before its goal */
	bool falls;    /* as meant, and legal */
};

struct aiming {
	const struct task *task;
	struct slot *slot;
	struct workspace *work;
	struct record *record;
	struct rules_outcome *outcome;
	struct goal goal[PLAN_CHAIN_MAX];
};

/* The ball whose leg is looked at. */
struct leg {
	int place; /* in the record's chain, 0 the cue ball */
	int ball, cushions;
	vec2 pos, vel; /* the last that is known of it */
};

static const struct goal *goal_of(const struct aiming *aiming, const struct leg *leg)
{
	return &aiming->goal[aiming->record->chain_count - 1 - leg->place];
}

static void begin_leg(struct leg *leg, const struct aiming *aiming, int place, const struct ball *ball)
{
	*leg = (struct leg){.place = place, .ball = aiming->record->chain[place], .pos = ball->pos, .vel = ball->vel};
}

/* Takes one event of the leg's ball in. False when the leg ends with it. */
static bool follow(struct leg *leg, const struct aiming *aiming, const struct trace_entry *entry)
{
	const struct event *event = &entry->event;
	const struct ball *after = &entry->after[event->ball == leg->ball ? 0 : 1];
	switch (event->kind) {
	case EVENT_BALL_BALL: {
		int other = event->ball == leg->ball ? event->other : event->ball;
		if (leg->place + 1 == aiming->record->chain_count || other != aiming->record->chain[leg->place + 1])
			return false;
		begin_leg(leg, aiming, leg->place + 1, &entry->after[event->ball == other ? 0 : 1]);
		return true;
	}
	case EVENT_CUSHION:
		if (!aiming->task->def->table->cushion[event->other].main_rail ||
		    leg->cushions == goal_of(aiming, leg)->rails)
			return false;
		leg->cushions++;
		break;
	case EVENT_JAW:
	case EVENT_POCKET:
		return false;
	default:
		break;
	}
	leg->pos = after->pos;
	leg->vel = vec2_norm2(after->vel) > 0 ? after->vel : leg->vel;
	return true;
}

static struct miss look(const struct aiming *aiming)
{
	const struct trace *trace = &aiming->work->trace;
	const struct record *record = aiming->record;
	struct leg leg;
	bool ended = false;
	begin_leg(&leg, aiming, 0, &trace->start[record->chain[0]]);
	for (int i = 0; i < trace->count && !ended; i++) {
		const struct event *event = &trace->entry[i].event;
		if (event->ball == leg.ball || (event->kind == EVENT_BALL_BALL && event->other == leg.ball))
			ended = !follow(&leg, aiming, &trace->entry[i]);
	}
	const struct goal *goal = goal_of(aiming, &leg);
	vec2 way = vec2_unit(leg.vel), left = vec2_sub(goal->point, leg.pos);
	return (struct miss){
		.stage = leg.place * (PLAN_RAILS_MAX + 1) + leg.cushions,
		.offset = vec2_cross(way, left),
		.is_short = !ended,
		.falls = record->foul == 0 && shot_is_as_meant(record),
	};
}

static struct miss aim_and_look(struct aiming *aiming, double angle)
{
	const struct task *task = aiming->task;
	const struct state *state = &task->state[aiming->slot->node.state];
	if (budget_is_over(task->budget))
		return (struct miss){.stage = -1};
	aiming->record->shot.angle = angle;
	aiming->slot->count[COUNT_SIMS]++;
	if (!state_play(task, state, aiming->work, aiming->record, aiming->outcome))
		return (struct miss){.stage = -1};
	return look(aiming);
}

static bool is_better(const struct miss *a, const struct miss *b)
{
	if (a->stage != b->stage)
		return a->stage > b->stage;
	return fabs(a->offset) < fabs(b->offset);
}

/* Secant steps from angle, whose miss is known, until the goal is met or nothing gets better. */
static double approach(struct aiming *aiming, double angle, struct miss *miss)
{
	struct miss probe = aim_and_look(aiming, angle + PROBE);
	double slope = probe.stage == miss->stage ? (probe.offset - miss->offset) / PROBE : 0;
	for (int i = 0; i < STEPS_MAX && fabs(miss->offset) > GOOD && slope != 0; i++) {
		double step = fmax(-STEP_MAX, fmin(STEP_MAX, -miss->offset / slope));
		struct miss next = aim_and_look(aiming, angle + step);
		for (int h = 0; h < HALVINGS_MAX && !is_better(&next, miss); h++) {
			step /= 2;
			next = aim_and_look(aiming, angle + step);
		}
		if (!is_better(&next, miss))
			break;
		if (next.stage == miss->stage)
			slope = (next.offset - miss->offset) / step;
		else {
			probe = aim_and_look(aiming, angle + step + PROBE);
			slope = probe.stage == next.stage ? (probe.offset - next.offset) / PROBE : 0;
		}
		angle += step;
		*miss = next;
	}
	return angle;
}

bool shot_refine(const struct task *task, struct slot *slot, struct workspace *work, struct record *record,
		 struct rules_outcome *outcome)
{
	struct aiming aiming = {.task = task, .slot = slot, .work = work, .record = record, .outcome = outcome};
	if (!candidate_goals(&task->state[slot->node.state].scene, &slot->node, aiming.goal))
		return false;
	double angle = record->shot.angle;
	for (int i = 0; i < FASTER_MAX && record->shot.speed <= fmin(task->def->profile.max_speed, SHOT_SPEED_MAX);
	     i++) {
		struct miss miss = aim_and_look(&aiming, angle);
		if (miss.stage < 0)
			return false;
		if (!(miss.falls && fabs(miss.offset) <= GOOD))
			angle = approach(&aiming, angle, &miss);
		miss = aim_and_look(&aiming, angle);
		if (miss.falls)
			return true;
		if (!miss.is_short)
			return false;
		record->shot.speed *= FASTER;
	}
	return false;
}
