#include "vision/calibration.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "physics/vec2.h"
#include "vision/camera.h"
#include "vision/marker_edges.h"

enum { AVERAGED_MAX = 50, FULL_SEARCH_EVERY = 5 };
static const double BUMP_PX = 1.5; /* at 1280 px: corners further off than this were moved, not noisy */

int calibration_init(struct calibration *c, const struct marker_layout *layout, double interval, double keep, char *err,
		     size_t err_size)
{
	*c = (struct calibration){.layout = layout, .interval = interval, .keep = keep};
	return marker_finder_create(&c->finder, layout->dictionary_count, layout->dictionary_bits, err, err_size);
}

void calibration_finish(struct calibration *c)
{
	marker_finder_destroy(c->finder);
	c->finder = NULL;
}

void calibration_reset(struct calibration *c)
{
	c->valid = false;
	c->seen_count = c->now_count = c->partial = 0;
}

/* Markers that do not belong to the layout are somebody else's; the others' corners are refined. */
static int keep_known(const struct marker_layout *layout, const struct image *frame, struct marker_view *view,
		      int count)
{
	int kept = 0;
	for (int i = 0; i < count; i++)
		for (int k = 0; k < layout->count; k++)
			if (view[i].id == layout->marker[k].id) {
				view[kept] = view[i];
				marker_refine(frame, layout->dictionary_bits + 2, &view[kept++]);
				break;
			}
	return kept;
}

static bool find_pose(struct calibration *c, const struct marker_view *view, int count,
		      const struct camera_intrinsics *in)
{
	struct camera camera = {.in = *in};
	struct pose_fit fit;
	if (!pose_from_markers(c->layout, view, count, &camera, &fit))
		return false;
	c->camera = camera;
	c->fit = fit;
	c->valid = true;
	return true;
}

/* Why there was no pose. */
static void say_why(const struct calibration *c, int count, char *reason, size_t reason_size)
{
	if (count < 3)
		snprintf(reason, reason_size, "%d of %d markers seen, 3 are needed", count, c->layout->count);
	else
		snprintf(reason, reason_size, "the %d markers seen do not fit the table", count);
}

static void begin_average(struct calibration *c, const struct marker_view *view, int count)
{
	memcpy(c->seen, view, sizeof(*view) * (size_t)count);
	c->seen_count = count;
	for (int i = 0; i < count; i++)
		c->averaged[i] = 1;
}

bool calibration_single(struct calibration *c, const struct image *frame, const struct camera_intrinsics *in,
			char *reason, size_t reason_size)
{
	struct marker_view view[MARKER_MAX];
	int count = keep_known(c->layout, frame, view, marker_find(c->finder, frame, view, MARKER_MAX));
	calibration_reset(c);
	c->now_count = count;
	if (!find_pose(c, view, count, in)) {
		say_why(c, count, reason, reason_size);
		return false;
	}
	begin_average(c, view, count);
	return true;
}

/* Index of a marker among those averaged, -1 when it has not been seen yet. */
static int known_marker(const struct calibration *c, int id)
{
	for (int i = 0; i < c->seen_count; i++)
		if (c->seen[i].id == id)
			return i;
	return -1;
}

/* Largest distance of a marker's middle from where it was, px. */
static double moved_px(const struct calibration *c, const struct marker_view *view, int count)
{
	double most = 0;
	for (int i = 0; i < count; i++) {
		int at = known_marker(c, view[i].id);
		double dx = 0, dy = 0;
		for (int k = 0; k < 4 && at >= 0; k++) {
			dx += (view[i].x[k] - c->seen[at].x[k]) / 4;
			dy += (view[i].y[k] - c->seen[at].y[k]) / 4;
		}
		most = fmax(most, hypot(dx, dy));
	}
	return most;
}

