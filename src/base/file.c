/* Opens and reads the files that camber is given or that a style names. It checks a file before reading it: the file
 * must be a regular file, not the output, and, if a style names it, inside the context's root. */
#define _XOPEN_SOURCE 700 /* realpath */

#include "base/base.h"
#include "base/open_file.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

camber_status camber_file_fail(camber_context *context, const char *path, int cause) {
    if (cause == EMFILE || cause == ENFILE)
        return camber_fail(context, CAMBER_ERROR_IO, "%s: cannot be read: too many open files; allow more (ulimit -n)",
                           path);
    if (cause == ELOOP)
        return camber_fail(
            context, CAMBER_ERROR_INPUT,
            "%s: is a link, or inside one, and links are not followed there; put the file itself there (cp -rL)", path);
    const camber_status status = cause == ENOENT || cause == ENOTDIR ? CAMBER_ERROR_NOT_FOUND : CAMBER_ERROR_IO;
    return camber_fail(context, status, "%s: cannot be read: %s; check the path and its permissions", path,
                       strerror(cause));
}

/* ---- Access ---- */

static camber_status check_kind(camber_context *context, const char *path, const struct stat *about) {
    if (S_ISREG(about->st_mode))
        return CAMBER_OK;
    if (S_ISDIR(about->st_mode))
        return camber_fail(context, CAMBER_ERROR_INPUT, "%s: is a folder; name a file in it", path);
    return camber_fail(context, CAMBER_ERROR_INPUT, "%s: is a device or a pipe; copy its data to a file", path);
}

/* Resolves links. For a file that does not exist, resolves the closest folder above it that does. */
static bool resolve(const char *path, char found[PATH_MAX]) {
    char above[PATH_MAX];
    if (snprintf(above, sizeof above, "%s%s", path[0] == '/' ? "" : "./", path) >= (int)sizeof above)
        return false;
    while (!realpath(above, found)) {
        char *slash = strrchr(above, '/');
        if ((errno != ENOENT && errno != ENOTDIR) || !slash || slash == above || strcmp(slash, "/..") == 0)
            return false;
        *slash = 0;
    }
    return true;
}

bool camber_file_is_reached(const camber_context *context, const char *path) {
    const char *folder = context->desc.access.root;
    char found[PATH_MAX], root[PATH_MAX];
    if (!folder)
        return true;
    if (!realpath(folder, root) || !resolve(path, found))
        return false;
    const size_t length = strcmp(root, "/") == 0 ? 0 : strlen(root);
    return strncmp(found, root, length) == 0 && (found[length] == '/' || found[length] == 0);
}

static bool is_output(const camber_context *context, const struct stat *about) {
    const camber_access *access = &context->desc.access;
    for (size_t i = 0; i < sizeof access->outputs / sizeof *access->outputs; i++) {
        struct stat other;
        if (access->outputs[i] && stat(access->outputs[i], &other) == 0 && other.st_dev == about->st_dev &&
            other.st_ino == about->st_ino)
            return true;
    }
    return false;
}

static camber_status check_access(camber_context *context, const char *path, const struct stat *about) {
    const camber_status status = check_kind(context, path, about);
    if (status != CAMBER_OK || !is_output(context, about))
        return status;
    return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                       "%s: is an input, and would be overwritten; write to another file", path);
}

/* This check comes before the check whether the file exists, so that a style learns nothing about files outside the
 * root. */
static camber_status check_root(camber_context *context, const char *path, camber_file_naming naming) {
    if (naming == CAMBER_NAMED_BY_CALLER || camber_file_is_reached(context, path))
        return CAMBER_OK;
    return camber_fail(context, CAMBER_ERROR_INPUT,
                       "%s: is not a file in %s, and a style may name files only there; put it there", path,
                       context->desc.access.root);
}

camber_status camber_file_check(camber_context *context, const char *path, camber_file_naming naming,
                                uint64_t *size_bytes) {
    struct stat about;
    camber_status status = check_root(context, path, naming);
    if (status == CAMBER_OK && stat(path, &about) != 0)
        return camber_file_fail(context, path, errno);
    if (status == CAMBER_OK)
        status = check_access(context, path, &about);
    if (status == CAMBER_OK)
        *size_bytes = (uint64_t)about.st_size;
    return status;
}

camber_status camber_file_open(camber_context *context, const char *path, camber_file_naming naming, int *file,
                               uint64_t *size_bytes) {
    struct stat about;
    camber_status status = check_root(context, path, naming);
    if (status != CAMBER_OK)
        return status;
    const int opened = camber_open_file(path, &about);
    if (opened < 0)
        return camber_file_fail(context, path, errno);
    status = check_access(context, path, &about);
    if (status != CAMBER_OK) {
        close(opened);
        return status;
    }
    *file = opened;
    *size_bytes = (uint64_t)about.st_size;
    return CAMBER_OK;
}

/* ---- Reading ---- */

static camber_status read_bytes(camber_context *context, int file, const char *path, char *block, size_t size,
                                size_t *done) {
    ssize_t got = 1;
    *done = 0;
    while (*done < size && (got > 0 || (got < 0 && errno == EINTR))) {
        got = read(file, block + *done, size - *done);
        *done += got > 0 ? (size_t)got : 0;
    }
    return got < 0 ? camber_file_fail(context, path, errno) : CAMBER_OK;
}

/* Reads an open file and closes it. If it grows meanwhile, it is read up to the size that it had when it was opened. */
static camber_status read_all(camber_context *context, const char *path, int file, uint64_t size, char **bytes,
                              size_t *size_bytes) {
    size_t done = 0;
    char *block = size < SIZE_MAX ? camber_alloc(context, (size_t)size + 1, 1) : NULL;
    const camber_status status =
        block ? read_bytes(context, file, path, block, (size_t)size, &done) : CAMBER_ERROR_MEMORY;
    close(file);
    if (status != CAMBER_OK) {
        camber_free(context, block);
        return status;
    }
    block[done] = 0;
    *bytes = block;
    *size_bytes = done;
    return CAMBER_OK;
}

camber_status camber_read_file(camber_context *context, const char *path, camber_file_naming naming, char **bytes,
                               size_t *size_bytes) {
    int file = -1;
    uint64_t size = 0;
    const camber_status status = camber_file_open(context, path, naming, &file, &size);
    return status == CAMBER_OK ? read_all(context, path, file, size, bytes, size_bytes) : status;
}

camber_status camber_read_file_below(camber_context *context, const char *folder, const char *name, char **bytes,
                                     size_t *size_bytes) {
    char path[PATH_MAX];
    struct stat about;
    snprintf(path, sizeof path, "%s/%s", folder, name); /* for messages */
    const int file = camber_open_file_below(folder, name, &about);
    if (file < 0 && (errno == ENOENT || errno == ENOTDIR))
        return CAMBER_ERROR_NOT_FOUND;
    if (file < 0)
        return camber_file_fail(context, path, errno);
    const camber_status status = check_access(context, path, &about);
    if (status == CAMBER_OK)
        return read_all(context, path, file, (uint64_t)about.st_size, bytes, size_bytes);
    close(file);
    return status;
}

uint64_t camber_hash(uint64_t hash, const void *bytes, size_t size_bytes) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size_bytes; i++)
        hash = (hash ^ byte[i]) * 1099511628211ull;
    return hash;
}
