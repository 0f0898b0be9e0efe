/* Vision behind the virtual camera, whose truth is known, on the thesis' table. */
#ifndef BILLIARD_TESTS_VISION_RIG_H
#define BILLIARD_TESTS_VISION_RIG_H

#include "app/config/colour_file.h"
#include "app/config/config.h"
#include "app/virtual/table_camera.h"
#include "vision_scene.h"

struct rig {
	struct config config;
	struct colour_model colours;
	struct table_camera *camera;
	struct vision *vision;
	struct image_buffer image;
	struct vision_result result;
	struct ball ball[BALL_MAX];
	int count;
};
extern struct rig *rig;

/* For a checked fixture. */
void rig_setup(void);
void rig_teardown(void);
/* count balls that neither overlap nor lie over a pocket: white, the six colours, reds. */
void rig_scatter(struct random *r, int count);
/* Paints the balls into rig->image. */
void rig_paint(int frame);
/* Hands rig->image to vision_track(). */
void rig_look(double time);
/* Both. */
void rig_track(int frame, double time);
/* The ball of the result within reach (m) of a place, or NULL. */
const struct vision_ball *rig_found_at(vec2 pos, double reach);

#endif
