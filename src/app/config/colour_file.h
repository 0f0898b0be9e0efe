/* The colour parameter file: JSON, written by `billiard calibrate colours`. */
#ifndef BILLIARD_APP_COLOUR_FILE_H
#define BILLIARD_APP_COLOUR_FILE_H

#include "vision/colour.h"

/* 0, or a negative errno with file, line, key and reason in err and out untouched. */
int colour_file_read(const char *path, struct colour_model *out, char *err, size_t err_size);
int colour_file_write(const char *path, const struct colour_model *model, char *err, size_t err_size);

#endif
