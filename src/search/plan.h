/* From a position to ranked proposals: candidate search backwards from the pockets, start speed, simulation, cost,
 * several shots deep (thesis 4.6). Knows no bus, file or clock of its own. */
#ifndef BILLIARD_SEARCH_PLAN_H
#define BILLIARD_SEARCH_PLAN_H

#include "physics/sim.h"
#include "search/player_error.h"
#include "search/rules.h"
#include "search/scheme.h"

enum {
	PLAN_MAX = 1024,
	PLAN_SHOTS_MAX = 4,
	PLAN_CHAIN_MAX = 4,
	PLAN_RAILS_MAX = 3,
	PLAN_POTTED_MAX = 8,
	PLAN_WORKERS_MAX = 16
};

/* What decides which proposal comes first. */
enum plan_ranking {
	RANK_THESIS,  /* the cost of 4.104, sequences of depth shots */
	RANK_SUCCESS, /* the chance that all shots of a sequence succeed */
	RANK_VALUE    /* expected points of the visit less what the opponent may expect (search/value.h); one shot */
};
/* "thesis", "success", "value"; never NULL. */
bool plan_ranking_from_name(const char *name, enum plan_ranking *ranking);

/* A player profile (thesis O-6): weights and constants of the cost, by name of the term. Filled from config/. */
struct cost_profile {
	char name[16];				      /* "thesis", "beginner", "professional" */
	double w_distance, w_angle, w_balls, w_rails; /* weights of 4.20-4.32; 0 switches a term off */
	double ball_cost, rail_cost; /* per ball struck, per cushion: 1/2 and 2/3 in the thesis' program */
	double w_points, w_speed;    /* weights of 4.103, both 0.5 */
	double w_simulation;	     /* g of 4.104 */
	double max_cut;		     /* rad, 87 degrees */
	double max_speed;	     /* m/s, V_max of 4.102 and the limit of a start speed */
	double pocket_speed;	     /* m/s, least speed at the pocket */
	double speed_step;	     /* m/s between the tried start speeds */
	double clearance;	     /* m over the diameter along a ball's way */
	double cue_clearance;	     /* m beyond the radius beside the cue */
	double cue_room;	     /* m behind the cue ball */
	struct player_error error;   /* how this player errs */
	int aims; /* 1: the middle of a pocket; 3, 5, ...: points across it too, for what the middle does not give */
	enum plan_ranking ranking;
	bool program_speed; /* start speeds by 4.33 for every leg, as the thesis' program; false: both branches */
	bool any_first;	  /* do not ask which ball is struck first, as that program; false: by the rules. Requests with
			       TARGET_RULES are by the rules in any case, unless their state says any_first, too */
	bool keep_flukes; /* keep legal pots that are not the intended one, named by what falls, as that program does */
};
/* The constants of the thesis' program (errata.md, last tables). */
struct cost_profile cost_profile_thesis(void);

enum plan_target_kind { TARGET_ANY, TARGET_RULES, TARGET_COLOUR, TARGET_BALL };

struct plan_budget {
	uint64_t nodes; /* expansions and simulations; repeatable; 0 none */
	double seconds; /* live; 0 none; needs def.now */
};

struct plan_request {
	struct ball ball[BALL_MAX]; /* exactly one white, on the table unless state.in_hand; all at rest or potted */
	int ball_count;
	struct rules_state state; /* used for TARGET_RULES and for the shots after the first */
	enum plan_target_kind target;
	enum ball_colour target_colour;
	int target_ball;
	int depth;	/* shots, 1..PLAN_SHOTS_MAX */
	int rails;	/* cushions a leg at most, 0..PLAN_RAILS_MAX */
	int balls;	/* balls in a chain at most, 1..PLAN_CHAIN_MAX - 1 (1 = direct) */
	int speeds;	/* start speeds tried, >= 1 */
	int plans;	/* wanted, 1..PLAN_MAX */
	int tolerances; /* of so many of the best plans tolerance and success are found, 0..PLAN_MAX; costs some 40
			   simulations a shot */
	struct plan_budget budget;
	bool has_error; /* error holds, not the profile's */
	struct player_error error;
	uint64_t run; /* number by which planner_cancel() names this run, the caller's, rising from 1; 0: none can */
};
/* Direct and via one ball, no cushions, one shot, one speed, 10 plans, tolerance of one, no budget. */
struct plan_request plan_request_default(void);

/* What speaks for a shot that was ranked by value. */
enum plan_why {
	WHY_UNKNOWN,  /* ranked otherwise */
	WHY_POT,      /* the best pot; what follows is open */
	WHY_POSITION, /* a pot that leaves one at why_ball */
	WHY_LAST,     /* the last ball */
	WHY_NO_POT,   /* safety: the opponent has no pot */
	WHY_SNOOKER,  /* safety: the opponent is snookered */
	WHY_LEAST,    /* safety: leaves the opponent as little as can be */
	WHY_ESCAPE,   /* from a snooker to a ball on */
	WHY_FOUL      /* nothing legal was found */
};

