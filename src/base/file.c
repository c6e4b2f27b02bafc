#include "base/base.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static camber_status fail_errno(camber_context *context, const char *path) {
    const int cause = errno;
    const camber_status status = cause == ENOENT || cause == ENOTDIR ? CAMBER_ERROR_NOT_FOUND : CAMBER_ERROR_IO;
    return camber_fail(context, status, "%s: cannot be read: %s; check the path and its permissions", path,
                       strerror(cause));
}

static camber_status read_stream(camber_context *context, FILE *file, const char *path, char **bytes,
                                 size_t *size_bytes) {
    char *block = NULL;
    size_t capacity = 0, size = 0;
    camber_status status = CAMBER_ERROR_MEMORY;
    for (;;) {
        if (!camber_grow(context, &block, &capacity, size + 65536, 1))
            goto done;
        const size_t got = fread(block + size, 1, capacity - size - 1, file);
        size += got;
        if (got == 0)
            break;
    }
    if (ferror(file)) {
        status = fail_errno(context, path);
        goto done;
    }
    block[size] = 0;
    *bytes = block;
    *size_bytes = size;
    return CAMBER_OK;
done:
    camber_free(context, block);
    return status;
}

camber_status camber_read_file(camber_context *context, const char *path, char **bytes, size_t *size_bytes) {
    struct stat about;
    if (stat(path, &about) != 0)
        return fail_errno(context, path);
    if (S_ISDIR(about.st_mode))
        return camber_fail(context, CAMBER_ERROR_INPUT, "%s: is a directory; name a file in it", path);
    FILE *file = fopen(path, "rb");
    if (!file)
        return fail_errno(context, path);
    const camber_status status = read_stream(context, file, path, bytes, size_bytes);
    fclose(file);
    return status;
}

uint64_t camber_hash(uint64_t hash, const void *bytes, size_t size_bytes) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size_bytes; i++)
        hash = (hash ^ byte[i]) * 1099511628211ull;
    return hash;
}
