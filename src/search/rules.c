#include "search/rules.h"

#include <assert.h>

#include "search/respot.h"

/* The rules as one table: what each state lets be struck, what a miss costs at least, what comes after a pot. */
struct rule {
	bool red, colours, lowest_only; /* what is on */
	int least_foul;
	enum rules_on after_pot;
};

static const struct rule rule_table[] = {
	[ON_ANY] = {.red = true, .colours = true, .lowest_only = false, .least_foul = 4, .after_pot = ON_ANY},
	[ON_RED] = {.red = true, .colours = false, .lowest_only = false, .least_foul = 4, .after_pot = ON_COLOUR},
	[ON_COLOUR] = {.red = false, .colours = true, .lowest_only = false, .least_foul = 4, .after_pot = ON_RED},
	[ON_CLEARANCE] =
		{.red = false, .colours = true, .lowest_only = true, .least_foul = 4, .after_pot = ON_CLEARANCE},
};

static bool is_colour(enum ball_colour colour)
{
	return colour >= COLOUR_YELLOW && colour <= COLOUR_BLACK;
}

static int value_of(const struct ball *ball)
{
	return ball->colour >= COLOUR_RED && ball->colour <= COLOUR_BLACK ? (int)ball->colour : 0;
}

static int count_reds(const struct ball *ball, int count)
{
	int reds = 0;
	for (int i = 0; i < count; i++)
		reds += ball[i].colour == COLOUR_RED && ball[i].phase != BALL_POTTED;
	return reds;
}

/* Lowest colour on the table, COLOUR_UNKNOWN when there is none. */
static enum ball_colour lowest_colour(const struct ball *ball, int count)
{
	enum ball_colour lowest = COLOUR_UNKNOWN;
	for (int i = 0; i < count; i++)
		if (ball[i].phase != BALL_POTTED && is_colour(ball[i].colour) && ball[i].colour < lowest)
			lowest = ball[i].colour;
	return lowest;
}

bool rules_ball_on(const struct rules_state *state, const struct ball *ball, int count, int index)
{
	assert(index >= 0 && index < count);
	const struct rule *rule = &rule_table[state->on];
	const struct ball *b = &ball[index];
	if (b->phase == BALL_POTTED || b->colour == COLOUR_WHITE)
		return false;
	if (state->on == ON_ANY)
		return true;
	if (b->colour == COLOUR_RED)
		return rule->red;
	if (!is_colour(b->colour) || !rule->colours)
		return false;
	return !rule->lowest_only || b->colour == lowest_colour(ball, count);
}

struct rules_state rules_state_from_position(const struct ball *ball, int count)
{
	return (struct rules_state){.on = count_reds(ball, count) > 0 ? ON_RED : ON_CLEARANCE};
}

int rules_first_contact(const struct trace *trace, int cue)
{
	for (int i = 0; i < trace->count; i++) {
		const struct event *event = &trace->entry[i].event;
		if (event->kind == EVENT_BALL_BALL && (event->ball == cue || event->other == cue))
			return event->ball == cue ? event->other : event->ball;
	}
	return -1;
}

/* What a finished shot came to, before it is judged. */
struct facts {
	const struct ball *start; /* before the shot */
	int count, cue, first;
	int potted[BALL_MAX], potted_count; /* object balls */
	bool cue_potted;
};

static void gather(const struct trace *trace, struct facts *facts)
{
	*facts = (struct facts){.start = trace->start, .count = trace->ball_count, .cue = -1, .first = -1};
	for (int i = 0; i < facts->count; i++)
		if (facts->start[i].colour == COLOUR_WHITE)
			facts->cue = i;
	if (facts->cue >= 0)
		facts->first = rules_first_contact(trace, facts->cue);
	for (int i = 0; i < trace->count; i++) {
		const struct event *event = &trace->entry[i].event;
		if (event->kind != EVENT_POCKET)
			continue;
		if (event->ball == facts->cue)
			facts->cue_potted = true;
		else if (facts->potted_count < BALL_MAX)
			facts->potted[facts->potted_count++] = event->ball;
	}
}

/* True when ball index may be struck first and fall: on, and after a red the one colour that was named. */
static bool is_legal(const struct rules_state *state, const struct facts *facts, int nominated, int index)
{
	if (!rules_ball_on(state, facts->start, facts->count, index))
		return false;
	return state->on != ON_COLOUR || nominated < 0 || index == nominated;
}

/* Value of the ball on, which a miss costs if it is more than the least foul. */
static int value_on(const struct rules_state *state, const struct facts *facts, int nominated)
{
	if (state->on == ON_COLOUR)
		return nominated >= 0 ? value_of(&facts->start[nominated]) : 0;
	if (state->on == ON_CLEARANCE) {
		enum ball_colour lowest = lowest_colour(facts->start, facts->count);
		return lowest == COLOUR_UNKNOWN ? 0 : (int)lowest;
	}
	return 0;
}

