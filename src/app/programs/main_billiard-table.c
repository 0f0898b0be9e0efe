/* billiard-table: a virtual table in place of camera, table and player. CAMERA and TRUTH out; DRAW and ANIMATION are its light, PLAN what its player plays. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/clock.h"
#include "app/process/ball_message.h"
#include "app/planner/plan_check.h"
#include "app/light/animation.h"
#include "app/light/draw.h"
#include "app/planner/plan_message.h"
#include "app/virtual/player.h"
#include "app/config/position.h"
#include "app/process/process.h"
#include "app/light/render.h"
#include "app/virtual/table_camera.h"
#include "vision/image_io_cv.h"

struct virtual_process {
	struct process process;
	struct config config;
	struct virtual_table *table; /* owned */
	struct table_camera *camera; /* owned */
	struct render *render;	     /* owned: the projector's picture */
	struct image_buffer frame;
	struct byte_buffer jpeg;
	char name[BALL_MAX][BALL_NAME_SIZE];
	billiard_draw_list_t list;
	struct animation animation;
	bool lit; /* the camera has the light of list; false: draw it anew */
	billiard_plan_t plan;
	int64_t wanted_id; /* proposal on the table that was not played yet, 0 none */
	double wanted_at;  /* s, when it was first seen there */
	int64_t frames;
	int points;
	double work; /* s, of the last frame */
};

/* ---- the table as it is --------------------------------------------------------------------------------------------- */

static void publish_truth(struct virtual_process *p, int64_t utime, double now, bool moving)
{
	struct ball ball[BALL_MAX];
	billiard_table_state_t truth = {.utime = utime, .seq = p->frames, .calibration = 1, .moving = moving};
	player_balls(p->table, now, ball);
	for (int i = 0; i < p->table->count; i++)
		if (ball[i].phase != BALL_POTTED)
			ball_to_message(&truth.balls[truth.ball_count++], &ball[i], p->name[i], i + 1);
	bus_publish(p->process.bus, "TRUTH", &bus_table_state, &truth);
}

static void publish_frame(struct virtual_process *p, int64_t utime, double now)
{
	struct ball ball[BALL_MAX];
	char err[PROCESS_ERROR_SIZE];
	struct image *image = &p->frame.image;
	player_balls(p->table, now, ball);
	table_camera_render(p->camera, ball, p->table->count, (uint64_t)p->frames, image);
	if (image_encode_jpeg(image, p->config.virtual_table.jpeg_quality, &p->jpeg, err, sizeof err) < 0) {
		process_error(&p->process, "CAMERA: %s", err);
		return;
	}
	billiard_image_t message = {utime, p->frames, image->width, image->height, (int32_t)p->jpeg.size, p->jpeg.data};
	bus_publish(p->process.bus, "CAMERA", &bus_image, &message);
}

static void name_balls(struct virtual_process *p, const struct position *position)
{
	int number[COLOUR_COUNT] = {0};
	for (int i = 0; i < p->table->count; i++) {
		enum ball_colour colour = p->table->ball[i].colour;
		if (position)
			snprintf(p->name[i], sizeof p->name[i], "%s", position->name[i]);
		else
			snprintf(p->name[i], sizeof p->name[i], "%s%d", ball_colour_name(colour), ++number[colour]);
	}
}

/* The frame is over: the next one, with other errors of the player. */
static void rack_again(struct virtual_process *p)
{
	struct ball rack[BALL_MAX];
	player_rack(&p->config.table, rack);
	p->config.virtual_table.seed++;
	player_init(p->table, &p->config.table, &p->config.model, &p->config.virtual_table, p->config.infinity.rules,
		    rack, BALL_MAX);
	name_balls(p, NULL);
}

/* The end of a shot: what fell is said before the colours come back. */
static void end_shot(struct virtual_process *p, int64_t utime, double now)
{
	publish_truth(p, utime, now, true);
	if (!player_tick(p->table, now))
		return;
	p->points += p->table->result.points;
	if (player_is_done(p->table))
		rack_again(p);
	publish_truth(p, utime, now, false);
}

/* The player has looked at the proposal long enough. */
static void play_wanted(struct virtual_process *p, double now)
{
	char err[PROCESS_ERROR_SIZE];
	if (!p->wanted_id || p->table->running || p->plan.request_id != p->wanted_id ||
	    p->plan.status != PLAN_MESSAGE_OK || now - p->wanted_at < p->config.virtual_table.think_time)
		return;
	const billiard_plan_shot_t *s = &p->plan.entries[0].shots[0];
	struct shot shot = {s->angle, s->speed, s->side, s->follow, s->elevation};
	p->wanted_id = 0;
	if (player_play(p->table, &shot, now, err, sizeof err) < 0)
		process_error(&p->process, "shot refused: %s", err);
}

/* The projector's light as it is now. A standing picture is drawn once, a running animation each frame. */
static void light(struct virtual_process *p, double now)
{
	if (p->lit && !animation_runs(&p->animation))
		return;
	int width, height, stride;
	render_draw(p->render, &p->list, animation_is_shown(&p->animation) ? &p->animation.message : NULL,
		    animation_time(&p->animation, now));
	const uint32_t *pixels = render_pixels(p->render, &width, &height, &stride);
	table_camera_light(p->camera, pixels, width, height, stride);
	p->lit = true;
}

