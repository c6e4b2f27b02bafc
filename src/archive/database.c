#include "archive/database.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Whether a file with this suffix exists next to the database and is not empty. */
static bool has_companion(const char *path, const char *ending) {
    char name[4096];
    struct stat about;
    return snprintf(name, sizeof name, "%s%s", path, ending) < (int)sizeof name && stat(name, &about) == 0 &&
           about.st_size > 0;
}

/* Whether the database is in WAL mode, according to its header. */
static bool keeps_log(const char *path) {
    unsigned char head[20] = "";
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    const ssize_t got = file >= 0 ? pread(file, head, sizeof head, 0) : 0;
    if (file >= 0)
        close(file);
    return got == sizeof head && memcmp(head, "SQLite format 3", 16) == 0 && head[18] == 2;
}

camber_database_kind camber_database_get_kind(const char *path) {
    if (!keeps_log(path))
        return CAMBER_DATABASE_PLAIN;
    if (!has_companion(path, "-wal"))
        return CAMBER_DATABASE_AT_REST;
    return has_companion(path, "-shm") ? CAMBER_DATABASE_LOGGED : CAMBER_DATABASE_INTERRUPTED;
}

bool camber_database_uri(const char *path, char *uri, size_t size) {
    size_t used = (size_t)snprintf(uri, size, "file:%s", path[0] == '/' ? "//" : "");
    for (; *path && used + 16 < size; path++)
        used += (size_t)snprintf(uri + used, size - used, strchr("%?#", *path) ? "%%%02X" : "%c", (unsigned char)*path);
    if (*path)
        return false;
    snprintf(uri + used, size - used, "?immutable=1");
    return true;
}

bool camber_database_is_virtual(const char *path) {
    static const char sql[] =
        "SELECT 1 FROM sqlite_master WHERE sql LIKE 'create%virtual%table%using%' AND sql NOT LIKE "
        "'%using%rtree%(%' AND sql NOT LIKE '%using%fts%(%'";
    char uri[3 * 4096];
    sqlite3 *handle = NULL;
    sqlite3_stmt *row = NULL;
    if (!camber_database_uri(path, uri, sizeof uri))
        return true;
    const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_URI;
    const bool found = sqlite3_open_v2(uri, &handle, flags, NULL) == SQLITE_OK &&
                       sqlite3_prepare_v2(handle, sql, -1, &row, NULL) == SQLITE_OK && sqlite3_step(row) == SQLITE_ROW;
    sqlite3_finalize(row);
    sqlite3_close(handle);
    return found;
}
