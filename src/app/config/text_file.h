/* Whole text files into memory. */
#ifndef BILLIARD_APP_TEXT_FILE_H
#define BILLIARD_APP_TEXT_FILE_H

#include <stddef.h>

/* Reads a file ("-": standard input) of at most max bytes. 0, or a negative errno with "path: reason" in err: what
 * cannot be read, is a folder, is longer than max (-EFBIG) or holds a zero byte (-EBADMSG: not a text, or UTF-16). A byte order mark is left out. *text ends
 * with a zero, *size does not count it; caller frees. Both are untouched on failure. */
int text_file_read(const char *path, size_t max, char **text, size_t *size, char *err, size_t err_size);

#endif
