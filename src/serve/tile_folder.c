/* Reads and writes tiles of a folder. */
#define _XOPEN_SOURCE 700

#include "serve/tile_folder.h"

#include "serve/cached_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LARGEST_TILE_BYTES = 64 << 20 };

static bool name_tile(const camber_tile_folder *folder, uint64_t input, camber_tile_key key, char path[PATH_MAX]) {
    const uint64_t low = (UINT64_C(1) << 28) - 1;
    return snprintf(path, PATH_MAX, "%s/%016" PRIx64 "/%" PRIx64 "/%" PRIu64 "/%" PRIu64 "/%" PRIu64, folder->path,
                    input, key.look, key.place >> 56, key.place >> 28 & low, key.place & low) < PATH_MAX;
}

static bool read_all(int file, unsigned char *bytes, size_t size_bytes) {
    while (size_bytes > 0) {
        const ssize_t got = read(file, bytes, size_bytes);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        bytes += got;
        size_bytes -= (size_t)got;
    }
    return true;
}

static camber_body *read_body(int file) {
    struct stat about;
    if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode) || about.st_size <= 0 || about.st_size > LARGEST_TILE_BYTES)
        return NULL;
    const size_t size_bytes = (size_t)about.st_size;
    unsigned char *bytes = malloc(size_bytes);
    camber_body *body = bytes && read_all(file, bytes, size_bytes) ? camber_body_create(bytes, size_bytes) : NULL;
    free(bytes);
    return body;
}

camber_body *camber_body_read(const char *path) {
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return NULL;
    camber_body *body = read_body(file);
    close(file);
    return body;
}

camber_body *camber_tile_folder_get(const camber_tile_folder *folder, uint64_t input, camber_tile_key key) {
    char path[PATH_MAX];
    return name_tile(folder, input, key, path) ? camber_body_read(path) : NULL;
}

void camber_tile_folder_put(camber_tile_folder *folder, uint64_t input, camber_tile_key key, const camber_body *body) {
    char path[PATH_MAX], message[512];
    const camber_file_part part = {body->bytes, body->size_bytes};
    const int cause = name_tile(folder, input, key, path)
                          ? camber_cached_file_write(path, strlen(folder->path) + 1, &part, 1)
                          : ENAMETOOLONG;
    if (atomic_exchange(&folder->fails, cause != 0) || !cause)
        return;
    snprintf(message, sizeof message, "%s: %s; free some space, or let it be written to; tiles are served all the same",
             folder->path, strerror(cause));
    folder->failed(folder->user, message);
}
