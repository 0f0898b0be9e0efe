/* Colour classes of balls, relative to the local cloth colour. Parameters come from a file that the application reads.
 */
#ifndef BILLIARD_VISION_COLOUR_H
#define BILLIARD_VISION_COLOUR_H

#include <stdbool.h>
#include <stddef.h>

#include "physics/ball.h"
#include "vision/image.h"
#include "vision/outline.h"

enum { COLOUR_CLASSES = COLOUR_UNKNOWN, COLOUR_FEATURES = 6, COLOUR_BALLS_MAX = 64 };

/* What a ball looks like, in numbers without unit:
 * 0..2 ln of blue, green, red over the cloth's (medians of the ball's inside);
 * 3, 4 ln of blue and of red over green, weighted down where the ball is dark;
 * 5 how grey the ball's lighter quarter is (1: white light only). */
struct colour_feature {
	double v[COLOUR_FEATURES];
};

/* How far two looks lie apart: about 0.1 for one ball in other light, 1 and more for other colours. */
double colour_difference(const struct colour_feature *a, const struct colour_feature *b);

/* One class: normal distribution of its features. samples 0: the class is not known. */
struct colour_class {
	int samples;
	double mean[COLOUR_FEATURES];
	double covariance[COLOUR_FEATURES][COLOUR_FEATURES]; /* symmetric, positive definite */
	double scale, scale_spread; /* apparent radius over the true one, and its standard deviation; 0.5..1.5, > 0 */
};

/* Plain numbers, filled by the application (app/colour_file.h reads and writes the file). */
struct colour_model {
	struct colour_class class[COLOUR_CLASSES]; /* by enum ball_colour */
	double unknown_distance; /* Mahalanobis distance to the nearest class beyond which a ball is unknown, > 0 */
};

/* 0, or -EINVAL with the reason (which class, which number). */
int colour_model_check(const struct colour_model *model, char *err, size_t err_size);

/* Looks at a ball; cloth: BGR of the cloth around it. */
struct colour_feature colour_measure(const struct image *frame, const struct outline *outline, const float cloth[3]);

/* A ball of known colour. */
struct colour_sample {
	struct colour_feature feature;
	double scale; /* apparent radius over the true one, from its fit */
	enum ball_colour colour;
};

/* Learned from balls whose colours are known. 0, or -EINVAL when a class that appears has fewer than 3 samples. */
int colour_learn(const struct colour_sample *sample, int count, struct colour_model *out, char *err, size_t err_size);

struct colour_verdict {
	enum ball_colour colour;
	double confidence; /* 0..1 */
};

/* Ready for use: inverses of the covariances. */
struct colour_classifier {
	double unknown_distance;
	bool known[COLOUR_CLASSES];
	double mean[COLOUR_CLASSES][COLOUR_FEATURES];
	double inverse[COLOUR_CLASSES][COLOUR_FEATURES][COLOUR_FEATURES];
	double log_norm[COLOUR_CLASSES];
	double scale[COLOUR_CLASSES], scale_spread[COLOUR_CLASSES];
};
/* model must have passed colour_model_check(). */
struct colour_classifier colour_classifier(const struct colour_model *model);
/* The class a ball looks most like on its own, COLOUR_UNKNOWN when none. */
enum ball_colour colour_likeliest(const struct colour_classifier *classifier, const struct colour_feature *feature);
/* All balls of a frame at once: at most one is white and one of each of the six colours; none is forced to be there.
 * count at most COLOUR_BALLS_MAX. */
void colour_assign(const struct colour_classifier *classifier, const struct colour_feature *feature, int count,
		   struct colour_verdict *out);

#endif
