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

/* m between balls that touch; m that the cue ball has moved at the most when it is pushed into one. */
static const double TOUCHING = 1e-5, PUSHED = 1e-3;
/* s between contacts that are one blow. */
static const double AT_ONCE = 1e-9;

static bool is_by_thesis(const struct rules_state *state)
{
	return state->any_first || state->on == ON_ANY;
}

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
	if (state->on == ON_ANY || state->free_ball)
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
	int count, cue;
	int first, second;		    /* balls that the cue ball meets first; second: at once with it, -1 */
	int touching;			    /* the ball that it touched before, the one on if there is one; -1 */
	bool pushed;			    /* it was played into a ball that it touched */
	int potted[BALL_MAX], potted_count; /* object balls */
	bool cue_potted;
};

/* The ball that the cue ball meets in an event; -1 none. */
static int met(const struct event *event, int cue)
{
	if (event->kind != EVENT_BALL_BALL || (event->ball != cue && event->other != cue))
		return -1;
	return event->ball == cue ? event->other : event->ball;
}

static bool touches(const struct facts *facts, double radius, int index)
{
	const struct ball *ball = &facts->start[index];
	return index != facts->cue && ball->phase != BALL_POTTED && facts->cue >= 0 &&
	       vec2_dist(ball->pos, facts->start[facts->cue].pos) <= 2 * radius + TOUCHING;
}

static void gather_contacts(const struct trace *trace, struct facts *facts)
{
	double first_time = 0;
	for (int i = 0; i < trace->count; i++) {
		const struct trace_entry *entry = &trace->entry[i];
		int ball = met(&entry->event, facts->cue);
		if (ball < 0)
			continue;
		if (facts->first < 0) {
			facts->first = ball;
			first_time = entry->event.time;
			vec2 at = entry->after[entry->event.ball != facts->cue].pos;
			facts->pushed = touches(facts, trace->table->ball_radius, ball) &&
					vec2_dist(at, facts->start[facts->cue].pos) < PUSHED;
		} else if (facts->second < 0 && ball != facts->first && entry->event.time - first_time < AT_ONCE) {
			facts->second = ball;
		}
	}
}

