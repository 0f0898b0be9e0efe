#include "vision/marker_image_cv.h"

#include <exception>

#include <opencv2/aruco.hpp>

bool marker_bits(int dictionary_count, int dictionary_bits, int id, uint8_t out[MARKER_BITS_MAX * MARKER_BITS_MAX])
{
	if (dictionary_count < 1 || dictionary_bits < 1 || dictionary_bits > MARKER_BITS_MAX || id < 0 ||
	    id >= dictionary_count)
		return false;
	try {
		cv::Ptr<cv::aruco::Dictionary> dictionary =
			cv::aruco::generateCustomDictionary(dictionary_count, dictionary_bits);
		cv::Mat bits = cv::aruco::Dictionary::getBitsFromByteList(dictionary->bytesList.rowRange(id, id + 1),
									  dictionary_bits);
		for (int i = 0; i < dictionary_bits * dictionary_bits; i++)
			out[i] = bits.at<uint8_t>(i / dictionary_bits, i % dictionary_bits);
	} catch (const std::exception &) {
		return false;
	}
	return true;
}
