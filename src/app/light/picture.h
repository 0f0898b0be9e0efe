/* Cairo's pictures as files that are whole or not there (config/save.h). */
#ifndef BILLIARD_APP_PICTURE_H
#define BILLIARD_APP_PICTURE_H

#include <cairo.h>
#include <stddef.h>

/* Writes what was drawn on a surface of pixels as a PNG. 0, or a negative errno with "path: reason" in err; the file is untouched then. */
int picture_save_png(cairo_t *cairo, const char *path, char *err, size_t err_size);

/* The same as an SVG of that size (points), drawn by draw(cairo, context). */
typedef void picture_draw_fn(cairo_t *cairo, const void *context);
struct picture {
	double width, height;
	picture_draw_fn *draw;
	const void *context; /* borrowed */
};
int picture_save_svg(const struct picture *picture, const char *path, char *err, size_t err_size);

#endif
