/* The journal of an archive that is being written: which tiles its finished units have. */
#ifndef CAMBER_ARCHIVE_UNITS_H
#define CAMBER_ARCHIVE_UNITS_H

#include "archive/contents.h"

typedef enum camber_unit_kind {
    CAMBER_UNIT_TILE = 1,
    CAMBER_UNIT_REMOVED, /* the archive has no such tile any more */
    CAMBER_UNIT_END,     /* number is the unit's, offset the end of store 0, hash that of all records before */
} camber_unit_kind;

/* As it stands in the file; one machine writes and reads it. */
typedef struct camber_unit_record {
    uint32_t kind, size_bytes;
    uint64_t number, offset, hash; /* the content's */
} camber_unit_record;

typedef struct camber_units {
    camber_context *context;
    int descriptor;
    const char *name;
    uint64_t written_bytes, chain;
    camber_unit_record *pending; /* of the unit that is being written */
    size_t pending_count, pending_capacity;
    uint64_t *done; /* units that an earlier run has ended, ascending */
    size_t done_count, done_capacity;
} camber_units;

/* Takes a tile that an earlier run has written; content: CAMBER_NO_CONTENT where it was removed. */
typedef struct camber_unit_taker {
    camber_status (*take_tile)(void *user, uint64_t number, uint32_t content);
    void *user;
} camber_unit_taker;

/* Begins a journal of what key describes. */
camber_status camber_units_begin(camber_units *units, const char *key);
/* Reads a journal: tells the tiles of its finished units, notes their contents, and cuts both files behind the last
 * unit that is whole. Returns CAMBER_ERROR_INPUT where the journal is of another key. An empty file is begun. */
camber_status camber_units_resume(camber_units *units, const char *key, camber_contents *contents,
                                  const camber_unit_taker *taker);
camber_status camber_units_add(camber_units *units, const camber_unit_record *record);
/* Ends a unit; the contents are flushed already. */
camber_status camber_units_end(camber_units *units, uint64_t unit, uint64_t contents_bytes);
bool camber_units_has(const camber_units *units, uint64_t unit);
void camber_units_free(camber_units *units);

#endif