/* Each marker by the frames that it was seen in: one that comes late is as noisy as the others were. */
static void average(struct calibration *c, const struct marker_view *view, int count)
{
	for (int i = 0; i < count; i++) {
		int at = known_marker(c, view[i].id);
		if (at < 0 && c->seen_count < MARKER_MAX) {
			at = c->seen_count++;
			c->seen[at] = view[i];
			c->averaged[at] = 1;
			continue;
		}
		if (at < 0)
			continue;
		struct marker_view *mean = &c->seen[at];
		c->averaged[at] += c->averaged[at] < AVERAGED_MAX;
		for (int k = 0; k < 4; k++) {
			mean->x[k] += (view[i].x[k] - mean->x[k]) / c->averaged[at];
			mean->y[k] += (view[i].y[k] - mean->y[k]) / c->averaged[at];
		}
	}
}

/* Where a marker that has not been seen yet must be by the pose. */
static bool expected_view(const struct calibration *c, int i, struct marker_view *out)
{
	static const double sx[4] = {-1, 1, 1, -1}, sy[4] = {1, 1, -1, -1};
	double half = c->layout->side / 2;
	out->id = c->layout->marker[i].id;
	for (int k = 0; k < 4; k++) {
		vec2 px, corner = {half * sx[k], half * sy[k]};
		if (!camera_project(&c->camera, vec2_add(c->layout->marker[i].centre, corner), c->layout->height, &px))
			return false;
		out->x[k] = px.x;
		out->y[k] = px.y;
	}
	return true;
}

/* Places to look at: where markers were, then where those are that were covered all the time. */
static int places(const struct calibration *c, struct marker_view out[MARKER_MAX])
{
	int count = c->seen_count;
	memcpy(out, c->seen, sizeof(*out) * (size_t)count);
	for (int i = 0; i < c->layout->count && count < MARKER_MAX; i++)
		if (known_marker(c, c->layout->marker[i].id) < 0 && expected_view(c, i, &out[count]))
			count++;
	return count;
}

static int search(struct calibration *c, const struct image *frame, struct marker_view view[MARKER_MAX])
{
	struct marker_view near[MARKER_MAX];
	int count = marker_find_near(c->finder, frame, near, places(c, near), view, MARKER_MAX);
	count = keep_known(c->layout, frame, view, count);
	c->partial = count < c->seen_count ? c->partial + 1 : 0;
	/* Not where they were: covered, or the camera looks elsewhere. The whole frame is dear, so not every time. */
	if (count < 3 && c->partial % FULL_SEARCH_EVERY == 1)
		count = keep_known(c->layout, frame, view, marker_find(c->finder, frame, view, MARKER_MAX));
	return count;
}

static enum calibration_news begin(struct calibration *c, const struct calibration_frame *frame, char *reason,
				   size_t reason_size)
{
	if (!calibration_single(c, frame->image, frame->in, reason, reason_size))
		return CALIBRATION_LOST;
	c->searched = c->found = frame->time;
	return CALIBRATION_MOVED;
}

static enum calibration_news without(struct calibration *c, double time, char *reason, size_t reason_size)
{
	if (time - c->found <= c->keep)
		return CALIBRATION_SAME;
	snprintf(reason, reason_size, "no markers for %.0f s", time - c->found);
	calibration_reset(c);
	return CALIBRATION_LOST;
}

enum calibration_news calibration_track(struct calibration *c, const struct calibration_frame *frame, char *reason,
					size_t reason_size)
{
	struct marker_view view[MARKER_MAX];
	if (!c->valid)
		return begin(c, frame, reason, reason_size);
	if (frame->time - c->searched < c->interval && !frame->urgent)
		return CALIBRATION_SAME;
	c->searched = frame->time;
	int count = c->now_count = search(c, frame->image, view);
	if (count < 3)
		return without(c, frame->time, reason, reason_size);
	c->found = frame->time;
	if (moved_px(c, view, count) > BUMP_PX * frame->in->width / 1280) {
		begin_average(c, view, count);
		if (find_pose(c, view, count, frame->in))
			return CALIBRATION_MOVED;
		say_why(c, count, reason, reason_size);
		return without(c, frame->time, reason, reason_size);
	}
	average(c, view, count);
	if (!find_pose(c, c->seen, c->seen_count, frame->in))
		say_why(c, c->seen_count, reason, reason_size);
	return CALIBRATION_REFINED;
}
