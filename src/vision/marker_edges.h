/* Corners of a marker to a few hundredths of a pixel: lines through the edges of its black square. */
#ifndef BILLIARD_VISION_MARKER_EDGES_H
#define BILLIARD_VISION_MARKER_EDGES_H

#include <stdbool.h>

#include "vision/image.h"
#include "vision/markers_cv.h"

/* Improves the corners of one marker. cells: squares along its side, border included (bits + 2). False, and view
 * untouched, when an edge is not there to be measured (half covered, blurred, too small). */
bool marker_refine(const struct image *frame, int cells, struct marker_view *view);

#endif
