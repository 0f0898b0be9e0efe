/* The inside of the virtual camera, shared by its source files. Names: px_ is a place in a picture, all else table
 * metres. */
#ifndef BILLIARD_APP_TABLE_CAMERA_STATE_H
#define BILLIARD_APP_TABLE_CAMERA_STATE_H

#include "app/virtual/table_camera.h"
#include "app/virtual/table_scene.h"

/* Brightness is kept as linear light, as lenses blur it and lamps add up: LEVEL is what the sensor shows as 255, four
 * times as much is kept before it clips. Colours are given in grey levels and go through the sRGB curve. */
enum { LEVEL = 16384, LEVEL_MAX = 65535 };
/* Parts of a grey level in which the sensor reckons. */
enum { GREY = 64 };

struct shown_picture {
	uint32_t *pixels; /* xRGB, rows without gaps */
	int width, height;
	bool dark; /* nothing to see in it */
};

struct table_camera {
	struct table table;
	struct config_projector projector;
	struct config_virtual def;
	struct camera camera;
	struct table_scene scene;
	double projector_at[3], lamp_at[3]; /* m */
	struct shown_picture picture;
	struct table_disturbance disturbance;
	float *cloth;	  /* per pixel x, y: where its ray meets z = 0 */
	float *spot;	  /* per pixel x, y: px of the projector that lights what is seen there */
	uint8_t *surface; /* per pixel: enum surface at its middle */
	uint16_t *base;	  /* per pixel B, G, R in levels: the table without picture and balls */
	uint16_t *lit;	  /* the same with the projector's picture */
	uint16_t *work;	  /* the frame in the making */
	uint32_t *column; /* one row on its way through the lens */
	uint16_t *grey;	  /* GREYths of a grey level by level, 0 to LEVEL */
	int16_t *noise;	  /* GREYths, NOISE_COUNT Gaussian samples */
};

enum { NOISE_COUNT = 1 << 16 };

/* Level of a grey level >= 0, in shares of LEVEL. */
float table_camera_linear(float grey);
/* Light of the lens: 1 in the middle, less towards the corners. Includes the exposure. */
float table_camera_gain(const struct table_camera *camera, int x, int y);
/* Share of full light (red, green, blue) that the projector's picture throws at a point of the table. Zero beside the
 * picture. */
void table_camera_picture_at(const struct table_camera *camera, vec2 at, double height, float rgb[3]);
/* Balls and their shadows into work. */
void table_camera_draw_balls(struct table_camera *camera, const struct ball *ball, int count);
/* Arm and cue and their shadows into work. */
void table_camera_draw_arm(struct table_camera *camera, const struct table_arm *arm);

#endif
