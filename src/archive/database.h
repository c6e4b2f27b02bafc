/* SQLite files: which files stand beside them, and how they are read without leaving new ones there. */
#ifndef CAMBER_ARCHIVE_DATABASE_H
#define CAMBER_ARCHIVE_DATABASE_H

#include <stdbool.h>
#include <stddef.h>

typedef enum camber_database_kind {
    CAMBER_DATABASE_PLAIN = 0,   /* reading makes no file; also for files that are not SQLite's */
    CAMBER_DATABASE_AT_REST,     /* writers keep a log beside it (WAL), and there is none now: read as it stands */
    CAMBER_DATABASE_LOGGED,      /* somebody is writing: the log and its index are there */
    CAMBER_DATABASE_INTERRUPTED, /* a log without an index: the writer ended before it was done */
} camber_database_kind;

camber_database_kind camber_database_get_kind(const char *path);
/* Whether the database has virtual tables of modules that may open other files. Those of indices (R-trees, full
 * text) do not count. Call it on databases that are plain or at rest. */
bool camber_database_is_virtual(const char *path);
/* Writes the path as a URI that lets SQLite read the file as it stands. false: too long. */
bool camber_database_uri(const char *path, char *uri, size_t size);

#endif
