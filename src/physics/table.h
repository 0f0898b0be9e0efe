/* The table: geometry and material constants. Read-only once table_finish() has accepted it, and then shared by all
 * threads. No table is built into the code: the application fills one from config/. */
#ifndef BILLIARD_PHYSICS_TABLE_H
#define BILLIARD_PHYSICS_TABLE_H

#include <stddef.h>
#include <stdint.h>

#include "physics/ball.h"

enum { CUSHION_MAX = 32, JAW_MAX = 32, POCKET_MAX = 6, SPOT_COUNT = 8 };

/* One straight cushion: the nose line from a to b. Balls are on the side of normal. */
struct cushion {
	vec2 a, b;	    /* m, ends of the nose line */
	vec2 normal;	    /* unit, towards the side of the bed's centre; computed by table_finish() */
	vec2 along;	    /* unit, from a to b; computed by table_finish() */
	double span;	    /* m, distance of a and b; computed by table_finish() */
	double nose_height; /* m above the bed */
	bool two_sided;	    /* a ball may touch it from either side */
	bool open_ends;	    /* no sharp tips are added where no jaw covers its ends */
	bool main_rail;	    /* one of the six long noses (mirrors of the search); false: a pocket's jaw */
	double e, mu;	    /* restitution and friction of this one; 0: the material's */
};

/* A rounded jaw tip: a vertical cylinder that balls bounce off from outside. Radius 0 is a sharp tip. */
struct jaw {
	vec2 centre;	    /* m */
	double radius;	    /* m, >= 0 */
	double nose_height; /* m above the bed */
};

/* A pocket takes a ball whose centre comes within radius of centre. */
struct pocket {
	vec2 centre;   /* m */
	double radius; /* m, > 0 */
	vec2 normal;   /* unit, into the bed; the search's angle cost uses it */
	char name[16]; /* "BOTTOM-LEFT", ... */
};

/* The neighbourhood of a pocket: a ball whose centre stays outside the box touches none of the jaws, jaw cushions and
 * pockets in the masks (bit i: index i). Computed by table_finish(). */
struct table_region {
	vec2 low, high; /* m */
	uint32_t cushions, jaws, pockets;
};

/* The bed's height over its middle: slope.x x + slope.y y + (bowl[0] x^2 + 2 bowl[1] x y + bowl[2] y^2) / 2. All 0: level,
 * and then motion has closed forms. */
struct bed {
	vec2 slope;	   /* rise per way at the middle, along x and y */
	double bowl[3];	   /* 1/m, change of slope per way: xx, xy, yy */
	double path_error; /* m, of a path between the ends of its pieces (bed.h); 0: PATH_ERROR */
	bool uneven;	   /* computed by table_finish() */
};

/* Material and contact constants. Every model reads only its own. */
struct material {
	double gravity;	 /* m/s^2 */
	double mu_slide; /* cloth, sliding */
	double mu_roll;	 /* cloth, rolling resistance: deceleration mu_roll g */
	double mu_spin;	 /* m: vertical spin decays by 5 mu_spin g / (2 r^2) rad/s^2; pooltool's u_sp times r */

	/* model "thesis" */
	double loss_ball;      /* share of the speed lost at a ball contact, 4.43 */
	double loss_cushion;   /* share of the speed lost at a cushion, 4.63 */
	int topspin_variant;   /* 0 none, 1 (4.56 to 4.59), 2 (4.60, 4.61) */
	double topspin_factor; /* A: m/s for variant 1, share for variant 2 */

	/* models "simple" and "real" */
	double ball_fall;  /* s/m: restitution at approach speed v is e_ball / (1 + ball_fall v); 0: the same at all */
	double e_ball;	   /* restitution ball on ball */
	double e_cushion;  /* restitution at a cushion */
	double mu_cushion; /* friction at a cushion */
	double cushion_fall; /* s/m: restitution at approach speed v is e / (1 + cushion_fall v); 0: the same at all */
	double cue_end_mass; /* kg that the cue's end moves aside with: squirt; 0: none */
	double mu_ball_a, mu_ball_b, mu_ball_c; /* mu = a + b exp(-c v), v slip in m/s: Alciatore TP A.14 */
	double stronge_omega;			/* frequency ratio of Stronge's compliant impact */
	double hertz_modulus;			/* Pa, E / (1 - nu^2) of the balls; 0: contacts take no time */
};

/* Where a ball touches a cushion, a jaw or a tip, and what that is made of. */
struct nose {
	vec2 normal;   /* unit, from the nose towards the ball */
	double height; /* m above the bed */
	double e, mu;  /* restitution at a slow approach, friction */
};

struct table {
	double length, width; /* m, inner size along x and y */
	double ball_radius;   /* m */
	double ball_mass;     /* kg */
	struct bed bed;
	struct cushion cushion[CUSHION_MAX];
	int cushion_count;
	struct jaw jaw[JAW_MAX];
	int jaw_count;
	struct pocket pocket[POCKET_MAX];
	int pocket_count;
	struct table_region region[POCKET_MAX];
	int region_count;
	vec2 spot[SPOT_COUNT]; /* m; by colour; [COLOUR_WHITE] and [COLOUR_RED] are unused */
	vec2 baulk_d_centre;   /* m; middle of the D (brown spot) */
	double baulk_d_radius; /* m */
	struct material material;
};

/* Checks ranges, computes normals and regions, and adds a sharp tip (a jaw of radius 0) to each end of a cushion that
 * no jaw covers, so that no ball slips through a corner. May be called again. Returns 0, or -EINVAL with the reason in
 * err. */
int table_finish(struct table *table, char *err, size_t err_size);

/* A nose of the table's material. */
struct nose table_nose(const struct table *table, vec2 normal, double height);

/* Restitution of a nose at an approach speed (m/s, at least 0). */
double nose_restitution(const struct table *table, const struct nose *nose, double speed);

/* Restitution of two balls at an approach speed (m/s, at least 0). */
double ball_restitution(const struct material *material, double speed);

/* Pocket of that name, -1 when there is none. */
int table_pocket(const struct table *table, const char *name);

/* Checks a position: finite, each centre on the bed or in the mouth of a pocket (between its jaws, not in its circle),
 * no two balls overlapping by more than 1e-4 m (what a camera cannot resolve is the caller's to separate). Returns 0, or
 * -EINVAL; *first and *second name the culprits (second -1 if only one). */
int table_check_balls(const struct table *table, const struct ball *ball, int count, int *first, int *second, char *err,
		      size_t err_size);

#endif
