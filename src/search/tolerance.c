/* How far a shot may be off before the pot fails, found by simulation, and what that makes of a player's spread. */
#include "search/tolerance.h"

#include <math.h>

enum { HALVINGS = 6 };

/* A shot with one quantity off by some amount. */
struct trial {
	const struct task *task;
	const struct state *state;
	struct workspace *work;
	struct record record;
	struct shot exact;
	bool speed; /* false: the angle is off */
};

static bool still_falls(struct trial *trial, double off)
{
	struct rules_outcome outcome;
	if (budget_is_over(trial->task->budget))
		return false;
	trial->record.shot = trial->exact;
	if (trial->speed)
		trial->record.shot.speed *= 1 + off;
	else
		trial->record.shot.angle += off;
	if (!(trial->record.shot.speed > 0 && trial->record.shot.speed <= SHOT_SPEED_MAX))
		return false;
	return state_play(trial->task, trial->state, trial->work, &trial->record, &outcome) &&
	       trial->record.foul == 0 && shot_is_as_meant(&trial->record);
}

/* Largest |off| in the direction of sign up to which it falls: doubled from first to last, then halved between. */
static double reach(struct trial *trial, double sign, double first, double last)
{
	double good = 0, bad = first;
	while (bad < last && still_falls(trial, sign * bad)) {
		good = bad;
		bad *= 2;
	}
	if (bad >= last) {
		bad = last;
		if (still_falls(trial, sign * bad))
			return bad;
	}
	for (int i = 0; i < HALVINGS; i++) {
		double middle = (good + bad) / 2;
		if (still_falls(trial, sign * middle))
			good = middle;
		else
			bad = middle;
	}
	return good;
}

/* Probability that a normal deviate of that sigma lies within (-below, above). */
static double within(double below, double above, double sigma)
{
	if (sigma <= 0)
		return 1;
	return (erf(above / (sigma * M_SQRT2)) + erf(below / (sigma * M_SQRT2))) / 2;
}

void tolerance_find(const struct task *task, const struct state *state, struct record *record, struct workspace *work)
{
	const struct cost_profile *profile = &task->def->profile;
	struct trial trial = {.task = task, .state = state, .work = work, .record = *record, .exact = record->shot};
	if (record->target < 0)
		return;
	double left = reach(&trial, 1, 0.0005, 0.1), right = reach(&trial, -1, 0.0005, 0.1);
	trial.speed = true;
	double faster = reach(&trial, 1, 0.01, 0.5), slower = reach(&trial, -1, 0.01, 0.5);
	if (budget_is_over(task->budget))
		return; /* what was found is cut short: it stays unknown */
	record->tolerance_angle = fmin(left, right);
	record->tolerance_speed = fmin(faster, slower);
	record->success = within(right, left, profile->error.angle) * within(slower, faster, profile->error.speed);
}
