/* What the parts of the vision evaluation share. */
#ifndef BILLIARD_BENCH_VISION_EVAL_H
#define BILLIARD_BENCH_VISION_EVAL_H

#include "app/config/config.h"
#include "report.h"
#include "vision/colour.h"
#include "vision/image_io_cv.h"
#include "vision/vision.h"

enum { SAMPLE_MAX = 200000 };

/* Numbers gathered one by one, and their quantiles. Begins as {0}; caller frees value. */
struct numbers {
	double *value;
	int count, capacity;
};
void numbers_add(struct numbers *n, double value);
/* share 0..1; 0 when there is none. Sorts. */
double numbers_quantile(struct numbers *n, double share);
double numbers_rms(const struct numbers *n);

/* A vision for the shipped table with these colours (NULL: none). Ends the program with a message when it cannot. */
struct vision *eval_vision(const struct config *config, const struct colour_model *colours);
/* s of this thread's CPU. */
double eval_seconds(void);
/* Prints and keeps a number beside the bar it must not exceed (NAN: none). */
void eval_bar(struct report *report, const char *name, double value, const char *unit, double bar);
/* The same for numbers that must not fall below. */
void eval_floor(struct report *report, const char *name, double value, const char *unit, double floor);

/* Pictures of the worst go to BUILD/eval. */
void eval_photos(struct report *report, const struct config *config, const char *build, const char *data);
void eval_videos(struct report *report, const struct config *config, const char *data);
void eval_rendered(struct report *report, const struct config *config);

#endif
