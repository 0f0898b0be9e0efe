#include "vision/calibration.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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
	c->seen_count = c->averaged = c->now_count = c->partial = 0;
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
		      const struct camera_intrinsics *in, char *reason, size_t reason_size)
{
	struct camera camera = {.in = *in};
	struct pose_fit fit;
	if (pose_from_markers(c->layout, view, count, &camera, &fit)) {
		c->camera = camera;
		c->fit = fit;
		c->valid = true;
		return true;
	}
	if (count < 3)
		snprintf(reason, reason_size, "%d of %d markers seen, 3 are needed", count, c->layout->count);
	else
		snprintf(reason, reason_size, "the %d markers seen do not fit the table", count);
	return false;
}

bool calibration_single(struct calibration *c, const struct image *frame, const struct camera_intrinsics *in,
			char *reason, size_t reason_size)
{
	struct marker_view view[MARKER_MAX];
	int count = keep_known(c->layout, frame, view, marker_find(c->finder, frame, view, MARKER_MAX));
	calibration_reset(c);
	c->now_count = count;
	if (!find_pose(c, view, count, in, reason, reason_size))
		return false;
	memcpy(c->seen, view, sizeof(*view) * (size_t)count);
	c->seen_count = count;
	c->averaged = 1;
	return true;
}

static struct marker_view *known_view(struct calibration *c, int id)
{
	for (int i = 0; i < c->seen_count; i++)
		if (c->seen[i].id == id)
			return &c->seen[i];
	return NULL;
}

/* Largest distance of a marker's middle from where it was, px. */
static double moved_px(struct calibration *c, const struct marker_view *view, int count)
{
	double most = 0;
	for (int i = 0; i < count; i++) {
		const struct marker_view *old = known_view(c, view[i].id);
		double dx = 0, dy = 0;
		for (int k = 0; k < 4 && old; k++) {
			dx += (view[i].x[k] - old->x[k]) / 4;
			dy += (view[i].y[k] - old->y[k]) / 4;
		}
		most = fmax(most, hypot(dx, dy));
	}
	return most;
}

static void average(struct calibration *c, const struct marker_view *view, int count)
{
	if (c->averaged < AVERAGED_MAX)
		c->averaged++;
	for (int i = 0; i < count; i++) {
		struct marker_view *old = known_view(c, view[i].id);
		if (!old && c->seen_count < MARKER_MAX) {
			c->seen[c->seen_count++] = view[i];
			continue;
		}
		for (int k = 0; k < 4 && old; k++) {
			old->x[k] += (view[i].x[k] - old->x[k]) / c->averaged;
			old->y[k] += (view[i].y[k] - old->y[k]) / c->averaged;
		}
	}
}

static int search(struct calibration *c, const struct image *frame, struct marker_view view[MARKER_MAX])
{
	int count = marker_find_near(c->finder, frame, c->seen, c->seen_count, view, MARKER_MAX);
	count = keep_known(c->layout, frame, view, count);
	c->partial = count < c->seen_count ? c->partial + 1 : 0;
	/* Not where they were: covered, or the camera looks elsewhere. The whole frame is dear, so not every time. */
	if (count < 3 && c->partial % FULL_SEARCH_EVERY == 1)
		count = keep_known(c->layout, frame, view, marker_find(c->finder, frame, view, MARKER_MAX));
	return count;
}

static enum calibration_news begin(struct calibration *c, const struct image *frame, const struct camera_intrinsics *in,
				   double time, char *reason, size_t reason_size)
{
	if (!calibration_single(c, frame, in, reason, reason_size))
		return CALIBRATION_LOST;
	c->searched = c->found = time;
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

enum calibration_news calibration_track(struct calibration *c, const struct image *frame,
					const struct camera_intrinsics *in, double time, bool urgent, char *reason,
					size_t reason_size)
{
	struct marker_view view[MARKER_MAX];
	if (!c->valid)
		return begin(c, frame, in, time, reason, reason_size);
	if (time - c->searched < c->interval && !urgent)
		return CALIBRATION_SAME;
	c->searched = time;
	int count = c->now_count = search(c, frame, view);
	if (count < 3)
		return without(c, time, reason, reason_size);
	c->found = time;
	if (moved_px(c, view, count) > BUMP_PX * in->width / 1280) {
		memcpy(c->seen, view, sizeof(*view) * (size_t)count);
		c->seen_count = count;
		c->averaged = 1;
		return find_pose(c, view, count, in, reason, reason_size) ? CALIBRATION_MOVED
									  : without(c, time, reason, reason_size);
	}
	average(c, view, count);
	find_pose(c, c->seen, c->seen_count, in, reason, reason_size);
	return CALIBRATION_REFINED;
}
