/* Balls in one calibrated frame: seeds, fits, and the tests that tell balls from everything else. */
#ifndef BILLIARD_VISION_DETECTOR_H
#define BILLIARD_VISION_DETECTOR_H

#include "vision/colour.h"
#include "vision/fit.h"
#include "vision/region.h"
#include "vision/scan.h"
#include "vision/seeds.h"
#include "vision/stages.h"

enum { DETECT_MAX = 48 };

/* Why a candidate was refused; for pictures and statistics. */
enum refusal {
	REFUSED_NOT,
	REFUSED_PLACE,
	REFUSED_FIT,
	REFUSED_DOUBLE,
	REFUSED_RIM,
	REFUSED_INSIDE,
	REFUSED_SIZE,
	REFUSED_PART
};

struct sighting {
	struct fit fit;
	struct colour_feature look;
	double cover;	   /* share of the inside that is not cloth */
	double ring;	   /* share just outside of the rim that is not cloth, neighbours left out */
	double confidence; /* 0..1 */
	enum refusal refusal;
	bool fixed;  /* known from before and unchanged: neither fitted nor judged again */
	bool alone;  /* no neighbour near enough to hide any of its rim */
	bool judged; /* fitted and judged while alone: done unless a neighbour turns up */
	int tag;     /* the caller's, -1 for what was found anew */
};

struct detector {
	const struct table *table;
	const struct colour_classifier *colours; /* NULL: none learned yet */
	const struct stage_watch *watch;	 /* borrowed; NULL: nobody looks */
	struct scan scan;
	struct seeds seeds;
	struct region region;
	struct fit_view view; /* frame and camera from begin to settle */
	struct fit neighbour[DETECT_MAX];
	int count;
	struct sighting candidate[DETECT_MAX]; /* accepted ones */
	int refused_count;
	struct sighting refused[SEED_MAX];
};

/* Borrows table and colours (NULL is fine). 0 or -ENOMEM. */
int detector_init(struct detector *d, const struct table *table, const struct colour_classifier *colours, int width,
		  int height);
void detector_finish(struct detector *d);
/* Whenever the pose or the frame's size changes. False when the bed is not in view. */
bool detector_place(struct detector *d, const struct camera *camera);
/* Balls of a whole frame into d->candidate. False when no cloth is seen. */
bool detector_frame(struct detector *d, const struct image *frame, const struct camera *camera);

/* The same of a frame that scan_changes() has copied. */
bool detector_look(struct detector *d, const struct image *frame, const struct camera *camera);

/* The same in steps, for a tracked table whose scan is up to date: begin; put in what is known; look for more in the
 * active cells; settle. Candidates that are known carry the caller's tag. frame and camera are borrowed until settle. */
void detector_begin(struct detector *d, const struct image *frame, const struct camera *camera);
/* A ball that did not change. */
void detector_keep(struct detector *d, const struct sighting *known, int tag);
/* A ball to be fitted again, near pos; scale and look are taken from known. False when it is not there. */
bool detector_follow(struct detector *d, const struct sighting *known, vec2 pos, int tag);
/* active: one byte a cell of the scan; NULL: all. */
void detector_search(struct detector *d, const uint8_t *active);
void detector_settle(struct detector *d);
/* Share of small pixels that are not cloth around a full pixel, within 0.8 of a usual ball's radius. */
double detector_cover(const struct detector *d, vec2 px);

/* A ball's centre can be here: on the bed, or in a pocket's mouth. */
bool detect_possible(const struct table *table, vec2 pos);

#endif
