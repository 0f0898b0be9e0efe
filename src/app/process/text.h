/* Texts of messages: byte[] members, NUL padded. Pure. */
#ifndef BILLIARD_APP_TEXT_H
#define BILLIARD_APP_TEXT_H

#include <stddef.h>
#include <stdint.h>

/* Text of a byte[] member as a C string of at most size - 1 bytes (size >= 1), always terminated. Control characters and what is no UTF-8
 * become '?'. */
void text_get(char *out, size_t size, const uint8_t *bytes, size_t byte_count);
/* The other way: cut to fit, padded with NUL. byte_count >= 1. */
void text_set(uint8_t *bytes, size_t byte_count, const char *text);

#endif
