/* How bin_count and bin_scatter find the tiles of a segment: from its bits, or row by row of a large box. */
#ifndef CAMBER_KERNELS_BIN_H
#define CAMBER_KERNELS_BIN_H

#include "segment.h"

/* The tile of the lowest bit of some, counted from the first tile of the box. columns: of the area. */
static inline camber_u32 tile_of_bit(camber_u32 bits, camber_u32 columns) {
    const camber_u32 lowest = popcount((bits - 1u) & ~bits);
    return lowest / CAMBER_TILE_BITS_COLUMNS * columns + lowest % CAMBER_TILE_BITS_COLUMNS;
}

/* Finds the tiles of rows of a box, a lane each, from row y on. Returns how many rows these are. */
static inline camber_u32 find_rows(global const float *segment, camber_u32 box, camber_u32 y,
                                   const camber_tile_grid *of, camber_u32 *first, camber_u32 *last) {
    const uint numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const camber_u32 rows = CAMBER_BOX_LAST_Y(box) + 1u - y;
    const camber_words boxes = (camber_words)(box);
    camber_segment s;
    camber_slab slab;
    camber_segment_place(segment, &s);
    camber_slab_of(&s, &slab);
    const camber_tile_range tiles =
        camber_tiles_in_row(&slab, boxes, camber_touches_all(&s, boxes, of), y + CAMBER_LOAD(0, numbers), of);
    CAMBER_STORE(tiles.first, 0, first);
    CAMBER_STORE(tiles.last, 0, last);
    return rows < CAMBER_LANES ? rows : CAMBER_LANES;
}

#endif
