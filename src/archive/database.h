/* SQLite files: examines the files next to them, and makes it possible to read them without creating new ones. */
#ifndef CAMBER_ARCHIVE_DATABASE_H
#define CAMBER_ARCHIVE_DATABASE_H

#include <stdbool.h>
#include <stddef.h>

typedef enum camber_database_kind {
    CAMBER_DATABASE_PLAIN = 0,   /* reading creates no file; also returned for files that are not SQLite's */
    CAMBER_DATABASE_AT_REST,     /* in WAL mode, but without a log at present: the file can be read as it is */
    CAMBER_DATABASE_LOGGED,      /* somebody is writing: the log and its index exist */
    CAMBER_DATABASE_INTERRUPTED, /* there is a log without an index: the writer was interrupted */
} camber_database_kind;

camber_database_kind camber_database_get_kind(const char *path);
/* Whether the database has virtual tables whose modules may open other files. Virtual tables that are indices (R-trees,
 * full text) do not count. Call this only on databases that are plain or at rest. */
bool camber_database_is_virtual(const char *path);
/* Writes the path as a URI with which SQLite reads the file without creating others. Returns false if it is too long.
 */
bool camber_database_uri(const char *path, char *uri, size_t size);

#endif
