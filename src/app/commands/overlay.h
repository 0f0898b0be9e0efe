/* A photograph with what was found in it drawn on top, for looking at. */
#ifndef BILLIARD_APP_OVERLAY_H
#define BILLIARD_APP_OVERLAY_H

#include "vision/vision.h"

enum { OVERLAY_REFUSED_MAX = 64 };

struct overlay {
	const struct image *frame; /* borrowed, all of them */
	const struct table *table;
	const struct vision_result *result;
	const struct vision_refusal *refused;
	int refused_count;
};

/* Writes a PNG: outline of the bed and the pockets through the camera found, a ring, colour and confidence for each
 * ball, a cross and the reason for what was refused, residuals and state as text. 0, or a negative errno with "path:
 * reason" in err. */
int overlay_write(const struct overlay *overlay, const char *path, char *err, size_t err_size);

#endif
