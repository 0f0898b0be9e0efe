#include "vision/image_io_cv.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "vision/reason.h"

namespace
{

struct header_size {
	long width, height;
	bool found, complete; /* complete: the end marker is there */
};

unsigned be16(const uint8_t *p)
{
	return (unsigned)p[0] << 8 | p[1];
}

unsigned long be32(const uint8_t *p)
{
	return (unsigned long)be16(p) << 16 | be16(p + 2);
}

bool is_png(const uint8_t *p, size_t size)
{
	return size >= 8 && memcmp(p, "\x89PNG\r\n\x1a\n", 8) == 0;
}

bool is_jpeg(const uint8_t *p, size_t size)
{
	return size >= 3 && p[0] == 0xff && p[1] == 0xd8 && p[2] == 0xff;
}

header_size png_size(const uint8_t *p, size_t size)
{
	if (size < 33 || memcmp(p + 12, "IHDR", 4) != 0)
		return {0, 0, false, false};
	bool end = false;
	for (size_t at = 8; at + 12 <= size;) {
		size_t length = be32(p + at);
		if (length > size - at - 12)
			break;
		end = memcmp(p + at + 4, "IEND", 4) == 0;
		at += 12 + length;
	}
	return {(long)be32(p + 16), (long)be32(p + 20), true, end};
}

/* Walks the segments up to the frame header. */
header_size jpeg_size(const uint8_t *p, size_t size)
{
	header_size s = {0, 0, false, false};
	for (size_t at = 2; at + 4 <= size;) {
		if (p[at] != 0xff)
			break;
		unsigned kind = p[at + 1];
		if (kind == 0xff) {
			at++;
			continue;
		}
		bool alone = kind == 0x01 || (kind >= 0xd0 && kind <= 0xd8);
		if (alone) {
			at += 2;
			continue;
		}
		size_t length = be16(p + at + 2);
		bool frame = kind >= 0xc0 && kind <= 0xcf && kind != 0xc4 && kind != 0xc8 && kind != 0xcc;
		if (frame && length >= 8 && at + 9 <= size) {
			s = {(long)be16(p + at + 7), (long)be16(p + at + 5), true, false};
			break;
		}
		if (kind == 0xda || kind == 0xd9 || length < 2)
			break;
		at += 2 + length;
	}
	/* Cameras may pad behind the end marker. */
	for (size_t at = size; s.found && at >= 2 && size - at < 64; at--)
		s.complete = s.complete || (p[at - 2] == 0xff && p[at - 1] == 0xd9);
	return s;
}

int keep(const cv::Mat &mat, image_buffer *out, char *err, size_t err_size)
{
	int rc = image_buffer_reserve(out, mat.cols, mat.rows);
	if (rc < 0)
		return vision_fail(rc, err, err_size, "no memory for %d x %d pixels", mat.cols, mat.rows);
	cv::Mat view(mat.rows, mat.cols, CV_8UC3, out->image.data, (size_t)out->image.stride);
	mat.copyTo(view);
	return 0;
}

int decode(const uint8_t *data, size_t size, image_buffer *out, char *err, size_t err_size)
{
	if (size > (size_t)1 << 30)
		return vision_fail(-EFBIG, err, err_size, "%zu bytes are too many for an image", size);
	cv::Mat bytes(1, (int)size, CV_8UC1, const_cast<uint8_t *>(data));
	cv::Mat mat = cv::imdecode(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
	if (mat.empty())
		return vision_fail(-EBADMSG, err, err_size, "not a readable image");
	if (mat.cols > IMAGE_SIDE_MAX || mat.rows > IMAGE_SIDE_MAX)
		return vision_fail(-EFBIG, err, err_size, "%d x %d pixels, at most %d a side", mat.cols, mat.rows,
				   IMAGE_SIDE_MAX);
	return keep(mat, out, err, err_size);
}

int read_bytes(const char *path, std::vector<uint8_t> &bytes)
{
	FILE *file = fopen(path, "rb");
	if (!file)
		return -errno;
	uint8_t block[65536];
	size_t n;
	while ((n = fread(block, 1, sizeof(block), file)) > 0 && bytes.size() < (size_t)1 << 30)
		bytes.insert(bytes.end(), block, block + n);
	int rc = ferror(file) ? -EIO : 0;
	fclose(file);
	return rc;
}

} // namespace

int image_buffer_reserve(struct image_buffer *buffer, int width, int height)
{
	if (width <= 0 || height <= 0 || width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX)
		return -EINVAL;
	size_t need = (size_t)width * (size_t)height * 3;
	if (need > buffer->capacity) {
		void *data = realloc(buffer->image.data, need);
		if (!data)
			return -ENOMEM;
		buffer->image.data = (uint8_t *)data;
		buffer->capacity = need;
	}
	buffer->image.width = width;
	buffer->image.height = height;
	buffer->image.stride = (ptrdiff_t)width * 3;
	return 0;
}

void image_buffer_finish(struct image_buffer *buffer)
{
	free(buffer->image.data);
	*buffer = image_buffer{};
}

void byte_buffer_finish(struct byte_buffer *buffer)
{
	free(buffer->data);
	*buffer = byte_buffer{};
}

int image_decode(const uint8_t *data, size_t size, struct image_buffer *out, char *err, size_t err_size)
try {
	bool png = is_png(data, size), jpeg = is_jpeg(data, size);
	if (!png && !jpeg)
		return vision_fail(-EBADMSG, err, err_size, "neither JPEG nor PNG");
	header_size s = png ? png_size(data, size) : jpeg_size(data, size);
	if (!s.found || s.width <= 0 || s.height <= 0)
		return vision_fail(-EBADMSG, err, err_size, "the image has no valid header");
	if (s.width > IMAGE_SIDE_MAX || s.height > IMAGE_SIDE_MAX)
		return vision_fail(-EFBIG, err, err_size, "%ld x %ld pixels, at most %d a side", s.width, s.height,
				   IMAGE_SIDE_MAX);
	if (!s.complete)
		return vision_fail(-EBADMSG, err, err_size, "the image is truncated");
	return decode(data, size, out, err, err_size);
} catch (const std::exception &e) {
	return vision_fail(-EBADMSG, err, err_size, "not a readable image: %.100s", e.what());
}

int image_read(const char *path, struct image_buffer *out, char *err, size_t err_size)
try {
	std::vector<uint8_t> bytes;
	int rc = read_bytes(path, bytes);
	if (rc < 0)
		return vision_fail(rc, err, err_size, "%s: %s", path, strerror(-rc));
	char reason[160] = "";
	const uint8_t *p = bytes.data();
	if (bytes.empty())
		return vision_fail(-EBADMSG, err, err_size, "%s: the file is empty", path);
	if (is_png(p, bytes.size()) || is_jpeg(p, bytes.size()))
		rc = image_decode(p, bytes.size(), out, reason, sizeof(reason));
	else if (bytes.size() > 2 && p[0] == 'B' && p[1] == 'M')
		rc = decode(p, bytes.size(), out, reason, sizeof(reason));
	else
		rc = vision_fail(-EBADMSG, reason, sizeof(reason), "not a PNG, JPEG or BMP image");
	return rc < 0 ? vision_fail(rc, err, err_size, "%s: %s", path, reason) : 0;
} catch (const std::exception &e) {
	return vision_fail(-EBADMSG, err, err_size, "%s: %.100s", path, e.what());
}

static int write_bytes(const char *path, const std::vector<uint8_t> &bytes)
{
	FILE *file = fopen(path, "wb");
	if (!file)
		return -errno;
	int rc = fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() ? 0 : -errno;
	return fclose(file) == EOF && rc == 0 ? -errno : rc;
}

int image_encode_jpeg(const struct image *image, int quality, struct byte_buffer *out, char *err, size_t err_size)
try {
	cv::Mat mat(image->height, image->width, CV_8UC3, image->data, (size_t)image->stride);
	std::vector<uint8_t> bytes;
	if (!cv::imencode(".jpg", mat, bytes, {cv::IMWRITE_JPEG_QUALITY, quality}))
		return vision_fail(-EIO, err, err_size, "the image could not be encoded");
	if (bytes.size() > out->capacity) {
		void *data = realloc(out->data, bytes.size());
		if (!data)
			return vision_fail(-ENOMEM, err, err_size, "no memory for %zu bytes", bytes.size());
		out->data = (uint8_t *)data;
		out->capacity = bytes.size();
	}
	memcpy(out->data, bytes.data(), bytes.size());
	out->size = bytes.size();
	return 0;
} catch (const std::exception &e) {
	return vision_fail(-EIO, err, err_size, "the image could not be encoded: %.100s", e.what());
}

int image_write_png(const struct image *image, const char *path, char *err, size_t err_size)
try {
	cv::Mat mat(image->height, image->width, CV_8UC3, image->data, (size_t)image->stride);
	std::vector<uint8_t> bytes;
	/* Fast rather than small: these are pictures to look at. */
	if (!cv::imencode(".png", mat, bytes, {cv::IMWRITE_PNG_COMPRESSION, 2}))
		return vision_fail(-EIO, err, err_size, "%s: the image could not be encoded", path);
	/* Not cv::imwrite: it does not notice that the disk is full. */
	int rc = write_bytes(path, bytes);
	return rc < 0 ? vision_fail(rc, err, err_size, "%s: %s", path, strerror(-rc)) : 0;
} catch (const std::exception &e) {
	return vision_fail(-EIO, err, err_size, "%s: %.100s", path, e.what());
}
