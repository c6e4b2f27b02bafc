/* The colours of a picture, numbered in the order in which they first appear. */
#ifndef CAMBER_IO_COLORS_H
#define CAMBER_IO_COLORS_H

#include "base/base.h"

/* Numbers keys by a hash table of up to twice as many slots. */
typedef struct camber_key_table {
    uint16_t *slots; /* 1 + the number of a key; 0: free */
    uint32_t *keys;  /* most */
    size_t count, most;
    unsigned bits; /* of the slots that are in use */
} camber_key_table;

enum { CAMBER_KEYS_MOST = 32768 }; /* that a table can be made for; a power of 2, as most is */

/* Returns CAMBER_ERROR_MEMORY. */
camber_status camber_key_table_make(camber_context *context, size_t most, camber_key_table *table);
void camber_key_table_free(camber_context *context, camber_key_table *table);
void camber_key_table_clear(camber_key_table *table);
/* Returns the number of the key, which may be new; most, where there are as many already. */
size_t camber_key_table_add(camber_key_table *table, uint32_t key);

/* A premultiplied colour as a number, its bytes in memory as RGBA8 has them. The alphas 0 and 255 are kept apart from
 * all others, whatever is dropped.
 * drop: how many of the lowest bits of each channel count as 0. */
uint32_t camber_color_key(uint32_t color, unsigned drop);

typedef struct camber_colors {
    camber_context *context;
    camber_key_table table;
    /* table.count each */
    uint32_t *colors; /* premultiplied RGBA8 as it stands in memory */
    uint32_t *counts; /* pixels */
    uint32_t *votes;
    uint16_t *numbers; /* each pixel's colour, row after row */
    size_t number_capacity;
    uint32_t *row; /* of the picture */
    size_t row_capacity;
    unsigned drop; /* bits that were dropped until there were few enough colours */
} camber_colors;

/* most is a power of 2, CAMBER_KEYS_MOST at most. */
camber_status camber_colors_make(camber_context *context, size_t most, camber_colors *colors);
void camber_colors_free(camber_colors *colors);
/* Numbers the colours of a picture. Where there are more than most, *fits is false, or, if it may coarsen, colours that
 * share their upper bits become one: that of most of their pixels, where one has more than half of them.
 * opaque: alpha is taken for 255.
 * Returns CAMBER_ERROR_MEMORY. */
camber_status camber_colors_number(camber_colors *colors, const camber_pixels *pixels, bool opaque, bool coarsen,
                                   bool *fits);

#endif
