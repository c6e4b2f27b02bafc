/* SQLite files: what lies beside them, and what may be read of them without leaving anything there. */
#ifndef CAMBER_DATABASE_H
#define CAMBER_DATABASE_H

#include <stdbool.h>
#include <stddef.h>

typedef enum camber_database_kind {
    CAMBER_DATABASE_PLAIN = 0,   /* reading makes no file; also what is no SQLite file at all */
    CAMBER_DATABASE_AT_REST,     /* writers keep a log beside it (WAL), and none is there: to be read as it stands */
    CAMBER_DATABASE_LOGGED,      /* somebody writes: the log and its index are there */
    CAMBER_DATABASE_INTERRUPTED, /* a log without an index: who wrote is gone */
} camber_database_kind;

camber_database_kind camber_database_get_kind(const char *path);
/* Whether tables of it are made by modules that may open other files; those of indices (R-trees, full text) are not.
 * Only of one that is plain or at rest. */
bool camber_database_is_virtual(const char *path);
/* The path as a URI by which SQLite reads the file as it stands; false: too long. */
bool camber_database_uri(const char *path, char *uri, size_t size);

#endif
