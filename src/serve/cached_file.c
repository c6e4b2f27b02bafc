/* Writes files of a folder of tiles. */
#define _XOPEN_SOURCE 700

#include "serve/cached_file.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Makes the folders of a path that are not there. */
static int make_folders(char *path, size_t there) {
    for (char *slash = strchr(path + there, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        const bool made = mkdir(path, 0777) == 0 || errno == EEXIST;
        *slash = '/';
        if (!made)
            return errno;
    }
    return 0;
}

/* Opens a file beside a path, of a name that nobody has. */
static int open_beside(char *beside, const char *path, size_t size) {
    if (snprintf(beside, size, "%s.XXXXXX", path) >= (int)size) {
        errno = ENAMETOOLONG;
        return -1;
    }
    return mkstemp(beside);
}

static bool write_all(int file, const void *bytes, size_t size_bytes) {
    for (const char *at = bytes; size_bytes > 0;) {
        const ssize_t written = write(file, at, size_bytes);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return false;
        at += written;
        size_bytes -= (size_t)written;
    }
    return true;
}

int camber_cached_file_write(const char *path, size_t there, const camber_file_part *parts, size_t count) {
    char beside[PATH_MAX];
    int made = open_beside(beside, path, sizeof beside);
    if (made < 0 && errno == ENOENT) {
        const int cause = make_folders(beside, there);
        if (cause)
            return cause;
        made = open_beside(beside, path, sizeof beside);
    }
    if (made < 0)
        return errno;
    bool written = fchmod(made, 0644) == 0;
    for (size_t i = 0; i < count && written; i++)
        written = write_all(made, parts[i].bytes, parts[i].size_bytes);
    int cause = written ? 0 : errno ? errno : ENOSPC;
    if (close(made) != 0 && !cause)
        cause = errno;
    if (!cause && rename(beside, path) != 0)
        cause = errno;
    if (cause)
        (void)unlink(beside);
    return cause;
}
