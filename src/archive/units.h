/* The journal of an archive that is being written. It lists the tiles of finished units. */
#ifndef CAMBER_ARCHIVE_UNITS_H
#define CAMBER_ARCHIVE_UNITS_H

#include "archive/contents.h"

typedef enum camber_unit_kind {
    CAMBER_UNIT_TILE = 1,
    CAMBER_UNIT_REMOVED, /* the archive no longer has this tile */
    CAMBER_UNIT_END,     /* number: the unit's; offset: the end of store 0; hash: covers all records before */
} camber_unit_kind;

/* A record as it is laid out in the file. The machine that writes it also reads it. */
typedef struct camber_unit_record {
    uint32_t kind, size_bytes;
    uint64_t number, offset, hash; /* offset and hash: the content's */
} camber_unit_record;

typedef struct camber_units {
    camber_context *context;
    int descriptor;
    const char *name;
    uint64_t written_bytes, chain;
    camber_unit_record *pending; /* the records of the current unit */
    size_t pending_count, pending_capacity;
    uint64_t *done; /* units that an earlier run finished, ascending */
    size_t done_count, done_capacity;
} camber_units;

/* Receives a tile that an earlier run wrote. content: CAMBER_NO_CONTENT if the tile was removed. */
typedef struct camber_unit_taker {
    camber_status (*take_tile)(void *user, uint64_t number, uint32_t content);
    void *user;
} camber_unit_taker;

/* Starts a journal for the archive that key describes. */
camber_status camber_units_begin(camber_units *units, const char *key);
/* Reads a journal: reports the tiles of its finished units, registers their contents, and truncates both files after
 * the last complete unit. Returns CAMBER_ERROR_INPUT if the journal has another key. An empty file is started. */
camber_status camber_units_resume(camber_units *units, const char *key, camber_contents *contents,
                                  const camber_unit_taker *taker);
camber_status camber_units_add(camber_units *units, const camber_unit_record *record);
/* Ends a unit. Its contents must be flushed. */
camber_status camber_units_end(camber_units *units, uint64_t unit, uint64_t contents_bytes);
bool camber_units_has(const camber_units *units, uint64_t unit);
void camber_units_free(camber_units *units);

#endif
