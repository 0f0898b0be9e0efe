/* One ball, to a fraction of a pixel: the sphere's exact outline laid onto the edges of the frame. */
#ifndef BILLIARD_VISION_FIT_H
#define BILLIARD_VISION_FIT_H

#include "vision/image.h"
#include "vision/outline.h"

struct fit {
	vec2 pos;	       /* m */
	double scale;	       /* apparent radius over the true one */
	double expected_scale; /* what scale is pulled towards ... */
	double scale_spread;   /* ... when the rim leaves it open; 1 sigma, > 0 */
	float cloth[3];	       /* BGR of the cloth around it */
	/* of the last look: */
	struct outline outline;
	int rays;	    /* that no neighbour hides, of OUTLINE_POINTS */
	double support;	    /* share of them with an edge where it should be, 0..1 */
	double residual_px; /* rms of those edges */
	double contrast;    /* mean difference inside - outside at them, levels */
};

struct fit_view {
	const struct image *frame;
	const struct camera *camera;
	double radius;		 /* m, of a ball */
	const struct fit *other; /* neighbours that may hide parts of the rim; the ball itself may be among them */
	int other_count;
	bool coarse; /* half the samples: enough to tell whether there is a ball at all */
};

/* Improves pos and scale in steps from fit's own values, at most `steps`. False when it runs away or finds no rim. */
bool fit_refine(const struct fit_view *view, struct fit *fit, int steps);

/* What the frame shows along an outline, for looking at. */
enum rim_state { RIM_EDGE, RIM_CREASE /* an edge against a neighbour */, RIM_BARE /* none */, RIM_HIDDEN };
struct rim_point {
	vec2 px; /* where the edge is; on the outline when there is none */
	enum rim_state state;
};
/* Along fit->outline as it is; needs its pos and cloth too. */
void fit_rim(const struct fit_view *view, const struct fit *fit, struct rim_point out[OUTLINE_POINTS]);

#endif
