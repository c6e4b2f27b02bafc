/* Memory for values that are all freed at the same time. */
#ifndef CAMBER_STYLE_ARENA_H
#define CAMBER_STYLE_ARENA_H

#include "base/base.h"

typedef struct camber_arena {
    camber_context *context;
    char *at; /* the next free byte; it may start in a buffer of the owner */
    size_t left;
    void *blocks; /* a list: each block begins with a pointer to the previous one */
    size_t used, limit;
    bool starved; /* memory ran out before the limit was reached */
} camber_arena;

/* Allocates memory aligned to 8 bytes. NULL, without a message: the limit is reached, or memory ran out. */
void *camber_arena_alloc(camber_arena *arena, size_t size_bytes);
/* Copies the text and appends a 0. */
char *camber_arena_text(camber_arena *arena, const char *text, size_t length);
void camber_arena_free(camber_arena *arena);

#endif
