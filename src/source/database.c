#include "source/database.h"

#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Whether a file stands beside it, and has something in it. */
static bool has_beside(const char *path, const char *ending) {
    char name[4096];
    struct stat about;
    return snprintf(name, sizeof name, "%s%s", path, ending) < (int)sizeof name && stat(name, &about) == 0 &&
           about.st_size > 0;
}

/* The header's word on how it is written to. */
static bool keeps_log(const char *path) {
    unsigned char head[20] = "";
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    const ssize_t got = file >= 0 ? pread(file, head, sizeof head, 0) : 0;
    if (file >= 0)
        close(file);
    return got == sizeof head && memcmp(head, "SQLite format 3", 16) == 0 && head[18] == 2;
}

camber_database_kind camber_database_look(const char *path) {
    if (!keeps_log(path))
        return CAMBER_DATABASE_PLAIN;
    if (!has_beside(path, "-wal"))
        return CAMBER_DATABASE_AT_REST;
    return has_beside(path, "-shm") ? CAMBER_DATABASE_LOGGED : CAMBER_DATABASE_INTERRUPTED;
}
