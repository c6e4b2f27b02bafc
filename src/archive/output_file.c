/* Writes files that appear either complete or not at all: each file gets its final name after all its bytes are written
 * and synced.
 *
 * Input: paths and bytes, and a context for messages. A failure is reported in one line with the cause and what to do,
 * and leaves the old file or folder in place. */
#define _XOPEN_SOURCE 700 /* nftw */
#define _FILE_OFFSET_BITS 64

#include "archive/output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *cure_of(int cause) {
    switch (cause) {
    case ENOENT:
    case ENOTDIR: return "make its folder first";
    case ENAMETOOLONG: return "choose a shorter name: temporary files next to it have up to 16 letters more";
    default: return camber_file_cure(cause, "write elsewhere");
    }
}

camber_status camber_output_fail(camber_context *context, const char *name, int cause) {
    return camber_fail(context, CAMBER_ERROR_IO, "%s: cannot be written: %s; %s", name, strerror(cause),
                       cure_of(cause));
}

camber_status camber_write_at(camber_context *context, const char *name, int file, const void *bytes, size_t size_bytes,
                              uint64_t offset) {
    const int cause = camber_file_write(file, bytes, size_bytes, offset);
    return cause ? camber_output_fail(context, name, cause) : CAMBER_OK;
}

camber_status camber_sync(camber_context *context, const char *name, int file) {
    const int cause = camber_file_sync(file);
    return cause ? camber_output_fail(context, name, cause) : CAMBER_OK;
}

camber_status camber_sync_and_close(camber_context *context, const char *name, int file) {
    const int unsynced = camber_file_sync(file);
    const int unclosed = close(file) != 0 ? errno : 0;
    if (!unsynced && !unclosed)
        return CAMBER_OK;
    return camber_output_fail(context, name, unsynced ? unsynced : unclosed);
}

static int remove_one(const char *path, const struct stat *about, int kind, struct FTW *where) {
    (void)about;
    (void)kind;
    (void)where;
    return remove(path);
}

void camber_remove_tree(camber_context *context, const char *path) {
    (void)context;
    if (unlink(path) != 0 && (errno == EISDIR || errno == EPERM))
        nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

/* Syncs the folder, which stores the file's name, if the file system supports this. */
static void sync_folder(const char *path) {
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    if (length + 2 > sizeof folder)
        return;
    memcpy(folder, path, length);
    memcpy(folder + length, ".", 2);
    const int opened = open(folder, O_RDONLY | O_CLOEXEC);
    if (opened < 0)
        return;
    (void)fsync(opened);
    close(opened);
}

/* rename cannot replace one folder by another, so the old folder is moved aside first. It is moved back if renaming the
 * new folder fails. */
static int replace_folder(camber_context *context, const char *whole, const char *path) {
    char aside[PATH_MAX];
    if (snprintf(aside, sizeof aside, "%s.camber-old", path) >= (int)sizeof aside)
        return ENAMETOOLONG;
    camber_remove_tree(context, aside);
    if (rename(path, aside) != 0)
        return errno;
    if (rename(whole, path) != 0) {
        const int cause = errno;
        (void)rename(aside, path);
        return cause;
    }
    camber_remove_tree(context, aside);
    return 0;
}

static bool is_folder(const char *path) {
    struct stat about;
    return lstat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

static camber_status say_named(camber_context *context, const char *path, int cause) {
    if (cause == EEXIST)
        return camber_fail(
            context, CAMBER_ERROR_IO,
            "%s: another program has created it meanwhile; name another file, or replace it with --force", path);
    if (cause)
        return camber_output_fail(context, path, cause);
    sync_folder(path);
    return CAMBER_OK;
}

camber_status camber_give_name(camber_context *context, const char *whole, const char *path, bool force) {
    const bool replaces = force && is_folder(whole) && is_folder(path);
    return say_named(context, path,
                     replaces ? replace_folder(context, whole, path) : camber_file_name(whole, path, force));
}

camber_status camber_output_begin(camber_context *context, const char *path, camber_whole_file *output) {
    const int cause = camber_whole_file_begin(output, path, 0644);
    return cause ? camber_output_fail(context, path, cause) : CAMBER_OK;
}

camber_status camber_output_end(camber_context *context, camber_whole_file *output, camber_status status, bool force) {
    int cause = status != CAMBER_OK ? ECANCELED : camber_file_sync(output->file);
    cause = camber_whole_file_end(output, cause, force);
    return status != CAMBER_OK ? status : say_named(context, output->path, cause);
}
