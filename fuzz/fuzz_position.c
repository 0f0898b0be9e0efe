/* Position texts: whatever the bytes are, either refused with a reason or a valid position. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/position.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void box(struct table *table)
{
	char err[160];
	*table = (struct table){.length = 1.881, .width = 0.943, .ball_radius = 0.02615, .ball_mass = 0.14};
	table->material = (struct material){
		.gravity = 9.8, .mu_slide = 0.17, .mu_roll = 0.014, .mu_spin = 3e-4, .e_ball = 0.95, .e_cushion = 0.85};
	if (table_finish(table, err, sizeof err) < 0)
		abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct table table;
	if (!(table.length > 0))
		box(&table);
	char err[200] = "";
	struct position position;
	if (position_parse(&position, &table, "p", (const char *)data, size, err, sizeof err) < 0) {
		if (strncmp(err, "p:", 2) != 0)
			abort();
		return 0;
	}
	int first, second;
	if (position.count < 1 || position.count > BALL_MAX ||
	    table_check_balls(&table, position.ball, position.count, &first, &second, err, sizeof err) < 0)
		abort();
	return 0;
}
