/* billiard-vision: frames in, TABLE_STATE out. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/process/ball_message.h"
#include "app/config/colour_file.h"
#include "app/process/frame_source.h"
#include "app/process/process.h"
#include "vision/vision.h"

static const double FILE_FPS = 10, CAMERA_FPS = 30; /* 1/s */
static const char CHANNEL_CHARACTERS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
enum { DARK_FRAMES = 6 };	 /* more than the controller forgives */
static const double SILENCE = 1; /* s without a frame until the table counts as unseen */
enum { JPEG_QUALITY = 92, SOURCE_TICK_US = 500000, LATENCY_US = 500000 };

struct vision_process {
	struct process process;
	struct config config;
	struct colour_model colours;
	struct vision *vision;
	struct frame_source *source; /* NULL: frames come from the bus */
	struct frame_source_frame frame;
	struct byte_buffer jpeg;
	struct vision_result result;
	billiard_table_state_t state;
	billiard_vision_doubt_t doubt;
	int64_t last_camera; /* us, of the last CAMERA message */
	int64_t last_frame;  /* us, of the last frame, by the source's clock */
	double last_arrival; /* s, monotonic, when it came */
	int64_t frames, bad;
	bool folder;	      /* source is a folder of photographs */
	char picture[256];    /* the photograph shown */
	int dark;	      /* frames until it is looked at */
	double rate;	      /* 1/s, smoothed */
	double latency, work; /* s, of the last frame */
};

/* ---- one frame ------------------------------------------------------------------------------------------------------ */

/* The most certain balls first, as far as the message has room. */
static void fill_balls(billiard_table_state_t *out, billiard_vision_doubt_t *doubt, const struct vision_result *result)
{
	bool taken[VISION_BALL_MAX] = {false};
	for (out->ball_count = 0; out->ball_count < BALL_MAX && out->ball_count < result->ball_count;
	     out->ball_count++) {
		int best = -1;
		for (int i = 0; i < result->ball_count; i++)
			if (!taken[i] && (best < 0 || result->ball[i].confidence > result->ball[best].confidence))
				best = i;
		taken[best] = true;
		const struct vision_ball *b = &result->ball[best];
		struct ball ball = ball_at(b->colour, b->pos);
		ball.vel = b->vel;
		billiard_ball_t *message = &out->balls[out->ball_count];
		ball_to_message(message, &ball, "", b->track);
		message->confidence = b->confidence;
		doubt->ball_doubt[out->ball_count] = (int8_t)b->doubt;
		doubt->certainty[out->ball_count] = b->certainty;
		doubt->place[out->ball_count] = b->place;
	}
}

static void publish_state(struct vision_process *p, int64_t utime, int64_t seq)
{
	billiard_table_state_t *s = &p->state;
	*s = (billiard_table_state_t){
		.utime = utime,
		.seq = seq,
		.latency_us = clock_utime() - utime,
		.calibration = (int8_t)p->result.calibration,
		.occluded = p->result.occluded,
		.markers = p->result.markers_seen,
		.residual_px = p->result.residual_px,
	};
	text_set(s->reason, sizeof s->reason, p->result.reason);
	p->doubt = (billiard_vision_doubt_t){.utime = utime, .doubt = (int8_t)p->result.doubt};
	fill_balls(s, &p->doubt, &p->result);
	p->doubt.ball_count = s->ball_count;
	bus_publish(p->process.bus, "TABLE_DOUBT", &bus_vision_doubt, &p->doubt);
	bus_publish(p->process.bus, "TABLE_STATE", &bus_table_state, s);
	p->latency = 1e-6 * (double)s->latency_us;
}

static void see(struct vision_process *p, const struct image *frame, int64_t utime, int64_t seq)
{
	char err[PROCESS_ERROR_SIZE];
	double begin = clock_seconds();
	int r = vision_track(p->vision, frame, 1e-6 * (double)utime, &p->result, err, sizeof err);
	p->work = clock_seconds() - begin;
	if (r < 0) {
		p->bad++;
		p->result = (struct vision_result){.calibration = CALIBRATION_NONE};
		snprintf(p->result.reason, sizeof p->result.reason, "%.90s", err);
		process_error(&p->process, "%s", err);
	}
	publish_state(p, utime, seq);
	if (p->last_frame && utime > p->last_frame)
		p->rate += 0.1 * (1e6 / (double)(utime - p->last_frame) - p->rate);
	p->last_frame = utime;
	p->last_arrival = clock_seconds();
	p->frames++;
	if (p->result.calibration == CALIBRATION_NONE)
		process_state(&p->process, "not calibrated");
	else if (!p->folder)
		process_state(&p->process, p->result.occluded ? "occluded" : "running");
}

