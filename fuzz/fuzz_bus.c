/* Messages from the wire: whatever the bytes, decoding neither crashes nor leaks, and what passes the checks behind it can be used. The
 * first byte picks the type, the next the table. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process/text.h"
#include "app/planner/plan_check.h"
#include "app/planner/request_message.h"
#include "app/light/animation.h"
#include "app/process/bus.h"
#include "app/process/message_table.h"
#include "app/config/config.h"
#include "app/control/controller.h"
#include "app/light/draw.h"
#include "app/planner/plan_message.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const struct bus_type *const types[] = {&bus_image,     &bus_table_state, &bus_plan_request, &bus_plan,
					       &bus_draw_list, &bus_animation,	 &bus_command,	    &bus_status};
static struct config config;
static struct controller controller;

static void load(void)
{
	char err[640];
	if (config.name[0])
		return;
	if (config_load(&config, "config/thesis-table.conf", err, sizeof err) < 0) {
		fprintf(stderr, "%s\n", err);
		exit(1);
	}
}

static void use_plan(const billiard_plan_t *plan)
{
	static billiard_draw_list_t list;
	char text[128];
	static billiard_animation_t animation;
	static const struct draw_options all = {true, true, true, true};
	if (!plan_check(plan, &config.table) || plan->entry_count == 0)
		return;
	draw_proposal(&list, &config.table, &(struct draw_subject){plan, 0, 0}, &all);
	if (!message_check(&message_draw_list, &list, text, sizeof text) || !draw_check(&list))
		abort();
	plan_message_animation(&animation, plan, 0, 0);
	if (!message_check(&message_animation, &animation, text, sizeof text) || !animation_check(&animation))
		abort();
	animation_position(&animation, 1);
}

static void use(const struct bus_type *type, const void *message)
{
	char text[256];
	struct plan_request request;
	if (!message_check(type->table, message, text, sizeof text))
		return;
	controller_init(&controller, &config);
	if (type == &bus_table_state) {
		controller_state(&controller, message, 1);
	} else if (type == &bus_plan_request) {
		plan_request_from_message(&request, message, &config.table, text, sizeof text);
	} else if (type == &bus_plan) {
		use_plan(message);
	} else if (type == &bus_draw_list) {
		draw_check(message);
	} else if (type == &bus_animation) {
		if (animation_check(message))
			animation_position(message, 1);
	} else if (type == &bus_command) {
		controller_command(&controller, message, 1);
	} else if (type == &bus_status) {
		const billiard_status_t *s = message;
		text_get(text, sizeof text, s->error, sizeof s->error);
	}
}

/* The hash in front of each message is put right: the fuzzer would never find it. A short input stands for a message that goes on with zeros. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	load();
	if (size < 2)
		return 0;
	const struct bus_type *type = types[data[0] % (sizeof types / sizeof types[0])];
	bool whole = data[1] & 1;
	void *message = calloc(1, type->size);
	size_t full = type == &bus_image ? size + 6 : (size_t)type->encoded_size(message);
	size_t used = whole || size + 6 > full ? full : size + 6;
	uint8_t *bytes = calloc(1, used), head[64 + 8];
	uint8_t pixel = 0;
	billiard_image_t small_image = {.size = 1, .data = &pixel};
	if (type == &bus_image)
		type->encode(head, 0, sizeof head, &small_image);
	else
		type->encode(bytes, 0, (int)used, message);
	if (type == &bus_image)
		memcpy(bytes, head, used < 8 ? used : 8);
	for (size_t i = 2; i < size && i + 6 < used; i++)
		bytes[i + 6] = data[i];
	if (!type->check || type->check(bytes, used)) {
		int n = type->decode(bytes, 0, (int)used, message);
		if (n >= 0) {
			use(type, message);
			type->cleanup(message);
		}
	}
	free(bytes);
	free(message);
	return 0;
}
