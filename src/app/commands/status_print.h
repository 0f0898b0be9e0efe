/* A process' STATUS as a line for people and as one of JSON. */
#ifndef BILLIARD_APP_STATUS_PRINT_H
#define BILLIARD_APP_STATUS_PRINT_H

#include <jansson.h>
#include <stdio.h>

#include "app/process/bus.h"

/* One line, and a second with its last error when there is one. */
void status_print_line(const billiard_status_t *status, FILE *out);
/* As an object. NULL when there is no memory; caller owns. */
json_t *status_json(const billiard_status_t *status);

#endif
