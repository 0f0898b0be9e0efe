/* From a pot to strokes: speed, tip place, and the aim that sends the object ball into the pocket with them. */
#ifndef BILLIARD_SEARCH_STROKE_H
#define BILLIARD_SEARCH_STROKE_H

#include "search/estimate.h"

/* A stroke at a direct pot. */
struct aimed {
	struct shot shot;
	double chance; /* that the ball falls, from the measured window and the player's error; 0..1 */
	double gain;   /* radians of the object ball's direction a radian of the aim */
};

/* Turns the aim of a stroke of given speed and tip until the object ball, in a simulation of the two balls, leaves
 * towards the middle of what the pocket takes at that speed: throw, swerve and spin are in it. False when the ball does
 * not get there or is not met. A handful of simulations of a few events. */
bool stroke_aim(const struct estimator *estimator, const struct model *model, const struct ball *cue,
		const struct ball *object, const struct pot *pot, struct aimed *aimed);

#endif
