/* The distinct colours of a picture, numbered in the order in which they first appear. */
#ifndef CAMBER_IO_COLORS_H
#define CAMBER_IO_COLORS_H

#include "base/base.h"

/* Numbers keys with a hash table, which has up to twice as many slots as keys. */
typedef struct camber_key_table {
    uint16_t *slots; /* 1 + the key's number; 0: free */
    uint32_t *keys;  /* room for `most` keys */
    size_t count, most;
    unsigned bits; /* log2 of the number of slots in use */
} camber_key_table;

enum { CAMBER_KEYS_MOST = 32768 }; /* the largest `most` of a table; like every `most`, it is a power of 2 */

/* Returns CAMBER_ERROR_MEMORY. */
camber_status camber_key_table_make(camber_context *context, size_t most, camber_key_table *table);
void camber_key_table_free(camber_context *context, camber_key_table *table);
void camber_key_table_clear(camber_key_table *table);
/* Returns the number of the key, which is added if it is new. Returns `most` if there is no room for it. */
size_t camber_key_table_add(camber_key_table *table, uint32_t key);

/* Returns a premultiplied colour as a number, with its bytes in memory in the order of RGBA8. drop: how many of the
 * lowest bits of each channel are replaced by 0. Whatever is dropped, alpha values of 0 and 255 are never mixed with
 * others. */
uint32_t camber_color_key(uint32_t color, unsigned drop);

typedef struct camber_colors {
    camber_context *context;
    camber_key_table table;
    /* These have table.count entries. */
    uint32_t *colors; /* premultiplied RGBA8, in memory order */
    uint32_t *counts; /* number of pixels */
    uint32_t *votes;
    uint16_t *numbers; /* the number of each pixel's colour, row by row */
    size_t number_capacity;
    uint32_t *row; /* a row of the picture */
    size_t row_capacity;
    unsigned drop; /* how many bits were dropped until there were few enough colours */
} camber_colors;

/* `most` is a power of 2, at most CAMBER_KEYS_MOST. */
camber_status camber_colors_make(camber_context *context, size_t most, camber_colors *colors);
void camber_colors_free(camber_colors *colors);
/* Numbers the colours of a picture. If there are more than `most`, *fits becomes false. But if coarsen is set, colours
 * with equal upper bits are merged: into the colour that more than half of their pixels have, if there is one. opaque:
 * alpha counts as 255. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_colors_number(camber_colors *colors, const camber_pixels *pixels, bool opaque, bool coarsen,
                                   bool *fits);

#endif
