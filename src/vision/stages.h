/* Pictures of what the stages of a detection saw, for people to look at. Costs nothing while nobody watches. */
#ifndef BILLIARD_VISION_STAGES_H
#define BILLIARD_VISION_STAGES_H

#include "vision/image.h"

/* Called once per picture, in the order of the stages. name: static, fit for a file's name. image: as large as the
 * frame, so that pictures can be laid onto one another; the callee's only during the call; NULL when there was no
 * memory for it. */
struct stage_watch {
	void (*show)(void *user, const char *name, const struct image *image);
	void *user;
};

struct calibration;
struct detector;
struct scan;
struct seeds;
struct table;

/* All of them: watch may be NULL, then nothing is done. */

/* "markers": corners found (green), and with a pose the markers (red) and the bed (blue) where it puts them. */
void stage_markers(const struct stage_watch *watch, const struct image *frame, const struct calibration *calibration,
		   const struct table *table);
/* "cloth": its colour as it is known for each place; "marks": black cloth, grey in doubt, white anything else. */
void stage_scan(const struct stage_watch *watch, const struct image *frame, const struct scan *scan);
/* "votes": brightest where most edges say that a ball's middle is; "seeds": the peaks that are tried, brighter with
 * more votes. */
void stage_seeds(const struct stage_watch *watch, const struct image *frame, const struct scan *scan,
		 const struct seeds *seeds);
/* Fits as they are now: outlines (green), and along them the edges that hold them (white), the edges in creases
 * (yellow), where no edge is (red), what a neighbour hides (blue); refused ones so far (magenta crosses). */
void stage_fits(const struct stage_watch *watch, const char *name, const struct detector *detector);

#endif
