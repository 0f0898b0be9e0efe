/* billiard-projector: draws what DRAW and ANIMATION say, in table coordinates, and knows nothing of snooker. */
#include <stdio.h>
#include <string.h>

#include "app/process/text.h"
#include "app/process/clock.h"
#include "app/light/animation.h"
#include "app/light/draw.h"
#include "app/light/lease.h"
#include "app/process/process.h"
#include "app/light/render.h"
#include "app/light/window.h"

enum { FRAME_US = 33333 };

struct projector {
	struct process process;
	struct config config;
	struct render *render;
	struct window *window; /* NULL without a display */
	billiard_draw_list_t list;
	struct animation animation;
	struct lease lease;
	bool lapsed; /* what is shown is the notice that nobody vouches for a picture */
	bool dirty;
	int64_t pictures;
	double work; /* s, of the last picture */
};

/* ---- messages ------------------------------------------------------------------------------------------------------- */

static bool on_draw(void *context, const void *message)
{
	struct projector *p = context;
	const billiard_draw_list_t *list = message;
	if (!draw_check(list))
		return false;
	lease_picture(&p->lease, list->seq, clock_seconds());
	p->list = *list;
	p->lapsed = false;
	p->dirty = true;
	return true;
}

static bool on_lease(void *context, const void *message)
{
	struct projector *p = context;
	lease_take(&p->lease, message, clock_seconds());
	return true;
}

/* Nobody vouches for the picture any more: it goes, and the table says so. */
static void end_lease(struct projector *p, double now)
{
	if (p->lapsed || !lease_is_over(&p->lease, now))
		return;
	lease_notice(&p->list, p->config.table.width);
	p->animation = (struct animation){0};
	p->lapsed = p->dirty = true;
}

static bool on_animation(void *context, const void *message)
{
	struct projector *p = context;
	bool changed, ok = animation_take(&p->animation, message, clock_seconds(), &changed);
	p->dirty = p->dirty || changed;
	return ok;
}

static void snapshot(struct projector *p, const char *path)
{
	char err[PROCESS_ERROR_SIZE];
	/* The standing picture, without the animation: the same list gives the same bytes. */
	render_draw(p->render, &p->list, NULL, 0);
	p->dirty = true;
	if (render_write_png(p->render, path, err, sizeof err) < 0)
		process_error(&p->process, "snapshot: %s", err);
}

static bool on_command(void *context, const void *message)
{
	struct projector *p = context;
	const billiard_command_t *command = message;
	char name[sizeof command->name], argument[sizeof command->argument];
	text_get(name, sizeof name, command->name, sizeof command->name);
	text_get(argument, sizeof argument, command->argument, sizeof command->argument);
	if (strcmp(name, "snapshot") == 0 && argument[0] && bus_is_for(command, p->process.name))
		snapshot(p, argument);
	return true;
}

/* ---- pictures ------------------------------------------------------------------------------------------------------- */

static void send_command(struct projector *p, const char *name, const char *argument)
{
	billiard_command_t command = {.utime = clock_utime()};
	text_set(command.name, sizeof command.name, name);
	text_set(command.argument, sizeof command.argument, argument);
	bus_publish(p->process.bus, "COMMAND", &bus_command, &command);
}

static int on_frame(sd_event_source *source, uint64_t usec, void *context)
{
	(void)source, (void)usec;
	struct projector *p = context;
	const char *name, *argument;
	bool quit = false;
	end_lease(p, clock_seconds());
	while (p->window && (name = window_command(p->window, &argument, &quit)))
		send_command(p, name, argument);
	if (quit)
		return sd_event_exit(p->process.event, 0);
	if (!p->window || !(p->dirty || animation_runs(&p->animation)))
		return 0;
	double begin = clock_seconds();
	render_draw(p->render, &p->list, animation_is_shown(&p->animation) ? &p->animation.message : NULL,
		    animation_time(&p->animation, begin));
	int width, height, stride;
	const uint32_t *pixels = render_pixels(p->render, &width, &height, &stride);
	window_show(p->window, pixels, stride);
	p->work = clock_seconds() - begin;
	p->pictures++;
	p->dirty = false;
	return 0;
}

static void describe(void *context, struct process *process)
{
	struct projector *p = context;
	process_metric(process, "pictures", "1", (double)p->pictures);
	process_metric(process, "work", "ms", 1e3 * p->work);
	process_metric(process, "items", "1", p->list.item_count);
	process_state(process, p->lapsed ? "lease over" : p->window ? "running" : "no display");
}

static int setup(struct projector *p, const struct process_options *options)
{
	char err[PROCESS_ERROR_SIZE] = "";
	int r = process_init(&p->process, "billiard-projector", options, &p->config);
	if (r < 0)
		return r;
	const struct config_projector *c = &p->config.projector;
	draw_clear(&p->list);
	p->process.describe = describe;
	p->process.context = p;
	/* Without a display it still serves snapshots, and says so. */
	if (window_create(&p->window, c, err, sizeof err) < 0)
		process_error(&p->process, "%s", err);
	err[0] = '\0';
	if ((r = render_create(&p->render, c, err, sizeof err)) < 0 ||
	    (r = bus_subscribe(p->process.bus,
			       &(struct bus_subscription){"DRAW", &bus_draw_list, BUS_EACH, on_draw, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus,
			       &(struct bus_subscription){"LEASE", &bus_lease, BUS_EACH, on_lease, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus, &(struct bus_subscription){"ANIMATION", &bus_animation, BUS_EACH,
									  on_animation, p})) < 0 ||
	    (r = bus_subscribe(p->process.bus,
			       &(struct bus_subscription){"COMMAND", &bus_command, BUS_EACH, on_command, p})) < 0 ||
	    (r = process_every(&p->process, FRAME_US, on_frame, p)) < 0)
		fprintf(stderr, "billiard-projector: %s\n", err[0] ? err : strerror(-r));
	return r;
}

int main(int argc, char **argv)
{
	struct process_options options;
	int r = process_parse(&options, "billiard-projector", argc, argv);
	if (r != 0)
		return r < 0 ? 2 : 0;
	struct projector p = {0};
	int status = setup(&p, &options) < 0 ? 2 : process_run(&p.process);
	window_destroy(p.window);
	render_destroy(p.render);
	process_finish(&p.process);
	return status;
}
