/* The cells of a tile: the box of cells around a segment, and the position of each cell relative to it.
 *
 * Input: the footprint of a segment in the picture, its coefficients, and the rows of cells of a tile that are drawn.
 * Output: boxes and masks of cells. A lane is a segment or a cell, as the caller fills it, so that sixteen segments and
 * the cells of one segment are sorted by the same code. */
#ifndef CAMBER_KERNELS_CELLS_H
#define CAMBER_KERNELS_CELLS_H

#include "edge.h"

#define CAMBER_CELLS (CAMBER_TILE_CELLS * CAMBER_TILE_CELLS)
/* A vector has CAMBER_LANES of the sixteen pixels of a cell, row by row, or of sixteen segments. */
#define CAMBER_VECTORS (16 / CAMBER_LANES)

/* On a CPU a work-item draws a tile, or rows of its cells. On a GPU the work-items of a group share a tile, and each
 * draws a row of the pixels of one cell, which is the only cell of its state. */
#if defined(CAMBER_DEVICE) && CAMBER_LANES == 1
#define CAMBER_SHARES_TILE 1
#define CAMBER_OWN_CELLS 1
#define CAMBER_OWN_VECTORS CAMBER_CELL_PX
#else
#define CAMBER_SHARES_TILE 0
#define CAMBER_OWN_CELLS CAMBER_CELLS
#define CAMBER_OWN_VECTORS CAMBER_VECTORS
#endif

/* Functions that GPU compilers must not inline everywhere, which takes them a minute. */
#ifdef CAMBER_DEVICE
#define CAMBER_NOINLINE static __attribute__((noinline))
#else
#define CAMBER_NOINLINE CAMBER_FN
#endif

/* Rows of cells [first, last] of a tile, and the position of the tile in the picture, in px. */
typedef struct camber_tile_rows {
    float left, top;
    int first, last;
} camber_tile_rows;