static int larger(int a, int b)
{
	return a > b ? a : b;
}

/* Penalty of the shot, 0 when it is legal: the highest of all that is wrong with it. Touching a cushion first is legal.
 */
static int penalty(const struct rules_state *state, const struct facts *facts, int nominated)
{
	int foul = 0;
	int least = larger(rule_table[state->on].least_foul, value_on(state, facts, nominated));
	if (facts->first < 0 || facts->cue_potted)
		foul = least;
	if (!state->any_first && facts->first >= 0 && !is_legal(state, facts, nominated, facts->first))
		foul = larger(foul, larger(least, value_of(&facts->start[facts->first])));
	for (int i = 0; i < facts->potted_count; i++)
		if (!is_legal(state, facts, nominated, facts->potted[i]))
			foul = larger(foul, larger(least, value_of(&facts->start[facts->potted[i]])));
	return foul;
}

/* Puts potted colours back, the most valuable first. Not those that the clearance has taken off for good. */
static void respot_colours(const struct table *table, const struct rules_state *state, struct rules_outcome *out,
			   int count)
{
	bool for_good = out->foul == 0 &&
			(state->on == ON_CLEARANCE || (state->on == ON_ANY && count_reds(out->ball, count) == 0));
	if (for_good)
		return;
	for (int colour = COLOUR_BLACK; colour >= COLOUR_YELLOW; colour--)
		for (int i = 0; i < count; i++) {
			struct ball *ball = &out->ball[i];
			if (ball->phase != BALL_POTTED || (int)ball->colour != colour)
				continue;
			vec2 pos;
			if (rules_respot(table, out->ball, count, ball->colour, &pos))
				*ball = ball_at(ball->colour, pos);
			else
				out->respot_failed = true;
		}
}

static struct rules_state next_state(const struct rules_state *state, const struct rules_outcome *out, bool potted,
				     int count)
{
	struct rules_state next = rules_state_from_position(out->ball, count);
	next.in_hand = out->cue_potted;
	next.any_first = state->any_first;
	if (state->on == ON_ANY)
		next.on = ON_ANY;
	else if (potted && out->foul == 0) {
		enum rules_on after = rule_table[state->on].after_pot;
		next.on = after == ON_RED && next.on == ON_CLEARANCE ? ON_CLEARANCE : after;
	}
	return next;
}

/* Balls as they lie when all has come to rest. Colours that were off the table before the shot stay off. */
static void end_position(const struct trace *trace, struct rules_outcome *out)
{
	for (int i = 0; i < trace->ball_count; i++)
		out->ball[i] = trace->start[i];
	for (int i = 0; i < trace->count; i++) {
		const struct trace_entry *entry = &trace->entry[i];
		out->ball[entry->event.ball] = entry->after[0];
		if (entry->event.kind == EVENT_BALL_BALL)
			out->ball[entry->event.other] = entry->after[1];
	}
	for (int i = 0; i < trace->ball_count; i++)
		if (out->ball[i].phase != BALL_POTTED)
			out->ball[i] = ball_at(out->ball[i].colour, out->ball[i].pos);
}

void rules_judge(const struct table *table, const struct rules_state *state, const struct trace *trace, int nominated,
		 struct rules_outcome *out)
{
	assert(nominated < trace->ball_count);
	struct facts facts;
	gather(trace, &facts);
	if (nominated < 0 && state->on == ON_COLOUR)
		nominated = facts.first;
	*out = (struct rules_outcome){.cue_potted = facts.cue_potted};
	end_position(trace, out);
	out->foul = penalty(state, &facts, nominated);
	for (int i = 0; i < facts.potted_count && out->foul == 0; i++)
		out->points += value_of(&facts.start[facts.potted[i]]);
	respot_colours(table, state, out, trace->ball_count);
	out->next = next_state(state, out, facts.potted_count > 0, trace->ball_count);
}

bool rules_respot(const struct table *table, const struct ball *ball, int count, enum ball_colour colour, vec2 *pos)
{
	assert(is_colour(colour));
	for (int c = (int)colour; c <= COLOUR_BLACK; c++)
		if (respot_is_free(table, ball, count, table->spot[c])) {
			*pos = table->spot[c];
			return true;
		}
	for (int c = (int)colour - 1; c >= COLOUR_YELLOW; c--)
		if (respot_is_free(table, ball, count, table->spot[c])) {
			*pos = table->spot[c];
			return true;
		}
	return respot_towards_top(table, ball, count, table->spot[colour], pos) ||
	       respot_breadth_first(table, ball, count, table->spot[colour], pos);
}
