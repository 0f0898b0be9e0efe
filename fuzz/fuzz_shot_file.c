/* Shot files: whatever the bytes are, either refused with a reason or a shot that simulates to an end. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/shot_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct shot_file file;
	char err[300] = "";
	if (shot_file_parse(&file, "p", (const char *)data, size, err, sizeof err) < 0) {
		if (strncmp(err, "p:", 2) != 0)
			abort();
		return 0;
	}
	int first, second;
	if (file.ball_count < 1 || file.ball_count > BALL_MAX ||
	    table_check_balls(&file.table, file.ball, file.ball_count, &first, &second, err, sizeof err) < 0)
		abort();
	struct sim sim;
	sim_init(&sim, &file.table, &file.model, file.ball, file.ball_count);
	sim_run(&sim, &(struct sim_limits){.max_time = 60, .max_events = 100}, NULL);
	for (int i = 0; i < file.ball_count; i++) {
		struct ball ball = sim_ball(&sim, i);
		if (!ball_is_finite(&ball))
			abort();
	}
	return 0;
}
