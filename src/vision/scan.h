/* The quick look over a whole frame: a smaller copy of the bed, the cloth's colour per place, and how little each pixel
 * looks like cloth (lit, shaded or plain). Everything finer is done by fit.h on the full frame. */
#ifndef BILLIARD_VISION_SCAN_H
#define BILLIARD_VISION_SCAN_H

#include <stdbool.h>

#include "physics/table.h"
#include "vision/camera.h"
#include "vision/image.h"

enum {
	SCAN_CELL = 16,	   /* small pixels a side of a cell of the cloth's colour */
	SCAN_FOREIGN = 128 /* marks from here on are not cloth */
};

struct scan {
	int capacity;	   /* small pixels there is room for */
	int factor;	   /* full pixels a side of a small one */
	int x0, y0;	   /* full pixel where the small picture begins */
	int width, height; /* small pixels */
	int cells_x, cells_y;
	uint8_t *bgr;		    /* width x height x 3 */
	uint8_t *mark;		    /* 0 cloth .. 255 surely something else; 0 outside of the bed */
	int16_t *row_from, *row_to; /* columns [from, to) of the bed in each row */
	float *cell;		    /* cells_x x cells_y x 3: cloth, BGR */
	float *cell_weight;
	float cloth[3];	      /* of the whole bed, BGR */
	uint8_t *reference;   /* what the marks were made from: bgr as it was then */
	uint8_t *changed;     /* per cell: there is something new in it or beside it; after a whole frame: anything but
				 cloth */
	uint16_t *foreign;    /* per cell: pixels that are not cloth */
	uint16_t *half;	      /* per cell: pixels that may not be; behind foreign */
	uint16_t *difference; /* per cell: mean absolute difference, 1/16 level */
	int usual;	      /* the usual one of these: noise, or light that is not what it was */
	int relearn_row;      /* of cells: the next to be learned again */
};

/* Room for frames of up to width x height at factor 1. 0 or -ENOMEM. */
int scan_init(struct scan *scan, int width, int height);
void scan_finish(struct scan *scan);

/* Where the bed lies in the frame and how much smaller the copy is: call whenever the pose or the frame's size changes.
 * False, and everything stays as it was, when the bed is not in the picture. */
bool scan_place(struct scan *scan, const struct camera *camera, const struct table *table);
/* Copies, learns the cloth, marks. False when nothing like an even cloth is seen (black, overexposed...). */
bool scan_frame(struct scan *scan, const struct image *frame);
/* The same of the frame that scan_changes() has copied. */
bool scan_again(struct scan *scan);
/* The next frame of a tracked table: copies it and finds the cells that changed (with those around them). Returns how
 * many; they are in scan->changed until the next call. */
int scan_changes(struct scan *scan, const struct image *frame);
/* Marks the changed cells anew. */
void scan_update(struct scan *scan);
/* Learns the cloth of the next row of cells again: light drifts. */
void scan_relearn(struct scan *scan);
/* Cloth colour, BGR, at a full pixel. */
void scan_cloth_at(const struct scan *scan, vec2 px, float out[3]);
/* Full pixel of a small pixel's middle, and the reverse. */
vec2 scan_to_full(const struct scan *scan, double x, double y);
vec2 scan_from_full(const struct scan *scan, vec2 px);

#endif
