#include "vision/vision.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vision/calibration.h"
#include "vision/colour.h"
#include "vision/detector.h"
#include "vision/reason.h"
#include "vision/track.h"

static const double OCCLUDED_CELLS = 2.5; /* cells full of something that is no ball: more than a stain */
static const double OCCLUDED_SHARE = 0.2; /* of a cell; less is lines and the edge of the bed */
static const double BUMP_SHARE = 0.5;	  /* of all cells changed at once: the camera may have been bumped */
static const double CERTAIN = 0.7;	  /* of a colour, from which on it is believed */
static const double GAP = 0.1;		  /* s without a frame: what moves may be anywhere */
static const double LIGHT_FACTOR = 2, LIGHT_FLOOR = 24; /* all cells differ by that much: other light; 1/16 level */
enum { STILL_FRAMES = 3 };				/* without movement until the table rests */

struct vision {
	struct vision_def def;
	struct colour_classifier colours;
	bool has_colours;
	struct calibration single, stream;
	struct detector detector;
	struct tracker tracker;
	bool tracking;	   /* the detector's scan is that of the stream's last frame */
	int width, height; /* px of the stream */
	double time;
	int still;	  /* frames in a row in which nothing moved */
	int noise;	  /* usual difference of the cells right after a whole look, 1/16 level; -1 not known */
	bool cue_missing; /* in the last frame */
};

struct vision_def vision_def_default(void)
{
	return (struct vision_def){.marker_interval = 1, .pose_keep = 10};
}

/* ---- life
 * ------------------------------------------------------------------------------------------------------------ */

