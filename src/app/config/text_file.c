#include "app/config/text_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int fail(const char *path, const char *reason, int code, char *err, size_t err_size)
{
	snprintf(err, err_size, "%s: %s", path, reason);
	return code;
}

/* Opening a folder succeeds and only reading it fails, so it is asked for first. */
static int read_all(FILE *file, const char *path, size_t max, char *text, size_t *size, char *err, size_t err_size)
{
	struct stat info;
	if (fstat(fileno(file), &info) == 0 && S_ISDIR(info.st_mode))
		return fail(path, "is a folder", -EISDIR, err, err_size);
	size_t n = fread(text, 1, max + 1, file);
	if (ferror(file))
		return fail(path, strerror(errno), -EIO, err, err_size);
	if (n > max)
		return fail(path, "is too long", -EFBIG, err, err_size);
	if (memchr(text, 0, n))
		return fail(path, "is not a text (UTF-8 is wanted)", -EBADMSG, err, err_size);
	/* Some editors put a mark before UTF-8. */
	if (n >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)
		memmove(text, text + 3, n -= 3);
	text[n] = 0;
	*size = n;
	return 0;
}

int text_file_read(const char *path, size_t max, char **text, size_t *size, char *err, size_t err_size)
{
	FILE *file = strcmp(path, "-") == 0 ? stdin : fopen(path, "re");
	if (!file) {
		int code = -errno;
		return fail(path, strerror(-code), code, err, err_size);
	}
	char *buffer = malloc(max + 1);
	int code = buffer ? read_all(file, path, max, buffer, size, err, err_size)
			  : fail(path, "out of memory", -ENOMEM, err, err_size);
	if (file != stdin)
		fclose(file);
	if (code < 0)
		free(buffer);
	else
		*text = buffer;
	return code;
}
