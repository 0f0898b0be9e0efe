/* Keyframes of a plan as lines. Internal to the draw lists. */
#ifndef BILLIARD_APP_DRAW_PATH_H
#define BILLIARD_APP_DRAW_PATH_H

#include "app/light/draw.h"

enum { DRAW_PATH_MAX = 512 };

/* The way of one ball: no farther than 1 mm from the true parabolas. */
struct draw_path {
	vec2 point[DRAW_PATH_MAX]; /* m */
	int count;
	int contact; /* index of the point at the first ball contact, -1 none */
};

/* Path of a ball in the keyframes of a shot of a checked plan, from where it starts to move. */
void draw_path_of(struct draw_path *path, const billiard_plan_t *plan, const billiard_plan_shot_t *shot, int ball);

#endif
