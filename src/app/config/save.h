/* Files that are whole or not there: written beside their place, synced, renamed. The counterpart of text_file.h. */
#ifndef BILLIARD_APP_SAVE_H
#define BILLIARD_APP_SAVE_H

#include <stddef.h>

/* Puts size bytes into the file. What was there stays untouched until all of the new is on the disk, also when the disk
 * is full or the power goes; permissions and a symbolic link on the way are kept. A device or pipe (/dev/stdout) is
 * written to directly. 0, or a negative errno with "path: reason" in err. */
int save_file(const char *path, const void *data, size_t size, char *err, size_t err_size);

/* Keeps the present file as path~, replacing an older one; 0 also when there is none. Else a negative errno with the
 * reason in err, and path is untouched. */
int save_backup(const char *path, char *err, size_t err_size);

#endif
