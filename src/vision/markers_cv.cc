#include "vision/markers_cv.h"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <vector>

#include <opencv2/core/version.hpp>
#include <opencv2/imgproc.hpp>
/* Since 4.7 the markers are in OpenCV itself and no more among its contributions. */
#if CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

#include "vision/reason.h"

struct marker_finder {
#if CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7
	cv::aruco::ArucoDetector detector;
#else
	cv::Ptr<cv::aruco::Dictionary> dictionary;
	cv::Ptr<cv::aruco::DetectorParameters> parameters;
#endif
	cv::Mat grey;
	std::vector<int> ids;
	std::vector<std::vector<cv::Point2f>> corners;
};

namespace
{

/* Around a marker seen before: this many of its own sides. */
const double NEAR_MARGIN = 0.6;

/* The caller's array of markers, in order of id. */
struct sorted {
	marker_view *out;
	int count, max;
};

void insert(sorted *s, const marker_view &view)
{
	int at = 0;
	while (at < s->count && s->out[at].id < view.id)
		at++;
	if ((at < s->count && s->out[at].id == view.id) || s->count == s->max)
		return;
	std::copy_backward(s->out + at, s->out + s->count, s->out + s->count + 1);
	s->out[at] = view;
	s->count++;
}

void refine_corners(cv::aruco::DetectorParameters *p)
{
	p->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
	/* Larger windows reach the marker's inner squares and are drawn off by them. */
	p->cornerRefinementWinSize = 3;
	p->cornerRefinementMaxIterations = 50;
	p->cornerRefinementMinAccuracy = 0.01;
}

#if CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7
void prepare(marker_finder *f, int dictionary_count, int dictionary_bits)
{
	cv::aruco::DetectorParameters parameters;
	refine_corners(&parameters);
#if CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 9
	/* The window stays what it is, also for small markers. */
	parameters.relativeCornerRefinmentWinSize = 10;
#endif
	f->detector =
		cv::aruco::ArucoDetector(cv::aruco::extendDictionary(dictionary_count, dictionary_bits), parameters);
}

void detect(marker_finder *f)
{
	f->detector.detectMarkers(f->grey, f->corners, f->ids);
}
#else
void prepare(marker_finder *f, int dictionary_count, int dictionary_bits)
{
	f->dictionary = cv::aruco::generateCustomDictionary(dictionary_count, dictionary_bits);
	f->parameters = cv::aruco::DetectorParameters::create();
	refine_corners(f->parameters.get());
}

void detect(marker_finder *f)
{
	cv::aruco::detectMarkers(f->grey, f->dictionary, f->corners, f->ids, f->parameters);
}
#endif

void search(marker_finder *f, const cv::Mat &bgr, cv::Point offset, sorted *found)
{
	cv::cvtColor(bgr, f->grey, cv::COLOR_BGR2GRAY);
	detect(f);
	for (size_t i = 0; i < f->ids.size(); i++) {
		marker_view view;
		view.id = f->ids[i];
		for (int k = 0; k < 4; k++) {
			view.x[k] = (double)f->corners[i][(size_t)k].x + offset.x;
			view.y[k] = (double)f->corners[i][(size_t)k].y + offset.y;
		}
		insert(found, view);
	}
}

cv::Rect around(const marker_view &view, int width, int height)
{
	double x0 = *std::min_element(view.x, view.x + 4), x1 = *std::max_element(view.x, view.x + 4);
	double y0 = *std::min_element(view.y, view.y + 4), y1 = *std::max_element(view.y, view.y + 4);
	double margin = NEAR_MARGIN * std::max(x1 - x0, y1 - y0);
	cv::Rect box((int)(x0 - margin), (int)(y0 - margin), (int)(x1 - x0 + 2 * margin), (int)(y1 - y0 + 2 * margin));
	return box & cv::Rect(0, 0, width, height);
}

cv::Mat view_of(const image *frame)
{
	return cv::Mat(frame->height, frame->width, CV_8UC3, frame->data, (size_t)frame->stride);
}

} // namespace

int marker_finder_create(struct marker_finder **out, int dictionary_count, int dictionary_bits, char *err,
			 size_t err_size)
{
	*out = nullptr;
	marker_finder *f = nullptr;
	/* OpenCV searches for ever where there are fewer different markers than wanted. */
	if (dictionary_bits < 3 || dictionary_bits > 7 || dictionary_count < 1 || dictionary_count > 50)
		return vision_fail(-EINVAL, err, err_size,
				   "dictionary of %d markers of %d bits, allowed 1..50 and 3..7", dictionary_count,
				   dictionary_bits);
	try {
		/* Vision has one thread, OpenCV's own would take the other programs' cores. */
		cv::setNumThreads(0);
		f = new marker_finder;
		prepare(f, dictionary_count, dictionary_bits);
	} catch (const std::exception &e) {
		delete f;
		return vision_fail(-EINVAL, err, err_size, "markers: %.80s", e.what());
	}
	*out = f;
	return 0;
}

void marker_finder_destroy(struct marker_finder *finder)
{
	delete finder;
}

int marker_find(struct marker_finder *finder, const struct image *frame, struct marker_view *out, int max)
{
	sorted found = {out, 0, max};
	try {
		search(finder, view_of(frame), cv::Point(0, 0), &found);
	} catch (const std::exception &) {
		/* What OpenCV cannot search holds no marker. */
		found.count = 0;
	}
	return found.count;
}

int marker_find_near(struct marker_finder *finder, const struct image *frame, const struct marker_view *seen,
		     int seen_count, struct marker_view *out, int max)
{
	sorted found = {out, 0, max};
	try {
		for (int i = 0; i < seen_count; i++) {
			cv::Rect box = around(seen[i], frame->width, frame->height);
			if (box.width > 0 && box.height > 0)
				search(finder, view_of(frame)(box), box.tl(), &found);
		}
	} catch (const std::exception &) {
		found.count = 0;
	}
	return found.count;
}
