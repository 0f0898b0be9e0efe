#include "vision/marker_image_cv.h"

#include <exception>

#include <opencv2/core/version.hpp>
/* Since 4.7 the markers are in OpenCV itself and no more among its contributions. */
#if CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7
#include <opencv2/objdetect/aruco_dictionary.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

namespace
{

cv::Mat bytes_of(int dictionary_count, int dictionary_bits)
{
#if CV_VERSION_MAJOR > 4 || CV_VERSION_MINOR >= 7
	return cv::aruco::extendDictionary(dictionary_count, dictionary_bits).bytesList;
#else
	return cv::aruco::generateCustomDictionary(dictionary_count, dictionary_bits)->bytesList;
#endif
}

} // namespace

bool marker_bits(int dictionary_count, int dictionary_bits, int id, uint8_t out[MARKER_BITS_MAX * MARKER_BITS_MAX])
{
	if (dictionary_count < 1 || dictionary_bits < 1 || dictionary_bits > MARKER_BITS_MAX || id < 0 ||
	    id >= dictionary_count)
		return false;
	try {
		cv::Mat bytes = bytes_of(dictionary_count, dictionary_bits);
		cv::Mat bits = cv::aruco::Dictionary::getBitsFromByteList(bytes.rowRange(id, id + 1), dictionary_bits);
		for (int i = 0; i < dictionary_bits * dictionary_bits; i++)
			out[i] = bits.at<uint8_t>(i / dictionary_bits, i % dictionary_bits);
	} catch (const std::exception &) {
		return false;
	}
	return true;
}
