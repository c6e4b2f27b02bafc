/* Opening files that a user or a style names. The functions are inline because the tool opens files, too, and libcamber
 * hides its internal symbols. */
#ifndef CAMBER_BASE_OPEN_FILE_H
#define CAMBER_BASE_OPEN_FILE_H

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Opens a file for reading and describes it: the caller can refuse a device or a pipe by looking at *about. Opening a
 * pipe without a writer does not wait, and about describes the opened file, so that nobody can swap it in between.
 * Returns a descriptor, or -1 with errno. */
static inline int camber_open_file(const char *path, struct stat *about) {
    const int opened = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (opened < 0 || fstat(opened, about) == 0)
        return opened;
    close(opened);
    return -1;
}

/* Opens a file in a folder by its relative name, whose components are separated by slashes. The folder's own path may
 * contain links, but the name may not, so that whoever fills a folder that somebody else serves cannot make it lead to
 * other files. Otherwise it works like camber_open_file; errno is ELOOP for a link. */
static inline int camber_open_file_below(const char *folder, const char *name, struct stat *about) {
    int opened = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (bool is_last = false; opened >= 0 && !is_last;) {
        char part[NAME_MAX + 1];
        const size_t length = strcspn(name, "/");
        const int above = opened;
        struct stat found;
        is_last = !name[length];
        if (length < sizeof part) {
            memcpy(part, name, length);
            part[length] = 0;
            opened = openat(above, part,
                            O_RDONLY | O_NOFOLLOW | O_CLOEXEC | (is_last ? O_NONBLOCK | O_NOCTTY : O_DIRECTORY));
        } else {
            opened = -1;
            errno = ENAMETOOLONG;
        }
        int cause = errno;
        /* The system reports ENOTDIR for a link in place of a folder. */
        if (opened < 0 && cause == ENOTDIR && fstatat(above, part, &found, AT_SYMLINK_NOFOLLOW) == 0 &&
            S_ISLNK(found.st_mode))
            cause = ELOOP;
        close(above);
        errno = cause;
        name += length + !is_last;
    }
    if (opened < 0 || fstat(opened, about) == 0)
        return opened;
    close(opened);
    return -1;
}

#endif
