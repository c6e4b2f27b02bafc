/* Draws a single segment of a brush without features, and sorts its cells for those that have some. */
#ifndef CAMBER_CELLS_OF_ONE_CL
#define CAMBER_CELLS_OF_ONE_CL

#include "cells.cl"
#include "tile_state.h"

/* Everything that a single segment is drawn from. */
typedef struct drawn_segment {
    global const float *segment, *arc_length, *side_table;
#if CAMBER_RASTER_PITCHED
    global const float *plane;
    camber_eye eye;
#endif
} drawn_segment;

#if CAMBER_RASTER_PITCHED
#define FROM_EYE_X(px, from) ((px) - (from).eye.x)
#define FROM_EYE_Y(px, from) ((px) - (from).eye.y)
#else
#define FROM_EYE_X(px, from) (px)
#define FROM_EYE_Y(px, from) (px)
#endif

static inline void begin_edge(drawn_segment from, camber_edge *p) {
    const camber_u32 flags = as_uint(from.segment[CAMBER_SEGMENT_FLAGS]);
#if CAMBER_RASTER_PITCHED
    camber_edge_of(from.eye, from.segment, from.plane, flags, p);
#else
    camber_edge_of(from.segment, flags, p);
#endif
}

/* Returns the cells in the box of a segment, one bit each, row by row from the lowest bit. */
static inline ulong box_of(global const float *segment, camber_tile_rows where) {
    camber_footprint f;
    camber_cell_boxes boxes;
    camber_footprint_of(segment, &f);
    camber_cell_boxes_of(&f, where, (camber_mask)(-1), &boxes);
    if (boxes.columns.s0 < 1 || boxes.rows.s0 < 1)
        return 0;
    const ulong row = (255ul >> (CAMBER_TILE_CELLS - boxes.columns.s0)) << boxes.x.s0;
    return (row * (0x0101010101010101ul >> (CAMBER_TILE_CELLS * (CAMBER_TILE_CELLS - boxes.rows.s0))))
           << (CAMBER_TILE_CELLS * boxes.y.s0);
}

#if !CAMBER_RASTER_PITCHED
/* Spreads the coefficients of one segment over all lanes. */
static inline void spread_edge(global const float *segment, camber_edges *p) {
    p->ax = CAMBER_REAL(segment[CAMBER_SEGMENT_AX]);
    p->ay = CAMBER_REAL(segment[CAMBER_SEGMENT_AY]);
    p->bx = CAMBER_REAL(segment[CAMBER_SEGMENT_BX]);
    p->by = CAMBER_REAL(segment[CAMBER_SEGMENT_BY]);
    p->ux = CAMBER_REAL(segment[CAMBER_SEGMENT_UX]);
    p->uy = CAMBER_REAL(segment[CAMBER_SEGMENT_UY]);
    p->nax = CAMBER_REAL(segment[CAMBER_SEGMENT_NAX]);
    p->nay = CAMBER_REAL(segment[CAMBER_SEGMENT_NAY]);
    p->nbx = CAMBER_REAL(segment[CAMBER_SEGMENT_NBX]);
    p->nby = CAMBER_REAL(segment[CAMBER_SEGMENT_NBY]);
    p->half_width = CAMBER_REAL(segment[CAMBER_SEGMENT_HALF_WIDTH]);
    p->side.slope = CAMBER_REAL(segment[CAMBER_SEGMENT_SLOPE]);
    p->side.curve = CAMBER_REAL(segment[CAMBER_SEGMENT_CURVE]);
    camber_edge_finish((camber_words)(as_uint(segment[CAMBER_SEGMENT_FLAGS])), p);
}
#endif

static inline void sort_cells(drawn_segment from, const camber_edge *p, const positions *at, ulong cells,
                              cell_sets *sets) {
#if !CAMBER_RASTER_PITCHED
    camber_edges all;
    camber_cell_bounds bounds;
    spread_edge(from.segment, &all);
    camber_cell_bounds_of(&all, &bounds);
#endif
    sets->partial = sets->near_end = sets->full = 0;
    for (int i = 0; i < CAMBER_CELLS; i += CAMBER_LANES) {
        const camber_real x = FROM_EYE_X(at->middle_x, from);
        const camber_real y = FROM_EYE_Y(at->middle_y + (float)(CAMBER_CELL_PX * (i / CAMBER_TILE_CELLS)), from);
        camber_cell_masks m;
        if (!(cells >> i & (~0ul >> (64 - CAMBER_LANES))))
            continue;
#if CAMBER_RASTER_PITCHED
        camber_cell_masks_of(p, x, y, &m);
#else
        camber_cell_masks_of(&all, &bounds, x, y, &m);
#endif
        sets->partial |= (ulong)camber_lanes_set(m.partial) << i;
        sets->near_end |= (ulong)camber_lanes_set(m.near_end) << i;
        sets->full |= (ulong)camber_lanes_set(m.full) << i;
    }
    sets->partial &= cells;
    sets->near_end &= sets->partial;
    sets->full &= sets->partial & ~sets->near_end;
}

/* Returns the positions of the pixels of vector v of a cell in the picture; with a pitch relative to its middle. */
static inline camber_real pixels_x(const positions *at, drawn_segment from, int i) {
    return FROM_EYE_X(at->x[i % CAMBER_TILE_CELLS], from);
}

static inline camber_real pixels_y(const positions *at, drawn_segment from, int i, int v) {
    return FROM_EYE_Y(at->y[i / CAMBER_TILE_CELLS][v], from);
}

/* Adds an area to the brush. */
static inline void put_area(camber_tile_state *c, const camber_edge *p, int i, int v, camber_real area,
                            const camber_pixel *pixels) {
    camber_real nx, ny;
    if (c->now.mode != CAMBER_BRUSH_UNION) {
        camber_tile_put_over(c, i, v, area);
        return;
    }
    const camber_mask thick = camber_edge_normal(p, pixels, &nx, &ny);
    camber_tile_put_union(c, i, v, area, thick, nx, ny);
}

#if CAMBER_RASTER_PITCHED
/* Draws a cell of a segment without features. */
static inline void draw_cell(camber_tile_state *c, const positions *at, const camber_edge *p, drawn_segment from, int i,
                             int near_end) {
    for (int v = 0; v < CAMBER_VECTORS; v++) {
        const camber_real x = pixels_x(at, from, i), y = pixels_y(at, from, i, v);
        camber_pixel pixels;
        if (!near_end && c->now.mode != CAMBER_BRUSH_UNION) {
            camber_tile_put_over(c, i, v, camber_edge_side(p, x, y));
            continue;
        }
        /* The normal of a union's edge needs all values that the area is computed from. */
        camber_look(p, x, y, &pixels);
        const camber_real area = camber_edge_area(p, &pixels);
        put_area(c, p, i, v, area, &pixels);
    }
    camber_tile_count(c, i);
}

static inline void draw_segment(camber_tile_state *c, const positions *at, camber_tile_rows where, drawn_segment from) {
    cell_sets sets;
    camber_edge p;
    const ulong cells = box_of(from.segment, where) & ~(c->done | c->filled);
    if (!cells)
        return;
    begin_edge(from, &p);
    sort_cells(from, &p, at, cells, &sets);
    camber_tile_take_cells(c, sets.partial);
    for (ulong left = sets.partial; left; left &= left - 1) {
        const int i = camber_lowest(left);
        if (sets.full >> i & 1ul)
            camber_tile_put_whole(c, i);
        else
            draw_cell(c, at, &p, from, i, (int)(sets.near_end >> i & 1ul));
    }
}
#endif

#endif
