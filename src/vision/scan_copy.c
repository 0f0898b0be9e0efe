/* The smaller copy of the bed. */
#include "vision/scan_parts.h"

#include <string.h>

enum { STRIP = 64 };

/* Downwards first, then sideways for twice as many as are wanted: those loops run over plain bytes. */
static void shrink_two(const uint8_t *restrict a, const uint8_t *restrict b, uint8_t *restrict out, int count)
{
	uint16_t sum[6 * STRIP];
	uint8_t mean[6 * STRIP];
	for (int from = 0; from < count; from += STRIP) {
		int n = count - from < STRIP ? count - from : STRIP;
		for (int i = 0; i < 6 * n; i++)
			sum[i] = (uint16_t)(a[6 * from + i] + b[6 * from + i] + 1);
		for (int i = 0; i < 6 * n - 3; i++)
			mean[i] = (uint8_t)((sum[i] + sum[i + 3]) >> 2);
		for (int i = 0; i < n; i++)
			memcpy(out + 3 * (from + i), mean + 6 * i, 3);
	}
}

static void shrink_any(const uint8_t *in, ptrdiff_t stride, int factor, uint8_t *out, int count)
{
	int area = factor * factor;
	for (int i = 0; i < count; i++, in += 3 * factor, out += 3)
		for (int c = 0; c < 3; c++) {
			int sum = area / 2;
			for (int y = 0; y < factor; y++)
				for (int x = 0; x < factor; x++)
					sum += in[y * stride + 3 * x + c];
			out[c] = (uint8_t)(sum / area);
		}
}

void scan_copy(struct scan *scan, const struct image *frame)
{
	for (int y = 0; y < scan->height; y++) {
		const uint8_t *in = frame->data + (scan->y0 + y * scan->factor) * frame->stride + 3 * scan->x0;
		uint8_t *out = scan->bgr + 3 * y * scan->width;
		if (scan->factor == 2)
			shrink_two(in, in + frame->stride, out, scan->width);
		else
			shrink_any(in, frame->stride, scan->factor, out, scan->width);
	}
}
