#include "formats/pool.h"

#include <stdalign.h>
#include <stddef.h>

struct camber_pool_block {
    camber_pool_block *next;
    size_t size_bytes;
    alignas(max_align_t) unsigned char bytes[];
};

static const size_t FIRST_BYTES = (size_t)1 << 17;

static void *allocate(void *user, size_t size_bytes) {
    return camber_pool_alloc(user, size_bytes);
}

static void release(void *user, void *block) {
    (void)user;
    (void)block;
}

void camber_pool_init(camber_pool *pool, camber_context *context, size_t limit_bytes) {
    *pool = (camber_pool){.context = context, .limit_bytes = limit_bytes};
    pool->allocator = (ProtobufCAllocator){allocate, release, pool};
}

void camber_pool_free(camber_pool *pool) {
    for (camber_pool_block *block = pool->blocks, *next; block; block = next) {
        next = block->next;
        camber_free(pool->context, block);
    }
    *pool = (camber_pool){0};
}

/* Inserts a block with at least this many bytes after the current one. */
static bool add_block(camber_pool *pool, size_t size_bytes) {
    size_t wanted = pool->total_bytes > FIRST_BYTES ? pool->total_bytes : FIRST_BYTES;
    wanted = wanted > size_bytes ? wanted : size_bytes;
    if (size_bytes > pool->limit_bytes - pool->total_bytes) {
        pool->exhausted = true;
        return false;
    }
    if (wanted > pool->limit_bytes - pool->total_bytes)
        wanted = pool->limit_bytes - pool->total_bytes;
    camber_pool_block *block = camber_alloc(pool->context, 1, sizeof *block + wanted);
    if (!block) {
        pool->exhausted = pool->out_of_memory = true;
        return false;
    }
    block->size_bytes = wanted;
    block->next = pool->current ? pool->current->next : pool->blocks;
    if (pool->current)
        pool->current->next = block;
    else
        pool->blocks = block;
    pool->total_bytes += wanted;
    pool->current = block;
    pool->used_bytes = 0;
    return true;
}

void *camber_pool_alloc(camber_pool *pool, size_t size_bytes) {
    const size_t step = alignof(max_align_t);
    if (size_bytes > pool->limit_bytes) {
        pool->exhausted = true;
        return NULL;
    }
    const size_t padded = (size_bytes + step - 1) / step * step;
    while (!pool->current || padded > pool->current->size_bytes - pool->used_bytes) {
        camber_pool_block *next = pool->current ? pool->current->next : pool->blocks;
        if (!next || padded > next->size_bytes) {
            if (!add_block(pool, padded))
                return NULL;
        } else {
            pool->current = next;
            pool->used_bytes = 0;
        }
    }
    void *made = pool->current->bytes + pool->used_bytes;
    pool->used_bytes += padded;
    return made;
}

camber_pool_mark camber_pool_here(const camber_pool *pool) {
    return (camber_pool_mark){pool->current, pool->used_bytes};
}

void camber_pool_reset(camber_pool *pool, camber_pool_mark mark) {
    pool->current = mark.current;
    pool->used_bytes = mark.used_bytes;
    pool->exhausted = false;
}
