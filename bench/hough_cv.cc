#include "hough_cv.h"

#include <ctime>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace
{

double spent;

double cpu_seconds()
{
	timespec t;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

} // namespace

/* As the thesis describes its detector: what is not green by hue and saturation, smoothed, then circles. */
int hough_balls(const struct image *frame, double radius_px, double *x, double *y, int max)
try {
	cv::setNumThreads(1);
	cv::Mat bgr(frame->height, frame->width, CV_8UC3, frame->data, (size_t)frame->stride), hsv, cloth, grey;
	std::vector<cv::Vec3f> circles;
	cv::cvtColor(bgr, hsv, cv::COLOR_BGR2HSV);
	cv::inRange(hsv, cv::Scalar(60, 20, 60), cv::Scalar(100, 140, 240), cloth);
	cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
	int low = (int)(0.8 * radius_px), high = (int)(1.25 * radius_px);
	double before = cpu_seconds();
	cv::HoughCircles(grey, circles, cv::HOUGH_GRADIENT, 1, 1.6 * radius_px, 90, 11, low, high);
	spent = cpu_seconds() - before;
	grey.setTo(cv::Scalar(150), cloth);
	cv::GaussianBlur(grey, grey, cv::Size(5, 5), 0);
	cv::HoughCircles(grey, circles, cv::HOUGH_GRADIENT, 1, 1.6 * radius_px, 90, 11, low, high);
	int count = 0;
	for (const cv::Vec3f &c : circles)
		if (count < max) {
			x[count] = (double)c[0];
			y[count++] = (double)c[1];
		}
	return count;
} catch (const cv::Exception &) {
	return 0;
}

double hough_seconds(void)
{
	return spent;
}
