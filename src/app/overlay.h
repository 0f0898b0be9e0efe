/* A photograph with what was found in it drawn on top, for looking at. */
#ifndef BILLIARD_APP_OVERLAY_H
#define BILLIARD_APP_OVERLAY_H

#include "vision/vision.h"

/* Writes a PNG: outline of the bed and the pockets through the camera found, a ring, colour and confidence for each ball, residuals and state as text.
 * 0, or a negative errno with "path: reason" in err. */
int overlay_write(const struct image *frame, const struct table *table, const struct vision_result *result, const char *path, char *err,
		  size_t err_size);

#endif
