/* Small dense systems of linear equations. */
#ifndef BILLIARD_VISION_LINEAR_H
#define BILLIARD_VISION_LINEAR_H

#include <stdbool.h>

/* Solves a x = b for a symmetric positive definite n x n matrix, row by row; a is destroyed, b becomes x.
 * False when a is not positive definite (b is then undefined). */
bool solve_spd(double *a, double *b, int n);

#endif
