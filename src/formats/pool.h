/* Memory for the messages of vector tiles. All of it is freed at once, and its size is limited, because a few bytes of
 * a malicious tile can ask for megabytes. */
#ifndef CAMBER_FORMATS_POOL_H
#define CAMBER_FORMATS_POOL_H

#include "base/base.h"

#include <protobuf-c/protobuf-c.h>

typedef struct camber_pool_block camber_pool_block;

typedef struct camber_pool {
    camber_context *context;
    size_t limit_bytes;
    camber_pool_block *blocks, *current; /* the first block, and the one in use */
    size_t used_bytes;                   /* how much of the current block is used */
    size_t total_bytes;                  /* the size of all blocks */
    bool exhausted; /* a request was refused since the last reset, by the limit or for lack of memory */
    bool out_of_memory;
    ProtobufCAllocator allocator; /* allocates from this pool; freed memory stays in it until a reset */
} camber_pool;

/* A mark to which the pool can be reset. */
typedef struct camber_pool_mark {
    camber_pool_block *current;
    size_t used_bytes;
} camber_pool_mark;

/* Makes an empty pool, which must not be moved afterwards. */
void camber_pool_init(camber_pool *pool, camber_context *context, size_t limit_bytes);
void camber_pool_free(camber_pool *pool);
/* Returns NULL if the request is refused. Running out of memory is logged. */
void *camber_pool_alloc(camber_pool *pool, size_t size_bytes);
camber_pool_mark camber_pool_here(const camber_pool *pool);
/* Frees everything that was allocated since the mark. The blocks stay for later use. */
void camber_pool_reset(camber_pool *pool, camber_pool_mark mark);

#endif
