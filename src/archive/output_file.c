/* Writing files that appear whole or not at all: all bytes or an error, synced, renamed.
 *
 * Input: a context for messages, paths, bytes. A failure is one line with the cause and its cure, and leaves the old
 * file or folder under its name. */
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
    case ENOSPC:
    case EDQUOT:
    case EIO: return "free some space or write elsewhere";
    case EFBIG: return "raise the limit of a file's size (ulimit -f), or make it smaller";
    case EMFILE: return "raise ulimit -n";
    case ENOENT:
    case ENOTDIR: return "make its folder first";
    case ENAMETOOLONG: return "choose a shorter name: files beside it add 16 letters";
    default: return "write elsewhere";
    }
}

camber_status camber_output_fail(camber_context *context, const char *name, int cause) {
    return camber_fail(context, CAMBER_ERROR_IO, "%s: cannot be written: %s; %s", name, strerror(cause),
                       cure_of(cause));
}

camber_status camber_write_at(camber_context *context, const char *name, int file, const void *bytes, size_t size_bytes,
                              uint64_t offset) {
    const unsigned char *at = bytes;
    for (size_t done = 0; done < size_bytes;) {
        const ssize_t put = pwrite(file, at + done, size_bytes - done, (off_t)(offset + done));
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return camber_output_fail(context, name, put < 0 ? errno : ENOSPC);
        done += (size_t)put;
    }
    return CAMBER_OK;
}

/* A file system that cannot sync says EINVAL. */
static int sync_file(int file) {
    return fsync(file) != 0 && errno != EINVAL ? errno : 0;
}

camber_status camber_sync(camber_context *context, const char *name, int file) {
    const int unsynced = sync_file(file);
    return unsynced ? camber_output_fail(context, name, unsynced) : CAMBER_OK;
}

camber_status camber_sync_and_close(camber_context *context, const char *name, int file) {
    const int unsynced = sync_file(file);
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

/* The name itself lies in the folder, which is synced where that can be done. */
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

/* A folder is no file that rename replaces: the old one is set aside first, and comes back where the new one fails. */
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

static int give_name(camber_context *context, const char *whole, const char *path, bool force) {
    struct stat about, there;
    if (stat(whole, &about) != 0)
        return errno;
    const bool taken = lstat(path, &there) == 0;
    if (taken && !force)
        return EEXIST;
    if (taken && S_ISDIR(about.st_mode) && S_ISDIR(there.st_mode))
        return replace_folder(context, whole, path);
    if (force || S_ISDIR(about.st_mode))
        return rename(whole, path) == 0 ? 0 : errno;
    /* A link fails where a file has appeared meanwhile. */
    if (link(whole, path) == 0) {
        (void)unlink(whole);
        return 0;
    }
    if (errno == EEXIST || errno == ENOSPC || errno == EIO)
        return errno;
    return rename(whole, path) == 0 ? 0 : errno;
}

camber_status camber_give_name(camber_context *context, const char *whole, const char *path, bool force) {
    const int cause = give_name(context, whole, path, force);
    if (cause == EEXIST)
        return camber_fail(context, CAMBER_ERROR_IO,
                           "%s: has appeared meanwhile; name another, or replace it with --force", path);
    if (cause)
        return camber_output_fail(context, path, cause);
    sync_folder(path);
    return CAMBER_OK;
}

camber_status camber_output_begin(camber_context *context, const char *path, camber_output_file *output) {
    output->context = context;
    output->path = path;
    if (snprintf(output->beside, sizeof output->beside, "%s.XXXXXX", path) >= (int)sizeof output->beside)
        return camber_output_fail(context, path, ENAMETOOLONG);
    output->file = mkstemp(output->beside);
    if (output->file < 0)
        return camber_output_fail(context, path, errno);
    (void)fchmod(output->file, 0644);
    return CAMBER_OK;
}

camber_status camber_output_end(camber_output_file *output, camber_status status, bool force) {
    const camber_status closed = camber_sync_and_close(output->context, output->path, output->file);
    status = status == CAMBER_OK ? closed : status;
    if (status == CAMBER_OK)
        status = camber_give_name(output->context, output->beside, output->path, force);
    if (status != CAMBER_OK)
        (void)unlink(output->beside);
    return status;
}