static void gather(const struct rules_state *state, const struct trace *trace, struct facts *facts)
{
	*facts = (struct facts){.start = trace->start,
				.count = trace->ball_count,
				.cue = -1,
				.first = -1,
				.second = -1,
				.touching = -1};
	for (int i = 0; i < facts->count; i++)
		if (facts->start[i].colour == COLOUR_WHITE)
			facts->cue = i;
	if (facts->cue >= 0)
		gather_contacts(trace, facts);
	for (int i = 0; i < facts->count; i++)
		if (touches(facts, trace->table->ball_radius, i) &&
		    (facts->touching < 0 || rules_ball_on(state, facts->start, facts->count, i)))
			facts->touching = i;
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

/* The state without the free ball: what is on by right. */
static bool is_on_by_right(const struct rules_state *state, const struct facts *facts, int index)
{
	struct rules_state plain = *state;
	plain.free_ball = false;
	return rules_ball_on(&plain, facts->start, facts->count, index);
}

static bool is_named_free(const struct rules_state *state, const struct facts *facts, int nominated)
{
	return state->free_ball && nominated >= 0 && !is_on_by_right(state, facts, nominated);
}

/* True when ball index may be struck first: on, and the one that was named where one has to be. */
static bool may_be_struck(const struct rules_state *state, const struct facts *facts, int nominated, int index)
{
	if (!rules_ball_on(state, facts->start, facts->count, index))
		return false;
	if (state->free_ball && nominated >= 0)
		return is_named_free(state, facts, nominated) ? index == nominated
							      : is_on_by_right(state, facts, index);
	return state->on != ON_COLOUR || nominated < 0 || index == nominated;
}

/* True when ball index may fall. With a free ball the balls on may fall, too. */
static bool may_fall(const struct rules_state *state, const struct facts *facts, int nominated, int index)
{
	if (state->free_ball && is_on_by_right(state, facts, index))
		return true;
	return may_be_struck(state, facts, nominated, index);
}

/* Value of the ball on: what a miss costs if it is more than the least foul, and what a free ball scores. */
static int value_on(const struct rules_state *state, const struct facts *facts, int nominated)
{
	if (state->on == ON_RED)
		return 1;
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

/* The first blow: nothing struck, or a ball not on, or two at once that may not be; a push. */
static int contact_penalty(const struct rules_state *state, const struct facts *facts, int nominated, int least)
{
	if (facts->pushed && !is_by_thesis(state))
		return larger(least, value_of(&facts->start[facts->first]));
	bool deemed =
		!is_by_thesis(state) && facts->touching >= 0 && may_be_struck(state, facts, nominated, facts->touching);
	if (deemed || (facts->first >= 0 && state->any_first))
		return 0;
	if (facts->first < 0)
		return least;
	int foul = 0, struck[2] = {facts->first, is_by_thesis(state) ? -1 : facts->second};
	for (int i = 0; i < 2; i++)
		if (struck[i] >= 0 && !may_be_struck(state, facts, nominated, struck[i]) &&
		    !(i == 1 && may_fall(state, facts, nominated, struck[i])))
			foul = larger(foul, larger(least, value_of(&facts->start[struck[i]])));
	return foul;
}

/* Penalty of the shot, 0 when it is legal: the highest of all that is wrong with it. Touching a cushion first is legal.
 */
static int penalty(const struct rules_state *state, const struct facts *facts, int nominated)
{
	int least = larger(rule_table[state->on].least_foul, value_on(state, facts, nominated));
	int foul = contact_penalty(state, facts, nominated, least);
	if (facts->cue_potted)
		foul = larger(foul, least);
	for (int i = 0; i < facts->potted_count; i++)
		if (!may_fall(state, facts, nominated, facts->potted[i]))
			foul = larger(foul, larger(least, value_of(&facts->start[facts->potted[i]])));
	return foul;
}

/* Points of a legal shot. */
static int points(const struct rules_state *state, const struct facts *facts, int nominated)
{
	int sum = 0;
	for (int i = 0; i < facts->potted_count; i++) {
		int ball = facts->potted[i];
		bool as_on = state->free_ball && !is_on_by_right(state, facts, ball);
		/* the free ball and the ball on count once where there is but one ball on */
		if (as_on && state->on == ON_CLEARANCE && facts->potted_count > 1)
			continue;
		sum += as_on ? value_on(state, facts, nominated) : value_of(&facts->start[ball]);
	}
	return sum;
}

/* Potted colours stay off only when the clearance has taken them. */
static bool is_for_good(const struct rules_state *state, const struct facts *facts, const struct rules_outcome *out,
			int index)
{
	if (out->foul != 0)
		return false;
	if (state->on == ON_ANY)
		return count_reds(out->ball, facts->count) == 0;
	return state->on == ON_CLEARANCE && is_on_by_right(state, facts, index);
}

/* Puts colours that fell in this shot back, the most valuable first. */
static void respot_colours(const struct table *table, const struct rules_state *state, const struct facts *facts,
			   struct rules_outcome *out)
{
	for (int colour = COLOUR_BLACK; colour >= COLOUR_YELLOW; colour--)
		for (int i = 0; i < facts->count; i++) {
			struct ball *ball = &out->ball[i];
			bool fell = ball->phase == BALL_POTTED && facts->start[i].phase != BALL_POTTED;
			if (!fell || (int)ball->colour != colour || is_for_good(state, facts, out, i))
				continue;
			vec2 pos;
			bool placed = is_by_thesis(state)
					      ? rules_respot_thesis(table, out->ball, facts->count, ball->colour, &pos)
					      : rules_respot(table, out->ball, facts->count, ball->colour, &pos);
			if (placed)
				*ball = ball_at(ball->colour, pos);
			else
				out->respot_failed = true;
		}
}

/* Only the black is left and has been potted or fouled. */
static bool ends_frame(const struct rules_state *state, const struct facts *facts, const struct rules_outcome *out)
{
	return state->on == ON_CLEARANCE && lowest_colour(facts->start, facts->count) == COLOUR_BLACK &&
	       (out->foul > 0 || out->points > 0);
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
	gather(state, trace, &facts);
	bool named = nominated >= 0;
	if (!named && (state->on == ON_COLOUR || state->free_ball))
		nominated = facts.first;
	*out = (struct rules_outcome){.cue_potted = facts.cue_potted};
	end_position(trace, out);
	out->foul = penalty(state, &facts, nominated);
	if (out->foul > 0 && !named && state->on == ON_COLOUR && !is_by_thesis(state))
		out->foul = COLOUR_BLACK; /* a foul before a colour was named */
	if (out->foul == 0)
		out->points = points(state, &facts, nominated);
	respot_colours(table, state, &facts, out);
	out->ends = ends_frame(state, &facts, out);
	out->next = next_state(state, out, facts.potted_count > 0, trace->ball_count);
}

struct rules_state rules_opponent(const struct table *table, const struct rules_outcome *out, int count)
{
	struct rules_state state = rules_state_from_position(out->ball, count);
	state.in_hand = out->cue_potted;
	state.free_ball = out->foul > 0 && rules_is_snookered(table, &state, out->ball, count);
	return state;
}

struct rules_state rules_respot_black(const struct table *table, struct ball *ball, int count)
{
	for (int i = 0; i < count; i++)
		if (ball[i].colour == COLOUR_BLACK)
			ball[i] = ball_at(COLOUR_BLACK, table->spot[COLOUR_BLACK]);
	return (struct rules_state){.on = ON_CLEARANCE, .in_hand = true};
}

static bool highest_free_spot(const struct table *table, const struct ball *ball, int count, vec2 *pos)
{
	for (int c = COLOUR_BLACK; c >= COLOUR_YELLOW; c--)
		if (respot_is_free(table, ball, count, table->spot[c])) {
			*pos = table->spot[c];
			return true;
		}
	return false;
}

bool rules_respot(const struct table *table, const struct ball *ball, int count, enum ball_colour colour, vec2 *pos)
{
	assert(is_colour(colour));
	vec2 spot = table->spot[colour];
	*pos = spot;
	return respot_is_free(table, ball, count, spot) || highest_free_spot(table, ball, count, pos) ||
	       respot_towards_top(table, ball, count, spot, pos) ||
	       respot_towards_bottom(table, ball, count, spot, pos) ||
	       respot_breadth_first(table, ball, count, spot, pos);
}

bool rules_respot_thesis(const struct table *table, const struct ball *ball, int count, enum ball_colour colour,
			 vec2 *pos)
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
