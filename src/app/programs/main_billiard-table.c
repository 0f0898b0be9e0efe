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
#include "app/light/lease.h"
#include "app/planner/plan_message.h"
#include "app/virtual/drawn_shot.h"
#include "app/virtual/habits.h"
#include "app/virtual/player.h"
#include "app/virtual/sensor_faults.h"
#include "app/config/position.h"
#include "app/process/process.h"
#include "app/process/text.h"
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
	struct lease lease;
	bool lapsed;		  /* the light is the notice that nobody vouches for a picture */
	bool lit;		  /* the camera has the light of list; false: draw it anew */
	struct drawn_shot *drawn; /* owned: the answers of the planner */
	struct habits habits;
	bool placing;	 /* a hand puts down a ball */
	vec2 placing_at; /* m */
	struct sensor_faults faults;
	struct byte_buffer late; /* the newest frame that is held back */
	int64_t late_utime;	 /* us, 0 none */
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

/* ---- the sensor ----------------------------------------------------------------------------------------------------- */

static bool holds(const struct virtual_process *p, enum sensor_fault fault, double now)
{
	return sensor_faults_hold(&p->faults, fault, now);
}

static void send_jpeg(struct virtual_process *p, const struct byte_buffer *jpeg, int64_t utime)
{
	const struct image *image = &p->frame.image;
	billiard_image_t message = {utime, p->frames, image->width, image->height, (int32_t)jpeg->size, jpeg->data};
	if (jpeg->size > 0)
		bus_publish(p->process.bus, "CAMERA", &bus_image, &message);
}

static void flip_bits(struct virtual_process *p)
{
	uint64_t r = sensor_faults_random(&p->faults, FAULT_BITS) ^ (uint64_t)p->frames * 0x9e3779b97f4a7c15u;
	for (int i = 0; i < 4 && p->jpeg.size > 4; i++, r = r * 6364136223846793005u + 1442695040888963407u)
		p->jpeg.data[2 + (r >> 16) % (p->jpeg.size - 4)] ^= (uint8_t)(1u << (r >> 61));
}

/* The balls that the camera sees: one more, or one less. */
static int seen_balls(const struct virtual_process *p, double now, struct ball out[BALL_MAX + 1])
{
	int n = p->table->count;
	player_balls(p->table, now, out);
	if (holds(p, FAULT_MISSING, now))
		out[sensor_faults_random(&p->faults, FAULT_MISSING) % (uint64_t)n].phase = BALL_POTTED;
	if (!holds(p, FAULT_GHOST, now))
		return n;
	uint64_t r = sensor_faults_random(&p->faults, FAULT_GHOST);
	const struct table *t = &p->config.table;
	vec2 at = {((double)(r >> 40) * 0x1p-24 - 0.5) * 0.9 * t->length,
		   ((double)(r >> 16 & 0xffffff) * 0x1p-24 - 0.5) * 0.9 * t->width};
	struct ball ghost = ball_at((enum ball_colour)(1 + r % 7), at);
	for (int i = 0; i < n; i++)
		if (out[i].phase == BALL_POTTED) {
			out[i] = ghost;
			return n;
		}
	if (n < BALL_MAX)
		out[n++] = ghost;
	return n;
}

static struct habits_view view_of(const struct virtual_process *p)
{
	return (struct habits_view){.ball = p->table->ball,
				    .count = p->table->count,
				    .at_rest = !p->table->running && !p->placing,
				    .placing = p->placing ? &p->placing_at : NULL};
}

static void disturb(struct virtual_process *p, double now)
{
	struct habits_view view = view_of(p);
	struct table_disturbance d = {.arm = habits_arm(&p->habits, &view, now), .gain = 1};
	if (holds(p, FAULT_DARK, now))
		d.gain = 0.125;
	if (holds(p, FAULT_BRIGHT, now))
		d.gain = 3;
	if (holds(p, FAULT_FLASH, now))
		d.gain = 32;
	if (holds(p, FAULT_KNOCK, now)) {
		uint64_t r = sensor_faults_random(&p->faults, FAULT_KNOCK);
		d.shift_x = (int)(r % 17) - 8;
		d.shift_y = (int)(r / 17 % 17) - 8;
	}
	table_camera_disturb(p->camera, &d);
}

