/* Frames from the bus: refused with a reason, or pixels that can all be read. */
#include <stdint.h>
#include <stdlib.h>

#include "vision/image_io_cv.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct image_buffer buffer;
	unsigned sum = 0;
	char err[640] = "";
	if (image_decode(data, size, &buffer, err, sizeof err) < 0) {
		if (!err[0])
			abort();
		return 0;
	}
	const struct image *image = &buffer.image;
	if (image->width < 1 || image->height < 1 || image->stride < 3 * (ptrdiff_t)image->width)
		abort();
	for (int y = 0; y < image->height; y++)
		for (int x = 0; x < 3 * image->width; x++)
			sum += image->data[y * image->stride + x];
	__asm__ volatile("" : : "r"(sum)); /* keeps the reads */
	return 0;
}
