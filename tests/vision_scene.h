/* Pictures with known truth for the vision tests: spheres traced ray by ray, which shares nothing with the code under
 * test. */
#ifndef BILLIARD_TESTS_VISION_SCENE_H
#define BILLIARD_TESTS_VISION_SCENE_H

#include "harness.h"
#include "physics/table.h"
#include "vision/image_io_cv.h"
#include "vision/vision.h"

/* Bed, ball and pockets of the thesis' table, nothing else. */
struct table scene_table(void);
struct marker_layout scene_markers(void);
/* 1280 x 720; above the bed's middle, 1.57 m high, tilted by so many radians about x and y. */
struct camera scene_camera(double tilt_x, double tilt_y);

struct scene_ball {
	vec2 pos;
	uint8_t bgr[3];
};

/* Cloth, balls (flat colours), grey noise of that standard deviation. out: an image of the camera's size is reserved.
 */
void scene_paint(const struct camera *camera, const struct table *table, const struct scene_ball *ball, int count,
		 double noise, struct random *random, struct image_buffer *out);
/* Adds the markers with their white paper. */
void scene_paint_markers(const struct camera *camera, const struct marker_layout *layout, struct image_buffer *out);
/* Normally distributed, mean 0, 1 sigma. */
double scene_gauss(struct random *random);

#endif
