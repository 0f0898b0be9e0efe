/* How the vision module says why something failed. */
#ifndef BILLIARD_VISION_REASON_H
#define BILLIARD_VISION_REASON_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Writes the reason into err (err_size 0: nothing) and returns code. */
__attribute__((format(printf, 4, 5))) int vision_fail(int code, char *err, size_t err_size, const char *format, ...);

#ifdef __cplusplus
}
#endif

#endif
