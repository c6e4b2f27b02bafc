/* Opening files that a user or a style names. Inline, because the tool opens files too and libcamber hides its own. */
#ifndef CAMBER_BASE_OPEN_FILE_H
#define CAMBER_BASE_OPEN_FILE_H

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

/* Opens a file for reading and describes it: the caller may refuse a device or a pipe by what about says. Opening a
 * pipe without a writer does not wait, and about describes the opened file, so that nobody can swap it in between.
 * Returns a descriptor, or -1 with errno. */
static inline int camber_open_file(const char *path, struct stat *about) {
    const int opened = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (opened < 0 || fstat(opened, about) == 0)
        return opened;
    close(opened);
    return -1;
}

#endif
