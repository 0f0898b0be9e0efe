/* How much hangs together with a find: a ball lies alone or among balls, a find on an arm hangs on the arm. */
#ifndef BILLIARD_VISION_REGION_H
#define BILLIARD_VISION_REGION_H

#include "vision/scan.h"

/* Every second small pixel of every second row. */
struct region {
	uint8_t *state; /* of each: free, wall, visited */
	int *queue;
	int capacity;
};

/* A circle in full pixels. */
struct region_disc {
	vec2 px;
	double radius; /* px */
};

/* Room for the scan of frames of width x height. 0 or -ENOMEM. */
int region_init(struct region *region, int width, int height);
void region_finish(struct region *region);
/* Small pixels that are not cloth, hang together with those in the first disc, and lie outside of it. The other discs,
 * balls and pockets, neither count nor connect. Stops counting at limit. */
int region_beyond(struct region *region, const struct scan *scan, const struct region_disc *disc, int count, int limit);

#endif
