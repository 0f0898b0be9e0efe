#include "app/process/text.h"

#include <glib.h>
#include <string.h>

void text_get(char *out, size_t size, const uint8_t *bytes, size_t byte_count)
{
	size_t n = 0;
	for (; n + 1 < size && n < byte_count && bytes[n]; n++)
		out[n] = bytes[n] < ' ' || bytes[n] == 127 ? '?' : (char)bytes[n];
	out[n] = '\0';
	/* Texts are cut by the byte on their way here. */
	const char *bad;
	while (!g_utf8_validate(out, -1, &bad))
		out[bad - out] = '?';
}

void text_set(uint8_t *bytes, size_t byte_count, const char *text)
{
	size_t n = strnlen(text, byte_count - 1);
	memcpy(bytes, text, n);
	memset(bytes + n, 0, byte_count - n);
}
