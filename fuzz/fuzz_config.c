/* Configuration files, damaged or made up: refused with a reason, or every value in range. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "app/config/config.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	static struct config config;
	int fd = memfd_create("fuzz", 0);
	if (fd < 0 || write(fd, data, size) != (ssize_t)size)
		abort();
	char path[32], err[640] = "";
	snprintf(path, sizeof path, "/dev/fd/%d", fd);
	int code = config_load(&config, path, err, sizeof err);
	close(fd);
	if (code < 0 ? err[0] == 0 : !(config.table.ball_radius > 0.009 && config.table.ball_radius < 0.041))
		abort();
	return 0;
}
