/* The different bytes that tiles of an archive have, each once, wherever they are stored. */
#ifndef CAMBER_ARCHIVE_CONTENTS_H
#define CAMBER_ARCHIVE_CONTENTS_H

#include "base/base.h"

typedef struct camber_content {
    uint64_t hash, offset;
    uint32_t size_bytes, store;
} camber_content;

/* Store 0 leaves room for the header and the root directory of PMTiles, so that it can become such an archive. */
enum { CAMBER_STORE_BEGIN = 16384 };

/* A file that has contents. Store 0 is the writer's own, which is appended to. */
typedef struct camber_content_store {
    int descriptor;
    uint64_t offset; /* of its contents in the file */
    char *name;      /* in messages */
} camber_content_store;

typedef struct camber_contents {
    camber_context *context;
    camber_content *items;
    size_t count, capacity;
    uint32_t *table; /* open addressing; index + 1 of an item, 0: free */
    size_t table_size;
    camber_content_store *stores;
    size_t store_count, store_capacity;
    /* The end of store 0 that is not written yet. */
    unsigned char *tail;
    size_t tail_bytes;
    uint64_t written_bytes;
    unsigned char *compared; /* the bytes of a content, to compare */
    size_t compared_capacity;
} camber_contents;

/* A fast 64-bit hash of bytes. Equal hashes are compared byte by byte. */
uint64_t camber_content_hash(const void *bytes, size_t size_bytes);

/* Opens store 0 over an open file, which is empty or has contents that are noted. name is copied. */
camber_status camber_contents_init(camber_contents *contents, camber_context *context, int descriptor,
                                   const char *name);
camber_status camber_contents_add_store(camber_contents *contents, int descriptor, uint64_t offset, const char *name,
                                        uint32_t *store);
void camber_contents_free(camber_contents *contents);

#define CAMBER_NO_CONTENT UINT32_MAX

/* Finds bytes that are stored already. *index: CAMBER_NO_CONTENT where they are not. */
camber_status camber_contents_find(camber_contents *contents, const void *bytes, size_t size_bytes, uint64_t hash,
                                   uint32_t *index);
/* Notes a content that its store has already. */
camber_status camber_contents_note(camber_contents *contents, const camber_content *content, uint32_t *index);
/* Finds bytes, or appends them to store 0. */
camber_status camber_contents_put(camber_contents *contents, const void *bytes, size_t size_bytes, uint32_t *index);
/* Forgets the contents of store 0 from an offset on, which becomes its end. Nothing of other stores is noted yet. */
void camber_contents_cut(camber_contents *contents, uint64_t end);
/* Writes what store 0 has not written yet. */
camber_status camber_contents_flush(camber_contents *contents);
/* Reads bytes of a store. */
camber_status camber_contents_read(camber_contents *contents, uint32_t store, uint64_t offset, void *bytes,
                                   size_t size_bytes);

#endif
