/* The still part of the virtual table: what lies where, and its colour. Internal to the virtual camera. */
#ifndef BILLIARD_APP_TABLE_SCENE_H
#define BILLIARD_APP_TABLE_SCENE_H

#include "physics/table.h"
#include "vision/marker_image_cv.h"
#include "vision/vision.h"

enum surface {
	SURFACE_FLOOR, /* around the table */
	SURFACE_BED,
	SURFACE_UNDER_NOSE, /* bed in the shadow below a cushion's nose */
	SURFACE_CUSHION,
	SURFACE_RAIL,
	SURFACE_CASTING, /* dark metal around the pockets */
	SURFACE_HOLE,
	SURFACE_WHITE, /* of markers and diamonds */
	SURFACE_BLACK  /* of markers */
};

struct table_scene {
	const struct table *table; /* borrowed */
	struct marker_layout markers;
	uint8_t bits[MARKER_MAX][MARKER_BITS_MAX * MARKER_BITS_MAX];
	double rail_height;		/* m: cushions, rails and markers are one plane */
	double eye[3];			/* m, the camera's centre */
	double mouth_depth[POCKET_MAX]; /* m, how far a pocket's jaws reach out from the noses */
};

/* 0, or -EINVAL with the reason when a marker is not in its dictionary. */
int table_scene_init(struct table_scene *scene, const struct table *table, const struct marker_layout *markers,
		     const double eye[3], char *err, size_t err_size);

/* What the ray from the eye through p (table frame, z = 0) meets first. */
enum surface table_scene_surface(const struct table_scene *scene, vec2 p);
/* Its colour in grey levels (red, green, blue) under the room's light. */
void table_scene_colour(const struct table_scene *scene, vec2 p, enum surface surface, float rgb[3]);
/* Where the ray through p meets the surface: p itself or a point at rail height. Returns its height, m. */
double table_scene_meet(const struct table_scene *scene, vec2 p, enum surface surface, vec2 *at);
/* Brightness of the room's light at a place, 1 in the middle, by colour. */
void table_scene_light(const struct table_scene *scene, vec2 at, float rgb[3]);

#endif
