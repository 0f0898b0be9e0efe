#include "app/config/save.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int fail(const char *path, int code, char *err, size_t err_size)
{
	snprintf(err, err_size, "%s: %s", path, strerror(-code));
	return code;
}

static int write_all(int fd, const char *data, size_t size)
{
	while (size > 0) {
		ssize_t n = write(fd, data, size);
		if (n < 0 && errno != EINTR)
			return -errno;
		if (n > 0) {
			data += n;
			size -= (size_t)n;
		}
	}
	return 0;
}

/* Closing tells of errors, too: a network disk may notice only then that it is full. */
static int close_after(int fd, int code)
{
	return close(fd) < 0 && code == 0 ? -errno : code;
}

static int write_directly(const char *path, const void *data, size_t size)
{
	int fd = open(path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
	return fd < 0 ? -errno : close_after(fd, write_all(fd, data, size));
}

/* The name in its folder, so that the rename stays on one disk. A leftover of that name is of a process that is gone:
 * pids are one at a time. */
static int name_beside(const char *path, char out[PATH_MAX])
{
	const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
	int n = snprintf(out, PATH_MAX, "%.*s.%s.%d~", (int)(name - path), path, name, (int)getpid());
	return n < 0 || n >= PATH_MAX ? -ENAMETOOLONG : 0;
}

/* A rename is on the disk only when its folder is. Not every file system can sync a folder: then it is as good as it
 * gets. */
static void sync_folder(const char *path)
{
	char folder[PATH_MAX];
	const char *slash = strrchr(path, '/');
	snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path + 1) : 1, slash ? path : ".");
	int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
	if (fd < 0)
		return;
	fsync(fd);
	close(fd);
}

/* old: what the file is now, NULL when there is none. */
static int write_beside(const char *beside, const struct stat *old, const void *data, size_t size)
{
	unlink(beside);
	int fd = open(beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
	if (fd < 0)
		return -errno;
	int code = write_all(fd, data, size);
	if (code == 0 && old && (fchmod(fd, old->st_mode & 07777) < 0))
		code = -errno;
	if (old && fchown(fd, old->st_uid, old->st_gid) < 0 && errno != EPERM && code == 0)
		code = -errno;
	if (code == 0 && fsync(fd) < 0)
		code = -errno;
	return close_after(fd, code);
}

static int replace(const char *path, const struct stat *old, const void *data, size_t size)
{
	char beside[PATH_MAX];
	int code = name_beside(path, beside);
	if (code < 0)
		return code;
	code = write_beside(beside, old, data, size);
	if (code == 0 && rename(beside, path) < 0)
		code = -errno;
	if (code < 0)
		unlink(beside);
	else
		sync_folder(path);
	return code;
}

int save_file(const char *path, const void *data, size_t size, char *err, size_t err_size)
{
	struct stat old;
	bool there = stat(path, &old) == 0;
	if (there && S_ISDIR(old.st_mode))
		return fail(path, -EISDIR, err, err_size);
	if (there && !S_ISREG(old.st_mode)) {
		int code = write_directly(path, data, size);
		return code < 0 ? fail(path, code, err, err_size) : 0;
	}
	char real[PATH_MAX];
	const char *target = there && realpath(path, real) ? real : path;
	int code = replace(target, there ? &old : NULL, data, size);
	return code < 0 ? fail(path, code, err, err_size) : 0;
}

int save_backup(const char *path, char *err, size_t err_size)
{
	char backup[PATH_MAX], beside[PATH_MAX];
	int n = snprintf(backup, sizeof backup, "%s~", path);
	if (n < 0 || n >= PATH_MAX)
		return fail(path, -ENAMETOOLONG, err, err_size);
	int code = name_beside(backup, beside);
	if (code < 0)
		return fail(backup, code, err, err_size);
	/* Two names for one file: path is never away, and the next save_file() leaves the other alone. */
	unlink(beside);
	if (link(path, beside) < 0)
		return errno == ENOENT ? 0 : fail(backup, -errno, err, err_size);
	if (rename(beside, backup) < 0) {
		code = fail(backup, -errno, err, err_size);
		unlink(beside);
	}
	return code;
}
