/* Colour parameter files: refused with a reason or read. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "app/config/colour_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct colour_model model;
	int fd = memfd_create("fuzz", 0);
	if (fd < 0 || write(fd, data, size) != (ssize_t)size)
		abort();
	char path[32], err[640] = "";
	snprintf(path, sizeof path, "/dev/fd/%d", fd);
	if (colour_file_read(path, &model, err, sizeof err) < 0 && !err[0])
		abort();
	close(fd);
	return 0;
}
