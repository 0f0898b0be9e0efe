#include "vision/image_io_cv.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "harness.h"

static char path[64];

static void setup(void)
{
	snprintf(path, sizeof(path), "/tmp/billiard-image-%ld.png", (long)getpid());
}

static void teardown(void)
{
	unlink(path);
}

/* A picture of soft hills: JPEG keeps it. */
static void paint(struct image_buffer *b, int width, int height)
{
	ck_assert_int_eq(image_buffer_reserve(b, width, height), 0);
	for (int y = 0; y < height; y++)
		for (int x = 0; x < width; x++)
			for (int c = 0; c < 3; c++)
				b->image.data[y * b->image.stride + 3 * x + c] = (uint8_t)(60 + 40 * c + (x + y) % 60);
}

START_TEST(test_png_round_trip_is_exact)
{
	struct image_buffer a = {0}, b = {0};
	char err[256];
	paint(&a, 37, 23);
	ck_assert_int_eq(image_write_png(&a.image, path, err, sizeof(err)), 0);
	ck_assert_int_eq(image_read(path, &b, err, sizeof(err)), 0);
	ck_assert(b.image.width == 37 && b.image.height == 23);
	ck_assert_mem_eq(a.image.data, b.image.data, 37 * 23 * 3);
	image_buffer_finish(&a);
	image_buffer_finish(&b);
}
END_TEST

START_TEST(test_jpeg_round_trip_is_close)
{
	struct image_buffer a = {0}, b = {0};
	struct byte_buffer bytes = {0};
	char err[256];
	paint(&a, 160, 90);
	ck_assert_int_eq(image_encode_jpeg(&a.image, 95, &bytes, err, sizeof(err)), 0);
	ck_assert_int_eq(image_decode(bytes.data, bytes.size, &b, err, sizeof(err)), 0);
	double sum = 0;
	for (int i = 0; i < 160 * 90 * 3; i++)
		sum += abs(a.image.data[i] - b.image.data[i]);
	ck_assert_double_lt(sum / (160 * 90 * 3), 3);
	byte_buffer_finish(&bytes);
	image_buffer_finish(&a);
	image_buffer_finish(&b);
}
END_TEST

/* Every beginning of a JPEG and of a PNG is refused, and nothing is read beyond it (the sanitizers watch). */
START_TEST(test_truncated_is_refused)
{
	struct image_buffer a = {0}, b = {0};
	struct byte_buffer bytes = {0};
	char err[256];
	paint(&a, 64, 48);
	ck_assert_int_eq(image_encode_jpeg(&a.image, 80, &bytes, err, sizeof(err)), 0);
	for (size_t n = 0; n < bytes.size; n += 1 + n / 16) {
		uint8_t *copy = malloc(n + 1);
		memcpy(copy, bytes.data, n);
		err[0] = 0;
		ck_assert_int_lt(image_decode(copy, n, &b, err, sizeof(err)), 0);
		ck_assert(err[0] != 0);
		ck_assert_ptr_null(b.image.data);
		free(copy);
	}
	ck_assert_int_eq(image_write_png(&a.image, path, err, sizeof(err)), 0);
	ck_assert_int_eq(truncate(path, 300), 0);
	ck_assert_int_eq(image_read(path, &b, err, sizeof(err)), -EBADMSG);
	ck_assert_ptr_nonnull(strstr(err, path));
	byte_buffer_finish(&bytes);
	image_buffer_finish(&a);
}
END_TEST

static void put_be32(uint8_t *p, uint32_t v)
{
	for (int i = 0; i < 4; i++)
		p[i] = (uint8_t)(v >> (24 - 8 * i));
}

/* A header of 100 000 x 100 000 pixels must not make anybody allocate them. */
START_TEST(test_huge_headers_are_refused)
{
	uint8_t png[64] = "\x89PNG\r\n\x1a\n";
	struct image_buffer b = {0};
	char err[256];
	put_be32(png + 8, 13);
	memcpy(png + 12, "IHDR", 4);
	put_be32(png + 16, 100000);
	put_be32(png + 20, 100000);
	ck_assert_int_eq(image_decode(png, sizeof(png), &b, err, sizeof(err)), -EFBIG);
	uint8_t jpeg[] = {0xff, 0xd8, 0xff, 0xc0, 0,	17, 8, 0xff, 0xff, 0xff, 0xff, 3,
			  1,	0x22, 0,    2,	  0x11, 1,  3, 0x11, 1,	   0xff, 0xd9};
	ck_assert_int_eq(image_decode(jpeg, sizeof(jpeg), &b, err, sizeof(err)), -EFBIG);
	ck_assert_int_lt(image_buffer_reserve(&b, 0, 5), 0);
	ck_assert_int_lt(image_buffer_reserve(&b, IMAGE_SIDE_MAX + 1, 5), 0);
}
END_TEST

START_TEST(test_no_image_at_all)
{
	struct image_buffer b = {0};
	char err[256];
	ck_assert_int_eq(image_read("/nowhere/a.png", &b, err, sizeof(err)), -ENOENT);
	ck_assert_ptr_nonnull(strstr(err, "/nowhere/a.png"));
	FILE *file = fopen(path, "w");
	fputs("these are not the pixels you are looking for", file);
	fclose(file);
	ck_assert_int_eq(image_read(path, &b, err, sizeof(err)), -EBADMSG);
	file = fopen(path, "w");
	fclose(file);
	ck_assert_int_eq(image_read(path, &b, err, sizeof(err)), -EBADMSG);
	ck_assert_int_lt(image_read("/tmp", &b, err, sizeof(err)), 0);
	ck_assert_int_eq(image_write_png(&(struct image){(uint8_t[3]){0}, 1, 1, 3}, "/dev/full", err, sizeof(err)),
			 -ENOSPC);
	ck_assert_int_lt(image_write_png(&(struct image){(uint8_t[3]){0}, 1, 1, 3}, "/nowhere/a.png", err, sizeof(err)),
			 0);
	image_buffer_finish(&b);
}
END_TEST

Suite *test_suite(void)
{
	Suite *suite = suite_create("image_io");
	TCase *tc = tcase_create("image_io");
	tcase_add_checked_fixture(tc, setup, teardown);
	tcase_add_test(tc, test_png_round_trip_is_exact);
	tcase_add_test(tc, test_jpeg_round_trip_is_close);
	tcase_add_test(tc, test_truncated_is_refused);
	tcase_add_test(tc, test_huge_headers_are_refused);
	tcase_add_test(tc, test_no_image_at_all);
	suite_add_tcase(suite, tc);
	return suite;
}
