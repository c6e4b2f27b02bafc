/* Arenas: blocks of memory from which values are cut off in turn. */
#include "style/arena.h"

enum { BLOCK_SIZE = 4096, ALIGNMENT = 8 };

/* Adds a block with at least this much room, and as much as twice everything before it, so that there are few blocks.
 */
static bool add_block(camber_arena *arena, size_t size_bytes) {
    size_t room = arena->used > BLOCK_SIZE / 2 ? 2 * arena->used : BLOCK_SIZE;
    if (room < size_bytes)
        room = size_bytes;
    char *block = camber_resize_quietly(arena->context, NULL, room + ALIGNMENT);
    if (!block)
        return false;
    memcpy(block, &arena->blocks, sizeof arena->blocks);
    arena->blocks = block;
    arena->at = block + ALIGNMENT;
    arena->left = room;
    return true;
}

void *camber_arena_alloc(camber_arena *arena, size_t size_bytes) {
    if (size_bytes > arena->limit)
        return NULL;
    const size_t rounded = size_bytes ? (size_bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT : ALIGNMENT;
    if (rounded > arena->limit || arena->used > arena->limit - rounded)
        return NULL;
    if (rounded > arena->left && !add_block(arena, rounded)) {
        arena->starved = true;
        return NULL;
    }
    char *taken = arena->at;
    arena->at += rounded;
    arena->left -= rounded;
    arena->used += rounded;
    return taken;
}

char *camber_arena_text(camber_arena *arena, const char *text, size_t length) {
    char *copy = camber_arena_alloc(arena, length + 1);
    if (!copy)
        return NULL;
    if (length)
        memcpy(copy, text, length);
    copy[length] = 0;
    return copy;
}

void camber_arena_free(camber_arena *arena) {
    while (arena->blocks) {
        void *block = arena->blocks;
        memcpy(&arena->blocks, block, sizeof arena->blocks);
        camber_free(arena->context, block);
    }
}
