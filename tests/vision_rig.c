#include "vision_rig.h"

#include <stdlib.h>

static const double mm = 1e-3;

struct rig *rig;

void rig_setup(void)
{
	char err[640];
	rig = calloc(1, sizeof(*rig));
	ck_assert_msg(config_load(&rig->config, "config/thesis-table.conf", err, sizeof(err)) == 0, "%s", err);
	ck_assert_msg(colour_file_read(rig->config.colours, &rig->colours, err, sizeof(err)) == 0, "%s", err);
	struct vision_def def = config_vision_def(&rig->config, &rig->colours);
	ck_assert_msg(vision_create(&rig->vision, &def, err, sizeof(err)) == 0, "%s", err);
	ck_assert_msg(table_camera_create(&rig->camera, &rig->config, err, sizeof(err)) == 0, "%s", err);
	ck_assert_int_eq(image_buffer_reserve(&rig->image, rig->config.camera.width, rig->config.camera.height), 0);
}

void rig_teardown(void)
{
	vision_destroy(rig->vision);
	table_camera_destroy(rig->camera);
	image_buffer_finish(&rig->image);
	free(rig);
}

static bool is_free(vec2 p)
{
	double d = 2 * rig->config.table.ball_radius;
	for (int i = 0; i < rig->count; i++)
		if (vec2_dist(rig->ball[i].pos, p) < d + 0.1 * mm)
			return false;
	for (int i = 0; i < rig->config.table.pocket_count; i++)
		if (vec2_dist(rig->config.table.pocket[i].centre, p) < 1.2 * rig->config.table.pocket[i].radius)
			return false;
	return true;
}

void rig_scatter(struct random *r, int count)
{
	const struct table *t = &rig->config.table;
	double hx = t->length / 2 - t->ball_radius, hy = t->width / 2 - t->ball_radius;
	for (rig->count = 0; rig->count < count;) {
		vec2 p = {random_in(r, -hx, hx), random_in(r, -hy, hy)};
		int n = rig->count;
		if (is_free(p))
			rig->ball[rig->count++] = ball_at(n == 0  ? COLOUR_WHITE
							  : n < 7 ? (enum ball_colour)(n + 1)
								  : COLOUR_RED,
							  p);
	}
}

void rig_paint(int frame)
{
	ck_assert_int_eq(image_buffer_reserve(&rig->image, rig->config.camera.width, rig->config.camera.height), 0);
	table_camera_render(rig->camera, rig->ball, rig->count, (uint64_t)frame, &rig->image.image);
}

void rig_look(double time)
{
	char err[256];
	ck_assert_msg(vision_track(rig->vision, &rig->image.image, time, &rig->result, err, sizeof(err)) == 0, "%s",
		      err);
}

void rig_track(int frame, double time)
{
	rig_paint(frame);
	rig_look(time);
}

const struct vision_ball *rig_found_at(vec2 pos, double reach)
{
	for (int i = 0; i < rig->result.ball_count; i++)
		if (vec2_dist(rig->result.ball[i].pos, pos) < reach)
			return &rig->result.ball[i];
	return NULL;
}
