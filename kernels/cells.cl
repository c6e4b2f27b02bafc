/* The cells of a tile in kernels: positions that are computed once per tile, and sets of cells, one bit each. */
#ifndef CAMBER_CELLS_CL
#define CAMBER_CELLS_CL

#include "cells.h"

/* Positions in the picture, in px: of the pixels of a cell, by its column or row, and of the middles of as many cells
 * as a vector has lanes, row by row, from the tile's first cell on. */
typedef struct positions {
    camber_real x[CAMBER_TILE_CELLS], y[CAMBER_TILE_CELLS][CAMBER_VECTORS];
    camber_real middle_x, middle_y;
} positions;

constant float CELL_COLUMNS[16] = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
constant float CELL_ROWS[16] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};
static inline void begin_positions(positions *at, float left, float top) {
    const float middle = 0.5f * CAMBER_CELL_PX;
    for (int i = 0; i < CAMBER_TILE_CELLS; i++) {
        const float from = (float)(CAMBER_CELL_PX * i);
        at->x[i] = left + from + 0.5f + CAMBER_LOAD(0, COLUMNS);
        for (int v = 0; v < CAMBER_VECTORS; v++)
            at->y[i][v] = top + from + 0.5f + CAMBER_LOAD((size_t)v, ROWS);
    }
    at->middle_x = left + middle + CAMBER_CELL_PX * CAMBER_LOAD(0, CELL_COLUMNS);
    at->middle_y = top + middle + CAMBER_CELL_PX * CAMBER_LOAD(0, CELL_ROWS);
}

/* Cells, one bit each: those that a segment touches, those near one of its ends, and those that it fills. */
typedef struct cell_sets {
    ulong partial, near_end, full;
} cell_sets;

#endif
