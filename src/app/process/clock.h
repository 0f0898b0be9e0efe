/* The clocks of the processes. */
#ifndef BILLIARD_APP_CLOCK_H
#define BILLIARD_APP_CLOCK_H

#include <stdint.h>

/* us since 1970, as messages carry it; jumps when the clock is set. */
int64_t clock_utime(void);
/* s since any time, monotonic. */
double clock_seconds(void);

#endif
