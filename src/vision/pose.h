/* The camera's pose above the table from the markers. */
#ifndef BILLIARD_VISION_POSE_H
#define BILLIARD_VISION_POSE_H

#include "vision/camera.h"
#include "vision/markers_cv.h"
#include "vision/vision.h"

struct pose_fit {
	double residual_px; /* rms over the markers' corners, px */
	double residual;    /* the same on the markers' plane, m */
};

/* Pose that maps the layout's markers best onto what was seen (least squares over all corners; how each marker is
 * turned in its plane, and how large they all look, is found along with it). Needs three markers that are not in a
 * line. camera->in is read, camera->pose written. False when there is no sensible pose; outputs are then untouched. */
bool pose_from_markers(const struct marker_layout *layout, const struct marker_view *view, int count,
		       struct camera *camera, struct pose_fit *fit);

#endif
