/* The projector's screen: an SDL2 window or full screen, or nothing where there is no display. */
#ifndef BILLIARD_APP_WINDOW_H
#define BILLIARD_APP_WINDOW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "app/config/config.h"

struct window; /* opaque */

/* 0, or -ENODEV with the reason (no display): the caller goes on without. Caller destroys. */
int window_create(struct window **out, const struct config_projector *projector, char *err, size_t err_size);
void window_destroy(struct window *window); /* NULL is fine */

/* Shows a picture of the window's size: 32-bit xRGB, rows from the top. */
void window_show(struct window *window, const uint32_t *pixels, int stride);

/* Next key pressed, as the command it stands for (thesis 4.8), NULL when none waits. *quit is set when the window was closed. */
const char *window_command(struct window *window, const char **argument, bool *quit);

#endif