/* The columns and rows of the pixels of a vector of a cell. */
#if CAMBER_HAS_VECTORS
constant float COLUMNS[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
constant float ROWS[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
constant float NUMBERS[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
#endif

CAMBER_FN camber_real camber_columns_of_cell(int v) {
#if CAMBER_HAS_VECTORS
    return CAMBER_LOAD((size_t)v, COLUMNS);
#else
    return (float)(v % CAMBER_CELL_PX);
#endif
}

CAMBER_FN camber_real camber_rows_of_cell(int v) {
#if CAMBER_HAS_VECTORS
    return CAMBER_LOAD((size_t)v, ROWS);
#else
    return (float)(v / CAMBER_CELL_PX);
#endif
}

/* The numbers from 0 to 15 of a vector. */
CAMBER_FN camber_real camber_numbers(int v) {
#if CAMBER_HAS_VECTORS
    return CAMBER_LOAD((size_t)v, NUMBERS);
#else
    return (float)v;
#endif
}

/* ---- Boxes ---- */

/* The position of a segment in the picture: A, B, and how far around them it reaches, in px. */
typedef struct camber_footprint {
    camber_real ax, ay, bx, by, reach;
} camber_footprint;

/* Computes the footprint of one segment, the same in all lanes. */
CAMBER_FN void camber_footprint_of(CAMBER_GLOBAL const float *segment, camber_footprint *f) {
    f->ax = CAMBER_REAL(segment[CAMBER_SEGMENT_AX]);
    f->ay = CAMBER_REAL(segment[CAMBER_SEGMENT_AY]);
    f->bx = CAMBER_REAL(segment[CAMBER_SEGMENT_BX]);
    f->by = CAMBER_REAL(segment[CAMBER_SEGMENT_BY]);
    f->reach = CAMBER_REAL(segment[CAMBER_SEGMENT_REACH]);
}

/* Boxes of cells: the first cell, and how many cells along each side; 0 if a segment touches none. */
typedef struct camber_cell_boxes {
    camber_mask x, y, columns, rows; /* as integers */
} camber_cell_boxes;

/* Computes the boxes of segments. wanted: the lanes that count. */
CAMBER_FN void camber_cell_boxes_of(const camber_footprint *f, camber_tile_rows where, camber_mask wanted,
                                    camber_cell_boxes *b) {
    const float a_cell = 1.0f / CAMBER_CELL_PX;
    const camber_real none = CAMBER_REAL(0.0f), side = CAMBER_REAL((float)(CAMBER_TILE_CELLS - 1));
    const camber_real top = CAMBER_REAL((float)where.first), bottom = CAMBER_REAL((float)where.last);
    const camber_real x0 = (CAMBER_LESS(f->ax, f->bx) - f->reach - where.left + 0.5f) * a_cell;
    const camber_real x1 = (CAMBER_MORE(f->ax, f->bx) + f->reach - where.left - 0.5f) * a_cell;
    const camber_real y0 = (CAMBER_LESS(f->ay, f->by) - f->reach - where.top + 0.5f) * a_cell;
    const camber_real y1 = (CAMBER_MORE(f->ay, f->by) + f->reach - where.top - 0.5f) * a_cell;
    const camber_mask meets = wanted & (x1 >= 0.0f) & (y1 >= top) & (x0 < side + 1.0f) & (y0 < bottom + 1.0f);
    const camber_mask empty = CAMBER_TO_INTEGERS(none);
    b->x = CAMBER_TO_INTEGERS((meets & (x0 > none)) ? x0 : none);
    b->y = CAMBER_TO_INTEGERS((meets & (y0 > top)) ? y0 : top);
    b->columns = meets ? CAMBER_TO_INTEGERS((meets & (x1 < side)) ? x1 : side) + 1 - b->x : empty;
    b->rows = meets ? CAMBER_TO_INTEGERS((meets & (y1 < bottom)) ? y1 : bottom) + 1 - b->y : empty;
}

#if !CAMBER_STROKE_PITCHED

/* ---- The position of cells relative to segments without a pitch; edge.h has it with one ---- */

/* Bounds, in px, that the position of a cell's middle is compared with to find the cell's position relative to a
 * segment. */
typedef struct camber_cell_bounds {
    camber_real wide, full;       /* to the side of the line: for cells that it touches, and for cells that it fills */
    camber_real near_a, near_b;   /* along the line: an end matters before near_a and after near_b */
    camber_real near_fa, near_fb; /* the same, past the bisectors */
    camber_real far_a, far_b;     /* past the bisectors, where the neighbour has all pixels, or no cap reaches */
} camber_cell_bounds;

CAMBER_FN void camber_cell_bounds_of(const camber_edges *p, camber_cell_bounds *b) {
    const camber_real always = CAMBER_REAL(CAMBER_ALWAYS_PX), h = p->half_width;
    const camber_real reach = 1.5f * (CAMBER_FABS(p->ux) + CAMBER_FABS(p->uy));
    const camber_real reach_a = 1.5f * (CAMBER_FABS(p->nax) + CAMBER_FABS(p->nay));
    const camber_real reach_b = 1.5f * (CAMBER_FABS(p->nbx) + CAMBER_FABS(p->nby));
    /* A join bends the edge outwards by at most this: camber_join_bend. */
    const camber_real bend_a = CAMBER_FABS(p->sa), bend_b = CAMBER_FABS(p->sb);
    const camber_real bend = 0.25f * CAMBER_MORE(bend_a, bend_b);
    /* A sharp join may cut pixels that are far from it. */
    const camber_real near = p->sharp ? CAMBER_REAL(CAMBER_NEVER_PX) : reach + CAMBER_PAD_PX;
    b->wide = h + p->side.extent + reach + bend;
    b->full = h > 2.0f ? h - p->side.extent - reach : always;
    b->near_a = near;
    b->near_b = p->length - near;
    b->near_fa = reach_a + 0.5f;
    b->near_fb = -0.5f - reach_b;
    /* A cap has no neighbour, but an end: half the width past it if it is round. Its bisector is straight across. */
    const camber_real cap_a = CAMBER_LESS(p->flat_a, h) + CAMBER_PAD_PX + reach_a,
                      cap_b = CAMBER_LESS(p->flat_b, h) + CAMBER_PAD_PX + reach_b;
    const camber_real past_a = p->owner_a == CAMBER_NEVER_PX ? -cap_a : always,
                      past_b = p->owner_b == CAMBER_NEVER_PX ? cap_b : -always;
    b->far_a = p->owner_a == always ? -reach_a : past_a;
    b->far_b = p->owner_b == always ? reach_b : past_b;
}

/* How far cells are along a segment, beside it, and past the bisectors, in px: the part that comes from one coordinate
 * of their middles. All cells of a column have one part in common, and all cells of a row the other. */
typedef struct camber_cell_lines {
    camber_real x, aside, fa, fb;
} camber_cell_lines;

/* mx: the middles of cells in the picture, px. */
CAMBER_FN void camber_cell_lines_across(const camber_edges *p, camber_real mx, camber_cell_lines *l) {
    const camber_real qx = mx - p->ax, rx = mx - p->bx;
    l->x = qx * p->ux;
    l->aside = qx * p->uy;
    l->fa = qx * p->nax;
    l->fb = rx * p->nbx;
}

CAMBER_FN void camber_cell_lines_down(const camber_edges *p, camber_real my, camber_cell_lines *l) {
    const camber_real qy = my - p->ay, ry = my - p->by;
    l->x = qy * p->uy;
    l->aside = qy * p->ux;
    l->fa = qy * p->nay;
    l->fb = ry * p->nby;
}

CAMBER_FN void camber_cell_masks_from(const camber_cell_bounds *b, const camber_cell_lines *across,
                                      const camber_cell_lines *down, camber_cell_masks *cells) {
    const camber_real x = across->x + down->x, aside = CAMBER_FABS(down->aside - across->aside);
    const camber_real fa = across->fa + down->fa, fb = across->fb + down->fb;
    cells->partial = (aside < b->wide) & (fa >= b->far_a) & (fb < b->far_b);
    cells->near_end = (x < b->near_a) | (x > b->near_b) | (fa < b->near_fa) | (fb > b->near_fb);
    cells->full = aside <= b->full;
}

CAMBER_FN void camber_cell_masks_of(const camber_edges *p, const camber_cell_bounds *b, camber_real mx, camber_real my,
                                    camber_cell_masks *cells) {
    camber_cell_lines across, down;
    camber_cell_lines_across(p, mx, &across);
    camber_cell_lines_down(p, my, &down);
    camber_cell_masks_from(b, &across, &down, cells);
}

#endif

#endif
