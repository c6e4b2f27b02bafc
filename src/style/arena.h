/* Memory for values that are freed together, all at once. */
#ifndef CAMBER_STYLE_ARENA_H
#define CAMBER_STYLE_ARENA_H

#include "base/base.h"

typedef struct camber_arena {
    camber_context *context;
    char *at; /* the next free byte; at first in the owner's own buffer */
    size_t left;
    void *blocks; /* a list: each block begins with a pointer to the one before */
    size_t used, limit;
    bool starved; /* memory ran out; the limit was not reached */
} camber_arena;

/* Aligned to 8. NULL where the limit is reached or memory ran out, without a message. */
void *camber_arena_alloc(camber_arena *arena, size_t size_bytes);
/* Copies the text and puts a 0 behind it. */
char *camber_arena_text(camber_arena *arena, const char *text, size_t length);
void camber_arena_free(camber_arena *arena);

#endif
