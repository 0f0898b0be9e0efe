/* What a camera above the virtual table sees: bed, cushions, pockets, rails, markers, shaded balls with highlights and
 * shadows, the projector's light on the cloth and on the balls, the blur of what moves, an arm, sensor noise. Pure; same input and seed, same pixels. */
#ifndef BILLIARD_APP_TABLE_CAMERA_H
#define BILLIARD_APP_TABLE_CAMERA_H

#include "app/config/config.h"
#include "app/virtual/table_arm.h"
#include "vision/image.h"

struct table_camera; /* opaque: precomputed background, projector map, scratch */
/* 0, -EINVAL, -ENOMEM with reason. Caller destroys. Camera pose from config->virtual_table, intrinsics from
 * config->camera. The configuration is copied. */
int table_camera_create(struct table_camera **out, const struct config *config, char *err, size_t err_size);
void table_camera_destroy(struct table_camera *camera); /* NULL is fine */
/* The true camera (for tests). */
const struct camera *table_camera_truth(const struct table_camera *camera);
/* New projector picture (xRGB as render_pixels() gives it), of the size in config->projector; NULL: projector dark. Copied. */
void table_camera_light(struct table_camera *camera, const uint32_t *pixels, int width, int height, int stride);
/* What the next frames show besides the table, and what is wrong with them. */
struct table_disturbance {
	struct table_arm arm;
	double gain;	      /* of the exposure, 1 none, 0..32 */
	int shift_x, shift_y; /* px that the camera was turned by, +-64 */
};
void table_camera_disturb(struct table_camera *camera,
			  const struct table_disturbance *disturbance); /* NULL: nothing. Copied. */
/* Renders a frame of the balls (finite; potted ones are not seen) into out, whose size must be that of the camera. frame:
 * seeds the noise. */
void table_camera_render(struct table_camera *camera, const struct ball *ball, int count, uint64_t frame,
			 struct image *out);

#endif
