/* Which contact law answers for what. Chosen by name, per call; the engine pays only for what is used. */
#ifndef BILLIARD_PHYSICS_MODEL_H
#define BILLIARD_PHYSICS_MODEL_H

#include <stdbool.h>

enum ball_model {
	BALL_MODEL_ELASTIC,	/* frictionless, no loss */
	BALL_MODEL_RESTITUTION, /* frictionless, e_ball */
	BALL_MODEL_THESIS,	/* 2-D elastic with speed loss and topspin variants (thesis 4.6.4.2) */
	BALL_MODEL_FRICTIONAL	/* inelastic, friction falling with slip, throw and spin transfer (Alciatore TP A.14) */
};

enum cushion_model {
	CUSHION_MODEL_MIRROR,	   /* normal velocity reversed, spin untouched */
	CUSHION_MODEL_RESTITUTION, /* the same, times e_cushion */
	CUSHION_MODEL_THESIS,	   /* mirror with speed loss, rolls at once (thesis 4.6.4.3, 4.6.4.9) */
	CUSHION_MODEL_STRONGE,	   /* compliant impact at nose height (Stronge 2000), closed form */
	CUSHION_MODEL_MATHAVAN	   /* impulse integration (Mathavan, Jackson, Parkin 2010) */
};

enum pocket_model {
	POCKET_MODEL_NONE,   /* no pockets, jaws or jaw cushions: the main rails only */
	POCKET_MODEL_CIRCLE, /* centre enters the circle (thesis 4.6.4.8); rounded jaw tips, no sharp ones */
	POCKET_MODEL_JAWS    /* jaw segments and all tips, then the circle */
};

struct model {
	enum ball_model ball;
	enum cushion_model cushion;
	enum pocket_model pocket;
	bool thesis_motion; /* no spin: a struck ball slides, then rolls; a cushion sets it rolling (4.6.4.9) */
	/* SI; the coefficients of two balls' quartic (4.76 to 4.80) are rounded down to multiples of it; 0: exact */
	double contact_grid;
	bool lasting_contacts; /* contacts of balls that lie close overlap in time (cluster.h) */
};

/* The names of all models for people, with commas between: the one list of them. */
const char *model_names(void);

/* "thesis", "simple" (restitution, circle), "simple-elastic", "real" (frictional, Stronge, jaws), "real-mathavan".
 * False when there is none of that name. */
bool model_from_name(const char *name, struct model *model);

#endif
