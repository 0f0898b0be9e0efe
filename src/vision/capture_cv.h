/* Frame sources: a camera, a video, a folder of images. OpenCV stays behind this header. */
#ifndef BILLIARD_VISION_CAPTURE_CV_H
#define BILLIARD_VISION_CAPTURE_CV_H

#include <stdbool.h>

#include "vision/image_io_cv.h"

#ifdef __cplusplus
extern "C" {
#endif

struct capture_def {
	const char
		*source; /* "v4l2:/dev/videoN", "dir:FOLDER" (images in natural number order), "file:VIDEO or IMAGE" */
	int width, height; /* px, wanted from a camera; 0: its own */
	double fps;	   /* wanted from a camera; frame rate given to a folder; 0: its own, 30 for a folder */
};

struct capture_frame {
	char name[256]; /* file the frame came from, or the source */
	int index;	/* 0, 1, ... */
	double time;	/* s since the first frame by the source's frame rate; a camera's is 0: take your clock's */
};

struct capture;
/* 0, -EINVAL (unknown source, empty folder), -ENOENT, -EIO with the reason in err. Caller closes. */
int capture_open(struct capture **out, const struct capture_def *def, char *err, size_t err_size);
void capture_close(struct capture *capture); /* NULL is fine */
/* Next frame into image: 1; 0 at the end; a negative errno with the reason (naming the file) in err. After an error of
 * a folder the next call goes on with the next file; a camera that fails must be closed and opened again (-EIO). A
 * video that ends before the length it announces gives -EBADMSG once. One thread at a time, any thread. */
int capture_next(struct capture *capture, struct image_buffer *image, struct capture_frame *frame, char *err,
		 size_t err_size);

#ifdef __cplusplus
}
#endif

#endif
