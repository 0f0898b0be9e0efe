/* What a ball looks like to the camera: the exact image of a sphere's silhouette. */
#ifndef BILLIARD_VISION_OUTLINE_H
#define BILLIARD_VISION_OUTLINE_H

#include "vision/camera.h"

enum { OUTLINE_POINTS = 48 };

struct outline {
	vec2 centre;		     /* image of the ball's centre, px */
	vec2 point[OUTLINE_POINTS];  /* px, in order around the ball */
	vec2 normal[OUTLINE_POINTS]; /* unit, outwards */
	double radius_px;	     /* mean distance of the points from their middle */
};

/* Silhouette of a ball of that radius (m) lying on the bed at pos, times scale about its own middle (a light ball
 * blooms, a dark one shrinks). The tangent cone from the camera touches the sphere in a circle; its points are
 * projected. False when any of it is behind the camera. */
bool outline_of_ball(const struct camera *camera, vec2 pos, double radius, double scale, struct outline *out);
/* The camera's image of a small move on the table at the ball's height: px per m, row by row (du/dx du/dy dv/dx dv/dy).
 */
bool outline_jacobian(const struct camera *camera, vec2 pos, double radius, double out[4]);

#endif
