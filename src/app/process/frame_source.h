/* Frames from a camera, a video or a folder, read by a thread of its own so that the event loop never blocks. From a camera the newest
 * frame wins and the others are counted; from files no frame is lost. */
#ifndef BILLIARD_APP_FRAME_SOURCE_H
#define BILLIARD_APP_FRAME_SOURCE_H

#include <stdbool.h>
#include <stdint.h>

#include "app/process/frame_slot.h"

struct frame_source_def {
	const char *source; /* as capture_def.source */
	int width, height;  /* px, wanted from a camera */
	double fps;	    /* 1/s, pace of files; wanted from a camera */
	double hold;	    /* s each image of a folder is shown, again and again */
};

struct frame_source_figures {
	int64_t frames, dropped, bad; /* bad: photographs that are none, attempts to open a camera */
	bool ended;		      /* files: nothing more will come */
	char error[256];	      /* last one of files; of a camera the present one; empty none */
};

struct frame_source; /* opaque */
/* Starts the thread. A folder or file that cannot be opened is an error at once; a camera is tried again every second. 0, or a negative errno
 * with the reason. Caller destroys. */
int frame_source_create(struct frame_source **out, const struct frame_source_def *def, char *err, size_t err_size);
void frame_source_destroy(struct frame_source *source); /* NULL is fine; joins the thread */

/* Readable when a frame, an error or the end waits. */
int frame_source_descriptor(const struct frame_source *source);
/* Swaps the waiting frame into *frame. False when none waits. */
bool frame_source_take(struct frame_source *source, struct frame_source_frame *frame);
void frame_source_figures(struct frame_source *source, struct frame_source_figures *out);

#endif
