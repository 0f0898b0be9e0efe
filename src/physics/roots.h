/* Roots of the polynomials of degree 2 to 4 that contact times come from. Pure functions.
 * c[k] is the coefficient of t^k. */
#ifndef BILLIARD_PHYSICS_ROOTS_H
#define BILLIARD_PHYSICS_ROOTS_H

/* Real roots of a t^2 + b t + c in ascending order, without cancellation; a may be 0. Returns how many there are (a
 * double root counts once; none if all coefficients are 0). */
int roots_quadratic(double a, double b, double c, double root[2]);

/* Entry time: the earliest t in [0, horizon] at which the polynomial is not positive and falling, INFINITY if there is
 * none. That is the earliest approaching root of a distance; a start on the root (c[0] <= 0) counts only if the
 * polynomial falls there, and is else taken to lie exactly on it. 0 <= horizon < INFINITY. */
double roots_quadratic_entry(double c0, double c1, double c2, double horizon);

/* The same for a quartic; any leading coefficients may be 0. Guaranteed up to the rounding of the polynomial's own
 * value: [0, horizon] is cut at the inflection points, and Newton's iteration in a piece of one curvature cannot step
 * over a root. */
double roots_quartic_entry(const double c[5], double horizon);

#endif
