/* What the markers look like: for those who print or render them. OpenCV stays behind this header. */
#ifndef BILLIARD_VISION_MARKER_IMAGE_CV_H
#define BILLIARD_VISION_MARKER_IMAGE_CV_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { MARKER_BITS_MAX = 7 };

/* Inner cells of marker id of cv::aruco::generateCustomDictionary(count, bits), row by row from the top left: bits *
 * bits values, 1 white. A black border of one cell lies around them. False when there is no such marker or dictionary.
 */
bool marker_bits(int dictionary_count, int dictionary_bits, int id, uint8_t out[MARKER_BITS_MAX * MARKER_BITS_MAX]);

#ifdef __cplusplus
}
#endif

#endif
