/* Memory for values that live and die together: handed out in pieces, freed at once. */
#ifndef CAMBER_STYLE_ARENA_H
#define CAMBER_STYLE_ARENA_H

#include "base/base.h"

typedef struct camber_arena {
    camber_context *context;
    char *at; /* room is taken from here; at first what the owner has of its own */
    size_t left;
    void *blocks; /* each begins with a pointer to the one before */
    size_t used, limit;
    bool starved; /* memory ran out, not the limit */
} camber_arena;

/* Aligned to 8. NULL where the limit is reached or memory ran out, without a message. */
void *camber_arena_alloc(camber_arena *arena, size_t size_bytes);
/* The text with a 0 behind it. */
char *camber_arena_text(camber_arena *arena, const char *text, size_t length);
void camber_arena_free(camber_arena *arena);

#endif
