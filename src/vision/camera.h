/* Pinhole camera with lens distortion, its pose above the table, and the two ways between pixels and the table. */
#ifndef BILLIARD_VISION_CAMERA_H
#define BILLIARD_VISION_CAMERA_H

#include <stdbool.h>

#include "physics/vec2.h"

struct camera_intrinsics {
	int width, height;	   /* px the constants hold for */
	double fx, fy, cx, cy;	   /* px, pixel centres at whole numbers */
	double k1, k2, p1, p2, k3; /* OpenCV's distortion model */
};

/* Table to camera: X_cam = R X_table + t, m. Camera looks along +z, x right, y down. */
struct camera_pose {
	double r[9]; /* row by row */
	double t[3]; /* m */
};

struct camera {
	struct camera_intrinsics in;
	struct camera_pose pose;
};

/* Constants for another resolution of the same aspect (within 1 %). False when the aspect differs. */
bool camera_scale(const struct camera_intrinsics *in, int width, int height, struct camera_intrinsics *out);
/* Point in the table frame (m, z up) to pixel. False when it lies behind the camera. */
bool camera_project(const struct camera *camera, vec2 pos, double z, vec2 *px);
/* Pixel to the plane z (m) of the table frame. False when the ray does not meet it. */
bool camera_unproject(const struct camera *camera, vec2 px, double z, vec2 *pos);
/* Camera's centre in the table frame, m. */
void camera_centre(const struct camera *camera, double out[3]);

#endif
