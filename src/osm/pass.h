/* Processes the parts of a file in several threads, and delivers results in the order of the parts. */
#ifndef CAMBER_OSM_PASS_H
#define CAMBER_OSM_PASS_H

#include "base/base.h"

/* The reason why a part failed. The thread that started the pass logs the reason for the first part that failed. */
typedef struct camber_osm_failure {
    camber_status status;
    bool declined; /* the part is valid, but not for this reader */
    bool told;     /* the text says what to do; otherwise the file is damaged */
    char text[240];
} camber_osm_failure;

/* A buffer that can grow. */
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
    size_t slot_bytes; /* size of a part's result; slots are zeroed before the first part */
    void *user;
    /* Runs on any thread. Returns false and sets *failure if it fails. */
    bool (*work)(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure);
    /* Runs on the caller's thread, for one part after the other. NULL: there is nothing to commit. */
    camber_status (*commit)(void *user, size_t part, void *slot);
    void (*free_slot)(camber_context *context, void *slot);
    double from, to; /* the progress before and after this pass */
} camber_osm_pass_desc;

/* Processes all parts, unless one fails. *declined: a part is not for this reader; then nothing is logged. */
camber_status camber_osm_pass_run(const camber_osm_pass_desc *desc, bool *declined);
/* Makes room for size_bytes bytes in the block while other threads work, and keeps its content. */
bool camber_osm_reserve(camber_osm_pass *pass, camber_osm_block *block, size_t size_bytes, camber_osm_failure *failure);

/* Allocates memory of the context while other threads work. Returns NULL if there is none. */
void *camber_osm_allocate(camber_osm_pass *pass, size_t size_bytes);
void camber_osm_release(camber_osm_pass *pass, void *block);

/* These functions set *failure and return false. camber_osm_fail: the file is damaged. camber_osm_refuse: the file is
 * intact, and the text ends with advice. camber_osm_decline: the file is not for this reader. */
bool camber_osm_fail(camber_osm_failure *failure, const char *text);
bool camber_osm_refuse(camber_osm_failure *failure, const char *format, ...) CAMBER_PRINTF(2, 3);
bool camber_osm_decline(camber_osm_failure *failure);

#endif
