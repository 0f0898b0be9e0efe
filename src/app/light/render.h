/* Draw lists to pixels with Cairo, through the homography table -> picture. */
#ifndef BILLIARD_APP_RENDER_H
#define BILLIARD_APP_RENDER_H

#include "app/config/config.h"
#include "lcmtypes/billiard_animation_t.h"
#include "lcmtypes/billiard_draw_list_t.h"

struct render; /* opaque: surface and font */
/* 0, -EINVAL, -ENOMEM; *out NULL on failure. Caller destroys. */
int render_create(struct render **out, const struct config_projector *projector, char *err, size_t err_size);
void render_destroy(struct render *render); /* NULL is fine */
/* Draws the list, which draw_check() must have accepted, and over it the balls of the animation, which animation_check() must have accepted,
 * at time t (s since the strike); NULL: none. Black where nothing is. */
void render_draw(struct render *render, const billiard_draw_list_t *list, const billiard_animation_t *animation,
		 double t);
/* The picture: 32-bit xRGB in native order, rows from the top, stride in bytes; borrowed until the next render_draw(). */
const uint32_t *render_pixels(const struct render *render, int *width, int *height, int *stride);
/* Place of an animated ball t s after the strike: by its keyframe begun last (thesis 4.6.5). False when it has
 * not moved yet (the real ball lies there, and light on it only disturbs) or is potted. */
bool render_animated(const billiard_animation_t *animation, int ball, double t, vec2 *pos);
/* 0 or a negative errno with reason. */
int render_write_png(struct render *render, const char *path, char *err, size_t err_size);

#endif