struct plan_shot {
	struct shot shot;
	struct ball start[BALL_MAX];   /* the position it is played from */
	int16_t target;		       /* ball meant to fall, -1: safety, only a contact */
	int16_t pocket;		       /* pocket meant, -1 */
	int16_t chain[PLAN_CHAIN_MAX]; /* cue ball first, ..., target last */
	int chain_count;
	int rails; /* cushions over all legs */
	struct {
		int16_t ball, pocket;
	} potted[PLAN_POTTED_MAX]; /* all that fall in the simulation, in order */
	int potted_count;
	int points, foul;
	double search_cost, cost; /* K_s; K_s + 4.104 */
	double tolerance_angle,
		tolerance_speed; /* rad, share: half-width within which the pot still falls; 0 unknown */
	double success;		 /* probability for the profile's spread, 0..1; NAN unknown */
	double value;		 /* points of the visit less what the opponent may expect; NAN unknown */
	vec2 leave;		 /* m, where the cue ball is meant to come to rest */
	double leave_radius;	 /* m, half of the samples end within it; NAN: leave is unknown */
	enum plan_why why;
	int16_t why_ball; /* WHY_POSITION: the next ball; else -1 */
	uint64_t hash;	  /* sim_hash at rest */
};

struct plan {
	struct plan_shot shot[PLAN_SHOTS_MAX];
	int shot_count;
	double cost; /* sum over the shots */
};

enum plan_status { PLAN_OK, PLAN_NONE, PLAN_CANCELLED };

struct plan_result {
	enum plan_status status;
	int plan_count;	   /* best first */
	int found;	   /* plan_count, and what the limits of the definition left out */
	struct plan *plan; /* owned by the planner, valid until its next run */
	uint64_t nodes, sims;
	uint64_t tried, landed, refined; /* shots simulated at the mirror's aim; those that did as meant; those that did
					    after their aim was refined */
	bool exhausted;			 /* nothing left to expand */
};

/* What a planner is made of; all memory is taken at create. */
struct planner_def {
	const struct table *table; /* borrowed */
	struct model model;
	struct cost_profile profile;
	int workers; /* 1..PLAN_WORKERS_MAX; SCHEME_BATCH: the caller's thread is one of them, else it manages */
	enum plan_scheme scheme; /* default SCHEME_BATCH */
	double sync_period,
		sync_window; /* s, k and n of thesis 4.7, for SCHEME_WINDOWS; needs (workers + 1) n <= k and def.now */
	int progress_plans;  /* at most so many plans are filled in for plan_progress_fn and when cancelled; 0: all */
	int result_plans;    /* the same for what planner_run returns */
	size_t memory;	     /* bytes for nodes, default 32 MB; schemes with queues of their own take as much again */
	double (*now)(void *context); /* s, monotonic, for budget.seconds; NULL: time budgets are refused */
	void *now_context;
};
struct planner_def planner_def_default(void);

struct planner;
/* 0, -EINVAL (also for a profile with a value that no player can have: aims 1..9, max_cut up to 90 degrees, speeds above
 * 0 and up to SHOT_SPEED_MAX, the rest not negative) or -ENOMEM; *out is NULL on failure. Caller destroys. */
int planner_create(struct planner **out, const struct planner_def *def);
void planner_destroy(struct planner *planner); /* NULL is fine */

/* Checks a request at the border. 0, or -EINVAL with the reason (naming the ball or field). */
int plan_request_check(const struct table *table, const struct plan_request *request, char *err, size_t err_size);

/* Called on each improvement of the best plan, in the running thread; result as planner_run would give it now. May be
 * NULL. */
typedef void plan_progress_fn(void *context, const struct plan_result *result);

/* 0, or -EINVAL (request not acceptable, reason in err), -ECANCELED (best so far is in result). Same request, same
 * result, bit for bit, at any number of workers unless budget.seconds cut it short; but nodes and sims without a node
 * budget only in SCHEME_BATCH. Allocates nothing. */
int planner_run(struct planner *planner, const struct plan_request *request, plan_progress_fn *progress, void *context,
		struct plan_result *result, char *err, size_t err_size);

/* From any thread. */
void planner_figures(const struct planner *planner, struct plan_figures *out);

/* From any thread: runs of requests numbered 1 to run end soon with -ECANCELED, whether they run by now or are still to
 * begin: a cancel given between the request and its run is not lost, and one that comes late ends no later run. */
void planner_cancel(struct planner *planner, uint64_t run);

/* One sentence for people, without full stop: "pot with position for the black". "" when it is unknown. Into text. */
const char *plan_why_text(const struct plan_shot *shot, char *text, size_t size);

/* Plays one planned shot again from its own start: fills trace, true when the same balls fall in the same pockets and
 * the hash is equal. */
bool plan_shot_replay(const struct table *table, const struct model *model, const struct plan_shot *shot,
		      int ball_count, struct trace *trace);

#endif
