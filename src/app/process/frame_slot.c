#include "app/process/frame_slot.h"

#include <errno.h>
#include <time.h>

#include "app/process/clock.h"

void frame_slot_init(struct frame_slot *slot)
{
	pthread_condattr_t attributes;
	*slot = (struct frame_slot){0};
	pthread_condattr_init(&attributes);
	pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
	pthread_mutex_init(&slot->lock, NULL);
	pthread_cond_init(&slot->changed, &attributes);
	pthread_condattr_destroy(&attributes);
}

void frame_slot_finish(struct frame_slot *slot)
{
	image_buffer_finish(&slot->frame.image);
	pthread_cond_destroy(&slot->changed);
	pthread_mutex_destroy(&slot->lock);
}

bool frame_slot_offer(struct frame_slot *slot, struct frame_source_frame *frame, bool live)
{
	pthread_mutex_lock(&slot->lock);
	while (slot->full && !live && !slot->stop)
		pthread_cond_wait(&slot->changed, &slot->lock);
	slot->dropped += slot->full;
	struct frame_source_frame old = slot->frame;
	frame->utime = clock_utime();
	frame->seq = ++slot->frames;
	slot->frame = *frame;
	*frame = old;
	slot->full = true;
	bool go_on = !slot->stop;
	pthread_mutex_unlock(&slot->lock);
	return go_on;
}

bool frame_slot_take(struct frame_slot *slot, struct frame_source_frame *frame)
{
	pthread_mutex_lock(&slot->lock);
	bool any = slot->full;
	if (any) {
		struct frame_source_frame old = *frame;
		*frame = slot->frame;
		slot->frame = old;
		slot->full = false;
		pthread_cond_broadcast(&slot->changed);
	}
	pthread_mutex_unlock(&slot->lock);
	return any;
}

bool frame_slot_wait(struct frame_slot *slot, double seconds)
{
	double end = clock_seconds() + seconds;
	struct timespec deadline = {.tv_sec = (time_t)end, .tv_nsec = (long)((end - (double)(time_t)end) * 1e9)};
	pthread_mutex_lock(&slot->lock);
	while (!slot->stop && pthread_cond_timedwait(&slot->changed, &slot->lock, &deadline) != ETIMEDOUT)
		;
	bool go_on = !slot->stop;
	pthread_mutex_unlock(&slot->lock);
	return go_on;
}

void frame_slot_stop(struct frame_slot *slot)
{
	pthread_mutex_lock(&slot->lock);
	slot->stop = true;
	pthread_cond_broadcast(&slot->changed);
	pthread_mutex_unlock(&slot->lock);
}
