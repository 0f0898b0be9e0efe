/* The reference: plain_sim.c in long double. */
#define REAL	       long double
#define PLAIN_RUN      plain_run_long
#define PLAIN_BRACKETS 1
#include "plain_sim.c"
