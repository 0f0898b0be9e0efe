/* Pictures of finished simulations for people: the table from above and the way of every ball. */
#ifndef BILLIARD_APP_PLOT_H
#define BILLIARD_APP_PLOT_H

#include <stdbool.h>
#include <stddef.h>

#include "physics/trace.h"

/* True when the file's name ends in .svg or .png. */
bool plot_format_known(const char *path);

/* Draws cushions, jaws, pockets, where balls start (pale) and end (full), and their paths. Balls that had fallen before
 * are left out; a trace that ends before the balls rest says so, and its ends are pale. Format by the file's name. 0, or a negative errno
 * with "path: reason" in err. */
int plot_trace(const struct table *table, const struct trace *trace, const char *path, char *err, size_t err_size);

#endif
