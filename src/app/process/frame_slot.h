/* The one place where a frame waits between the thread that reads frames and the loop that takes them. A live frame replaces one that still
 * waits, so that what is taken is never old; other frames wait until the former one was taken, so that none is lost. */
#ifndef BILLIARD_APP_FRAME_SLOT_H
#define BILLIARD_APP_FRAME_SLOT_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

#include "vision/image_io_cv.h"

struct frame_source_frame {
	struct image_buffer image; /* owned by the taker's struct; reused */
	int64_t utime;		   /* us, when it was taken */
	int64_t seq;
	char name[256];
};

struct frame_slot {
	pthread_mutex_t lock;	/* of all below, and of what the owner keeps beside it */
	pthread_cond_t changed; /* taken, or stop */
	bool stop, full;
	struct frame_source_frame frame; /* owned; waits when full, else a spare */
	int64_t frames, dropped;	 /* offered; replaced before they were taken */
};

void frame_slot_init(struct frame_slot *slot);
void frame_slot_finish(struct frame_slot *slot);

/* Puts a frame into the slot with its time and number; *frame gets a spare one back. False: stopped. Any thread. */
bool frame_slot_offer(struct frame_slot *slot, struct frame_source_frame *frame, bool live);
/* Swaps the waiting frame into *frame. False when none waits. */
bool frame_slot_take(struct frame_slot *slot, struct frame_source_frame *frame);
/* Waits for some seconds, but not past a stop. False: stopped. */
bool frame_slot_wait(struct frame_slot *slot, double seconds);
/* Nobody waits any more. */
void frame_slot_stop(struct frame_slot *slot);

#endif
