/* An independent judge of entry times: extended precision, critical points by recursion, bisection only. */
#ifndef BILLIARD_TESTS_POLY_JUDGE_H
#define BILLIARD_TESTS_POLY_JUDGE_H

#include <stdbool.h>

enum { JUDGE_DEGREE = 4 };

/* Value, slope and a bound on what rounding in double may change of the value. */
long double judge_value(const long double c[JUDGE_DEGREE + 1], long double t);
long double judge_slope(const long double c[JUDGE_DEGREE + 1], long double t);
long double judge_noise(const long double c[JUDGE_DEGREE + 1], long double t);

struct judge_entry {
	bool certain;	   /* the polynomial falls below its noise somewhere in [0, horizon] */
	long double root;  /* the first such entry */
	long double below; /* a time up to which it has certainly come */
};
struct judge_entry judge_first_entry(const long double c[JUDGE_DEGREE + 1], long double horizon);

#endif
