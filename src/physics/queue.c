#include "physics/queue.h"

#include <math.h>

static int row(int high)
{
	return high * (high - 1) / 2;
}

void queue_init(struct queue *queue, int count)
{
	queue->count = count;
	for (int i = 0; i < count; i++) {
		queue->own[i] = (struct event){INFINITY, EVENT_NONE, (int16_t)i, -1};
		queue->row_time[i] = INFINITY;
		queue->row_low[i] = -1;
	}
	for (int i = 0; i < row(count); i++)
		queue->pair[i] = INFINITY;
}

void queue_set_own(struct queue *queue, int ball, const struct event *event)
{
	queue->own[ball] = *event;
}

static void rescan(struct queue *queue, int high)
{
	const double *pair = &queue->pair[row(high)];
	double best = INFINITY;
	int low = -1;
	for (int i = 0; i < high; i++) {
		if (pair[i] < best) {
			best = pair[i];
			low = i;
		}
	}
	queue->row_time[high] = best;
	queue->row_low[high] = (int16_t)low;
}

void queue_set_pair(struct queue *queue, int low, int high, double time)
{
	queue->pair[row(high) + low] = time;
	double best = queue->row_time[high];
	if (time < best || (time == best && low < queue->row_low[high])) {
		queue->row_time[high] = time;
		queue->row_low[high] = (int16_t)low;
	} else if (queue->row_low[high] == low) {
		rescan(queue, high);
	}
}

double queue_pair(const struct queue *queue, int low, int high)
{
	return queue->pair[row(high) + low];
}

bool queue_first(const struct queue *queue, struct event *event)
{
	struct event best = {INFINITY, EVENT_NONE, -1, -1};
	for (int i = 0; i < queue->count; i++) {
		if (queue->own[i].time <= best.time && event_compare(&queue->own[i], &best) < 0)
			best = queue->own[i];
		if (queue->row_low[i] >= 0 && queue->row_time[i] <= best.time) {
			struct event e = {queue->row_time[i], EVENT_BALL_BALL, queue->row_low[i], (int16_t)i};
			if (best.time == INFINITY || event_compare(&e, &best) < 0)
				best = e;
		}
	}
	*event = best;
	return best.time < INFINITY;
}