/* ---- frames from the bus -------------------------------------------------------------------------------------------- */

static bool on_camera(void *context, const void *message)
{
	struct vision_process *p = context;
	const billiard_image_t *image = message;
	char err[PROCESS_ERROR_SIZE];
	if (image_decode(image->data, (size_t)image->size, &p->frame.image, err, sizeof err) < 0) {
		p->bad++;
		process_error(&p->process, "CAMERA: %s", err);
		return false;
	}
	see(p, &p->frame.image.image, image->utime, image->seq);
	return true;
}

/* ---- frames from a source ------------------------------------------------------------------------------------------- */

/* Puts the frame on the bus for recordings and onlookers, at most camera_rate times a second. */
static void publish_camera(struct vision_process *p)
{
	char err[PROCESS_ERROR_SIZE];
	double rate = p->config.camera_rate;
	const struct image *frame = &p->frame.image.image;
	double since = 1e-6 * (double)(p->frame.utime - p->last_camera);
	/* A clock that was set back does not stop them. */
	if (rate <= 0 || (since >= 0 && since < 0.99 / rate))
		return;
	p->last_camera = p->frame.utime;
	if (image_encode_jpeg(frame, JPEG_QUALITY, &p->jpeg, err, sizeof err) < 0) {
		process_error(&p->process, "CAMERA: %s", err);
		return;
	}
	billiard_image_t message = {p->frame.utime, p->frame.seq,	   frame->width,
				    frame->height,  (int32_t)p->jpeg.size, p->jpeg.data};
	bus_publish(p->process.bus, "CAMERA", &bus_image, &message);
}

/* A new photograph of a folder shows another table: a dark moment, so that nothing of the former one is kept. */
static bool is_dark(struct vision_process *p)
{
	if (!p->folder)
		return false;
	if (strcmp(p->picture, p->frame.name) != 0) {
		snprintf(p->picture, sizeof p->picture, "%s", p->frame.name);
		vision_reset(p->vision);
		p->dark = DARK_FRAMES;
	}
	return p->dark > 0 && p->dark-- > 0;
}

static void show_dark(struct vision_process *p)
{
	p->result = (struct vision_result){.calibration = CALIBRATION_NONE, .reason = "next photograph"};
	publish_state(p, p->frame.utime, p->frame.seq);
	p->last_frame = p->frame.utime;
	p->last_arrival = clock_seconds();
	const char *slash = strrchr(p->picture, '/');
	process_state(&p->process, "photo %s", slash ? slash + 1 : p->picture);
}

static int on_source(sd_event_source *event, int fd, uint32_t events, void *context)
{
	(void)event, (void)fd, (void)events;
	struct vision_process *p = context;
	struct frame_source_figures f;
	if (frame_source_take(p->source, &p->frame)) {
		if (is_dark(p))
			show_dark(p);
		else
			see(p, &p->frame.image.image, p->frame.utime, p->frame.seq);
		publish_camera(p);
	}
	frame_source_figures(p->source, &f);
	if (f.error[0])
		process_error(&p->process, "%s", f.error);
	if (f.ended)
		process_state(&p->process, "end of source");
	return 0;
}