/* False when there is no picture. */
static bool take_picture(struct virtual_process *p, double now)
{
	struct ball ball[BALL_MAX + 1];
	char err[PROCESS_ERROR_SIZE];
	int count = seen_balls(p, now, ball);
	disturb(p, now);
	table_camera_render(p->camera, ball, count, (uint64_t)p->frames, &p->frame.image);
	if (image_encode_jpeg(&p->frame.image, p->config.virtual_table.jpeg_quality, &p->jpeg, err, sizeof err) == 0)
		return true;
	process_error(&p->process, "CAMERA: %s", err);
	return false;
}

/* What comes too late keeps its time. */
static void hold_back(struct virtual_process *p, int64_t utime)
{
	struct byte_buffer jpeg = p->late;
	p->late = p->jpeg;
	p->jpeg = jpeg;
	p->late_utime = utime;
}

static void publish_frame(struct virtual_process *p, int64_t utime, double now)
{
	sensor_faults_frame(&p->faults, (uint64_t)p->frames, now);
	bool late = holds(p, FAULT_LATE, now);
	if (p->late_utime && !late) {
		send_jpeg(p, &p->late, p->late_utime);
		p->late_utime = 0;
	}
	if (holds(p, FAULT_DROP, now))
		return;
	bool frozen = holds(p, FAULT_FREEZE, now) && p->jpeg.size > 0;
	if (!frozen && !take_picture(p, now))
		return;
	if (holds(p, FAULT_BITS, now) && !frozen)
		flip_bits(p);
	if (late) {
		hold_back(p, utime);
		return;
	}
	send_jpeg(p, &p->jpeg, utime);
	if (holds(p, FAULT_REPEAT, now))
		send_jpeg(p, &p->jpeg, utime);
}

/* ---- the player ----------------------------------------------------------------------------------------------------- */

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

/* The state of the game is told when it changes: the judge goes by it. */
static void describe(void *context, struct process *process)
{
	struct virtual_process *p = context;
	process_metric(process, "frames", "1", (double)p->frames);
	process_metric(process, "work", "ms", 1e3 * p->work);
	process_metric(process, "shots", "1", (double)p->table->shots);
	process_metric(process, "moving", "1", p->table->running);
	process_metric(process, "ball on", "1", p->table->state.on);
	process_metric(process, "in hand", "1", p->table->state.in_hand);
	process_metric(process, "points", "1", p->points);
	process_state(process, p->table->running ? "moving" : "at rest");
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
	describe(p, &p->process);
}

