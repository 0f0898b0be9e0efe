/* Judges a run of the whole system: what was believed, asked for and drawn, against what the virtual table says of itself
 * (TRUTH). Fed with checked messages in the order in which they came; now: us, when they came. Knows no bus, no file and no
 * clock; same messages, same report. */
#ifndef BILLIARD_APP_JUDGE_H
#define BILLIARD_APP_JUDGE_H

#include <stddef.h>

#include "app/light/lease.h"
#include "app/virtual/judge_match.h"
#include "lcmtypes/billiard_draw_list_t.h"
#include "lcmtypes/billiard_plan_request_t.h"
#include "lcmtypes/billiard_plan_t.h"
#include "lcmtypes/billiard_status_t.h"
#include "lcmtypes/billiard_table_state_t.h"

enum {
	JUDGE_TRUTHS = 256,   /* remembered, to find the one of a frame */
	JUDGE_REQUESTS = 16,  /* remembered */
	JUDGE_MS_MAX = 60000, /* times above count as this, ms */
	JUDGE_TEXT_SIZE = 240
};

/* Why a proposal is wrong: the first that holds. */
enum judge_cause {
	JUDGE_DOUBLE,  /* a ball was seen twice */
	JUDGE_GHOST,   /* a ball was asked for that is not there */
	JUDGE_MISSING, /* a ball was left out */
	JUDGE_COLOUR,  /* a ball has another colour */
	JUDGE_PLACE,   /* a ball lies more than 5 mm elsewhere */
	JUDGE_CAUSE_COUNT
};
/* "double", "ghost", ...; never NULL. */
const char *judge_cause_name(enum judge_cause cause);

/* Times of a run: their number in each millisecond. */
struct judge_times {
	int64_t bin[JUDGE_MS_MAX + 1], count;
	double max; /* ms */
};
/* ms below which that share of them lies, to the millisecond; 0 when there is none. */
double judge_times_share(const struct judge_times *times, double share);

struct judge_report {
	int64_t shots, rests, requests, repeated; /* repeated: the same request sent again */
	int64_t wrong, wrong_by[JUDGE_CAUSE_COUNT];
	int64_t more_than_one_request;
	int64_t without_request; /* rests of more than 5 s */
	int64_t changed_after_drawn;
	int64_t ball_on_wrong, in_hand_wrong, asked_by_rules;
	int64_t proposed_pots, made;
	int64_t frames, frames_wrong; /* TABLE_STATE of a table that rested for a second */
	struct judge_times rest_to_drawn, stale_light;
};

/* A proposal as far as it tells one first shot from another. */
struct judge_shot {
	int64_t request; /* 0: none */
	double angle, speed;
	int target, pocket;
};

struct judge_asked {
	int64_t id;
	struct judge_position position;
	struct judge_shot best;	 /* first shot of the newest answer */
	struct judge_shot drawn; /* as it was when it was first drawn */
	int target_track;	 /* real ball meant to fall, 0 none */
};

/* About 1 MB: not for the stack. */
struct judge {
	double ball_radius; /* m */
	struct judge_report report;
	struct {
		int64_t utime;
		struct judge_position position;
		bool moving;
	} truth[JUDGE_TRUTHS]; /* a ring; the newest is truth[truths % JUDGE_TRUTHS] */
	int64_t truths;
	/* The present rest. */
	struct judge_position rest;
	int64_t rest_begin;
	bool at_rest, rest_drawn, rest_changed, rest_told;
	int rest_requests;
	/* The game: what the virtual table says, else as far as what fell tells it. */
	bool cue_fell;
	int on;			      /* enum rules_on */
	struct judge_position before; /* when the shot began */
	uint32_t fallen;	      /* balls of before that are gone, by bit */
	/* Requests and light. */
	struct judge_asked asked[JUDGE_REQUESTS]; /* a ring */
	int64_t asked_count;
	billiard_draw_list_t light;
	struct lease lease; /* of light: whoever shows it blanks it then */
	bool is_stale;
	int64_t stale_since;
	int stale_target; /* ball that the struck proposal meant, 0 none */
	char finding[JUDGE_TEXT_SIZE];
};

void judge_init(struct judge *judge, double ball_radius);
/* TRUTH, STATUS, TABLE_STATE, PLAN_REQUEST, PLAN, DRAW. */
void judge_truth(struct judge *judge, int64_t now, const billiard_table_state_t *truth);
/* The virtual table's own word on the ball on; other processes' are ignored. */
void judge_status(struct judge *judge, const billiard_status_t *status);
void judge_state(struct judge *judge, const billiard_table_state_t *state);
void judge_request(struct judge *judge, int64_t now, const billiard_plan_request_t *request);
void judge_plan(struct judge *judge, const billiard_plan_t *plan);
void judge_draw(struct judge *judge, int64_t now, const billiard_draw_list_t *list);
void judge_lease(struct judge *judge, int64_t now, const billiard_lease_t *lease);
/* The end of the run: closes what is open. */
void judge_finish(struct judge *judge, int64_t now);
/* What was found wrong since the last call, for people: "place: RED ..."; false when nothing was. */
bool judge_finding(struct judge *judge, char *out, size_t size);

#endif
