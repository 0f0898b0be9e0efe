#include "app/process/frame_source.h"

#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include "app/process/clock.h"
#include "app/process/process.h"
#include "vision/capture_cv.h"

static const double REOPEN_PERIOD = 1; /* s between tries to open a camera that went away */

struct frame_source {
	char source[256];
	struct capture_def def;
	double hold;
	bool is_folder;
	struct capture *capture; /* the thread's, NULL while the camera is away */
	pthread_t thread;
	bool thread_runs;
	int descriptor;

	struct frame_slot slot;
	struct frame_source_figures figures; /* under the slot's lock; but frames and dropped, which the slot counts */
};

static void wake_loop(struct frame_source *s)
{
	uint64_t one = 1;
	if (write(s->descriptor, &one, sizeof one) < 0)
		return; /* full counter: the loop is awake anyway */
}

static bool offer(struct frame_source *s, struct frame_source_frame *frame, bool live)
{
	bool go_on = frame_slot_offer(&s->slot, frame, live);
	wake_loop(s);
	return go_on;
}

/* error: "" when all is well again. */
static void set_error(struct frame_source *s, const char *error)
{
	pthread_mutex_lock(&s->slot.lock);
	snprintf(s->figures.error, sizeof s->figures.error, "%s", error);
	s->figures.bad += error[0] != '\0';
	pthread_mutex_unlock(&s->slot.lock);
}

/* False: stop. */
static bool report(struct frame_source *s, const char *error, double wait)
{
	set_error(s, error);
	wake_loop(s);
	return frame_slot_wait(&s->slot, wait);
}

/* Copies pixels: the same photograph is shown again and again. */
static bool copy_frame(struct frame_source_frame *to, const struct image_buffer *from, const char *name)
{
	const struct image *i = &from->image;
	if (image_buffer_reserve(&to->image, i->width, i->height) < 0)
		return false;
	for (int y = 0; y < i->height; y++)
		memcpy(to->image.image.data + y * to->image.image.stride, i->data + y * i->stride,
		       3 * (size_t)i->width);
	snprintf(to->name, sizeof to->name, "%s", name);
	return true;
}

/* Shows one image as often as the pace and the holding time say. False: stop. */
static bool show(struct frame_source *s, struct frame_source_frame *frame, const struct image_buffer *image,
		 const char *name)
{
	double period = 1 / s->def.fps;
	int times = s->is_folder && s->hold > period ? (int)(s->hold / period + 0.5) : 1;
	for (int i = 0; i < times; i++) {
		double next = clock_seconds() + period;
		if (!copy_frame(frame, image, name))
			return report(s, "out of memory", 0);
		if (!offer(s, frame, false))
			return false;
		if (!frame_slot_wait(&s->slot, next - clock_seconds()))
			return false;
	}
	return true;
}

static void end(struct frame_source *s)
{
	pthread_mutex_lock(&s->slot.lock);
	s->figures.ended = true;
	pthread_mutex_unlock(&s->slot.lock);
	wake_loop(s);
}

static void read_files(struct frame_source *s)
{
	struct frame_source_frame frame = {0};
	struct image_buffer image = {0};
	struct capture_frame info;
	char err[256];
	int r = 1;
	bool go_on = true;
	while (go_on && r != 0) {
		r = capture_next(s->capture, &image, &info, err, sizeof err);
		if (r < 0)
			go_on = report(s, err, 0);
		else if (r > 0)
			go_on = show(s, &frame, &image, info.name);
	}
	image_buffer_finish(&frame.image);
	image_buffer_finish(&image);
	end(s);
}

static void read_camera(struct frame_source *s)
{
	struct frame_source_frame frame = {0};
	struct capture_frame info;
	char err[256];
	bool go_on = true;
	while (go_on) {
		if (!s->capture && capture_open(&s->capture, &s->def, err, sizeof err) < 0) {
			go_on = report(s, err, REOPEN_PERIOD);
			continue;
		}
		int r = capture_next(s->capture, &frame.image, &info, err, sizeof err);
		if (r > 0) {
			snprintf(frame.name, sizeof frame.name, "%s", info.name);
			set_error(s, "");
			go_on = offer(s, &frame, true);
			continue;
		}
		if (r == 0)
			snprintf(err, sizeof err, "%.200s: no more frames", s->source);
		capture_close(s->capture);
		s->capture = NULL;
		go_on = report(s, err, REOPEN_PERIOD);
	}
	image_buffer_finish(&frame.image);
}

static void *source_thread(void *context)
{
	struct frame_source *s = context;
	if (strncmp(s->source, "v4l2:", 5) == 0)
		read_camera(s);
	else
		read_files(s);
	return NULL;
}

int frame_source_create(struct frame_source **out, const struct frame_source_def *def, char *err, size_t err_size)
{
	*out = NULL;
	struct frame_source *s = calloc(1, sizeof *s);
	if (!s) {
		snprintf(err, err_size, "out of memory");
		return -ENOMEM;
	}
	snprintf(s->source, sizeof s->source, "%s", def->source);
	s->def = (struct capture_def){s->source, def->width, def->height, def->fps};
	s->hold = def->hold;
	s->is_folder = strncmp(s->source, "dir:", 4) == 0;
	frame_slot_init(&s->slot);
	s->descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
	int r = s->descriptor < 0 ? -errno : 0;
	if (r < 0)
		snprintf(err, err_size, "%s: %s", s->source, strerror(-r));
	else if (strncmp(s->source, "v4l2:", 5) != 0)
		r = capture_open(&s->capture, &s->def, err, err_size);
	if (r == 0 && (r = -pthread_create(&s->thread, NULL, source_thread, s)) < 0)
		snprintf(err, err_size, "%s: no thread: %s", s->source, strerror(-r));
	if (r < 0) {
		frame_source_destroy(s);
		return r;
	}
	s->thread_runs = true;
	*out = s;
	return 0;
}

void frame_source_destroy(struct frame_source *s)
{
	if (!s)
		return;
	if (s->thread_runs) {
		frame_slot_stop(&s->slot);
		pthread_join(s->thread, NULL);
	}
	capture_close(s->capture);
	if (s->descriptor >= 0)
		close(s->descriptor);
	frame_slot_finish(&s->slot);
	free(s);
}

int frame_source_descriptor(const struct frame_source *s)
{
	return s->descriptor;
}

bool frame_source_take(struct frame_source *s, struct frame_source_frame *frame)
{
	uint64_t drop;
	if (read(s->descriptor, &drop, sizeof drop) < 0)
		drop = 0; /* nothing to reset */
	return frame_slot_take(&s->slot, frame);
}

void frame_source_figures(struct frame_source *s, struct frame_source_figures *out)
{
	pthread_mutex_lock(&s->slot.lock);
	*out = s->figures;
	out->frames = s->slot.frames;
	out->dropped = s->slot.dropped;
	pthread_mutex_unlock(&s->slot.lock);
}
