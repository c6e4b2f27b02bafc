/* SQLite files: what lies beside them, and what may be read of them without leaving anything there. */
#ifndef CAMBER_DATABASE_H
#define CAMBER_DATABASE_H

typedef enum camber_database_kind {
    CAMBER_DATABASE_PLAIN = 0,   /* reading makes no file; also what is no SQLite file at all */
    CAMBER_DATABASE_AT_REST,     /* writers keep a log beside it (WAL), and none is there: to be read as it stands */
    CAMBER_DATABASE_LOGGED,      /* somebody writes: the log and its index are there */
    CAMBER_DATABASE_INTERRUPTED, /* a log without an index: who wrote is gone */
} camber_database_kind;

camber_database_kind camber_database_look(const char *path);

#endif