/* What the player sees and does. */
static void play(struct virtual_process *p, double now)
{
	char err[PROCESS_ERROR_SIZE];
	p->placing = player_place(p->table, now, &p->placing_at);
	struct habits_view view = view_of(p);
	const billiard_animation_t *animation = animation_is_shown(&p->animation) ? &p->animation.message : NULL;
	if (p->list.plan_id && drawn_shot_find(p->drawn, p->list.plan_id, animation, &view.shot))
		view.proposal = p->list.plan_id;
	struct habits_act act = habits_tick(&p->habits, &view, now);
	if (act.touched >= 0)
		player_touch(p->table, act.touched, act.to);
	if (!act.strike)
		return;
	if (player_play(p->table, &act.shot, now, err, sizeof err) < 0)
		process_error(&p->process, "shot refused: %s", err);
	describe(p, &p->process);
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

static bool on_lease(void *context, const void *message)
{
	struct virtual_process *p = context;
	lease_take(&p->lease, message, clock_seconds());
	return true;
}

/* Nobody vouches for the picture any more: it goes, and is not played. */
static void end_lease(struct virtual_process *p, double now)
{
	if (p->lapsed || !lease_is_over(&p->lease, now))
		return;
	lease_notice(&p->list, p->config.table.width);
	p->animation = (struct animation){0};
	p->lit = false;
	p->lapsed = true;
}

static int on_frame(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	struct virtual_process *p = context;
	double now = clock_seconds();
	int64_t utime = clock_utime();
	p->frames++;
	end_lease(p, now);
	play(p, now);
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
	lease_picture(&p->lease, list->seq, clock_seconds());
	p->lapsed = false;
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
		drawn_shot_plan(p->drawn, plan);
	return true;
}

/* "fault", with its name and its seconds: one of the sensor. */
static bool on_command(void *context, const void *message)
{
	struct virtual_process *p = context;
	const billiard_command_t *command = message;
	char name[sizeof command->name], argument[sizeof command->argument];
	text_get(name, sizeof name, command->name, sizeof command->name);
	text_get(argument, sizeof argument, command->argument, sizeof command->argument);
	if (!bus_is_for(command, "billiard-table") || strcmp(name, "fault") != 0)
		return true;
	return sensor_faults_command(&p->faults, argument, clock_seconds());
}

/* ---- set-up --------------------------------------------------------------------------------------------------------- */

static const char RANDOM[] = "random:";

/* The opening position, or a random one of the middle of a frame. */
static int own_position(const struct config *c, const char *text, struct position *out, char *err, size_t err_size)
{
	char reason[160], *rest;
	unsigned long long seed = text ? strtoull(text + strlen(RANDOM), &rest, 10) : 0;
	if (text && (rest == text + strlen(RANDOM) || *rest)) {
		snprintf(err, err_size, "--position: found \"%.60s\", allowed a file or random:SEED", text);
		return -EINVAL;
	}
	if (!text)
		player_rack(&c->table, out->ball);
	out->count = text ? player_scatter(&c->table, seed, out->ball) : BALL_MAX;
	if (table_check_balls(&c->table, out->ball, out->count, &(int){0}, &(int){0}, reason, sizeof reason) == 0)
		return 0;
	snprintf(err, err_size, "%.100s: table.spots: no opening position: %.100s", c->path, reason);
	return -EINVAL;
}

static int set_balls(struct virtual_process *p, const char *path, char *err, size_t err_size)
{
	struct position position = {0};
	const struct config *c = &p->config;
	bool own = !path || strncmp(path, RANDOM, strlen(RANDOM)) == 0;
	int r = own ? own_position(c, path, &position, err, err_size)
		    : position_read(&position, &c->table, path, err, err_size);
	if (r < 0)
		return r;
	if (!own && position_cue(&position) < 0) {
		snprintf(err, err_size, "%s: no cue ball", path);
		return -EINVAL;
	}
	player_init(p->table, &c->table, &c->model, &c->virtual_table, c->infinity.rules, position.ball,
		    position.count);
	habits_init(&p->habits, &c->table, &c->virtual_table);
	sensor_faults_init(&p->faults, &c->virtual_table, clock_seconds());
	name_balls(p, own ? NULL : &position);
	return 0;
}

static int create_parts(struct virtual_process *p, const struct process_options *options, char *err, size_t err_size)
{
	int r = -ENOMEM;
	p->table = calloc(1, sizeof *p->table);
	p->drawn = calloc(1, sizeof *p->drawn);
	if (!p->table || !p->drawn ||
	    image_buffer_reserve(&p->frame, p->config.camera.width, p->config.camera.height) < 0) {
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
	    (r = bus_subscribe(p->process.bus,
			       &(struct bus_subscription){"LEASE", &bus_lease, BUS_EACH, on_lease, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus, &(struct bus_subscription){"ANIMATION", &bus_animation, BUS_EACH,
									  on_animation, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus, &(struct bus_subscription){"PLAN", &bus_plan, BUS_EACH, on_plan, p})) <
		    0 ||
	    (r = bus_subscribe(p->process.bus,
			       &(struct bus_subscription){"COMMAND", &bus_command, BUS_EACH, on_command, p})) < 0 ||
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
	byte_buffer_finish(&p.late);
	process_finish(&p.process);
	free(p.table);
	free(p.drawn);
	return status;
}
