/* A view of pixels that somebody else owns. */
#ifndef BILLIARD_VISION_IMAGE_H
#define BILLIARD_VISION_IMAGE_H

#include <stddef.h>
#include <stdint.h>

/* 8-bit BGR, rows from the top, stride in bytes >= 3 width. */
struct image {
	uint8_t *data;	   /* borrowed */
	int width, height; /* px */
	ptrdiff_t stride;  /* bytes */
};

#endif