static int on_frame(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	struct virtual_process *p = context;
	double now = clock_seconds();
	int64_t utime = clock_utime();
	p->frames++;
	play_wanted(p, now);
	if (p->table->running)
		end_shot(p, utime, now);
	else
		publish_truth(p, utime, now, false);
	light(p, now);
	publish_frame(p, utime, now);
	p->work = clock_seconds() - now;
	return 0;
}

/* ---- light and proposals -------------------------------------------------------------------------------------------- */

/* Repeated each second: only a new picture is drawn anew. */
static bool same_picture(const billiard_draw_list_t *a, const billiard_draw_list_t *b)
{
	billiard_draw_list_t c = *a;
	c.utime = b->utime;
	c.seq = b->seq;
	return memcmp(&c, b, sizeof c) == 0;
}

static bool on_draw(void *context, const void *message)
{
	struct virtual_process *p = context;
	const billiard_draw_list_t *list = message;
	if (!draw_check(list))
		return false;
	if (list->plan_id != p->list.plan_id) {
		p->wanted_id = list->plan_id;
		p->wanted_at = clock_seconds();
	}
	if (same_picture(&p->list, list))
		return true;
	p->list = *list;
	p->lit = false;
	return true;
}

static bool on_animation(void *context, const void *message)
{
	struct virtual_process *p = context;
	bool changed, ok = animation_take(&p->animation, message, clock_seconds(), &changed);
	p->lit = p->lit && !changed;
	return ok;
}

static bool on_plan(void *context, const void *message)
{
	struct virtual_process *p = context;
	const billiard_plan_t *plan = message;
	if (!plan_check(plan, &p->config.table))
		return false;
	if (plan->status == PLAN_MESSAGE_OK)
		p->plan = *plan;
	return true;
}

static void describe(void *context, struct process *process)
{
	struct virtual_process *p = context;
	process_metric(process, "frames", "1", (double)p->frames);
	process_metric(process, "work", "ms", 1e3 * p->work);
	process_metric(process, "shots", "1", (double)p->table->shots);
	process_metric(process, "points", "1", p->points);
	process_state(process, p->table->running ? "moving" : "at rest");
}

/* ---- set-up --------------------------------------------------------------------------------------------------------- */

static int set_balls(struct virtual_process *p, const char *path, char *err, size_t err_size)
{
	struct position position = {0};
	const struct config *c = &p->config;
	if (path) {
		int r = position_read(&position, &c->table, path, err, err_size);
		if (r < 0)
			return r;
		if (position_cue(&position) < 0) {
			snprintf(err, err_size, "%s: no cue ball", path);
			return -EINVAL;
		}
	} else {
		char reason[160];
		player_rack(&c->table, position.ball);
		position.count = BALL_MAX;
		if (table_check_balls(&c->table, position.ball, BALL_MAX, &(int){0}, &(int){0}, reason, sizeof reason) <
		    0) {
			snprintf(err, err_size, "%.100s: table.spots: no opening position: %.100s", c->path, reason);
			return -EINVAL;
		}
	}
	player_init(p->table, &c->table, &c->model, &c->virtual_table, c->infinity.rules, position.ball,
		    position.count);
	name_balls(p, path ? &position : NULL);
	return 0;
}

static int create_parts(struct virtual_process *p, const struct process_options *options, char *err, size_t err_size)
{
	int r = -ENOMEM;
	p->table = calloc(1, sizeof *p->table);
	if (!p->table || image_buffer_reserve(&p->frame, p->config.camera.width, p->config.camera.height) < 0) {
		snprintf(err, err_size, "out of memory");
		return r;
	}
	if ((r = set_balls(p, options->position, err, err_size)) < 0 ||
	    (r = table_camera_create(&p->camera, &p->config, err, err_size)) < 0)
		return r;
	return render_create(&p->render, &p->config.projector, err, err_size);
}

static int setup(struct virtual_process *p, const struct process_options *options)
{
	char err[PROCESS_ERROR_SIZE] = "";
	int r = process_init(&p->process, "billiard-table", options, &p->config);
	if (r < 0)
		return r;
	uint64_t period = (uint64_t)(1e6 / p->config.virtual_table.frame_rate);
	if ((r = create_parts(p, options, err, sizeof err)) < 0 ||
	    (r = bus_subscribe(p->process.bus,
			       &(struct bus_subscription){"DRAW", &bus_draw_list, BUS_EACH, on_draw, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus, &(struct bus_subscription){"ANIMATION", &bus_animation, BUS_EACH,
									  on_animation, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus, &(struct bus_subscription){"PLAN", &bus_plan, BUS_EACH, on_plan, p})) <
		    0 ||
	    (r = process_every(&p->process, period, on_frame, p)) < 0) {
		fprintf(stderr, "billiard-table: %s\n", err[0] ? err : strerror(-r));
		return r;
	}
	p->process.describe = describe;
	p->process.context = p;
	return 0;
}

int main(int argc, char **argv)
{
	struct process_options options;
	int r = process_parse(&options, "billiard-table", argc, argv);
	if (r != 0)
		return r < 0 ? 2 : 0;
	struct virtual_process p = {0};
	int status = setup(&p, &options) < 0 ? 2 : process_run(&p.process);
	table_camera_destroy(p.camera);
	render_destroy(p.render);
	image_buffer_finish(&p.frame);
	byte_buffer_finish(&p.jpeg);
	process_finish(&p.process);
	free(p.table);
	return status;
}
