/* Work on the parts of a file by several threads, whose results come in the order of the parts. */
#ifndef CAMBER_OSM_PASS_H
#define CAMBER_OSM_PASS_H

#include "base/base.h"

/* Why a part failed. The thread that made the call logs it, for the first part that fails. */
typedef struct camber_osm_failure {
    camber_status status;
    bool declined; /* nothing is wrong with it, but it is not for this reader */
    bool told;     /* text has the cure, too; else the file is damaged */
    char text[240];
} camber_osm_failure;

/* A block that grows. */
typedef struct camber_osm_block {
    uint8_t *bytes;
    size_t capacity;
} camber_osm_block;

typedef struct camber_osm_pass camber_osm_pass;

typedef struct camber_osm_pass_desc {
    camber_context *context;
    const char *name; /* for messages */
    size_t part_count;
    unsigned threads;
    size_t slot_bytes; /* of what a part's result is kept in; slots are zeroed before the first part */
    void *user;
    /* Runs on any thread. false: *failure says why. */
    bool (*work)(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure);
    /* Runs on the caller's thread, one part after the other. NULL: there is nothing to do. */
    camber_status (*commit)(void *user, size_t part, void *slot);
    void (*free_slot)(camber_context *context, void *slot);
    double from, to; /* of the progress */
} camber_osm_pass_desc;

/* Works on all parts, unless one fails. *declined: one was not for this reader, and nothing is logged. */
camber_status camber_osm_pass_run(const camber_osm_pass_desc *desc, bool *declined);
/* Makes room for so many bytes while other threads work; what was in the block stays. */
bool camber_osm_reserve(camber_osm_pass *pass, camber_osm_block *block, size_t size_bytes, camber_osm_failure *failure);

/* Memory of the context while other threads work; NULL: there is none. */
void *camber_osm_allocate(camber_osm_pass *pass, size_t size_bytes);
void camber_osm_release(camber_osm_pass *pass, void *block);

/* Sets *failure, and returns false. fail: the file is damaged; refuse: it is whole, and the text ends with the cure. */
bool camber_osm_fail(camber_osm_failure *failure, const char *text);
bool camber_osm_refuse(camber_osm_failure *failure, const char *format, ...) CAMBER_PRINTF(2, 3);
bool camber_osm_decline(camber_osm_failure *failure);

#endif
