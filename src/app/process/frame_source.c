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

	pthread_mutex_t lock;	/* of all below */
	pthread_cond_t changed; /* slot taken, or stop */
	bool stop, full;
	struct frame_source_frame slot;
	struct frame_source_figures figures;
};

static void wake_loop(struct frame_source *s)
{
	uint64_t one = 1;
	if (write(s->descriptor, &one, sizeof one) < 0)
		return; /* full counter: the loop is awake anyway */
}

static struct timespec deadline_in(double seconds)
{
	struct timespec t;
	clock_gettime(CLOCK_MONOTONIC, &t);
	double whole = (double)t.tv_sec + 1e-9 * (double)t.tv_nsec + seconds;
	t.tv_sec = (time_t)whole;
	t.tv_nsec = (long)((whole - (double)t.tv_sec) * 1e9);
	return t;
}

/* Waits, but not past stop. False: stop. Locked. */
static bool wait_until(struct frame_source *s, const struct timespec *deadline)
{
	while (!s->stop && pthread_cond_timedwait(&s->changed, &s->lock, deadline) != ETIMEDOUT)
		;
	return !s->stop;
}

/* Puts a frame into the slot. A live source replaces a frame that still waits; files wait for the taker. False: stop. */
static bool offer(struct frame_source *s, struct frame_source_frame *frame, bool live)
{
	pthread_mutex_lock(&s->lock);
	while (s->full && !live && !s->stop)
		pthread_cond_wait(&s->changed, &s->lock);
	s->figures.dropped += s->full;
	struct frame_source_frame old = s->slot;
	frame->utime = clock_utime();
	frame->seq = ++s->figures.frames;
	s->slot = *frame;
	*frame = old;
	s->full = true;
	if (live)
		s->figures.error[0] = '\0'; /* the camera is back */
	bool go_on = !s->stop;
	pthread_mutex_unlock(&s->lock);
	wake_loop(s);
	return go_on;
}

static bool report(struct frame_source *s, const char *error, double wait)
{
	struct timespec until = deadline_in(wait);
	pthread_mutex_lock(&s->lock);
	snprintf(s->figures.error, sizeof s->figures.error, "%s", error);
	s->figures.bad++;
	wake_loop(s);
	bool go_on = wait > 0 ? wait_until(s, &until) : !s->stop;
	pthread_mutex_unlock(&s->lock);
	return go_on;
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
		struct timespec next = deadline_in(period);
		if (!copy_frame(frame, image, name))
			return report(s, "out of memory", 0);
		if (!offer(s, frame, false))
			return false;
		pthread_mutex_lock(&s->lock);
		bool go_on = wait_until(s, &next);
		pthread_mutex_unlock(&s->lock);
		if (!go_on)
			return false;
	}
	return true;
}

static void end(struct frame_source *s)
{
	pthread_mutex_lock(&s->lock);
	s->figures.ended = true;
	pthread_mutex_unlock(&s->lock);
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

static int init_locks(struct frame_source *s)
{
	pthread_condattr_t attributes;
	pthread_condattr_init(&attributes);
	pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
	pthread_mutex_init(&s->lock, NULL);
	pthread_cond_init(&s->changed, &attributes);
	pthread_condattr_destroy(&attributes);
	s->descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
	return s->descriptor < 0 ? -errno : 0;
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
	int r = init_locks(s);
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
		pthread_mutex_lock(&s->lock);
		s->stop = true;
		pthread_cond_broadcast(&s->changed);
		pthread_mutex_unlock(&s->lock);
		pthread_join(s->thread, NULL);
	}
	capture_close(s->capture);
	image_buffer_finish(&s->slot.image);
	if (s->descriptor >= 0)
		close(s->descriptor);
	pthread_cond_destroy(&s->changed);
	pthread_mutex_destroy(&s->lock);
	free(s);
}

int frame_source_descriptor(const struct frame_source *s)
{
	return s->descriptor;
}

bool frame_source_take(struct frame_source *s, struct frame_source_frame *frame)
{
	uint64_t drop;
	pthread_mutex_lock(&s->lock);
	bool any = s->full;
	if (read(s->descriptor, &drop, sizeof drop) < 0)
		drop = 0; /* nothing to reset */
	if (any) {
		struct frame_source_frame old = *frame;
		*frame = s->slot;
		s->slot = old;
		s->full = false;
		pthread_cond_broadcast(&s->changed);
	}
	pthread_mutex_unlock(&s->lock);
	return any;
}

void frame_source_figures(struct frame_source *s, struct frame_source_figures *out)
{
	pthread_mutex_lock(&s->lock);
	*out = s->figures;
	pthread_mutex_unlock(&s->lock);
}
