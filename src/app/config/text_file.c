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
static int read_all(FILE *file, size_t max, char *text, size_t *size, const char **reason)
{
	struct stat info;
	*reason = "is a folder";
	if (fstat(fileno(file), &info) == 0 && S_ISDIR(info.st_mode))
		return -EISDIR;
	size_t n = fread(text, 1, max + 1, file);
	*reason = strerror(errno);
	if (ferror(file))
		return -EIO;
	*reason = "is too long";
	if (n > max)
		return -EFBIG;
	*reason = "is not a text (UTF-8 is wanted)";
	if (memchr(text, 0, n))
		return -EBADMSG;
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
	const char *reason = "out of memory";
	int code = buffer ? read_all(file, max, buffer, size, &reason) : -ENOMEM;
	if (code < 0)
		fail(path, reason, code, err, err_size);
	if (file != stdin)
		fclose(file);
	if (code < 0)
		free(buffer);
	else
		*text = buffer;
	return code;
}
