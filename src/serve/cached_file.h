/* Files of a folder of tiles. They appear whole or not at all; nothing is synced, since each can be drawn again. */
#ifndef CAMBER_SERVE_CACHED_FILE_H
#define CAMBER_SERVE_CACHED_FILE_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes that follow each other in a file. */
typedef struct camber_file_part {
    const void *bytes;
    size_t size_bytes;
} camber_file_part;

/* Writes a file beside its path, and renames it. Folders of the path behind its first `there` letters are made. Returns
 * 0 or an errno. */
int camber_cached_file_write(const char *path, size_t there, const camber_file_part *parts, size_t count);

#endif
