/* Writes files that appear whole or not at all. A file is written beside its path, under a name that no other file has,
 * and is renamed when it is complete; so readers see the old file or the new one, and a run that is killed harms
 * neither.
 *
 * Input: a path and bytes. Output: the file, or an errno; the caller reports which file failed and what to do. */
#define _XOPEN_SOURCE 700
#define _FILE_OFFSET_BITS 64

#include "base/whole_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int camber_whole_file_begin(camber_whole_file *whole, const char *path, mode_t mode) {
    whole->path = path;
    if (snprintf(whole->beside, sizeof whole->beside, "%s.XXXXXX", path) >= (int)sizeof whole->beside)
        return ENAMETOOLONG;
    whole->file = mkstemp(whole->beside);
    if (whole->file < 0)
        return errno;
    (void)fchmod(whole->file, mode); /* if it fails, only this user can read the file */
    return 0;
}

int camber_whole_file_end(camber_whole_file *whole, int cause, bool force) {
    if (close(whole->file) != 0 && !cause)
        cause = errno;
    if (!cause)
        cause = camber_file_name(whole->beside, whole->path, force);
    if (cause)
        (void)unlink(whole->beside);
    return cause;
}

int camber_whole_file_write(const char *path, size_t there, mode_t mode, const camber_file_part *parts, size_t count) {
    camber_whole_file whole;
    uint64_t offset = 0;
    int cause = camber_whole_file_begin(&whole, path, mode);
    if (cause == ENOENT && (cause = camber_file_make_folders(whole.beside, there, 0777)) == 0)
        cause = camber_whole_file_begin(&whole, path, mode);
    if (cause)
        return cause;
    for (size_t i = 0; i < count && !cause; i++) {
        cause = camber_file_write(whole.file, parts[i].bytes, parts[i].size_bytes, offset);
        offset += parts[i].size_bytes;
    }
    return camber_whole_file_end(&whole, cause, true);
}

int camber_file_name(const char *whole, const char *path, bool force) {
    struct stat there;
    if (!force) {
        if (link(whole, path) == 0) {
            (void)unlink(whole);
            return 0;
        }
        if (errno == EEXIST || camber_file_fails_anyway(errno))
            return errno;
        if (lstat(path, &there) == 0)
            return EEXIST;
    }
    return rename(whole, path) == 0 ? 0 : errno;
}

int camber_file_read(int file, void *bytes, size_t size_bytes, uint64_t offset, size_t *done) {
    unsigned char *at = bytes;
    for (*done = 0; *done < size_bytes;) {
        const ssize_t got = pread(file, at + *done, size_bytes - *done, (off_t)(offset + *done));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return got < 0 ? errno : 0;
        *done += (size_t)got;
    }
    return 0;
}

int camber_file_write(int file, const void *bytes, size_t size_bytes, uint64_t offset) {
    const unsigned char *at = bytes;
    for (size_t done = 0; done < size_bytes;) {
        const ssize_t put = pwrite(file, at + done, size_bytes - done, (off_t)(offset + done));
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return put < 0 ? errno : ENOSPC;
        done += (size_t)put;
    }
    return 0;
}

/* Pipes, devices and some file systems have nothing to sync, and say EINVAL. */
int camber_file_sync(int file) {
    return fsync(file) != 0 && errno != EINVAL ? errno : 0;
}

int camber_file_make_folders(char *path, size_t there, mode_t mode) {
    for (char *slash = strchr(path + there, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        const bool made = mkdir(path, mode) == 0 || errno == EEXIST;
        *slash = '/';
        if (!made)
            return errno;
    }
    return 0;
}

bool camber_file_fails_anyway(int cause) {
    return cause == ENOSPC || cause == EDQUOT || cause == EIO || cause == EMFILE || cause == ENFILE || cause == EFBIG;
}

const char *camber_file_cure(int cause, const char *otherwise) {
    switch (cause) {
    case EMFILE: return "raise ulimit -n";
    case ENFILE: return "end other programs, or raise the system's limit (fs.file-max)";
    case EFBIG: return "raise the limit of a file's size (ulimit -f), or make it smaller";
    case ENOSPC:
    case EDQUOT:
    case EIO: return "free some space or write elsewhere";
    case EPIPE: return "its reader has gone; keep it running";
    default: return otherwise;
    }
}
