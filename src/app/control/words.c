#include "app/control/words.h"

#include <stdio.h>

#include "app/process/text.h"
#include "vision/vision.h"

static void say(char out[WORDS_SIZE], const char *text)
{
	snprintf(out, WORDS_SIZE, "%s", text);
}

void words_of_ball(char out[WORDS_SIZE], const struct ball *ball, const char *what)
{
	snprintf(out, WORDS_SIZE, "%s at (%.0f, %.0f): %s", ball_colour_name(ball->colour), 1e3 * ball->pos.x,
		 1e3 * ball->pos.y, what);
}

static void say_what_is_not_clear(char out[WORDS_SIZE], const struct layout *layout, const struct stability_view *view,
				  const billiard_vision_doubt_t *doubt)
{
	if (view->occluded)
		say(out, "something is over the table");
	else if (view->doubted < 0)
		say(out, "looking again");
	else if (doubt->ball_doubt[view->doubted] & DOUBT_HIDDEN)
		words_of_ball(out, &layout->ball[view->doubted], "hidden");
	else if (doubt->ball_doubt[view->doubted] & DOUBT_PLACE)
		words_of_ball(out, &layout->ball[view->doubted], "not seen clearly");
	else
		words_of_ball(out, &layout->ball[view->doubted], "which colour?");
}

void words_of_obstacle(char out[WORDS_SIZE], const struct stability *s, const struct layout *layout,
		       const struct stability_view *view, const billiard_vision_doubt_t *doubt)
{
	enum stability_condition obstacle = stability_obstacle(s);
	int ball = obstacle < STABILITY_ALL ? s->result[obstacle].ball : -1;
	switch (obstacle) {
	case STABILITY_CUE:
		say(out, view->occluded ? "something is over the table" : "which white ball is the cue ball?");
		break;
	case STABILITY_STILL:
		if (ball >= 0)
			words_of_ball(out, &layout->ball[ball], "moves");
		else
			say(out, "waiting for rest");
		break;
	case STABILITY_KEPT:
		say(out, "a ball comes and goes");
		break;
	case STABILITY_NONE_NEW:
		say(out, "a ball comes and goes");
		break;
	case STABILITY_CLEAR:
		say_what_is_not_clear(out, layout, view, doubt);
		break;
	case STABILITY_ALL:
	case STABILITY_CONDITIONS:
		break;
	}
}

void words_of_blindness(char out[WORDS_SIZE], const billiard_table_state_t *state)
{
	char reason[sizeof state->reason];
	text_get(reason, sizeof reason, state->reason, sizeof state->reason);
	if (state->calibration != 0)
		say(out, "no cue ball");
	else
		snprintf(out, WORDS_SIZE, "not calibrated: %.70s", reason);
}

void words_report(billiard_stability_condition_t out[STABILITY_CONDITIONS], const struct stability *s,
		  const struct layout *layout)
{
	for (int i = 0; i < STABILITY_CONDITIONS; i++) {
		const struct stability_result *from = &s->result[i];
		const struct layout *of = i == STABILITY_KEPT ? &s->anchor : layout;
		out[i] = (billiard_stability_condition_t){
			.holds = from->holds,
			.value = from->value,
			.limit = from->limit,
			.held = from->held,
			.needed = from->needed,
			.track = from->ball >= 0 && from->ball < of->count ? of->track[from->ball] : 0,
		};
	}
}
