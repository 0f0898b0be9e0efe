/* The camera's pose over time: found from the markers, averaged while nothing moves, kept when markers are covered. */
#ifndef BILLIARD_VISION_CALIBRATION_H
#define BILLIARD_VISION_CALIBRATION_H

#include "vision/markers_cv.h"
#include "vision/pose.h"

struct calibration {
	const struct marker_layout *layout; /* borrowed */
	double interval, keep;		    /* s: between searches; how long a pose outlives its markers */
	struct marker_finder *finder;	    /* owned */
	bool valid;
	struct camera camera;
	struct pose_fit fit;
	struct marker_view seen[MARKER_MAX]; /* averaged corners, in order of id */
	int averaged[MARKER_MAX];	     /* frames in each one's average */
	int seen_count;			     /* markers */
	int now_count;			     /* markers of the last search */
	double searched, found;		     /* s: times of the last search and of the last pose */
	int partial;			     /* searches in a row that found less than before */
};

enum calibration_news { CALIBRATION_SAME, CALIBRATION_REFINED, CALIBRATION_MOVED, CALIBRATION_LOST };

/* 0, or a negative errno with the reason. */
int calibration_init(struct calibration *c, const struct marker_layout *layout, double interval, double keep, char *err,
		     size_t err_size);
void calibration_finish(struct calibration *c);
void calibration_reset(struct calibration *c);

/* From one frame alone. in: constants for the frame's size. False, with the reason, when there is no pose. */
bool calibration_single(struct calibration *c, const struct image *frame, const struct camera_intrinsics *in,
			char *reason, size_t reason_size);
struct calibration_frame {
	const struct image *image;
	const struct camera_intrinsics *in; /* constants for its size */
	double time;			    /* s */
	bool urgent;			    /* much of the picture changed, the camera may have been bumped */
};

/* The next frame of a stream. MOVED: the pose is
 * new and former pixels mean nothing any more. LOST: there is none (any more), with the reason. */
enum calibration_news calibration_track(struct calibration *c, const struct calibration_frame *frame, char *reason,
					size_t reason_size);

#endif
