/* Colour classes of balls, relative to the local cloth colour. Parameters come from a file that the application reads. */
#ifndef BILLIARD_VISION_COLOUR_H
#define BILLIARD_VISION_COLOUR_H

#include <stddef.h>

#include "physics/ball.h"

/* Plain numbers, filled by the application (app/colour_file.h reads and writes the file). */
struct colour_model {
	int placeholder;
};

#endif
