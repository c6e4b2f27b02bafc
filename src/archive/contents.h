/* The distinct contents of an archive's tiles, each once, wherever they are stored. */
#ifndef CAMBER_ARCHIVE_CONTENTS_H
#define CAMBER_ARCHIVE_CONTENTS_H

#include "base/base.h"

typedef struct camber_content {
    uint64_t hash, offset;
    uint32_t size_bytes, store;
} camber_content;

/* Store 0 starts with room for the header and the root directory of PMTiles, so that the file can become such an
 * archive. */
enum { CAMBER_STORE_BEGIN = 16384 };

/* A file that has contents. Store 0 is the writer's own, to which it appends. */
typedef struct camber_content_store {
    int descriptor;
    uint64_t offset; /* where the contents begin in the file */
    char *name;      /* for messages */
} camber_content_store;

typedef struct camber_contents {
    camber_context *context;
    camber_content *items;
    size_t count, capacity;
    uint32_t *table; /* open addressing; an item's index + 1; 0: free */
    size_t table_size;
    camber_content_store *stores;
    size_t store_count, store_capacity;
    /* The end of store 0, which is not in the file yet. */
    unsigned char *tail;
    size_t tail_bytes;
    uint64_t written_bytes;
    unsigned char *compared; /* scratch: the bytes of a content to compare with */
    size_t compared_capacity;
} camber_contents;

/* Returns a fast 64-bit hash. If two hashes are equal, the caller compares the bytes. */
uint64_t camber_content_hash(const void *bytes, size_t size_bytes);

/* Opens store 0 on an open file, which is empty or has contents that are noted later. name is copied. */
camber_status camber_contents_init(camber_contents *contents, camber_context *context, int descriptor,
                                   const char *name);
camber_status camber_contents_add_store(camber_contents *contents, int descriptor, uint64_t offset, const char *name,
                                        uint32_t *store);
void camber_contents_free(camber_contents *contents);

#define CAMBER_NO_CONTENT UINT32_MAX

/* Looks up bytes that are already stored. *index is CAMBER_NO_CONTENT if they are not. */
camber_status camber_contents_find(camber_contents *contents, const void *bytes, size_t size_bytes, uint64_t hash,
                                   uint32_t *index);
/* Registers a content that is already in its store. */
camber_status camber_contents_note(camber_contents *contents, const camber_content *content, uint32_t *index);
/* Looks bytes up, and appends them to store 0 if they are new. */
camber_status camber_contents_put(camber_contents *contents, const void *bytes, size_t size_bytes, uint32_t *index);
/* Removes the contents of store 0 from an offset on, and truncates the store at this offset. Call this before contents
 * of other stores are noted. */
void camber_contents_cut(camber_contents *contents, uint64_t end);
/* Writes the end of store 0 that is not in the file yet. */
camber_status camber_contents_flush(camber_contents *contents);
/* Reads bytes from a store. */
camber_status camber_contents_read(camber_contents *contents, uint32_t store, uint64_t offset, void *bytes,
                                   size_t size_bytes);

#endif