static int check_def(const struct vision_def *def, char *err, size_t err_size)
{
	const struct camera_intrinsics *in = &def->intrinsics;
	if (!def->table)
		return vision_fail(-EINVAL, err, err_size, "no table");
	if (in->width < 64 || in->height < 64 || in->width > 8192 || in->height > 8192)
		return vision_fail(-EINVAL, err, err_size, "camera of %d x %d px, allowed 64..8192", in->width,
				   in->height);
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

static int init_parts(struct vision *v, char *err, size_t err_size)
{
	const struct vision_def *def = &v->def;
	int rc = calibration_init(&v->single, &def->markers, def->marker_interval, def->pose_keep, err, err_size);
	if (rc == 0)
		rc = calibration_init(&v->stream, &def->markers, def->marker_interval, def->pose_keep, err, err_size);
	if (rc < 0)
		return rc;
	rc = detector_init(&v->detector, def->table, v->has_colours ? &v->colours : NULL, def->intrinsics.width,
			   def->intrinsics.height);
	if (rc < 0)
		return vision_fail(rc, err, err_size, "no memory for frames of %d x %d px", def->intrinsics.width,
				   def->intrinsics.height);
	tracker_init(&v->tracker, &v->detector);
	return 0;
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
	v->def.colours = NULL;
	rc = init_parts(v, err, err_size);
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
	calibration_finish(&vision->single);
	calibration_finish(&vision->stream);
	detector_finish(&vision->detector);
	free(vision);
}

void vision_reset(struct vision *vision)
{
	tracker_forget(&vision->tracker);
	calibration_reset(&vision->stream);
	vision->tracking = false;
	vision->still = 0;
}

void vision_watch(struct vision *vision, const struct stage_watch *watch)
{
	vision->detector.watch = watch;
}

void vision_samples(const struct vision *vision, struct colour_sample *out)
{
	const struct detector *d = &vision->detector;
	for (int i = 0; i < d->count && i < VISION_BALL_MAX; i++)
		out[i] = (struct colour_sample){d->candidate[i].look, d->candidate[i].fit.scale, COLOUR_UNKNOWN};
}

int vision_refusals(const struct vision *vision, struct vision_refusal *out, int capacity)
{
	static const char *const reason[] = {
		[REFUSED_NOT] = "accepted",	  [REFUSED_PLACE] = "no place for a ball",
		[REFUSED_FIT] = "no rim found",	  [REFUSED_DOUBLE] = "two in one",
		[REFUSED_RIM] = "too little rim", [REFUSED_INSIDE] = "inside like cloth",
		[REFUSED_SIZE] = "wrong size",	  [REFUSED_PART] = "part of something large",
	};
	const struct detector *d = &vision->detector;
	for (int i = 0; i < d->refused_count && i < capacity; i++) {
		const struct sighting *c = &d->refused[i];
		out[i] = (struct vision_refusal){c->fit.pos, c->fit.support, c->cover, reason[c->refusal]};
	}
	return d->refused_count;
}

/* ---- results
 * --------------------------------------------------------------------------------------------------------- */

static void report_calibration(const struct calibration *c, struct vision_result *out)
{
	out->calibration = c->now_count >= 3 ? CALIBRATION_FRESH : CALIBRATION_KEPT;
	out->camera = c->camera;
	out->markers_seen = c->now_count;
	out->residual_px = c->fit.residual_px;
	out->residual = c->fit.residual;
}

/* Colours of all balls at once. */
static void assign_colours(const struct vision *v, const struct colour_feature *look, struct vision_result *out)
{
	struct colour_verdict verdict[VISION_BALL_MAX];
	for (int i = 0; i < out->ball_count; i++)
		verdict[i] = (struct colour_verdict){COLOUR_UNKNOWN, 1};
	if (v->has_colours)
		colour_assign(&v->colours, look, out->ball_count, verdict);
	for (int i = 0; i < out->ball_count; i++) {
		out->ball[i].colour = verdict[i].colour;
		out->ball[i].certainty = verdict[i].confidence;
	}
}

/* What is in doubt, ball by ball and for the whole table. */
static void report_doubt(struct vision_result *r, bool judged)
{
	bool cue = false;
	r->doubt = judged ? 0 : DOUBT_UNJUDGED;
	for (int i = 0; i < r->ball_count; i++) {
		struct vision_ball *b = &r->ball[i];
		cue = cue || b->colour == COLOUR_WHITE;
		b->doubt |= b->confidence < TRACK_SURE ? DOUBT_PLACE : 0;
		b->doubt |= b->colour == COLOUR_UNKNOWN || b->certainty < CERTAIN ? DOUBT_COLOUR : 0;
		b->place = b->confidence;
		b->confidence *= b->certainty;
		r->doubt |= b->doubt;
	}
	r->doubt |= cue ? 0 : DOUBT_NO_CUE;
}

static struct vision_ball ball_of(const struct sighting *c)
{
	return (struct vision_ball){.pos = c->fit.pos,
				    .px = c->fit.outline.centre,
				    .confidence = c->confidence,
				    .radius_px = c->fit.outline.radius_px,
				    .rim_support = c->fit.support};
}

static bool is_explained(const struct vision *v, const struct vision_result *r, vec2 px)
{
	vec2 pos;
	const struct table *table = v->def.table;
	double half_cell = SCAN_CELL * v->detector.scan.factor / 2.0;
	for (int i = 0; i < r->ball_count; i++)
		if (vec2_dist(r->ball[i].px, px) < r->ball[i].radius_px + half_cell)
			return true;
	if (!camera_unproject(&r->camera, px, 0, &pos))
		return true;
	for (int i = 0; i < table->pocket_count; i++)
		if (vec2_dist(table->pocket[i].centre, pos) < table->pocket[i].radius + 1.5 * table->ball_radius)
			return true;
	return false;
}

/* Something large that neither balls nor pockets explain. */
static bool is_occluded(const struct vision *v, const struct vision_result *r)
{
	const struct scan *s = &v->detector.scan;
	double sum = 0;
	for (int cy = 0; cy < s->cells_y; cy++)
		for (int cx = 0; cx < s->cells_x; cx++) {
			double share = s->foreign[cy * s->cells_x + cx] / (double)(SCAN_CELL * SCAN_CELL);
			vec2 px = scan_to_full(s, (cx + 0.5) * SCAN_CELL, (cy + 0.5) * SCAN_CELL);
			if (share > OCCLUDED_SHARE && !is_explained(v, r, px))
				sum += share;
		}
	return sum > OCCLUDED_CELLS;
}

/* ---- single frames
 * --------------------------------------------------------------------------------------------------- */

static int check_frame(const struct vision *v, const struct image *frame, struct camera_intrinsics *in, char *err,
		       size_t err_size)
{
	if (camera_scale(&v->def.intrinsics, frame->width, frame->height, in))
		return 0;
	return vision_fail(-EINVAL, err, err_size, "a frame of %d x %d px does not fit a camera of %d x %d px",
			   frame->width, frame->height, v->def.intrinsics.width, v->def.intrinsics.height);
}

/* Why the balls of a calibrated frame are not known after all. */
static bool fail_frame(struct vision_result *r, const char *why)
{
	r->calibration = CALIBRATION_NONE;
	snprintf(r->reason, sizeof(r->reason), "%s", why);
	return false;
}

/* The frame as a whole into the detector. */
static bool search_whole(struct vision *v, const struct image *frame, struct vision_result *r)
{
	if (!detector_place(&v->detector, &r->camera))
		return fail_frame(r, "the table is not in the picture");
	if (!detector_frame(&v->detector, frame, &r->camera))
		return fail_frame(r, "no cloth is seen: too dark or too bright");
	return true;
}

static void report_single(const struct vision *v, struct vision_result *r)
{
	struct colour_feature look[VISION_BALL_MAX];
	const struct detector *d = &v->detector;
	for (int i = 0; i < d->count && i < VISION_BALL_MAX; i++) {
		r->ball[i] = ball_of(&d->candidate[i]);
		look[i] = d->candidate[i].look;
		r->ball_count++;
	}
	assign_colours(v, look, r);
	report_doubt(r, true);
	r->occluded = is_occluded(v, r);
}

int vision_detect(struct vision *vision, const struct image *frame, struct vision_result *out, char *err,
		  size_t err_size)
{
	struct vision_result r = {0};
	int rc = check_frame(vision, frame, &r.camera.in, err, err_size);
	if (rc < 0)
		return rc;
	/* The scan is shared with the stream, which must then begin with a whole frame again. */
	vision->tracking = false;
	vision->detector.count = 0;
	bool placed = calibration_single(&vision->single, frame, &r.camera.in, r.reason, sizeof(r.reason));
	stage_markers(vision->detector.watch, frame, &vision->single, vision->def.table);
	if (placed) {
		report_calibration(&vision->single, &r);
		if (search_whole(vision, frame, &r))
			report_single(vision, &r);
	} else {
		r.markers_seen = vision->single.now_count;
	}
	*out = r;
	return 0;
}

/* ---- streams
 * --------------------------------------------------------------------------------------------------------- */

static void report_tracks(struct vision *v, struct vision_result *r)
{
	struct colour_feature look[VISION_BALL_MAX];
	for (int i = 0; i < TRACK_MAX; i++) {
		const struct track *k = &v->tracker.track[i];
		if (k->id == 0 || !k->confirmed || r->ball_count == VISION_BALL_MAX)
			continue;
		struct vision_ball *b = &r->ball[r->ball_count];
		*b = ball_of(&k->seen);
		b->pos = k->steady.pos;
		b->vel = k->steady.vel;
		camera_project(&r->camera, b->pos, v->def.table->ball_radius, &b->px);
		b->track = k->id;
		b->age = k->age;
		b->doubt = k->disputed ? DOUBT_PLACE : 0;
		if (k->misses > 0) {
			b->confidence *= 0.5;
			b->doubt |= DOUBT_HIDDEN;
		}
		look[r->ball_count++] = k->look;
	}
	assign_colours(v, look, r);
	report_doubt(r, v->tracker.judged);
	v->cue_missing = (r->doubt & DOUBT_NO_CUE) != 0;
	r->occluded = v->tracker.occluded = is_occluded(v, r);
}

static bool is_resting(const struct vision *v)
{
	return v->still >= STILL_FRAMES;
}

static void take_look(struct vision *v, double time, struct vision_result *r)
{
	tracker_look(&v->tracker, time, !tracker_moves(&v->tracker));
	v->tracking = true;
	v->noise = -1;
	report_tracks(v, r);
}

/* The whole frame: at the start, after a bump, after a single frame in between. */
static void step_whole(struct vision *v, const struct image *frame, double time, struct vision_result *r)
{
	v->tracking = false;
	if (search_whole(v, frame, r))
		take_look(v, time, r);
}

/* The whole frame in the same place, which scan_changes() has copied. */
static void step_look(struct vision *v, const struct image *frame, double time, struct vision_result *r)
{
	v->tracking = false;
	if (detector_look(&v->detector, frame, &r->camera))
		take_look(v, time, r);
	else
		fail_frame(r, "no cloth is seen: too dark or too bright");
}

static void step_changes(struct vision *v, const struct image *frame, double time, struct vision_result *r)
{
	struct scan *s = &v->detector.scan;
	scan_update(s);
	tracker_step(&v->tracker, frame, &r->camera, time);
	scan_relearn(s);
	report_tracks(v, r);
}

/* Light that changes everywhere makes no cell differ from the others. */
static bool light_changed(struct vision *v)
{
	int usual = v->detector.scan.usual;
	if (v->noise < 0)
		v->noise = usual;
	return usual > LIGHT_FACTOR * v->noise + LIGHT_FLOOR;
}

/* Look at the whole frame rather than at what changed in it? gap: s since the last one; changed: cells. */
static bool wants_look(struct vision *v, double gap, int changed)
{
	v->still = changed == 0 || !tracker_moves(&v->tracker) ? v->still + (v->still < STILL_FRAMES) : 0;
	bool light = light_changed(v);
	if (gap > GAP && !is_resting(v))
		return true;
	return light || (is_resting(v) && tracker_wants_look(&v->tracker, v->time, v->cue_missing));
}

static void begin_frame(struct vision *v, const struct image *frame, double time)
{
	if (time < v->time || frame->width != v->width || frame->height != v->height)
		vision_reset(v);
	v->time = time;
	v->width = frame->width;
	v->height = frame->height;
}

int vision_track(struct vision *vision, const struct image *frame, double time, struct vision_result *out, char *err,
		 size_t err_size)
{
	struct vision_result r = {0};
	struct scan *s = &vision->detector.scan;
	int rc = check_frame(vision, frame, &r.camera.in, err, err_size);
	if (rc < 0)
		return rc;
	double gap = time - vision->time;
	begin_frame(vision, frame, time);
	int changed = vision->tracking ? scan_changes(s, frame) : 0;
	bool urgent = changed > BUMP_SHARE * s->cells_x * s->cells_y;
	const struct calibration_frame view = {frame, &r.camera.in, time, urgent};
	enum calibration_news news = calibration_track(&vision->stream, &view, r.reason, sizeof(r.reason));
	if (news == CALIBRATION_LOST) {
		r.markers_seen = vision->stream.now_count;
		vision->tracking = false;
		*out = r;
		return 0;
	}
	/* What became of a search does not matter while a pose holds. */
	r.reason[0] = '\0';
	report_calibration(&vision->stream, &r);
	r.pose_age = time - vision->stream.found;
	if (news == CALIBRATION_MOVED || !vision->tracking)
		step_whole(vision, frame, time, &r);
	else if (wants_look(vision, gap, changed))
		step_look(vision, frame, time, &r);
	else
		step_changes(vision, frame, time, &r);
	*out = r;
	return 0;
}
