#include "app/light/picture.h"

#include <cairo-svg.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/save.h"

/* A file in memory: its bytes are there after fclose(). */
struct memory {
	FILE *file;
	char *data;
	size_t size;
};

static cairo_status_t append(void *file, const unsigned char *data, unsigned size)
{
	return fwrite(data, 1, size, file) == size ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static int begin(struct memory *memory, const char *path, char *err, size_t err_size)
{
	*memory = (struct memory){0};
	memory->file = open_memstream(&memory->data, &memory->size);
	if (memory->file)
		return 0;
	snprintf(err, err_size, "%s: %s", path, strerror(ENOMEM));
	return -ENOMEM;
}

/* Takes what was drawn to the disk, or tells why it could not be drawn. */
static int end(struct memory *memory, cairo_status_t status, const char *path, char *err, size_t err_size)
{
	if (fclose(memory->file) == EOF && status == CAIRO_STATUS_SUCCESS)
		status = CAIRO_STATUS_NO_MEMORY;
	int code = status == CAIRO_STATUS_SUCCESS ? 0 : status == CAIRO_STATUS_NO_MEMORY ? -ENOMEM : -EIO;
	if (code == 0)
		code = save_file(path, memory->data, memory->size, err, err_size);
	else
		snprintf(err, err_size, "%s: %s", path, cairo_status_to_string(status));
	free(memory->data);
	return code;
}

int picture_save_png(cairo_t *cairo, const char *path, char *err, size_t err_size)
{
	struct memory memory;
	int code = begin(&memory, path, err, err_size);
	if (code < 0)
		return code;
	cairo_status_t status = cairo_status(cairo);
	if (status == CAIRO_STATUS_SUCCESS)
		status = cairo_surface_write_to_png_stream(cairo_get_target(cairo), append, memory.file);
	return end(&memory, status, path, err, err_size);
}

int picture_save_svg(const struct picture *picture, const char *path, char *err, size_t err_size)
{
	struct memory memory;
	int code = begin(&memory, path, err, err_size);
	if (code < 0)
		return code;
	cairo_surface_t *surface =
		cairo_svg_surface_create_for_stream(append, memory.file, picture->width, picture->height);
	cairo_t *cairo = cairo_create(surface);
	picture->draw(cairo, picture->context);
	cairo_status_t status = cairo_status(cairo);
	cairo_destroy(cairo);
	cairo_surface_finish(surface);
	if (status == CAIRO_STATUS_SUCCESS)
		status = cairo_surface_status(surface);
	cairo_surface_destroy(surface);
	return end(&memory, status, path, err, err_size);
}
