/* Images in memory and on disk. OpenCV stays behind this header; no exception comes out of it. */
#ifndef BILLIARD_VISION_IMAGE_IO_CV_H
#define BILLIARD_VISION_IMAGE_IO_CV_H

#include "vision/image.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { IMAGE_SIDE_MAX = 8192 }; /* px; larger images are refused before they are decoded */

/* Pixels that grow when needed and are then reused. Begins as {0}; finish frees. */
struct image_buffer {
	struct image image; /* valid after a successful call */
	size_t capacity;    /* bytes owned */
};

/* Bytes that grow when needed. Begins as {0}; finish frees. */
struct byte_buffer {
	uint8_t *data;
	size_t size, capacity;
};

/* Makes room for width x height pixels; the pixels are not set. 0, -EINVAL (size), -ENOMEM. */
int image_buffer_reserve(struct image_buffer *buffer, int width, int height);
void image_buffer_finish(struct image_buffer *buffer); /* {0} is fine */
void byte_buffer_finish(struct byte_buffer *buffer);

/* All of these: 0, or a negative errno with the reason in err and out untouched. Grey and 16-bit images become 8-bit
 * BGR. */

/* PNG, JPEG or BMP file. -ENOENT, -EBADMSG (no image, truncated), -EFBIG. */
int image_read(const char *path, struct image_buffer *out, char *err, size_t err_size);
/* The same from memory: JPEG or PNG only; the size in the header is checked before anything is decoded. */
int image_decode(const uint8_t *data, size_t size, struct image_buffer *out, char *err, size_t err_size);
/* quality 1..100. */
int image_encode_jpeg(const struct image *image, int quality, struct byte_buffer *out, char *err, size_t err_size);
int image_write_png(const struct image *image, const char *path, char *err, size_t err_size);

#ifdef __cplusplus
}
#endif

#endif