/* A source that gives no frames: the others must know that what they have is old. */
static int on_silence(sd_event_source *event, uint64_t usec, void *context)
{
	(void)event, (void)usec;
	struct vision_process *p = context;
	struct frame_source_figures f = {0};
	double silent = clock_seconds() - p->last_arrival;
	if (silent < SILENCE)
		return 0;
	if (p->source)
		frame_source_figures(p->source, &f);
	if (f.ended)
		return 0;
	p->rate = 0;
	p->result = (struct vision_result){.calibration = CALIBRATION_NONE};
	snprintf(p->result.reason, sizeof p->result.reason, "no frames: %.70s",
		 f.error[0] ? f.error : "the source is silent");
	process_state(&p->process, "no frames");
	/* In the source's clock: a replayed recording has its own. */
	int64_t utime = p->last_frame ? p->last_frame + (int64_t)(1e6 * silent) : clock_utime();
	utime -= LATENCY_US; /* a frame under way must not count as older */
	publish_state(p, utime, 0);
	return 0;
}

static void describe(void *context, struct process *process)
{
	struct vision_process *p = context;
	struct frame_source_figures f = {0};
	if (p->source)
		frame_source_figures(p->source, &f);
	process_metric(process, "frames", "1", (double)p->frames);
	process_metric(process, "rate", "1/s", p->rate);
	process_metric(process, "latency", "ms", 1e3 * p->latency);
	process_metric(process, "work", "ms", 1e3 * p->work);
	process_metric(process, "dropped", "1", (double)f.dropped);
	process_metric(process, "bad", "1", (double)(p->bad + f.bad));
	process_metric(process, "ended", "1", f.ended);
	process_metric(process, "balls", "1", p->result.ball_count);
	process_metric(process, "residual", "px", p->result.residual_px);
	process_metric(process, "pose age", "s", p->result.pose_age);
}

/* ---- set-up --------------------------------------------------------------------------------------------------------- */

static int open_source(struct vision_process *p, const struct process_options *options, char *err, size_t err_size)
{
	const char *source = options->source ? options->source : p->config.source;
	if (strncmp(source, "lcm:", 4) == 0) {
		/* LCM takes regular expressions: more than one camera at a time makes no sense. */
		const char *channel = source + 4;
		if (!channel[0] || strlen(channel) > 60 || strspn(channel, CHANNEL_CHARACTERS) != strlen(channel)) {
			snprintf(err, err_size, "source: \"%.64s\" names no channel", source);
			return -EINVAL;
		}
		return bus_subscribe(p->process.bus,
				     &(struct bus_subscription){source + 4, &bus_image, BUS_LATEST, on_camera, p});
	}
	struct frame_source_def def = {source, p->config.camera.width, p->config.camera.height, FILE_FPS,
				       options->hold};
	if (strncmp(source, "v4l2:", 5) == 0)
		def.fps = CAMERA_FPS;
	p->folder = strncmp(source, "dir:", 4) == 0;
	int r = frame_source_create(&p->source, &def, err, err_size);
	return r < 0 ? r
		     : sd_event_add_io(p->process.event, NULL, frame_source_descriptor(p->source), EPOLLIN, on_source,
				       p);
}

static int create_vision(struct vision_process *p, char *err, size_t err_size)
{
	int r = colour_file_read(p->config.colours, &p->colours, err, err_size);
	if (r < 0)
		return r;
	struct vision_def def = config_vision_def(&p->config, &p->colours);
	return vision_create(&p->vision, &def, err, err_size);
}

static int setup(struct vision_process *p, const struct process_options *options)
{
	char err[PROCESS_ERROR_SIZE] = "";
	int r = process_init(&p->process, "billiard-vision", options, &p->config);
	if (r < 0)
		return r;
	p->process.describe = describe;
	p->process.context = p;
	if ((r = create_vision(p, err, sizeof err)) < 0 || (r = open_source(p, options, err, sizeof err)) < 0 ||
	    (r = process_every(&p->process, SOURCE_TICK_US, on_silence, p)) < 0)
		fprintf(stderr, "billiard-vision: %s\n", err[0] ? err : strerror(-r));
	return r;
}

int main(int argc, char **argv)
{
	struct process_options options;
	int r = process_parse(&options, "billiard-vision", argc, argv);
	if (r != 0)
		return r < 0 ? 2 : 0;
	struct vision_process p = {0};
	int status = setup(&p, &options) < 0 ? 2 : process_run(&p.process);
	frame_source_destroy(p.source);
	vision_destroy(p.vision);
	image_buffer_finish(&p.frame.image);
	byte_buffer_finish(&p.jpeg);
	process_finish(&p.process);
	return status;
}
