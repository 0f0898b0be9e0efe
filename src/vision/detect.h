/* Balls in one calibrated frame: seeds, fits, and the tests that tell balls from everything else. */
#ifndef BILLIARD_VISION_DETECT_H
#define BILLIARD_VISION_DETECT_H

#include "vision/colour.h"
#include "vision/fit.h"
#include "vision/scan.h"
#include "vision/seeds.h"

enum { DETECT_MAX = 48 };

/* Why a candidate was refused; for pictures and statistics. */
enum refusal { REFUSED_NOT, REFUSED_PLACE, REFUSED_FIT, REFUSED_DOUBLE, REFUSED_RIM, REFUSED_INSIDE, REFUSED_SIZE };

struct candidate {
	struct fit fit;
	struct colour_feature look;
	double cover;		/* share of the inside that is not cloth */
	double ring;		/* share just outside of the rim that is not cloth, neighbours left out */
	double confidence;	/* 0..1 */
	enum refusal refusal;
};

struct detector {
	const struct table *table;
	const struct colour_classifier *colours;	/* NULL: none learned yet */
	struct scan scan;
	struct seeds seeds;
	int count;
	struct candidate candidate[DETECT_MAX];	/* accepted ones */
	int refused_count;
	struct candidate refused[SEED_MAX];
};

/* Borrows table and colours (NULL is fine). 0 or -ENOMEM. */
int detector_init(struct detector *d, const struct table *table, const struct colour_classifier *colours, int width, int height);
void detector_finish(struct detector *d);
/* Whenever the pose or the frame's size changes. False when the bed is not in view. */
bool detector_place(struct detector *d, const struct camera *camera);
/* Balls of a whole frame into d->candidate. False when no cloth is seen. */
bool detector_frame(struct detector *d, const struct image *frame, const struct camera *camera);

/* A ball's centre can be here: on the bed, or in a pocket's mouth. */
bool detect_possible(const struct table *table, vec2 pos);

#endif
