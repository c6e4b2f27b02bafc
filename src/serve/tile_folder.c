/* Reads and writes tiles in a folder. */
#define _XOPEN_SOURCE 700

#include "serve/tile_folder.h"

#include "base/open_file.h"
#include "base/whole_file.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_TILE_BYTES = 64 << 20, NAME_SIZE = 128, TAG_BYTES = 26 };

static void name_tile(uint64_t input, camber_tile_key key, char name[NAME_SIZE]) {
    const uint64_t low = (UINT64_C(1) << 28) - 1;
    snprintf(name, NAME_SIZE, "%016" PRIx64 "/%" PRIx64 "/%" PRIu64 "/%" PRIu64 "/%" PRIu64, input, key.look,
             key.place >> 56, key.place >> 28 & low, key.place & low);
}

static unsigned char *read_bytes(int file, const struct stat *about) {
    if (!S_ISREG(about->st_mode) || about->st_size <= 0 || about->st_size > LARGEST_TILE_BYTES)
        return NULL;
    const size_t size_bytes = (size_t)about->st_size;
    unsigned char *bytes = malloc(size_bytes);
    size_t done;
    if (bytes && camber_file_read(file, bytes, size_bytes, 0, &done) == 0 && done == size_bytes)
        return bytes;
    free(bytes);
    return NULL;
}

/* tagged: the body's tag is at the end of the file. */
static camber_body *read_body(const char *folder, const char *name, bool tagged) {
    struct stat about;
    const size_t tag_bytes = tagged ? TAG_BYTES : 0;
    const int file = camber_open_file_below(folder, name, &about);
    unsigned char *bytes = file >= 0 ? read_bytes(file, &about) : NULL;
    if (file >= 0)
        close(file);
    const size_t size_bytes = bytes && (size_t)about.st_size > tag_bytes ? (size_t)about.st_size - tag_bytes : 0;
    camber_body *body = size_bytes ? camber_body_create(bytes, size_bytes) : NULL;
    if (body && memcmp(body->etag, bytes + size_bytes, tag_bytes) != 0) {
        camber_body_release(body);
        body = NULL;
    }
    free(bytes);
    return body;
}

camber_body *camber_body_read(const char *folder, const char *name) {
    return read_body(folder, name, false);
}

camber_body *camber_tile_folder_get(const camber_tile_folder *folder, uint64_t input, camber_tile_key key) {
    char name[NAME_SIZE];
    name_tile(input, key, name);
    return read_body(folder->path, name, true);
}

void camber_tile_folder_put(camber_tile_folder *folder, uint64_t input, camber_tile_key key, const camber_body *body) {
    char path[PATH_MAX], name[NAME_SIZE], message[512];
    const camber_file_part parts[] = {{body->bytes, body->size_bytes}, {body->etag, TAG_BYTES}};
    name_tile(input, key, name);
    const int cause = snprintf(path, sizeof path, "%s/%s", folder->path, name) < (int)sizeof path
                          ? camber_whole_file_write(path, strlen(folder->path) + 1, 0644, parts, 2)
                          : ENAMETOOLONG;
    if (atomic_exchange(&folder->fails, cause != 0) || !cause)
        return;
    snprintf(message, sizeof message, "%s: %s; free some space, or make it writable; tiles are still served",
             folder->path, strerror(cause));
    folder->failed(folder->user, message);
}
