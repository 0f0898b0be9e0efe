/* billiard-infinity: the controller. Thinks in controller.c; here is the bus around it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/config/save.h"
#include "app/config/text_file.h"
#include "app/control/controller.h"
#include "app/process/process.h"

enum { TICK_US = 50000, REPEAT_US = 500000, LEASE_US = 250000 };
enum { GAME_FILE_SIZE = 4096 };
static const double LEASE = 0.9; /* s a picture is true after the last word from here */

struct infinity {
	struct process process;
	struct config config;
	struct controller controller;
	int64_t draw_seq;
	char game_path[CONFIG_PATH_MAX]; /* empty: the game is not kept over a restart */
};

static double now(void)
{
	return clock_seconds();
}

static void send_draw(struct infinity *p)
{
	p->controller.draw.utime = clock_utime();
	p->controller.draw.seq = ++p->draw_seq;
	bus_publish(p->process.bus, "DRAW", &bus_draw_list, &p->controller.draw);
}

static void send_lease(struct infinity *p)
{
	billiard_lease_t lease = {.utime = clock_utime(), .seq = p->draw_seq, .seconds = LEASE};
	bus_publish(p->process.bus, "LEASE", &bus_lease, &lease);
}

static void send_animation(struct infinity *p)
{
	bus_publish(p->process.bus, "ANIMATION", &bus_animation, &p->controller.animation);
}

/* What is kept of the game, for everybody and for the next infinity. */
static void send_game(struct infinity *p)
{
	billiard_game_t game = {.utime = clock_utime()};
	keeper_report(&p->controller.keeper, &game);
	bus_publish(p->process.bus, "GAME", &bus_game, &game);
}

/* ---- the game over a restart ------------------------------------------------------------------------------------------ */

static void save_game(struct infinity *p)
{
	char text[GAME_FILE_SIZE], err[PROCESS_ERROR_SIZE];
	if (p->game_path[0] && game_write(&p->controller.keeper.game, text, sizeof text) &&
	    save_file(p->game_path, text, strlen(text), err, sizeof err) < 0)
		process_error(&p->process, "%s", err);
}

static void find_game(struct infinity *p)
{
	const char *folder = getenv("STATE_DIRECTORY");
	if (p->config.infinity.game_file[0])
		snprintf(p->game_path, sizeof p->game_path, "%s", p->config.infinity.game_file);
	else if (folder && strlen(folder) < sizeof p->game_path - 8)
		snprintf(p->game_path, sizeof p->game_path, "%.*s/game", (int)sizeof p->game_path - 8, folder);
}

/* A file that is not there, or holds no game, is no error: a game begins. */
static void load_game(struct infinity *p)
{
	char *text, err[PROCESS_ERROR_SIZE];
	size_t size;
	struct game game;
	find_game(p);
	if (!p->game_path[0] || text_file_read(p->game_path, GAME_FILE_SIZE, &text, &size, err, sizeof err) < 0)
		return;
	if (game_read(&game, text))
		keeper_restore(&p->controller.keeper, &game);
	free(text);
}

static void send_cancel(struct infinity *p, int64_t id)
{
	char text[32];
	billiard_command_t command = {.utime = clock_utime()};
	snprintf(text, sizeof text, "%lld", (long long)id);
	text_set(command.name, sizeof command.name, "cancel");
	text_set(command.target, sizeof command.target, "billiard-planner");
	text_set(command.argument, sizeof command.argument, text);
	bus_publish(p->process.bus, "COMMAND", &bus_command, &command);
}

/* Sends what the controller wants sent, in the order that keeps the table dark while it plans. */
static void flush(struct infinity *p)
{
	struct controller_output out = p->controller.output;
	p->controller.output = (struct controller_output){0};
	if (out.cancel)
		send_cancel(p, out.cancel_id);
	if (out.request) {
		p->controller.request.utime = clock_utime();
		bus_publish(p->process.bus, "PLAN_REQUEST", &bus_plan_request, &p->controller.request);
	}
	if (out.stability)
		bus_publish(p->process.bus, "STABILITY", &bus_stability, &p->controller.report);
	if (out.game) {
		send_game(p);
		save_game(p);
	}
	if (out.draw)
		send_draw(p);
	if (out.animation) {
		p->controller.animation.utime = clock_utime();
		send_animation(p);
	}
	process_state(&p->process, "%s", fsm_state_name(p->controller.fsm.state));
}

static bool on_doubt(void *context, const void *message)
{
	struct infinity *p = context;
	controller_doubt(&p->controller, message);
	return true;
}

static bool on_table_state(void *context, const void *message)
{
	struct infinity *p = context;
	bool ok = controller_state(&p->controller, message, now());
	flush(p);
	return ok;
}

static bool on_plan(void *context, const void *message)
{
	struct infinity *p = context;
	bool ok = controller_plan(&p->controller, message, now());
	flush(p);
	return ok;
}

static bool on_command(void *context, const void *message)
{
	struct infinity *p = context;
	bool ok = controller_command(&p->controller, message, now());
	flush(p);
	return ok;
}

static int on_tick(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	struct infinity *p = context;
	controller_tick(&p->controller, now());
	flush(p);
	return 0;
}

static int on_lease(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	send_lease(context);
	return 0;
}

static int on_repeat(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	struct infinity *p = context;
	send_draw(p);
	send_animation(p);
	if (p->config.infinity.rules && p->controller.keeper.game.begun)
		send_game(p);
	return 0;
}

static void describe(void *context, struct process *process)
{
	struct infinity *p = context;
	process_metric(process, "proposals", "1", (double)p->controller.proposals);
	process_metric(process, "balls", "1", p->controller.seen.count);
}

static int setup(struct infinity *p, const struct process_options *options)
{
	int r = process_init(&p->process, "billiard-infinity", options, &p->config);
	if (r < 0)
		return r;
	controller_init(&p->controller, &p->config);
	load_game(p);
	p->process.describe = describe;
	p->process.context = p;
	if ((r = bus_subscribe(p->process.bus, &(struct bus_subscription){"TABLE_DOUBT", &bus_vision_doubt, BUS_EACH,
									  on_doubt, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus, &(struct bus_subscription){"TABLE_STATE", &bus_table_state, BUS_EACH,
									  on_table_state, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus, &(struct bus_subscription){"PLAN", &bus_plan, BUS_EACH, on_plan, p})) <
		    0 ||
	    (r = bus_subscribe(p->process.bus,
			       &(struct bus_subscription){"COMMAND", &bus_command, BUS_EACH, on_command, p})) < 0 ||
	    (r = process_every(&p->process, TICK_US, on_tick, p)) < 0 ||
	    (r = process_every(&p->process, LEASE_US, on_lease, p)) < 0 ||
	    (r = process_every(&p->process, REPEAT_US, on_repeat, p)) < 0)
		fprintf(stderr, "billiard-infinity: %s\n", strerror(-r));
	return r;
}

int main(int argc, char **argv)
{
	struct process_options options;
	int r = process_parse(&options, "billiard-infinity", argc, argv);
	if (r != 0)
		return r < 0 ? 2 : 0;
	struct infinity p = {0};
	int status = setup(&p, &options) < 0 ? 2 : process_run(&p.process);
	process_finish(&p.process);
	return status;
}
