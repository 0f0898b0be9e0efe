/* The virtual table's truth and its player: where the balls really are, a shot that runs, what it came to. Knows no bus
 * and no clock: time comes as an argument (s, any epoch, never backwards). Same seed and shots, same balls, bit for
 * bit. */
#ifndef BILLIARD_APP_PLAYER_H
#define BILLIARD_APP_PLAYER_H

#include "app/config/config.h"
#include "physics/sim.h"
#include "search/rules.h"

enum { PLAYER_EVENTS_MAX = 4096 };

/* What a shot came to. */
struct player_result {
	struct shot played; /* with the player's error */
	int first;	    /* ball that the cue ball touched first, -1 none */
	struct {
		int ball, pocket;
	} potted[BALL_MAX]; /* in the order in which they fell, cue ball included */
	int potted_count;
	int points, foul;
	bool cue_potted, respot_failed;
	double duration; /* s of the table's time from strike until no ball goes on; one may still turn on the spot */
};

/* About 1 MB: not for the stack. */
struct virtual_table {
	const struct table *table; /* borrowed */
	struct table own;	   /* another table than the planner believes in, when the configuration says so */
	struct model model;
	double error_angle, error_speed; /* 1 sigma: rad, share */
	double time_scale;		 /* table's time to real time */
	uint64_t seed;
	struct ball ball[BALL_MAX]; /* at rest: before the running shot, or after the last one */
	int count;
	struct rules_state state;
	int64_t shots; /* played */
	bool running;
	double started;		      /* s, caller's clock */
	struct player_result result;  /* of the running or last shot; points and foul only at its end */
	double place_time;	      /* s for a ball that a hand puts down, 0: it is there at once */
	struct ball placed[BALL_MAX]; /* as they will be put down, in this order */
	int placing[BALL_MAX];	      /* which balls those are */
	int placing_count;
	double place_since; /* s, when the hand took the first of them */
	struct sim sim;
	struct trace trace;
	struct trace_entry entry[PLAYER_EVENTS_MAX];
};

/* The opening position of snooker: cue ball in the D, 15 reds behind the pink. The order: white, reds, yellow to black.
 */
void player_rack(const struct table *table, struct ball ball[BALL_MAX]);

/* table is borrowed; the balls are copied and must be acceptable to table_check_balls() (asserted). rules: play by the
 * rules of snooker, else every ball is on. */
void player_init(struct virtual_table *vt, const struct table *table, const struct model *model,
		 const struct config_virtual *def, bool rules, const struct ball *ball, int count);

/* Plays the shot with the player's error from now on. 0; -EBUSY while balls move, -EINVAL when the shot is out of range
 * or there is no cue ball, with the reason; nothing has changed then. */
int player_play(struct virtual_table *vt, const struct shot *shot, double now, char *err, size_t err_size);

/* Ends a shot whose time is over: colours come back by the rules, a potted cue ball is put into the D. True once per
 * shot, when it does. */
bool player_tick(struct virtual_table *vt, double now);

/* Where the balls are at that time: vt->count of them. */
void player_balls(const struct virtual_table *vt, double now, struct ball out[BALL_MAX]);

/* Puts down the balls that come back, one after the other, place_time each. True while there is one; *where: its place. */
bool player_place(struct virtual_table *vt, double now, vec2 *where);

/* A hand moves a ball that rests to a place that is free. */
void player_touch(struct virtual_table *vt, int ball, vec2 to);

/* A position as in the middle of a frame: white, 1 to 10 reds and the colours on their spots, some of them elsewhere. Returns the number of
 * balls. */
int player_scatter(const struct table *table, uint64_t seed, struct ball ball[BALL_MAX]);

/* No object ball is left. */
bool player_is_done(const struct virtual_table *vt);

#endif
