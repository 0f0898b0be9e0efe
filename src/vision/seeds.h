/* Where balls may be: edges of what is not cloth vote for centres one outline away. */
#ifndef BILLIARD_VISION_SEEDS_H
#define BILLIARD_VISION_SEEDS_H

#include "vision/scan.h"

enum { SEED_MAX = 160 };

struct seed {
	vec2 px; /* full pixel of the outline's middle */
	int votes;
	double cover; /* share of its inside that is not cloth, 0..1 */
};

/* Ellipse that a ball's outline is at one place, as a symmetric matrix in small pixels squared. */
struct seed_shape {
	float xx, xy, yy;
};

struct seeds {
	uint16_t *vote, *sum;	  /* as large as the small picture */
	struct seed_shape *shape; /* one a cell of the scan */
	int capacity;
	int count;
	struct seed seed[SEED_MAX]; /* most votes first */
};

int seeds_init(struct seeds *seeds, int width, int height); /* 0 or -ENOMEM */
void seeds_finish(struct seeds *seeds);
/* Shapes for the scan's present place. */
bool seeds_place(struct seeds *seeds, const struct scan *scan, const struct camera *camera, const struct table *table);
/* Votes, and their peaks, within the cells that are set in active (one byte a cell of the scan, 0 or 1; NULL: all). */
void seeds_find(struct seeds *seeds, const struct scan *scan, const uint8_t *active);

#endif
