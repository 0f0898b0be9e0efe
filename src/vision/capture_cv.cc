#include "vision/capture_cv.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/videoio.hpp>

#include "vision/reason.h"

struct capture {
	std::string source;
	bool live = false;
	std::vector<std::string> files; /* a folder's, or a single image */
	size_t next_file = 0;
	cv::VideoCapture video;
	cv::Mat mat;
	double fps = 30;
	long announced = 0; /* frames a video says it has; 0 unknown */
	bool ended = false;
	int index = 0;
};

namespace
{

namespace fs = std::filesystem;

const double DEFAULT_FPS = 30;

/* "9.png" before "10.png". */
bool natural_less(const std::string &a, const std::string &b)
{
	size_t i = 0, j = 0;
	while (i < a.size() && j < b.size()) {
		if (isdigit((unsigned char)a[i]) && isdigit((unsigned char)b[j])) {
			size_t i1 = i, j1 = j;
			while (i1 < a.size() && isdigit((unsigned char)a[i1]))
				i1++;
			while (j1 < b.size() && isdigit((unsigned char)b[j1]))
				j1++;
			std::string x = a.substr(i, i1 - i), y = b.substr(j, j1 - j);
			x.erase(0, std::min(x.find_first_not_of('0'), x.size()));
			y.erase(0, std::min(y.find_first_not_of('0'), y.size()));
			if (x.size() != y.size())
				return x.size() < y.size();
			if (x != y)
				return x < y;
			i = i1, j = j1;
		} else if (a[i] != b[j]) {
			return a[i] < b[j];
		} else {
			i++, j++;
		}
	}
	return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

bool is_image_name(const std::string &name)
{
	size_t dot = name.rfind('.');
	if (dot == std::string::npos)
		return false;
	std::string ext = name.substr(dot + 1);
	std::transform(ext.begin(), ext.end(), ext.begin(), [](unsigned char c) { return (char)tolower(c); });
	return ext == "png" || ext == "jpg" || ext == "jpeg" || ext == "bmp";
}

int check_there(const std::string &path, char *err, size_t err_size)
{
	std::error_code code;
	if (fs::exists(path, code))
		return 0;
	int number = code ? code.value() : ENOENT;
	return vision_fail(-number, err, err_size, "%s: %s", path.c_str(), strerror(number));
}

int open_folder(capture *c, const std::string &path, char *err, size_t err_size)
{
	std::error_code code;
	for (const fs::directory_entry &entry : fs::directory_iterator(path, code))
		if (is_image_name(entry.path().filename().string()))
			c->files.push_back(entry.path().string());
	if (code)
		return vision_fail(-code.value(), err, err_size, "%s: %s", path.c_str(), code.message().c_str());
	if (c->files.empty())
		return vision_fail(-EINVAL, err, err_size, "%s: the folder holds no PNG, JPEG or BMP image",
				   path.c_str());
	std::sort(c->files.begin(), c->files.end(), natural_less);
	return 0;
}

int open_file(capture *c, const std::string &path, char *err, size_t err_size)
{
	int rc = check_there(path, err, err_size);
	if (rc < 0)
		return rc;
	if (fs::is_directory(path))
		return vision_fail(-EISDIR, err, err_size, "%s: is a folder, use dir:", path.c_str());
	if (is_image_name(path)) {
		c->files.push_back(path);
		return 0;
	}
	if (!c->video.open(path, cv::CAP_FFMPEG) || !c->video.isOpened())
		return vision_fail(-EBADMSG, err, err_size, "%s: neither a readable video nor an image", path.c_str());
	double fps = c->video.get(cv::CAP_PROP_FPS), frames = c->video.get(cv::CAP_PROP_FRAME_COUNT);
	c->fps = std::isfinite(fps) && fps > 0.1 && fps < 1000 ? fps : DEFAULT_FPS;
	c->announced = std::isfinite(frames) && frames > 0 && frames < 1e9 ? (long)frames : 0;
	return 0;
}

int open_camera(capture *c, const std::string &path, const capture_def *def, char *err, size_t err_size)
{
	int rc = check_there(path, err, err_size);
	if (rc < 0)
		return rc;
	c->live = true;
	if (!c->video.open(path, cv::CAP_V4L2) || !c->video.isOpened())
		return vision_fail(-EIO, err, err_size, "%s: the camera does not open", path.c_str());
	/* Cheap cameras reach full size at full rate only in MJPG. */
	c->video.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'));
	if (def->width > 0 && def->height > 0) {
		c->video.set(cv::CAP_PROP_FRAME_WIDTH, def->width);
		c->video.set(cv::CAP_PROP_FRAME_HEIGHT, def->height);
	}
	if (def->fps > 0)
		c->video.set(cv::CAP_PROP_FPS, def->fps);
	/* The newest frame, not the oldest of a queue. */
	c->video.set(cv::CAP_PROP_BUFFERSIZE, 1);
	return 0;
}

int open_source(capture *c, const capture_def *def, char *err, size_t err_size)
{
	c->source = def->source;
	if (def->fps > 0)
		c->fps = def->fps;
	if (c->source.rfind("v4l2:", 0) == 0)
		return open_camera(c, c->source.substr(5), def, err, err_size);
	if (c->source.rfind("dir:", 0) == 0)
		return open_folder(c, c->source.substr(4), err, err_size);
	if (c->source.rfind("file:", 0) == 0)
		return open_file(c, c->source.substr(5), err, err_size);
	return vision_fail(-EINVAL, err, err_size, "unknown source \"%s\": v4l2:DEVICE, dir:FOLDER or file:FILE",
			   def->source);
}

void describe(capture *c, const std::string &name, capture_frame *frame)
{
	snprintf(frame->name, sizeof(frame->name), "%s", name.c_str());
	frame->index = c->index;
	frame->time = c->live ? 0 : c->index / c->fps;
	c->index++;
}

int next_image(capture *c, image_buffer *image, capture_frame *frame, char *err, size_t err_size)
{
	if (c->next_file >= c->files.size())
		return 0;
	const std::string &path = c->files[c->next_file++];
	describe(c, path, frame);
	int rc = image_read(path.c_str(), image, err, err_size);
	return rc < 0 ? rc : 1;
}

int end_of_video(capture *c, char *err, size_t err_size)
{
	if (c->live)
		return vision_fail(-EIO, err, err_size, "%s: the camera gives no frame", c->source.c_str());
	bool first = !c->ended;
	c->ended = true;
	/* Containers may count a frame or two more than they hold. */
	if (first && (c->index == 0 || c->index + 2 < c->announced))
		return vision_fail(-EBADMSG, err, err_size, "%s: ends after %d of %ld frames", c->source.c_str(),
				   c->index, c->announced);
	return 0;
}

int next_video(capture *c, image_buffer *image, capture_frame *frame, char *err, size_t err_size)
{
	if (c->ended)
		return 0;
	if (!c->video.read(c->mat) || c->mat.empty())
		return end_of_video(c, err, err_size);
	if (c->mat.type() != CV_8UC3)
		return vision_fail(-EBADMSG, err, err_size, "%s: frames are not 8-bit BGR", c->source.c_str());
	int rc = image_buffer_reserve(image, c->mat.cols, c->mat.rows);
	if (rc < 0)
		return vision_fail(rc, err, err_size, "%s: %d x %d pixels", c->source.c_str(), c->mat.cols,
				   c->mat.rows);
	cv::Mat view(c->mat.rows, c->mat.cols, CV_8UC3, image->image.data, (size_t)image->image.stride);
	c->mat.copyTo(view);
	describe(c, c->source, frame);
	return 1;
}

} // namespace

int capture_open(struct capture **out, const struct capture_def *def, char *err, size_t err_size)
{
	*out = nullptr;
	struct capture *c = nullptr;
	try {
		c = new struct capture;
		int rc = open_source(c, def, err, err_size);
		if (rc < 0) {
			delete c;
			return rc;
		}
		*out = c;
		return 0;
	} catch (const std::exception &e) {
		delete c;
		return vision_fail(-EIO, err, err_size, "%s: %.100s", def->source, e.what());
	}
}

void capture_close(struct capture *capture)
{
	delete capture;
}

int capture_next(struct capture *capture, struct image_buffer *image, struct capture_frame *frame, char *err,
		 size_t err_size)
try {
	return capture->files.empty() ? next_video(capture, image, frame, err, err_size)
				      : next_image(capture, image, frame, err, err_size);
} catch (const std::exception &e) {
	return vision_fail(-EIO, err, err_size, "%s: %.100s", capture->source.c_str(), e.what());
}
