/* The old way of finding balls, as the yardstick: circle Hough on the whole frame. OpenCV stays behind this header. */
#ifndef BILLIARD_BENCH_HOUGH_CV_H
#define BILLIARD_BENCH_HOUGH_CV_H

#include "vision/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Middles (px) of circles of about that radius, at most max; returns how many. One thread.
 */
int hough_balls(const struct image *frame, double radius_px, double *x, double *y, int max);
/* s of this thread's CPU that cv::HoughCircles alone took in the last call, on the plain grey frame. (The whole way
 * runs it again on the segmented and smoothed one; take these seconds off its time.) */
double hough_seconds(void);

#ifdef __cplusplus
}
#endif

#endif
