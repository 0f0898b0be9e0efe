#include "vision/vision.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vision/colour.h"
#include "vision/detect.h"
#include "vision/markers_cv.h"
#include "vision/pose.h"
#include "vision/reason.h"

struct vision {
	struct vision_def def;
	struct colour_classifier colours;
	bool has_colours;
	struct marker_finder *finder;
	struct detector detector;
};

struct vision_def vision_def_default(void)
{
	return (struct vision_def){.marker_interval = 1, .pose_keep = 10};
}

static int check_def(const struct vision_def *def, char *err, size_t err_size)
{
	const struct camera_intrinsics *in = &def->intrinsics;
	if (!def->table)
		return vision_fail(-EINVAL, err, err_size, "no table");
	if (in->width < 64 || in->height < 64 || in->width > 8192 || in->height > 8192)
		return vision_fail(-EINVAL, err, err_size, "camera of %d x %d px, allowed 64..8192", in->width, in->height);
	if (!(in->fx > 0) || !(in->fy > 0) || !isfinite(in->cx) || !isfinite(in->cy))
		return vision_fail(-EINVAL, err, err_size, "camera: fx and fy must be > 0, cx and cy finite");
	if (def->markers.count < 3 || def->markers.count > MARKER_MAX)
		return vision_fail(-EINVAL, err, err_size, "%d markers, allowed 3..%d", def->markers.count, MARKER_MAX);
	if (!(def->markers.side > 0))
		return vision_fail(-EINVAL, err, err_size, "marker side %g m, must be > 0", def->markers.side);
	if (!(def->marker_interval >= 0) || !(def->pose_keep >= 0))
		return vision_fail(-EINVAL, err, err_size, "marker_interval and pose_keep must be >= 0 s");
	return def->colours ? colour_model_check(def->colours, err, err_size) : 0;
}

int vision_create(struct vision **out, const struct vision_def *def, char *err, size_t err_size)
{
	*out = NULL;
	int rc = check_def(def, err, err_size);
	if (rc < 0)
		return rc;
	struct vision *v = calloc(1, sizeof(*v));
	if (!v)
		return vision_fail(-ENOMEM, err, err_size, "no memory");
	v->def = *def;
	v->has_colours = def->colours != NULL;
	if (v->has_colours)
		v->colours = colour_classifier(def->colours);
	rc = marker_finder_create(&v->finder, def->markers.dictionary_count, def->markers.dictionary_bits, err, err_size);
	if (rc == 0) {
		rc = detector_init(&v->detector, def->table, v->has_colours ? &v->colours : NULL, def->intrinsics.width,
				   def->intrinsics.height);
		if (rc < 0)
			vision_fail(rc, err, err_size, "no memory for frames of %d x %d px", def->intrinsics.width,
				    def->intrinsics.height);
	}
	if (rc < 0) {
		vision_destroy(v);
		return rc;
	}
	*out = v;
	return 0;
}

void vision_destroy(struct vision *vision)
{
	if (!vision)
		return;
	marker_finder_destroy(vision->finder);
	detector_finish(&vision->detector);
	free(vision);
}

void vision_samples(const struct vision *vision, struct colour_sample *out)
{
	const struct detector *d = &vision->detector;
	for (int i = 0; i < d->count && i < VISION_BALL_MAX; i++)
		out[i] = (struct colour_sample){d->candidate[i].look, d->candidate[i].fit.scale, COLOUR_UNKNOWN};
}

void vision_reset(struct vision *vision)
{
	(void)vision;
}

/* The camera from this frame's markers. */
static bool calibrate(struct vision *v, const struct image *frame, struct vision_result *out)
{
	struct marker_view view[MARKER_MAX];
	struct pose_fit fit;
	int count = marker_find(v->finder, frame, view, MARKER_MAX);
	out->markers_seen = count;
	if (!pose_from_markers(&v->def.markers, view, count, &out->camera, &fit)) {
		if (count < 3)
			snprintf(out->reason, sizeof(out->reason), "%d of %d markers seen, 3 are needed", count, v->def.markers.count);
		else
			snprintf(out->reason, sizeof(out->reason), "the %d markers seen do not fit the table", count);
		return false;
	}
	out->calibration = CALIBRATION_FRESH;
	out->residual_px = fit.residual_px;
	out->residual = fit.residual;
	return true;
}

static void report(struct vision *v, struct vision_result *out)
{
	struct detector *d = &v->detector;
	struct colour_feature feature[VISION_BALL_MAX];
	struct colour_verdict verdict[VISION_BALL_MAX];
	int count = d->count < VISION_BALL_MAX ? d->count : VISION_BALL_MAX;
	for (int i = 0; i < count; i++) {
		feature[i] = d->candidate[i].look;
		verdict[i] = (struct colour_verdict){COLOUR_UNKNOWN, 1};
	}
	if (v->has_colours)
		colour_assign(&v->colours, feature, count, verdict);
	for (int i = 0; i < count; i++) {
		const struct candidate *c = &d->candidate[i];
		out->ball[i] = (struct vision_ball){.pos = c->fit.pos, .px = c->fit.outline.centre, .colour = verdict[i].colour,
						    .confidence = c->confidence, .radius_px = c->fit.outline.radius_px,
						    .rim_support = c->fit.support};
	}
	out->ball_count = count;
}

int vision_detect(struct vision *vision, const struct image *frame, struct vision_result *out, char *err, size_t err_size)
{
	struct vision_result r = {0};
	if (!camera_scale(&vision->def.intrinsics, frame->width, frame->height, &r.camera.in))
		return vision_fail(-EINVAL, err, err_size, "a frame of %d x %d px does not fit a camera of %d x %d px",
				   frame->width, frame->height, vision->def.intrinsics.width, vision->def.intrinsics.height);
	if (calibrate(vision, frame, &r)) {
		if (!detector_place(&vision->detector, &r.camera)) {
			r.calibration = CALIBRATION_NONE;
			snprintf(r.reason, sizeof(r.reason), "the table is not in the picture");
		} else if (detector_frame(&vision->detector, frame, &r.camera)) {
			report(vision, &r);
		} else {
			snprintf(r.reason, sizeof(r.reason), "no cloth is seen: too dark or too bright");
		}
	}
	*out = r;
	return 0;
}

int vision_track(struct vision *vision, const struct image *frame, double time, struct vision_result *out, char *err,
		 size_t err_size)
{
	(void)time;
	return vision_detect(vision, frame, out, err, err_size);
}
