#include "base/base.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* ---- Cache ---- */

enum { PATH_SIZE = 1024, LARGEST_BYTES = 64 << 20 };

/* The folder, made where it is missing; false: no cache. */
static bool cache_folder(const camber_context *context, char folder[PATH_SIZE]) {
    int length;
    const char *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (context->desc.cache_dir)
        length = snprintf(folder, PATH_SIZE, "%s", context->desc.cache_dir);
    else if (xdg && xdg[0] == '/')
        length = snprintf(folder, PATH_SIZE, "%s/camber", xdg);
    else if (home && home[0] == '/')
        length = snprintf(folder, PATH_SIZE, "%s/.cache/camber", home);
    else
        return false;
    return length > 0 && length < PATH_SIZE;
}

static bool make_folders(char *folder) {
    for (char *slash = strchr(folder + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        const int made = mkdir(folder, 0700);
        *slash = '/';
        if (made != 0 && errno != EEXIST)
            return false;
    }
    return mkdir(folder, 0700) == 0 || errno == EEXIST;
}

bool camber_cache_is_on(const camber_context *context) {
    char folder[PATH_SIZE];
    return cache_folder(context, folder);
}

bool camber_cache_load(camber_context *context, const char *name, char **bytes, size_t *size_bytes) {
    char folder[PATH_SIZE], path[PATH_SIZE + 256];
    if (!cache_folder(context, folder))
        return false;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    struct stat about;
    if (stat(path, &about) != 0 || !S_ISREG(about.st_mode) || about.st_size > LARGEST_BYTES)
        return false;
    camber_soft_log kept;
    camber_log_soften(context, &kept);
    const camber_status status = camber_read_file(context, path, bytes, size_bytes);
    camber_log_restore(context, &kept);
    return status == CAMBER_OK;
}

void camber_cache_save(camber_context *context, const char *name, const void *bytes, size_t size_bytes) {
    char folder[PATH_SIZE], path[PATH_SIZE + 256], beside[PATH_SIZE + 320];
    if (!cache_folder(context, folder) || !make_folders(folder))
        return;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    snprintf(beside, sizeof beside, "%s.XXXXXX", path);
    const int handle = mkstemp(beside);
    if (handle < 0)
        return;
    FILE *file = fdopen(handle, "wb");
    if (!file) {
        close(handle);
        unlink(beside);
        return;
    }
    bool whole = fwrite(bytes, 1, size_bytes, file) == size_bytes;
    whole = fclose(file) == 0 && whole;
    if (!whole || rename(beside, path) != 0)
        unlink(beside);
}
