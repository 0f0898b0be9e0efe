/* From frames to balls: calibration, detection, colours, tracking. One struct vision per camera; one thread; takes its
 * memory at create. Knows no files, bus or clock: time comes with the frame. */
#ifndef BILLIARD_VISION_VISION_H
#define BILLIARD_VISION_VISION_H

#include "physics/table.h"
#include "vision/camera.h"
#include "vision/image.h"

enum { MARKER_MAX = 8, VISION_BALL_MAX = 40 };

/* The markers on the rails. */
struct marker_layout {
	int dictionary_count, dictionary_bits; /* cv::aruco::generateCustomDictionary(count, bits): 4, 3 */
	double side;			       /* m */
	double height;			       /* m above the bed */
	int count;
	struct {
		int id;
		vec2 centre;
	} marker[MARKER_MAX]; /* m, table frame */
};

struct colour_model;
struct colour_sample;

struct vision_def {
	const struct table *table; /* borrowed: sizes, pockets, ball radius */
	struct camera_intrinsics intrinsics;
	struct marker_layout markers;
	double marker_interval;		    /* s between marker searches on a tracked table, default 1 */
	double pose_keep;		    /* s the last good pose is kept when markers are covered, default 10 */
	const struct colour_model *colours; /* borrowed; see vision/colour.h */
};
struct vision_def vision_def_default(void);

enum vision_calibration { CALIBRATION_NONE, CALIBRATION_FRESH, CALIBRATION_KEPT };

/* What is not sure of a ball, or of the whole table. */
enum vision_doubt {
	DOUBT_PLACE = 1,    /* too little of it is seen, or whole frame and track differ */
	DOUBT_COLOUR = 2,   /* it may be of another colour, or is of none that is known */
	DOUBT_HIDDEN = 4,   /* believed to lie there, not seen in this frame */
	DOUBT_UNJUDGED = 8, /* nobody has looked at the whole frame since something moved, came or went */
	DOUBT_NO_CUE = 16   /* no white ball */
};

struct vision_ball {
	vec2 pos; /* m, table frame, centre; stabilised when tracked */
	vec2 vel; /* m/s; 0 from a single frame */
	vec2 px;  /* image of the centre, pixels of the frame */
	enum ball_colour colour;
	double confidence;  /* 0..1: of the place times of the colour */
	double place;	    /* 0..1: of the place alone */
	double certainty;   /* 0..1: of the colour alone */
	int doubt;	    /* of enum vision_doubt */
	int track;	    /* identity over frames, >= 1; 0 from a single frame */
	int age;	    /* frames it has been tracked */
	double radius_px;   /* fitted outline, mean */
	double rim_support; /* share of the rim with an edge, 0..1 */
};

struct vision_result {
	enum vision_calibration calibration;
	char reason[96]; /* why not calibrated; empty when it is */
	double pose_age; /* s, since markers were last seen; 0 without a pose */
	int markers_seen;
	double residual_px, residual; /* rms of the marker corners: px, m on the table */
	struct camera camera;	      /* valid unless CALIBRATION_NONE */
	bool occluded;		      /* a hand, arm, cue or head is in the picture */
	int doubt;		      /* of enum vision_doubt: all balls', and the table's own */
	int ball_count;
	struct vision_ball ball[VISION_BALL_MAX];
};

struct vision;
/* 0, -EINVAL (reason), -ENOMEM. Caller destroys. */
int vision_create(struct vision **out, const struct vision_def *def, char *err, size_t err_size);
void vision_destroy(struct vision *vision); /* NULL is fine */

/* One frame on its own: no memory of former frames is used or changed but the scratch. 0, or -EINVAL (wrong size for
 * the intrinsics...) with the reason; a frame without markers is 0 with CALIBRATION_NONE. */
int vision_detect(struct vision *vision, const struct image *frame, struct vision_result *out, char *err,
		  size_t err_size);

/* The next frame of a stream, time in s (any epoch, must not go back: if it does, tracking starts anew). */
int vision_track(struct vision *vision, const struct image *frame, double time, struct vision_result *out, char *err,
		 size_t err_size);

/* What the balls of the last vision_detect() looked like (vision/colour.h; colour UNKNOWN), in its order: out has room
 * for VISION_BALL_MAX. For learning colours. */
void vision_samples(const struct vision *vision, struct colour_sample *out);

/* What the last vision_detect() of a calibrated frame looked at and did not take for a ball; for people to look at. */
struct vision_refusal {
	vec2 pos;	    /* m */
	double rim_support; /* share of the rim with an edge, 0..1 */
	double cover;	    /* share of the inside that is not cloth, 0..1 */
	const char *reason; /* static */
};
/* Fills at most capacity, returns how many there are in all. */
int vision_refusals(const struct vision *vision, struct vision_refusal *out, int capacity);

/* From now on shows what the stages of each vision_detect() saw, and those that a frame of a stream goes through
 * (vision/stages.h): several ms a picture. watch is borrowed; NULL: nobody looks, which is how it begins. */
struct stage_watch;
void vision_watch(struct vision *vision, const struct stage_watch *watch);

/* Forgets tracks and pose. */
void vision_reset(struct vision *vision);

#endif
