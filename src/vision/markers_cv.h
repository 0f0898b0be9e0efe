/* Finding the ArUco markers on the rails. OpenCV stays behind this header; no exception comes out of it. */
#ifndef BILLIARD_VISION_MARKERS_CV_H
#define BILLIARD_VISION_MARKERS_CV_H

#include "vision/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One marker in a frame. Corners in the marker's own order (clockwise as the camera sees it), sub-pixel, px. */
struct marker_view {
	int id;
	double x[4], y[4];
};

struct marker_finder;
/* For the markers of cv::aruco::generateCustomDictionary(count, bits). 0, -EINVAL or -ENOMEM with the reason. Caller
 * destroys. */
int marker_finder_create(struct marker_finder **out, int dictionary_count, int dictionary_bits, char *err,
			 size_t err_size);
void marker_finder_destroy(struct marker_finder *finder); /* NULL is fine */

/* Markers in the whole frame, each id once, in order of id. Returns how many, at most max. */
int marker_find(struct marker_finder *finder, const struct image *frame, struct marker_view *out, int max);
/* The same, looking only around where markers were seen before: far cheaper. */
int marker_find_near(struct marker_finder *finder, const struct image *frame, const struct marker_view *seen,
		     int seen_count, struct marker_view *out, int max);

#ifdef __cplusplus
}
#endif

#endif
